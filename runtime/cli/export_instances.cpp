// `fieldwright export --instances`: a glTF in which a mesh that the graph copies stands once, and is shown at
// many places: as nodes, or as instances of one node (EXT_mesh_gpu_instancing).
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "graph/compile/copies.h"
#include "runtime/bake/mesh_field_baker.h"
#include "runtime/cli/measured.h"
#include "runtime/cli/mesh_graph.h"
#include "runtime/cli/sequence.h"
#include "runtime/export/gltf_scene.h"
#include "runtime/export/outputs.h"
#include "runtime/play/copied_meshes.h"
#include "runtime/play/mesh_program.h"
#include "runtime/system/interruption.h"

namespace fw::cli {

namespace {

constexpr int kFewestCells = 8;

Done checkInstances(const ExportOptions& options) {
    if (const Done fine = checkWish(options, options.output, options.measured()); !fine) return fine;
    if (isGltf(options.output)) return done();
    return Error{.message = "copies share a mesh in .glb and .gltf alone: leave --instances out for " +
                            lowerExtension(options.output) + ", or choose one of them",
                 .file = options.output};
}

/// Meshes the solids of one document, one after the other, on one device.
class SolidMesher {
  public:
    SolidMesher(const ExportOptions& options_, const OpenedGraph& opened, Device device)
        : options(options_),
          whole(opened),
          session(std::move(device)),
          cell(longestSide(opened.region) / opened.request.resolution) {
        given = opened.request.region ? opened.request.region : opened.program.region;
    }

    double cellSize() const { return cell; }
    const std::optional<Box>& givenRegion() const { return given; }
    bool capped() const { return wasCapped; }
    std::string deviceName() const { return session.device().name(); }
    CompileOptions compileOptions() {
        CompileOptions how;
        how.bake = meshFieldBaker([this] { return &session.device(); });
        return how;
    }

    /// The whole document.
    Result<MeshedField> document() {
        return mesh(whole.program, whole.region, whole.request.resolution, cell);
    }
    Result<MeshedField> solid(const Graph& shown) {
        Result<Program> program = compileAtTime(shown, options.mesh.graph.time, compileOptions(), {}, {});
        if (!program) return program.error();
        if (given) return mesh(std::move(*program), *given, whole.request.resolution, cell);
        return found(std::move(*program), cell, shown, &whole.region);
    }
    /// What is copied, which lies wherever it lies.
    Result<MeshedField> content(const Graph& shown, double cellThere) {
        Result<Program> program = compileAtTime(shown, options.mesh.graph.time, compileOptions(), {}, {});
        if (!program) return program.error();
        return found(std::move(*program), cellThere, shown, nullptr);
    }

  private:
    /// `otherwise`: the region if the solid is not bounded.
    Result<MeshedField> found(Program program, double cellThere, const Graph& shown, const Box* otherwise) {
        const auto cellsOf = [&](const Box& box) {
            return std::clamp(int(std::ceil(longestSide(box) / cellThere)), kFewestCells, kMostResolution);
        };
        const Region where = findRegion(program);
        if (where.extent == Extent::empty) return MeshedField{{}, std::move(program), cellThere};
        const bool bounded = where.extent == Extent::bounded;
        if (!bounded && !otherwise)
            return regionError(program, where, regionContext(shown, options.mesh.graph.time));
        Box box = bounded ? where.box : *otherwise;
        if (bounded) box = padded(box, cellsOf(box), 1.5);
        return mesh(std::move(program), box, cellsOf(box), cellThere);
    }

    Result<MeshedField> mesh(Program program, const Box& region, int resolution, double cellThere) {
        session.setProgram(std::move(program));
        const Result<MesherResult> made = session.polygonise({region, resolution, whole.request.method});
        if (!made) return made.error();
        wasCapped = wasCapped || made->capped;
        Mesh mesh;
        if (made->triangles > 0) mesh = session.download(*made, partsOf(options, options.output));
        return MeshedField{std::move(mesh), session.onHost(), cellThere};
    }

    const ExportOptions& options;
    const OpenedGraph& whole;
    Session session;
    double cell;
    std::optional<Box> given;
    bool wasCapped = false;
};

void noteOf(const ExportOptions& options, const std::string& words) {
    std::fprintf(stderr, "%s: note: %s\n", options.output.c_str(), words.c_str());
}

/// What to say of copies that are none.
void noteRest(const ExportOptions& options, const MeshedSolid& solid) {
    if (solid.copied.why.empty()) return;
    if (solid.copied.places.empty())
        noteOf(options, "'" + solid.name + "' is one mesh, for its copies " + solid.copied.why);
    else
        noteOf(options, "'" + solid.name + "': " + std::to_string(solid.copied.places.size()) +
                            " copies share a mesh, and the rest is another, for some copies " +
                            solid.copied.why);
}

/// Why the document cannot be parted into solids; empty if it may.
std::string whyWhole(const Program& program) {
    if (!program.stages.empty())
        return "what is done to the mesh behind polygonize is done to all of it: the file has one mesh";
    const auto simulated = [](const FieldVolumePtr& volume) { return bool(volume->particles); };
    if (std::ranges::any_of(program.ir.volumes(), simulated))
        return "particles are meshed together: the file has one mesh";
    return {};
}

using Numbers = std::vector<float>;

/// Where a copy is in the file, if what is before it is mirrored or not.
struct FilePlace {
    Numbers move, turn, size;

    FilePlace(const CopyPlace& place, double scale) {
        for (const double along : place.pose.move) move.push_back(float(along * scale) + 0.0f);  // -0 is 0
        turn.assign(place.pose.turn.begin(), place.pose.turn.end());
        size.assign(3, float(place.pose.size));
    }
};

void addNodes(GltfScene& scene, const MeshedSolid& solid, std::size_t mesh, std::size_t parent,
              double scale) {
    std::size_t number = 0;
    for (const CopyPlace& place : solid.copied.places) {
        FilePlace at(place, scale);
        if (place.mirrored) at.size[0] = -at.size[0];
        nlohmann::json node = {{"name", solid.name + "_" + std::to_string(++number)}, {"mesh", mesh}};
        if (at.move != Numbers{0, 0, 0}) node["translation"] = at.move;
        if (at.turn != Numbers{0, 0, 0, 1}) node["rotation"] = at.turn;
        if (at.size != Numbers{1, 1, 1}) node["scale"] = at.size;
        scene.addNode(std::move(node), parent);
    }
}

/// Copies that are mirrored have a node of their own, which mirrors: programs tell the side of triangles by
/// nodes, and not by instances.
void addInstances(GltfScene& scene, const MeshedSolid& solid, std::size_t mesh, std::size_t parent,
                  double scale) {
    for (const bool mirrored : {false, true}) {
        Numbers moves, turns, sizes;
        const auto add = [](Numbers& to, const Numbers& more) {
            to.insert(to.end(), more.begin(), more.end());
        };
        for (const CopyPlace& place : solid.copied.places) {
            if (place.mirrored != mirrored) continue;
            FilePlace at(place, scale);
            if (mirrored) {
                at.move[0] = -at.move[0];
                at.turn[1] = -at.turn[1], at.turn[2] = -at.turn[2];
            }
            add(moves, at.move), add(turns, at.turn), add(sizes, at.size);
        }
        if (moves.empty()) continue;
        nlohmann::json node = {{"name", solid.name + (mirrored ? "_mirrored" : "_copies")}, {"mesh", mesh}};
        if (mirrored) node["scale"] = {-1, 1, 1};
        scene.addInstances(scene.addNode(std::move(node), parent), moves, turns, sizes);
    }
}

Result<ExportedFiles> write(const ExportOptions& options, const fw::ExportOptions& how,
                            const std::vector<MeshedSolid>& solids) {
    Result<GltfScene> scene = GltfScene::open(options.output, how);
    if (!scene) return scene.error();
    const std::size_t whole = scene->addNode({{"name", scene->name()}});
    for (const MeshedSolid& solid : solids) {
        if (!solid.mesh.indices.empty()) {
            const std::string name = solid.name.empty()            ? scene->name()
                                     : solid.copied.places.empty() ? solid.name
                                                                   : solid.name + "_rest";
            if (const Done shown = scene->addShown(placed(solid.mesh, how.placement), name, whole); !shown)
                return shown.error();
        }
        if (solid.copied.places.empty()) continue;
        const Result<std::size_t> mesh =
            scene->addMesh(placed(solid.copied.mesh, how.placement), solid.name + "_copy");
        if (!mesh) return mesh.error();
        const std::size_t parent = scene->addNode({{"name", solid.name}}, whole);
        (options.instances == "gpu" ? addInstances : addNodes)(*scene, solid, *mesh, parent,
                                                               how.placement.scale);
    }
    return scene->end();
}

/// Meshes all solids. Empty, and `status` told, if that cannot be done.
std::vector<MeshedSolid> meshSolids(const ExportOptions& options, const OpenedGraph& opened,
                                    SolidMesher& mesher, Progress& progress, int& status) {
    const auto fail = [&](const Error& error) {
        status = badInput(options.mesh, error);
        return std::vector<MeshedSolid>{};
    };
    std::vector<Solid> solids;
    if (const std::string why = whyWhole(opened.program); !why.empty()) {
        noteOf(options, why);
    } else {
        progress.start("copies", 20);
        solids = copyingSolids(opened.graph, options.mesh.graph.time, opened.region, mesher.compileOptions());
        if (solids.empty()) noteOf(options, "nothing in it is a copy by itself: the file has one mesh");
    }
    progress.start("mesh", 30);
    std::vector<MeshedSolid> meshes;
    if (solids.empty()) {
        Result<MeshedField> all = mesher.document();
        if (!all) return fail(all.error());
        meshes.push_back({{}, std::move(all->mesh), {}});
    }
    for (std::size_t i = 0; i < solids.size(); ++i) {
        progress.show(30 + int(30 * i / solids.size()));
        const Solid& solid = solids[i];
        Result<MeshedField> meshed = mesher.solid(solid.shown);
        if (!meshed) return fail(in(meshed.error(), "node '" + solid.name + "'"));
        MeshedSolid& made = meshes.emplace_back(MeshedSolid{solid.name, {}, {}});
        if (solid.copied && !meshed->mesh.indices.empty()) {
            made.copied = copiedMesh(*meshed, solid.copied->map, mesher.givenRegion(), [&](double cell) {
                return mesher.content(solid.copied->content, cell);
            });
            made.mesh = std::move(made.copied.rest);
            noteRest(options, made);
        } else {
            made.mesh = std::move(meshed->mesh);
        }
    }
    if (std::ranges::all_of(meshes, [](const MeshedSolid& one) {
            return one.mesh.indices.empty() && one.copied.places.empty();
        }))
        return fail(nothingToSee(mesher.givenRegion().has_value(), opened.region, opened.request.resolution));
    return meshes;
}

}  // namespace

int exportInstances(const ExportOptions& options) {
    Progress progress;
    if (const Done fine = checkInstances(options); !fine) return print(fine.error()), kBadUsage;
    MeshOptions wanted = options.mesh;
    wanted.outputs = exportedPaths(options.output);
    if (!options.report.empty()) wanted.outputs.push_back(options.report);
    if (const Done distinct = checkDistinct(wanted.graph.path, wanted.outputs); !distinct)
        return print(distinct.error()), kBadUsage;
    int status = kDone;
    std::optional<OpenedGraph> opened = openForMesh(wanted, progress, status);
    if (!opened) return status;
    fw::ExportOptions how = writingOf(options);
    how.placement = *placementOf(options.output, opened->unit, options.placement);
    SolidMesher mesher(options, *opened, std::move(opened->device));
    const std::vector<MeshedSolid> solids = meshSolids(options, *opened, mesher, progress, status);
    if (solids.empty()) return status;
    if (solids.size() > 1 && reachInto(solids, opened->program, 0.25 * mesher.cellSize()))
        noteOf(options, "solids that reach into each other are each whole in the file, and not one");
    progress.start("write", 70);
    Report report;
    const MeshedFrom from{&opened->program, opened->region,           mesher.deviceName(),
                          how.placement,    densityOf(opened->graph), !mesher.givenRegion()};
    how.examine = measuring(options, from, &progress, report);
    how.kept = [] { whenEnded({.said = "; the file was written"}); };
    if (const Result<ExportedFiles> written = write(options, how, solids); !written)
        return print(written.error()), kSystemFailure;
    progress.finish();
    if (mesher.capped()) noteOf(options, "the surface leaves the region and was closed at its boundary");
    report.capped = mesher.capped();
    return tellReport(options, report);
}

}  // namespace fw::cli
