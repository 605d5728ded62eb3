#include "graph/compile/compile.h"

#include <algorithm>
#include <cmath>

#include "graph/base/words.h"
#include "graph/compile/effort.h"
#include "graph/compile/graph_lowering.h"
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

/// A warning if the driver would be busy with the field for long, at the node that has most part in that.
std::optional<Error> slowness(const Graph& graph, GraphLowering& lowering, IrId distance) {
    Ir& ir = lowering.state.ir;
    if (secondsToCompile(codeWeight(ir, distance, {})) <= kMostSecondsToCompile) return std::nullopt;
    const Families families = findFamilies(ir, distance);
    const double weight = codeWeight(ir, distance, families), seconds = secondsToCompile(weight);
    if (seconds <= kMostSecondsToCompile) return std::nullopt;
    const NodeEffort most = effortByNode(ir, std::span(&distance, 1), families, lowering.origins).front();
    const Node* node = graph.node(most.node.substr(0, most.node.find('/')));
    const auto rounded = [](double number) { return std::to_string(std::lround(number)); };
    Error warning = errorAt(graph, node,
                            "the driver would be busy with the field's code for about " + rounded(seconds) +
                                " s, and " + rounded(100 * most.code / std::max(weight, 1.0)) +
                                " % of it comes from here: the host makes meshes where that is sooner, and "
                                "pictures are drafts ('fieldwright compile --cost' has what each node adds)");
    warning.node = most.node;
    warning.severity = Error::Severity::warning;
    return warning;
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
    GraphLowering lowering(graph, options);
    const Lowered inputs = inside ? defaultsOf(lowering, *inside) : Lowered{};
    const LoweredNodes lowered = lowering.lowerAll(nodes, "", inside ? &inputs : nullptr, {node});
    const Lowered& made = lowered.at(node->id);
    if (made.failed) return {};
    for (const NodeOutput& output : made.outputs)
        if (link.output.empty() || output.name == link.output) return output.type;
    return {};
}

Result<Program> compile(const Graph& graph, const CompileOptions& options) {
    for (const Error& error : checkStructure(graph))
        if (error.severity == Error::Severity::error) return error;
    const Node* output = outputNode(graph);
    if (!output)
        return errorAt(graph, nullptr, "the graph has no output node: add one and connect the surface to it");

    GraphLowering lowering(graph, options);
    LoweredNodes lowered = lowering.lowerAll(graph.nodes, "", nullptr, {output});
    for (const Error& finding : lowering.findings)
        if (finding.severity == Error::Severity::error) return finding;

    const NodeOutput& result = lowered.at(output->id).outputs[0];
    Program program;
    std::copy_n(result.value.ids.begin(), 9, program.surface.begin());
    writeOutAffine(lowering.state.ir, program.surface);
    program.ir = lowering.state.ir.compact(program.surface);
    program.live = std::move(lowering.live);
    program.origins = std::move(lowering.origins);
    if (auto problem = fieldProblem(graph, *output, program.ir, program.distance())) return *problem;
    program.structureHash = program.ir.hash(program.surface);
    program.families = findFamilies(program.ir, program.distance());
    program.exactness = result.exactness;
    program.spoiledBy = result.spoiledBy;
    program.nodeExactness = std::move(lowering.exactness);
    program.notes = std::move(lowering.findings);
    readSettings(*output, result.value.mesh ? *result.value.mesh : MeshRecipe{}, program);
    return program;
}

std::vector<Error> compileErrors(const Graph& graph, const CompileOptions& options) {
    CompileOptions unmeasured = options;
    unmeasured.bake = boxInPlace;  // what it would be is of no matter
    GraphLowering lowering(graph, unmeasured);
    std::vector<const Node*> all;
    for (const Node& node : graph.nodes) all.push_back(&node);
    const LoweredNodes lowered = lowering.lowerAll(graph.nodes, "", nullptr, all);
    const Node* output = outputNode(graph);
    if (!hasErrors(lowering.findings) && output) {
        // Only what the output needs counts.
        std::array<IrId, 9> surface = lowered.at(output->id).outputs[0].value.ids;
        const bool small = lowering.state.ir.size() <= kMaxIrOperations;
        const Ir needed = small ? Ir() : lowering.state.ir.compact(surface);
        if (auto problem =
                fieldProblem(graph, *output, small ? lowering.state.ir : needed, surface[distanceComponent]))
            lowering.findings.push_back(*problem);
        else if (auto slow = slowness(graph, lowering, surface[distanceComponent]))
            lowering.findings.push_back(*slow);
    }
    return std::move(lowering.findings);
}

Done checkLive(const Graph& graph, const CompileOptions& options) {
    std::vector<std::string> names;
    CompileOptions folded;
    folded.bake = boxInPlace;
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
