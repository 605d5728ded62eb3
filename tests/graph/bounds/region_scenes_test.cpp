// The region search on random everyday scenes and on reported ones: no solid is lost, few bounded solids are
// refused, and regions are close to their solids.
//
// FIELDWRIGHT_LONG=1 tests 10,000 scenes. FIELDWRIGHT_SCENE_SEED=N tests only scene N, and prints its JSON
// and the bounds:
//
//     FIELDWRIGHT_SCENE_SEED=17 graph_bounds_tests --gtest_filter=RegionScenes.ContainTheirSolidsClosely
//
// The reported scenes are skipped where the folder of bug reports is absent.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <optional>

#include "graph/base/parallel.h"
#include "graph/compile/compile.h"
#include "graph/document/json.h"
#include "tests/support/graph/random_scene.h"
#include "tests/support/graph/solid_bounds.h"

namespace fw::region_scenes_test {

using test::RandomScene;
using test::SceneAnchor;
using test::SolidBounds;

constexpr std::size_t kMaxPrintedScenes = 5;  ///< of each kind of failure
/// Scenes whose bounds the search may fail to prove, or find more than 1.5 times too long. The aim is 1 %
/// each; these keep it from getting worse.
constexpr std::size_t kMaxRefusedPercent = 3, kMaxLoosePercent = 8;
/// Relative to the region's size and its distance from the origin.
constexpr double kRounding = 1e-9;

enum class Outcome { kept, lost, refused, tooFar, wronglyEmpty, empty, notCompiled };

struct Finding {
    Outcome outcome = Outcome::kept;
    Region region;
    SolidBounds solid;
    Point worst{};         ///< the inside point farthest outside the region
    double outside = 0.0;  ///< by how much
    std::string error = {};
};

double largestCoordinate(const Box& box) {
    double largest = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis)
        largest = std::max({largest, std::abs(box.lo[axis]), std::abs(box.hi[axis])});
    return largest;
}

Finding examine(const Program& program, std::span<const SceneAnchor> anchors,
                const test::SolidBoundsOptions& options) {
    Finding finding;
    finding.region = findRegion(program);
    const bool bounded = finding.region.extent == Extent::bounded;
    finding.solid = test::sampleSolid(program.ir, program.distance(), program.parameters(), anchors,
                                      bounded ? std::optional(finding.region.box) : std::nullopt, options);
    if (!bounded) {
        const bool far = finding.solid.found && largestCoordinate(finding.solid.box) > kFarthest;
        if (finding.region.extent == Extent::empty)
            finding.outcome = finding.solid.found ? Outcome::wronglyEmpty : Outcome::empty;
        else
            finding.outcome = far ? Outcome::tooFar : Outcome::refused;
        return finding;
    }
    if (!finding.solid.found) {
        finding.outcome = Outcome::empty;
        return finding;
    }
    finding.outside = -INFINITY;
    for (const Point& point : finding.solid.extremes) {
        const double outside = test::distanceOutside(finding.region.box, point);
        if (outside > finding.outside) finding.outside = outside, finding.worst = point;
    }
    if (finding.outside > kRounding * std::max(1.0, largestCoordinate(finding.region.box)))
        finding.outcome = Outcome::lost;
    return finding;
}

Finding examine(const Result<Graph>& graph, std::span<const SceneAnchor> anchors,
                const test::SolidBoundsOptions& options) {
    Finding finding;
    finding.outcome = Outcome::notCompiled;
    if (!graph) {
        finding.error = format(graph.error());
        return finding;
    }
    const Result<Program> program = compile(*graph);
    if (program) return examine(*program, anchors, options);
    finding.error = format(program.error());
    return finding;
}

Finding examine(const RandomScene& scene) {
    return examine(parseGraph(scene.json, "scene " + std::to_string(scene.seed), nullptr), scene.anchors,
                   {.seed = scene.seed + 1});
}

bool isFailure(Outcome outcome) {
    return outcome != Outcome::kept && outcome != Outcome::empty && outcome != Outcome::tooFar;
}

const char* nameOf(Outcome outcome) {
    switch (outcome) {
        case Outcome::kept: return "kept";
        case Outcome::lost: return "LOST";
        case Outcome::refused: return "refused";
        case Outcome::tooFar: return "beyond the search";
        case Outcome::wronglyEmpty: return "called empty, but is not";
        case Outcome::empty: return "empty";
        default: return "does not compile";
    }
}

void print(const char* label, const Box& box) {
    std::fprintf(stderr, "  %s (%.9g %.9g %.9g) to (%.9g %.9g %.9g)\n", label, box.lo[0], box.lo[1],
                 box.lo[2], box.hi[0], box.hi[1], box.hi[2]);
}

void print(const Finding& finding) {
    if (!finding.error.empty()) std::fprintf(stderr, "  %s\n", finding.error.c_str());
    if (finding.region.extent == Extent::bounded) print("region", finding.region.box);
    if (finding.solid.found) print("solid ", finding.solid.box);
    if (finding.outcome == Outcome::lost)
        std::fprintf(stderr, "  inside at (%.17g %.17g %.17g), %.9g outside the region\n", finding.worst[0],
                     finding.worst[1], finding.worst[2], finding.outside);
}

void print(const RandomScene& scene, const Finding& finding) {
    std::fprintf(stderr, "scene %u: %s. Run it with FIELDWRIGHT_SCENE_SEED=%u\n", scene.seed,
                 nameOf(finding.outcome), scene.seed);
    print(finding);
    std::fputs(scene.json.c_str(), stderr);
}

/// The box's length over the solid's, of each axis that is reliable.
std::vector<double> ratiosOf(const Finding& finding) {
    std::vector<double> ratios;
    if (finding.outcome != Outcome::kept) return ratios;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double length = finding.solid.box.hi[axis] - finding.solid.box.lo[axis];
        if (finding.solid.reliable[axis] && length > 0.0)
            ratios.push_back((finding.region.box.hi[axis] - finding.region.box.lo[axis]) / length);
    }
    return ratios;
}

/// The smallest value that at least this share of the values does not exceed.
double quantile(std::vector<double> values, double share) {
    if (values.empty()) return 0.0;
    std::sort(values.begin(), values.end());
    const double rank = std::ceil(share * double(values.size())) - 1.0;
    return values[std::size_t(std::clamp(rank, 0.0, double(values.size() - 1)))];
}

void runOneScene(uint32_t seed) {
    const RandomScene scene = test::randomScene(seed);
    const Finding finding = examine(scene);
    print(scene, finding);
    for (const double ratio : ratiosOf(finding)) std::fprintf(stderr, "  length ratio %.3f\n", ratio);
    EXPECT_FALSE(isFailure(finding.outcome)) << nameOf(finding.outcome);
}

TEST(RegionScenes, ContainTheirSolidsClosely) {
    if (const char* seed = std::getenv("FIELDWRIGHT_SCENE_SEED"))
        return runOneScene(uint32_t(std::strtoul(seed, nullptr, 10)));
    const uint32_t scenes = std::getenv("FIELDWRIGHT_LONG") ? 10'000 : 200;
    std::map<Outcome, std::size_t> counts;
    std::vector<double> ratios;
    std::vector<uint32_t> looseSeeds;
    std::size_t measured = 0;
    std::vector<Finding> findings(scenes);
    forBlocks(scenes, 1, [&](std::size_t, std::size_t first, std::size_t) {
        findings[first] = examine(test::randomScene(uint32_t(first) + 1));
    });
    for (uint32_t seed = 1; seed <= scenes; ++seed) {
        const Finding& finding = findings[seed - 1];
        const std::size_t number = ++counts[finding.outcome];
        if (isFailure(finding.outcome) && number <= kMaxPrintedScenes)
            print(test::randomScene(seed), finding);
        const std::vector<double> ofScene = ratiosOf(finding);
        if (ofScene.empty()) continue;
        ++measured;
        ratios.insert(ratios.end(), ofScene.begin(), ofScene.end());
        const double worst = *std::max_element(ofScene.begin(), ofScene.end());
        if (worst > 1.5) looseSeeds.push_back(seed);
    }
    const double median = quantile(ratios, 0.5);
    std::fprintf(stderr,
                 "%u scenes: %zu kept, %zu lost, %zu refused, %zu wrongly empty, %zu beyond the search, %zu "
                 "empty, %zu do not compile\n"
                 "%zu sides of %zu scenes: median length ratio %.3f, 99th percentile %.3f, largest %.3f; %zu "
                 "scenes above 1.5\n",
                 scenes, counts[Outcome::kept], counts[Outcome::lost], counts[Outcome::refused],
                 counts[Outcome::wronglyEmpty], counts[Outcome::tooFar], counts[Outcome::empty],
                 counts[Outcome::notCompiled], ratios.size(), measured, median, quantile(ratios, 0.99),
                 quantile(ratios, 1.0), looseSeeds.size());
    EXPECT_EQ(counts[Outcome::lost], 0u);
    EXPECT_EQ(counts[Outcome::wronglyEmpty], 0u);
    // A node that measures distances needs a region too, and does not compile where that is refused.
    EXPECT_LE((counts[Outcome::refused] + counts[Outcome::notCompiled]) * 100, kMaxRefusedPercent * scenes);
    EXPECT_LE(looseSeeds.size() * 100, kMaxLoosePercent * measured)
        << "seeds: " << testing::PrintToString(looseSeeds);
    EXPECT_LE(median, 1.1);
    // Conditions of the test itself.
    EXPECT_LE(counts[Outcome::empty] * 20, scenes);
    EXPECT_GE(ratios.size() * 10, 8 * 3 * counts[Outcome::kept]) << "the oracle converges on too few sides";
}

/// Balls in which the solids of any graph could be: around the origin and around each offset in it.
std::vector<SceneAnchor> anchorsOf(const Graph& graph) {
    std::vector<SceneAnchor> anchors = {{{}, 0.5}, {{}, 2.0}, {{}, 8.0}, {{}, 60.0}};
    for (const Node& node : graph.nodes) {
        for (const char* name : {"offset", "translation"}) {
            const InputValue* input = node.input(name);
            const auto* at = input ? std::get_if<std::vector<double>>(&input->value) : nullptr;
            if (!at || at->size() != 3) continue;
            const Point centre{(*at)[0], (*at)[1], (*at)[2]};
            const double distance = std::hypot(centre[0], centre[1], centre[2]);
            for (const double radius : {0.05 * distance, 0.3 * distance, 1.5})
                if (radius > 0.0) anchors.push_back({centre, radius});
        }
    }
    return anchors;
}

/// Reported scenes whose region lost a solid, was much too large or was refused. Each name is the beginning
/// of names of files.
class ReportedRegions : public testing::TestWithParam<const char*> {};

TEST_P(ReportedRegions, ContainTheirSolids) {
    const std::filesystem::path reports = FIELDWRIGHT_SOURCE_DIR "/../shared/corpus/bug_reports";
    const std::filesystem::path prefix = reports / GetParam();
    if (!std::filesystem::is_directory(prefix.parent_path())) GTEST_SKIP() << "no folder of bug reports";
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(prefix.parent_path())) {
        const std::string name = entry.path().filename();
        if (!name.starts_with(prefix.filename().string()) || !name.ends_with(kGraphEnding)) continue;
        ++files;
        const Result<Graph> graph = readGraph(entry.path(), nullptr);
        ASSERT_TRUE(graph) << format(graph.error());
        const Finding finding = examine(graph, anchorsOf(*graph), {});
        if (isFailure(finding.outcome)) print(finding);
        EXPECT_STREQ(nameOf(finding.outcome), "kept") << name;
    }
    if (files == 0) GTEST_SKIP() << "no file whose name begins with " << GetParam();
}

constexpr const char* kReported[] = {"qa/r1_",
                                     "qa/r3_",
                                     "qa/r10_",
                                     "qa/rotate_4",
                                     "qa/tube_4",
                                     "qa/twist_4",
                                     "qa/sweep_4",
                                     "qa/mirror_oblique_4",
                                     "qa/polar_oblique_4",
                                     "qa/true_of_twist_4",
                                     "qa/s_tetrahedron",
                                     "qa/region_s",
                                     "qa/loose_",
                                     "maker/lost_",
                                     "maker/false_no_bounds_"};

std::string testNameOf(const testing::TestParamInfo<const char*>& info) {
    std::string name = info.param;
    std::replace(name.begin(), name.end(), '/', '_');
    return name;
}

INSTANTIATE_TEST_SUITE_P(BugReports, ReportedRegions, testing::ValuesIn(kReported), testNameOf);

}  // namespace fw::region_scenes_test
