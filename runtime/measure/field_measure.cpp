#include "runtime/measure/field_measure.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>

#include "graph/base/parallel.h"
#include "graph/evaluate/evaluate.h"

namespace fw {

namespace {

constexpr int kNewtonSteps = 8;
constexpr double kNear = 1e-6;         // of the way gone, that may be left
constexpr int kLeastPieces = 4096;     // of the region's longest side: what is shorter is not halved further
constexpr double kWorthKeeping = 0.8;  // of its steps that a shortened tape may have
constexpr int kLines = 12'000;
constexpr uint32_t kTogether = 8;            // lines that have a tape in common
constexpr std::size_t kMostIntervals = 400;  // of a line; they say little where it takes more
// Work in steps of a tape at a point, of which a thread makes about a billion a second.
constexpr double kStepOnInterval = 16.0;
constexpr double kMostWork = 2e9;  // of all lines, and of all points of the mesh
constexpr int kFirstLines = 48;
constexpr double kStepsToSurface = 40.0;  // a step for values and gradients, two or three times

std::vector<Point> positionsOf(std::span<const glm::dvec3> points) {
    std::vector<Point> positions(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) positions[i] = {points[i].x, points[i].y, points[i].z};
    return positions;
}

/// How far a point lies outside of the box, or, negative, from its nearest face.
double beyond(const Box& box, const Point& p) {
    double most = -INFINITY;
    for (std::size_t axis = 0; axis < 3; ++axis)
        most = std::max({most, box.lo[axis] - p[axis], p[axis] - box.hi[axis]});
    return most;
}

/// A number from 0 to 1 that is the same for the same place in the grid of lines.
double jitter(uint32_t a, uint32_t b, uint32_t c) {
    uint32_t hash = a * 0x9e3779b1u ^ b * 0x85ebca77u ^ c * 0xc2b2ae3du;
    hash = (hash ^ hash >> 16) * 0x7feb352du;
    hash = (hash ^ hash >> 15) * 0x846ca68bu;
    return double(hash ^ hash >> 16) / 4294967296.0;
}

/// Looks along one line after another for places where the field changes its sign.
class Lines {
  public:
    explicit Lines(double shortest) : least(shortest) {}

    std::vector<Point> found;

    double work() const { return double(machine.intervalSteps()) * kStepOnInterval + stepsAtPoints; }

    /// The tape for lines within the box.
    Tape within(const Box& box, const Tape& tape) {
        machine.interval(tape, box);
        return machine.shortens() ? machine.shortenedForSigns(tape) : tape;
    }
    /// Looks at the line, which extends along one axis alone.
    void look(int along, const Box& line, const Tape& tape) {
        intervals = 0;
        halve(along, line, tape);
    }

  private:
    void halve(int along, const Box& piece, const Tape& tape) {
        if (++intervals > kMostIntervals) return sample(along, piece, tape);
        const Interval f = machine.interval(tape, piece);
        if (f.lo >= 0.0 || f.hi < 0.0) return;
        const auto axis = std::size_t(along);
        if (piece.hi[axis] - piece.lo[axis] <= least) return close(along, piece, tape);
        const Tape shorter = machine.shortens() ? machine.shortenedForSigns(tape) : Tape();
        const bool worth =
            machine.shortens() && double(shorter.steps.size()) < kWorthKeeping * double(tape.steps.size());
        const double middle = 0.5 * (piece.lo[axis] + piece.hi[axis]);
        Box half = piece;
        half.hi[axis] = middle;
        halve(along, half, worth ? shorter : tape);
        half = piece;
        half.lo[axis] = middle;
        halve(along, half, worth ? shorter : tape);
    }

    static constexpr int kCount = int(TapeMachine<double>::kPoints);
    /// The values at that many points of the piece, its ends among them.
    const double* valuesAlong(int along, const Box& piece, const Tape& tape) {
        const auto axis = std::size_t(along);
        const double from = piece.lo[axis], step = (piece.hi[axis] - from) / (kCount - 1);
        for (int i = 0; i < kCount; ++i)
            for (int a = 0; a < 3; ++a)
                machine.position(a)[i] = a == along ? from + step * i : piece.lo[std::size_t(a)];
        stepsAtPoints += double(tape.steps.size()) * kCount;
        return machine.value(tape, std::size_t(kCount));
    }

    /// In place of halving: closes in on the least pieces at whose ends the signs differ.
    void sample(int along, const Box& piece, const Tape& tape) {
        const auto axis = std::size_t(along);
        const double length = piece.hi[axis] - piece.lo[axis];
        const int batches = std::max(1, int(std::ceil(length / (least * (kCount - 1)))));
        for (int batch = 0; batch < batches; ++batch) {
            Box some = piece;
            some.lo[axis] = piece.lo[axis] + length * batch / batches;
            some.hi[axis] = piece.lo[axis] + length * (batch + 1) / batches;
            bool inside[kCount];
            const double* values = valuesAlong(along, some, tape);
            for (int i = 0; i < kCount; ++i) inside[i] = values[i] < 0.0;
            const double step = (some.hi[axis] - some.lo[axis]) / (kCount - 1);
            for (int i = 0; i + 1 < kCount; ++i) {
                if (inside[i] == inside[i + 1]) continue;
                Box between = some;
                between.lo[axis] = some.lo[axis] + step * i;
                between.hi[axis] = some.lo[axis] + step * (i + 1);
                close(along, between, tape);
            }
        }
    }

    /// Twice a batch of points within the piece: then the root is known to 1e-4 of its length.
    void close(int along, Box piece, const Tape& tape) {
        const auto axis = std::size_t(along);
        for (int round = 0; round < 2; ++round) {
            const double from = piece.lo[axis], step = (piece.hi[axis] - from) / (kCount - 1);
            const double* values = valuesAlong(along, piece, tape);
            int at = 0;
            while (at + 1 < kCount && (values[at] < 0.0) == (values[at + 1] < 0.0)) ++at;
            if (at + 1 == kCount) return;
            piece.lo[axis] = from + step * at;
            piece.hi[axis] = from + step * (at + 1);
        }
        Point root = piece.lo;
        root[axis] = 0.5 * (piece.lo[axis] + piece.hi[axis]);
        found.push_back(root);
    }

    TapeMachine<double> machine;
    double least;
    std::size_t intervals = 0;  ///< of this line
    double stepsAtPoints = 0;
};

struct Found {
    std::vector<Point> points;
    double work = 0;
};

/// Looks along some `lines` lines of the region.
Found lookAlong(const Tape& tape, const Box& region, int lines) {
    double size[3], longest = 0.0, faces = 0.0;
    for (std::size_t a = 0; a < 3; ++a) longest = std::max(longest, size[a] = region.hi[a] - region.lo[a]);
    for (std::size_t a = 0; a < 3; ++a) faces += size[(a + 1) % 3] * size[(a + 2) % 3];
    const double spacing = std::sqrt(faces / std::max(lines, 1));
    struct Row {
        int along;
        uint32_t number;
    };
    std::vector<Row> rows;
    const auto across = [&](std::size_t axis) {
        return uint32_t(std::max(1.0, std::round(size[axis] / spacing)));
    };
    for (int along = 0; along < 3; ++along)
        for (uint32_t i = 0; i < across(std::size_t(along + 1) % 3); ++i) rows.push_back({along, i});

    std::vector<Found> parts(rows.size());
    forBlocks(rows.size(), 1, [&](std::size_t, std::size_t at, std::size_t) {
        const auto [along, i] = rows[at];
        const std::size_t a = std::size_t(along), b = (a + 1) % 3, c = (a + 2) % 3;
        Lines looking(longest / kLeastPieces);
        Box slab = region;  // that the row's lines are in, and then some of them
        slab.lo[b] = region.lo[b] + size[b] * i / across(b);
        slab.hi[b] = region.lo[b] + size[b] * (i + 1) / across(b);
        const Tape ofRow = looking.within(slab, tape);
        Tape ofSome;
        for (uint32_t j = 0; j < across(c); ++j) {
            if (j % kTogether == 0) {
                slab.lo[c] = region.lo[c] + size[c] * j / across(c);
                slab.hi[c] = region.lo[c] + size[c] * (j + kTogether) / across(c);
                ofSome = looking.within(slab, ofRow);
            }
            Box line = region;
            const uint32_t place = uint32_t(along) << 30;
            line.lo[b] = line.hi[b] = region.lo[b] + size[b] * (i + jitter(i, j, place)) / across(b);
            line.lo[c] = line.hi[c] = region.lo[c] + size[c] * (j + jitter(i, j, place + 1)) / across(c);
            looking.look(along, line, ofSome);
        }
        parts[at] = {std::move(looking.found), looking.work()};
    });
    Found all;
    for (const Found& part : parts) {
        all.points.insert(all.points.end(), part.points.begin(), part.points.end());
        all.work += part.work;
    }
    return all;
}

}  // namespace

std::vector<SurfacePoint> surfacePoints(const Program& program, const Box& region, int lines, Points asked) {
    const Tape tape = makeTape(program.ir, program.distance(), program.parameters());
    Found found;
    if (asked == Points::affordable && lines > kFirstLines) {
        found = lookAlong(tape, region, kFirstLines);
        lines = int(std::min(kFirstLines * kMostWork / std::max(found.work, 1.0), double(lines)));
    }
    if (asked == Points::all || lines > kFirstLines) found = lookAlong(tape, region, lines);
    const std::vector<Point>& points = found.points;
    std::vector<ValueGradient> fields(points.size());
    constexpr std::size_t kPoints = 4096;
    forBlocks(points.size(), kPoints, [&](std::size_t, std::size_t first, std::size_t last) {
        TapeMachine<double> machine;
        evaluateGradient(machine, tape, std::span(points).subspan(first, last - first),
                         std::span(fields).subspan(first, last - first));
    });
    std::vector<SurfacePoint> surface;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Point& g = fields[i].gradient;
        const double length = std::hypot(g[0], g[1], g[2]),
                     sum = std::abs(g[0]) + std::abs(g[1]) + std::abs(g[2]);
        surface.push_back({{points[i][0], points[i][1], points[i][2]},
                           sum > 0.0 && std::isfinite(length) ? length / sum : 1.0});
    }
    return surface;
}

MeasureOptions measureOf(const Program& program, const Box& region, Points wanted) {
    MeasureOptions measure;
    if (!program.exactness.exact())
        measure.errorNote = "left out: the field is no distance since node " + inQuotes(program.spoiledBy) +
                            "; meshToSurfaceMax is one";
    if (const double constant = lipschitzWithin(program, region); std::isfinite(constant))
        measure.lipschitz = constant;
    const Tape tape = makeTape(program.ir, program.distance(), program.parameters());
    const auto at = [tape](std::span<const Point> positions) {
        std::vector<ValueGradient> results(positions.size());
        TapeMachine<double> machine;
        evaluateGradient(machine, tape, positions, results);
        return results;
    };
    measure.error = [at, region](std::span<const glm::dvec3> points, std::span<double> errors) {
        const std::vector<Point> positions = positionsOf(points);
        const std::vector<ValueGradient> results = at(positions);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Point& g = results[i].gradient;
            const double slope = std::hypot(g[0], g[1], g[2]);
            errors[i] = std::abs(results[i].value) / (slope > 1e-12 ? slope : 1.0);
            if (results[i].value < 0.0)
                errors[i] = std::min(errors[i], std::abs(beyond(region, positions[i])));
        }
    };
    measure.distance = [at, region, error = measure.error](std::span<const glm::dvec3> points,
                                                           std::span<double> distances) {
        error(points, distances);  // where Newton's steps lead nowhere
        const std::vector<Point> starts = positionsOf(points);
        std::vector<Point> positions = starts;
        std::vector<double> left(points.size());
        std::vector<bool> inside(points.size());
        const auto gone = [&](std::size_t i) {
            return std::hypot(positions[i][0] - starts[i][0], positions[i][1] - starts[i][1],
                              positions[i][2] - starts[i][2]);
        };
        std::vector<std::size_t> open(points.size());  // those that are not there yet
        std::iota(open.begin(), open.end(), std::size_t{0});
        for (int step = 0; step <= kNewtonSteps && !open.empty(); ++step) {
            std::vector<Point> asked;
            for (const std::size_t i : open) asked.push_back(positions[i]);
            const std::vector<ValueGradient> results = at(asked);
            std::vector<std::size_t> still;
            for (std::size_t k = 0; k < open.size(); ++k) {
                const std::size_t i = open[k];
                const auto& [value, g] = results[k];
                if (step == 0) inside[i] = value < 0.0;
                const double squared = g[0] * g[0] + g[1] * g[1] + g[2] * g[2];
                left[i] = squared > 1e-24 ? std::abs(value) / std::sqrt(squared) : INFINITY;
                if (!std::isfinite(left[i]) || left[i] <= kNear * gone(i)) continue;
                if (step == kNewtonSteps) continue;
                for (std::size_t a = 0; a < 3; ++a) positions[i][a] -= value * g[a] / squared;
                still.push_back(i);
            }
            open = std::move(still);
        }
        for (std::size_t i = 0; i < points.size(); ++i) {
            const double way = gone(i);
            if (left[i] > 1e-3 * way + 1e-9) continue;
            distances[i] = way + left[i];
            if (inside[i]) distances[i] = std::min(distances[i], std::abs(beyond(region, starts[i])));
        }
    };
    const double work = kStepsToSurface * double(tape.steps.size() + 1);
    if (wanted == Points::affordable)
        measure.samples = std::min(measure.samples, std::size_t(kMostWork / work) + 1);
    measure.surface = surfacePoints(program, region, kLines, wanted);
    return measure;
}

}  // namespace fw
