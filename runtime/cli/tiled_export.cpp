#include "runtime/cli/tiled_export.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <utility>

#include "runtime/export/export.h"
#include "runtime/export/outputs.h"
#include "runtime/play/tiled_mesh.h"
#include "runtime/system/interruption.h"

namespace fw::cli {
namespace {

constexpr int kMostUntiled = 1024;  // cells along the longest side, unless the option asks for tiles
constexpr char kPartEnding[] = ".part";

struct Share {
    uint32_t share = 1, shares = 1;
};

/// Of "i/n", 1 to n.
std::optional<Share> readShare(const std::string& text) {
    Share share;
    const char* end = text.data() + text.size();
    const auto first = std::from_chars(text.data(), end, share.share);
    if (first.ec != std::errc() || first.ptr == end || *first.ptr != '/') return std::nullopt;
    const auto second = std::from_chars(first.ptr + 1, end, share.shares);
    if (second.ec != std::errc() || second.ptr != end || share.share < 1 || share.share > share.shares)
        return std::nullopt;
    return share;
}

/// Meshes tiles first to last (not of it) that are not there yet.
Result<std::vector<TileRecord>> meshTiles(Session& session, const MeshRequest& request, const TilePlan& plan,
                                          uint64_t key, std::pair<std::size_t, std::size_t> range,
                                          const std::string& folder, Progress& progress) {
    std::vector<TileRecord> tiles;
    const auto [first, last] = range;
    for (std::size_t i = first; i < last; ++i) {
        std::optional<TileRecord> done = doneTile(folder, plan, key, i);
        if (!done) {
            const std::string words =
                "tile " + std::to_string(i - first + 1) + " of " + std::to_string(last - first);
            progress.start("tile", int(20 + 60 * (i - first) / (last - first)), words.c_str());
            Result<TileRecord> meshed = meshTile(session, request, plan, key, i, folder, nullptr);
            if (!meshed) return meshed.error();
            done = std::move(*meshed);
        }
        tiles.push_back(std::move(*done));
    }
    return tiles;
}

std::string whatIsKept(const std::string& folder) {
    return "fieldwright: the tiles that are done are kept in " + inQuotes(folder) +
           ": the same command goes on from there\n";
}

/// The folder of the tiles, held against other processes that would write the same mesh.
class TileFolder {
  public:
    static Result<TileFolder> open(const std::string& path) {
        std::error_code failure;
        std::filesystem::create_directory(path, failure);
        const int descriptor = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
        if (descriptor < 0)
            return Error{
                .message = std::string("cannot make a folder for the tiles: ") + std::strerror(errno),
                .file = path};
        if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
            ::close(descriptor);
            return Error{.message =
                             "another command is writing this mesh's tiles: wait for it, or give "
                             "another output",
                         .file = path};
        }
        return TileFolder(descriptor);
    }
    TileFolder(TileFolder&& other) noexcept : descriptor(std::exchange(other.descriptor, -1)) {}
    ~TileFolder() {
        if (descriptor >= 0) ::close(descriptor);
    }

  private:
    explicit TileFolder(int opened) : descriptor(opened) {}
    int descriptor;
};

/// Has the pieces' loading shown as progress from 80 %: a format reads each about twice.
void showLoading(MeshPieces& mesh, const Progress& progress) {
    mesh.load = [load = mesh.load, &progress, all = 2 * mesh.count, loaded = std::size_t(0)](
                    std::size_t piece, MeshPieces::Part part) mutable {
        progress.show(80 + int(20 * std::min(loaded++, all - 1) / all));
        return load(piece, part);
    };
}

}  // namespace

void sayWhatIsKept(const std::string& folder) {
    std::error_code ignored;
    std::filesystem::remove(folder, ignored);  // only if it is empty
    if (std::filesystem::exists(folder, ignored)) std::fputs(whatIsKept(folder).c_str(), stderr);
}

Done checkTiledExport(const ExportOptions& options) {
    const auto refuse = [&](std::string message) {
        return Error{.message = std::move(message), .file = options.output};
    };
    if (!options.report.empty() || !options.required.empty())
        return refuse(
            "--report and --require hold the whole mesh in memory, which tiles are there to avoid: leave "
            "them out, "
            "or --tiles and --tile");
    if (options.manifold)
        return refuse(
            "--manifold holds the whole mesh in memory, which tiles are there to avoid: leave it out");
    if (options.share.empty()) return checkPiecesPath(options.output);
    if (!readShare(options.share))
        return refuse("--tile " + inQuotes(options.share) + ": write part i of n as i/n, from 1/n to n/n");
    if (!options.output.ends_with(kPartEnding))
        return refuse("with --tile the output is a part, not a mesh: name it with the ending .part");
    return done();
}

bool canBeTiled(const ExportOptions& options, const OpenedGraph& opened) {
    return opened.request.method != MeshMethod::dualContouring && opened.program.stages.empty() &&
           checkTiledExport(options);
}

bool wantsTiles(const ExportOptions& options, const OpenedGraph& opened) {
    return opened.request.resolution > kMostUntiled && canBeTiled(options, opened);
}

int exportTiles(const ExportOptions& options, OpenedGraph opened, Progress& progress) {
    if (const Done fine = checkTiledExport(options); !fine) return print(fine.error()), kBadUsage;
    if (opened.request.method == MeshMethod::dualContouring)
        return badInput(options.mesh, {.message = "dual contouring is not meshed in tiles: take --method "
                                                  "marching-cubes, or leave out --tiles and --tile"});
    if (!opened.program.stages.empty())
        return badInput(options.mesh,
                        {.message = "a mesh in tiles cannot be smoothed, subdivided or decimated: leave "
                                    "out --tiles and --tile, or connect the output to polygonize"});
    const Result<CellGrid> grid = cellGrid(opened.region, opened.request.resolution);
    if (!grid) return badInput(options.mesh, grid.error());
    const bool given = opened.request.region || opened.program.region;
    opened.request.region = opened.region;
    const Share share = readShare(options.share).value_or(Share{});
    const std::string folder = tilesFolder(options.output);

    progress.start("pipelines", 15, kCompiling);
    Session session(std::move(opened.device));
    session.setProgram(std::move(opened.program));
    whenEnded({"; no mesh was written", folder, whatIsKept(folder)});
    const Result<TileFolder> held = TileFolder::open(folder);
    if (!held) return print(held.error()), kSystemFailure;

    const int longest = std::max({grid->cells.x, grid->cells.y, grid->cells.z});
    const TilePlan plan = planTiles(*grid, options.tiles > 0 ? longest / options.tiles : kTileCells);
    if (share.shares > plan.tiles.size()) {
        sayWhatIsKept(folder);
        return print({.message = "too few tiles, " + std::to_string(plan.tiles.size()) + ", for " +
                                 std::to_string(share.shares) + " parts: ask for fewer parts or more --tiles",
                      .file = options.output}),
               kBadUsage;
    }
    const uint64_t key = tileKey(session, plan);
    Result<std::vector<TileRecord>> tiles =
        meshTiles(session, opened.request, plan, key,
                  tilesOfShare(plan.tiles.size(), share.share, share.shares), folder, progress);
    if (!tiles) {
        progress.finish();
        int status = kDone;
        if (tiles.error().code == Error::Code::tooMuchSurface)
            status = badInput(options.mesh, {.message = tiles.error().message + "; or take more --tiles"});
        else
            status = (print(tiles.error()), tiles.error().file.empty() ? kBadInput : kSystemFailure);
        sayWhatIsKept(folder);
        return status;
    }
    progress.start("write", 80);
    const bool capped = std::any_of(tiles->begin(), tiles->end(),
                                    [](const TileRecord& tile) { return tile.header.capped != 0; });
    const bool empty = std::all_of(tiles->begin(), tiles->end(),
                                   [](const TileRecord& tile) { return tile.header.triangles == 0; });
    if (!options.share.empty()) {
        PartHeader part{.key = key, .share = share.share, .shares = share.shares};
        if (const Done written = writePart(part, *tiles, options.output, nullptr); !written)
            return print(written.error()), sayWhatIsKept(folder), kSystemFailure;
    } else if (empty) {
        removeTiles(folder);
        return badInput(options.mesh, nothingToSee(given, opened.region, opened.request.resolution));
    } else {
        Result<MeshPieces> mesh = joinTiles(std::move(*tiles));
        if (!mesh) return removeTiles(folder), badInput(options.mesh, mesh.error());
        showLoading(*mesh, progress);
        const Result<ExportedFiles> written = exportPieces(*mesh, options.output);
        if (!written) return print(written.error()), sayWhatIsKept(folder), kSystemFailure;
    }
    progress.finish();
    removeTiles(folder);
    if (capped)
        std::fprintf(stderr, "%s: note: the surface leaves the region and was closed at its boundary\n",
                     options.output.c_str());
    return kDone;
}

int runMerge(const MergeOptions& options) {
    if (const Done known = checkPiecesPath(options.output); !known) return print(known.error()), kBadUsage;
    if (const Done kept = checkReplacesNone(options.parts, exportedPaths(options.output)); !kept)
        return print(kept.error()), kBadUsage;
    Progress progress;
    progress.start("read", 0);
    Result<std::vector<TileRecord>> tiles = readParts(options.parts);
    if (!tiles) return print(tiles.error()), kBadInput;
    Result<MeshPieces> mesh = joinTiles(std::move(*tiles));
    if (!mesh) return print(mesh.error()), kBadInput;
    if (mesh->triangleCount == 0)
        return print({.message = "the parts hold no triangle: the surface does not pass through the region",
                      .file = options.parts[0]}),
               kBadInput;
    progress.start("write", 80);
    showLoading(*mesh, progress);
    const Result<ExportedFiles> written = exportPieces(*mesh, options.output);
    if (!written) return print(written.error()), kSystemFailure;
    progress.finish();
    return kDone;
}

}  // namespace fw::cli
