#include "runtime/export/tile_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <glm/common.hpp>
#include <memory>
#include <type_traits>

#include "runtime/mesh/octahedral.h"
#include "runtime/mesher/mesher.h"
#include "runtime/system/output_file.h"

namespace fw {
namespace {

static_assert(sizeof(TileHeader) == 152 && sizeof(PartHeader) == 24 && sizeof(SharedVertex) == 24);
static_assert(sizeof(gpu::MeshVertex) == 16 && std::is_trivially_copyable_v<TileHeader>);

Error damaged(const std::string& path, const char* what) {
    return {.message = std::string(what) + ": make it again", .file = path};
}

/// Where the arrays of a record begin, from its own beginning.
struct RecordLayout {
    uint64_t shared, vertices, colors, triangles, end;
};
RecordLayout layoutOf(const TileHeader& header) {
    RecordLayout at{};
    at.shared = sizeof header;
    at.vertices = at.shared + header.shared * sizeof(SharedVertex);
    at.colors = at.vertices + header.vertices * sizeof(gpu::MeshVertex);
    at.triangles = at.colors + (header.colors ? header.vertices * sizeof(glm::vec3) : 0);
    at.end = at.triangles + header.triangles * 12;
    return at;
}

/// `count` values at `offset` of a file.
template <class T>
Result<std::vector<T>> readArray(const std::string& path, uint64_t offset, uint64_t count) {
    std::ifstream file(path, std::ios::binary);
    std::vector<T> values(count);
    file.seekg(static_cast<std::streamoff>(offset));
    if (count > 0)
        file.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(count * sizeof(T)));
    if (!file) return damaged(path, "the file of tiles was cut short while it was read");
    return values;
}

constexpr uint64_t kPiece = 4u << 20;  // bytes read at once where all pass through

/// The checksum goes on over `bytes`, a multiple of four: any one word that is another makes it another. By
/// words and not bytes as hashBytes, for gigabytes pass through.
uint64_t summed(uint64_t checksum, const void* data, std::size_t bytes) {
    for (std::size_t at = 0; at < bytes; at += 4) {
        uint32_t word;
        std::memcpy(&word, static_cast<const char*>(data) + at, sizeof word);
        checksum = (checksum ^ word) * 0x9E3779B97F4A7C15u;
        checksum ^= checksum >> 32;
    }
    return checksum;
}
uint64_t summed(TileHeader header) {
    header.checksum = 0;
    return summed(0, &header, sizeof header);
}
template <class T>
uint64_t summed(uint64_t checksum, const std::vector<T>& values) {
    return summed(checksum, values.data(), values.size() * sizeof(T));
}

/// The record at `offset`, which must lie within the file's `size` bytes.
Result<TileRecord> recordAt(const std::string& path, uint64_t offset, uint64_t size) {
    if (offset > size || size - offset < sizeof(TileHeader)) return damaged(path, "the file is cut short");
    const Result<std::vector<TileHeader>> header = readArray<TileHeader>(path, offset, 1);
    if (!header) return header.error();
    const TileRecord record{path, offset, header->front()};
    const TileHeader& has = record.header;
    constexpr uint64_t kMost = uint64_t(1) << 40;  // so that sizes do not overflow
    if (std::memcmp(has.magic, TileHeader().magic, sizeof has.magic) != 0 || has.colors > 1 ||
        has.vertices > 0xffffffffu || has.shared > has.vertices || has.triangles > kMost)
        return damaged(path, "this is no file of tiles, or it is damaged");
    const uint64_t end = layoutOf(has).end;
    if (size - offset < end) return damaged(path, "the file is cut short");
    uint64_t checksum = summed(has);
    for (uint64_t at = sizeof has; at < end; at += kPiece) {
        const Result<std::vector<char>> bytes =
            readArray<char>(path, offset + at, std::min(kPiece, end - at));
        if (!bytes) return bytes.error();
        checksum = summed(checksum, *bytes);
    }
    if (checksum != has.checksum) return damaged(path, "the file is damaged");
    return record;
}

Result<uint64_t> sizeOf(const std::string& path) {
    std::error_code failure;
    const uint64_t size = std::filesystem::file_size(path, failure);
    if (failure) return Error{.message = "cannot read: " + failure.message(), .file = path};
    return size;
}

uint64_t bits(float value) {
    uint32_t word;
    std::memcpy(&word, &value, sizeof word);
    return word;
}

/// What `part` needs of the record.
Result<TileContent> readContent(const TileRecord& record, MeshPieces::Part part) {
    const std::string& path = record.path;
    const uint64_t offset = record.offset;
    const auto& header = record.header;
    const RecordLayout at = layoutOf(header);
    TileContent tile;
    tile.header = header;
    const auto read = [&]<class T>(std::vector<T>& to, uint64_t place, uint64_t count) -> Done {
        Result<std::vector<T>> values = readArray<T>(path, offset + place, count);
        if (!values) return values.error();
        to = std::move(*values);
        return done();
    };
    Done all = read(tile.vertices, at.vertices, header.vertices);
    if (all) all = read(tile.indices, at.triangles, header.triangles * 3);
    if (all && part == MeshPieces::numbered) all = read(tile.shared, at.shared, header.shared);
    if (all && part == MeshPieces::numbered && header.colors)
        all = read(tile.colors, at.colors, header.vertices);
    if (!all) return all.error();
    for (const uint32_t corner : tile.indices)
        if (corner >= header.vertices) return damaged(path, "the file is damaged");
    return tile;
}

}  // namespace

Done writeTile(TileContent& tile, const std::string& path, const std::atomic<bool>* cancel) {
    tile.header.vertices = tile.vertices.size();
    tile.header.triangles = tile.indices.size() / 3;
    tile.header.shared = tile.shared.size();
    tile.header.colors = tile.colors.empty() ? 0 : 1;
    tile.header.checksum = summed(
        summed(summed(summed(summed(tile.header), tile.shared), tile.vertices), tile.colors), tile.indices);
    Result<OutputFile> file = OutputFile::open(path, cancel);
    if (!file) return file.error();
    file->write(&tile.header, sizeof tile.header);
    file->write(std::span<const SharedVertex>(tile.shared));
    file->write(std::span<const gpu::MeshVertex>(tile.vertices));
    file->write(std::span<const glm::vec3>(tile.colors));
    file->write(std::span<const uint32_t>(tile.indices));
    return file->commit();
}

Result<TileRecord> readTile(const std::string& path) {
    const Result<uint64_t> size = sizeOf(path);
    if (!size) return size.error();
    Result<TileRecord> record = recordAt(path, 0, *size);
    if (record && layoutOf(record->header).end != *size) return damaged(path, "the file is damaged");
    return record;
}

std::pair<std::size_t, std::size_t> tilesOfShare(std::size_t tiles, uint32_t share, uint32_t shares) {
    return {tiles * (share - 1) / shares, tiles * share / shares};
}

Done writePart(const PartHeader& part, const std::vector<TileRecord>& tiles, const std::string& path,
               const std::atomic<bool>* cancel) {
    Result<OutputFile> file = OutputFile::open(path, cancel);
    if (!file) return file.error();
    file->write(&part, sizeof part);
    for (const TileRecord& tile : tiles) {
        const uint64_t end = layoutOf(tile.header).end;
        for (uint64_t at = 0; at < end && file->good(); at += kPiece) {
            const Result<std::vector<char>> bytes =
                readArray<char>(tile.path, tile.offset + at, std::min(kPiece, end - at));
            if (!bytes) return bytes.error();
            file->write(std::span<const char>(*bytes));
        }
    }
    return file->commit();
}

Result<std::vector<TileRecord>> readParts(const std::vector<std::string>& paths) {
    std::vector<TileRecord> tiles;
    std::vector<std::string> ofShare;  // the file that holds each
    PartHeader first;
    for (const std::string& path : paths) {
        const Result<uint64_t> size = sizeOf(path);
        if (!size) return size.error();
        Result<std::vector<PartHeader>> header = damaged(path, "the file is cut short");
        if (*size >= sizeof(PartHeader)) header = readArray<PartHeader>(path, 0, 1);
        if (!header) return header.error();
        const PartHeader& part = header->front();
        if (std::memcmp(part.magic, first.magic, sizeof first.magic) != 0 || part.share < 1 ||
            part.share > part.shares || part.shares > 1u << 20)
            return Error{.message = "this is not a part that export --tile wrote", .file = path};
        if (ofShare.empty()) first = part, ofShare.resize(part.shares);
        if (part.key != first.key || part.shares != first.shares)
            return Error{.message = "this part is of another mesh than " + paths.front() +
                                    ": the graph, its parameters, the resolution, the tiles, the number of "
                                    "parts, the device and "
                                    "the version must be the same for all",
                         .file = path};
        std::string& holder = ofShare[part.share - 1];
        if (!holder.empty())
            return Error{.message = "part " + std::to_string(part.share) + " is also in " + holder,
                         .file = path};
        holder = path;
        uint64_t offset = sizeof part;
        do {
            Result<TileRecord> tile = recordAt(path, offset, *size);
            if (!tile) return tile.error();
            if (tile->header.key != part.key) return damaged(path, "the file is damaged");
            offset += layoutOf(tile->header).end;
            tiles.push_back(std::move(*tile));
        } while (offset < *size);
        const auto [begin, end] = tilesOfShare(tiles.back().header.tiles, part.share, part.shares);
        if (tiles.back().header.tile + 1 < end) return damaged(path, "the file is cut short");
    }
    std::string missing;
    std::size_t missingCount = 0;
    for (std::size_t i = 0; i < ofShare.size(); ++i)
        if (ofShare[i].empty() && ++missingCount <= 20)
            missing += (missing.empty() ? "" : ", ") + std::to_string(i + 1);
    if (missingCount > 20) missing += ", …";
    if (missingCount > 0)
        return Error{.message = std::to_string(missingCount) + " of the " + std::to_string(ofShare.size()) +
                                " parts " + (missingCount == 1 ? "is" : "are") + " missing: " + missing};
    std::sort(tiles.begin(), tiles.end(),
              [](const TileRecord& a, const TileRecord& b) { return a.header.tile < b.header.tile; });
    for (std::size_t i = 0; i < tiles.size(); ++i)
        if (tiles[i].header.tile != i || tiles[i].header.tiles != tiles.size())
            return damaged(tiles[i].path, "the parts do not make up one mesh");
    return tiles;
}

std::size_t TileJoin::PlaceHash::operator()(const Place& place) const {
    const glm::vec3 p = place.position;
    uint64_t hash = bits(p.x) ^ uint64_t(place.copy) << 32;
    for (const uint64_t word : {bits(p.y), bits(p.z)})
        hash = (hash ^ hash >> 29) * 0x9E3779B97F4A7C15u + word;
    return (hash ^ hash >> 32) * 0xBF58476D1CE4E5B9u;
}

bool TileJoin::SameBits::operator()(const Place& a, const Place& b) const {
    return std::memcmp(&a, &b, sizeof a) == 0;
}

Result<TileNumbers> TileJoin::add(const TileHeader& header, std::span<const SharedVertex> shared,
                                  const std::string& path) {
    if (pieces.vertexCount + header.vertices > 0x7fffffffu)
        return Error{.message = "the mesh has more than 2,147,483,647 vertices; lower the resolution"};
    TileNumbers numbers{uint32_t(pieces.vertexCount), {}};
    numbers.shared.reserve(shared.size());
    uint32_t known = 0;
    for (const SharedVertex& vertex : shared) {
        if (vertex.vertex >= header.vertices || vertex.holders < 2)
            return damaged(path, "the file is damaged");
        const auto [at, isNew] =
            open.try_emplace(Place{vertex.position, vertex.copy},
                             Known{numbers.firstVertex + vertex.vertex - known, vertex.holders});
        known += isNew ? 0 : 1;
        numbers.shared.push_back(at->second.number);
        if (--at->second.left == 0) open.erase(at);
    }
    if (header.vertices > 0) {
        const bool first = pieces.vertexCount == 0;
        pieces.least = first ? header.least : glm::min(pieces.least, header.least);
        pieces.greatest = first ? header.greatest : glm::max(pieces.greatest, header.greatest);
        pieces.colors = header.colors != 0;
    }
    if (pieces.count++ == 0) {
        pieces.material.baseColor = header.baseColor;
        pieces.material.material = header.material;
    }
    pieces.size.volume += header.size.volume;
    pieces.size.area += header.size.area;
    pieces.vertexCount += header.vertices - known;
    pieces.triangleCount += header.triangles;
    return numbers;
}

Result<MeshPieces> TileJoin::end() const {
    if (open.empty()) return pieces;
    return Error{.message =
                     "the tiles do not fit together: the surface ends at a face between two of them. The "
                     "field's bounds are wrong there, or the devices compute differently; export without "
                     "tiles, or all parts on one kind of device"};
}

Mesh pieceOf(TileContent tile, const TileNumbers& numbers, MeshPieces::Part part) {
    Mesh mesh;
    mesh.baseColor = tile.header.baseColor;
    mesh.indices = std::move(tile.indices);
    if (part == MeshPieces::corners) {
        mesh.positions.reserve(tile.vertices.size());
        for (const gpu::MeshVertex& vertex : tile.vertices) mesh.positions.push_back(vertex.position);
        return mesh;
    }
    const auto known =
        std::ranges::count_if(numbers.shared, [&](uint32_t number) { return number < numbers.firstVertex; });
    const std::size_t own = tile.vertices.size() - std::size_t(known);
    mesh.positions.reserve(own);
    mesh.normals.reserve(own);
    if (!tile.colors.empty()) mesh.colors.reserve(own);
    std::vector<uint32_t> numberOf(tile.vertices.size());
    uint32_t next = numbers.firstVertex;
    std::size_t s = 0;
    for (uint32_t v = 0; v < tile.vertices.size(); ++v) {
        const bool isShared = s < tile.shared.size() && tile.shared[s].vertex == v;
        const uint32_t number = isShared ? numbers.shared[s++] : next;
        numberOf[v] = number;
        if (number < numbers.firstVertex) continue;  // a tile before has it
        ++next;
        mesh.positions.push_back(tile.vertices[v].position);
        mesh.normals.push_back(unpackOctahedral(tile.vertices[v].normal));
        if (!tile.colors.empty()) mesh.colors.push_back(tile.colors[v]);
    }
    for (uint32_t& corner : mesh.indices) corner = numberOf[corner];
    return mesh;
}

Result<MeshPieces> joinTiles(std::vector<TileRecord> tiles) {
    TileJoin join;
    std::vector<TileNumbers> numbers;
    for (const TileRecord& record : tiles) {
        const TileHeader& header = record.header;
        const Result<std::vector<SharedVertex>> shared =
            readArray<SharedVertex>(record.path, record.offset + layoutOf(header).shared, header.shared);
        if (!shared) return shared.error();
        Result<TileNumbers> added = join.add(header, *shared, record.path);
        if (!added) return added.error();
        numbers.push_back(std::move(*added));
    }
    Result<MeshPieces> pieces = join.end();
    if (!pieces) return pieces;
    const auto kept = std::make_shared<const std::pair<std::vector<TileRecord>, std::vector<TileNumbers>>>(
        std::move(tiles), std::move(numbers));
    pieces->load = [kept](std::size_t i, MeshPieces::Part part) -> Result<Mesh> {
        Result<TileContent> tile = readContent(kept->first[i], part);
        if (!tile) return tile.error();
        return pieceOf(std::move(*tile), kept->second[i], part);
    };
    return pieces;
}

}  // namespace fw
