// Nodes into one Ir: what each of a document's nodes gives, in the order in which they need each other.
//
// A node of the library with a body is lowered by its body (language/lower.h). The others have a hook in
// their entry of the node table, one of those at the end: they read their inputs as they need them and give
// what they make. Groups are expanded in place: their fields are values like any other. A muted node passes
// on its first input of its output's type.
//
// Where light passes through some of the surfaces, the nodes that such went into are lowered a second time
// without them (lowerOpaque): what is left is the solid part of the whole, which rays of light need apart.
//
// Lifetime: one GraphLowering for one compilation.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "graph/compile/compile.h"
#include "graph/language/resolve.h"
#include "graph/library/node_type.h"

namespace fw {

/// One output of a node.
struct NodeOutput {
    std::string name;
    Type type;
    language::Value value = {};
    Exactness exactness = distorted();  ///< of a surface
    std::string spoiledBy = {};         ///< as Program::spoiledBy
};

/// What a node gives. After a mistake, which was reported, outputs that stand for it.
struct Lowered {
    std::vector<NodeOutput> outputs = {};
    bool failed = false;
    bool transmits = false;  ///< light passes through something that went into it
};
using LoweredNodes = std::unordered_map<std::string, Lowered>;

/// A node where it stands.
struct NodeAt {
    const Node& node;
    const NodeType& type;
    const std::string& prefix;  ///< ids of the groups that it is in, each with a slash behind
    const LoweredNodes& done;   ///< the nodes beside it that were lowered before: all that it links to
    const Lowered* groupInput;  ///< what its group receives; null outside of groups

    std::string path() const { return prefix + node.id; }
};

/// An input of the library, as a node has it.
struct NodeInput {
    const InputSpec* spec;
    language::Value value;
    const NodeOutput* from = nullptr;  ///< what is linked to it
    Exactness exactness = kExact;      ///< of a surface
};

class GraphLowering {
  public:
    GraphLowering(const Graph& graph, const CompileOptions& options);

    /// Lowers `targets` and what they need among `nodes`.
    const LoweredNodes& lowerAll(const std::vector<Node>& nodes, const std::string& prefix,
                                 const Lowered* groupInput, const std::vector<const Node*>& targets);
    /// What the target, a node of the document that was lowered, gives without what light passes through.
    Lowered lowerOpaque(const Node& target);
    /// What was lowered of the document's nodes, or of an instance's by its prefix; nullptr if nothing was.
    const LoweredNodes* nodesIn(const std::string& prefix) const;

    // ---- for hooks

    /// An error, or a warning, about an input of the node; about the node itself if `input` is empty.
    void report(const NodeAt& at, std::string_view input, Error error);
    void warn(const NodeAt& at, std::string_view input, std::string message);
    /// What stands for the outputs of a node that failed.
    Lowered failure(const std::vector<OutputSpec>& outputs);

    /// Whether light passes through something that is linked to the node.
    static bool receivesTransmission(const NodeAt& at);
    /// What a link leads to; nullptr where that is nothing. `failed` is set where its node failed.
    const NodeOutput* linked(const NodeAt& at, const Link& link, bool& failed) const;
    /// The value that the file or the library gives for an input that is not linked. `folded`: may not be
    /// live.
    language::Value literal(const NodeAt& at, const InputSpec& spec, const InputValue* given,
                            bool folded = false);
    /// The node's inputs, in the order of the library; none, reported, if one is not what it should be.
    std::optional<std::vector<NodeInput>> inputs(const NodeAt& at);
    /// A number that must be known when the graph is compiled. Reported, and none, if it is not.
    std::optional<double> knownNumber(const NodeAt& at, const std::vector<NodeInput>& inputs,
                                      std::string_view name, int component = 0);
    /// What a muted node, or a reroute, gives: the first linked input that fits the first of `outputs`;
    /// without `outputs` the first input.
    Lowered passOn(const NodeAt& at, const std::vector<OutputSpec>* outputs);
    /// By the body of the node's type.
    Lowered lowerBody(const NodeAt& at);
    Lowered lowerBody(const NodeAt& at, const std::vector<NodeInput>& inputs);
    /// Class of the node's surface by its type's rule, given its inputs.
    void classify(const NodeAt& at, const std::vector<NodeInput>& inputs, NodeOutput& surface);

    const Graph& graph;
    const CompileOptions& options;
    language::Lowering state;
    std::vector<Error> findings;  ///< errors and warnings
    std::vector<LiveParameter> live;
    std::map<std::string, NodeExactness, std::less<>> exactness;
    std::vector<std::string> origins = {""};        ///< Program::origins
    std::vector<std::string> painters = {""};       ///< Program::painters
    std::vector<std::string>* canBeLive = nullptr;  ///< gets the name of every input that can be, if not null
    /// Of a node's code and the types of its inputs (-1: unknown), for groups have it in each instance.
    std::map<std::pair<const Node*, std::vector<int>>, language::Resolved> resolved;
    std::set<std::string, std::less<>> nearFields = {};  ///< particles_to_field without true distances
    std::set<std::string, std::less<>> gridded = {};     ///< nodes whose distances were measured on a grid

  private:
    /// Those of each group's instance, by its prefix; and, while the opaque part is made, those of the whole.
    std::map<std::string, LoweredNodes> lowered, whole;
    std::unordered_map<std::string, uint32_t> originOf;   ///< its number among `origins`
    std::unordered_map<const Node*, uint32_t> painterOf;  ///< its number among `painters`

    Lowered lower(const NodeAt& at);

    IrId liveComponent(const std::string& name, int component, double value);
    std::string liveName(const NodeAt& at, const std::string& input) const;
    std::optional<language::Value> linkedValue(const NodeAt& at, const InputSpec& spec,
                                               const NodeOutput& from);
    void keepInRange(const NodeAt& at, const InputSpec& spec, language::Value& value, bool& fine);
};

/// The operation of a field that moves, a live parameter or particles; nullptr if all of it is known when the
/// graph is compiled.
const IrNode* movingIn(const Ir& ir, IrId root);
/// The named one of a node's inputs, which it has.
const language::Value& inputOf(const std::vector<NodeInput>& inputs, std::string_view name);
/// A mesh is known by the surface that it is made from.
Type flowsAs(Type type);
/// The type of an input that the document alone declares, by its value.
Type literalType(const InputValue& input);
/// What a group receives from an instance that gives nothing.
Lowered defaultsOf(GraphLowering& lowering, const Group& group);

// Hooks of the node table. groups.cpp:
Lowered lowerGroup(GraphLowering& lowering, const NodeAt& at);
Lowered lowerGroupInput(GraphLowering& lowering, const NodeAt& at);
Lowered lowerGroupOutput(GraphLowering& lowering, const NodeAt& at);
Lowered lowerReroute(GraphLowering& lowering, const NodeAt& at);
Lowered lowerExpression(GraphLowering& lowering, const NodeAt& at);
Lowered lowerNothing(GraphLowering& lowering, const NodeAt& at);
// meshes.cpp:
Lowered lowerMeshFile(GraphLowering& lowering, const NodeAt& at);
Lowered lowerMeshToField(GraphLowering& lowering, const NodeAt& at);
Lowered lowerPolygonize(GraphLowering& lowering, const NodeAt& at);
Lowered lowerSmooth(GraphLowering& lowering, const NodeAt& at);
Lowered lowerSubdivide(GraphLowering& lowering, const NodeAt& at);
Lowered lowerDecimate(GraphLowering& lowering, const NodeAt& at);
Lowered lowerDropCrumbs(GraphLowering& lowering, const NodeAt& at);
Lowered lowerOutput(GraphLowering& lowering, const NodeAt& at);
/// The surface of a volume at the node's input "p". Used by meshes and particles.
Lowered sampledVolume(GraphLowering& lowering, const NodeAt& at, const std::vector<NodeInput>& inputs,
                      const FieldVolumePtr& volume, VolumeChannel distance);
/// What to say if the graph's volumes would take too much with this one, about an input "resolution".
std::optional<Error> tooManySamples(const GraphLowering& lowering, const FieldVolumePtr& volume);
// particles.cpp:
Lowered lowerEmitter(GraphLowering& lowering, const NodeAt& at);
Lowered lowerParticleFile(GraphLowering& lowering, const NodeAt& at);
Lowered lowerParticleDynamics(GraphLowering& lowering, const NodeAt& at);
Lowered lowerFluid(GraphLowering& lowering, const NodeAt& at);
Lowered lowerFoam(GraphLowering& lowering, const NodeAt& at);
Lowered lowerParticlesToField(GraphLowering& lowering, const NodeAt& at);
// walls.cpp:
Lowered lowerTrueDistance(GraphLowering& lowering, const NodeAt& at);
Lowered lowerRoundEdges(GraphLowering& lowering, const NodeAt& at);
Lowered lowerChamferEdges(GraphLowering& lowering, const NodeAt& at);
/// The body of `offset` and `shell`, with a warning about distances that are not true.
Lowered lowerOffset(GraphLowering& lowering, const NodeAt& at);
// repetitions.cpp:
/// The body of a repetition, with a warning if the surface does not fit into its cell or sector.
Lowered lowerRepeat(GraphLowering& lowering, const NodeAt& at);
Lowered lowerPolarRepeat(GraphLowering& lowering, const NodeAt& at);
Lowered lowerScatter(GraphLowering& lowering, const NodeAt& at);
// splines.cpp:
/// The body of `sweep`, with a bound that tells intervals where nothing is.
Lowered lowerSweep(GraphLowering& lowering, const NodeAt& at);

}  // namespace fw
