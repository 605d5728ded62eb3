// What is asked of a document's mesh: itself, its measures, a file of it.
#include <algorithm>

#include "graph/base/fence.h"
#include "graph/compile/single_precision.h"
#include "graph/document/unit.h"
#include "runtime/export/outputs.h"
#include "runtime/files/mesh_wish.h"
#include "runtime/measure/field_measure.h"
#include "runtime/mesh/edges.h"
#include "runtime/play/mesh_program.h"
#include "runtime/serve/document.h"

namespace fw::serve {

namespace {

Json boxJson(const Box& box) { return Json::array({box.lo, box.hi}); }
Json tripleJson(glm::vec3 v) { return Json::array({v.x, v.y, v.z}); }

Json materialJson(const Material& material, const std::string& name) {
    Json json = Json::object();
    if (!name.empty()) json["name"] = name;
    json["roughness"] = material.roughness, json["metallic"] = material.metallic;
    json["emission"] = tripleJson(material.emission);
    json["transmission"] = material.transmission, json["ior"] = material.ior;
    json["absorption"] = tripleJson(material.absorption);
    return json;
}

Json materialsJson(const Mesh& mesh) {
    Json list = Json::array();
    for (const MeshPart& part : mesh.parts) {
        Json entry = materialJson(part.material, part.name);
        entry["triangles"] = part.triangles;
        list.push_back(std::move(entry));
    }
    if (list.empty()) {
        list.push_back(materialJson(mesh.material, mesh.materialName));
        list[0]["triangles"] = mesh.triangleCount();
    }
    return list;
}

/// Texels along a side of those that are asked for, if some are.
std::optional<int> texturesOf(Params& params) {
    const int size = params.whole("textures", 0, 0, kMostTexture);
    if (size != 0 && (size < kLeastTexture || (size & (size - 1)) != 0))
        params.refuse("textures", "is a power of two from " + std::to_string(kLeastTexture) + " to " +
                                      std::to_string(kMostTexture));
    return size == 0 ? std::nullopt : std::optional(size);
}

/// What the blobs of an answer refer to.
struct Made {
    Mesh mesh;
    Edges edges;
};

/// The mesh's arrays as blobs, and of its pictures, if it has some.
void addBlobs(Reply& reply, const Mesh& mesh, bool normals, bool colors) {
    const std::size_t n = mesh.positions.size();
    const auto add = [&](const char* name, const char* type, std::vector<std::size_t> shape, auto& values) {
        if (!values.empty()) reply.blobs.push_back({name, type, std::move(shape), bytesOf(values)});
    };
    reply.blobs.push_back({"positions", "f32", {n, 3}, bytesOf(mesh.positions)});
    if (normals) add("normals", "f32", {n, 3}, mesh.normals);
    if (colors) add("colors", "f32", {n, 3}, mesh.colors);
    add("uvs", "f32", {n, 2}, mesh.uvs);
    add("tangents", "f32", {n, 4}, mesh.tangents);
    reply.blobs.push_back({"indices", "u32", {mesh.triangleCount(), 3}, bytesOf(mesh.indices)});
    if (!mesh.textures) return;
    const auto side = std::size_t(mesh.textures->size);
    add("base_color", "u8", {side, side, 3}, mesh.textures->baseColor);
    add("surface", "u8", {side, side, 3}, mesh.textures->surface);
    add("normal", "u8", {side, side, 3}, mesh.textures->normal);
    add("emission", "u8", {side, side, 3}, mesh.textures->emission);
    reply.result["emissionStrength"] = mesh.textures->emissionStrength;
}

}  // namespace

Answer Document::mesh(Params& params, Task& task) {
    const bool normals = params.flag("normals", true), colors = params.flag("colors", true);
    const bool materials = params.flag("materials", false), edges = params.flag("edges", false);
    const MeshWish wish = {.textures = texturesOf(params)};
    if (std::optional<Fault> fault = playAs(params, task)) return *fault;
    if (task.cancelled) return cancelledFault();
    Result<Mesh> made = player->mesh(wish.textures ? MaterialParts::besideTextures
                                     : materials   ? MaterialParts::whole
                                                   : MaterialParts::none);
    if (task.cancelled) return cancelledFault();
    if (!made) return Fault(made.error());
    if (wish.textures) {
        task.progress("textures", 0);
        made = withTextures(wish, std::move(*made), player->programOnHost());
        if (task.cancelled) return cancelledFault();
        if (!made) return Fault(made.error());
    }
    const auto kept = std::make_shared<Made>(Made{std::move(*made), {}});
    const Mesh* const mesh = &kept->mesh;
    if (edges) kept->edges = edgesOf(mesh->indices, mesh->positions.size());
    Reply reply;
    reply.keeps = kept;
    reply.result = {{"vertices", mesh->positions.size()},
                    {"triangles", mesh->triangleCount()},
                    {"resolution", player->resolution()},
                    {"region", boxJson(player->region())},
                    {"capped", player->capped()},
                    {"unit", unitOf(player->graph()).name},
                    {"baseColor", tripleJson(mesh->baseColor)}};
    if (materials || wish.textures) reply.result["materials"] = materialsJson(*mesh);
    std::vector<Error> notes = player->notes();
    if (const std::optional<Error> coarser = player->coarser()) notes.push_back(*coarser);
    if (!notes.empty()) reply.result["notes"] = findingsJson(notes);
    addBlobs(reply, *mesh, normals, colors);
    if (edges) {
        reply.blobs.push_back({"edges", "u32", {kept->edges.ends.size(), 2}, bytesOf(kept->edges.ends)});
        reply.blobs.push_back(
            {"triangle_edges", "u32", {mesh->triangleCount(), 3}, bytesOf(kept->edges.ofCorner)});
    }
    return reply;
}

Answer Document::measure(Params& params, Task& task) {
    const bool field = params.flag("field", true);
    if (std::optional<Fault> fault = playAs(params, task)) return *fault;
    const Result<Mesh> mesh = player->mesh();
    if (task.cancelled) return cancelledFault();
    if (!mesh) return Fault(mesh.error());
    task.progress("measure", 0);
    const Program program = player->programOnHost();
    MeasureOptions options =
        field ? measureOf(program, player->region(), Points::affordable) : MeasureOptions{};
    options.selfIntersections = options.widths = true;
    Report report = reportOnMesh(mesh->positions, mesh->indices, options);
    if (task.cancelled) return cancelledFault();
    report.unit = unitOf(graph()).name;
    report.density = densityOf(graph());
    report.capped = player->capped();
    if (field) report.completeness = checkCompleteness(program, player->meshedRegion(), &task.cancelled);
    if (task.cancelled) return cancelledFault();
    report.device = player->device().name();
    Reply reply;
    reply.result = Json::parse(writeReport(report));
    for (const char* ofCommands : {"stages", "totalMs", "peakMemoryBytes"}) reply.result.erase(ofCommands);
    return reply;
}

Answer Document::exportMesh(Params& params, Task& task) {
    params.need("path");
    const std::string path = params.text("path", "");
    MeshWish wish = {.manifold = params.flag("manifold", false),
                     .compress = params.flag("compress", false),
                     .parts = params.flag("parts", false),
                     .splitMaterials = params.flag("splitMaterials", false),
                     .textures = texturesOf(params),
                     .lods = params.whole("lods", 1, 1, kMostLevels)};
    static const std::vector<std::string> purposes = {"print"};
    wish.placement = {params.text("unit", ""), params.text("up", ""), params.oneOf("for", purposes, "")};
    CompileOptions compiled;
    compiled.triangles = params.whole("triangles", 0, 0, 1 << 24);
    compiled.byShape = wish.textures.has_value();
    const auto [resolution, method] = cellsOf(params);
    if (std::optional<Fault> fault = params.fault()) return *fault;
    if (const Done fine = checkWish(wish, path); !fine) return Fault(fine.error());
    if (const Done inside = checkMayWrite(path); !inside) return Fault(inside.error());
    const std::vector<std::string> outputs = wishedPaths(wish, path);
    if (const Done kept = checkReplacesNone(filesRead(graph()), outputs); !kept) return Fault(kept.error());
    if (const Done distinct = checkDistinct(graph().path, outputs); !distinct) return Fault(distinct.error());
    if (const Done there = checkCanBeWritten(outputs); !there) return Fault(there.error());

    now = &task;
    task.progress("compile", 0);
    Result<Program> program = folded(task, std::move(compiled));
    if (task.cancelled) return cancelledFault();
    if (!program) return Fault(program.error());
    const int cells = resolution > 0           ? resolution
                      : playing.resolution > 0 ? playing.resolution
                                               : program->resolution;
    const MeshRequest request{{},
                              cells,
                              method           ? method
                              : playing.method ? *playing.method
                                               : program->method};
    const Result<Box> region =
        meshRegion(*program, request, regionContext(graph(), seconds, task.cancelled.token()));
    if (!region) return Fault(region.error());
    const std::optional<Error> loss = precisionLoss(graph(), *program, *region);
    Result<Device> device = openDevice();
    if (!device) return Fault(kSystemFault, device.error().message);
    const auto starts = [&task](const char* stage) {
        task.progress(stage, 0);
        return !task.cancelled;
    };
    Result<MeshedProgram> meshed =
        meshProgram(std::move(*device), std::move(*program), request, *region, starts);
    if (task.cancelled) return cancelledFault();
    if (!meshed) return Fault(meshed.error());
    Result<std::vector<Mesh>> levels = withTextures(
        wish, meshed->session.downloadLevels(meshed->mesh, std::size_t(wish.lods), partsOf(wish, path)),
        wish.textures ? meshed->session.onHost() : Program(), starts);
    if (task.cancelled) return cancelledFault();
    if (!levels) return Fault(levels.error());
    task.progress("write", 0);
    ExportOptions how = writingOf(wish);
    how.placement = *placementOf(path, unitOf(graph()), wish.placement);
    how.cellSize = float(meshed->cellSize);
    how.cancel = &task.cancelled;
    const Result<ExportedFiles> written = exportWished(wish, *levels, path, how);
    if (task.cancelled) return cancelledFault();
    if (!written) return Fault(written.error());
    Reply reply;
    reply.result = {{"files", written->paths},
                    {"bytes", written->bytes},
                    {"vertices", levels->front().positions.size()},
                    {"triangles", levels->front().triangleCount()},
                    {"capped", meshed->mesh.capped}};
    if (loss) reply.result["notes"] = findingsJson({*loss});
    return reply;
}

}  // namespace fw::serve
