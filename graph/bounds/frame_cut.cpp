#include "graph/bounds/frame_cut.h"

#include <algorithm>

namespace fw {

namespace {

constexpr int kMaxCut = 3;

/// Maximum flow from the last vertex of a cone to its variables. A vertex that may be cut is an arc of
/// capacity 1 from its in side to its out side, so that a unit of flow is a path and paths share no such
/// vertex.
class Flow {
  public:
    Flow(std::span<const IrId> cone, std::span<const IrId> variables,
         const std::function<std::vector<IrId>(IrId)>& operandsOf, const std::function<bool(IrId)>& mayCut)
        : sink(int(2 * cone.size())), source(sink - 1), firstArc(std::size_t(sink) + 1, -1) {
        for (std::size_t v = 0; v < cone.size(); ++v) {
            addArc(int(2 * v), int(2 * v + 1), mayCut(cone[v]) ? 1 : kMaxCut + 1);
            for (const IrId operand : operandsOf(cone[v])) {
                const bool isVariable = std::ranges::find(variables, operand) != variables.end();
                const auto at = std::ranges::lower_bound(cone, operand) - cone.begin();
                addArc(int(2 * v + 1), isVariable ? sink : int(2 * at), kMaxCut + 1);
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
    std::vector<std::size_t> cutAtSink() const {
        const std::vector<bool> reaches = connected(sink, true);
        std::vector<std::size_t> vertices;
        for (std::size_t v = 0; 2 * v < std::size_t(sink); ++v)
            if (reaches[2 * v + 1] && !reaches[2 * v]) vertices.push_back(v);
        return vertices;
    }
    /// The vertices of the minimum cut next to the source. Requires a maximum flow.
    std::vector<std::size_t> cutAtSource() const {
        const std::vector<bool> isReached = connected(source, false);
        std::vector<std::size_t> vertices;
        for (std::size_t v = 0; 2 * v < std::size_t(sink); ++v)
            if (isReached[2 * v] && !isReached[2 * v + 1]) vertices.push_back(v);
        return vertices;
    }

  private:
    struct Arc {
        int to, capacity, next;  ///< the next one that leaves the same side
    };
    /// The sides that arcs with capacity left lead to from `start`, or that they lead from to `start`.
    std::vector<bool> connected(int start, bool isBackwards) const {
        std::vector<bool> isSeen(firstArc.size());
        std::vector<int> pending{start};
        isSeen[std::size_t(start)] = true;
        for (std::size_t i = 0; i < pending.size(); ++i)
            for (int arc = firstArc[std::size_t(pending[i])]; arc >= 0; arc = arcs[std::size_t(arc)].next) {
                const int other = arcs[std::size_t(arc)].to;
                if (arcs[std::size_t(isBackwards ? arc ^ 1 : arc)].capacity == 0 ||
                    isSeen[std::size_t(other)])
                    continue;
                isSeen[std::size_t(other)] = true;
                pending.push_back(other);
            }
        return isSeen;
    }
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

std::vector<IrId> frameCut(std::span<const IrId> cone, std::span<const IrId> variables, CutSide side,
                           const std::function<std::vector<IrId>(IrId)>& operandsOf,
                           const std::function<bool(IrId)>& mayCut) {
    if (cone.size() < 2) return {};
    Flow flow(cone, variables, operandsOf, mayCut);
    int count = 0;
    while (count <= kMaxCut && flow.augment()) ++count;
    if (count > kMaxCut) return {};
    std::vector<IrId> cut;
    for (const std::size_t v : side == CutSide::root ? flow.cutAtSource() : flow.cutAtSink())
        cut.push_back(cone[v]);
    return cut;
}

}  // namespace fw
