// Wavefront OBJ: positions (with colours behind them, as some programs write), faces of any number of
// corners, and of the materials beside it their diffuse colours. All else is passed over.
#include <cmath>
#include <glm/common.hpp>
#include <map>

#include "graph/assets/triangle_mesh.h"
#include "graph/assets/triangle_mesh_text.h"
#include "graph/base/asset_file.h"

namespace fw {

namespace {

constexpr FileKind kMaterials = {.noun = "material file", .mostBytes = 16u << 20};
constexpr glm::vec3 kNoColor{0.8f};  // of faces without a material, where others have one

struct Fault {
    std::string what;
};

float unit(float x) { return x >= 0 ? std::min(x, 1.0f) : 0.0f; }

/// What is left of a line, without blanks about it.
std::string_view rest(const Scanner& words) {
    const std::string_view all = words.rest;
    const std::size_t first = all.find_first_not_of(" \t");
    return first == all.npos ? std::string_view()
                             : all.substr(first, all.find_last_not_of(" \t") + 1 - first);
}

class Reader {
  public:
    explicit Reader(const MeshFile& file_) : file(file_), scanner{file_.bytes} {}

    TriangleMesh run() {
        while (!scanner.atEnd()) {
            ++line;
            read(joined());
        }
        if (mesh.indices.empty()) throw Fault{"has no faces"};
        if (!colored) mesh.colors.clear();
        return std::move(mesh);
    }

  private:
    [[noreturn]] void fail(const std::string& what) const {
        throw Fault{what + " in line " + std::to_string(line)};
    }

    /// The next line, with those that a backslash at its end makes part of it.
    std::string_view joined() {
        const std::string_view first = scanner.line();
        if (!first.ends_with('\\')) return first;
        kept = first;
        while (kept.ends_with('\\') && !scanner.atEnd()) {
            kept.back() = ' ';
            kept += scanner.line();
            ++line;
        }
        return kept;
    }

    void read(std::string_view text) {
        Scanner words{text};
        const std::string_view word = words.word();
        if (word == "v")
            vertex(words);
        else if (word == "f")
            face(words);
        else if (word == "mtllib")
            materials(std::string(rest(words)));
        else if (word == "usemtl")
            use(std::string(rest(words)));
    }

    void vertex(Scanner words) {
        float numbers[7];
        int count = 0;
        while (count < 7) {
            const std::string_view word = words.word();
            if (word.empty()) break;
            const auto number = Scanner::numberIn<float>(word);
            if (!number || !std::isfinite(*number)) {
                if (count >= 3) break;  // behind the place there may be anything
                fail("has a vertex with " + inQuotes(std::string(word)) + " where a number should be,");
            }
            numbers[count++] = *number;
        }
        if (count < 3) fail("has a vertex of fewer than three numbers");
        if (places.size() >= kMostMeshVertices) fail("has more vertices than can be read,");
        places.emplace_back(numbers[0], numbers[1], numbers[2]);
        const bool own = count >= 6;  // x y z r g b; with four numbers the last is a weight
        colors.push_back(own ? glm::vec3(unit(numbers[3]), unit(numbers[4]), unit(numbers[5]))
                             : glm::vec3(-1));
        colored = colored || own;
    }

    void face(Scanner words) {
        corners.clear();
        for (std::string_view word = words.word(); !word.empty(); word = words.word()) {
            const auto index = Scanner::numberIn<int64_t>(word.substr(0, word.find('/')));
            const auto count = int64_t(places.size());
            if (!index || *index == 0)
                fail("has a face with " + inQuotes(std::string(word)) + " for a vertex,");
            if (*index > count || *index < -count)
                fail("has a face with vertex " + std::to_string(*index) + " of " + std::to_string(count));
            corners.push_back(cornerOf(uint32_t(*index > 0 ? *index - 1 : count + *index)));
        }
        if (mesh.indices.size() / 3 + corners.size() > kMostMeshTriangles)
            fail("has more triangles than can be read,");
        for (std::size_t c = 2; c < corners.size(); ++c)
            mesh.indices.insert(mesh.indices.end(), {corners[0], corners[c - 1], corners[c]});
    }

    /// The mesh's vertex for a place in the material in use.
    uint32_t cornerOf(uint32_t place) {
        made.resize(places.size(), {kNone, kNone});
        auto& [vertex, material] = made[place];
        if (vertex != kNone && material == inUse) return vertex;
        vertex = uint32_t(mesh.positions.size()), material = inUse;
        mesh.positions.push_back(places[place]);
        const glm::vec3 base = inUse == kNone ? kNoColor : palette[inUse], own = colors[place];
        mesh.colors.push_back(own.x < 0 ? base : inUse == kNone ? own : own * base);
        return vertex;
    }

    void use(const std::string& name) {
        const auto known = numbers_.find(name);
        inUse = known == numbers_.end() ? kNone : known->second;
        colored = colored || inUse != kNone;
    }

    /// Colours alone are lost where the file of the materials is missing or damaged.
    void materials(const std::string& path) {
        const Result<Asset> asset = openAsset(file.file, path, kMaterials);
        const Result<std::string> bytes = asset ? asset->read() : asset.error();
        if (!bytes) return;
        uint32_t current = kNone;
        for (Scanner lines{*bytes}; !lines.atEnd();) {
            Scanner words{lines.line()};
            const std::string_view word = words.word();
            if (word == "newmtl") {
                current = uint32_t(palette.size());
                numbers_[std::string(rest(words))] = current;
                palette.push_back(kNoColor);
            } else if (word == "Kd" && current != kNone) {
                glm::vec3 color;
                bool whole = true;
                for (int k = 0; k < 3; ++k) {
                    const auto number = words.number<float>();
                    whole = whole && number;
                    color[k] = unit(number.value_or(0.0f));
                }
                if (whole) palette[current] = color;
            }
        }
    }

    static constexpr uint32_t kNone = ~0u;
    const MeshFile& file;
    Scanner scanner;
    std::string kept;
    std::size_t line = 0;
    std::vector<glm::vec3> places, colors;            // as listed; a colour below zero is none
    std::vector<std::pair<uint32_t, uint32_t>> made;  // of a place, the last vertex and its material
    std::vector<uint32_t> corners;
    std::vector<glm::vec3> palette;
    std::map<std::string, uint32_t> numbers_;
    uint32_t inUse = kNone;
    bool colored = false;
    TriangleMesh mesh;
};

}  // namespace

std::vector<std::string> objPieces(std::string_view bytes) {
    std::vector<std::string> pieces;
    for (Scanner lines{bytes}; !lines.atEnd();) {
        Scanner words{lines.line()};
        if (words.word() == "mtllib") pieces.emplace_back(rest(words));
    }
    return pieces;
}

Result<TriangleMesh> readObjMesh(const MeshFile& file) {
    try {
        return Reader(file).run();
    } catch (const Fault& fault) { return meshProblem(file, fault.what); }
}

}  // namespace fw
