#include "runtime/mesher/pinches.h"

#include <algorithm>
#include <array>
#include <compare>
#include <map>

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

/// What the device wrote for an active edge, and where it stands.
struct Edge {
    uint32_t index;
    std::array<uint32_t, 4> ring;  ///< vertices of the cells around it, in the order of the device
    std::array<bool, 4> twice;     ///< whether the patches of ring[i] and ring[i + 1] meet twice
    std::array<uint32_t, 3> inside;
    MeshVertex point;
};

template <class T>
T at(const Device& device, const Buffer& buffer, std::size_t index) {
    T value;
    downloadBytes(device, buffer, &value, sizeof value, index * sizeof value);
    return value;
}

Edge readEdge(const Device& device, const MesherBuffers& buffers, uint32_t index) {
    Edge edge{.index = index, .ring = {}, .twice = {}, .inside = {}, .point = {}};
    const auto word = at<uint32_t>(device, buffers.vertexList, index);
    const auto corners = at<std::array<uint32_t, 4>>(device, buffers.corners, index);
    const std::array<uint32_t, 4> around = {corners[3], corners[2], corners[0], corners[1]};
    for (std::size_t i = 0; i < 4; ++i) {
        edge.ring[i] = around[i] & 0x3fffffffu;
        edge.twice[i] = (around[i] & around[(i + 1) % 4] & (i % 2 == 0 ? 1u << 30 : 1u << 31)) != 0;
    }
    const GridEdge grid =
        unpackEdge(word, unpackBrick(at<uint32_t>(device, buffers.brickList, slotOfEdge(word))));
    edge.inside = {grid.start.x, grid.start.y, grid.start.z};
    if (!grid.insideAtStart) ++edge.inside[grid.axis];
    edge.point = at<MeshVertex>(device, buffers.points, index);
    return edge;
}

}  // namespace

Addition mostOfPinches(uint32_t quads) { return {2 * quads, 4 * quads}; }

Parting partPinches(const Device& device, MesherBuffers& buffers, const gpu::MesherCounts& counts) {
    std::vector<uint32_t> list = download<uint32_t>(device, buffers.pinched, counts.pinched);
    std::ranges::sort(list);
    using Triangle = std::array<uint32_t, 3>;
    struct Middle {
        uint32_t vertex;
        MeshVertex first;
    };
    std::map<Segment, Middle> middles;
    std::vector<Triangle> more;
    Parting parting;
    for (const uint32_t index : list) {
        const Edge edge = readEdge(device, buffers, index);
        std::vector<Triangle> triangles = {at<Triangle>(device, buffers.triangles, 2 * index),
                                           at<Triangle>(device, buffers.triangles, 2 * index + 1)};
        for (std::size_t i = 0; i < 4; ++i) {
            if (!edge.twice[i]) continue;
            const uint32_t a = edge.ring[i], b = edge.ring[(i + 1) % 4];
            const auto [found, isNew] =
                middles.try_emplace({std::min(a, b), std::max(a, b), edge.inside},
                                    Middle{counts.vertices + uint32_t(middles.size()), edge.point});
            const uint32_t middle = found->second.vertex;
            if (!isNew) {  // the other edge that the segment ends on
                MeshVertex vertex = found->second.first;
                vertex.position = 0.5f * (vertex.position + edge.point.position);
                uploadBytes(device, buffers.vertices, &vertex, sizeof vertex, middle * sizeof vertex);
                if (buffers.colors) {
                    const auto color = at<glm::vec3>(device, buffers.colors, a);
                    uploadBytes(device, buffers.colors, &color, sizeof color, middle * sizeof color);
                }
            }
            // The triangle with that side becomes two.
            for (std::size_t t = 0, was = triangles.size(); t < was; ++t)
                for (std::size_t k = 0; k < 3; ++k) {
                    const uint32_t from = triangles[t][k], to = triangles[t][(k + 1) % 3];
                    if ((from != a || to != b) && (from != b || to != a)) continue;
                    triangles.push_back({middle, to, triangles[t][(k + 2) % 3]});
                    triangles[t][(k + 1) % 3] = middle;
                }
        }
        uploadBytes(device, buffers.triangles, triangles.data(), 2 * sizeof(Triangle),
                    2 * index * sizeof(Triangle));
        more.insert(more.end(), triangles.begin() + 2, triangles.end());
        parting.quads.resize(more.size(), index);
    }
    uploadBytes(device, buffers.triangles, more.data(), more.size() * sizeof(Triangle),
                counts.triangles * sizeof(Triangle));
    parting.vertices = uint32_t(middles.size());
    return parting;
}

}  // namespace fw
