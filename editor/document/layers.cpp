#include "editor/document/layers.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace fw::editor {

namespace {

constexpr double kColumnGap = 80.0, kRowGap = 28.0;
constexpr double kBendHeight = 4.0;
constexpr std::size_t kMostBends = 20'000;  ///< beyond, far wires are drawn without a place of their own
constexpr int kOrderSweeps = 12, kHeightSweeps = 8;

/// A box, or a bend of a wire that passes a column by.
struct Item {
    uint32_t column = 0;
    double width = 0.0, height = kBendHeight;
    double y = 0.0;
};

using Column = std::vector<uint32_t>;  // items from top to bottom

class Drawing {
  public:
    Drawing(const std::vector<LayerBox>& boxes, const std::vector<LayerEdge>& given)
        : edges(given), count(boxes.size()) {
        for (const LayerBox& box : boxes) items.push_back({0, box.width, box.height, 0.0});
        dropCycles();
        setColumns();
        addBends();
        before.resize(items.size()), after.resize(items.size());
        for (uint32_t i = 0; i < edges.size(); ++i)
            before[edges[i].to].push_back(i), after[edges[i].from].push_back(i);
    }

    /// Orders the columns, beginning with the order of the boxes in `wish`.
    void arrange(const std::vector<uint32_t>& wish) {
        rank.assign(items.size(), 0.0);
        position.assign(items.size(), 0.0);
        for (std::size_t i = 0; i < wish.size(); ++i) rank[wish[i]] = static_cast<double>(i);
        for (std::size_t i = count; i < items.size(); ++i)  // a bend begins where its source is
            rank[i] = rank[edges[before[i][0]].from];
        columns.assign(columnCount, {});
        for (uint32_t i = 0; i < items.size(); ++i) columns[items[i].column].push_back(i);
        for (Column& column : columns) sortByRank(column), number(column);
        std::vector<Column> best = columns;
        std::size_t fewest = crossings();
        for (int sweep = 0; sweep < kOrderSweeps && fewest > 0; ++sweep) {
            const bool forward = sweep % 2 == 0;
            for (uint32_t i = 1; i < columnCount; ++i)
                orderByNeighbours(forward ? i : columnCount - 1 - i, forward);
            const std::size_t now = crossings();
            if (now < fewest) fewest = now, best = columns;
        }
        columns = std::move(best);
    }

    std::vector<LayerPlace> places() {
        stack();
        for (int sweep = 0; sweep < kHeightSweeps; ++sweep) {
            const bool forward = sweep % 2 == 0;
            for (uint32_t i = 0; i < columnCount; ++i)
                level(columns[forward ? i : columnCount - 1 - i], forward, sweep >= kHeightSweeps - 2);
        }
        std::vector<double> left(columnCount, 0.0);
        for (uint32_t i = 1; i < columnCount; ++i) {
            double width = 0.0;
            for (const uint32_t item : columns[i - 1]) width = std::max(width, items[item].width);
            left[i] = left[i - 1] + width + kColumnGap;
        }
        std::vector<LayerPlace> result;
        for (std::size_t i = 0; i < count; ++i)
            result.push_back({items[i].column, left[items[i].column], items[i].y});
        return result;
    }

  private:
    /// Takes off edges that close a cycle, and those of a box to itself.
    void dropCycles() {
        std::vector<std::vector<uint32_t>> out(count);
        for (uint32_t i = 0; i < edges.size(); ++i) out[edges[i].from].push_back(i);
        enum : uint8_t { fresh, open, left };
        std::vector<uint8_t> state(count, fresh);
        std::vector<char> closes(edges.size(), false);
        std::vector<std::pair<uint32_t, std::size_t>> stack;
        for (uint32_t root = 0; root < count; ++root) {
            if (state[root] != fresh) continue;
            stack.assign(1, {root, 0});
            state[root] = open;
            while (!stack.empty()) {
                auto& [box, next] = stack.back();
                if (next == out[box].size()) {
                    state[box] = left;
                    stack.pop_back();
                    continue;
                }
                const uint32_t edge = out[box][next++], to = edges[edge].to;
                closes[edge] = state[to] == open;
                if (state[to] == fresh) state[to] = open, stack.emplace_back(to, 0);
            }
        }
        std::vector<LayerEdge> kept;
        for (std::size_t i = 0; i < edges.size(); ++i)
            if (!closes[i]) kept.push_back(edges[i]);
        edges = std::move(kept);
    }

    /// As far left as what feeds a box allows, then as near as possible to what it feeds.
    void setColumns() {
        std::vector<uint32_t> waiting(count, 0), sorted;
        std::vector<std::vector<uint32_t>> out(count);
        for (const LayerEdge& edge : edges) ++waiting[edge.to], out[edge.from].push_back(edge.to);
        for (uint32_t i = 0; i < count; ++i)
            if (waiting[i] == 0) sorted.push_back(i);
        for (std::size_t at = 0; at < sorted.size(); ++at)
            for (const uint32_t to : out[sorted[at]]) {
                items[to].column = std::max(items[to].column, items[sorted[at]].column + 1);
                if (--waiting[to] == 0) sorted.push_back(to);
            }
        for (std::size_t at = sorted.size(); at-- > 0;) {
            uint32_t nearest = ~0u;
            for (const uint32_t to : out[sorted[at]]) nearest = std::min(nearest, items[to].column);
            if (nearest != ~0u) items[sorted[at]].column = nearest - 1;
        }
        columnCount = 1;
        for (const Item& item : items) columnCount = std::max(columnCount, item.column + 1);
    }

    void addBends() {
        std::vector<uint32_t> reach(count, 0);  // the farthest column that each box feeds
        for (const LayerEdge& edge : edges)
            reach[edge.from] = std::max(reach[edge.from], items[edge.to].column);
        std::size_t bends = 0;
        for (std::size_t i = 0; i < count; ++i)
            if (reach[i] > items[i].column + 1) bends += reach[i] - items[i].column - 1;
        if (bends > kMostBends) return;
        std::vector<uint32_t> first(count);  // of each box's bends, in the column after its own
        std::vector<double> exit(count, 0.0);
        for (const LayerEdge& edge : edges) exit[edge.from] = edge.fromY;
        std::vector<LayerEdge> chained;
        for (uint32_t i = 0; i < count; ++i) {
            first[i] = static_cast<uint32_t>(items.size());
            for (uint32_t column = items[i].column + 1; column < reach[i]; ++column) {
                const auto bend = static_cast<uint32_t>(items.size());
                chained.push_back({bend == first[i] ? i : bend - 1, bend,
                                   bend == first[i] ? exit[i] : 0.5 * kBendHeight, 0.5 * kBendHeight});
                items.push_back({column});
            }
        }
        for (const LayerEdge& edge : edges) {
            const uint32_t gap = items[edge.to].column - items[edge.from].column;
            if (gap < 2)
                chained.push_back(edge);
            else
                chained.push_back({first[edge.from] + gap - 2, edge.to, 0.5 * kBendHeight, edge.toY});
        }
        edges = std::move(chained);
    }

    void sortByRank(Column& column) const {
        std::stable_sort(column.begin(), column.end(),
                         [&](uint32_t a, uint32_t b) { return rank[a] < rank[b]; });
    }

    void number(const Column& column) {
        for (std::size_t i = 0; i < column.size(); ++i) position[column[i]] = static_cast<double>(i);
    }

    /// The position in its column of an end of a wire; where on its box it lies counts as a fraction.

    double endOf(const LayerEdge& edge, bool atSource) const {
        const uint32_t item = atSource ? edge.from : edge.to;
        return position[item] + (atSource ? edge.fromY : edge.toY) / (items[item].height + 1.0);
    }

    void orderByNeighbours(uint32_t column, bool fromSources) {
        for (const uint32_t item : columns[column]) {
            const std::vector<uint32_t>& wires = fromSources ? before[item] : after[item];
            rank[item] = position[item];
            if (wires.empty()) continue;
            double sum = 0.0;
            for (const uint32_t wire : wires) sum += endOf(edges[wire], fromSources);
            rank[item] = sum / static_cast<double>(wires.size());
        }
        sortByRank(columns[column]);
        number(columns[column]);
    }

    /// Pairs of wires between two columns that cross, counted over all columns: inversions, by a Fenwick
    /// tree.
    std::size_t crossings() const {
        std::size_t total = 0;
        std::vector<std::vector<std::pair<double, double>>> gaps(columnCount);
        for (const LayerEdge& edge : edges)
            gaps[items[edge.from].column].emplace_back(endOf(edge, true), endOf(edge, false));
        std::vector<double> ends;
        std::vector<std::size_t> tree;
        for (auto& wires : gaps) {
            std::sort(wires.begin(), wires.end());
            ends.clear();
            for (const auto& wire : wires) ends.push_back(wire.second);
            std::sort(ends.begin(), ends.end());
            tree.assign(ends.size() + 1, 0);
            for (std::size_t i = 0; i < wires.size(); ++i) {
                const auto place = static_cast<std::size_t>(
                    std::upper_bound(ends.begin(), ends.end(), wires[i].second) - ends.begin());
                std::size_t notAbove = 0;
                for (std::size_t at = place; at > 0; at -= at & (~at + 1)) notAbove += tree[at];
                total += i - notAbove;
                for (std::size_t at = place; at < tree.size(); at += at & (~at + 1)) ++tree[at];
            }
        }
        return total;
    }

    static double gapBetween(const Item& above, const Item& below) {
        const bool bends = above.width == 0.0 || below.width == 0.0;
        return bends ? 0.5 * kRowGap : kRowGap;
    }

    void stack() {
        for (const Column& column : columns) {
            double y = 0.0;
            for (std::size_t i = 0; i < column.size(); ++i) {
                if (i > 0) y += gapBetween(items[column[i - 1]], items[column[i]]);
                items[column[i]].y = y;
                y += items[column[i]].height;
            }
        }
    }

    /// Moves a column's items as near as can be to where their wires would be level, in the order they have:
    /// the least sum of squares, by merging neighbours that would overlap into blocks.
    void level(const Column& column, bool fromSources, bool bothWays) {
        struct Run {
            double sum = 0.0, weight = 0.0;
            std::size_t end = 0;
            double mean() const { return sum / weight; }
        };
        std::vector<double> offset(column.size(), 0.0);  // below the first item, if all stand close
        std::vector<Run> runs;
        for (std::size_t i = 0; i < column.size(); ++i) {
            const Item& item = items[column[i]];
            if (i > 0) {
                const Item& above = items[column[i - 1]];
                offset[i] = offset[i - 1] + above.height + gapBetween(above, item);
            }
            double sum = 0.0;
            std::size_t wires = 0;
            if (fromSources || bothWays)
                for (const uint32_t wire : before[column[i]]) {
                    sum += items[edges[wire].from].y + edges[wire].fromY - edges[wire].toY;
                    ++wires;
                }
            if (!fromSources || bothWays)
                for (const uint32_t wire : after[column[i]]) {
                    sum += items[edges[wire].to].y + edges[wire].toY - edges[wire].fromY;
                    ++wires;
                }
            const bool loose = wires == 0;
            const double wish = loose ? item.y : sum / static_cast<double>(wires);
            const double weight = loose ? 0.01 : 1.0;
            runs.push_back({weight * (wish - offset[i]), weight, i + 1});
            while (runs.size() > 1 && runs[runs.size() - 2].mean() > runs.back().mean()) {
                Run last = runs.back();
                runs.pop_back();
                runs.back().sum += last.sum, runs.back().weight += last.weight, runs.back().end = last.end;
            }
        }
        std::size_t i = 0;
        for (const Run& run : runs)
            for (; i < run.end; ++i) items[column[i]].y = run.mean() + offset[i];
    }

    std::vector<LayerEdge> edges;
    std::size_t count;  ///< of the boxes, which come before the bends
    std::vector<Item> items;
    std::vector<std::vector<uint32_t>> before, after;  ///< edges of each item
    std::vector<Column> columns;
    std::vector<double> position;  ///< of each item in its column
    std::vector<double> rank;      ///< by which a column is sorted
    uint32_t columnCount = 1;
};

}  // namespace

std::vector<LayerPlace> layered(const std::vector<LayerBox>& boxes, const std::vector<LayerEdge>& edges,
                                const std::vector<uint32_t>& order) {
    if (boxes.empty()) return {};
    Drawing drawing(boxes, edges);
    drawing.arrange(order);
    return drawing.places();
}

}  // namespace fw::editor
