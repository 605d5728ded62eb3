#include "runtime/mesh/split_materials.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>
#include <unordered_map>

#include "runtime/mesh/field_values.h"

namespace fw {
namespace {

constexpr int kHalvings = 12;       ///< of an edge, to a 4,096th of its length
constexpr float kAtVertex = 0.02f;  ///< of an edge: a border so near to its end runs through the vertex

/// An edge with a border on it, seen from its lesser end: the last place of that end's painter, and the first
/// of another one.
struct Border {
    uint32_t ends[2];
    glm::vec3 before, behind;
    float at = 0;  ///< share of the edge
};

/// A vertex whose colour is that of a place near it.
struct Painted {
    uint32_t vertex;
    float painter;
    glm::vec3 near, surely;  ///< the second, if the first has another painter
};

uint64_t keyOf(uint32_t a, uint32_t b) { return uint64_t(std::min(a, b)) << 32 | std::max(a, b); }

class MaterialSplitter {
  public:
    MaterialSplitter(Mesh& mesh_, const Program& program)
        : mesh(mesh_),
          painter(makeTape(program.ir, program.surface[painterComponent], program.parameters())),
          color(makeTape(program.ir, std::span(program.surface).subspan(baseColorComponent, 3),
                         program.parameters())) {}

    std::vector<glm::vec3> split() {
        painters = fieldValues(painter, mesh.positions);
        findBorders();
        findShared();
        const std::vector<uint32_t> before = std::move(mesh.indices);
        for (std::size_t t = 0; t < before.size(); t += 3) splitTriangle(&before[t]);
        if (!mesh.colors.empty()) paintCopies();
        return std::move(places);
    }

  private:
    void findBorders() {
        for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
            const uint32_t a = mesh.indices[i], b = mesh.indices[i % 3 == 2 ? i - 2 : i + 1];
            if (painters[a] == painters[b] || borderOf.contains(keyOf(a, b))) continue;
            borderOf.emplace(keyOf(a, b), borders.size());
            const uint32_t low = std::min(a, b), high = std::max(a, b);
            borders.push_back({{low, high}, mesh.positions[low], mesh.positions[high]});
        }
        std::vector<glm::vec3> middles(borders.size());
        for (int halving = 0; halving < kHalvings; ++halving) {
            for (std::size_t i = 0; i < borders.size(); ++i)
                middles[i] = 0.5f * (borders[i].before + borders[i].behind);
            const std::vector<float> there = fieldValues(painter, middles);
            for (std::size_t i = 0; i < borders.size(); ++i) {
                Border& border = borders[i];
                const bool still = there[i] == painters[border.ends[0]];
                (still ? border.before : border.behind) = middles[i];
                if (still) border.at += std::ldexp(1.0f, -1 - halving);
            }
        }
    }

    /// Vertices of which every border about them runs through the vertex itself. Who coloured the mesh may
    /// have seen a vertex so near to a border on its other side.
    void findShared() {
        shared.assign(mesh.positions.size(), 0);
        std::vector<char> apart(mesh.positions.size(), 0);
        for (const Border& border : borders)
            for (int end = 0; end < 2; ++end) {
                const float from = end == 0 ? border.at : 1.0f - border.at;
                (from < kAtVertex ? shared : apart)[border.ends[end]] = 1;
                const uint32_t v = border.ends[end];
                if (from < kAtVertex)
                    painted.push_back({v, painters[v], mesh.positions[v], mesh.positions[v]});
            }
        for (std::size_t v = 0; v < shared.size(); ++v)
            if (apart[v]) shared[v] = 0;
    }

    /// With the colour of `near`; if that is of another painter than `of`, of `surely`.
    uint32_t addVertex(glm::vec3 position, glm::vec3 normal, float of, glm::vec3 near, glm::vec3 surely) {
        mesh.positions.push_back(position);
        if (!mesh.normals.empty()) mesh.normals.push_back(normal);
        if (!mesh.colors.empty()) mesh.colors.emplace_back(0.0f);
        painted.push_back({uint32_t(mesh.positions.size()) - 1, of, near, surely});
        return uint32_t(mesh.positions.size()) - 1;
    }

    glm::vec3 normalAt(uint32_t vertex) const {
        return mesh.normals.empty() ? glm::vec3(0.0f) : mesh.normals[vertex];
    }

    /// The vertex where the border crosses the edge, for the side of `of`, one of its ends.
    uint32_t crossing(uint32_t of, uint32_t to) {
        const uint64_t key = keyOf(of, to);
        const auto [known, isNew] = onEdge.try_emplace({key, painters[of]}, 0);
        if (!isNew) return known->second;
        const Border& border = borders[borderOf.at(key)];
        const glm::vec3 normal = glm::mix(normalAt(border.ends[0]), normalAt(border.ends[1]), border.at);
        const glm::vec3 own = of == border.ends[0] ? border.before : border.behind;
        const float length = glm::length(normal);
        known->second =
            addVertex(0.5f * (border.before + border.behind), length > 0 ? normal / length : normalAt(of),
                      painters[of], own, mesh.positions[of]);
        return known->second;
    }

    /// The vertex itself, or where the border runs through it, its copy for a painter: coloured as at `near`.
    uint32_t vertexFor(uint32_t vertex, float of, glm::vec3 near) {
        if (painters[vertex] == of) return vertex;
        const auto [known, isNew] = copies.try_emplace({vertex, of}, 0);
        if (isNew)
            known->second = addVertex(mesh.positions[vertex], normalAt(vertex), of,
                                      glm::mix(mesh.positions[vertex], near, kAtVertex), near);
        return known->second;
    }

    void add(uint32_t a, uint32_t b, uint32_t c, glm::vec3 place) {
        mesh.indices.insert(mesh.indices.end(), {a, b, c});
        places.push_back(place);
    }

    void splitTriangle(const uint32_t* corner) {
        const auto at = [&](int i) { return corner[i % 3]; };
        const auto where = [&](int i) { return mesh.positions[at(i)]; };
        const auto free = [&](int i) { return bool(shared[at(i)]); };
        const auto cut = [&](int i) {  // the edge from corner i on
            return !free(i) && !free(i + 1) && painters[at(i)] != painters[at(i + 1)];
        };
        const int cuts = cut(0) + cut(1) + cut(2);
        if (cuts == 0) {
            int own = 0;
            while (own < 3 && free(own)) ++own;
            const glm::vec3 place = own < 3 ? where(own) : (where(0) + where(1) + where(2)) / 3.0f;
            const float of = own < 3 ? painters[at(own)] : fieldValues(painter, {&place, 1})[0];
            add(vertexFor(at(0), of, place), vertexFor(at(1), of, place), vertexFor(at(2), of, place), place);
        } else if (cuts == 1) {  // from a corner that goes with both sides to the edge opposite
            const int i = cut(0) ? 0 : cut(1) ? 1 : 2;
            const uint32_t a = at(i), b = at(i + 1), c = at(i + 2);
            add(a, crossing(a, b), vertexFor(c, painters[a], where(i)), where(i));
            add(crossing(b, a), b, vertexFor(c, painters[b], where(i + 1)), where(i + 1));
        } else if (cuts == 2) {  // a corner is cut off
            const int i = !cut(0) ? 2 : !cut(1) ? 0 : 1;
            const uint32_t a = at(i), b = at(i + 1), c = at(i + 2);
            add(a, crossing(a, b), crossing(a, c), where(i));
            add(crossing(b, a), b, c, where(i + 1));
            add(crossing(b, a), c, crossing(c, a), where(i + 2));
        } else {
            glm::vec3 middle(0.0f), normal(0.0f);
            for (int i = 0; i < 3; ++i) {
                middle += mesh.positions[crossing(at(i), at(i + 1))] / 3.0f;
                normal += normalAt(at(i));
            }
            const float length = glm::length(normal);
            for (int i = 0; i < 3; ++i) {
                const uint32_t own = addVertex(middle, length > 0 ? normal / length : normalAt(at(i)),
                                               painters[at(i)], glm::mix(where(i), middle, 0.9f), where(i));
                add(at(i), crossing(at(i), at(i + 1)), own, where(i));
                add(at(i), own, crossing(at(i), at(i + 2)), where(i));
            }
        }
    }

    void paintCopies() {
        std::vector<glm::vec3> at;
        for (const Painted& one : painted) at.push_back(one.near);
        const std::vector<float> there = fieldValues(painter, at);
        for (std::size_t i = 0; i < at.size(); ++i)
            if (there[i] != painted[i].painter) at[i] = painted[i].surely;
        const std::vector<float> colors = fieldValues(color, at);
        for (std::size_t i = 0; i < painted.size(); ++i)
            mesh.colors[painted[i].vertex] =
                glm::clamp(glm::vec3(colors[3 * i], colors[3 * i + 1], colors[3 * i + 2]), 0.0f, 1.0f);
    }

    Mesh& mesh;
    Tape painter, color;
    std::vector<float> painters;  ///< of the vertices that there were
    std::vector<char> shared;     ///< the border runs through it
    std::vector<Border> borders;
    std::unordered_map<uint64_t, std::size_t> borderOf;
    std::map<std::pair<uint64_t, float>, uint32_t> onEdge;
    std::map<std::pair<uint32_t, float>, uint32_t> copies;
    std::vector<Painted> painted;
    std::vector<glm::vec3> places;
};

}  // namespace

std::vector<glm::vec3> splitMaterials(Mesh& mesh, const Program& program) {
    return MaterialSplitter(mesh, program).split();
}

}  // namespace fw
