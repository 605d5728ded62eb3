// `fieldwright export --animated`: the frames of a timeline as one glTF that moves. Where parts move as
// wholes each is a mesh, and what carries it a node with keys, called as in the graph; else every frame is a
// mesh, and they take turns. Or as one mesh and the places of its points, where its triangles stay.
#include <algorithm>
#include <cstdio>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "runtime/cli/mesh_graph.h"
#include "runtime/cli/sequence.h"
#include "runtime/export/animated.h"
#include "runtime/export/outputs.h"
#include "runtime/export/point_cache.h"
#include "runtime/play/mesh_sequence.h"
#include "runtime/play/part_meshes.h"
#include "runtime/system/interruption.h"

namespace fw::cli {

namespace {

int badAnimation(const std::string& message) {
    std::fprintf(stderr, "fieldwright export: %s\n", message.c_str());
    return kBadUsage;
}

/// What is written, of which a player plays the frames.
struct Animation {
    const ExportOptions& options;
    fw::ExportOptions how;
    std::string meshPath;  ///< whose ending says what a mesh in it has
    FrameRange range;
    Placement placement;
    Player& player;

    double seconds(long frame) const { return range.time(frame) - range.time(range.first); }
};

/// Makes the mesh of each frame, as it stands in a file, and calls add(mesh, frame) behind the making of the
/// next.
int forFrames(const Animation& of, const std::function<Done(Mesh, long frame)>& add) {
    WrittenBehind writing;
    SequenceProgress progress("frame", of.range.count());
    bool empty = false;
    for (long frame = of.range.first; frame < of.range.last; ++frame) {
        Result<Mesh> mesh = onceMoreIfLost(
            [&] {
                of.player.seek(of.range.time(frame));
                return of.player.mesh(partsOf(of.options, of.meshPath));
            },
            [&] { renewDevice(of.player, "going on at frame " + std::to_string(frame)); });
        if (!mesh) return badInput(of.options.mesh, in(mesh.error(), "frame " + std::to_string(frame)));
        if (mesh->indices.empty() && !std::exchange(empty, true))
            std::fprintf(stderr, "%s: note: the solid is empty at frame %ld, and nothing is shown there\n",
                         of.options.output.c_str(), frame);
        std::shared_ptr<const Program> program;
        if (of.options.textures) program = std::make_shared<Program>(of.player.programOnHost());
        auto write = [&, frame, program, mesh = std::move(*mesh)]() mutable -> Done {
            Result<Mesh> dressed =
                program ? withTextures(of.options, std::move(mesh), *program) : Result<Mesh>(std::move(mesh));
            const Done added =
                dressed ? add(placed(std::move(*dressed), of.placement), frame) : Done(dressed.error());
            return added ? done() : Done(in(added.error(), "frame " + std::to_string(frame)));
        };
        if (const Done before = writing.begin(std::move(write)); !before)
            return print(before.error()), kSystemFailure;
        progress.next(true);
    }
    if (const Done written = writing.end(); !written) return print(written.error()), kSystemFailure;
    return kDone;
}

/// The exit status of the file's end.
int ended(const Result<ExportedFiles>& files) {
    return files ? kDone : (print(files.error()), kSystemFailure);
}

int writeTurns(const Animation& of) {
    Result<AnimatedGltf> file = AnimatedGltf::open(of.options.output, of.how);
    if (!file) return print(file.error()), kSystemFailure;
    const auto add = [&](const Mesh& mesh, long frame) {
        return file->add(mesh, of.seconds(frame), "frame_" + std::to_string(frame));
    };
    const int status = forFrames(of, add);
    return status == kDone ? ended(file->end(of.seconds(of.range.last))) : status;
}

Result<PointCache> openPoints(const Animation& of) {
    std::vector<double> seconds;
    for (long frame = of.range.first; frame < of.range.last; ++frame) seconds.push_back(of.seconds(frame));
    return PointCache::open(of.options.output, std::move(seconds), of.how);
}

/// The points of a mesh whose triangles stay what they are.
int writePoints(const Animation& of) {
    Result<PointCache> file = openPoints(of);
    if (!file) return print(file.error()), kSystemFailure;
    const int status = forFrames(of, [&](const Mesh& mesh, long) { return file->add(mesh); });
    return status == kDone ? ended(file->end()) : status;
}

/// Those of all parts, each of which moves as a whole.
int writePartPoints(const Animation& of, const std::vector<PartNode>& nodes,
                    const std::vector<PartMesh>& meshes) {
    Result<PointCache> file = openPoints(of);
    if (!file) return print(file.error()), kSystemFailure;
    for (std::size_t moment = 0; moment < std::size_t(of.range.count()); ++moment) {
        if (const Done added = file->add(placed(together(nodes, meshes, moment), of.placement)); !added)
            return print(added.error()), kSystemFailure;
    }
    return ended(file->end());
}

/// The values of a property at all moments as a track; the first of them alone, as the node's own, where it
/// rests.
void addTrack(GltfScene& scene, std::vector<GltfTrack>& tracks, const std::vector<float>& times,
              std::size_t node, const char* path, const std::vector<std::vector<float>>& values,
              const std::vector<float>& none) {
    if (values.front() != none) scene.setNode(node, path, values.front());
    if (std::ranges::all_of(values, [&](const auto& value) { return value == values.front(); })) return;
    GltfTrack track{.node = node, .path = path, .times = times, .values = {}};
    for (const std::vector<float>& value : values)
        track.values.insert(track.values.end(), value.begin(), value.end());
    tracks.push_back(std::move(track));
}

void addTracks(GltfScene& scene, std::vector<GltfTrack>& tracks, const std::vector<float>& times,
               std::size_t node, const std::vector<Pose>& poses, double scale) {
    std::vector<std::vector<float>> moves, turns, sizes;
    for (const Pose& pose : poses) {
        auto& move = moves.emplace_back();
        for (const double along : pose.move) move.push_back(float(along * scale) + 0.0f);  // -0 is 0
        turns.emplace_back(pose.turn.begin(), pose.turn.end());
        sizes.emplace_back(3, float(pose.size));
    }
    addTrack(scene, tracks, times, node, "translation", moves, {0, 0, 0});
    addTrack(scene, tracks, times, node, "rotation", turns, {0, 0, 0, 1});
    addTrack(scene, tracks, times, node, "scale", sizes, {1, 1, 1});
}

int writeParts(const Animation& of, const std::vector<PartNode>& nodes, const std::vector<PartMesh>& meshes) {
    Result<GltfScene> scene = GltfScene::open(of.options.output, of.how);
    if (!scene) return print(scene.error()), kSystemFailure;
    std::vector<float> times;
    for (long frame = of.range.first; frame < of.range.last; ++frame)
        times.push_back(float(of.seconds(frame)));
    const std::size_t whole = scene->addNode({{"name", scene->name()}});
    std::vector<std::size_t> numbers;
    std::vector<GltfTrack> tracks;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const std::size_t parent = nodes[i].parent ? numbers[*nodes[i].parent] : whole;
        nlohmann::json node = {{"name", nodes[i].name}};
        if (!meshes[i].mesh.indices.empty()) {
            Result<Mesh> dressed = withTextures(of.options, meshes[i].mesh, meshes[i].program);
            if (!dressed) return badInput(of.options.mesh, in(dressed.error(), nodes[i].name));
            const Result<std::size_t> mesh =
                scene->addMesh(placed(std::move(*dressed), of.placement), nodes[i].name);
            if (!mesh) return badInput(of.options.mesh, mesh.error());
            node["mesh"] = *mesh;
        }
        numbers.push_back(scene->addNode(std::move(node), parent));
        if (!nodes[i].poses.empty())
            addTracks(*scene, tracks, times, numbers.back(), nodes[i].poses, of.placement.scale);
    }
    if (!tracks.empty()) scene->addAnimation("motion", tracks);
    return ended(scene->end());
}

PlayerOptions playing(const ExportOptions& options) {
    return {.resolution = options.mesh.resolution.value_or(0),
            .method = options.mesh.method,
            .liveParameters = false};
}

/// The parts' meshes, where the document is parts that move apart from each other.
std::optional<std::vector<PartMesh>> separateMeshes(const Animation& of, const std::vector<PartNode>& nodes) {
    const double cell = longestSide(of.player.region()) / of.player.resolution();
    const auto make = [&] {
        return partMeshes(of.player, nodes, cell, playing(of.options), partsOf(of.options, of.meshPath));
    };
    const Result<std::vector<PartMesh>> meshes =
        onceMoreIfLost(make, [&] { renewDevice(of.player, "making the parts again"); });
    if (!meshes || overlap(nodes, *meshes, std::size_t(of.range.count()), 0.25 * cell)) return std::nullopt;
    return *meshes;
}

}  // namespace

int exportAnimated(const ExportOptions& options) {
    fw::ExportOptions how = writingOf(options);
    how.kept = [] { whenEnded({.said = "; the file was written"}); };
    const bool asPoints = isPointCache(options.output);
    if (const Done fine =
            asPoints ? checkPointCache(options.output, how) : checkAnimatedPath(options.output, how);
        !fine)
        return print(fine.error()), kBadUsage;
    const std::vector<std::string> files =
        asPoints ? pointCachePaths(options.output) : exportedPaths(options.output);
    const std::string meshPath = files[asPoints ? 1 : 0];
    if (const Done fine = checkWish(options, meshPath); !fine) return print(fine.error()), kBadUsage;
    if (asPoints && options.textures)
        return badAnimation("a point cache has no --textures: leave them out, or write a .glb");
    if (options.measured())
        return badAnimation(
            "--report and --require measure one mesh: export the frames into a folder for them");
    MeshOptions wanted = options.mesh;
    wanted.outputs = files;
    if (const Done distinct = checkDistinct(wanted.graph.path, wanted.outputs); !distinct)
        return print(distinct.error()), kBadUsage;
    FrameRange range;
    std::optional<Player> player;
    {
        Progress progress;
        int status = kDone;
        player = openPlayer(wanted, progress, {.liveParameters = false}, status, [&](const Graph& graph) {
            const Result<FrameRange> frames = framesAsked(graph, options);
            if (!frames) return badAnimation(frames.error().message);
            range = *frames;
            return kDone;
        });
        if (!player) return status;
    }
    const Placement placement = *placementOf(meshPath, unitOf(player->graph()), options.placement);
    const Animation animation{options, how, meshPath, range, placement, *player};
    std::vector<double> times;
    for (long frame = range.first; frame < range.last; ++frame) times.push_back(range.time(frame));
    int status = -1;
    // A region that is given is the document's, and no part's.
    if (options.mesh.region.empty())
        if (const std::optional<std::vector<PartNode>> nodes = movingParts(player->graph(), times)) {
            const Graph whole = player->graph();
            if (const auto meshes = separateMeshes(animation, *nodes))
                status = asPoints ? writePartPoints(animation, *nodes, *meshes)
                                  : writeParts(animation, *nodes, *meshes);
            else if (const Done back = player->reload(whole, playing(options)); !back)
                return badInput(options.mesh, back.error());
        }
    if (status < 0) status = asPoints ? writePoints(animation) : writeTurns(animation);
    if (const std::optional<Error> coarser = player->coarser()) print(*coarser);
    return status;
}

}  // namespace fw::cli
