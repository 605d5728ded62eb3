#include "graph/outlines/outline.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <mutex>
#include <numeric>
#include <utility>

#include "graph/base/grown_cells.h"
#include "graph/base/hash.h"

namespace fw {

namespace {

constexpr std::size_t kKeptOutlines = 8;
constexpr std::size_t kFew = 4;  // arcs of a cell that are no more work than to leave some away
constexpr int kSplittings = 3;   // of a level, before its parts are shared out
constexpr double kSlack = 1e-3;  // of a cell: places that rounding puts into a neighbour are served too

uint32_t wordOf(double x) { return std::bit_cast<uint32_t>(float(x)); }
double numberOf(uint32_t word) { return std::bit_cast<float>(word); }

/// Cells along x and y of a level, all those of the levels before, and half its size.
int cellsOf(const Outline& outline, int level) { return level == 0 ? outline.cells : outline.farCells; }
int rowsOf(const Outline& outline, int level) { return level == 0 ? outline.rows : outline.farCells; }
std::size_t firstOf(const Outline& outline, int level) {
    return level == 0 ? 0
                      : std::size_t(outline.cells * outline.rows +
                                    (level - 1) * outline.farCells * outline.farCells);
}
glm::dvec2 halfOf(const Outline& outline, int level) {
    return level == 0 ? outline.half
                      : glm::dvec2(std::ldexp(std::max(outline.half.x, outline.half.y), level));
}

/// Where a cell's list begins among all lists.
std::size_t listOf(const Outline& outline, const OutlineTexel& cell) {
    return (cell[0] - firstOf(outline, kOutlineLevels)) / (outline.straight ? 1 : 2);
}

/// Makes the cells and lists of an outline, level by level.
class Maker {
  public:
    Maker(Outline& outline_, const std::function<bool(glm::dvec2)>& isInside_)
        : outline(outline_), isInside(isInside_), all(outline.arcs) {
        if (isInside) return;
        rows.resize(std::size_t(outline.rows));
        const auto rowOf = [&](double y) {
            return std::size_t(std::clamp((y - lowest(0).y) / widthOf(0).y, 0.0, outline.rows - 1.0));
        };
        for (uint32_t i = 0; i < all.size(); ++i)
            for (std::size_t row = rowOf(std::min(all[i].a.y, all[i].b.y));
                 row <= rowOf(std::max(all[i].a.y, all[i].b.y)); ++row)
                rows[row].push_back(i);
    }

    void run() {
        std::vector<uint32_t> arcs(all.size());
        std::iota(arcs.begin(), arcs.end(), 0u);
        outline.texels.resize(firstOf(outline, kOutlineLevels));
        for (int level = 0; level < kOutlineLevels; ++level) {
            const auto most = unsigned(std::max(cellsOf(outline, level), rowsOf(outline, level)));
            cellsOfLevel(level, int(std::bit_ceil(most)), arcs);
            arcs = nearestBeyond(level);
        }
        for (const uint32_t i : outline.lists) {
            const Arc& arc = all[i];
            outline.texels.push_back({wordOf(arc.a.x), wordOf(arc.a.y), wordOf(arc.b.x), wordOf(arc.b.y)});
            if (!outline.straight)
                outline.texels.push_back({wordOf(arc.normal.x), wordOf(arc.normal.y), wordOf(arc.bend), 0});
        }
    }

  private:
    /// So many cells from one on, in a square of as many along x as along y; metres.
    struct Square {
        glm::dvec2 low, size;
        glm::dvec2 centre() const { return low + 0.5 * size; }
        double reach() const { return (0.5 + kSlack) * glm::length(size); }  // from the centre
        glm::dvec2 corner(int i) const {
            const glm::dvec2 grown = (1 + 2 * kSlack) * size;
            return low - kSlack * size + glm::dvec2((i & 1) * grown.x, (i >> 1) * grown.y);
        }
    };

    glm::dvec2 lowest(int level) const { return outline.centre - halfOf(outline, level); }
    glm::dvec2 widthOf(int level) const {  // of a cell
        return 2.0 * halfOf(outline, level) / glm::dvec2(cellsOf(outline, level), rowsOf(outline, level));
    }

    /// The arcs that can be the nearest somewhere beyond a level: the way from such a place to its nearest
    /// one has that as its nearest all along, and leaves the level's square by one of its outermost cells.
    std::vector<uint32_t> nearestBeyond(int level) const {
        const int across = cellsOf(outline, level), down = rowsOf(outline, level);
        std::vector<uint32_t> arcs;
        for (int y = 0; y < down; ++y)
            for (int x = 0; x < across; x += y == 0 || y == down - 1 ? 1 : std::max(across - 1, 1)) {
                const OutlineTexel& cell =
                    outline.texels[firstOf(outline, level) + std::size_t(y * across + x)];
                const auto list = outline.lists.begin() + std::ptrdiff_t(listOf(outline, cell));
                arcs.insert(arcs.end(), list, list + std::ptrdiff_t(cell[1] & 0xFFFF));
            }
        std::ranges::sort(arcs);
        arcs.erase(std::unique(arcs.begin(), arcs.end()), arcs.end());
        return arcs;
    }

    /// Of the arcs those that may be the nearest somewhere in the square.
    std::vector<uint32_t> nearestOf(const std::vector<uint32_t>& arcs, const Square& square) const {
        std::vector<double> distances;
        for (const uint32_t i : arcs) distances.push_back(distanceTo(all[i], square.centre()));
        const double most = *std::ranges::min_element(distances) + 2 * square.reach();
        std::array<glm::dvec2, 4> corners;
        for (int k = 0; k < 4; ++k) corners[std::size_t(k)] = square.corner(k);
        // The arcs' first ends that are the closest to each corner, and how far they are from all of them.
        std::array<std::array<double, 4>, 4> close;
        for (std::size_t k = 0; k < 4; ++k) {
            const glm::dvec2 place = all[*std::ranges::min_element(arcs, {}, [&](uint32_t i) {
                                         return squared(all[i].a - corners[k]);
                                     })].a;
            for (std::size_t j = 0; j < 4; ++j) close[k][j] = glm::distance(corners[j], place) * (1 + 1e-9);
        }
        std::vector<uint32_t> near;
        for (std::size_t k = 0; k < arcs.size(); ++k)
            if (distances[k] <= most && !anyIsCloser(close, all[arcs[k]], corners)) near.push_back(arcs[k]);
        return near;
    }

    /// Whether a place, so far from a square's corners, is closer to all of it than any place of the arc.
    /// That it is closer than a place of the chord by more than the arc's sag holds in one branch of a
    /// hyperbola, which has all of the square if it has its corners; between the ends of the chord squared
    /// distances sag by up to a quarter of its length's.
    static bool anyIsCloser(const std::array<std::array<double, 4>, 4>& close, const Arc& arc,
                            const std::array<glm::dvec2, 4>& corners) {
        const double chord2 = squared(arc.b - arc.a), sag = 0.25 * std::abs(arc.bend) * chord2;
        std::array<double, 4> ends;
        for (std::size_t j = 0; j < 4; ++j)
            ends[j] = std::min(squared(corners[j] - arc.a), squared(corners[j] - arc.b)) - 0.25 * chord2;
        return std::ranges::any_of(close, [&](const std::array<double, 4>& far) {
            for (std::size_t j = 0; j < 4; ++j)
                if (ends[j] <= (far[j] + sag) * (far[j] + sag)) return false;
            return true;
        });
    }

    /// Cells from one on, as many along x as along y, of which `arcs` are all that can be near.
    struct Part {
        int x, y, side;
        std::vector<uint32_t> arcs;
    };
    /// What a cell lists, those that meet it first, and its place.
    struct Leaf {
        int x, y;
        std::vector<uint32_t> near;
        std::size_t met;
        glm::dvec2 place;
    };

    void cellsOfLevel(int level, int side, const std::vector<uint32_t>& arcs) {
        const auto splits = [&](const Part& part, const auto& take) { split(level, part, take); };
        const auto grows = [&](const Part& part, std::vector<Leaf>& leaves) { grow(level, part, leaves); };
        for (const Leaf& leaf : grownCells<Leaf>(Part{0, 0, side, arcs}, kSplittings, splits, grows))
            add(level, leaf);
    }
    template <class Take>
    void split(int level, const Part& part, const Take& take) const {
        if (part.x >= cellsOf(outline, level) || part.y >= rowsOf(outline, level)) return;
        const Square own = squareOf(level, part);
        // What a lower level serves needs no lists here.
        const glm::dvec2 lower = halfOf(outline, level - 1) - widthOf(level);
        if (level > 0 && own.low.x > outline.centre.x - lower.x && own.low.y > outline.centre.y - lower.y &&
            own.low.x + own.size.x < outline.centre.x + lower.x &&
            own.low.y + own.size.y < outline.centre.y + lower.y)
            return;
        const std::vector<uint32_t> near = nearestOf(part.arcs, own);
        const int half = part.side / 2;
        for (const int dy : {0, half})
            for (const int dx : {0, half}) take(Part{part.x + dx, part.y + dy, half, near});
    }
    void grow(int level, const Part& part, std::vector<Leaf>& leaves) const {
        if (part.x >= cellsOf(outline, level) || part.y >= rowsOf(outline, level)) return;
        const Square own = squareOf(level, part);
        Leaf leaf{part.x, part.y, nearestOf(part.arcs, own), 0, {}};
        if (leaf.near.size() > kFew) leaf.near = nearestOfQuarters(leaf.near, own);
        const auto meets = [&](uint32_t i) { return distanceTo(all[i], own.centre()) <= own.reach(); };
        leaf.met =
            std::size_t(std::stable_partition(leaf.near.begin(), leaf.near.end(), meets) - leaf.near.begin());
        leaf.place = placeIn(own, std::span(leaf.near).first(leaf.met));
        leaves.push_back(std::move(leaf));
    }
    Square squareOf(int level, const Part& part) const {
        const glm::dvec2 cell = widthOf(level);
        return {lowest(level) + glm::dvec2(part.x, part.y) * cell, double(part.side) * cell};
    }
    void add(int level, const Leaf& leaf) {
        const std::size_t list = outline.lists.size() * (outline.straight ? 1 : 2);
        outline.texels[firstOf(outline, level) + std::size_t(leaf.y * cellsOf(outline, level) + leaf.x)] = {
            uint32_t(firstOf(outline, kOutlineLevels) + list),
            uint32_t(leaf.near.size()) | uint32_t(leaf.met) << 16 |
                uint32_t(isIn(level, leaf.y, leaf.place)) << 31,
            wordOf(leaf.place.x), wordOf(leaf.place.y)};
        outline.lists.insert(outline.lists.end(), leaf.near.begin(), leaf.near.end());
    }

    /// The same for each quarter of a square: fewer than for all of it at once.
    std::vector<uint32_t> nearestOfQuarters(const std::vector<uint32_t>& arcs, const Square& own) const {
        std::vector<uint32_t> near;
        for (int k = 0; k < 4; ++k) {
            const glm::dvec2 half = 0.5 * own.size;
            const std::vector<uint32_t> some =
                nearestOf(arcs, {own.low + glm::dvec2((k & 1) * half.x, (k >> 1) * half.y), half});
            near.insert(near.end(), some.begin(), some.end());
        }
        std::ranges::sort(near);
        near.erase(std::unique(near.begin(), near.end()), near.end());
        return near;
    }

    /// Somewhere in a cell, in single precision, and not close to these arcs.
    glm::dvec2 placeIn(const Square& cell, std::span<const uint32_t> arcs) const {
        glm::dvec2 best{};
        double farthest = -1;
        for (const double v : {0.47, 0.79, 0.23})
            for (const double u : {0.53, 0.81, 0.19}) {
                const glm::dvec2 tried{float(cell.low.x + u * cell.size.x),
                                       float(cell.low.y + v * cell.size.y)};
                double nearest = 1e300;
                for (const uint32_t i : arcs) nearest = std::min(nearest, distanceTo(all[i], tried));
                if (nearest > farthest) farthest = nearest, best = tried;
            }
        return best;
    }

    bool isIn(int level, int y, glm::dvec2 place) const {
        if (place.x < outline.lo.x || place.y < outline.lo.y || place.x > outline.hi.x ||
            place.y > outline.hi.y)
            return false;
        if (isInside) return isInside(place);
        return level == 0 && isOdd(rows[std::size_t(y)], place);
    }

    /// Whether a ray from p along x crosses an odd number of arcs, all of which are in `row`.
    bool isOdd(const std::vector<uint32_t>& row, glm::dvec2 p) const {
        bool odd = false;
        for (const uint32_t i : row) {
            const Arc& arc = all[i];
            if ((arc.a.y <= p.y) != (arc.b.y <= p.y)) odd ^= isLeft(arc, p) == (arc.b.y > arc.a.y);
        }
        return odd;
    }

    Outline& outline;
    const std::function<bool(glm::dvec2)>& isInside;
    const std::vector<Arc>& all;
    std::vector<std::vector<uint32_t>> rows;  ///< arcs that meet a row of the first level's cells
};

/// Which of an outline's cells serves a place.
std::size_t cellAt(const Outline& outline, double x, double y) {
    const glm::dvec2 away = glm::dvec2(x, y) - outline.centre;
    int level = 0;
    double shrink = 1;
    if (!(std::abs(away.x) < outline.half.x && std::abs(away.y) < outline.half.y)) {
        const double far =
            std::max(std::abs(away.x), std::abs(away.y)) / std::max(outline.half.x, outline.half.y);
        std::frexp(far, &level);
        level = std::clamp(level, 1, kOutlineLevels - 1);
        shrink = std::max(1.0, std::ldexp(far, -level));  // beyond the last: in the same direction
    }
    const glm::dvec2 half = halfOf(outline, level);
    const auto along = [&](double at, int count) {
        const double cell = (at + 1) * 0.5 * count;
        return std::size_t(cell >= 0 ? std::min(cell, count - 1.0) : 0.0);  // 0 also for no number
    };
    const std::size_t across = along(away.x / (shrink * half.x), cellsOf(outline, level));
    return firstOf(outline, level) +
           along(away.y / (shrink * half.y), rowsOf(outline, level)) * std::size_t(cellsOf(outline, level)) +
           across;
}

}  // namespace

Outline::Outline(std::vector<Arc> arcs_, const std::function<bool(glm::dvec2)>& isInside)
    : arcs(std::move(arcs_)), straight(true), lo(arcs[0].a), hi(arcs[0].a), hash(arcs.size()) {
    assert(!arcs.empty() && arcs.size() <= kMostArcs);
    for (const Arc& arc : arcs) {
        for (const glm::dvec2 end : {arc.a, arc.b}) {
            lo = glm::min(lo, end), hi = glm::max(hi, end);
            hash = mixed(mixed(hash, std::bit_cast<uint64_t>(end.x)), std::bit_cast<uint64_t>(end.y));
        }
        hash = mixed(hash, std::bit_cast<uint64_t>(arc.bend));
        straight &= arc.bend == 0;
    }
    const glm::dvec2 size = hi - lo;
    centre = glm::dvec2(glm::vec2(0.5 * (lo + hi)));
    least = -0.5 * std::min(size.x, size.y);
    const double most = std::max(size.x, size.y);
    half = most < 2e-6 ? glm::dvec2(1) : glm::dvec2(glm::vec2(0.5 * size + 0.05 * most));
    const auto n = double(arcs.size());
    const double wanted = std::max({4096.0, std::min(16 * n, 49152.0), std::min(4 * n, 65536.0)});
    const double cell = 2 * std::sqrt(half.x * half.y / wanted);
    cells = std::max(1, int(std::lround(2 * half.x / cell)));
    rows = std::max(1, int(std::lround(2 * half.y / cell)));
    farCells = 32;
    Maker(*this, isInside).run();
}

Result<OutlinePtr> keptOutline(const std::string& key, const std::function<Result<OutlinePtr>()>& make) {
    static std::mutex mutex;
    static std::map<std::string, std::weak_ptr<const Outline>> known;
    static std::deque<OutlinePtr> recent;  // for a graph that is compiled again
    const std::lock_guard lock(mutex);
    std::erase_if(known, [](const auto& item) { return item.second.expired(); });
    if (const auto found = known.find(key); found != known.end())
        if (OutlinePtr outline = found->second.lock()) return outline;
    Result<OutlinePtr> outline = make();
    if (!outline || !*outline) return outline;
    known[key] = *outline;
    recent.push_back(*outline);
    if (recent.size() > kKeptOutlines) recent.pop_front();
    return outline;
}

std::string outlineKey(std::initializer_list<std::string_view> words, std::span<const double> numbers) {
    std::string key;
    for (const std::string_view word : words) (key += std::to_string(word.size()) + ' ') += word;
    return key.append(reinterpret_cast<const char*>(numbers.data()), numbers.size_bytes());
}

OutlinePtr outlineThrough(std::span<const double> corners) {
    assert(corners.size() >= 2 && corners.size() <= 2 * kMaxCorners);
    return *keptOutline(outlineKey({"polygon"}, corners), [&]() -> Result<OutlinePtr> {
        std::vector<Arc> arcs;
        const std::size_t count = corners.size() / 2;
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t next = (i + 1) % count;
            arcs.push_back(
                arcBetween({corners[2 * i], corners[2 * i + 1]}, {corners[2 * next], corners[2 * next + 1]}));
        }
        return std::make_shared<const Outline>(std::move(arcs));
    });
}

OutlineSample sampleOutline(const Outline& outline, double x, double y) {
    const OutlineTexel& cell = outline.texels[cellAt(outline, x, y)];
    const uint32_t* const list = &outline.lists[listOf(outline, cell)];
    const uint32_t count = cell[1] & 0xFFFF, met = cell[1] >> 16 & 0x7FFF;
    const glm::dvec2 p{x, y}, known{numberOf(cell[2]), numberOf(cell[3])}, turn{known.x, y};
    bool inside = cell[1] >> 31;
    double nearest = 1e300;
    uint32_t best = list[0];
    for (uint32_t k = 0; k < count; ++k) {
        const Arc& arc = outline.arcs[list[k]];
        if (const double distance = distanceTo(arc, p); distance < nearest)
            nearest = distance, best = list[k];
        if (k >= met) continue;
        const bool atTurn = isLeft(arc, turn);
        if ((arc.a.x <= turn.x) != (arc.b.x <= turn.x)) inside ^= isLeft(arc, known) != atTurn;
        if ((arc.a.y <= y) != (arc.b.y <= y)) inside ^= isLeft(arc, p) != atTurn;
    }
    const Arc& arc = outline.arcs[best];
    const double sign = inside ? -1 : 1;
    if (facesInside(arc, p)) {  // by the circle or line, which is exact near it
        const double side = sideOf(arc, p), out = side >= 0 ? sign : -sign;
        const glm::dvec2 towards = arc.normal - arc.bend * (p - arc.a);
        const glm::dvec2 slope = out / std::max(glm::length(towards), 1e-30) * towards;
        return {out * side, slope.x, slope.y};
    }
    const glm::dvec2 off = p - (squared(p - arc.a) <= squared(p - arc.b) ? arc.a : arc.b);
    const double distance = glm::length(off), out = distance > 0 ? sign / distance : 0;
    return {sign * distance, out * off.x, out * off.y};
}

Interval sampleOutline(const Outline& outline, Interval x, Interval y) {
    const double centre = sampleOutline(outline, 0.5 * (x.lo + x.hi), 0.5 * (y.lo + y.hi)).value;
    const double far = std::abs(centre) + absolute(x).hi + absolute(y).hi,
                 half = std::max(outline.half.x, outline.half.y);
    const double rounding =
        far < std::ldexp(half, kOutlineLevels - 2)
            ? 1e-14 * (far + std::abs(outline.centre.x) + std::abs(outline.centre.y) + half)
            : 1e-6 * far;
    const double reach = 0.5 * std::hypot(x.hi - x.lo, y.hi - y.lo) + rounding;
    return {std::max(centre - reach, outline.least - rounding), centre + reach};
}

double lipschitzConstant(const Outline& outline, Interval x, Interval y) {
    const glm::dvec2 half = halfOf(outline, kOutlineLevels - 1), lo = outline.centre - half,
                     hi = outline.centre + half;
    const bool within = x.lo >= lo.x && x.hi <= hi.x && y.lo >= lo.y && y.hi <= hi.y;
    return within ? 1.0 : std::numeric_limits<double>::infinity();
}

}  // namespace fw
