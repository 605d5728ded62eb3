#include "runtime/cli/tiled_export.h"

#include <fcntl.h>
#include <malloc.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <utility>

#include "runtime/cli/measured.h"
#include "runtime/export/export.h"
#include "runtime/export/outputs.h"
#include "runtime/play/tiled_mesh.h"
#include "runtime/system/interruption.h"

namespace fw::cli {
namespace {

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

/// Has the pieces' loading shown as progress from `begin` %: each is loaded once.
void showLoading(MeshPieces& mesh, const Progress& progress, int begin) {
    mesh.load = [load = mesh.load, &progress, begin, all = mesh.count](std::size_t piece,
                                                                       MeshPieces::Part part) {
        progress.show(begin + int((100 - begin) * piece / all));
        return load(piece, part);
    };
}

void noteCapped(const ExportOptions& options) {
    std::fprintf(stderr, "%s: note: the surface leaves the region and was closed at its boundary\n",
                 options.output.c_str());
}

int notMeshed(const ExportOptions& options, const Error& error) {
    if (error.code == Error::Code::tooMuchSurface)
        return badInput(options.mesh, {.message = error.message + "; or take more --tiles"});
    return print(error), error.file.empty() ? kBadInput : kSystemFailure;
}

/// Writes the mesh, and measures it where that is asked; the exit status. Of the progress it takes what is
/// behind `begin` %.
int writePieces(const MeshOutput& options, MeshPieces& mesh, const MeshedFrom& from, bool capped, int begin,
                Progress& progress) {
    if (options.measured())
        if (const Done fits = checkMeasurable(mesh.triangleCount, freeMemoryBytes()); !fits) {
            Error error = fits.error();
            error.file = options.output;
            return progress.finish(), print(error), kSystemFailure;
        }
    progress.start("write", begin);
    showLoading(mesh, progress, begin);
    Report report;
    fw::ExportOptions how{.placement = from.placement};
    how.examine = measuring(options, from, &progress, report);
    how.kept = [] { whenEnded({.said = "; the mesh was written"}); };
    const Result<ExportedFiles> written = exportPieces(mesh, options.output, how);
    progress.finish();
    if (!written) return print(written.error()), kSystemFailure;
    report.capped = capped;
    return tellReport(options, report);
}

/// All tiles straight into the mesh file.
int exportWhole(const ExportOptions& options, Session& session, const MeshRequest& request,
                const TilePlan& plan, const MeshedFrom& from, bool givenRegion, Progress& progress) {
    // A tile's arrays go back to the system with the tile: by itself the allocator would keep some of each
    // thread.
    ::mallopt(M_MMAP_THRESHOLD, 4 << 20);
    progress.start("count", 20);
    Result<CountedTiles> tiles = countTiles(session, request, plan, [&](std::size_t tile) {
        const std::string words =
            "tile " + std::to_string(tile + 1) + " of " + std::to_string(plan.tiles.size());
        progress.start("count", int(20 + 30 * tile / plan.tiles.size()), words.c_str());
        return true;
    });
    if (!tiles) return progress.finish(), notMeshed(options, tiles.error());
    if (tiles->mesh.triangleCount == 0)
        return badInput(options.mesh, nothingToSee(givenRegion, *request.region, request.resolution));
    const int status = writePieces(options, tiles->mesh, from, tiles->capped, 50, progress);
    if (tiles->capped && status != kSystemFailure) noteCapped(options);
    return status;
}

/// The tiles of a share, one after another into a folder, then into the part.
int exportPart(const ExportOptions& options, Session& session, const MeshRequest& request,
               const TilePlan& plan, const Share& share, Progress& progress) {
    const std::string folder = options.output + ".tiles";
    whenEnded({"; no mesh was written", folder, whatIsKept(folder)});
    const Result<TileFolder> held = TileFolder::open(folder);
    if (!held) return print(held.error()), kSystemFailure;
    const uint64_t key = tileKey(session, request, plan);
    const Result<std::vector<TileRecord>> tiles =
        meshTiles(session, request, plan, key, tilesOfShare(plan.tiles.size(), share.share, share.shares),
                  folder, progress);
    if (!tiles) {
        progress.finish();
        const int status = notMeshed(options, tiles.error());
        return sayWhatIsKept(folder), status;
    }
    progress.start("write", 80);
    const PartHeader part{.key = key, .share = share.share, .shares = share.shares};
    if (const Done written = writePart(part, *tiles, options.output, nullptr); !written)
        return print(written.error()), sayWhatIsKept(folder), kSystemFailure;
    progress.finish();
    removeTiles(folder);
    if (std::ranges::any_of(*tiles, [](const TileRecord& tile) { return tile.header.capped != 0; }))
        noteCapped(options);
    return kDone;
}

int noField(const std::string& output) {
    print({.message = "error= and complete are checked against the field, which parts do not hold: give "
                      "them to fieldwright export of the whole mesh",
           .file = output});
    return kBadUsage;
}

TilePlan tilesOf(const ExportOptions& options, const CellGrid& grid) {
    const int longest = std::max({grid.cells.x, grid.cells.y, grid.cells.z});
    return planTiles(grid, options.tiles > 0 ? longest / options.tiles : kTileCells);
}

int tooFewTiles(const ExportOptions& options, const TilePlan& plan, uint32_t shares) {
    print({.message =
               "too few tiles, " + std::to_string(plan.tiles.size()) + ", for " + std::to_string(shares) +
               " parts: ask for fewer parts, more --tiles, or a higher --resolution (a tile has 64 cells a "
               "side, or more)",
           .file = options.output});
    return kBadUsage;
}

int otherUnit(const ExportOptions& options, const OpenedGraph& opened, const char* leaveOut) {
    print({.message = "a part does not hold the document's unit, " + std::string(opened.unit.words) +
                      ": export without " + leaveOut,
           .file = options.output});
    return kBadUsage;
}

int notTiled(const ExportOptions& options, const Error& why, const char* leaveOut) {
    return badInput(options.mesh, {.message = why.message + ", or leave out " + leaveOut});
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
    if (const Done fine = checkTilesWish(options, options.output); !fine) return fine;
    if (options.share.empty()) return checkPiecesPath(options.output);
    if (!options.placement.isNone())
        return refuse("a part is in the document's unit and +Y up: leave out --unit, --up and --for");
    if (options.measured())
        return refuse("a part is no mesh to measure: give --report and --require to fieldwright merge");
    if (!readShare(options.share))
        return refuse("--tile " + inQuotes(options.share) + ": write part i of n as i/n, from 1/n to n/n");
    if (!options.output.ends_with(kPartEnding))
        return refuse("with --tile the output is a part, not a mesh: name it with the ending .part");
    return done();
}

bool canBeTiled(const ExportOptions& options, const OpenedGraph& opened) {
    return checkTiles(opened.program) && checkTiledExport(options);
}

bool wantsTiles(const ExportOptions& options, const OpenedGraph& opened) {
    return opened.request.resolution > kMostUntiled && canBeTiled(options, opened);
}

int checkShares(const ExportOptions& options, const OpenedGraph& opened, uint32_t shares) {
    ExportOptions part = options;
    part.share = "1/" + std::to_string(shares), part.output += kPartEnding;
    part.report.clear(), part.required.clear();  // the merge's
    for (const Done& fine : {checkTiledExport(part), checkPiecesPath(options.output)})
        if (!fine) return print(fine.error()), kBadUsage;
    if (needField(options.required)) return noField(options.output);
    if (opened.unit.metres != 1.0) return otherUnit(options, opened, "--tasks");
    if (const Done fine = checkTiles(opened.program); !fine)
        return notTiled(options, fine.error(), "--tasks");
    const Result<CellGrid> grid = cellGrid(opened.region, opened.request.resolution);
    if (!grid) return badInput(options.mesh, grid.error());
    const TilePlan plan = tilesOf(options, *grid);
    return shares > plan.tiles.size() ? tooFewTiles(options, plan, shares) : kDone;
}

int exportTiles(const ExportOptions& options, OpenedGraph opened, Progress& progress) {
    if (const Done fine = checkTiledExport(options); !fine) return print(fine.error()), kBadUsage;
    if (const Done fine = checkTiles(opened.program); !fine)
        return notTiled(options, fine.error(), "--tiles and --tile");
    Placement placement;
    if (options.share.empty()) {
        const Result<Placement> wanted = placementOf(options.output, opened.unit, options.placement);
        if (!wanted) return print(wanted.error()), kBadUsage;
        placement = *wanted;
    } else if (opened.unit.metres != 1.0) {
        return otherUnit(options, opened, "--tile");
    }
    const Result<CellGrid> grid = cellGrid(opened.region, opened.request.resolution);
    if (!grid) return badInput(options.mesh, grid.error());
    const bool given = opened.request.region || opened.program.region;
    opened.request.region = opened.region;
    const Share share = readShare(options.share).value_or(Share{});

    progress.start("pipelines", 15, kCompiling);
    Session session(std::move(opened.device));
    session.setProgram(std::move(opened.program));
    const TilePlan plan = tilesOf(options, *grid);
    if (share.shares > plan.tiles.size()) return tooFewTiles(options, plan, share.shares);
    if (options.share.empty())
        return exportWhole(options, session, opened.request, plan,
                           {&session.program(), opened.region, session.device().name(), placement,
                            densityOf(opened.graph), !given},
                           given, progress);
    return exportPart(options, session, opened.request, plan, share, progress);
}

int runMerge(const MergeOptions& options) {
    if (const Done known = checkPiecesPath(options.output); !known) return print(known.error()), kBadUsage;
    if (needField(options.required)) return noField(options.output);
    std::vector<std::string> outputs = exportedPaths(options.output);
    if (!options.report.empty()) outputs.push_back(options.report);
    if (const Done kept = checkReplacesNone(options.parts, outputs); !kept)
        return print(kept.error()), kBadUsage;
    if (const Done distinct = checkDistinct(options.parts.front(), outputs); !distinct)
        return print(distinct.error()), kBadUsage;
    if (const Done there = checkCanBeWritten(outputs); !there) return print(there.error()), kSystemFailure;
    Progress progress;
    progress.start("read", 0);
    Result<std::vector<TileRecord>> tiles = readParts(options.parts);
    if (!tiles) return print(tiles.error()), kBadInput;
    const bool capped =
        std::ranges::any_of(*tiles, [](const TileRecord& tile) { return tile.header.capped != 0; });
    Result<MeshPieces> mesh = joinTiles(std::move(*tiles));
    if (!mesh) return print(mesh.error()), kBadInput;
    if (mesh->triangleCount == 0)
        return print({.message = "the parts hold no triangle: the surface does not pass through the region",
                      .file = options.parts[0]}),
               kBadInput;
    return writePieces(options, *mesh, {}, capped, 80, progress);
}

}  // namespace fw::cli
