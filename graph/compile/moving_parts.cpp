#include "graph/compile/moving_parts.h"

#include <algorithm>
#include <set>
#include <utility>

namespace fw {
namespace {

/// Parts of one document, and what carries them: more are meshes that take turns.
constexpr std::size_t kMostPartNodes = 1000;

class PartFinder {
  public:
    PartFinder(const AskedGraph& graph, std::span<const double> moments)
        : asked(graph), times(moments), animated(animatedInputs(graph.graph(), graph.timeline())) {}

    std::optional<std::vector<PartNode>> find() {
        if (rests(asked.graph()) || !walk(asked.shown(), std::nullopt) || nodes.size() > kMostPartNodes)
            return std::nullopt;
        return std::move(nodes);
    }

  private:
    /// Whether the field is the same at all times.
    bool rests(const Graph& shown) const {
        const Result<LiveProgram> live = compileLive(shown, {});
        if (!live) return false;
        if (!live->program.stages.empty()) return false;
        for (const FieldVolumePtr& volume : live->program.ir.volumes())
            if (volume->particles) return false;
        const auto valuesRead = [&](double time) {
            std::vector<double> values = live->valuesAt(time);
            for (std::size_t slot = 0; slot < values.size(); ++slot)
                if (!live->read[slot]) values[slot] = 0.0;
            return values;
        };
        const std::vector<double> first = valuesRead(times[0]);
        return std::ranges::all_of(times, [&](double time) { return valuesRead(time) == first; });
    }

    static bool leaveAll(const std::vector<Pose>& poses) {
        return std::ranges::all_of(poses, [](const Pose& pose) { return pose == Pose{}; });
    }

    /// Whether its other inputs are plain numbers that nothing moves: then it is the same wherever it stands.
    bool isPlain(const Node& node, const std::string& surface) const {
        return std::ranges::all_of(node.inputs, [&](const auto& input) {
            return input.first == surface || (!std::holds_alternative<Link>(input.second.value) &&
                                              !animated.contains(node.id + "." + input.first));
        });
    }

    /// The part that is behind the link, with what goes to each part that is behind it, as it is at the first
    /// of the times: it has no timeline of its own.
    Graph partOf(const Link& link) const {
        Graph part = asked.showing(link, wrappers);
        part.timeline = nullptr;
        return atTime(part, asked.timeline(), timelineTime(asked.timeline(), times[0]));
    }

    bool walk(const Link& link, std::optional<std::size_t> parent) {
        const Node* any = asked.graph().node(link.node);
        if (!any || nodes.size() > kMostPartNodes) return false;
        if (rests(asked.showing(link))) {
            nodes.push_back({.name = AskedGraph::nameOf(*any), .parent = parent, .part = partOf(link)});
            return true;
        }
        const Node* node = asked.onlyOutputOf(link);
        if (!node) return false;
        const std::vector<std::string> surfaces = asked.surfacesOf(*node);
        const auto behind = [&](std::size_t i) { return *AskedGraph::linkOf(*node, surfaces[i]); };
        if (surfaces.size() == 2 && asked.isUnion(*node, surfaces[0], surfaces[1]))
            return walk(behind(0), parent) && walk(behind(1), parent);
        if (surfaces.size() != 1) return false;
        std::vector<Pose> poses = asked.posesOf(*node, surfaces[0]);
        if (poses.empty()) return false;
        if (leaveAll(poses)) {
            if (!isPlain(*node, surfaces[0])) return false;
            wrappers.push_back({node->id, surfaces[0]});
            const bool found = walk(behind(0), parent);
            wrappers.pop_back();
            return found;
        }
        nodes.push_back({.name = AskedGraph::nameOf(*node), .parent = parent, .poses = std::move(poses)});
        return walk(behind(0), nodes.size() - 1);
    }

    const AskedGraph& asked;
    std::span<const double> times;
    std::set<std::string> animated;  ///< "node.input"
    std::vector<Step> wrappers;      ///< on the way
    std::vector<PartNode> nodes;
};

}  // namespace

std::optional<std::vector<PartNode>> movingParts(const Graph& graph, std::span<const double> times) {
    const std::optional<AskedGraph> asked = AskedGraph::of(graph, times);
    if (!asked || asked->showsMesh()) return std::nullopt;
    return PartFinder(*asked, times).find();
}

}  // namespace fw
