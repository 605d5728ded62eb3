#include "graph/curves/spline_table.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <map>
#include <mutex>
#include <numeric>
#include <span>
#include <utility>

#include "graph/base/grown_cells.h"
#include "graph/base/hash.h"

namespace fw {

namespace {

constexpr double kGridSlack = 1e-3;  // of a cell: places that rounding puts into a neighbour are served too
constexpr int kSplittings = 2;       // of a level, before its parts are shared out
constexpr double kLeastSag = 0.3;
constexpr double kMostSwelling = 2;
constexpr uint32_t kPlainCell = 1u << 31;
constexpr uint32_t kLongestRun = 0x7FFF;  // arcs
constexpr double kStraightOn = 1e-3;      // sine of an angle that is no corner

uint32_t wordFor(double x) { return std::bit_cast<uint32_t>(float(x)); }

glm::ivec3 cellsAt(const SplineTable& table, int level) {
    return level == 0 ? table.cells
                      : glm::ivec3(level <= kSplineNearLevels ? kSplineNearCells : kSplineFarCells);
}
std::size_t firstAt(const SplineTable& table, int level) {
    std::size_t first = 0;
    for (int k = 0; k < level; ++k) {
        const glm::ivec3 cells = cellsAt(table, k);
        first += std::size_t(cells.x) * std::size_t(cells.y) * std::size_t(cells.z);
    }
    return first;
}
double widest(const SplineTable& table) { return std::max({table.half.x, table.half.y, table.half.z}); }
glm::dvec3 halfAt(const SplineTable& table, int level) {
    return level == 0 ? table.half : glm::dvec3(std::ldexp(widest(table), level));
}
glm::dvec3 sizeAt(const SplineTable& table, int level) {  // of a cell
    return 2.0 * halfAt(table, level) / glm::dvec3(cellsAt(table, level));
}

/// The nearest place of a spline.
struct Beside {
    const SpaceArc* arc;
    SpaceFoot foot;
};

/// One arc's ball, if it is closer than what was found; and where it is on the arc, metres from its middle.
double take(const SplineTable& table, uint32_t number, const glm::dvec3& p, Beside& best) {
    const SpaceArc& arc = table.spline->arcs[number];
    const SpaceFoot foot = nearestOn(arc, p, table.radius);
    if (foot.distance < best.foot.distance) best = {&arc, foot};
    return foot.s;
}

/// Of a run the arc at whose place the spline comes the closest, by halves.
uint32_t halved(const SplineTable& table, const SplineTable::Run& run, const glm::dvec3& p) {
    uint32_t lo = run.first, hi = run.first + run.count - 1;
    while (lo < hi) {
        const uint32_t mid = (lo + hi + 1) / 2;
        const SplineTable::Joint& joint = table.joints[mid];
        const glm::dvec3 off = p - joint.place;
        if (glm::dot(off, joint.leads) + table.radius * joint.shareSlope * glm::length(off) >= 0)
            lo = mid;
        else
            hi = mid - 1;
    }
    return lo;
}

/// Makes the cells and runs of a table, level by level.
class TableMaker {
  public:
    explicit TableMaker(SplineTable& table_) : table(table_), all(table.spline->arcs) {
        for (const SpaceArc& arc : all)
            around.push_back({arc.middle, arc.half, table.radius * arc.radius,
                              table.radius * (arc.radius + std::abs(arc.radiusSlope) * arc.half)});
        // A run ends at a corner, and so that none has more arcs than its word can count.
        for (std::size_t i = 1; i < all.size(); ++i) {
            const glm::dvec3 from = directionOn(all[i - 1], all[i - 1].half), to = table.joints[i].leads;
            follows.push_back(glm::length(glm::cross(from, to)) < kStraightOn && glm::dot(from, to) > 0);
        }
    }

    void run() {
        std::vector<uint32_t> arcs(all.size());
        std::iota(arcs.begin(), arcs.end(), 0u);
        table.texels.resize(firstAt(table, kSplineLevels));
        for (int level = 0; level < kSplineLevels; ++level) {
            const glm::ivec3 cells = cellsAt(table, level);
            beyond.assign(all.size(), false);
            cellsOfLevel(level, int(std::bit_ceil(unsigned(std::max({cells.x, cells.y, cells.z})))), arcs);
            arcs.clear();
            for (uint32_t i = 0; i < all.size(); ++i)
                if (beyond[i]) arcs.push_back(i);
        }
        for (std::size_t i = 0; i < table.runs.size(); i += 4) {
            SplineTexel four{};
            for (std::size_t k = i; k < std::min(i + 4, table.runs.size()); ++k)
                four[k - i] = table.runs[k].first | table.runs[k].count << 16;
            table.texels.push_back(four);
        }
        for (const SpaceArc& arc : all) {
            const double k = arc.bend, angle = k * arc.half, sine = std::sin(0.5 * angle);
            const bool line = k * arc.half < 1e-9;
            texel(arc.middle, k);
            texel(arc.along, line ? arc.half : std::sin(angle) / k);
            texel(arc.towards, line ? 0.0 : 2 * sine * sine / k);
            texel({arc.half, arc.begin, arc.radius}, arc.radiusSlope);
            const bool open = !table.spline->closed;
            table.texels.push_back(
                {wordFor(arc.turn), wordFor(arc.turnSlope),
                 uint32_t(open && &arc == &all.front()) | uint32_t(open && &arc == &all.back()) << 1, 0});
            const SplineTable::Joint& joint = table.joints[std::size_t(&arc - all.data())];
            texel(joint.place, joint.shareSlope);
            texel(joint.leads, 0);
        }
    }

  private:
    struct Cube {
        glm::dvec3 low, size;
        glm::dvec3 centre() const { return low + 0.5 * size; }
        double reach() const { return (0.5 + kGridSlack) * glm::length(size); }  // from the centre
        glm::dvec3 corner(int i) const {
            const glm::dvec3 grown = (1 + 2 * kGridSlack) * size;
            return low - kGridSlack * size + grown * glm::dvec3(i & 1, i >> 1 & 1, i >> 2);
        }
    };
    /// A ball that has an arc, and the radii of the balls that run along it: in its middle and at most.
    struct Around {
        glm::dvec3 middle;
        double reach, radius, most;
    };

    void texel(const glm::dvec3& v, double w) {
        table.texels.push_back({wordFor(v.x), wordFor(v.y), wordFor(v.z), wordFor(w)});
    }

    /// Of the arcs those that may be the nearest somewhere in the cube.
    std::vector<uint32_t> nearestOf(const std::vector<uint32_t>& arcs, const Cube& own) const {
        const glm::dvec3 centre = own.centre();
        std::vector<double> far(arcs.size());
        double least = 1e300;
        for (std::size_t k = 0; k < arcs.size(); ++k) {
            far[k] = glm::distance(centre, around[arcs[k]].middle);
            least = std::min(least, far[k] - around[arcs[k]].radius);
        }
        const double most = least + 2 * own.reach();
        std::vector<uint32_t> near;
        for (std::size_t k = 0; k < arcs.size(); ++k)
            if (far[k] - around[arcs[k]].reach - around[arcs[k]].most <= most) near.push_back(arcs[k]);
        if (near.size() > 1) dropDominated(near, own);
        return near;
    }

    /// Leaves away what is nowhere in the cube as near as the middle of some other arc. Where one place is
    /// nearer than another by more than a length, at least 0, is one branch of a hyperboloid, which has all
    /// of a cube if it has its corners.
    void dropDominated(std::vector<uint32_t>& arcs, const Cube& own) const {
        std::array<glm::dvec3, 8> corners;
        for (int c = 0; c < 8; ++c) corners[std::size_t(c)] = own.corner(c);
        std::vector<std::array<double, 8>> far(arcs.size());  // of each arc's middle from each corner
        std::array<std::size_t, 8> closest{};                 // to each corner
        for (std::size_t k = 0; k < arcs.size(); ++k)
            for (std::size_t c = 0; c < 8; ++c) {
                far[k][c] = glm::distance(corners[c], around[arcs[k]].middle);
                if (far[k][c] - around[arcs[k]].radius < far[closest[c]][c] - around[arcs[closest[c]]].radius)
                    closest[c] = k;
            }
        std::ranges::sort(closest);
        const std::span<const std::size_t> others(closest.begin(),
                                                  std::unique(closest.begin(), closest.end()));
        std::vector<uint32_t> left;
        for (std::size_t k = 0; k < arcs.size(); ++k) {
            const Around& arc = around[arcs[k]];
            const bool dominated = std::ranges::any_of(others, [&](std::size_t other) {
                const double by =
                    std::max(arc.reach + arc.most - around[arcs[other]].radius, 0.0) * (1 + 1e-9);
                for (std::size_t c = 0; c < 8; ++c)
                    if (!(far[k][c] - far[other][c] > by)) return false;
                return true;
            });
            if (!dominated) left.push_back(arcs[k]);
        }
        arcs = std::move(left);
    }

    /// Cells from one on, as many along each axis, of which `arcs` are all that can be near.
    struct Part {
        glm::ivec3 at;
        int side;
        std::vector<uint32_t> arcs;
    };
    struct Leaf {
        glm::ivec3 at;
        std::vector<uint32_t> near;
    };
    void cellsOfLevel(int level, int side, const std::vector<uint32_t>& arcs) {
        const auto split = [&](const Part& part, const auto& take) {
            const std::vector<uint32_t> near = nearIn(level, part);
            const int half = part.side / 2;
            if (near.empty()) return;
            for (int k = 0; k < 8; ++k)
                take(Part{part.at + half * glm::ivec3(k & 1, k >> 1 & 1, k >> 2), half, near});
        };
        const auto grow = [&](const Part& part, std::vector<Leaf>& leaves) {
            if (std::vector<uint32_t> near = nearIn(level, part); !near.empty())
                leaves.push_back({part.at, std::move(near)});
        };
        for (const Leaf& leaf : grownCells<Leaf>(Part{{0, 0, 0}, side, arcs}, kSplittings, split, grow))
            add(level, leaf.at, leaf.near);
    }
    Cube cubeOf(int level, const glm::ivec3& at, int side) const {
        const glm::dvec3 size = sizeAt(table, level);
        return {table.centre - halfAt(table, level) + glm::dvec3(at) * size, double(side) * size};
    }
    /// The arcs that may be the nearest somewhere in a part; none if it needs none.
    std::vector<uint32_t> nearIn(int level, const Part& part) const {
        const glm::ivec3 cells = cellsAt(table, level);
        if (part.at.x >= cells.x || part.at.y >= cells.y || part.at.z >= cells.z) return {};
        const Cube own = cubeOf(level, part.at, part.side);
        // What a lower level serves needs no lists here.
        if (level > 0) {
            const glm::dvec3 lower = halfAt(table, level - 1) - sizeAt(table, level),
                             lo = table.centre - lower, hi = table.centre + lower, end = own.low + own.size;
            if (glm::all(glm::greaterThan(own.low, lo)) && glm::all(glm::lessThan(end, hi))) return {};
        }
        return nearestOf(part.arcs, own);
    }

    void add(int level, const glm::ivec3& at, const std::vector<uint32_t>& near) {
        const glm::ivec3 cells = cellsAt(table, level);
        const Cube own = cubeOf(level, at, 1);
        // The way from a place beyond this level to its nearest one leaves the level by an outermost cell.
        if (glm::any(glm::equal(at, glm::ivec3(0))) || glm::any(glm::equal(at, cells - 1)))
            for (const uint32_t i : near) beyond[i] = true;
        const std::size_t index =
            firstAt(table, level) + std::size_t((at.z * cells.y + at.y) * cells.x + at.x);
        const auto begin = uint32_t(table.runs.size());
        bool sags = true;
        double bend = 0, turn = 0;
        for (const uint32_t i : near) {
            const bool own_ = sagsAround(i, own);
            sags &= own_;
            bend = std::max(bend, all[i].bend), turn = std::max(turn, std::abs(all[i].turnSlope));
            SplineTable::Run* last = table.runs.size() > begin ? &table.runs.back() : nullptr;
            if (last && runSags && own_ && last->first + last->count == i && follows[i - 1] &&
                last->count < kLongestRun)
                ++last->count;
            else
                table.runs.push_back({i, 1});
            runSags = own_;
        }
        const auto count = uint32_t(table.runs.size()) - begin;
        // All of a closed one has its two ends side by side.
        const bool plain = count == 1 && sags && !(table.spline->closed && near.size() == all.size());
        table.texels[index] = {begin, count | (plain ? kPlainCell : 0u), wordFor(bend * (1 + 1e-6)),
                               wordFor(turn * (1 + 1e-6))};
    }

    /// Whether the squared distance of any place of the cube sags along all of the arc: then two such arcs
    /// that follow each other without a corner have one nearest place. Where balls change, the distance
    /// itself must sag by more than their radii swell.
    bool sagsAround(uint32_t i, const Cube& own) const {
        const SpaceArc& arc = all[i];
        const glm::dvec3 off = arc.middle - own.centre();
        const double far = glm::length(off) + own.reach() + arc.half,
                     lean = glm::dot(off, arc.towards) - own.reach() - (1 + arc.bend * far) * arc.half,
                     sag = 1 + arc.bend * lean;  // half of the squared distance's second derivative
        if (sag < kLeastSag) return false;
        if (!table.tapered) return true;
        double swells = 0, steep = std::abs(arc.radiusSlope);
        for (const uint32_t k : {i, std::min(i + 1, uint32_t(all.size()) - 1)})
            if (k > 0) {
                swells = std::max(swells, std::abs(all[k].radiusSlope - all[k - 1].radiusSlope) /
                                              (all[k].half + all[k - 1].half));
                steep = std::max({steep, std::abs(all[k].radiusSlope), std::abs(all[k - 1].radiusSlope)});
            }
        // Where a ball is the nearest the distance grows along the arc as its radius does, and its second
        // derivative is what the squared distance's half leaves, over the distance.
        const double rises = table.radius * steep;
        return (sag - rises * rises) / far > kMostSwelling * table.radius * swells;
    }

    SplineTable& table;
    const std::vector<SpaceArc>& all;
    std::vector<Around> around;
    std::vector<bool> follows;  ///< whether the arc after each goes on without a corner
    std::vector<bool> beyond;   ///< arcs that can be the nearest beyond the level
    bool runSags = false;       ///< the last run's arcs do
};

/// The cell that serves a place.
struct CellAt {
    std::size_t index;
    glm::dvec3 lo, hi;
};
CellAt cellFor(const SplineTable& table, const glm::dvec3& p) {
    const glm::dvec3 away = p - table.centre;
    int level = 0;
    double shrink = 1;
    if (!(std::abs(away.x) < table.half.x && std::abs(away.y) < table.half.y &&
          std::abs(away.z) < table.half.z)) {
        const double far = std::max({std::abs(away.x), std::abs(away.y), std::abs(away.z)}) / widest(table);
        std::frexp(far, &level);
        level = std::clamp(level, 1, kSplineLevels - 1);
        shrink = std::max(1.0, std::ldexp(far, -level));  // beyond the last: in the same direction
    }
    const glm::dvec3 half = halfAt(table, level), size = sizeAt(table, level);
    const glm::ivec3 cells = cellsAt(table, level);
    glm::ivec3 at;
    for (int k = 0; k < 3; ++k) {
        const double cell = (away[k] / (shrink * half[k]) + 1) * 0.5 * cells[k];
        at[k] = int(cell >= 0 ? std::min(cell, cells[k] - 1.0) : 0.0);  // 0 also for no number
    }
    const glm::dvec3 lo = table.centre - half + glm::dvec3(at) * size;
    return {firstAt(table, level) + std::size_t((at.z * cells.y + at.y) * cells.x + at.x), lo, lo + size};
}

Beside besideOf(const SplineTable& table, const SplineTexel& cell, const glm::dvec3& p) {
    Beside best{nullptr, {0, 1e300, false}};
    const uint32_t count = cell[1] & ~kPlainCell;
    for (uint32_t k = 0; k < count; ++k) {
        const SplineTable::Run& run = table.runs[cell[0] + k];
        const uint32_t at = halved(table, run, p);
        const double s = take(table, at, p, best);
        if (!table.tapered) continue;
        // Of balls that change it may be the one beside, on the side of what was found.
        const uint32_t beside =
            s < 0 ? std::max(at, run.first + 1) - 1 : std::min(at + 1, run.first + run.count - 1);
        take(table, beside, p, best);
    }
    // Only where the position is NaN is no arc the nearest one.
    if (!best.arc) best = {&table.spline->arcs.front(), {0, NAN, false}};
    return best;
}

/// Across and up, and along; with the directions in which they grow.
struct Coordinates {
    double across, up, along;
    glm::dvec3 acrossSlope, upSlope, alongSlope;
};
Coordinates coordinatesOf(const SplineTable& table, const Beside& beside, const glm::dvec3& p) {
    const SpaceArc& arc = *beside.arc;
    const double s = beside.foot.s, angle = arc.turn + arc.turnSlope * s, cosine = std::cos(angle),
                 sine = std::sin(angle);
    const glm::dvec3 off = p - placeOn(arc, s), leads = directionOn(arc, s), towards = towardsOn(arc, s),
                     across = arc.across();
    double t = glm::dot(off, towards), z = glm::dot(off, across), along = arc.begin + arc.half + s;
    glm::dvec3 grows(0);
    const std::vector<SpaceArc>& all = table.spline->arcs;
    const bool open =
        !table.spline->closed && ((&arc == &all.front() && s < 0) || (&arc == &all.back() && s > 0));
    if (!beside.foot.beyond) {
        grows = leads / std::max(1 - arc.bend * t, 1e-9);
    } else if (open) {
        along += glm::dot(off, leads);
        grows = leads;
    } else if (const double flat = std::hypot(t, z); flat > 0) {
        const double stretch = glm::length(off) / flat;
        t *= stretch, z *= stretch;
    } else {
        t = glm::length(off);
    }
    Coordinates found;
    found.across = cosine * t + sine * z;
    found.up = cosine * z - sine * t;
    found.along = along;
    const glm::dvec3 first = cosine * towards + sine * across, second = cosine * across - sine * towards;
    const glm::dvec3 turns = beside.foot.beyond ? glm::dvec3(0) : arc.turnSlope * grows;
    found.acrossSlope = first + found.up * turns;
    found.upSlope = second - found.across * turns;
    found.alongSlope = grows;
    return found;
}

}  // namespace

SplineTable::SplineTable(SplinePtr spline_, double radius_) : spline(std::move(spline_)), radius(radius_) {
    glm::dvec3 lo(1e300), hi(-1e300);
    leastShare = 1e300, mostShare = 0, shareSlope = 0;
    for (const SpaceArc& arc : spline->arcs) {
        for (const double s : {-arc.half, 0.0, arc.half}) {
            lo = glm::min(lo, placeOn(arc, s)), hi = glm::max(hi, placeOn(arc, s));
            leastShare = std::min(leastShare, arc.radius + arc.radiusSlope * s);
            mostShare = std::max(mostShare, arc.radius + arc.radiusSlope * s);
        }
        shareSlope = std::max(shareSlope, std::abs(arc.radiusSlope));
    }
    tapered = radius > 0 && shareSlope > 0;
    least = -radius * mostShare;
    hash = mixed(spline->hash, std::bit_cast<uint64_t>(radius));
    const glm::dvec3 size = hi - lo;
    const double most = std::max({size.x, size.y, size.z, 1e-6});
    centre = glm::dvec3(glm::vec3(0.5 * (lo + hi)));
    half = glm::dvec3(glm::vec3(0.5 * size + 0.15 * most));
    const auto n = double(spline->arcs.size());
    const double wanted = std::clamp(16 * n, 2048.0, 16384.0),
                 cell = 2 * std::cbrt(half.x * half.y * half.z / wanted);
    for (int k = 0; k < 3; ++k) cells[k] = std::max(1, int(std::lround(2 * half[k] / cell)));
    for (std::size_t i = 0; i < spline->arcs.size(); ++i) {
        const SpaceArc &arc = spline->arcs[i], &before = spline->arcs[i == 0 ? i : i - 1];
        joints.push_back({placeOn(arc, -arc.half), directionOn(arc, -arc.half),
                          0.5 * (arc.radiusSlope + before.radiusSlope)});
    }
    TableMaker(*this).run();
}

SplineTablePtr splineTable(const SplinePtr& spline, double radius) {
    static std::mutex mutex;
    static std::map<std::pair<uint64_t, double>, std::weak_ptr<const SplineTable>> known;
    const std::lock_guard lock(mutex);
    std::erase_if(known, [](const auto& item) { return item.second.expired(); });
    const std::pair key(spline->hash, radius);
    if (const auto found = known.find(key); found != known.end())
        if (SplineTablePtr table = found->second.lock(); table && table->spline->arcs == spline->arcs)
            return table;
    auto table = std::make_shared<const SplineTable>(spline, radius);
    known[key] = table;
    return table;
}

SplineSample sampleSpline(const SplineTable& table, SplineChannel channel, const glm::dvec3& p) {
    const Beside beside = besideOf(table, table.texels[cellFor(table, p).index], p);
    if (channel == SplineChannel::distance) {
        const glm::dvec3 off = p - placeOn(*beside.arc, beside.foot.s);
        const double length = glm::length(off);
        return {beside.foot.distance, length > 0 ? off / length : glm::dvec3(0)};
    }
    const Coordinates at = coordinatesOf(table, beside, p);
    switch (channel) {
        case SplineChannel::across: return {at.across, at.acrossSlope};
        case SplineChannel::up: return {at.up, at.upSlope};
        case SplineChannel::along: return {at.along, at.alongSlope};
        default: break;
    }
    const SpaceArc& arc = *beside.arc;
    return {arc.radius + arc.radiusSlope * beside.foot.s,
            beside.foot.beyond ? glm::dvec3(0) : arc.radiusSlope * at.alongSlope};
}

Interval sampleSpline(const SplineTable& table, SplineChannel channel, const Interval* p) {
    const glm::dvec3 middle(0.5 * (p[0].lo + p[0].hi), 0.5 * (p[1].lo + p[1].hi), 0.5 * (p[2].lo + p[2].hi)),
        half(0.5 * (p[0].hi - p[0].lo), 0.5 * (p[1].hi - p[1].lo), 0.5 * (p[2].hi - p[2].lo));
    const double far = absolute(p[0]).hi + absolute(p[1]).hi + absolute(p[2]).hi + glm::length(table.centre) +
                       widest(table),
                 rounding = (far < std::ldexp(widest(table), kSplineLevels - 2) ? 1e-13 : 1e-6) * far,
                 reach = glm::length(half) + rounding;
    const CellAt cell = cellFor(table, middle);
    const SplineTexel& texel = table.texels[cell.index];
    const Beside beside = besideOf(table, texel, middle);
    const double nearest = beside.foot.distance;
    if (channel == SplineChannel::distance)
        return {std::max(nearest - reach, table.least - rounding), nearest + reach};
    const double most = nearest + reach, bend = double(std::bit_cast<float>(texel[2])),
                 turn = double(std::bit_cast<float>(texel[3]));
    bool plain = (texel[1] & kPlainCell) && bend * most < 0.9;
    for (int k = 0; k < 3; ++k) plain &= p[k].lo >= cell.lo[k] && p[k].hi <= cell.hi[k];
    const double stretch = plain ? reach / (1 - bend * most) : 0;  // of the place along it
    const Coordinates at = coordinatesOf(table, beside, middle);
    const auto around = [&](double value, double by, double lo, double hi) -> Interval {
        return plain ? Interval{std::max(value - by, lo), std::min(value + by, hi)} : Interval{lo, hi};
    };
    switch (channel) {
        case SplineChannel::across: return around(at.across, reach + most * turn * stretch, -most, most);
        case SplineChannel::up: return around(at.up, reach + most * turn * stretch, -most, most);
        case SplineChannel::along: {
            const double over = table.spline->closed ? rounding : most;
            return around(at.along, stretch + rounding, -over, table.spline->length + over);
        }
        default: break;
    }
    const SpaceArc& arc = *beside.arc;
    return around(arc.radius + arc.radiusSlope * beside.foot.s, table.shareSlope * stretch, table.leastShare,
                  table.mostShare);
}

double lipschitzConstant(const SplineTable& table, SplineChannel channel, const Interval* p) {
    constexpr double kUnknown = std::numeric_limits<double>::infinity();
    const glm::dvec3 middle(0.5 * (p[0].lo + p[0].hi), 0.5 * (p[1].lo + p[1].hi), 0.5 * (p[2].lo + p[2].hi)),
        half(0.5 * (p[0].hi - p[0].lo), 0.5 * (p[1].hi - p[1].lo), 0.5 * (p[2].hi - p[2].lo));
    if (channel == SplineChannel::distance) {
        const glm::dvec3 reach = glm::abs(middle - table.centre) + half;
        const double outermost = std::ldexp(widest(table), kSplineLevels - 1);
        return std::max({reach.x, reach.y, reach.z}) < outermost ? 1.0 : kUnknown;
    }
    // The others are as smooth as the spline in a plain cell.
    const CellAt cell = cellFor(table, middle);
    const SplineTexel& texel = table.texels[cell.index];
    if (!(texel[1] & kPlainCell)) return kUnknown;
    for (int k = 0; k < 3; ++k)
        if (p[k].lo < cell.lo[k] || p[k].hi > cell.hi[k]) return kUnknown;
    const double most = besideOf(table, texel, middle).foot.distance + glm::length(half) +
                        table.radius * table.mostShare,
                 bend = double(std::bit_cast<float>(texel[2])), turn = double(std::bit_cast<float>(texel[3]));
    if (!(bend * most < 0.9)) return kUnknown;
    const double along = (1 + 1e-9) / (1 - bend * most);
    switch (channel) {
        case SplineChannel::across:
        case SplineChannel::up: return 1 + most * turn * along;
        case SplineChannel::along: return along;
        default: return table.shareSlope * along;
    }
}

}  // namespace fw
