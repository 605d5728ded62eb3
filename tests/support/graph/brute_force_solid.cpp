#include "tests/support/graph/brute_force_solid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "tests/support/graph/random_scene.h"

namespace fw::test {

namespace {

using Cell = std::array<int, 3>;

constexpr int kBisections = 45;

Point between(const Point& a, const Point& b, double t) {
    return {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])};
}

double distanceOf(const Point& a, const Point& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// The offsets to the neighbours of a cell: of all 26, or of the 6 that share a face.
std::vector<Cell> neighbourOffsets(bool facesOnly) {
    std::vector<Cell> offsets;
    for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
            for (int z = -1; z <= 1; ++z) {
                const int distance = std::abs(x) + std::abs(y) + std::abs(z);
                if (distance > 0 && (!facesOnly || distance == 1)) offsets.push_back({x, y, z});
            }
    return offsets;
}

Cell plus(const Cell& a, const Cell& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }

std::vector<double> valuesAt(const PointField& field, const std::vector<Point>& points) {
    std::vector<double> values(points.size());
    field(points, values);
    return values;
}

void include(std::optional<Box>& box, const Point& point) { joinInto(box, Box{point, point}); }

/// The bodies of the inside cells, by flood fill.
std::vector<BruteForceBody> findBodies(const BruteForceSolid& solid, bool facesOnly) {
    const std::vector<Cell> offsets = neighbourOffsets(facesOnly);
    std::vector<BruteForceBody> bodies;
    std::vector<uint8_t> isFree = solid.inside;
    std::vector<std::size_t> open;
    for (std::size_t start = 0; start < isFree.size(); ++start) {
        if (!isFree[start]) continue;
        BruteForceBody body;
        std::optional<Box> centres;
        open = {start};
        isFree[start] = 0;
        while (!open.empty()) {
            const Cell cell = solid.grid.cell(open.back());
            open.pop_back();
            ++body.samples;
            include(centres, solid.grid.centre(cell));
            for (const Cell& offset : offsets) {
                const Cell next = plus(cell, offset);
                if (!solid.grid.contains(next) || !isFree[solid.grid.index(next)]) continue;
                isFree[solid.grid.index(next)] = 0;
                open.push_back(solid.grid.index(next));
            }
        }
        body.centres = *centres;
        bodies.push_back(body);
    }
    std::stable_sort(bodies.begin(), bodies.end(),
                     [](const BruteForceBody& a, const BruteForceBody& b) { return a.samples > b.samples; });
    return bodies;
}

/// Moves each pair of an inside and an outside point together, by bisection.
void closeIn(const PointField& field, std::vector<Point>& inside, std::vector<Point>& outside,
             int rounds = kBisections) {
    std::vector<Point> middles(inside.size());
    for (int round = 0; round < rounds; ++round) {
        for (std::size_t i = 0; i < middles.size(); ++i) middles[i] = between(inside[i], outside[i], 0.5);
        const std::vector<double> values = valuesAt(field, middles);
        for (std::size_t i = 0; i < middles.size(); ++i)
            (values[i] < 0.0 ? inside[i] : outside[i]) = middles[i];
    }
}

void findSignChanges(BruteForceSolid& solid) {
    const SampleGrid& grid = solid.grid;
    for (std::size_t at = 0; at < grid.size(); ++at) {
        const Cell cell = grid.cell(at);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            Cell next = cell;
            if (++next[axis] >= grid.cells[axis]) continue;
            const std::size_t other = grid.index(next);
            if (solid.inside[at] == solid.inside[other]) continue;
            solid.signChanges.push_back(solid.inside[at] ? SignChange{at, other} : SignChange{other, at});
        }
    }
}

/// Extends the bounds to the surface along the grid lines through the outermost inside cells.
void extendBounds(const PointField& field, BruteForceSolid& solid) {
    std::array<int, 3> lowest = solid.grid.cells, highest{-1, -1, -1};
    for (std::size_t at = 0; at < solid.inside.size(); ++at) {
        if (!solid.inside[at]) continue;
        const Cell cell = solid.grid.cell(at);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            lowest[axis] = std::min(lowest[axis], cell[axis]);
            highest[axis] = std::max(highest[axis], cell[axis]);
        }
    }
    std::vector<Point> inside, outside;
    for (const SignChange& change : solid.signChanges) {
        const Cell from = solid.grid.cell(change.inside), to = solid.grid.cell(change.outside);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const bool leavesLow = from[axis] == lowest[axis] && to[axis] < from[axis];
            const bool leavesHigh = from[axis] == highest[axis] && to[axis] > from[axis];
            if (!leavesLow && !leavesHigh) continue;
            inside.push_back(solid.grid.centre(from));
            outside.push_back(solid.grid.centre(to));
        }
    }
    closeIn(field, inside, outside);
    for (const Point& point : inside) include(solid.bounds, point);
}

/// Whether the cell is near the surface: one of its 26 neighbours has the other sign.
bool isNearSurface(const BruteForceSolid& solid, const Cell& cell, const std::vector<Cell>& offsets) {
    const uint8_t sign = solid.inside[solid.grid.index(cell)];
    return std::any_of(offsets.begin(), offsets.end(), [&](const Cell& offset) {
        const Cell next = plus(cell, offset);
        return solid.grid.contains(next) && solid.inside[solid.grid.index(next)] != sign;
    });
}

/// Volume and bounds by a random point in each octant of the cells near the surface.
void sampleNearSurface(const PointField& field, BruteForceSolid& solid, uint32_t seed) {
    constexpr std::size_t kOctants = 8;
    const std::vector<Cell> offsets = neighbourOffsets(false);
    SceneRandom random(seed);
    std::vector<Point> points;
    double insideCells = 0.0, variance = 0.0;
    for (std::size_t at = 0; at < solid.inside.size(); ++at) {
        const Cell cell = solid.grid.cell(at);
        if (!isNearSurface(solid, cell, offsets)) {
            insideCells += solid.inside[at];
            continue;
        }
        Point lowest = solid.grid.centre(cell);
        for (double& x : lowest) x -= 0.5 * solid.grid.step;
        for (std::size_t octant = 0; octant < kOctants; ++octant) {
            Point point = lowest;
            for (std::size_t axis = 0; axis < 3; ++axis)
                point[axis] += 0.5 * solid.grid.step * (double(octant >> axis & 1) + random.between(0, 1));
            points.push_back(point);
        }
    }
    const std::vector<double> values = valuesAt(field, points);
    for (std::size_t first = 0; first < points.size(); first += kOctants) {
        double share = 0.0;
        for (std::size_t i = first; i < first + kOctants; ++i) {
            if (!(values[i] < 0.0)) continue;
            share += 1.0 / kOctants;
            include(solid.bounds, points[i]);
        }
        insideCells += share;
        // That of independent samples of the whole cell. One in each octant deviates less.
        variance += share * (1.0 - share) / kOctants;
    }
    const double cellVolume = std::pow(solid.grid.step, 3.0);
    solid.volume = insideCells * cellVolume;
    solid.volumeError = 3.0 * std::sqrt(variance) * cellVolume;
}

/// Drops the segments whose surface point is farther from `from` than the one of a nearer segment.
void dropFarther(const Point& from, std::vector<Point>& inside, std::vector<Point>& outside) {
    // Along a segment the distance has no maximum between the ends, and its minimum is off by its length.
    double farthestOfBest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < inside.size(); ++i)
        farthestOfBest =
            std::min(farthestOfBest, std::max(distanceOf(from, inside[i]), distanceOf(from, outside[i])));
    std::vector<Point> keptInside, keptOutside;
    for (std::size_t i = 0; i < inside.size(); ++i) {
        const double nearer = std::min(distanceOf(from, inside[i]), distanceOf(from, outside[i]));
        if (nearer - distanceOf(inside[i], outside[i]) > farthestOfBest) continue;
        keptInside.push_back(inside[i]);
        keptOutside.push_back(outside[i]);
    }
    inside = std::move(keptInside);
    outside = std::move(keptOutside);
}

/// Finds a surface point on segments that change the sign, and keeps the nearest to `from`.
void keepNearest(const PointField& field, const Point& from, std::vector<Point> inside,
                 std::vector<Point> outside, NearestSurface& nearest) {
    for (int rounds = 0; rounds < kBisections; rounds += 9) {
        closeIn(field, inside, outside, 9);
        dropFarther(from, inside, outside);
    }
    for (std::size_t i = 0; i < inside.size(); ++i) {
        const double distance = std::max(distanceOf(from, inside[i]), distanceOf(from, outside[i]));
        if (!(distance < nearest.distance)) continue;
        nearest.distance = distance;
        nearest.at = inside[i];
        nearest.rounding = 1e-12 * (distance + std::hypot(from[0], from[1], from[2]));
    }
}

/// A direction of length 1, `spread` away from `way`.
Point spreadDirection(const Point& way, double spread, SceneRandom& random) {
    const Point off = random.direction();
    Point sum{way[0] + spread * off[0], way[1] + spread * off[1], way[2] + spread * off[2]};
    const double length = std::hypot(sum[0], sum[1], sum[2]);
    if (length < 1e-9) return way;
    for (double& x : sum) x /= length;
    return sum;
}

/// The direction from the point down to the surface, by finite differences.
Point towardsSurface(const PointField& field, const Point& point, double step) {
    std::vector<Point> points(7, point);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        points[1 + 2 * axis][axis] -= step;
        points[2 + 2 * axis][axis] += step;
    }
    const std::vector<double> values = valuesAt(field, points);
    Point way{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double slope = values[2 + 2 * axis] - values[1 + 2 * axis];
        way[axis] = values[0] < 0.0 ? slope : -slope;
    }
    const double length = std::hypot(way[0], way[1], way[2]);
    if (!(length > 0.0 && std::isfinite(length))) return {1, 0, 0};
    for (double& x : way) x /= length;
    return way;
}

/// Looks for surface points nearer than `nearest` in random directions around the best one.
void searchAround(const PointField& field, const Point& point, double value, double step, uint32_t seed,
                  NearestSurface& nearest) {
    constexpr int kRounds = 24, kDirections = 10, kAroundFoot = 100;
    const bool isInside = value < 0.0;
    SceneRandom random(seed);
    double spread = std::min(1.0, 2.0 * step / std::max(nearest.distance, 1e-300));
    Point best{};
    for (std::size_t axis = 0; axis < 3; ++axis)
        best[axis] = (nearest.at[axis] - point[axis]) / std::max(nearest.distance, 1e-300);
    for (int round = 0; round < kRounds; ++round) {
        std::vector<Point> ways, ends, inside, outside;
        if (round == 0) {
            const Point way = towardsSurface(field, point, 1e-4 * step);
            ways.push_back(way);
            // A true distance leads to the surface, also of a part that no sample has hit. That can be a
            // sharp edge, so the solid is looked for in all directions from there.
            for (int i = 0; i < kAroundFoot && std::abs(value) < nearest.distance; ++i) {
                const Point off = random.direction();
                Point& end = ends.emplace_back();
                for (std::size_t axis = 0; axis < 3; ++axis)
                    end[axis] = point[axis] + std::abs(value) * way[axis] + 0.01 * step * off[axis];
            }
        }
        while (int(ways.size()) < kDirections) ways.push_back(spreadDirection(best, spread, random));
        for (const Point& way : ways)
            ends.push_back({point[0] + nearest.distance * way[0], point[1] + nearest.distance * way[1],
                            point[2] + nearest.distance * way[2]});
        const std::vector<double> values = valuesAt(field, ends);
        for (std::size_t i = 0; i < ends.size(); ++i) {
            if ((values[i] < 0.0) == isInside) continue;
            inside.push_back(isInside ? point : ends[i]);
            outside.push_back(isInside ? ends[i] : point);
        }
        const double before = nearest.distance;
        keepNearest(field, point, std::move(inside), std::move(outside), nearest);
        if (nearest.distance < before) {
            for (std::size_t axis = 0; axis < 3; ++axis)
                best[axis] = (nearest.at[axis] - point[axis]) / std::max(nearest.distance, 1e-300);
        } else {
            spread *= 0.6;
        }
    }
}

}  // namespace

Cell SampleGrid::cell(std::size_t index) const {
    const std::size_t y = std::size_t(cells[1]), z = std::size_t(cells[2]);
    return {int(index / (y * z)), int(index / z % y), int(index % z)};
}

bool SampleGrid::contains(const Cell& cell) const {
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (cell[axis] < 0 || cell[axis] >= cells[axis]) return false;
    return true;
}

Point SampleGrid::centre(const Cell& cell) const {
    Point point = corner;
    for (std::size_t axis = 0; axis < 3; ++axis) point[axis] += step * (cell[axis] + 0.5);
    return point;
}

Box SampleGrid::box() const {
    Box box{corner, corner};
    for (std::size_t axis = 0; axis < 3; ++axis) box.hi[axis] += step * cells[axis];
    return box;
}

SampleGrid gridOver(const Box& box, int cells) {
    SampleGrid grid;
    grid.step = longestSide(box) / cells;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double length = box.hi[axis] - box.lo[axis];
        grid.cells[axis] = std::max(1, int(std::ceil(length / grid.step - 1e-9)));
        grid.corner[axis] = 0.5 * (box.lo[axis] + box.hi[axis] - grid.step * grid.cells[axis]);
    }
    return grid;
}

BruteForceSolid sampleByBruteForce(const PointField& field, const SampleGrid& grid, uint32_t seed) {
    BruteForceSolid solid;
    solid.grid = grid;
    solid.inside.resize(grid.size());
    solid.boundsError = std::numbers::sqrt3 * grid.step;
    std::vector<Point> column(std::size_t(grid.cells[2]));
    std::vector<double> values(column.size());
    for (std::size_t first = 0; first < grid.size(); first += column.size()) {
        for (std::size_t i = 0; i < column.size(); ++i) column[i] = grid.centre(first + i);
        field(column, values);
        for (std::size_t i = 0; i < column.size(); ++i) {
            if (!(values[i] < 0.0)) continue;
            solid.inside[first + i] = 1;
            ++solid.insideSamples;
            include(solid.bounds, column[i]);
            const Cell cell = grid.cell(first + i);
            for (std::size_t axis = 0; axis < 3; ++axis)
                solid.touchesGrid |= cell[axis] == 0 || cell[axis] == grid.cells[axis] - 1;
        }
    }
    solid.bodies = findBodies(solid, true);
    solid.bodiesByCorners = findBodies(solid, false).size();
    findSignChanges(solid);
    extendBounds(field, solid);
    sampleNearSurface(field, solid, seed);
    return solid;
}

NearestSurface nearestSurface(const PointField& field, const BruteForceSolid& solid, const Point& point,
                              uint32_t seed) {
    NearestSurface nearest;
    nearest.distance = std::numeric_limits<double>::infinity();
    nearest.error = std::numbers::sqrt3 * solid.grid.step;
    // A surface point between two centres is at most half a step from the middle between them.
    std::vector<std::pair<double, std::size_t>> changes;
    double least = std::numeric_limits<double>::infinity();
    const auto middleOf = [&](const SignChange& change) {
        return between(solid.grid.centre(change.inside), solid.grid.centre(change.outside), 0.5);
    };
    for (std::size_t i = 0; i < solid.signChanges.size(); ++i) {
        const double distance = distanceOf(point, middleOf(solid.signChanges[i]));
        if (distance > least + solid.grid.step) continue;
        least = std::min(least, distance);
        changes.push_back({distance, i});
    }
    std::erase_if(changes, [&](const auto& change) { return change.first > least + solid.grid.step; });
    // Enough of them to be among the nearest. The search around the best one does the rest.
    constexpr std::size_t kRefined = 24;
    std::sort(changes.begin(), changes.end());
    changes.resize(std::min(changes.size(), kRefined));
    std::vector<Point> inside, outside;
    for (const auto& [distance, i] : changes) {
        inside.push_back(solid.grid.centre(solid.signChanges[i].inside));
        outside.push_back(solid.grid.centre(solid.signChanges[i].outside));
    }
    keepNearest(field, point, std::move(inside), std::move(outside), nearest);
    if (!std::isfinite(nearest.distance)) return nearest;
    double value = 0.0;
    field(std::span(&point, 1), std::span(&value, 1));
    searchAround(field, point, value, solid.grid.step, seed, nearest);
    return nearest;
}

}  // namespace fw::test
