// Random everyday scenes, judged by brute force: the claims of the program about a field and its solid must
// agree with samples of the field.
//
// FIELDWRIGHT_LONG=1 tests 2,000 scenes on finer grids. FIELDWRIGHT_SCENE_SEED=N tests only scene N, and
// prints its JSON and measures.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <optional>

#include "graph/base/parallel.h"
#include "graph/check/check.h"
#include "graph/compile/compile.h"
#include "graph/compile/solid_query.h"
#include "graph/document/json.h"
#include "tests/support/graph/brute_force_solid.h"
#include "tests/support/graph/everyday_scene.h"
#include "tests/support/graph/expression_graph.h"
#include "tests/support/graph/solid_bounds.h"

namespace fw::everyday_scenes_test {

using test::BruteForceSolid;
using test::EverydayScene;
using test::NearestSurface;
using test::ReferenceField;

constexpr std::size_t kMaxPrinted = 3;  ///< scenes of each kind of failure
/// Scenes whose bounds the search may fail to prove, or find looser in one unit than in another. The aim is
/// 1 %.
constexpr std::size_t kMaxRefusedPercent = 6;
constexpr double kRounding = 1e-9;  ///< relative to the size of the scene

bool isLong() { return std::getenv("FIELDWRIGHT_LONG") != nullptr; }

enum class Fault {
    invalid,         ///< does not parse, check or compile
    refused,         ///< the region search proves no bounds
    lost,            ///< the solid leaves its region
    wronglyEmpty,    ///< called empty, but is not
    boundsTooSmall,  ///< solidBounds() does not contain the solid
    overestimated,   ///< a value exceeds what the Lipschitz constant allows
    notExact,        ///< a value is smaller than the distance, though it is declared exact
    unitMatters,     ///< the same scene in another unit is another field
    looserInUnit,    ///< the region of the same scene in another unit has a different size
};

const char* nameOf(Fault fault) {
    switch (fault) {
        case Fault::invalid: return "does not parse, check or compile";
        case Fault::refused: return "is refused by the region search";
        case Fault::lost: return "leaves its region";
        case Fault::wronglyEmpty: return "is called empty, but is not";
        case Fault::boundsTooSmall: return "leaves the bounds of solidBounds()";
        case Fault::overestimated: return "overestimates the distance";
        case Fault::notExact: return "is declared exact, but underestimates the distance";
        case Fault::unitMatters: return "is another field in another unit";
        case Fault::looserInUnit: return "has a region whose size depends on the unit";
    }
    return "";
}

struct Finding {
    Fault fault;
    std::string detail;
};

struct Judgement {
    std::vector<Finding> findings;
    std::optional<BruteForceSolid> solid;
    std::size_t bounds = 0, exact = 0;  ///< fields that are declared so, exact outside or inside
    double evaluations = 0.0;

    void add(Fault fault, const std::string& detail) {
        for (const Finding& finding : findings)
            if (finding.fault == fault) return;
        findings.push_back({fault, detail});
    }
};

std::string number(double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%.9g", value);
    return text;
}
std::string text(const Point& p) {
    return "(" + number(p[0]) + ", " + number(p[1]) + ", " + number(p[2]) + ")";
}
std::string text(const Box& box) { return text(box.lo) + " to " + text(box.hi); }

Point randomPoint(test::SceneRandom& random, const Box& box) {
    Point point;
    for (std::size_t axis = 0; axis < 3; ++axis) point[axis] = random.between(box.lo[axis], box.hi[axis]);
    return point;
}

double sizeOf(const Box& box) {
    double size = longestSide(box);
    for (std::size_t axis = 0; axis < 3; ++axis)
        size = std::max({size, std::abs(box.lo[axis]), std::abs(box.hi[axis])});
    return size;
}

/// How far `inner` leaves `outer`; negative if it does not.
double excess(const Box& outer, const Box& inner) {
    return std::max(test::distanceOutside(outer, inner.lo), test::distanceOutside(outer, inner.hi));
}

Result<Graph> graphOf(const EverydayScene& scene, Judgement& judgement) {
    std::vector<Error> warnings;
    Result<Graph> graph = parseGraph(scene.json, "scene " + std::to_string(scene.seed), &warnings);
    if (!graph) judgement.add(Fault::invalid, format(graph.error()));
    if (!graph) return graph;
    for (const Error& warning : warnings) judgement.add(Fault::invalid, format(warning));
    for (const Error& finding : check(*graph))
        if (finding.severity == Error::Severity::error) judgement.add(Fault::invalid, format(finding));
    return graph;
}

/// Samples the solid. The grid grows until the solid is within it, in case that the estimates are too small.
BruteForceSolid sampled(const ReferenceField& field, const EverydayScene& scene, int cells) {
    Box box = boxAround(scene);
    for (int growth = 0;; ++growth) {
        BruteForceSolid solid = sampleByBruteForce(field, test::gridOver(box, cells), scene.seed);
        if (!solid.touchesGrid || growth == 2) return solid;
        const Point centre = centreOf(box);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            box.lo[axis] = centre[axis] + 1.6 * (box.lo[axis] - centre[axis]);
            box.hi[axis] = centre[axis] + 1.6 * (box.hi[axis] - centre[axis]);
        }
    }
}

/// `isThorough`: also judges solidBounds(), which searches once more.
void judgeRegion(const Program& program, const Region& region, bool isThorough, Judgement& judgement) {
    const BruteForceSolid& solid = *judgement.solid;
    if (region.extent == Extent::empty) {
        if (solid.bounds) judgement.add(Fault::wronglyEmpty, "solid in " + text(*solid.bounds));
        return;
    }
    if (region.extent != Extent::bounded) {
        judgement.add(Fault::refused, region.extent == Extent::unbounded ? "unbounded" : "unproven");
        return;
    }
    if (!solid.bounds) return;
    const double slack = kRounding * sizeOf(region.box);
    if (excess(region.box, *solid.bounds) > slack)
        judgement.add(Fault::lost, "solid in " + text(*solid.bounds) + ", region " + text(region.box));
    if (!isThorough) return;
    const Box bounds = solidBounds(program.ir, program.distance(), program.parameters());
    if (excess(bounds, *solid.bounds) > slack)
        judgement.add(Fault::boundsTooSmall, "solid in " + text(*solid.bounds) + ", bounds " + text(bounds));
}

/// The error of a field that was measured on a grid. Outside of the grid its value is the distance to the
/// grid's box, and the values between samples can fall short of that.
double gridError(const Program& program) {
    double cell = 0.0;
    for (const FieldVolumePtr& volume : program.ir.volumes()) cell = std::max(cell, volume->grid.cell);
    return 0.02 * cell;
}

/// `node` is the one that the program shows.
void judgeDistances(const Program& program, const ReferenceField& field, const BruteForceSolid& solid,
                    int points, const std::string& node, Judgement& judgement, uint32_t seed) {
    if (solid.signChanges.empty()) return;
    const Exactness& declared = program.exactness;
    judgement.bounds += declared.bound();
    judgement.exact += declared.outside || declared.inside;
    const Box box = solid.grid.box();
    const double proven = lipschitzWithin(program, box, kQuickSteps);
    const bool isClaim = std::isfinite(declared.lipschitz) || declared.outside || declared.inside;
    if (!isClaim && !std::isfinite(proven)) return;
    const double slack = gridError(program) + kRounding * sizeOf(box);
    // The search for the nearest surface ends far within its proven error. For an exact field it also tries
    // the point that the value and the slope promise.
    const double searchError = 0.25 * solid.grid.step;
    test::SceneRandom random(seed);
    for (int i = 0; i < points; ++i) {
        // Half of the points are near the surface.
        Point point = randomPoint(random, box);
        if (i % 2) {
            const auto& change = solid.signChanges[std::size_t(random.below(int(solid.signChanges.size())))];
            point = solid.grid.centre(change.inside);
            for (double& x : point) x += 3.0 * solid.grid.step * random.between(-1, 1);
        }
        const double value = field(point);
        const NearestSurface nearest = nearestSurface(field, solid, point, seed + uint32_t(i));
        const std::string where = node + ": value " + number(value) + " at " + text(point) + ", surface at " +
                                  text(nearest.at) + " at a distance of " + number(nearest.distance);
        // The proven constant holds in the box, which contains the segment to the surface point only if it
        // contains the point.
        const bool isInBox = test::distanceOutside(box, point) <= 0.0;
        for (const double lipschitz : {declared.lipschitz, isInBox ? proven : INFINITY})
            if (std::abs(value) > lipschitz * (nearest.distance + nearest.rounding) + slack)
                judgement.add(Fault::overestimated, where + ", Lipschitz constant " + number(lipschitz));
        const bool isExact = value > 0.0 ? declared.outside : declared.inside;
        if (isExact && std::abs(value) < nearest.distance - searchError - slack)
            judgement.add(Fault::notExact, where);
    }
}

/// Compares the scene in this unit with the same in another.
void judgeUnit(const EverydayScene& scene, const Program& first, const ReferenceField& field,
               const Region& region, Judgement& judgement) {
    // Beyond a corner of a straight spline two segments are equally near, and rounding decides which of them
    // a sweep takes. Their values differ there, which is a fault of the sweep.
    const bool sweepsAroundCorners = scene.json.find("\"type\": \"sweep\"") != std::string::npos &&
                                     scene.json.find("\"straight\"") != std::string::npos;
    if (sweepsAroundCorners) return;
    const std::string unit =
        scene.unit == "m" ? std::vector<std::string>{"mm", "cm", "in"}[scene.seed % 3] : "m";
    const EverydayScene other = test::everydayScene(scene.seed, unit);
    Judgement ofOther;
    const Result<Graph> graph = graphOf(other, ofOther);
    const Result<Program> program = graph ? compile(*graph) : Result<Program>(graph.error());
    if (!program) {
        judgement.add(Fault::unitMatters,
                      "compiles in " + scene.unit + ", but not in " + unit + ": " + format(program.error()));
        return;
    }
    const double scale = other.perMetre / scene.perMetre;
    const ReferenceField otherField(*program);
    const Box box = judgement.solid->grid.box();
    // Shapes round their parameters to seven decimals, in the unit of each document.
    double tolerance = 1e-5 * std::max(sizeOf(box), scene.perMetre);
    // The region search stops at lengths that depend on the unit, so measured grids are placed differently.
    for (const FieldVolumePtr& volume : first.ir.volumes())
        tolerance = std::max(tolerance, 0.5 * volume->grid.cell);
    test::SceneRandom random(scene.seed);
    for (int i = 0; i < 200; ++i) {
        const Point point = randomPoint(random, box);
        const double value = field(point);
        const double otherValue = otherField({scale * point[0], scale * point[1], scale * point[2]}) / scale;
        if (std::abs(value - otherValue) <= tolerance * std::max(1.0, std::abs(value) / sizeOf(box)))
            continue;
        judgement.add(Fault::unitMatters,
                      number(value) + " at " + text(point) + ", but " + number(otherValue) + " in " + unit);
        return;
    }
    const Region otherRegion = findRegion(*program);
    if (otherRegion.extent != region.extent) {
        judgement.add(Fault::unitMatters, "the region in " + unit + " has another extent");
        return;
    }
    if (region.extent != Extent::bounded) return;
    Box scaled = otherRegion.box;
    for (std::size_t axis = 0; axis < 3; ++axis) scaled.lo[axis] /= scale, scaled.hi[axis] /= scale;
    const double most = 0.05 * longestSide(region.box);
    if (excess(region.box, scaled) > most || excess(scaled, region.box) > most)
        judgement.add(Fault::looserInUnit,
                      "the region is " + text(region.box) + ", but " + text(scaled) + " in " + unit);
}

/// Judges the last nodes of the graph that are declared exact and that are declared a bound.
void judgeParts(const Graph& graph, const Program& whole, int points, Judgement& judgement, uint32_t seed) {
    const Node* lastExact = nullptr;
    const Node* lastBound = nullptr;
    for (const Node& node : graph.nodes) {
        const auto found = whole.nodeExactness.find(node.id);
        if (found == whole.nodeExactness.end() || node.type == "output") continue;
        const Exactness& declared = found->second.exactness;
        const bool isExact = declared.outside || declared.inside;
        if (isExact) lastExact = &node;
        if (!isExact && declared.bound()) lastBound = &node;
    }
    for (const Node* node : {lastExact, lastBound}) {
        if (!node) continue;
        Graph part = graph;
        part.node("out")->set("surface", {Link{node->id, ""}});
        const Result<Program> program = compile(part);
        if (!program) {
            judgement.add(Fault::invalid, format(program.error()));
            continue;
        }
        const Region region = findRegion(*program);
        if (region.extent != Extent::bounded) continue;
        const ReferenceField field(*program);
        const test::SampleGrid grid = test::gridOver(padded(region.box, 32, 8.0), 32);
        const BruteForceSolid solid = sampleByBruteForce(field, grid, seed);
        judgeDistances(*program, field, solid, points, "node '" + node->id + "'", judgement, seed);
    }
}

Judgement judge(uint32_t seed) {
    const EverydayScene scene = test::everydayScene(seed);
    Judgement judgement;
    const Result<Graph> graph = graphOf(scene, judgement);
    if (!graph) return judgement;
    const Result<Program> program = compile(*graph);
    if (!program) {
        // A node that measures distances needs a region, and does not compile where that is refused.
        const bool isRefused = judgement.findings.empty();
        judgement.add(isRefused ? Fault::refused : Fault::invalid, format(program.error()));
        return judgement;
    }
    const ReferenceField field(*program);
    judgement.solid = sampled(field, scene, isLong() ? 64 : 34);
    judgement.evaluations = double(field.operations()) * double(judgement.solid->grid.size());
    const Region region = findRegion(*program);
    const bool isThorough = isLong() || seed % 4 == 0;
    judgeRegion(*program, region, isThorough, judgement);
    const int points = isLong() ? 40 : 16;
    judgeDistances(*program, field, *judgement.solid, points, "output", judgement, seed);
    judgeParts(*graph, *program, points, judgement, seed);
    if (isThorough) judgeUnit(scene, *program, field, region, judgement);
    return judgement;
}

void print(uint32_t seed, const Judgement& judgement) {
    std::fprintf(stderr, "Run it with FIELDWRIGHT_SCENE_SEED=%u:\n", seed);
    for (const Finding& finding : judgement.findings)
        std::fprintf(stderr, "scene %u %s: %s\n", seed, nameOf(finding.fault), finding.detail.c_str());
    if (const auto& solid = judgement.solid; solid && solid->bounds)
        std::fprintf(stderr, "  %zu bodies, volume %.9g +- %.2g, bounds %s, step %.9g\n",
                     solid->bodies.size(), solid->volume, solid->volumeError, text(*solid->bounds).c_str(),
                     solid->grid.step);
    std::fputs(test::everydayScene(seed).json.c_str(), stderr);
}

TEST(EverydayScenes, AgreeWithBruteForce) {
    if (const char* only = std::getenv("FIELDWRIGHT_SCENE_SEED")) {
        const auto seed = uint32_t(std::strtoul(only, nullptr, 10));
        const Judgement judgement = judge(seed);
        print(seed, judgement);
        EXPECT_TRUE(judgement.findings.empty());
        return;
    }
    const uint32_t scenes = isLong() ? 2'000 : 18;
    std::vector<Judgement> judgements(scenes);
    forBlocks(scenes, 1, [&](std::size_t, std::size_t first, std::size_t) {
        judgements[first] = judge(uint32_t(first) + 1);
        // The samples of thousands of scenes do not fit into memory.
        if (std::optional<BruteForceSolid>& solid = judgements[first].solid) {
            solid->inside = {};
            solid->signChanges = {};
        }
    });
    std::map<Fault, std::vector<uint32_t>> seeds;
    std::size_t empty = 0, cutOff = 0, certain = 0, bounds = 0, exact = 0;
    for (uint32_t seed = 1; seed <= scenes; ++seed) {
        const Judgement& judgement = judgements[seed - 1];
        bool isPrinted = false;
        for (const Finding& finding : judgement.findings) {
            seeds[finding.fault].push_back(seed);
            isPrinted |= seeds[finding.fault].size() <= kMaxPrinted;
        }
        if (isPrinted) print(seed, judgement);
        bounds += judgement.bounds;
        exact += judgement.exact;
        if (!judgement.solid) continue;
        empty += !judgement.solid->bounds;
        cutOff += judgement.solid->touchesGrid;
        certain += judgement.solid->isBodyCountCertain();
    }
    std::fprintf(stderr,
                 "%u scenes with %zu fields declared a bound and %zu exact outside or inside; %zu empty, %zu "
                 "leave the grid, "
                 "%zu with a certain number of bodies, %zu refused\n",
                 scenes, bounds, exact, empty, cutOff, certain, seeds[Fault::refused].size());
    for (const auto& [fault, of] : seeds) {
        // The region search ends at lengths that do not scale with the unit, so regions can differ.
        if (fault == Fault::refused || fault == Fault::looserInUnit)
            EXPECT_LE(of.size() * 100, kMaxRefusedPercent * scenes) << testing::PrintToString(of);
        else
            EXPECT_TRUE(of.empty()) << nameOf(fault) << ": seeds " << testing::PrintToString(of);
    }
    // Conditions of the test itself: most scenes have a solid in the grid, and many make a claim.
    EXPECT_LE(empty * 10, scenes);
    EXPECT_LE(cutOff * 10, scenes);
    EXPECT_GE(bounds, scenes / 2);
    EXPECT_GE(exact, scenes / 4);
}

/// The faults that are found in a program whose claims are changed after it is compiled.
std::vector<Fault> faultsOf(const std::string& code, const Exactness& declared, double regionScale) {
    Result<Program> program = compile(test::expressionGraph(code));
    EXPECT_TRUE(program);
    program->exactness = declared;
    Judgement judgement;
    const ReferenceField field(*program);
    judgement.solid = sampleByBruteForce(field, test::gridOver(cubeAround(1.5), 30));
    const Region region{Extent::bounded, cubeAround(regionScale), {}};
    judgeRegion(*program, region, true, judgement);
    judgeDistances(*program, field, *judgement.solid, 40, "output", judgement, 1);
    std::vector<Fault> faults;
    for (const Finding& finding : judgement.findings) faults.push_back(finding.fault);
    return faults;
}

TEST(EverydayScenes, FindWrongClaims) {
    using Faults = std::vector<Fault>;
    EXPECT_EQ(faultsOf("length(p) - 0.8", kExact, 0.8), Faults{});
    EXPECT_EQ(faultsOf("length(p) - 0.8", kExact, 0.79), Faults{Fault::lost});
    EXPECT_EQ(faultsOf("1.1 * (length(p) - 0.8)", kBound, 1.0), Faults{Fault::overestimated});
    EXPECT_EQ(faultsOf("1.1 * (length(p) - 0.8)", distorted(1.1), 1.0), Faults{});
    EXPECT_EQ(faultsOf("0.7 * (length(p) - 0.8)", kBound, 1.0), Faults{});
    EXPECT_EQ(faultsOf("0.7 * (length(p) - 0.8)", kExactOutside, 1.0), Faults{Fault::notExact});
    EXPECT_EQ(faultsOf("0.7 * (length(p) - 0.8)", kExactInside, 1.0), Faults{Fault::notExact});
}

TEST(EverydayScenes, AreTheSameForTheSameSeed) {
    EXPECT_EQ(test::everydayScene(7).json, test::everydayScene(7).json);
    EXPECT_NE(test::everydayScene(7).json, test::everydayScene(8).json);
    EXPECT_NE(test::everydayScene(7, "mm").json, test::everydayScene(7, "cm").json);
}

}  // namespace fw::everyday_scenes_test
