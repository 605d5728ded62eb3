#include "graph/assets/solid_mesh.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "graph/assets/triangle_tree.h"
#include "graph/base/hash.h"
#include "graph/base/parallel.h"

namespace fw {

namespace {

constexpr uint32_t kNone = ~0u;

/// Places in a table that is searched from a hash on: at least twice as many as there will be entries.
std::vector<uint32_t> emptyTable(std::size_t entries) {
    return std::vector<uint32_t>(std::bit_ceil(2 * entries + 1), kNone);
}

/// The place of the entry for which equal() holds, or the free one where it belongs.
template <class Equal>
std::size_t find(const std::vector<uint32_t>& table, uint64_t hash, const Equal& equal) {
    std::size_t place = (hash ^ hash >> 31) & (table.size() - 1);
    while (table[place] != kNone && !equal(table[place])) place = (place + 1) & (table.size() - 1);
    return place;
}

/// Gives vertices with equal coordinates one number.
std::vector<uint32_t> weld(const TriangleMesh& mesh, std::vector<glm::vec3>& positions) {
    std::vector<uint32_t> table = emptyTable(mesh.positions.size()), numbers;
    numbers.reserve(mesh.positions.size());
    for (glm::vec3 p : mesh.positions) {
        p += 0.0f;  // one zero
        uint64_t hash = 0;
        for (int axis = 0; axis < 3; ++axis) hash = mixed(hash, std::bit_cast<uint32_t>(p[axis]));
        uint32_t& entry = table[find(table, hash, [&](uint32_t i) { return positions[i] == p; })];
        if (entry == kNone) entry = uint32_t(positions.size()), positions.push_back(p);
        numbers.push_back(entry);
    }
    return numbers;
}

void takeTriangles(const TriangleMesh& mesh, SolidMesh& solid) {
    const std::vector<uint32_t> numbers = weld(mesh, solid.positions);
    std::vector<uint32_t> table = emptyTable(mesh.indices.size() / 3);
    for (uint32_t t = 0; 3 * std::size_t(t) < mesh.indices.size(); ++t) {
        std::array<uint32_t, 3> corners;
        for (std::size_t k = 0; k < 3; ++k) corners[k] = numbers[mesh.indices[3 * std::size_t(t) + k]];
        if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) {
            ++solid.found.collapsed;
            continue;
        }
        std::rotate(corners.begin(), std::ranges::min_element(corners), corners.end());
        const uint64_t hash = mixed(mixed(mixed(0, corners[0]), corners[1]), corners[2]);
        uint32_t& entry = table[find(table, hash, [&](uint32_t i) {
            return std::equal(corners.begin(), corners.end(), &solid.indices[3 * std::size_t(i)]);
        })];
        if (entry != kNone) {
            ++solid.found.copies;
            continue;
        }
        entry = uint32_t(solid.source.size());
        solid.indices.insert(solid.indices.end(), corners.begin(), corners.end());
        solid.source.push_back(t);
    }
}

/// SolidMesh::mates.
std::vector<uint32_t> matesOf(const std::vector<uint32_t>& indices) {
    std::vector<uint32_t> table = emptyTable(indices.size()), mates(indices.size(), kNoMate);
    const auto ends = [&](uint32_t side) {
        const uint32_t a = indices[side], b = indices[side % 3 == 2 ? side - 2 : side + 1];
        return std::pair(std::min(a, b), std::max(a, b));
    };
    for (uint32_t side = 0; side < indices.size(); ++side) {
        const auto edge = ends(side);
        const uint64_t hash = mixed(mixed(0, edge.first), edge.second);
        uint32_t& entry = table[find(table, hash, [&](uint32_t other) { return ends(other) == edge; })];
        if (entry == kNone) {
            entry = side;
        } else if (mates[entry] == kNoMate) {
            mates[entry] = side, mates[side] = entry;
        } else {
            if (mates[entry] != kManyMates) mates[mates[entry]] = kManyMates;
            mates[entry] = mates[side] = kManyMates;
        }
    }
    return mates;
}

/// Triangles that hang together, and what is known of them.
struct Part {
    std::vector<uint32_t> triangles;
    std::size_t turned = 0;
    bool closed = true;
    double volume = 0.0;  ///< as it is turned; about the mesh's middle, where it is open
};

void turn(SolidMesh& solid, uint32_t triangle) {
    const std::size_t first = 3 * std::size_t(triangle);
    std::swap(solid.indices[first + 1], solid.indices[first + 2]);
    // Its first and last side change places.
    std::swap(solid.mates[first], solid.mates[first + 2]);
    for (const std::size_t side : {first, first + 2})
        if (const uint32_t mate = solid.mates[side]; mate != kNoMate && mate != kManyMates)
            solid.mates[mate] = uint32_t(side);
}
void turn(SolidMesh& solid, Part& part) {
    for (uint32_t triangle : part.triangles) turn(solid, triangle);
    part.volume = -part.volume;
}

/// Finds the parts and turns the triangles of each alike.
std::vector<Part> findParts(SolidMesh& solid, const glm::dvec3& middle) {
    const std::vector<uint32_t>& mates = solid.mates;
    std::vector<uint8_t> reached(solid.source.size(), 0), against(solid.source.size(), 0);
    std::vector<Part> parts;
    for (uint32_t first = 0; first < solid.source.size(); ++first) {
        if (reached[first]) continue;
        Part& part = parts.emplace_back();
        bool agree = true;
        reached[first] = 1;
        part.triangles.push_back(first);
        for (std::size_t i = 0; i < part.triangles.size(); ++i) {
            const uint32_t t = part.triangles[i];
            for (uint32_t side = 3 * t; side < 3 * t + 3; ++side) {
                const uint32_t mate = mates[side];
                if (mate == kNoMate || mate == kManyMates) {
                    part.closed = false;
                    ++(mate == kNoMate ? solid.found.openEdges : solid.found.crowded);
                    continue;
                }
                const uint32_t other = mate / 3;
                // Neighbours that agree go along their edge in opposite directions.
                const uint8_t differs = solid.indices[side] == solid.indices[mate] ? 1 : 0;
                const uint8_t wanted = against[t] ^ differs;
                if (reached[other]) {
                    agree &= against[other] == wanted;
                    continue;
                }
                reached[other] = 1, against[other] = wanted;
                part.triangles.push_back(other);
            }
        }
        solid.found.oneSided += !agree;
        if (agree) {
            for (uint32_t t : part.triangles) part.turned += against[t];
            const bool most = 2 * part.turned > part.triangles.size();
            if (most) part.turned = part.triangles.size() - part.turned;
            for (uint32_t t : part.triangles)
                if ((against[t] != 0) != most) turn(solid, t);
        }
        for (uint32_t t : part.triangles) {
            const auto [a, b, c] = solid.corners(t);
            part.volume += glm::dot(a - middle, glm::cross(b - middle, c - middle)) / 6.0;
        }
        solid.found.turned += part.turned;
    }
    return parts;
}

/// How many of the other closed parts go around the part, whichever way they are turned.
int depthOf(const SolidMesh& solid, const std::vector<Part>& parts, const Part& part) {
    const glm::dvec3 at(solid.positions[solid.indices[3 * std::size_t(part.triangles[0])]]);
    int depth = 0;
    for (const Part& other : parts) {
        if (&other == &part || !other.closed) continue;
        double angle = 0.0;
        for (uint32_t t : other.triangles) {
            const auto [a, b, c] = solid.corners(t);
            angle += solidAngle(a - at, b - at, c - at);
        }
        depth += std::abs(angle) > 0.5;
    }
    return depth;
}

/// Beyond so many tests of a triangle each part is taken for one by itself.
constexpr std::size_t kMostTests = 10'000'000;

/// Turns closed parts outwards, and the walls of cavities into these.
void turnOutwards(SolidMesh& solid, std::vector<Part>& parts) {
    double total = 0.0;
    for (const Part& part : parts) total += part.volume;
    if (total < 0.0) {
        solid.found.insideOut = true;
        for (Part& part : parts) turn(solid, part);
    }
    const bool nested = parts.size() > 1 && parts.size() * solid.source.size() <= kMostTests;
    for (Part& part : parts) {
        if (!part.closed || part.volume >= 0.0) continue;
        const bool cavity = nested && part.turned == 0 && depthOf(solid, parts, part) % 2 == 1;
        if (cavity) continue;
        solid.found.turned += part.triangles.size();
        turn(solid, part);
    }
}

}  // namespace

std::string MeshFindings::text() const {
    std::string text;
    const auto add = [&](std::size_t count, const char* one, const char* many) {
        if (count == 0) return;
        if (!text.empty()) text += ", ";
        text += std::to_string(count) + " " + (count == 1 ? one : many);
    };
    add(openEdges, "open edge", "open edges");
    add(crowded, "face at an edge of more than two", "faces at edges of more than two");
    add(turned, "face turned the other way", "faces turned the other way");
    add(oneSided, "part whose faces cannot agree", "parts whose faces cannot agree");
    add(collapsed, "face without area left out", "faces without area left out");
    add(copies, "copy of a face left out", "copies of faces left out");
    if (insideOut) text += std::string(text.empty() ? "" : ", ") + "all faces turned inwards";
    return text;
}

SolidMesh solidMesh(const TriangleMesh& mesh) {
    SolidMesh solid;
    takeTriangles(mesh, solid);
    solid.mates = matesOf(solid.indices);
    glm::vec3 lo(std::numeric_limits<float>::infinity()), hi(-lo);
    for (const glm::vec3& p : solid.positions) lo = glm::min(lo, p), hi = glm::max(hi, p);
    std::vector<Part> parts = findParts(solid, 0.5 * (glm::dvec3(lo) + glm::dvec3(hi)));
    turnOutwards(solid, parts);
    solid.found.parts = parts.size();
    for (const Part& part : parts) solid.volume += part.volume;
    return solid;
}

std::vector<FeatureNormals> featureNormals(const SolidMesh& solid) {
    constexpr std::size_t kBlock = 4096;  // triangles
    const std::size_t count = solid.source.size();
    const auto unit = [](const glm::dvec3& v) {
        const double length = glm::length(v);
        return length > 0.0 ? v / length : glm::dvec3(0.0);
    };
    std::vector<glm::dvec3> faces(count), angles(count), vertices(solid.positions.size(), glm::dvec3(0.0));
    forBlocks(count, kBlock, [&](std::size_t, std::size_t first, std::size_t last) {
        for (std::size_t t = first; t < last; ++t) {
            const auto [a, b, c] = solid.corners(t);
            const glm::dvec3 ab = unit(b - a), bc = unit(c - b), ca = unit(a - c);
            const auto angle = [](const glm::dvec3& in, const glm::dvec3& out) {
                return std::acos(std::clamp(-glm::dot(in, out), -1.0, 1.0));
            };
            faces[t] = unit(glm::cross(b - a, c - a));
            angles[t] = {angle(ca, ab), angle(ab, bc), angle(bc, ca)};
        }
    });
    for (std::size_t i = 0; i < solid.indices.size(); ++i)
        vertices[solid.indices[i]] += angles[i / 3][int(i % 3)] * faces[i / 3];
    std::vector<FeatureNormals> normals(count);
    forBlocks(count, kBlock, [&](std::size_t, std::size_t first, std::size_t last) {
        for (std::size_t t = first; t < last; ++t) {
            normals[t][0] = faces[t];
            for (std::size_t k = 0; k < 3; ++k) {
                const uint32_t mate = solid.mates[3 * t + k];
                const bool paired = mate != kNoMate && mate != kManyMates;
                normals[t][1 + k] = unit(faces[t] + (paired ? faces[mate / 3] : glm::dvec3(0.0)));
                normals[t][4 + k] = unit(vertices[solid.indices[3 * t + k]]);
            }
        }
    });
    return normals;
}

}  // namespace fw
