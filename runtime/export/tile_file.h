// Tiles of a mesh on disk, and how they become one mesh again.
//
// A tile is a record: a TileHeader, its vertices that other tiles have too, all its vertices, their colours,
// its triangles. A tile's file holds one record; a part, which shares out the work on one mesh, is a
// PartHeader and the records of consecutive tiles. Numbers are as in memory, little-endian.
//
// Joining, of tiles from files and of those that are counted first and meshed again (play/tiled_mesh.h):
// neighbours hold a vertex on their common face, or by dual contouring beside it, each, with equal bits. The
// first tile in order keeps it. Only those vertices are numbered through a table of positions, and one is
// dropped from it with the last tile that holds it; what is kept is four bytes for each time a tile has one.
// A table that is not empty in the end means a hole: tiles that do not belong together, or a field whose
// bounds are wrong.
//
// Nothing read is trusted: sizes are checked against the file's, indices against the sizes, bytes against the
// record's checksum.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "graph/base/result.h"
#include "runtime/export/export.h"
#include "runtime/mesh/materials.h"
#include "shaders/shared.h"

namespace fw {

struct TileHeader {
    char magic[8] = {'F', 'W', 'T', 'I', 'L', 'E', '4', 0};
    uint64_t key = 0;       ///< equal for tiles of one mesh
    uint64_t checksum = 0;  ///< of the whole record, this taken for 0
    uint32_t tile = 0, tiles = 0;
    uint64_t vertices = 0, triangles = 0, shared = 0;
    SolidSize size;                   ///< of its triangles, if light passes through the solid; else 0
    uint16_t capped = 0, colors = 0;  ///< 0 or 1
    glm::vec3 least{0}, greatest{0};  ///< coordinates, if there are vertices
    glm::vec3 baseColor{0};
    Material material;
};

/// A vertex that several tiles have.
struct SharedVertex {
    uint32_t vertex = 0;   ///< of the tile; ascending
    uint32_t holders = 0;  ///< tiles that have it
    glm::vec3 position{0};
    uint32_t copy = 0;  ///< which of those at this place: those on creases are several
};

struct TileContent {
    TileHeader header;  ///< its counts are set from the arrays
    std::vector<SharedVertex> shared;
    std::vector<gpu::MeshVertex> vertices;
    std::vector<glm::vec3> colors;
    std::vector<uint32_t> indices;
};

/// Which vertices of the one mesh are a tile's.
struct TileNumbers {
    uint32_t firstVertex = 0;      ///< of those that no tile before it has; the tile's others follow in order
    std::vector<uint32_t> shared;  ///< of each of its shared vertices
};

/// Numbers the vertices of the tiles of one mesh, which are given in order.
class TileJoin {
  public:
    /// Errors: a damaged tile, whose file is `path`; too many vertices.
    Result<TileNumbers> add(const TileHeader& header, std::span<const SharedVertex> shared,
                            const std::string& path = {});
    /// What the one mesh is, without its pieces. Error: a hole.
    Result<MeshPieces> end() const;

  private:
    struct Known {
        uint32_t number, left;
    };
    struct Place {
        glm::vec3 position;
        uint32_t copy;
    };
    struct PlaceHash {
        std::size_t operator()(const Place& place) const;
    };
    struct SameBits {
        bool operator()(const Place& a, const Place& b) const;
    };
    std::unordered_map<Place, Known, PlaceHash, SameBits> open;
    MeshPieces pieces;
};

/// The tile as a piece of the one mesh. Its indices must be below its number of vertices.
Mesh pieceOf(TileContent tile, const TileNumbers& numbers, MeshPieces::Part part);

/// Where a record is.
struct TileRecord {
    std::string path;
    uint64_t offset = 0;
    TileHeader header;
};

Done writeTile(TileContent& tile, const std::string& path, const std::atomic<bool>* cancel);
/// Errors: no file, not a tile, cut short, damaged.
Result<TileRecord> readTile(const std::string& path);

struct PartHeader {
    char magic[8] = {'F', 'W', 'P', 'A', 'R', 'T', '2', 0};
    uint64_t key = 0;
    uint32_t share = 0, shares = 0;  ///< from 1
};

/// Tiles first to last (not of it) are those of share 1 to `shares` out of `tiles`.
std::pair<std::size_t, std::size_t> tilesOfShare(std::size_t tiles, uint32_t share, uint32_t shares);

/// Puts the tiles' records behind each other.
Done writePart(const PartHeader& part, const std::vector<TileRecord>& tiles, const std::string& path,
               const std::atomic<bool>* cancel);
/// The tiles of these parts, all of one mesh, in order. Errors: what readTile says, parts of different
/// meshes, one given twice, missing ones, which it names.
Result<std::vector<TileRecord>> readParts(const std::vector<std::string>& paths);

/// The one mesh of all tiles, in order. `tiles` is not empty. Errors: a hole, too many vertices.
Result<MeshPieces> joinTiles(std::vector<TileRecord> tiles);

}  // namespace fw
