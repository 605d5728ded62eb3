#include "graph/compile/compile.h"

#include <algorithm>
#include <cmath>

#include "graph/base/words.h"
#include "graph/bounds/region.h"
#include "graph/compile/effort.h"
#include "graph/compile/graph_lowering.h"
#include "graph/compile/single_precision.h"
#include "graph/document/named_parameters.h"
#include "graph/ir/affine_sums.h"
#include "graph/rules/structure.h"

namespace fw {

namespace {

const Node* outputNode(const Graph& graph) {
    const auto found = std::find_if(graph.nodes.begin(), graph.nodes.end(),
                                    [](const Node& node) { return roleOf(node.type) == NodeRole::output; });
    return found == graph.nodes.end() ? nullptr : &*found;
}

/// Why no program can be made of a field whose operations these are.
std::optional<Error> fieldProblem(const Graph& graph, const Node& output, const Ir& ir, IrId distance) {
    if (ir.size() > kMaxIrOperations)
        return errorAt(graph, &output,
                       "the field has more than " + std::to_string(kMaxIrOperations) +
                           " operations: use fewer nodes, copies or loops");
    if (!ir.isConstant(distance) || std::isfinite(ir.number(distance))) return std::nullopt;
    Error error =
        errorAt(graph, &output,
                "the field is not a number anywhere: look for a division by zero, or for numbers that grow "
                "beyond all bounds");
    error.code = Error::Code::divisionByZero;  // it may be one at another time
    return error;
}

/// How the mesh is made: by the polygonize node that it comes from, else by the output node.
void readSettings(const Node& output, const MeshRecipe& recipe, Program& program) {
    program.stages = recipe.stages;
    if (recipe.resolution > 0) {
        program.resolution = recipe.resolution;
        program.method = recipe.method;
        program.region = recipe.region;
        return;
    }
    if (const auto resolution = inputNumbers(output, "resolution"); !resolution.empty())
        program.resolution = static_cast<int>(resolution[0]);
    if (const InputValue* method = output.input("method"))
        if (const auto* name = std::get_if<std::string>(&method->value)) program.method = meshMethod(*name);
}

}  // namespace

std::optional<Type> compiledType(const Graph& graph, std::string_view group, const Link& link) {
    const Group* inside = group.empty() ? nullptr : graph.group(group);
    const std::vector<Node>& nodes = inside ? inside->nodes : graph.nodes;
    const Node* node = findNode(nodes, link.node);
    if (!node) return {};
    CompileOptions options;
    options.bake = boxInPlace;
    options.finest = kLeastFieldResolution;
    GraphLowering lowering(graph, options);
    const Lowered inputs = inside ? defaultsOf(lowering, *inside) : Lowered{};
    const LoweredNodes& lowered = lowering.lowerAll(nodes, "", inside ? &inputs : nullptr, {node});
    const Lowered& made = lowered.at(node->id);
    if (made.failed) return {};
    for (const NodeOutput& output : made.outputs)
        if (link.output.empty() || output.name == link.output) return output.type;
    return {};
}

namespace {

Result<Program> compileGraph(const Graph& graph, const CompileOptions& options) {
    for (const Error& error : checkStructure(graph))
        if (error.severity == Error::Severity::error) return error;
    const Node* output = outputNode(graph);
    if (!output)
        return errorAt(graph, nullptr, "the graph has no output node: add one and connect the surface to it");

    GraphLowering lowering(graph, options);
    const Lowered lowered = lowering.lowerAll(graph.nodes, "", nullptr, {output}).at(output->id);
    Lowered opaque = lowered.transmits ? lowering.lowerOpaque(*output) : lowered;
    for (const Error& finding : lowering.findings)
        if (finding.severity == Error::Severity::error) return finding;

    const NodeOutput& result = lowered.outputs[0];
    Program program;
    std::array<IrId, 2 * kSurfaceComponents> roots;
    std::ranges::copy(opaque.outputs[0].value.ids, std::ranges::copy(result.value.ids, roots.begin()).out);
    writeOutAffine(lowering.state.ir, roots);
    program.ir = lowering.state.ir.compact(roots);
    std::copy_n(roots.begin(), kSurfaceComponents, program.surface.begin());
    std::copy_n(roots.begin() + kSurfaceComponents, kSurfaceComponents, program.opaque.begin());
    program.live = std::move(lowering.live);
    program.origins = std::move(lowering.origins);
    program.painters = std::move(lowering.painters);
    if (auto problem = fieldProblem(graph, *output, program.ir, program.distance())) return *problem;
    program.structureHash = program.ir.hash(roots);
    program.families = findFamilies(program.ir, program.distance());
    program.exactness = result.exactness;
    program.spoiledBy = result.spoiledBy;
    program.nodeExactness = std::move(lowering.exactness);
    program.notes = std::move(lowering.findings);
    if (auto note = largeNumbers(graph, program.ir, program.surface, program.parameters(), program.origins))
        program.notes.push_back(std::move(*note));
    readSettings(*output, result.value.mesh ? *result.value.mesh : MeshRecipe{}, program);
    if (options.triangles > 0)
        program.stages.push_back(
            {.kind = MeshStage::Kind::decimate, .triangles = options.triangles, .byShape = options.byShape});
    return program;
}

}  // namespace

Result<Program> compile(const Graph& graph, const CompileOptions& options) {
    if (options.costByNode) {  // kept apart there may be too many operations
        CompileOptions together = options;
        together.costByNode = false;
        Result<Program> program = compileGraph(graph, options);
        return program ? std::move(program) : compileGraph(graph, together);
    }
    return compileGraph(graph, options);
}

namespace {

/// Heavier fields are not looked for in space: it would take check() seconds.
constexpr double kMostWeightToLookFor = 1.5e5;

/// A warning at the node that has most part in it, by code or by the cost of a sample.
std::optional<Error> warningAtHeaviest(const Graph& graph, double NodeEffort::*cost, const std::string& what,
                                       const std::string& then) {
    CompileOptions options;
    options.bake = boxInPlace;
    options.finest = kLeastFieldResolution;
    options.costByNode = true;
    const Result<Program> program = compile(graph, options);
    if (!program) return std::nullopt;
    const std::vector<NodeEffort> efforts = effortByNode(*program);
    double all = 0;
    for (const NodeEffort& effort : efforts) all += effort.*cost;
    const NodeEffort& most = *std::ranges::max_element(efforts, {}, cost);
    const long share = std::lround(100 * most.*cost / std::max(all, 1.0));
    const std::string part = share > 0 ? std::to_string(share) + " % of it comes from here"
                                       : "no node has more part in it than this, of many";
    return warningAt(
        graph, most.node,
        what + ", and " + part + ": " + then + " ('fieldwright compile --cost' has what each node adds)");
}

/// A warning if a software driver would be busy for long with the field's code; or with pictures, if asked
/// for.
std::optional<Error> slowness(const Graph& graph, Ir& ir, IrId distance, const CompileOptions& options) {
    bool pictures = options.warnOfPictures;
    double weight = codeWeight(ir, distance, {});
    const auto isSlow = [&] {
        return secondsToCompile(weight) > kMostSecondsToCompile ||
               (pictures && secondsToTrace(weight) > kMostSecondsToTrace);
    };
    if (!isSlow()) return std::nullopt;
    writeOutAffine(ir, std::span(&distance, 1));  // as compile() does
    weight = codeWeight(ir, distance, {});
    if (!isSlow()) return std::nullopt;
    pictures = pictures && secondsToTrace(weight) > kMostSecondsToTrace && weight < kMostWeightToLookFor;
    const Families families = findFamilies(ir, distance);
    const double compiling = secondsToCompile(codeWeight(ir, distance, families));
    if (compiling > kMostSecondsToCompile)
        return warningAtHeaviest(graph, &NodeEffort::code,
                                 "the driver would be busy with the field's code for about " +
                                     std::to_string(std::lround(compiling)) + " s",
                                 "the host makes meshes where that is sooner, and pictures are drafts");
    if (!pictures) return std::nullopt;
    const Region region = findRegion(ir, distance, {}, kUnknownLipschitz, options.stop);
    if (region.extent != Extent::bounded) return std::nullopt;
    const double tracing = secondsToTrace(weightAtSurface(ir, distance, families, {}, region.box));
    if (tracing <= kMostSecondsToTrace) return std::nullopt;
    return warningAtHeaviest(graph, &NodeEffort::sample,
                             "light that is traced through the field would take a software device about " +
                                 std::to_string(std::lround(tracing)) +
                                 " s for each sample of 640 x 360 pixels",
                             "there pictures are drafts");
}

}  // namespace

std::vector<Error> compileErrors(const Graph& graph, const CompileOptions& options) {
    CompileOptions unmeasured = options;
    unmeasured.bake = boxInPlace;  // what it would be is of no matter
    unmeasured.finest = kLeastFieldResolution;
    GraphLowering lowering(graph, unmeasured);
    std::vector<const Node*> all;
    for (const Node& node : graph.nodes) all.push_back(&node);
    const LoweredNodes& lowered = lowering.lowerAll(graph.nodes, "", nullptr, all);
    const Node* output = outputNode(graph);
    if (!hasErrors(lowering.findings) && output) {
        // Only what the output needs counts.
        std::array<IrId, kSurfaceComponents> surface = lowered.at(output->id).outputs[0].value.ids;
        if (lowered.at(output->id).transmits) lowering.lowerOpaque(*output);
        const bool small = lowering.state.ir.size() <= kMaxIrOperations;
        std::vector<double> parameters;
        for (const LiveParameter& parameter : lowering.live) parameters.push_back(parameter.value);
        if (small)
            if (auto note = largeNumbers(graph, lowering.state.ir, surface, parameters, lowering.origins))
                lowering.findings.push_back(std::move(*note));
        const Ir needed = small ? Ir() : lowering.state.ir.compact(surface);
        if (auto problem =
                fieldProblem(graph, *output, small ? lowering.state.ir : needed, surface[distanceComponent]))
            lowering.findings.push_back(*problem);
        else if (auto slow = slowness(graph, lowering.state.ir, surface[distanceComponent], options))
            lowering.findings.push_back(*slow);
    }
    return std::move(lowering.findings);
}

Done checkLive(const Graph& graph, const CompileOptions& options) {
    std::vector<std::string> names;
    CompileOptions folded;
    folded.bake = boxInPlace;
    folded.finest = kLeastFieldResolution;
    GraphLowering lowering(graph, folded);
    lowering.canBeLive = &names;
    std::vector<const Node*> all;
    for (const Node& node : graph.nodes) all.push_back(&node);
    lowering.lowerAll(graph.nodes, "", nullptr, all);
    names.push_back("time");
    for (const std::string& wish : options.live) {
        if (std::find(names.begin(), names.end(), wish) != names.end()) continue;
        const std::string near = nearestName(std::string_view(wish).substr(0, 64), names);
        std::vector<std::string> ofNode;
        for (const std::string& name : names)
            if (name.starts_with(wish.substr(0, wish.rfind('.')) + ".")) ofNode.push_back(name);
        return errorAt(graph, nullptr,
                       "there is no input " + inQuotes(wish) +
                           " that can be live: write node.input, of a number or vector that is not linked" +
                           (!near.empty()    ? "; did you mean " + inQuotes(near) + "?"
                            : ofNode.empty() ? ""
                                             : "; the node has " + listed(ofNode)));
    }
    return done();
}

}  // namespace fw
