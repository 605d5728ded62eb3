#include "graph/particle_file.h"

#include <bit>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <optional>

#include "graph/asset_file.h"
#include "graph/hash.h"
#include "graph/triangle_mesh.h"
#include "graph/triangle_mesh_text.h"

namespace fw {

namespace {

constexpr AssetKind kParticles = {"particle file", kMostMeshFileBytes};

/// The line's first three numbers.
std::optional<glm::vec3> placeIn(std::string_view line) {
    std::string apart(line);
    for (char& c : apart)
        if (c == ',' || c == ';') c = ' ';
    Scanner words{apart};
    glm::vec3 place;
    for (int k = 0; k < 3; ++k) {
        const std::optional<float> number = words.number<float>();
        if (!number) return std::nullopt;
        place[k] = *number;
    }
    return place;
}

/// Those in a text: in each line, or in an OBJ file in each line of a vertex.
Result<std::vector<glm::vec3>> placesInText(const std::string& bytes, const std::string& path, bool obj) {
    std::vector<glm::vec3> places;
    Scanner scanner{bytes};
    for (int line = 1; !scanner.atEnd(); ++line) {
        const std::string_view text = scanner.line();
        Scanner words{text};
        const std::string_view first = words.word();
        if (first.empty() || first[0] == '#' || (obj && first != "v")) continue;
        if (const std::optional<glm::vec3> place = placeIn(obj ? words.rest : text))
            places.push_back(*place);
        else if (obj || !places.empty() || Scanner::numberIn<float>(first))
            return assetProblem(path, kParticles,
                                "has no three numbers in line " + std::to_string(line) + ": write x y z");
    }
    return places;
}

}  // namespace

Result<std::vector<glm::vec3>> parseParticlePlaces(const std::string& bytes, const std::string& path) {
    std::string ending = std::filesystem::path(path).extension().string();
    for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    const bool ply = ending == ".ply", obj = ending == ".obj";
    std::vector<glm::vec3> places;
    if (ply) {
        Result<TriangleMesh> mesh = readPlyMesh({bytes, path, path});
        if (!mesh) return mesh.error();
        places = std::move(mesh->positions);
    } else if (obj || ending == ".csv" || ending == ".txt" || ending == ".xyz") {
        Result<std::vector<glm::vec3>> read = placesInText(bytes, path, obj);
        if (!read) return read;
        places = std::move(*read);
    } else {
        return assetProblem(path, kParticles,
                            "is of no format that is read: use a .ply, .obj, .csv, .txt or .xyz file");
    }
    if (places.empty()) return assetProblem(path, kParticles, "has no places of particles");
    if (places.size() > kMostFileParticles)
        return assetProblem(path, kParticles,
                            "has " + std::to_string(places.size()) +
                                " particles: " + std::to_string(kMostFileParticles) + " is the most");
    for (const glm::vec3& p : places)
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
            return assetProblem(path, kParticles, "has a place that is not a number");
    return places;
}

Result<ParticlePlacesPtr> readParticlePlaces(const std::string& graphPath, const std::string& path) {
    return readAsset<ParticlePlaces>(
        graphPath, path, kParticles,
        [&](const std::string& bytes, const std::string& file) -> Result<ParticlePlacesPtr> {
            Result<std::vector<glm::vec3>> places = parseParticlePlaces(bytes, path);
            if (!places) return places.error();
            uint64_t hash = 0xcbf29ce484222325u;
            for (const glm::vec3& p : *places)
                for (int k = 0; k < 3; ++k) hash = mixed(hash, std::bit_cast<uint32_t>(p[k]));
            return std::make_shared<const ParticlePlaces>(ParticlePlaces{std::move(*places), file, hash});
        });
}

}  // namespace fw
