#include "runtime/mesher/pinches.h"

#include <algorithm>
#include <array>
#include <compare>
#include <map>
#include <utility>

#include "runtime/mesher/grid_edge.h"

namespace fw {

namespace {

using gpu::MeshVertex;

/// The middle of one segment of such a face: the edge of the mesh across it, and the inside corner of the
/// face that the segment cuts off.
struct Segment {
    uint32_t low, high;  ///< vertices
    std::array<uint32_t, 3> inside;
    auto operator<=>(const Segment&) const = default;
};

using Triangle = std::array<uint32_t, 3>;

/// What the device wrote for an active edge: where it stands, and the quad around it.
struct Quad {
    std::array<uint32_t, 4> ring;  ///< vertices of the cells around it, in the order of the device
    std::array<bool, 4> twice;     ///< whether the patches of ring[i] and ring[i + 1] meet twice
    std::array<uint32_t, 3> inside;
    MeshVertex point;
    std::array<Triangle, 2> triangles;
};

/// Of each quad on the list its edge, and its two triangles.
std::vector<Quad> readQuads(const Device& device, const MesherBuffers& buffers,
                            const std::vector<uint32_t>& list) {
    std::vector<Quad> quads(list.size());
    std::vector<uint32_t> words(list.size()), bricks(list.size());
    std::vector<std::array<uint32_t, 4>> corners(list.size());
    std::vector<Piece> pieces;
    const auto read = [&]<class T>(const Buffer& buffer, T& value, std::size_t index) {
        pieces.push_back({buffer, &value, sizeof value, index * sizeof value});
    };
    for (std::size_t i = 0; i < list.size(); ++i) {
        read(buffers.vertexList, words[i], list[i]);
        read(buffers.corners, corners[i], list[i]);
        read(buffers.points, quads[i].point, list[i]);
        read(buffers.triangles, quads[i].triangles, list[i]);
    }
    downloadPieces(device, std::exchange(pieces, {}));
    for (std::size_t i = 0; i < list.size(); ++i) read(buffers.brickList, bricks[i], slotOfEdge(words[i]));
    downloadPieces(device, pieces);
    for (std::size_t i = 0; i < list.size(); ++i) {
        Quad& quad = quads[i];
        const std::array<uint32_t, 4> around = {corners[i][3], corners[i][2], corners[i][0], corners[i][1]};
        for (std::size_t k = 0; k < 4; ++k) {
            quad.ring[k] = around[k] & 0x3fffffffu;
            quad.twice[k] = (around[k] & around[(k + 1) % 4] & (k % 2 == 0 ? 1u << 30 : 1u << 31)) != 0;
        }
        const GridEdge grid = unpackEdge(words[i], unpackBrick(bricks[i]));
        quad.inside = {grid.start.x, grid.start.y, grid.start.z};
        if (!grid.insideAtStart) ++quad.inside[grid.axis];
    }
    return quads;
}

}  // namespace

Addition mostOfPinches(uint32_t quads) { return {2 * quads, 4 * quads}; }

Parting partPinches(const Device& device, MesherBuffers& buffers, const gpu::MesherCounts& counts) {
    std::vector<uint32_t> list = download<uint32_t>(device, buffers.pinched, counts.pinched);
    std::ranges::sort(list);
    std::vector<Quad> quads = readQuads(device, buffers, list);
    /// Of a segment whose two ends are known; one end's vertex until then.
    struct Middle {
        uint32_t vertex;
        MeshVertex at;
        uint32_t colored;  ///< the vertex whose colour it takes
        bool whole = false;
    };
    std::map<Segment, Middle> middles;
    std::vector<Triangle> more;
    Parting parting;
    for (std::size_t q = 0; q < list.size(); ++q) {
        Quad& quad = quads[q];
        std::vector<Triangle> triangles(quad.triangles.begin(), quad.triangles.end());
        for (std::size_t i = 0; i < 4; ++i) {
            if (!quad.twice[i]) continue;
            const uint32_t a = quad.ring[i], b = quad.ring[(i + 1) % 4];
            const auto [found, isNew] =
                middles.try_emplace({std::min(a, b), std::max(a, b), quad.inside},
                                    Middle{counts.vertices + uint32_t(middles.size()), quad.point, a});
            Middle& middle = found->second;
            if (!isNew) {  // the other edge that the segment ends on
                middle.at.position = 0.5f * (middle.at.position + quad.point.position);
                middle.colored = a;
                middle.whole = true;
            }
            // The triangle with that side becomes two.
            for (std::size_t t = 0, was = triangles.size(); t < was; ++t)
                for (std::size_t k = 0; k < 3; ++k) {
                    const uint32_t from = triangles[t][k], to = triangles[t][(k + 1) % 3];
                    if ((from != a || to != b) && (from != b || to != a)) continue;
                    triangles.push_back({middle.vertex, to, triangles[t][(k + 2) % 3]});
                    triangles[t][(k + 1) % 3] = middle.vertex;
                }
        }
        std::copy_n(triangles.begin(), 2, quad.triangles.begin());
        more.insert(more.end(), triangles.begin() + 2, triangles.end());
        parting.quads.resize(more.size(), list[q]);
    }
    std::vector<glm::vec3> colors(buffers.colors ? middles.size() : 0);
    std::vector<Piece> read;
    std::vector<ConstPiece> written;
    for (const auto& [segment, middle] : middles) {
        if (!middle.whole) continue;
        written.push_back({buffers.vertices, &middle.at, sizeof middle.at, middle.vertex * sizeof middle.at});
        if (!buffers.colors) continue;
        glm::vec3& color = colors[middle.vertex - counts.vertices];
        read.push_back({buffers.colors, &color, sizeof color, middle.colored * sizeof color});
        written.push_back({buffers.colors, &color, sizeof color, middle.vertex * sizeof color});
    }
    downloadPieces(device, read);
    for (std::size_t q = 0; q < list.size(); ++q)
        written.push_back({buffers.triangles, &quads[q].triangles, sizeof quads[q].triangles,
                           list[q] * sizeof quads[q].triangles});
    written.push_back({buffers.triangles, more.data(), more.size() * sizeof(Triangle),
                       counts.triangles * sizeof(Triangle)});
    uploadPieces(device, written);
    parting.vertices = uint32_t(middles.size());
    return parting;
}

}  // namespace fw
