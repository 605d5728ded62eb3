#include "runtime/mesher/quad_tiles.h"

#include "runtime/mesher/grid_edge.h"

namespace fw {

namespace {

uint8_t tileOf(const GridEdge& edge, const MesherTile& tile, glm::ivec3 cells) {
    int which = 0;
    for (int axis = 2; axis >= 0; --axis) {
        const int begin = tile.begin[axis] * kMesherBlock,
                  end = tile.end[axis] > 0 ? tile.end[axis] * kMesherBlock : cells[axis] + 3,
                  at = int(edge.start[axis]);
        const int least = at - (axis == int(edge.axis) ? 0 : 1);  // of the cells about it
        if ((begin > 0 && least < begin - kMesherBrick) || at >= end + kMesherBrick) return kNoTile;
        which = 3 * which + (at < begin ? 0 : at < end ? 1 : 2);
    }
    return uint8_t(which);
}

}  // namespace

std::vector<uint8_t> tilesOfTriangles(const Device& device, const MesherBuffers& buffers,
                                      const MesherResult& result, const MesherTile& tile, glm::ivec3 cells) {
    const auto words = download<uint32_t>(device, buffers.vertexList, result.quads),
               bricks = download<uint32_t>(device, buffers.brickList, result.bricks);
    std::vector<uint8_t> tiles;
    tiles.reserve(result.triangles);
    for (const uint32_t word : words)
        tiles.insert(tiles.end(), 2,
                     tileOf(unpackEdge(word, unpackBrick(bricks[slotOfEdge(word)])), tile, cells));
    for (const uint32_t quad : result.addedTo) tiles.push_back(tiles[2 * std::size_t(quad)]);
    return tiles;
}

}  // namespace fw
