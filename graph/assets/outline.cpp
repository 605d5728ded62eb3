#include "graph/assets/outline.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <deque>
#include <map>
#include <mutex>
#include <numeric>

#include "graph/base/hash.h"

namespace fw {

namespace {

constexpr std::size_t kKeptOutlines = 4;
constexpr double kSlack = 1e-3;  // of a cell: places that rounding puts into a neighbour are served too

struct Corner {
    double x, y;
};

/// Edge i joins corner i with the next.
struct Edge {
    Corner a, b;
    Edge(const std::vector<double>& corners, uint32_t i)
        : a{corners[2 * i], corners[2 * i + 1]},
          b{corners[2 * i + 2 < corners.size() ? 2 * i + 2 : 0],
            corners[2 * i + 2 < corners.size() ? 2 * i + 3 : 1]} {}

    double length2() const { return (b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y); }
    /// On which side a place is, times the edge's length.
    double side(Corner p) const { return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x); }
    /// Whether that is the left one. A place is taken to lie a little above where it is, as in every
    /// comparison of its height with a corner's.
    bool isLeft(Corner p) const {
        const double s = side(p);
        return s > 0 || (s == 0 && b.x > a.x);
    }
    /// How far along the edge the nearest place is, 0 to 1, before it is cut off there.
    double foot(Corner p) const {
        return ((p.x - a.x) * (b.x - a.x) + (p.y - a.y) * (b.y - a.y)) / std::max(length2(), 1e-30);
    }
    double distance(Corner p) const {
        const double t = std::clamp(foot(p), 0.0, 1.0);
        const double dx = p.x - a.x - t * (b.x - a.x), dy = p.y - a.y - t * (b.y - a.y);
        return std::sqrt(dx * dx + dy * dy);
    }
};

double squared(Corner a, Corner b) { return (a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y); }

uint32_t wordOf(double x) { return std::bit_cast<uint32_t>(float(x)); }
double numberOf(uint32_t word) { return std::bit_cast<float>(word); }

/// Cells along a side of a level, and all those of the levels before.
int sideOf(const Outline& outline, int level) { return level == 0 ? outline.cells : outline.farCells; }
std::size_t firstOf(const Outline& outline, int level) {
    return level == 0 ? 0
                      : std::size_t(outline.cells * outline.cells +
                                    (level - 1) * outline.farCells * outline.farCells);
}

/// Makes the cells and lists of an outline, level by level.
class Maker {
  public:
    explicit Maker(Outline& outline_) : outline(outline_), rows(std::size_t(outline.cells)) {
        for (uint32_t i = 0; i < outline.corners.size() / 2; ++i) all.emplace_back(outline.corners, i);
        const auto rowOf = [&](double y) {
            return std::size_t(std::clamp((y - lowest(1)) / width(0), 0.0, outline.cells - 1.0));
        };
        for (uint32_t i = 0; i < all.size(); ++i) {
            const Edge& edge = all[i];
            for (std::size_t row = rowOf(std::min(edge.a.y, edge.b.y));
                 row <= rowOf(std::max(edge.a.y, edge.b.y)); ++row)
                rows[row].push_back(i);
        }
    }

    void run() {
        std::vector<uint32_t> each(all.size());
        std::iota(each.begin(), each.end(), 0u);
        outline.texels.resize(firstOf(outline, kOutlineLevels));
        for (int level = 0; level < kOutlineLevels; ++level)
            square(level, 0, 0, sideOf(outline, level), each);
        for (const uint32_t i : outline.lists) {
            const Edge& edge = all[i];
            outline.texels.push_back(
                {wordOf(edge.a.x), wordOf(edge.a.y), wordOf(edge.b.x), wordOf(edge.b.y)});
        }
    }

  private:
    /// So many cells from one on, in a square; metres.
    struct Square {
        Corner low;
        double width;
        Corner centre() const { return {low.x + 0.5 * width, low.y + 0.5 * width}; }
        double reach() const { return (0.5 + kSlack) * width * std::sqrt(2.0); }  // from the centre
        Corner corner(int i) const {
            const double grown = (1 + 2 * kSlack) * width;
            return {low.x - kSlack * width + (i & 1) * grown, low.y - kSlack * width + (i >> 1) * grown};
        }
    };

    double lowest(int axis) const { return outline.centre[axis] - outline.halfWidth; }
    double width(int level) const {  // of a cell
        return 2 * std::ldexp(outline.halfWidth, level) / sideOf(outline, level);
    }

    /// Of the edges those that may be the nearest somewhere in the square.
    std::vector<uint32_t> nearestOf(const std::vector<uint32_t>& edges, const Square& square) const {
        std::vector<double> distances;
        for (const uint32_t i : edges) distances.push_back(all[i].distance(square.centre()));
        const double most = *std::ranges::min_element(distances) + 2 * square.reach();
        std::array<Corner, 4> close;  // to each corner of the square, of the edges' first ends
        for (int k = 0; k < 4; ++k)
            close[std::size_t(k)] = all[*std::ranges::min_element(edges, {}, [&](uint32_t i) {
                                        return squared(all[i].a, square.corner(k));
                                    })].a;
        std::vector<uint32_t> near;
        for (std::size_t k = 0; k < edges.size(); ++k)
            if (distances[k] <= most && std::ranges::none_of(close, [&](Corner other) {
                    return isCloser(other, all[edges[k]], square);
                }))
                near.push_back(edges[k]);
        return near;
    }

    /// Whether `place` is closer to all of a square than any place of the edge. That a place is closer than
    /// an end holds in a half-plane; between the ends squared distances sag by up to a quarter of the
    /// length's.
    static bool isCloser(Corner place, const Edge& edge, const Square& square) {
        for (int k = 0; k < 4; ++k) {
            const Corner p = square.corner(k);
            const double least = squared(p, place) * (1 + 1e-9) + 0.25 * edge.length2();
            if (squared(p, edge.a) <= least || squared(p, edge.b) <= least) return false;
        }
        return true;
    }

    /// The cells of a square of `side` cells, of which `edges` are all that can be near.
    void square(int level, int x, int y, int side, const std::vector<uint32_t>& edges) {
        const double cell = width(level), half = std::ldexp(outline.halfWidth, level);
        const Square own{{outline.centre[0] - half + x * cell, outline.centre[1] - half + y * cell},
                         side * cell};
        if (side == 1) return leaf(level, x, y, own, edges);
        // What a lower level serves needs no lists here.
        const int quarter = sideOf(outline, level) / 4;
        const auto served = [&](int from) { return from > quarter && from + side < 3 * quarter; };
        if (level > 0 && served(x) && served(y)) return;
        const std::vector<uint32_t> near = nearestOf(edges, own);
        for (const int dy : {0, side / 2})
            for (const int dx : {0, side / 2}) square(level, x + dx, y + dy, side / 2, near);
    }

    void leaf(int level, int x, int y, const Square& own, const std::vector<uint32_t>& edges) {
        std::vector<uint32_t> near;
        for (int k = 0; k < 4; ++k) {
            const double half = 0.5 * own.width;
            const Square quarter{{own.low.x + (k & 1) * half, own.low.y + (k >> 1) * half}, half};
            const std::vector<uint32_t> some = nearestOf(edges, quarter);
            near.insert(near.end(), some.begin(), some.end());
        }
        std::ranges::sort(near);
        near.erase(std::unique(near.begin(), near.end()), near.end());
        const auto meets = [&](uint32_t i) { return all[i].distance(own.centre()) <= own.reach(); };
        const auto met = std::size_t(std::stable_partition(near.begin(), near.end(), meets) - near.begin());
        const Corner place = placeIn(own, std::span(near).first(met));
        const bool isInside = level == 0 && inside(rows[std::size_t(y)], place);
        outline.texels[firstOf(outline, level) + std::size_t(y * sideOf(outline, level) + x)] = {
            uint32_t(firstOf(outline, kOutlineLevels) + outline.lists.size()),
            uint32_t(near.size()) | uint32_t(met) << 16 | uint32_t(isInside) << 31, wordOf(place.x),
            wordOf(place.y)};
        outline.lists.insert(outline.lists.end(), near.begin(), near.end());
    }

    /// Somewhere in a cell, in single precision, and not close to these edges.
    Corner placeIn(const Square& cell, std::span<const uint32_t> edges) const {
        Corner best{};
        double farthest = -1;
        for (const double v : {0.47, 0.79, 0.23})
            for (const double u : {0.53, 0.81, 0.19}) {
                const Corner tried{float(cell.low.x + u * cell.width), float(cell.low.y + v * cell.width)};
                double nearest = 1e300;
                for (const uint32_t i : edges) nearest = std::min(nearest, all[i].distance(tried));
                if (nearest > farthest) farthest = nearest, best = tried;
            }
        return best;
    }

    /// Whether a ray from p along x crosses an odd number of edges, all of which are in `row`.
    bool inside(const std::vector<uint32_t>& row, Corner p) const {
        bool odd = false;
        for (const uint32_t i : row) {
            const Edge& edge = all[i];
            if ((edge.a.y <= p.y) != (edge.b.y <= p.y)) odd ^= edge.isLeft(p) == (edge.b.y > edge.a.y);
        }
        return odd;
    }

    Outline& outline;
    std::vector<Edge> all;
    std::vector<std::vector<uint32_t>> rows;  ///< edges that meet a row of the first level's cells
};

/// Which of an outline's cells serves a place.
std::size_t cellAt(const Outline& outline, double x, double y) {
    const double u = (x - outline.centre[0]) / outline.halfWidth,
                 v = (y - outline.centre[1]) / outline.halfWidth;
    const double far = std::max(std::abs(u), std::abs(v));
    int level = 0;
    std::frexp(far, &level);
    level = std::clamp(level, 0, kOutlineLevels - 1);
    const double scale = 1 / std::max(std::ldexp(1.0, level), far);  // beyond the last: in the same direction
    const int side = sideOf(outline, level);
    const auto along = [&](double w) {
        const double at = (w * scale + 1) * 0.5 * side;
        return std::size_t(at >= 0 ? std::min(at, side - 1.0) : 0.0);  // 0 also for no number
    };
    return firstOf(outline, level) + along(v) * std::size_t(side) + along(u);
}

}  // namespace

Outline::Outline(std::span<const double> corners_)
    : corners(corners_.begin(), corners_.end()), hash(corners.size()) {
    assert(corners.size() >= 2 && corners.size() <= 2 * kMaxCorners);
    double lo[2] = {corners[0], corners[1]}, hi[2] = {corners[0], corners[1]};
    for (std::size_t i = 0; i < corners.size(); ++i) {
        lo[i % 2] = std::min(lo[i % 2], corners[i]);
        hi[i % 2] = std::max(hi[i % 2], corners[i]);
        hash = mixed(hash, std::bit_cast<uint64_t>(corners[i]));
    }
    const double widths[] = {hi[0] - lo[0], hi[1] - lo[1]};
    for (int axis = 0; axis < 2; ++axis) centre[axis] = double(float(0.5 * (lo[axis] + hi[axis])));
    least = -0.5 * std::min(widths[0], widths[1]);
    halfWidth = double(float(0.55 * std::max(widths[0], widths[1])));
    if (halfWidth < 1e-6) halfWidth = 1;
    cells = int(std::bit_ceil(std::clamp<std::size_t>(corners.size() / 16, 64, 128)));
    farCells = cells / 2;
    Maker(*this).run();
}

OutlinePtr outlineThrough(std::span<const double> corners) {
    static std::mutex mutex;
    static std::map<std::vector<double>, std::weak_ptr<const Outline>> known;
    static std::deque<OutlinePtr> recent;  // for a graph that is compiled again
    std::vector<double> key(corners.begin(), corners.end());
    const std::lock_guard lock(mutex);
    std::erase_if(known, [](const auto& item) { return item.second.expired(); });
    if (const auto found = known.find(key); found != known.end())
        if (OutlinePtr outline = found->second.lock()) return outline;
    OutlinePtr outline = std::make_shared<const Outline>(corners);
    known[std::move(key)] = outline;
    recent.push_back(outline);
    if (recent.size() > kKeptOutlines) recent.pop_front();
    return outline;
}

OutlineSample sampleOutline(const Outline& outline, double x, double y) {
    const OutlineTexel& cell = outline.texels[cellAt(outline, x, y)];
    const uint32_t* const list = &outline.lists[cell[0] - firstOf(outline, kOutlineLevels)];
    const uint32_t count = cell[1] & 0xFFFF, met = cell[1] >> 16 & 0x7FFF;
    const Corner p{x, y}, known{numberOf(cell[2]), numberOf(cell[3])}, turn{known.x, y};
    bool inside = cell[1] >> 31;
    double nearest = 1e300;
    uint32_t best = list[0];
    for (uint32_t k = 0; k < count; ++k) {
        const Edge edge(outline.corners, list[k]);
        const double t = std::clamp(edge.foot(p), 0.0, 1.0);
        const double dx = x - edge.a.x - t * (edge.b.x - edge.a.x),
                     dy = y - edge.a.y - t * (edge.b.y - edge.a.y);
        if (const double squared = dx * dx + dy * dy; squared < nearest) nearest = squared, best = list[k];
        if (k >= met) continue;
        const bool atTurn = edge.isLeft(turn);
        if ((edge.a.x <= turn.x) != (edge.b.x <= turn.x)) inside ^= edge.isLeft(known) != atTurn;
        if ((edge.a.y <= y) != (edge.b.y <= y)) inside ^= edge.isLeft(p) != atTurn;
    }
    const Edge edge(outline.corners, best);
    const double sign = inside ? -1 : 1, t = edge.foot(p), size = std::sqrt(edge.length2());
    if (t > 0 && t < 1) {  // by the line, which is exact near it
        const double side = edge.side(p), out = (side >= 0 ? sign : -sign) / size;
        return {out * side, -out * (edge.b.y - edge.a.y), out * (edge.b.x - edge.a.x)};
    }
    const Corner end = t <= 0 ? edge.a : edge.b;
    const double distance = std::hypot(x - end.x, y - end.y), out = distance > 0 ? sign / distance : 0;
    return {sign * distance, out * (x - end.x), out * (y - end.y)};
}

Interval sampleOutline(const Outline& outline, Interval x, Interval y) {
    const double centre = sampleOutline(outline, 0.5 * (x.lo + x.hi), 0.5 * (y.lo + y.hi)).value;
    const double far = std::abs(centre) + absolute(x).hi + absolute(y).hi;
    const double rounding =
        far < std::ldexp(outline.halfWidth, kOutlineLevels - 2)
            ? 1e-14 * (far + std::abs(outline.centre[0]) + std::abs(outline.centre[1]) + outline.halfWidth)
            : 1e-6 * far;
    const double reach = 0.5 * std::hypot(x.hi - x.lo, y.hi - y.lo) + rounding;
    return {std::max(centre - reach, outline.least - rounding), centre + reach};
}

}  // namespace fw
