#include "editor/document/brought_groups.h"

#include <set>
#include <string_view>
#include <unordered_map>

#include "editor/document/edits.h"

namespace fw::editor {

std::vector<Group> groupsFor(const std::vector<Node>& nodes, const std::vector<Group>& groups) {
    std::set<std::string_view> needed;
    std::vector<const std::vector<Node>*> open{&nodes};
    while (!open.empty()) {
        const std::vector<Node>& next = *open.back();
        open.pop_back();
        for (const Node& node : next)
            if (!node.group.empty() && needed.insert(node.group).second)
                for (const Group& group : groups)
                    if (group.id == node.group) open.push_back(&group.nodes);
    }
    std::vector<Group> found;
    for (const Group& group : groups)
        if (needed.contains(group.id)) found.push_back(group);
    return found;
}

void addGroups(Graph& from, Graph& to) {
    FreshIds ids(to.groups);
    std::unordered_map<std::string, std::string> renamed;
    std::vector<Group> added;
    for (Group& group : from.groups) {
        const Group* there = to.group(group.id);
        if (there && *there == group) continue;
        const std::string former = group.id;
        group.id = ids.next(group.id);
        if (group.id != former) renamed.emplace(former, group.id);
        added.push_back(std::move(group));
    }
    const auto follow = [&](std::vector<Node>& nodes) {
        for (Node& node : nodes)
            if (const auto found = renamed.find(node.group); found != renamed.end())
                node.group = found->second;
    };
    follow(from.nodes);
    for (Group& group : added) {
        follow(group.nodes);
        to.groups.push_back(std::move(group));
    }
}

}  // namespace fw::editor
