// Meshes: those that files have, as fields, and those that stages make of fields.
#include <algorithm>

#include "graph/compile/graph_lowering.h"

namespace fw {

using language::Value;

MeshMethod meshMethod(std::string_view name) {
    return MeshMethod(std::ranges::find(kMeshMethodNames, name) - kMeshMethodNames);
}

namespace {

/// A surface that stands for the mesh that is made of it.
Lowered meshOf(const NodeAt& at, NodeOutput surface, MeshRecipe recipe) {
    surface.name = at.type.outputs[0].name;
    surface.type = Type::surface;
    surface.value.mesh = std::make_shared<const MeshRecipe>(std::move(recipe));
    Lowered result;
    result.outputs.push_back(std::move(surface));
    return result;
}

/// A mesh from a file where one of a field is wanted.
void reportNoField(GraphLowering& lowering, const NodeAt& at, std::string_view input) {
    lowering.report(
        at, input,
        {.message = "takes a mesh that was made of a field: put mesh_to_field and polygonize behind "
                    "the mesh_file"});
}

/// What is linked to an input, with its class: empty space if nothing is.
NodeOutput given(GraphLowering& lowering, const NodeInput& input) {
    NodeOutput output{"", Type::surface, input.value, input.exactness,
                      input.from ? input.from->spoiledBy : std::string()};
    if (!input.from) output.value = language::emptySurface(lowering.state);
    return output;
}

/// A stage of the mesh that is linked to input "mesh".
template <class Stage>
Lowered lowerStage(GraphLowering& lowering, const NodeAt& at, Stage stageOf) {
    const auto inputs = lowering.inputs(at);
    if (!inputs) return lowering.failure(at.type.outputs);
    const NodeOutput from = given(lowering, inputs->front());
    if (from.value.mesh && from.value.mesh->read) {
        reportNoField(lowering, at, "mesh");
        return lowering.failure(at.type.outputs);
    }
    const std::optional<MeshStage> stage = stageOf(*inputs);
    if (!stage) return lowering.failure(at.type.outputs);
    MeshRecipe recipe = from.value.mesh ? *from.value.mesh : MeshRecipe{};
    recipe.stages.push_back(*stage);
    return meshOf(at, from, std::move(recipe));
}

}  // namespace

Lowered lowerMeshFile(GraphLowering& lowering, const NodeAt& at) {
    const auto inputs = lowering.inputs(at);
    if (!inputs) return lowering.failure(at.type.outputs);
    const std::string& path = inputOf(*inputs, "path").text;
    const Result<TriangleMeshPtr> mesh =
        path.empty() ? noFileNamed(kMeshFile) : readTriangleMesh(lowering.state.graphPath, path);
    if (!mesh) {
        lowering.report(at, "path", mesh.error());
        return lowering.failure(at.type.outputs);
    }
    return meshOf(at, {"", Type::surface, language::emptySurface(lowering.state)}, MeshRecipe{.read = *mesh});
}

Lowered lowerMeshToField(GraphLowering& lowering, const NodeAt& at) {
    const auto inputs = lowering.inputs(at);
    if (!inputs) return lowering.failure(at.type.outputs);
    const std::shared_ptr<const MeshRecipe>& mesh = inputOf(*inputs, "mesh").mesh;
    if (!mesh || !mesh->read) {
        lowering.report(
            at, "mesh",
            {.message = "takes a mesh from a file: connect a mesh_file node (what polygonize makes "
                        "has a field already: use that)"});
        return lowering.failure(at.type.outputs);
    }
    const auto resolution = lowering.knownNumber(at, *inputs, "resolution");
    const auto margin = lowering.knownNumber(at, *inputs, "margin");
    if (!resolution || !margin) return lowering.failure(at.type.outputs);
    const auto inside = std::ranges::find(kMeshInsideNames, inputOf(*inputs, "inside").text);
    const MeshFieldRecipe recipe{.mesh = mesh->read,
                                 .resolution = static_cast<int>(*resolution),
                                 .margin = *margin,
                                 .inside = MeshInside(inside - kMeshInsideNames)};
    const Result<FieldVolumePtr> volume = meshField(recipe, lowering.options.bake);
    if (!volume) {
        lowering.report(at, "mesh", volume.error());
        return lowering.failure(at.type.outputs);
    }
    for (const std::string& what : (*volume)->notes)
        lowering.warn(at, "mesh", meshName(*mesh->read) + " " + what);
    const bool flat = inputOf(*inputs, "sampling").text == "trilinear";
    return sampledVolume(lowering, at, *inputs, *volume, flat ? trilinearChannel : tricubicChannel);
}

std::optional<Error> tooManySamples(const GraphLowering& lowering, const FieldVolumePtr& volume) {
    std::size_t bytes = kTexelBytes * texelCount(*volume);
    for (const FieldVolumePtr& held : lowering.state.ir.volumes())
        if (held != volume) bytes += kTexelBytes * texelCount(*held);
    if (bytes <= kMostVolumeBytes) return {};
    return Error{.message = "what the graph has on grids, as meshes and particles, would take more than " +
                            std::to_string(kMostVolumeBytes >> 20) +
                            " MiB as fields: lower a resolution or take fewer"};
}

Lowered sampledVolume(GraphLowering& lowering, const NodeAt& at, const std::vector<NodeInput>& inputs,
                      const FieldVolumePtr& volume, VolumeChannel distance) {
    Ir& ir = lowering.state.ir;
    if (auto problem = tooManySamples(lowering, volume)) {
        lowering.report(at, "resolution", *problem);
        return lowering.failure(at.type.outputs);
    }
    lowering.gridded.insert(at.path());
    const uint32_t number = ir.addVolume(volume);
    const Value& p = inputOf(inputs, "p");
    const std::array<IrId, 3> place{p.ids[0], p.ids[1], p.ids[2]};
    Value surface = language::emptySurface(lowering.state);
    surface.ids[distanceComponent] = ir.sample(number, distance, place);
    if (volume->colored())
        for (int i = 0; i < 3; ++i)
            surface.ids[static_cast<std::size_t>(baseColorComponent + i)] =
                ir.sample(number, VolumeChannel(redChannel + i), place);
    const bool here = place == std::array<IrId, 3>{0, 1, 2};
    Lowered result;
    result.outputs.push_back({at.type.outputs[0].name, Type::surface, std::move(surface),
                              here ? distorted(kSampledLipschitz) : distorted(), at.path()});
    return result;
}

Lowered lowerPolygonize(GraphLowering& lowering, const NodeAt& at) {
    const auto inputs = lowering.inputs(at);
    if (!inputs) return lowering.failure(at.type.outputs);
    MeshRecipe recipe;
    recipe.method = meshMethod(inputOf(*inputs, "method").text);
    const auto resolution = lowering.knownNumber(at, *inputs, "resolution");
    bool known = resolution.has_value();
    recipe.resolution = static_cast<int>(resolution.value_or(0.0));
    if (at.node.input("region_min") && at.node.input("region_max")) {
        Box& box = recipe.region.emplace();
        for (int i = 0; i < 3; ++i)
            for (const auto& [name, corner] : {std::pair("region_min", &box.lo), {"region_max", &box.hi}}) {
                const auto number = lowering.knownNumber(at, *inputs, name, i);
                known &= number.has_value();
                (*corner)[std::size_t(i)] = number.value_or(0.0);
            }
    }
    if (!known) return lowering.failure(at.type.outputs);
    return meshOf(at, given(lowering, inputs->front()), std::move(recipe));
}

Lowered lowerSmooth(GraphLowering& lowering, const NodeAt& at) {
    return lowerStage(lowering, at, [&](const std::vector<NodeInput>& inputs) -> std::optional<MeshStage> {
        const auto times = lowering.knownNumber(at, inputs, "iterations");
        const auto spare = lowering.knownNumber(at, inputs, "spare");
        const auto within = lowering.knownNumber(at, inputs, "within");
        if (!times || !spare || !within) return std::nullopt;
        return MeshStage{.kind = MeshStage::Kind::smooth,
                         .times = static_cast<int>(*times),
                         .spare = *spare,
                         .within = *within};
    });
}

Lowered lowerSubdivide(GraphLowering& lowering, const NodeAt& at) {
    return lowerStage(lowering, at, [&](const std::vector<NodeInput>& inputs) -> std::optional<MeshStage> {
        const auto times = lowering.knownNumber(at, inputs, "levels");
        const auto project = lowering.knownNumber(at, inputs, "project");
        if (!times || !project) return std::nullopt;
        return MeshStage{.kind = MeshStage::Kind::subdivide,
                         .times = static_cast<int>(*times),
                         .project = *project != 0.0};
    });
}

Lowered lowerDecimate(GraphLowering& lowering, const NodeAt& at) {
    return lowerStage(lowering, at, [&](const std::vector<NodeInput>& inputs) -> std::optional<MeshStage> {
        const auto error = lowering.knownNumber(at, inputs, "error");
        const auto triangles = lowering.knownNumber(at, inputs, "triangles");
        if (!error || !triangles) return std::nullopt;
        if (*error <= 0.0 && *triangles <= 0.0) {
            lowering.report(at, "error",
                            {.message = "is 0, which bounds nothing, and so is triangles: give one of them"});
            return std::nullopt;
        }
        return MeshStage{
            .kind = MeshStage::Kind::decimate, .error = *error, .triangles = static_cast<int>(*triangles)};
    });
}

Lowered lowerDropCrumbs(GraphLowering& lowering, const NodeAt& at) {
    return lowerStage(lowering, at, [&](const std::vector<NodeInput>& inputs) -> std::optional<MeshStage> {
        const auto least = lowering.knownNumber(at, inputs, "least");
        if (!least) return std::nullopt;
        return MeshStage{.kind = MeshStage::Kind::dropCrumbs, .least = *least};
    });
}

/// The mesh that is linked, else the surface.
Lowered lowerOutput(GraphLowering& lowering, const NodeAt& at) {
    const auto inputs = lowering.inputs(at);
    if (!inputs) return lowering.failure(at.type.outputs);
    const NodeInput* shown = &inputs->front();
    for (const NodeInput& input : *inputs)
        if (input.from && flowsAs(input.spec->type) == Type::surface) shown = &input;
    Lowered result;
    NodeOutput& output = result.outputs.emplace_back(given(lowering, *shown));
    output.name = "surface";
    if (output.value.mesh && output.value.mesh->read) reportNoField(lowering, at, shown->spec->name);
    return result;
}

}  // namespace fw
