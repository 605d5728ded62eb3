#include "graph/compile/unbounded_node.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "graph/base/words.h"
#include "graph/compile/compile.h"
#include "graph/compile/graph_lowering.h"
#include "graph/compile/node_fields.h"
#include "graph/ir/affine_sums.h"
#include "graph/rules/structure.h"

namespace fw {

namespace {

using SearchClock = std::chrono::steady_clock;

bool isSolid(Type type) { return type == Type::surface || type == Type::scalar; }

/// Every scope's nodes and their fields.
struct Scope {
    std::unordered_map<std::string_view, const Node*> nodes;
    std::unordered_map<std::string_view, std::vector<const NodeField*>> fieldsOf;
    std::vector<NodeField> fields;
};

/// Finds regions of fields of one Ir, each once.
class RegionCache {
  public:
    RegionCache(Ir ir_, std::vector<double> parameters_, std::unordered_map<IrId, double> lipschitz_,
                std::stop_token stop_)
        : ir(std::move(ir_)),
          parameters(std::move(parameters_)),
          lipschitz(std::move(lipschitz_)),
          stop(std::move(stop_)) {}

    void startTimer(double maxSeconds) {
        end = SearchClock::now() +
              std::chrono::duration_cast<SearchClock::duration>(std::chrono::duration<double>(maxSeconds));
    }

    /// Nothing if the time is over, or if stopped.
    std::optional<Region> find(IrId root) {
        if (const auto known = regions.find(root); known != regions.end()) return known->second;
        const std::vector<IrId> operands = minimumOperands(root);
        // A union is bounded if its operands are, whose regions other nodes need too.
        std::optional<Region> unproven;
        for (const IrId operand : operands) {
            const std::optional<Region> region = findWhole(operand);
            if (!region || region->extent == Extent::unbounded) return region;
            if (region->extent == Extent::unproven) unproven = region;
        }
        if (!unproven || operands.size() == 1) return unproven.value_or(Region{});
        // The Lipschitz constant may be known of the whole only.
        return findWhole(root);
    }

    /// The same, but of a union all at once.
    std::optional<Region> findWhole(IrId root) {
        if (const auto known = regions.find(root); known != regions.end()) return known->second;
        if (stop.stop_requested() || (end && SearchClock::now() >= *end)) return std::nullopt;
        IrId compactRoot = root;
        const Ir part = ir.compact(std::span(&compactRoot, 1));
        const auto known = lipschitz.find(root);
        const Region region = findRegion(part, compactRoot, parameters,
                                         known == lipschitz.end() ? kUnknownLipschitz : known->second, stop);
        if (stop.stop_requested()) return std::nullopt;
        regions.emplace(root, region);
        return region;
    }

    /// Whether the solid `operand` is a part of the union `root`.
    bool isPartOfUnion(IrId operand, IrId root) const {
        const std::vector<IrId> all = minimumOperands(root), parts = minimumOperands(operand);
        const std::unordered_set<IrId> known(all.begin(), all.end());
        return std::ranges::all_of(parts, [&](IrId part) { return known.contains(part); });
    }

  private:
    std::vector<IrId> minimumOperands(IrId root) const {
        std::vector<IrId> operands, pending{root};
        std::unordered_set<IrId> seen;
        while (!pending.empty()) {
            const IrId id = pending.back();
            pending.pop_back();
            if (!seen.insert(id).second) continue;
            if (ir[id].op == Op::minimum)
                pending.insert(pending.end(), {ir[id].operands[1], ir[id].operands[0]});
            else
                operands.push_back(id);
        }
        return operands;
    }

    Ir ir;
    std::vector<double> parameters;
    std::unordered_map<IrId, double> lipschitz;
    std::stop_token stop;
    std::optional<SearchClock::time_point> end;
    std::unordered_map<IrId, Region> regions;
};

class UnboundedNodeSearch {
  public:
    UnboundedNodeSearch(const Graph& graph_, const UnboundedNodeOptions& options_)
        : graph(graph_), options(options_) {}

    std::optional<UnboundedNode> run() {
        const Node* output = lower();
        if (!output) return std::nullopt;
        RegionCache cache(std::move(ir), std::move(parameters), std::move(lipschitz), options.stop);
        std::optional<Found> found;
        for (const Candidate& candidate : surfaceInputs({"", output}))
            if (const auto region = cache.findWhole(candidate.root); region && !isFinite(*region)) {
                found = Found{candidate, *region};
                break;
            }
        if (!found) return std::nullopt;
        cache.startTimer(options.maxSeconds);
        bool complete = true;
        while (const std::optional<Found> next = nextUpstream(cache, *found, complete)) found = next;
        if (options.stop.stop_requested()) return std::nullopt;
        const Place& place = found->candidate.place;
        const NodeType* type = findNodeType(place.node->type);
        return UnboundedNode{
            place.prefix + place.node->id, place.node->label,      type ? type->label : std::string(),
            found->region.extent,          found->region.unproven, complete};
    }

  private:
    struct Place {
        std::string prefix;
        const Node* node = nullptr;
    };
    /// A node whose field arrives at an input.
    struct Candidate {
        Place place;
        IrId root = 0;
    };
    struct Found {
        Candidate candidate;
        Region region;
    };

    static bool isFinite(const Region& region) {
        return region.extent == Extent::bounded || region.extent == Extent::empty;
    }

    /// The output node; nullptr if the graph does not compile.
    const Node* lower() {
        for (const Error& error : checkStructure(graph))
            if (error.severity == Error::Severity::error) return nullptr;
        const auto output = std::ranges::find_if(
            graph.nodes, [](const Node& node) { return roleOf(node.type) == NodeRole::output; });
        if (output == graph.nodes.end()) return nullptr;
        CompileOptions compileOptions;
        compileOptions.time = options.time;
        compileOptions.bake = boxInPlace;
        compileOptions.finest = kLeastFieldResolution;
        GraphLowering lowering(graph, compileOptions);
        lowering.lowerAll(graph.nodes, "", nullptr, {&*output});
        for (const Error& finding : lowering.findings)
            if (finding.severity == Error::Severity::error) return nullptr;
        gather(lowering, "");
        for (const LiveParameter& live : lowering.live) parameters.push_back(live.value);
        takeRoots(lowering.state.ir);
        return &*output;
    }

    void gather(const GraphLowering& lowering, const std::string& prefix) {
        Scope& scope = scopes[prefix];
        scope.fields = gatherNodeFields(graph, lowering, prefix, FieldSelection::all);
        for (const NodeField& field : scope.fields) scope.fieldsOf[field.node].push_back(&field);
        for (const Node& node : *nodesInScope(graph, prefix)) {
            scope.nodes[node.id] = &node;
            const std::string inner = prefix + node.id + "/";
            if (!node.group.empty() && !node.muted && lowering.nodesIn(inner)) gather(lowering, inner);
        }
    }

    /// Makes the fields' distances roots of `ir`.
    void takeRoots(Ir& lowered) {
        std::vector<NodeField*> fields;
        std::vector<IrId> roots;
        for (auto& [prefix, scope] : scopes)
            for (NodeField& field : scope.fields)
                if (isSolid(field.type)) {
                    fields.push_back(&field);
                    roots.push_back(field.roots[distanceComponent]);
                }
        writeOutAffine(lowered, roots);
        ir = lowered.compact(roots);
        for (std::size_t i = 0; i < fields.size(); ++i) {
            fields[i]->roots[distanceComponent] = roots[i];
            if (fields[i]->type != Type::surface) continue;
            const auto [known, added] = lipschitz.emplace(roots[i], fields[i]->exactness.lipschitz);
            if (!added) known->second = std::min(known->second, fields[i]->exactness.lipschitz);
        }
    }

    const NodeField* fieldAt(const std::string& prefix, const Link& link) const {
        const auto scope = scopes.find(prefix);
        if (scope == scopes.end()) return nullptr;
        const auto fields = scope->second.fieldsOf.find(link.node);
        if (fields == scope->second.fieldsOf.end()) return nullptr;
        for (const NodeField* field : fields->second)
            if (link.output.empty() || field->output == link.output) return field;
        return nullptr;
    }

    static bool takesSurface(const Node& node, const std::string& input) {
        const NodeType* type = findNodeType(node.type);
        const int index = type ? inputIndex(*type, input) : -1;
        return index >= 0 && flowsAs(type->inputs[std::size_t(index)].type) == Type::surface;
    }

    /// The nodes that give the surfaces that this node takes, in the order of its type's inputs.
    std::vector<Candidate> surfaceInputs(const Place& place) const {
        std::vector<std::pair<int, Candidate>> sorted;
        const NodeType* type = findNodeType(place.node->type);
        for (const auto& [name, value] : place.node->inputs) {
            const Link* link = std::get_if<Link>(&value.value);
            const NodeField* field = link ? fieldAt(place.prefix, *link) : nullptr;
            if (!field || !isSolid(field->type)) continue;
            if (field->type != Type::surface && !takesSurface(*place.node, name)) continue;
            sorted.push_back({type ? inputIndex(*type, name) : -1,
                              {sourceOf(place.prefix, *link), field->roots[distanceComponent]}});
        }
        std::ranges::stable_sort(sorted, {}, [](const auto& entry) { return entry.first; });
        std::vector<Candidate> candidates;
        for (auto& [index, candidate] : sorted) candidates.push_back(std::move(candidate));
        return candidates;
    }

    /// The node that makes what a link leads to, inside groups and past reroutes and muted nodes.
    Place sourceOf(std::string prefix, Link link) const {
        Place place;
        while (true) {
            const auto scope = scopes.find(prefix);
            if (scope == scopes.end()) return place;
            const auto node = scope->second.nodes.find(link.node);
            if (node == scope->second.nodes.end()) return place;
            place = {prefix, node->second};
            const std::optional<std::pair<std::string, Link>> next = passed(place, link);
            if (!next) return place;
            std::tie(prefix, link) = *next;
        }
    }

    /// Where the node takes the result from that it only passes on; nothing if it makes it.
    std::optional<std::pair<std::string, Link>> passed(const Place& place, const Link& link) const {
        const Node& node = *place.node;
        const NodeRole role = roleOf(node.type);
        if (role == NodeRole::groupInput) return givenToInstance(place.prefix, link.output);
        if (node.muted || role == NodeRole::reroute) {
            const NodeField* own = fieldAt(place.prefix, link);
            for (const auto& [name, value] : node.inputs) {
                const Link* from = std::get_if<Link>(&value.value);
                const NodeField* field = from ? fieldAt(place.prefix, *from) : nullptr;
                if (own && field && field->roots[distanceComponent] == own->roots[distanceComponent])
                    return std::pair(place.prefix, *from);
            }
            return std::nullopt;
        }
        const Group* group = node.group.empty() ? nullptr : graph.group(node.group);
        if (!group) return std::nullopt;
        const std::string name =
            link.output.empty() && !group->outputs.empty() ? group->outputs[0].name : link.output;
        for (const Node& inner : group->nodes)
            if (roleOf(inner.type) == NodeRole::groupOutput)
                if (const InputValue* value = inner.input(name))
                    if (const Link* from = std::get_if<Link>(&value->value))
                        return std::pair(place.prefix + node.id + "/", *from);
        return std::nullopt;
    }

    /// The link at an input of the instance that the prefix ends with.
    std::optional<std::pair<std::string, Link>> givenToInstance(const std::string& prefix,
                                                                const std::string& name) const {
        const std::size_t slash =
            prefix.size() < 2 ? std::string::npos : prefix.rfind('/', prefix.size() - 2);
        const std::size_t begin = slash == std::string::npos ? 0 : slash + 1;
        const std::string outer = prefix.substr(0, begin),
                          id = prefix.substr(begin, prefix.size() - 1 - begin);
        const auto scope = scopes.find(outer);
        const auto instance = scope->second.nodes.find(id);
        const Group* group = graph.group(instance->second->group);
        if (!group) return std::nullopt;
        const InputValue* value =
            instance->second->input(name.empty() && !group->inputs.empty() ? group->inputs[0].name : name);
        const Link* from = value ? std::get_if<Link>(&value->value) : nullptr;
        return from ? std::optional(std::pair(outer, *from)) : std::nullopt;
    }

    /// An input of the node that is not bounded either. `complete` is cleared if that could not be found out.
    std::optional<Found> nextUpstream(RegionCache& cache, const Found& from, bool& complete) const {
        const NodeRole role = roleOf(from.candidate.place.node->type);
        complete = true;
        // The search ends at a group's instance or a muted node if its result is a number or a default.
        if (role == NodeRole::group || role == NodeRole::groupInput || from.candidate.place.node->muted)
            return std::nullopt;
        std::optional<Found> first;
        for (const Candidate& candidate : surfaceInputs(from.candidate.place)) {
            const std::optional<Region> region = cache.find(candidate.root);
            if (!region) complete = false;
            if (!region || isFinite(*region)) continue;
            if (region->extent == Extent::unbounded &&
                cache.isPartOfUnion(candidate.root, from.candidate.root))
                return Found{candidate, *region};
            if (!first) first = Found{candidate, *region};
        }
        return first;
    }

    const Graph& graph;
    const UnboundedNodeOptions& options;
    std::map<std::string, Scope> scopes;
    Ir ir;
    std::vector<double> parameters;
    std::unordered_map<IrId, double> lipschitz;
};

std::string pointText(const Point& point) {
    return "(" + shortNumber(point[0]) + " " + shortNumber(point[1]) + " " + shortNumber(point[2]) + ")";
}

}  // namespace

std::optional<UnboundedNode> findUnboundedNode(const Graph& graph, const UnboundedNodeOptions& options) {
    return UnboundedNodeSearch(graph, options).run();
}

std::string describe(const UnboundedNode& node) {
    std::string text = "node " + inQuotes(node.path);
    if (!node.typeLabel.empty()) text += " (" + node.typeLabel + ")";
    if (!node.isCause) text += ", or a node upstream of it,";
    if (node.extent == Extent::unbounded) return text + " is unbounded";
    return text + " cannot be proven bounded: " + describeUnproven(node.unproven);
}

std::string describeUnproven(const Box& unproven) {
    return "there may be solid between " + pointText(unproven.lo) + " and " + pointText(unproven.hi);
}

}  // namespace fw
