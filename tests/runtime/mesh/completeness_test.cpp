// Completeness: regions that miss some of a solid are found out, right ones are not accused.
#include "runtime/measure/completeness.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "graph/bounds/region.h"
#include "graph/compile/compile.h"
#include "graph/document/json.h"
#include "graph/evaluate/evaluate.h"
#include "runtime/measure/mesh_requirements.h"
#include "tests/support/command.h"
#include "tests/support/graph/code_field.h"
#include "tests/support/graph/random_scene.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::completeness_test {

using test::CommandResult;
using test::runCommand;

struct Field {
    Ir ir;
    IrId root;

    double at(const Point& point) const { return evaluate(ir, root, {}, point); }
    Completeness check(const Box& region, const CompletenessBudget& budget = {}) const {
        return checkCompleteness(ir, root, {}, region, nullptr, budget);
    }
};

Field fieldOf(const std::string& code) {
    test::CodeField field = test::fieldOfCode(code);
    return {std::move(field.ir), field.distance};
}

Box cube(double half, Point centre = {}) {
    Box box;
    for (std::size_t axis = 0; axis < 3; ++axis)
        box.lo[axis] = centre[axis] - half, box.hi[axis] = centre[axis] + half;
    return box;
}

double distanceBetween(const Point& a, const Point& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// The check finds solid outside the region, in a ball around that centre.
void expectMissing(const std::string& code, const Box& region, const Point& centre, double radius) {
    SCOPED_TRACE(code);
    const Field field = fieldOf(code);
    const Completeness found = field.check(region);
    ASSERT_FALSE(found.complete());
    EXPECT_FALSE(found.proven);
    EXPECT_LT(field.at(*found.solidOutside), 0.0);
    EXPECT_LE(distanceBetween(*found.solidOutside, centre), radius) << describeMissing(found);
}

void expectComplete(const std::string& code, const Box& region, bool proven) {
    SCOPED_TRACE(code);
    const Completeness found = fieldOf(code).check(region);
    EXPECT_TRUE(found.complete()) << (found.complete() ? "" : describeMissing(found));
    EXPECT_EQ(found.proven, proven);
}

/// A turned box of half extents 1: intervals over large boxes prove little about it.
const std::string kTurnedBox =
    "q = vec3(0.6 * p.x - 0.8 * p.z, p.y, 0.8 * p.x + 0.6 * p.z); d = box(q, vec3(1));";

TEST(Completeness, FindsABallThatTheRegionMisses) {
    expectMissing("return min(sphere(p, 1), sphere(p - vec3(4, 2, 3), 1));", cube(1.1), {4, 2, 3}, 1.0);
    expectMissing(kTurnedBox + "return min(d, sphere(p - vec3(4, 2, 3), 1));", cube(1.5), {4, 2, 3}, 1.0);
    expectMissing("return min(twist(box(p, vec3(0.3, 1, 0.1)), 1440), sphere(p - vec3(40, 2, 3), 0.5));",
                  cube(1.2), {40, 2, 3}, 0.5);
    // Small and far: few samples are nearer to it than to the box.
    expectMissing(kTurnedBox + "return min(d, sphere(p - vec3(-3000, 70, 900), 0.01));", cube(1.5),
                  {-3000, 70, 900}, 0.01);
    // Close to the region.
    expectMissing("return min(sphere(p, 1), sphere(p - vec3(0, 1.15, 0), 0.04));", cube(1.1), {0, 1.15, 0},
                  0.04);
}

TEST(Completeness, FindsAThinRodFarAway) {
    expectMissing(kTurnedBox + "return min(d, cylinder(p - vec3(0, 500, 20), 0.002, 0.5));", cube(1.5),
                  {0, 500, 20}, 0.51);
}

TEST(Completeness, FindsCopiesOutsideTheRegion) {
    const Completeness all = fieldOf("return repeat(sphere(p, 1), vec3(5, 0, 0));").check(cube(1.2));
    ASSERT_FALSE(all.complete());
    EXPECT_NEAR(std::remainder((*all.solidOutside)[0], 5.0), 0.0, 1.0);
    EXPECT_FALSE(fieldOf("return repeat(sphere(p, 1), vec3(0, 0, 300));").check(cube(1.2)).complete());
}

TEST(Completeness, FindsASolidThatTheRegionCuts) {
    EXPECT_FALSE(fieldOf("return p.y;").check(cube(1)).complete());
    EXPECT_FALSE(fieldOf("return -sphere(p, 1);").check(cube(2)).complete());
    EXPECT_FALSE(fieldOf("return -1;").check(cube(2)).complete());
    expectMissing("return sphere(p, 1);", cube(0.9), {0, 0, 0}, 1.0);
}

TEST(Completeness, ProvesWhatIntervalsCanProve) {
    expectComplete("return sphere(p, 1);", cube(1.05), true);
    expectComplete("return max(sphere(p, 1), -box(p, vec3(0.2, 2, 0.2)));", cube(1.05), true);
    expectComplete(kTurnedBox + "return d;", cube(1.45), true);
    expectComplete("return 1;", cube(1), true);
    // Slabs prove nothing here, as the minimum of a difference of moved copies.
    expectComplete(kTurnedBox + "return min(d, sphere(p - vec3(4, 2, 3), 1));",
                   {{-1.5, -1.5, -1.5}, {5.1, 3.1, 4.1}}, true);
}

TEST(Completeness, SaysWhatItDidNotProve) {
    // sin(x)^2 + cos(x)^2 is 1, which intervals do not see.
    const std::string code = "return sphere(p, 1) + 60 * (1 - sin(p.x) * sin(p.x) - cos(p.x) * cos(p.x));";
    expectComplete(code, cube(1.1), false);
}

TEST(Completeness, KeepsToItsBudget) {
    std::string code = "d = 1e9; v = 0.0;";
    for (int i = 1; i < 2000; ++i) {
        const std::string n = std::to_string(i);
        code += "v = " + n + " * p.x; d = min(d, sphere(p - vec3(sin(" + n + "), cos(2 * " + n +
                "), sin(5 * " + n + ")), 0.1) + 60 * (1 - sin(v) * sin(v) - cos(v) * cos(v)));";
    }
    const Field field = fieldOf(code + "return d;");
    const CompletenessBudget budget{.pointWork = 10'000'000, .intervalWork = 1'000'000};
    const Completeness found = field.check(cube(1.2), budget);
    EXPECT_TRUE(found.complete());
    EXPECT_FALSE(found.proven);
    EXPECT_GT(found.pointWork, budget.pointWork / 2);
    // Samples, a batch of descents and the six slabs are always done.
    EXPECT_LT(found.pointWork, 5 * budget.pointWork);
    EXPECT_LT(found.intervalWork, 2 * budget.intervalWork);
    std::atomic<bool> cancel = true;
    EXPECT_LT(checkCompleteness(field.ir, field.root, {}, cube(1.2), &cancel, budget).pointWork,
              found.pointWork / 4);
}

TEST(Completeness, TheSameOnEveryRun) {
    const Field field = fieldOf(kTurnedBox + "return min(d, sphere(p - vec3(4, 2, 3), 1));");
    const Completeness first = field.check(cube(1.5)), second = field.check(cube(1.5));
    EXPECT_EQ(first.solidOutside, second.solidOutside);
    EXPECT_EQ(first.pointWork, second.pointWork);
}

/// Regions of whole scenes are never accused, and those around one of their solids nearly always are.
TEST(Completeness, OfRandomScenes) {
    int wrong = 0, found = 0;
    for (uint32_t seed = 0; seed < (std::getenv("FIELDWRIGHT_LONG") ? 300u : 12u); ++seed) {
        SCOPED_TRACE("scene " + std::to_string(seed));
        const test::RandomScene scene = test::randomScene(seed);
        std::vector<Error> warnings;
        const Result<Graph> graph = parseGraph(scene.json, "scene", &warnings);
        ASSERT_TRUE(graph) << format(graph.error());
        const Result<Program> program = compile(*graph);
        ASSERT_TRUE(program) << format(program.error());
        const Region region = findRegion(*program);
        if (region.extent != Extent::bounded) continue;
        const Completeness right = checkCompleteness(*program, padded(region.box, 64, 1.5));
        EXPECT_TRUE(right.complete()) << describeMissing(right);
        for (const test::SceneAnchor& anchor : scene.anchors) {
            const Box box = cube(anchor.radius, anchor.centre);
            // Whether another solid is there: by samples where it should be.
            std::vector<Point> points;
            for (const test::SceneAnchor& other : scene.anchors)
                for (int i = 0; &other != &anchor && i < 8000; ++i) {
                    const Point at{other.centre[0] + other.radius * ((i % 20) / 9.5 - 1),
                                   other.centre[1] + other.radius * ((i / 20 % 20) / 9.5 - 1),
                                   other.centre[2] + other.radius * ((i / 400) / 9.5 - 1)};
                    bool isOutside = false;
                    for (std::size_t axis = 0; axis < 3; ++axis)
                        isOutside |= at[axis] < box.lo[axis] || at[axis] > box.hi[axis];
                    if (isOutside) points.push_back(at);
                }
            std::vector<double> values(points.size());
            evaluate(program->ir, program->distance(), program->parameters(), points, values);
            const bool isWrong = std::ranges::any_of(values, [](double value) { return value < 0; });
            if (!isWrong) continue;
            ++wrong;
            const Completeness check = checkCompleteness(*program, box);
            EXPECT_FALSE(check.proven);
            found += !check.complete();
        }
    }
    EXPECT_GT(wrong, 20);
    EXPECT_GE(found, wrong - wrong / 50) << "of " << wrong;
}

std::string reasonsOf(const std::string& list, const Report& report) {
    std::string all;
    for (const std::string& reason : unmet(*parseRequirements(list), report)) all += reason + "\n";
    return all;
}

TEST(Completeness, IsRequiredWithClosedWhereTheRegionWasFound) {
    const Field field = fieldOf("return min(sphere(p, 1), sphere(p - vec3(4, 2, 3), 1));");
    Report report;
    EXPECT_EQ(reasonsOf("closed", report), "") << "not checked";
    EXPECT_NE(reasonsOf("complete", report), "");
    report.completeness = field.check(cube(1.5));
    report.regionFound = true;
    const std::string reason = reasonsOf("closed,manifold", report);
    EXPECT_TRUE(reason.starts_with("not complete: there is solid at (")) << reason;
    EXPECT_NE(reason.find("outside the meshed region (-1.5 -1.5 -1.5) to (1.5 1.5 1.5): give"),
              std::string::npos)
        << reason;
    EXPECT_EQ(reasonsOf("complete", report), reason);
    EXPECT_EQ(reasonsOf("closed,complete", report), reason) << "told once";
    EXPECT_EQ(reasonsOf("manifold", report), "");
    report.regionFound = false;
    EXPECT_EQ(reasonsOf("closed", report), "") << "a given region may cut the solid";
    EXPECT_EQ(reasonsOf("complete", report), reason);
    report.completeness = field.check({{-1.5, -1.5, -1.5}, {6, 6, 6}});
    EXPECT_EQ(reasonsOf("complete,closed", report), "");
}

TEST(Completeness, IsInReports) {
    Report report;
    const auto json = [&] { return nlohmann::json::parse(writeReport(report)); };
    for (const char* key : {"complete", "completeness", "solidOutside"})
        EXPECT_TRUE(json()[key].is_null()) << key;
    EXPECT_EQ(reportWords(report).find("Complete"), std::string::npos);
    report.completeness = Completeness{.proven = true};
    EXPECT_EQ(json()["complete"], true);
    EXPECT_EQ(json()["completeness"], "proven");
    EXPECT_NE(reportWords(report).find("Complete: yes, proven\n"), std::string::npos);
    report.completeness = Completeness{};
    EXPECT_EQ(json()["completeness"], "sampled");
    report.completeness = Completeness{.solidOutside = Point{4, 2, 3}, .region = cube(1)};
    EXPECT_EQ(json()["complete"], false);
    EXPECT_TRUE(json()["completeness"].is_null());
    EXPECT_EQ(json()["solidOutside"], (nlohmann::json{4.0, 2.0, 3.0}));
    EXPECT_NE(
        reportWords(report).find("Complete: no: there is solid at (4, 2, 3), outside the meshed region (-1 "
                                 "-1 -1) to (1 1 1)\n"),
        std::string::npos);
}

TEST(Completeness, TheCommandRequiresItOfGivenRegionsOnlyIfAsked) {
    const test::TempDir folder;
    const std::string graph = folder.path("balls.field.json"), report = folder.path("balls.json");
    test::writeText(graph, R"({"fieldwright": 1, "nodes": [
        {"id": "a", "type": "sphere"},
        {"id": "b", "type": "sphere"},
        {"id": "moved", "type": "translate", "inputs": {"surface": {"from": "b"}, "offset": [4, 2, 3]}},
        {"id": "both", "type": "union", "inputs": {"a": {"from": "a"}, "b": {"from": "moved"}}},
        {"id": "ground", "type": "plane"},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "both"}, "resolution": 24}}]})");
    const auto made = [&](std::vector<std::string> more) {
        std::vector<std::string> all = {"export", graph, "-o", folder.path("balls.stl"), "--report", report};
        all.insert(all.end(), more.begin(), more.end());
        const CommandResult result = runCommand(all);
        return std::pair(result, nlohmann::json::parse(test::readText(report)));
    };
    const auto [whole, wholeReport] = made({"--require", "closed,complete"});
    EXPECT_EQ(whole.status, 0) << whole.errors;
    EXPECT_EQ(wholeReport["complete"], true);
    EXPECT_EQ(wholeReport["completeness"], "proven");
    const std::vector<std::string> region = {"--region", "-1.5", "-1.5", "-1.5",
                                             "1.5",      "1.5",  "1.5",  "--require"};
    const auto with = [&](const char* list) {
        std::vector<std::string> all = region;
        all.push_back(list);
        return made(all);
    };
    const auto [closed, cutReport] = with("closed");
    EXPECT_EQ(closed.status, 0) << closed.errors;
    EXPECT_EQ(cutReport["complete"], false);
    const Point at = cutReport["solidOutside"].get<Point>();
    EXPECT_LE(distanceBetween(at, {4, 2, 3}), 1.0);
    const CommandResult missed = with("closed,complete").first;
    EXPECT_EQ(missed.status, 1);
    EXPECT_NE(missed.errors.find("balls.stl: not complete: there is solid at ("), std::string::npos)
        << missed.errors;
    EXPECT_NE(missed.errors.find("outside the meshed region (-1.5 -1.5 -1.5) to (1.5 1.5 1.5)"),
              std::string::npos);
}

TEST(Completeness, APlaneIsNeverComplete) {
    const test::TempDir folder;
    const std::string graph = folder.path("ground.field.json");
    test::writeText(graph, R"({"fieldwright": 1, "nodes": [{"id": "ground", "type": "plane"},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "ground"}, "resolution": 16}}]})");
    const auto required = [&](const char* list) {
        return runCommand({"export", graph, "-o", folder.path("ground.stl"), "--region", "-1", "-1", "-1",
                           "1", "1", "1", "--require", list});
    };
    const CommandResult closed = required("closed");
    EXPECT_EQ(closed.status, 0) << closed.errors;
    const CommandResult complete = required("complete");
    EXPECT_EQ(complete.status, 1);
    EXPECT_NE(complete.errors.find("not complete: there is solid at ("), std::string::npos)
        << complete.errors;
}

TEST(Completeness, IsCheckedOfEveryVariant) {
    const test::TempDir folder;
    const std::string graph = folder.path("ball.field.json"), report = folder.path("report.json");
    test::writeText(graph, R"({"fieldwright": 1, "nodes": [{"id": "ball", "type": "sphere"},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "ball"}, "resolution": 16}}],
        "parameters": [{"name": "size", "node": "ball", "input": "radius", "max": 5}]})");
    const CommandResult made = runCommand({"export", graph, "-o", folder.path("balls"), "--format", "stl",
                                           "--sweep", "size=1:2:2", "--region", "-1.5", "-1.5", "-1.5", "1.5",
                                           "1.5", "1.5", "--report", report, "--require", "complete"});
    EXPECT_EQ(made.status, 1) << made.errors;
    EXPECT_NE(made.errors.find("size=2.stl: not complete: there is solid at ("), std::string::npos)
        << made.errors;
    EXPECT_EQ(made.errors.find("size=1.stl: not"), std::string::npos) << made.errors;
    const auto variants = nlohmann::json::parse(test::readText(report))["variants"];
    ASSERT_EQ(variants.size(), 2u);
    EXPECT_EQ(variants[0]["complete"], true);
    EXPECT_EQ(variants[1]["complete"], false);
}

TEST(Completeness, MergedPartsCannotBeChecked) {
    const CommandResult merged =
        runCommand({"merge", "none.part", "-o", "mesh.ply", "--require", "closed,complete"});
    test::expectRefusal(merged, 2, {"complete", "parts do not hold"});
}

}  // namespace fw::completeness_test
