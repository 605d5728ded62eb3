// What needs true distances: walls and offsets, which are uneven without; and what gives them, by measuring a
// field on a grid (measured_field.h).
#include <algorithm>
#include <string>

#include "graph/assets/mesh_field.h"
#include "graph/compile/graph_lowering.h"
#include "graph/compile/measured_field.h"

namespace fw {

using language::Value;

namespace {

constexpr double kEven = 1.01;  // Lipschitz constants up to which walls pass for even

/// Why a field cannot be measured when the graph is compiled; empty if it can.
std::string unmeasurable(const GraphLowering& lowering, IrId root) {
    const IrNode* moving = movingIn(lowering.state.ir, root);
    if (!moving) return {};
    if (moving->op == Op::parameter)
        return "depends on '" + lowering.live[std::size_t(moving->number)].name +
               "', which moves, and distances are measured once: move what is behind this node instead";
    return "is made of particles, which move, and distances are measured once: set the distance of "
           "particles_to_field to true instead";
}

/// The same field as distances that were measured. None, reported, if that cannot be; none, not reported, if
/// there is no solid.
struct Measured {
    std::optional<IrId> distance;
    bool failed = false;
};
Measured measured(GraphLowering& lowering, const NodeAt& at, IrId distance, double lipschitz, int resolution,
                  double margin, double chamfer = 0.0) {
    const auto fails = [&](const std::string& input, Error error) {
        lowering.report(at, input, std::move(error));
        return Measured{{}, true};
    };
    if (const std::string why = unmeasurable(lowering, distance); !why.empty())
        return fails("surface", {.message = why});
    Result<FieldVolumePtr> volume = measuredField(lowering.state.ir, {.distance = distance,
                                                                      .lipschitz = lipschitz,
                                                                      .resolution = resolution,
                                                                      .margin = margin,
                                                                      .chamfer = chamfer,
                                                                      .finest = lowering.options.finest,
                                                                      .stop = lowering.options.stop});
    if (!volume) return fails("surface", volume.error());
    if (!*volume) return {};
    if (auto problem = tooManySamples(lowering, *volume)) return fails("resolution", *problem);
    Ir& ir = lowering.state.ir;
    lowering.gridded.insert(at.path());
    return {
        ir.sample(ir.addVolume(*volume), tricubicChannel, {ir.position(0), ir.position(1), ir.position(2)})};
}

Lowered surfaceOf(const NodeAt& at, const NodeInput& from, IrId distance) {
    Value surface = from.value;
    surface.ids[distanceComponent] = distance;
    Lowered result;
    result.outputs.push_back({at.type.outputs[0].name, Type::surface, std::move(surface),
                              distorted(kSampledLipschitz), at.path()});
    return result;
}
/// What is not there needs no distance.
Lowered unchanged(const NodeAt& at, const NodeInput& from) {
    Lowered result;
    result.outputs.push_back({at.type.outputs[0].name, Type::surface, from.value, from.exactness,
                              from.from ? from.from->spoiledBy : std::string()});
    return result;
}

Lowered loweredAs(GraphLowering& lowering, const NodeAt& at, const NodeInput& from,
                  const Measured& measured) {
    if (measured.failed) return lowering.failure(at.type.outputs);
    return measured.distance ? surfaceOf(at, from, *measured.distance) : unchanged(at, from);
}

/// The inputs of a node that measures its first one: samples along the grid's longest side, and a length.
struct Asked {
    std::vector<NodeInput> inputs;
    int resolution;
    double length;
};
std::optional<Asked> askedOf(GraphLowering& lowering, const NodeAt& at, const std::string& length) {
    auto inputs = lowering.inputs(at);
    if (!inputs) return std::nullopt;
    const auto resolution = lowering.knownNumber(at, *inputs, "resolution");
    const auto known = lowering.knownNumber(at, *inputs, length);
    if (!resolution || !known) return std::nullopt;
    return Asked{std::move(*inputs), int(*resolution), *known};
}

/// Of the solid `distance`, whose distances are true, what a ball of this radius can reach within it: an
/// opening; with `sign` -1 of what is not the solid. What it gives is true for so many metres around the
/// shrunk solid.
Measured opened(GraphLowering& lowering, const NodeAt& at, IrId distance, double sign, double radius,
                int resolution, double margin) {
    Ir& ir = lowering.state.ir;
    const IrId by = ir.constant(sign * radius);
    Measured grown =
        measured(lowering, at, ir.add(Op::add, distance, by), kSampledLipschitz, resolution, margin);
    if (grown.distance) grown.distance = ir.add(Op::subtract, *grown.distance, by);
    return grown;
}

}  // namespace

Lowered lowerTrueDistance(GraphLowering& lowering, const NodeAt& at) {
    const std::optional<Asked> asked = askedOf(lowering, at, "margin");
    if (!asked) return lowering.failure(at.type.outputs);
    const auto& [inputs, resolution, margin] = *asked;
    const NodeInput& from = inputs.front();
    if (!from.from || from.exactness.exact()) return unchanged(at, from);
    const Measured found = measured(lowering, at, from.value.ids[distanceComponent], from.exactness.lipschitz,
                                    resolution, margin);
    return loweredAs(lowering, at, from, found);
}

Lowered lowerRoundEdges(GraphLowering& lowering, const NodeAt& at) {
    const std::optional<Asked> asked = askedOf(lowering, at, "radius");
    if (!asked) return lowering.failure(at.type.outputs);
    const auto& [inputs, resolution, radius] = *asked;
    const NodeInput& from = inputs.front();
    if (!from.from || radius == 0.0) return unchanged(at, from);
    const std::string& edges = inputOf(inputs, "edges").text;
    Measured now{from.value.ids[distanceComponent]};
    const bool fine =
        edges == "outer" ? from.exactness.inside && from.exactness.bound() : from.exactness.exact();
    if (!fine && !lowering.gridded.contains(from.from->spoiledBy))
        now = measured(lowering, at, *now.distance, from.exactness.lipschitz, resolution,
                       edges == "outer" ? 0.0 : 1.5 * radius);
    if (now.distance && edges != "inner") {
        now = opened(lowering, at, *now.distance, 1.0, radius, resolution,
                     (edges == "all" ? 2.5 : 1.25) * radius);
        if (!now.failed && !now.distance && lowering.options.finest >= resolution) {
            lowering.report(at, "radius",
                            {.message = "leaves nothing of the solid, which is nowhere as thick as twice the "
                                        "radius: take a smaller one"});
            now.failed = true;
        }
    }
    if (now.distance && edges != "outer")
        now = opened(lowering, at, *now.distance, -1.0, radius, resolution, 0.0);
    return loweredAs(lowering, at, from, now);
}

Lowered lowerChamferEdges(GraphLowering& lowering, const NodeAt& at) {
    const std::optional<Asked> asked = askedOf(lowering, at, "size");
    if (!asked) return lowering.failure(at.type.outputs);
    const auto& [inputs, resolution, size] = *asked;
    const NodeInput& from = inputs.front();
    if (!from.from || size == 0.0) return unchanged(at, from);
    const Measured now = measured(lowering, at, from.value.ids[distanceComponent], from.exactness.lipschitz,
                                  resolution, 0.0, size);
    Lowered result = loweredAs(lowering, at, from, now);
    // Neighbouring samples may be cut by different faces, so no Lipschitz constant is known.
    if (!result.failed && now.distance) result.outputs[0].exactness = distorted();
    return result;
}

Lowered lowerOffset(GraphLowering& lowering, const NodeAt& at) {
    Lowered result = lowering.lowerBody(at);
    if (result.failed) return result;
    const NodeOutput& made = result.outputs[0];
    if (lowering.nearFields.contains(made.spoiledBy)) {
        lowering.warn(at, "surface",
                      "the particles of node '" + made.spoiledBy +
                          "' have distances near their surface alone, so this grows by more than it should: "
                          "set that node's distance to true");
    } else if (made.exactness.lipschitz > kEven && !made.spoiledBy.empty() && made.spoiledBy != at.path() &&
               !lowering.gridded.contains(made.spoiledBy)) {
        lowering.warn(at, "surface",
                      "this is uneven, for behind node '" + made.spoiledBy +
                          "' values are no distances: put a true_distance node in front of this one");
    }
    return result;
}

}  // namespace fw
