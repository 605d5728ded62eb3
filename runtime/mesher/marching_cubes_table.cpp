#include "runtime/mesher/marching_cubes_table.h"

#include <algorithm>
#include <cassert>

namespace fw {
namespace {

/// Corners of the faces, counter-clockwise seen from outside the cell.
constexpr int kFaces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                              {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};

int edgeBetween(int cornerA, int cornerB) {
    int low = std::min(cornerA, cornerB), axis = cornerA ^ cornerB;
    switch (axis) {
        case 1: return low >> 1;                             // offsets y, z
        case 2: return 4 + (low & 1) + 2 * (low >> 2);       // offsets x, z
        default: return 8 + (low & 1) + 2 * (low >> 1 & 1);  // offsets x, y
    }
}

/// Bit f is set if the edge borders face f.
int facesOf(int edge) {
    int faces = 0;
    for (int f = 0; f < 6; ++f)
        for (int i = 0; i < 4; ++i)
            if (edgeBetween(kFaces[f][i], kFaces[f][(i + 1) % 4]) == edge) faces |= 1 << f;
    return faces;
}

/// Rotates the polygon so that no diagonal of its fan lies in a face.
void chooseFan(CellPolygon& polygon) {
    for (std::size_t start = 0; start < polygon.size(); ++start) {
        bool inFace = false;
        for (std::size_t i = 2; i + 1 < polygon.size(); ++i)
            inFace |= (facesOf(polygon[0]) & facesOf(polygon[i])) != 0;
        if (!inFace) return;
        std::rotate(polygon.begin(), polygon.begin() + 1, polygon.end());
    }
    assert(false && "a polygon has no fan without a diagonal in a face");
}

std::vector<CellPolygon> derive(int pattern) {
    // For each active edge the next one on its loop. Going around a face, an edge from outside to inside
    // begins a run of inside corners; the segment leads to the edge where that run ends.
    std::array<int, 12> next;
    next.fill(-1);
    auto inside = [&](int corner) { return (pattern >> corner & 1) != 0; };
    for (const int(&face)[4] : kFaces) {
        for (int i = 0; i < 4; ++i) {
            if (inside(face[i]) || !inside(face[(i + 1) % 4])) continue;
            int end = i + 1;
            while (inside(face[(end + 1) % 4])) ++end;
            next[edgeBetween(face[i], face[(i + 1) % 4])] = edgeBetween(face[end % 4], face[(end + 1) % 4]);
        }
    }
    std::vector<CellPolygon> polygons;
    std::array<bool, 12> used{};
    for (int first = 0; first < 12; ++first) {
        if (next[first] < 0 || used[first]) continue;
        CellPolygon polygon;
        for (int edge = first; !used[edge]; edge = next[edge]) {
            used[edge] = true;
            polygon.push_back(uint8_t(edge));
        }
        chooseFan(polygon);
        polygons.push_back(std::move(polygon));
    }
    return polygons;
}

unsigned codeOf(const CellEdge& edge) {
    return edge.corner.y | edge.corner.z << 2 | unsigned(edge.axis) << 3 | edge.corner.x << 5;
}

/// Bit f is set if the polygon runs over face f twice.
int facesTwice(const CellPolygon& polygon) {
    int once = 0, twice = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const int face = facesOf(polygon[i]) & facesOf(polygon[(i + 1) % polygon.size()]);
        twice |= once & face;
        once |= face;
    }
    return twice;
}

glm::uvec3 packPatch(const CellPolygon& polygon) {
    glm::uvec3 words(0);
    const int twice = facesTwice(polygon);
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const CellEdge edge = cellEdge(polygon[i]);
        const int first = edge.axis == 0 ? 1 : 0, second = edge.axis == 2 ? 1 : 2;
        const auto isTwice = [&](int axis) {
            return unsigned(twice >> (2 * axis + int(edge.corner[axis])) & 1);
        };
        const unsigned code =
            codeOf(edge) | isTwice(first) << 1 | isTwice(second) << 6 | (i + 1 == polygon.size() ? 128u : 0u);
        words[int(i) / 4] |= code << i % 4 * 8;
    }
    return words;
}

glm::uvec3 pack(const std::vector<CellPolygon>& polygons) {
    // An empty pattern ends at once, wherever the reader starts.
    if (polygons.empty()) return glm::uvec3(0x80808080u);
    glm::uvec3 words(0);
    unsigned count = 0, last = 0;
    for (const CellPolygon& polygon : polygons) {
        for (std::size_t i = 0; i < polygon.size(); ++i, ++count) {
            const unsigned code = codeOf(cellEdge(polygon[i]));
            words[count / 4] |= (code | (i == 0 ? 64u : 0u)) << count % 4 * 8;
            last = count;
        }
    }
    words[last / 4] |= 128u << last % 4 * 8;
    return words;
}

}  // namespace

const std::vector<CellPolygon>& cellPolygons(int pattern) {
    static const std::array<std::vector<CellPolygon>, 256> table = [] {
        std::array<std::vector<CellPolygon>, 256> made;
        for (int i = 0; i < 256; ++i) made[i] = derive(i);
        return made;
    }();
    assert(pattern >= 0 && pattern < 256);
    return table[pattern];
}

CellEdge cellEdge(int edge) {
    assert(edge >= 0 && edge < 12);
    unsigned b = edge & 1, c = edge >> 1 & 1;
    switch (edge >> 2) {
        case 0: return {{0, b, c}, 0};
        case 1: return {{b, 0, c}, 1};
        default: return {{b, c, 0}, 2};
    }
}

const std::array<glm::uvec3, 256>& packedCellPolygons() {
    static const std::array<glm::uvec3, 256> packed = [] {
        std::array<glm::uvec3, 256> made;
        for (int i = 0; i < 256; ++i) made[i] = pack(cellPolygons(i));
        return made;
    }();
    return packed;
}

const std::array<glm::uvec3, 256 * kMostCellPolygons>& packedCellPatches() {
    static const std::array<glm::uvec3, 256 * kMostCellPolygons> packed = [] {
        std::array<glm::uvec3, 256 * kMostCellPolygons> made{};
        for (int pattern = 0; pattern < 256; ++pattern) {
            const std::vector<CellPolygon>& polygons = cellPolygons(pattern);
            for (std::size_t i = 0; i < polygons.size(); ++i)
                made[std::size_t(pattern * kMostCellPolygons) + i] = packPatch(polygons[i]);
        }
        return made;
    }();
    return packed;
}

}  // namespace fw
