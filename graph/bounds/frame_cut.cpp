#include "graph/bounds/frame_cut.h"

#include <algorithm>

namespace fw {

namespace {

constexpr int kMaxCut = 3;

/// Maximum flow from the last vertex of a cone to its variables. A vertex is an arc of capacity 1 from its in
/// side to its out side, so that a unit of flow is a path and paths share no vertex.
class Flow {
  public:
    Flow(const Ir& ir, std::span<const IrId> cone, std::span<const IrId> variables,
         const std::function<bool(IrId)>& isNumber)
        : sink(int(2 * cone.size())), source(sink - 1), firstArc(std::size_t(sink) + 1, -1) {
        for (std::size_t v = 0; v < cone.size(); ++v) {
            addArc(int(2 * v), int(2 * v + 1), 1);
            const IrNode& node = ir[cone[v]];
            for (int i = 0; i < opInfo(node.op).arity; ++i) {
                const IrId operand = node.operands[std::size_t(i)];
                if (std::ranges::find(variables, operand) != variables.end()) {
                    addArc(int(2 * v + 1), sink, kMaxCut + 1);
                } else if (!isNumber(operand)) {
                    const auto at = std::ranges::lower_bound(cone, operand) - cone.begin();
                    addArc(int(2 * v + 1), int(2 * at), kMaxCut + 1);
                }
            }
        }
    }

    /// Sends one more unit; false if there is no way.
    bool augment() {
        std::vector<int> arcTo(firstArc.size(), -1), pending{source};
        for (std::size_t i = 0; i < pending.size() && arcTo[std::size_t(sink)] < 0; ++i)
            for (int arc = firstArc[std::size_t(pending[i])]; arc >= 0; arc = arcs[std::size_t(arc)].next) {
                const int to = arcs[std::size_t(arc)].to;
                if (arcs[std::size_t(arc)].capacity == 0 || to == source || arcTo[std::size_t(to)] >= 0)
                    continue;
                arcTo[std::size_t(to)] = arc;
                pending.push_back(to);
            }
        if (arcTo[std::size_t(sink)] < 0) return false;
        for (int at = sink; at != source;) {
            const int arc = arcTo[std::size_t(at)];
            --arcs[std::size_t(arc)].capacity;
            ++arcs[std::size_t(arc ^ 1)].capacity;
            at = arcs[std::size_t(arc ^ 1)].to;
        }
        return true;
    }

    /// The vertices of the minimum cut next to the sink. Requires a maximum flow.
    std::vector<std::size_t> cut() const {
        std::vector<bool> reachesSink(firstArc.size());
        std::vector<int> pending{sink};
        reachesSink[std::size_t(sink)] = true;
        for (std::size_t i = 0; i < pending.size(); ++i)
            for (int arc = firstArc[std::size_t(pending[i])]; arc >= 0; arc = arcs[std::size_t(arc)].next) {
                const int from = arcs[std::size_t(arc)].to;
                if (arcs[std::size_t(arc ^ 1)].capacity == 0 || reachesSink[std::size_t(from)]) continue;
                reachesSink[std::size_t(from)] = true;
                pending.push_back(from);
            }
        std::vector<std::size_t> vertices;
        for (std::size_t v = 0; 2 * v < std::size_t(sink); ++v)
            if (reachesSink[2 * v + 1] && !reachesSink[2 * v]) vertices.push_back(v);
        return vertices;
    }

  private:
    struct Arc {
        int to, capacity, next;  ///< the next one that leaves the same side
    };
    void addArc(int from, int to, int capacity) {
        arcs.push_back({to, capacity, firstArc[std::size_t(from)]});
        firstArc[std::size_t(from)] = int(arcs.size()) - 1;
        arcs.push_back({from, 0, firstArc[std::size_t(to)]});
        firstArc[std::size_t(to)] = int(arcs.size()) - 1;
    }

    int sink, source;
    std::vector<int> firstArc;
    std::vector<Arc> arcs;  ///< in pairs: an arc, and its reverse
};

}  // namespace

std::vector<IrId> frameCut(const Ir& ir, std::span<const IrId> cone, std::span<const IrId> variables,
                           const std::function<bool(IrId)>& isNumber) {
    if (cone.size() < 2) return {};
    Flow flow(ir, cone, variables, isNumber);
    int count = 0;
    while (count <= kMaxCut && flow.augment()) ++count;
    if (count > kMaxCut) return {};
    std::vector<IrId> cut;
    for (const std::size_t v : flow.cut()) cut.push_back(cone[v]);
    return cut;
}

}  // namespace fw
