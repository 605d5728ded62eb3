#include "graph/node_type.h"

#include <algorithm>
#include <cassert>
#include <iterator>
#include <numeric>
#include <unordered_map>

namespace fw {
namespace {

std::vector<NodeType> gatherNodeTypes() {
    std::vector<NodeType> all;
    for (auto family : {shapeNodes, shape2dNodes, combineNodes, domainNodes, fieldNodes, mathsNodes,
                        materialNodes, meshNodes, stageNodes, particleNodes}) {
        std::vector<NodeType> nodes = family();
        std::move(nodes.begin(), nodes.end(), std::back_inserter(all));
    }
    return all;
}

/// Ids and aliases to indices in nodeTypes().
std::unordered_map<std::string_view, std::size_t> indexNames() {
    std::unordered_map<std::string_view, std::size_t> index;
    const std::vector<NodeType>& types = nodeTypes();
    for (std::size_t i = 0; i < types.size(); i++) {
        bool unique = index.emplace(types[i].id, i).second;
        for (const std::string& alias : types[i].aliases) unique = index.emplace(alias, i).second && unique;
        assert(unique && "an id or alias names two node types");
        (void)unique;
    }
    return index;
}

/// Number of insertions, deletions, replacements and swaps of neighbours that turn `a` into `b` (the
/// restricted Damerau-Levenshtein distance).
std::size_t editDistance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> beforeLast, last(b.size() + 1), row(b.size() + 1);
    std::iota(last.begin(), last.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); i++) {
        row[0] = i + 1;
        for (std::size_t j = 0; j < b.size(); j++) {
            row[j + 1] = std::min({last[j] + (a[i] != b[j]), last[j + 1] + 1, row[j] + 1});
            if (i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j]) {
                row[j + 1] = std::min(row[j + 1], beforeLast[j - 1] + 1);
            }
        }
        beforeLast = std::move(last);
        last = row;
    }
    return last[b.size()];
}

/// Keeps the nearest of the names offered, if it is near enough to be what was meant.
struct Nearest {
    std::string_view wanted;
    std::string_view best = {};
    std::size_t distance = std::string_view::npos;

    void offer(std::string_view name) {
        // A third of the longer word may be wrong: "sphre" finds sphere, "abc" does not find box.
        const std::size_t limit = (std::max(wanted.size(), name.size()) + 1) / 3;
        const std::size_t shortest =
            wanted.size() > name.size() ? wanted.size() - name.size() : name.size() - wanted.size();
        if (shortest > limit) return;
        const std::size_t d = editDistance(wanted, name);
        if (d <= limit && d < distance) best = name, distance = d;
    }
};

}  // namespace

std::string_view categoryName(Category category) {
    switch (category) {
        case Category::shape: return "Shapes";
        case Category::shape2d: return "2-D shapes";
        case Category::combine: return "Combine";
        case Category::domain: return "Domain";
        case Category::field: return "Fields";
        case Category::maths: return "Maths";
        case Category::material: return "Material";
        case Category::mesh: return "Mesh stages";
        case Category::particles: return "Particles";
        case Category::structure: return "Structure";
    }
    assert(!"every category has a name");
    return "";
}

ExactnessRule always(Exactness exactness) {
    return [exactness](const ExactnessArguments&) { return exactness; };
}

ExactnessRule sameAs(std::string input) {
    return [input = std::move(input)](const ExactnessArguments& node) { return node.surface(input); };
}

const std::vector<NodeType>& nodeTypes() {
    static const std::vector<NodeType> types = gatherNodeTypes();
    return types;
}

const NodeType* findNodeType(std::string_view id) {
    static const std::unordered_map<std::string_view, std::size_t> index = indexNames();
    const auto found = index.find(id);
    return found == index.end() ? nullptr : &nodeTypes()[found->second];
}

int inputIndex(const NodeType& type, std::string_view name) {
    const auto found = std::ranges::find(type.inputs, name, &InputSpec::name);
    return found == type.inputs.end() ? -1 : static_cast<int>(found - type.inputs.begin());
}

int outputIndex(const NodeType& type, std::string_view name) {
    const auto found = std::ranges::find(type.outputs, name, &OutputSpec::name);
    return found == type.outputs.end() ? -1 : static_cast<int>(found - type.outputs.begin());
}

std::string nearestNodeType(std::string_view id) {
    Nearest nearest{id};
    for (const NodeType& type : nodeTypes()) {
        nearest.offer(type.id);
        for (const std::string& alias : type.aliases) nearest.offer(alias);
    }
    const NodeType* type = findNodeType(nearest.best);
    return type ? type->id : std::string();
}

std::string nearestName(std::string_view name, std::span<const std::string> names) {
    Nearest nearest{name};
    for (const std::string& candidate : names) nearest.offer(candidate);
    return std::string(nearest.best);
}

}  // namespace fw
