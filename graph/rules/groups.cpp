// The part of check() about groups.

#include "graph/base/words.h"
#include "graph/document/input_value.h"
#include "graph/rules/findings.h"

namespace fw {

namespace {

/// One input or output of a group; `first` tells whether its name is new.
template <class Entry>
void checkDeclaration(const Group& group, const Entry& entry, const std::string& what, bool first,
                      Findings& findings) {
    const Place place{entry.place, group.id, entry.name};
    if (!isName(entry.name))
        findings.error(place, "the name " + inQuotes(entry.name) + " of a group's " + what +
                                  " is not letters, digits and '_', beginning with a letter");
    if (!typeNamed(entry.type)) {
        std::vector<std::string> names;
        for (int i = 0; i < kTypes; ++i) names.emplace_back(typeName(static_cast<Type>(i)));
        findings.error(place, "unknown type " + inQuotes(entry.type) + findings.hint(entry.type, names) +
                                  "; the types are " + listed(names));
    }
    if (!first)
        findings.error(place,
                       "the group has two " + what + "s named " + inQuotes(entry.name) + ": rename one");
}

void checkDefault(const Group& group, const GroupInput& input, Findings& findings) {
    const Place place{input.value->at, group.id, input.name};
    if (std::holds_alternative<Link>(input.value->value))
        return findings.error(place, "the default of a group's input is a value, not a link: remove it");
    if (const auto type = typeNamed(input.type))
        if (auto problem = valueProblem(*type, nullptr, *input.value))
            findings.error(place, std::move(*problem));
}

/// How many nodes a list of nodes comes to with the groups in it expanded, and how deep they are nested.
struct Extent {
    std::size_t nodes = 0, depth = 0;
};

Extent extentOf(const std::vector<Node>& nodes, const Groups& groups, const std::vector<Extent>& known) {
    Extent extent{nodes.size(), 0};
    for (const Node& node : nodes)
        if (const auto inner = groups.of(node)) {
            extent.nodes = std::min(extent.nodes + known[*inner].nodes, 2 * kMaxExpandedNodes);
            extent.depth = std::max(extent.depth, known[*inner].depth + 1);
        }
    return extent;
}

void checkNesting(const Graph& graph, const Groups& groups, Findings& findings) {
    Edges edges(groups.list.size());
    std::vector<std::vector<const Node*>> instances(groups.list.size());  // the node behind each edge
    for (uint32_t i = 0; i < groups.list.size(); ++i)
        for (const Node& node : groups.list[i].group->nodes)
            if (const auto inner = groups.of(node)) {
                edges[i].push_back(*inner);
                instances[i].push_back(&node);
            }
    std::vector<Extent> extents(groups.list.size());
    bool cyclic = false;
    const auto id = [&](uint32_t i) { return std::string_view(groups.list[i].group->id); };
    walk(
        edges,
        [&](const std::vector<uint32_t>& stack, uint32_t edge) {
            cyclic = true;
            const uint32_t from = stack.back();
            const Node& node = *instances[from][edge];
            const Place place{node.place, std::string(id(from)) + "/" + node.id, {}};
            const auto names =
                findings.full() ? std::vector{id(from)} : cycleNames(stack, edges[from][edge], id);
            findings.error(place, "group " + inQuotes(names.front()) + " contains itself: " + arrows(names) +
                                      "; remove this node");
        },
        [&](uint32_t i) { extents[i] = extentOf(groups.list[i].group->nodes, groups, extents); });
    if (cyclic) return;
    const Extent whole = extentOf(graph.nodes, groups, extents);
    if (whole.depth > static_cast<std::size_t>(kMaxNesting))
        findings.error(
            {}, "groups are nested deeper than " + std::to_string(kMaxNesting) + " levels: flatten them");
    if (whole.nodes > kMaxExpandedNodes)
        findings.error({}, "with every instance of a group counted the graph has more than " +
                               std::to_string(kMaxExpandedNodes) +
                               " nodes: use fewer instances, or a repeat node");
}

}  // namespace

void checkGroups(const Graph& graph, const Groups& groups, Findings& findings) {
    for (const Group& group : graph.groups) {
        const Place place{group.place, group.id, {}};
        if (!isId(group.id))
            findings.error(place, inQuotes(group.id) +
                                      " is no id for a group: use a-z, 0-9 and '_', beginning with a letter");
        const Group& first = *groups.list[groups.byId.at(group.id)].group;
        if (&first != &group)
            findings.error(place, "two groups have the id " + inQuotes(group.id) + firstInLine(first.place) +
                                      ": rename one");
        std::unordered_map<std::string_view, bool> inputs, outputs;
        for (const GroupInput& input : group.inputs) {
            checkDeclaration(group, input, "input", inputs.try_emplace(input.name).second, findings);
            if (input.value) checkDefault(group, input, findings);
        }
        for (const GroupOutput& output : group.outputs)
            checkDeclaration(group, output, "output", outputs.try_emplace(output.name).second, findings);
    }
    checkNesting(graph, groups, findings);
}

}  // namespace fw
