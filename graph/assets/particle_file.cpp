#include "graph/assets/particle_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <optional>
#include <span>

#include "graph/assets/triangle_mesh.h"
#include "graph/assets/triangle_mesh_text.h"
#include "graph/base/asset_file.h"
#include "graph/base/hash.h"

namespace fw {

namespace {

/// The line's fields: between semicolons, or else commas, or else blanks; without quotes about them.
std::vector<std::string_view> fieldsOf(std::string_view line) {
    std::vector<std::string_view> fields;
    const char mark = line.find(';') != line.npos ? ';' : ',';
    if (line.find(mark) == line.npos) {
        Scanner words{line};
        for (std::string_view word = words.word(); !word.empty(); word = words.word()) fields.push_back(word);
        return fields;
    }
    for (std::size_t end = 0; end != line.npos; line.remove_prefix(end == line.npos ? 0 : end + 1)) {
        end = line.find(mark);
        std::string_view field = Scanner{line.substr(0, end)}.word();
        if (field.size() > 1 && field.front() == '"' && field.back() == '"')
            field = field.substr(1, field.size() - 2);
        fields.push_back(field);
    }
    return fields;
}

bool isFinite(const glm::vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

/// Which fields are x, y and z.
using Columns = std::array<std::size_t, 3>;

std::optional<glm::vec3> placeIn(std::span<const std::string_view> fields, const Columns& columns) {
    glm::vec3 place;
    for (int k = 0; k < 3; ++k) {
        const std::size_t column = columns[std::size_t(k)];
        const auto number =
            column < fields.size() ? Scanner::numberIn<float>(fields[column]) : std::optional<float>();
        if (!number) return std::nullopt;
        place[k] = *number;
    }
    return place;
}

/// As a line of names says; the first three if it names none of them.
Columns columnsIn(std::span<const std::string_view> names) {
    Columns columns{0, 1, 2}, named = columns;
    for (std::size_t k = 0; k < 3; ++k) {
        const auto found = std::ranges::find_if(names, [&](std::string_view name) {
            return name.size() == 1 && std::tolower(static_cast<unsigned char>(name[0])) == "xyz"[k];
        });
        if (found == names.end()) return columns;
        named[k] = std::size_t(found - names.begin());
    }
    return named;
}

/// Those in a text: in each line after one of names, which may be missing, or in an OBJ file in each line of
/// a vertex.
Result<std::vector<glm::vec3>> placesInText(std::string_view bytes, const std::string& path, bool obj) {
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (bytes.starts_with(kByteOrderMark)) bytes.remove_prefix(kByteOrderMark.size());
    std::vector<glm::vec3> places;
    Columns columns = obj ? Columns{1, 2, 3} : Columns{0, 1, 2};
    bool first = !obj;
    Scanner scanner{bytes};
    for (int line = 1; !scanner.atEnd(); ++line) {
        const std::vector<std::string_view> fields = fieldsOf(scanner.line());
        if (fields.empty() || fields[0].starts_with('#') || (obj && fields[0] != "v")) continue;
        if (const std::optional<glm::vec3> place = placeIn(fields, columns)) {
            if (!isFinite(*place))
                return fileProblem(path, kParticleFile,
                                   "has a place that is not a number in line " + std::to_string(line));
            places.push_back(*place);
        } else if (first && fields[0].find_first_of("0123456789+-.") != 0) {  // not a number, however large
            columns = columnsIn(fields);
        } else {
            return fileProblem(path, kParticleFile,
                               "has no three numbers in line " + std::to_string(line) + ": write x y z");
        }
        first = false;
    }
    return places;
}

}  // namespace

Result<std::vector<glm::vec3>> parseParticlePlaces(const std::string& bytes, const std::string& path) {
    if (!endsAs(kParticleFile, path)) return wrongEnding(path, kParticleFile);
    const std::string ending = endingOf(path);
    std::vector<glm::vec3> places;
    if (ending == ".ply") {
        Result<TriangleMesh> mesh = readPlyMesh({bytes, path, path, kParticleFile});
        if (!mesh) return mesh.error();
        places = std::move(mesh->positions);
    } else {
        Result<std::vector<glm::vec3>> read = placesInText(bytes, path, ending == ".obj");
        if (!read) return read;
        places = std::move(*read);
    }
    if (places.empty()) return fileProblem(path, kParticleFile, "has no places of particles");
    if (places.size() > kMostFileParticles)
        return fileProblem(path, kParticleFile,
                           "has " + std::to_string(places.size()) +
                               " particles: " + std::to_string(kMostFileParticles) + " is the most");
    if (!std::ranges::all_of(places, isFinite))
        return fileProblem(path, kParticleFile, "has a place that is not a number");
    return places;
}

Result<ParticlePlacesPtr> readParticlePlaces(const std::string& graphPath, const std::string& path) {
    return readAsset<ParticlePlaces>(
        graphPath, path, kParticleFile,
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
