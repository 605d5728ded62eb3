#include "runtime/play/tiled_mesh.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <glm/common.hpp>
#include <limits>

#include "graph/emit/glsl.h"
#include "runtime/mesh/creases.h"
#include "runtime/mesh/octahedral.h"
#include "runtime/mesher/quad_tiles.h"
#include "runtime/system/cache_file.h"

namespace fw {
namespace {

struct Hash {
    uint64_t value = hashBytes(nullptr, 0);
    void add(const void* data, std::size_t size) { value = hashBytes(data, size, value); }
    template <class T>
    void add(const std::vector<T>& values) {
        const uint64_t count = values.size();
        add(&count, sizeof count);
        add(values.data(), values.size() * sizeof(T));
    }
    void add(const std::string& text) { add(std::vector<char>(text.begin(), text.end())); }
};

/// Faces between tiles, as coordinates. A vertex on one stands there to the last bit or the one before; all
/// others keep eight of those away (mesher.h).
struct Faces {
    std::vector<float> at[3];
    float within;

    uint32_t count(glm::vec3 p) const {
        uint32_t faces = 0;
        for (int axis = 0; axis < 3; ++axis)
            for (const float face : at[axis]) faces += std::abs(p[axis] - face) <= within ? 1 : 0;
        return faces;
    }
};

Faces facesOf(const TilePlan& plan, std::size_t index) {
    const MesherTile& tile = plan.tiles[index];
    const glm::vec3 low = plan.grid.origin, high = low + plan.grid.cellSize * glm::vec3(plan.grid.cells);
    const glm::vec3 reach = glm::max(glm::abs(low), glm::abs(high));
    const float largest = std::max({reach.x, reach.y, reach.z});
    Faces faces{{}, 2 * (std::nextafter(largest, std::numeric_limits<float>::infinity()) - largest)};
    for (int axis = 0; axis < 3; ++axis)
        for (const int block : {tile.begin[axis], tile.end[axis]})
            if (block > 0)
                faces.at[axis].push_back(low[axis] +
                                         float(block * kMesherBlock - 1) * plan.grid.cellSize[axis]);
    return faces;
}

/// Adds the triangles to the header's numbers.
void lookAtTriangles(TileContent& tile, std::span<const gpu::MeshVertex> vertices) {
    const auto corner = [&](std::size_t i) { return vertices[tile.indices[i]].position; };
    for (std::size_t i = 0; i < tile.indices.size(); i += 3)
        tile.header.size.add(corner(i), corner(i + 1), corner(i + 2));
}

/// The numbers in the header.
Done lookAtVertices(TileContent& tile, std::span<const gpu::MeshVertex> vertices) {
    if (!vertices.empty()) tile.header.least = tile.header.greatest = vertices[0].position;
    glm::vec3 poison(0.0f);
    for (const auto& [p, normal] : vertices) {
        tile.header.least = glm::min(tile.header.least, p);
        tile.header.greatest = glm::max(tile.header.greatest, p);
        poison += p * 0.0f;  // NaN if it is not finite
    }
    if (poison == glm::vec3(0.0f)) return done();
    return Error{.message =
                     "the mesh has a vertex that is not finite; the field is infinite or undefined there"};
}

/// Which of the vertices at its place this one is: splitCreases() puts copies behind all, place by place.
uint32_t copyOf(const MesherResult& meshed, const Mesh& mesh, std::size_t v) {
    if (v < meshed.vertices) return 0;
    std::size_t first = v;
    while (first > meshed.vertices && mesh.positions[first - 1] == mesh.positions[v]) --first;
    return uint32_t(v - first) + 1;
}

/// The whole of what was meshed: by marching cubes that is the tile's own.
Done takeAll(const Session& session, const MesherResult& meshed, const TilePlan& plan, TileContent& tile,
             bool arrays) {
    const MesherBuffers& buffers = session.meshBuffers();
    const auto vertices = look(session.device(), buffers.vertices, meshed.vertices, tile.vertices);
    if (arrays && tile.vertices.empty()) tile.vertices.assign(vertices.begin(), vertices.end());
    const bool transmits = tile.header.material.transmission > 0.0f;
    if (arrays || transmits)
        tile.indices = download<uint32_t>(session.device(), buffers.triangles, meshed.triangles * 3);
    if (transmits) lookAtTriangles(tile, vertices);
    if (!arrays) tile.indices.clear();
    if (arrays && tile.header.colors)
        tile.colors = download<glm::vec3>(session.device(), buffers.colors, meshed.vertices);
    tile.header.vertices = meshed.vertices;
    tile.header.triangles = meshed.triangles;
    const Faces faces = facesOf(plan, tile.header.tile);
    for (std::size_t v = 0; v < vertices.size(); ++v)
        if (const uint32_t count = faces.count(vertices[v].position))
            tile.shared.push_back({uint32_t(v), 1u << count, vertices[v].position});
    return lookAtVertices(tile, vertices);
}

/// Of what was meshed by dual contouring the tile's own, with its creases.
Done takeOwn(const Session& session, const MesherResult& meshed, const TilePlan& plan, TileContent& tile,
             bool arrays) {
    Mesh mesh = downloadMesh(session.device(), session.meshBuffers(), meshed);
    std::vector<uint8_t> tiles = tilesOfTriangles(session.device(), session.meshBuffers(), meshed,
                                                  plan.tiles[tile.header.tile], plan.grid.cells);
    std::size_t whole = 0;
    for (std::size_t t = 0; t < tiles.size(); ++t) {
        if (tiles[t] == kNoTile) continue;
        std::copy_n(&mesh.indices[3 * t], 3, &mesh.indices[3 * whole]);
        tiles[whole++] = tiles[t];
    }
    mesh.indices.resize(3 * whole);
    splitCreases(mesh);

    std::vector<uint32_t> holders(mesh.positions.size());  // tiles that have a vertex, a bit each
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) holders[mesh.indices[i]] |= 1u << tiles[i / 3];
    std::vector<uint32_t> numbers(mesh.positions.size());
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        if ((holders[v] >> kOwnTile & 1) == 0) continue;
        numbers[v] = uint32_t(tile.vertices.size());
        if (const auto count = uint32_t(std::popcount(holders[v])); count > 1)
            tile.shared.push_back({numbers[v], count, mesh.positions[v], copyOf(meshed, mesh, v)});
        tile.vertices.push_back({mesh.positions[v], packOctahedral(mesh.normals[v])});
        if (tile.header.colors) tile.colors.push_back(mesh.colors[v]);
    }
    for (std::size_t i = 0; i < mesh.indices.size(); ++i)
        if (tiles[i / 3] == kOwnTile) tile.indices.push_back(numbers[mesh.indices[i]]);
    tile.header.vertices = tile.vertices.size();
    tile.header.triangles = tile.indices.size() / 3;
    if (tile.header.material.transmission > 0.0f) lookAtTriangles(tile, tile.vertices);
    const Done fine = lookAtVertices(tile, tile.vertices);
    if (!arrays) tile.vertices.clear(), tile.colors.clear(), tile.indices.clear();
    return fine;
}

/// Meshes the tile; without `arrays` its vertices, colours and triangles are only counted.
Result<TileContent> contentOf(Session& session, const MeshRequest& request, const TilePlan& plan,
                              std::size_t index, bool arrays) {
    MeshRequest ofTile = request;
    ofTile.tile = plan.tiles[index];
    const Result<MesherResult> meshed = session.polygonise(ofTile);
    if (!meshed) return meshed.error();
    TileContent tile;
    tile.header.tile = uint32_t(index);
    tile.header.tiles = uint32_t(plan.tiles.size());
    tile.header.capped = meshed->capped ? 1 : 0;
    tile.header.colors = meshed->colors ? 1 : 0;
    tile.header.baseColor = session.baseColor();
    tile.header.material = session.material();

    const Done fine = meshed->method == MeshMethod::dualContouring
                          ? takeOwn(session, *meshed, plan, tile, arrays)
                          : takeAll(session, *meshed, plan, tile, arrays);
    if (!fine) return fine.error();
    if (tile.header.vertices == 0) tile.header.colors = 0;
    return tile;
}

}  // namespace

Done checkTiles(const Program& program) {
    if (!program.stages.empty())
        return Error{
            .message =
                "a mesh in tiles cannot be smoothed, subdivided, decimated or rid of crumbs: connect the "
                "output to polygonize"};
    return done();
}

TilePlan planTiles(const CellGrid& grid, int tileCells) {
    tileCells = std::max(1, (tileCells + kMesherBlock / 2) / kMesherBlock) * kMesherBlock;
    TilePlan plan{grid, tileCells, {}};
    glm::ivec3 count;
    for (int axis = 0; axis < 3; ++axis)
        count[axis] = std::max(1, (grid.cells[axis] + tileCells / 2) / tileCells);
    const int step = tileCells / kMesherBlock;
    for (int z = 0; z < count.z; ++z)
        for (int y = 0; y < count.y; ++y)
            for (int x = 0; x < count.x; ++x) {
                const glm::ivec3 at(x, y, z);
                MesherTile tile{at * step, {}};
                for (int axis = 0; axis < 3; ++axis)
                    tile.end[axis] = at[axis] + 1 < count[axis] ? (at[axis] + 1) * step : 0;
                plan.tiles.push_back(tile);
            }
    return plan;
}

uint64_t tileKey(const Session& session, const MeshRequest& request, const TilePlan& plan,
                 uint32_t algorithms) {
    const Program& program = session.program();
    Hash hash;
    hash.add(std::string(FIELDWRIGHT_VERSION));
    hash.add(&algorithms, sizeof algorithms);
    hash.add(session.device().name());
    hash.add(emitField(program));
    hash.add(program.parameters());
    hash.add(imageWords(program.ir.images()));
    for (const FieldVolumePtr& volume : program.ir.volumes()) hash.add(volume->words);
    for (const OutlinePtr& outline : program.ir.outlines()) hash.add(outline->texels);
    for (const SplineTablePtr& spline : program.ir.splines()) hash.add(spline->texels);
    for (const Family& family : program.families.all) hash.add(family.table);
    const glm::vec3 baseColor = session.baseColor();
    const Material material = session.material();
    hash.add(&baseColor, sizeof baseColor);
    hash.add(&material, sizeof material);
    const MeshMethod method = request.method.value_or(program.method);
    hash.add(&method, sizeof method);
    hash.add(&plan.grid, sizeof plan.grid);
    hash.add(&plan.tileCells, sizeof plan.tileCells);
    return hash.value;
}

std::string tilePath(const std::string& folder, const TilePlan& plan, std::size_t index) {
    char name[48];
    std::snprintf(name, sizeof name, "%d-%06zu.tile", plan.tileCells, index);
    return (std::filesystem::path(folder) / name).string();
}

std::optional<TileRecord> doneTile(const std::string& folder, const TilePlan& plan, uint64_t key,
                                   std::size_t index) {
    const Result<TileRecord> tile = readTile(tilePath(folder, plan, index));
    if (!tile || tile->header.key != key || tile->header.tile != index ||
        tile->header.tiles != plan.tiles.size())
        return std::nullopt;
    return *tile;
}

Result<TileRecord> meshTile(Session& session, const MeshRequest& request, const TilePlan& plan, uint64_t key,
                            std::size_t index, const std::string& folder, const std::atomic<bool>* cancel) {
    Result<TileContent> tile = contentOf(session, request, plan, index, true);
    if (!tile) return tile.error();
    tile->header.key = key;
    const std::string path = tilePath(folder, plan, index);
    if (const Done written = writeTile(*tile, path, cancel); !written) return written.error();
    return TileRecord{path, 0, tile->header};
}

Result<CountedTiles> countTiles(Session& session, const MeshRequest& request, const TilePlan& plan,
                                const std::function<bool(std::size_t tile)>& counting) {
    TileJoin join;
    std::vector<TileNumbers> numbers;
    std::vector<bool> empty;
    bool capped = false;
    for (std::size_t i = 0; i < plan.tiles.size(); ++i) {
        if (counting && !counting(i)) return Error{.message = "cancelled; nothing was written"};
        const Result<TileContent> tile = contentOf(session, request, plan, i, false);
        if (!tile) return tile.error();
        capped = capped || tile->header.capped != 0;
        empty.push_back(tile->header.vertices == 0);
        Result<TileNumbers> added = join.add(tile->header, tile->shared);
        if (!added) return added.error();
        numbers.push_back(std::move(*added));
    }
    Result<MeshPieces> pieces = join.end();
    if (!pieces) return pieces.error();
    pieces->load = [&session, request, plan, numbers = std::move(numbers), empty = std::move(empty)](
                       std::size_t i, MeshPieces::Part part) -> Result<Mesh> {
        if (empty[i]) return Mesh{};
        Result<TileContent> tile = contentOf(session, request, plan, i, true);
        if (!tile) return tile.error();
        if (tile->shared.size() != numbers[i].shared.size())
            return Error{.message = "the mesh was another when it was made again; run the command again"};
        return pieceOf(std::move(*tile), numbers[i], part);
    };
    return CountedTiles{std::move(*pieces), capped};
}

void removeTiles(const std::string& folder) {
    std::error_code ignored;
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder, ignored))
        if (const std::string name = entry.path().filename().string();
            name.ends_with(".tile") || (name.find(".tile.") != name.npos && name.ends_with(".tmp")))
            files.push_back(entry.path());
    for (const auto& file : files) std::filesystem::remove(file, ignored);
    std::filesystem::remove(folder, ignored);  // fails where something else is in it
}

}  // namespace fw
