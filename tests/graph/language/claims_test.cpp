// The claim of every node about its field (Exactness), tested by brute force in double precision on random
// parameters and random input surfaces.
//
// Lipschitz constant: slopes between pairs of points at all distances. Each segment is cut into parts and its
// steepest part is bisected, always into the steeper half, which closes in on a jump. Points with a steep
// gradient are moved uphill. Exactness: within |f| (1 - eps) of a point the field does not change its sign,
// and within |f| (1 + eps) it does, or reaches 0.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <sstream>

#include "graph/compile/compile.h"
#include "graph/document/json.h"
#include "graph/evaluate/evaluate.h"
#include "graph/library/node_type.h"
#include "graph/library/reference.h"
#include "tests/support/graph/claim_graph.h"
#include "tests/support/graph/picture_file.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::claims_test {

bool isLong() { return std::getenv("FIELDWRIGHT_LONG") != nullptr; }

using Random = std::mt19937_64;

double uniform(Random& random, double lo, double hi) {
    return std::uniform_real_distribution(lo, hi)(random);
}
Point along(const Point& from, const Point& direction, double t) {
    return {from[0] + t * direction[0], from[1] + t * direction[1], from[2] + t * direction[2]};
}
double distanceOf(const Point& a, const Point& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}
Point unitVector(Random& random) {
    std::normal_distribution<double> normal;
    const Point v{normal(random), normal(random), normal(random)};
    return along({0, 0, 0}, v, 1 / std::max(std::hypot(v[0], v[1], v[2]), 1e-30));
}
Point normalized(const Point& v) {
    const double size = std::hypot(v[0], v[1], v[2]);
    return size > 0 ? along({0, 0, 0}, v, 1 / size) : Point{1, 0, 0};
}

/// The field of a program, and the cube in which it is sampled.
struct Sampled {
    const Program& program;
    Point centre{};
    double size = 2.5;
    double jump = 0;  ///< by which values may jump where the claim does not say so; see gridJump()

    std::vector<double> at(const std::vector<Point>& points) const {
        std::vector<double> values(points.size());
        evaluate(program.ir, program.distance(), program.parameters(), points, values);
        return values;
    }
    std::vector<ValueGradient> gradients(const std::vector<Point>& points) const {
        std::vector<ValueGradient> values(points.size());
        evaluateGradient(program.ir, program.distance(), program.parameters(), points, values);
        return values;
    }
    /// Most often near the solid.
    Point point(Random& random) const {
        const double extent = uniform(random, 0, 1) < 0.75 ? size : 4 * size;
        return {centre[0] + uniform(random, -extent, extent), centre[1] + uniform(random, -extent, extent),
                centre[2] + uniform(random, -extent, extent)};
    }
};

/// Values that were measured on a grid may rise where the grid ends, for beyond it they are at least the
/// distance to the solid's box, of which values between samples fall short: by 0.008 cells at most in 36
/// fields. That is not in what these fields claim.
double gridJump(const Program& program) {
    double cell = 0;
    for (const FieldVolumePtr& volume : program.ir.volumes()) cell = std::max(cell, volume->grid.cell);
    return 0.02 * cell;
}

Sampled sampled(const Program& program) {
    Sampled field{.program = program, .jump = gridJump(program)};
    const Region region = findRegion(program);
    if (region.extent != Extent::bounded || longestSide(region.box) <= 0) return field;
    for (std::size_t axis = 0; axis < 3; ++axis)
        field.centre[axis] = 0.5 * (region.box.lo[axis] + region.box.hi[axis]);
    field.size = 0.75 * longestSide(region.box);
    return field;
}

/// The worst of what contradicts a claim.
struct Breach {
    double excess = 0;  ///< relative
    std::string what;

    void note(double by, const std::string& text) {
        if (by > excess) excess = by, what = text;
    }
};
std::string text(const Point& p) {
    std::ostringstream out;
    out.precision(17);
    out << "(" << p[0] << ", " << p[1] << ", " << p[2] << ")";
    return out.str();
}

constexpr double kSlack = 1e-9;  // rounding error of values, relative to the sampled cube

/// Notes the pair if its slope is above `lipschitz`.
void notePair(Breach& breach, const Sampled& field, double lipschitz, const Point& a, const Point& b,
              double atA, double atB) {
    const double apart = distanceOf(a, b), by = std::abs(atA - atB);
    const double slack =
        field.jump + kSlack * std::max({field.size, std::abs(atA), std::abs(atB)}) + 1e-6 * lipschitz * apart;
    if (!(by > lipschitz * apart + slack)) return;
    breach.note(by / (lipschitz * apart) - 1, "slope " + std::to_string(by / apart) + ": " +
                                                  std::to_string(atA) + " at " + text(a) + ", " +
                                                  std::to_string(atB) + " at " + text(b));
}

void testSegments(Breach& breach, const Sampled& field, double lipschitz, int count, Random& random) {
    constexpr int kParts = 12, kHalvings = 18;
    std::vector<Point> from, to, cuts;
    for (int i = 0; i < count; ++i) {
        from.push_back(field.point(random));
        // Copies jump across planes along the axes most often.
        const Point way = i % 3 == 0 ? Point{double(i % 9 == 0), double(i % 9 == 3), double(i % 9 == 6)}
                                     : unitVector(random);
        const double length = i % 2 == 0 ? field.size * uniform(random, 0.2, 3)
                                         : field.size * std::pow(10, uniform(random, -6, 0));
        to.push_back(along(from.back(), way, length));
        for (int k = 0; k <= kParts; ++k) cuts.push_back(along(from.back(), way, length * k / kParts));
    }
    std::vector<double> values = field.at(cuts), atFrom(from.size()), atTo(from.size());
    for (std::size_t i = 0; i < from.size(); ++i) {
        const std::size_t first = i * (kParts + 1);
        notePair(breach, field, lipschitz, from[i], to[i], values[first], values[first + kParts]);
        std::size_t steepest = first;
        for (std::size_t k = first; k < first + kParts; ++k)
            if (std::abs(values[k + 1] - values[k]) > std::abs(values[steepest + 1] - values[steepest]))
                steepest = k;
        from[i] = cuts[steepest], to[i] = cuts[steepest + 1];
        atFrom[i] = values[steepest], atTo[i] = values[steepest + 1];
    }
    for (int step = 0; step < kHalvings; ++step) {
        std::vector<Point> middles;
        for (std::size_t i = 0; i < from.size(); ++i)
            middles.push_back(along(from[i], along(to[i], from[i], -1), 0.5));
        values = field.at(middles);
        for (std::size_t i = 0; i < from.size(); ++i) {
            notePair(breach, field, lipschitz, from[i], to[i], atFrom[i], atTo[i]);
            if (std::abs(values[i] - atFrom[i]) > std::abs(atTo[i] - values[i]))
                to[i] = middles[i], atTo[i] = values[i];
            else
                from[i] = middles[i], atFrom[i] = values[i];
        }
    }
}

void testGradients(Breach& breach, const Sampled& field, double lipschitz, int count, Random& random) {
    std::vector<Point> points;
    for (int i = 0; i < count; ++i) points.push_back(field.point(random));
    double step = 0.1 * field.size;
    for (int round = 0; round < 6; ++round, step *= 0.4) {
        const std::vector<ValueGradient> at = field.gradients(points);
        const auto slope = [&](std::size_t i) {
            return std::hypot(at[i].gradient[0], at[i].gradient[1], at[i].gradient[2]);
        };
        std::vector<Point> ends;
        for (std::size_t i = 0; i < points.size(); ++i)
            for (const double t : {-1e-5, 1e-5})
                ends.push_back(along(points[i], normalized(at[i].gradient), t * field.size));
        const std::vector<double> values = field.at(ends);
        for (std::size_t i = 0; i < points.size(); ++i)
            notePair(breach, field, lipschitz, ends[2 * i], ends[2 * i + 1], values[2 * i],
                     values[2 * i + 1]);
        std::vector<std::size_t> order(points.size());
        for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
        const std::size_t kept = std::max<std::size_t>(points.size() / 4, 1);
        std::ranges::nth_element(order, order.begin() + std::ptrdiff_t(kept) - 1,
                                 [&](std::size_t a, std::size_t b) { return slope(a) > slope(b); });
        std::vector<Point> next;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Point& parent = points[order[i % kept]];
            next.push_back(i < kept ? parent : along(parent, unitVector(random), step));
        }
        points = std::move(next);
    }
}

/// `sign`: 1 tests the outside, -1 the inside.
void testExact(Breach& breach, const Sampled& field, double sign, int count, Random& random) {
    constexpr double kEps = 1e-3;
    constexpr int kDirections = 24, kRounds = 14;
    std::vector<Point> points;
    for (int i = 0; i < 6 * count; ++i) points.push_back(field.point(random));
    const std::vector<ValueGradient> at = field.gradients(points);
    int tested = 0;
    for (std::size_t i = 0; i < points.size() && tested < count; ++i) {
        const double radius = sign * at[i].value;
        if (!(radius > 1e-4 * field.size) || radius > 1e6) continue;
        ++tested;
        const double slack = kSlack * std::max(field.size, radius);
        std::vector<Point> ways = {along({0, 0, 0}, normalized(at[i].gradient), -sign)}, ends;
        while (int(ways.size()) < kDirections) ways.push_back(unitVector(random));
        for (const Point& way : ways) {
            ends.push_back(along(points[i], way, radius * (1 - kEps)));
            ends.push_back(along(points[i], way, radius * (1 - kEps) * uniform(random, 0, 1)));
        }
        for (std::size_t k = 0; const double value : field.at(ends)) {
            if (sign * value < -slack)
                breach.note(1 - distanceOf(points[i], ends[k]) / radius + kEps,
                            "value " + std::to_string(at[i].value) + " at " + text(points[i]) +
                                ", but the other side is " + std::to_string(distanceOf(points[i], ends[k])) +
                                " away, at " + text(ends[k]));
            ++k;
        }
        // The least value on the sphere, first along the gradient, then by a search around the best
        // direction.
        const auto leastOf = [&](const std::vector<Point>& all, Point& best) {
            std::vector<Point> places;
            for (const Point& way : all) places.push_back(along(points[i], way, radius * (1 + kEps)));
            double least = 1e300;
            for (std::size_t k = 0; const double value : field.at(places)) {
                if (sign * value < least) least = sign * value, best = all[k];
                ++k;
            }
            return least;
        };
        const double enough = 2 * kEps * radius + slack;
        Point best{};
        double least = leastOf({ways[0]}, best);
        if (least > enough) least = leastOf(ways, best);
        double spread = 0.7;
        for (int round = 0; round < kRounds && least > enough; ++round, spread *= 0.7) {
            std::vector<Point> around = {best};
            while (around.size() < 12) around.push_back(normalized(along(best, unitVector(random), spread)));
            least = leastOf(around, best);
        }
        if (least > enough)
            breach.note(least / radius, "value " + std::to_string(at[i].value) + " at " + text(points[i]) +
                                            ", but the field is at least " + std::to_string(least) +
                                            " that far away");
    }
}

class EveryClaim : public testing::TestWithParam<std::string> {};

TEST_P(EveryClaim, Holds) {
    const NodeType& type = *findNodeType(GetParam());
    const test::TempDir folder;
    const test::ClaimFiles files{folder.path("g.field.json"), "picture.png", "mesh.obj"};
    Random random{20241128};
    std::vector<uint8_t> rgb(3 * 6 * 5);
    for (uint8_t& channel : rgb) channel = uint8_t(random());
    test::writePictureFile(folder.path(files.picture), 6, 5, rgb);
    test::writeText(folder.path(files.mesh),
                    "v 0 0 0\nv 1 0.1 0\nv 0.1 0.9 0.2\nv 0.2 0.1 1.1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
    std::size_t options = 1;
    for (const InputSpec& input : type.inputs) options = std::max(options, input.options.size());
    // A grid is slow to measure, and an outline of many edges slow to sample.
    const bool isSlow = type.body.empty() || type.id == "text" || type.id.ends_with("_file");
    const int graphs = (isLong() ? 12 : 1) * (isSlow ? 3 : std::max(8, std::min(13, int(options))));
    const int effort = isLong() ? 2 : 1;
    Breach slope, outside, inside;
    int claims = 0;
    for (int i = 0; i < graphs; ++i) {
        const Graph graph = test::claimGraph(type, uint32_t(random()), i, files);
        const Result<Program> program = compile(graph);
        if (!program) continue;  // of nothing, for example
        const Exactness claim = program->nodeExactness.at("tested").exactness;
        if (!std::isfinite(claim.lipschitz) && !claim.outside && !claim.inside) continue;
        ++claims;
        const Sampled field = sampled(*program);
        const std::string where = ", claimed " + exactnessText(claim) + ", of\n" + writeGraph(graph);
        const auto noteIn = [&](Breach& worst, const Breach& found) {
            worst.note(found.excess, found.what + where);
        };
        Breach found;
        if (std::isfinite(claim.lipschitz)) {
            testSegments(found, field, claim.lipschitz, 130 * effort, random);
            testGradients(found, field, claim.lipschitz, 100 * effort, random);
            noteIn(slope, found);
        }
        for (const double sign : {1.0, -1.0}) {
            if (!(sign > 0 ? claim.outside : claim.inside)) continue;
            Breach side;
            testExact(side, field, sign, 20 * effort, random);
            noteIn(sign > 0 ? outside : inside, side);
        }
    }
    RecordProperty("claims", claims);
    EXPECT_EQ(slope.excess, 0) << "too steep by this share: " << slope.what;
    EXPECT_EQ(outside.excess, 0) << "not exact outside: " << outside.what;
    EXPECT_EQ(inside.excess, 0) << "not exact inside: " << inside.what;
}

std::vector<std::string> nodesWithAClaim() {
    std::vector<std::string> ids;
    for (const NodeType& type : nodeTypes())
        if (test::hasClaimGraph(type)) ids.push_back(type.id);
    return ids;
}

INSTANTIATE_TEST_SUITE_P(Nodes, EveryClaim, testing::ValuesIn(nodesWithAClaim()),
                         [](const auto& test) { return test.param; });

}  // namespace fw::claims_test
