// STL: triangles without shared vertices, in binary or as text.
#include <bit>
#include <cmath>

#include "graph/assets/triangle_mesh.h"
#include "graph/assets/triangle_mesh_text.h"

namespace fw {

static_assert(std::endian::native == std::endian::little);  // as the binary form is

namespace {

constexpr std::size_t kHeader = 80, kRecord = 50;  // bytes of the binary form

bool finite(glm::vec3 p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

/// A name for an error; empty where there is none.
using Fault = std::string;

Fault readBinary(Scanner scanner, uint32_t count, TriangleMesh& mesh) {
    scanner.rest.remove_prefix(kHeader + 4);
    if (count > kMostMeshTriangles) return "has more triangles than can be read";
    mesh.positions.reserve(3ull * count);
    for (uint32_t t = 0; t < count; ++t) {
        scanner.rest.remove_prefix(12);  // the normal, which the corners tell as well
        for (int corner = 0; corner < 3; ++corner) {
            const glm::vec3 p{*scanner.raw<float>(), *scanner.raw<float>(), *scanner.raw<float>()};
            if (!finite(p)) return "has a corner that is not finite, in triangle " + std::to_string(t + 1);
            mesh.positions.push_back(p);
        }
        scanner.rest.remove_prefix(2);
    }
    return {};
}

Fault readText(Scanner scanner, TriangleMesh& mesh) {
    std::size_t line = 0, first = 0;
    const auto at = [&](const std::string& what) { return what + " in line " + std::to_string(line); };
    while (!scanner.atEnd()) {
        Scanner words{scanner.line()};
        ++line;
        const std::string_view word = words.word();
        const std::size_t corners = mesh.positions.size() - first;
        if (word == "vertex") {
            const auto x = words.number<float>(), y = words.number<float>(), z = words.number<float>();
            if (!x || !y || !z || !finite({*x, *y, *z})) return at("has a corner that is no three numbers,");
            if (corners == 3) return at("has a facet of more than three corners");
            mesh.positions.emplace_back(*x, *y, *z);
        } else if (word == "endfacet") {
            if (corners != 3)
                return at("has a facet that ends after " + std::to_string(corners) + " corners,");
            if (mesh.positions.size() / 3 > kMostMeshTriangles) return "has more triangles than can be read";
            first = mesh.positions.size();
        }
    }
    return mesh.positions.size() > first ? "is cut off: copy it again" : Fault();
}

}  // namespace

Result<TriangleMesh> readStlMesh(const MeshFile& file) {
    TriangleMesh mesh;
    const std::string_view bytes = file.bytes;
    Scanner scanner{bytes.substr(std::min(kHeader, bytes.size()))};
    const uint64_t count = scanner.raw<uint32_t>().value_or(0), needed = kHeader + 4 + kRecord * count;
    const bool text = Scanner{bytes}.word() == "solid";  // as the header of some binary files begins, too
    Fault fault;
    if (count > 0 && (needed == bytes.size() || (!text && needed < bytes.size())))
        fault = readBinary({bytes}, uint32_t(count), mesh);
    else if (text)
        fault = readText({bytes}, mesh);
    else
        fault = count > 0 ? "is cut off, or is no STL file" : "is no STL file, or has no triangles";
    const bool none = mesh.positions.empty();
    if (text && (none || !fault.empty()) && bytes.find('\0') != std::string_view::npos)
        fault = "is cut off, or is no STL file";  // it only began as text does
    else if (none && fault.empty())
        fault = "has no triangles";
    if (!fault.empty()) return meshProblem(file, fault);
    for (uint32_t i = 0; i < mesh.positions.size(); ++i) mesh.indices.push_back(i);
    return mesh;
}

}  // namespace fw
