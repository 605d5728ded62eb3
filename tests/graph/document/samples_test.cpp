// Every graph under samples/ is one a person can learn from and export as it stands.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "graph/bounds/region.h"
#include "graph/check/check.h"
#include "graph/compile/compile.h"
#include "graph/document/json.h"

namespace fw::samples_test {

std::string samplePath(const std::string& name) {
    return std::string(FIELDWRIGHT_SOURCE_DIR) + "/samples/" + name + ".field.json";
}

std::vector<std::string> sampleNames() {
    std::vector<std::string> names;
    for (const auto& entry :
         std::filesystem::directory_iterator(std::string(FIELDWRIGHT_SOURCE_DIR) + "/samples"))
        if (std::string name = entry.path().filename(); name.ends_with(".field.json"))
            names.push_back(name.substr(0, name.find('.')));
    std::sort(names.begin(), names.end());
    return names;
}

std::string textOf(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    EXPECT_TRUE(file) << path;
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

Program programOf(const std::string& name) {
    const Result<Graph> graph = readGraph(samplePath(name), nullptr);
    EXPECT_TRUE(graph) << format(graph.error());
    const Result<Program> program = compile(*graph);
    EXPECT_TRUE(program) << format(program.error());
    return *program;
}

std::vector<Point> randomPoints(const Box& box, int count) {
    std::mt19937 random(7);
    std::vector<Point> points(count);
    for (Point& point : points)
        for (int axis = 0; axis < 3; ++axis)
            point[axis] = std::uniform_real_distribution(box.lo[axis], box.hi[axis])(random);
    return points;
}

std::vector<double> valuesAt(const Program& program, const std::vector<Point>& points) {
    std::vector<double> values(points.size());
    evaluate(program.ir, program.distance(), program.parameters(), points, values);
    return values;
}

class Sample : public testing::TestWithParam<std::string> {};

TEST_P(Sample, ReadsAndChecksWithoutAFinding) {
    std::vector<Error> findings;
    const Result<Graph> graph = readGraph(samplePath(GetParam()), &findings);
    ASSERT_TRUE(graph) << format(graph.error());
    for (const Error& finding : check(*graph)) findings.push_back(finding);
    for (const Error& finding : findings) ADD_FAILURE() << format(finding);
}

TEST_P(Sample, SavesToTheSameBytes) {
    const std::string text = textOf(samplePath(GetParam()));
    const Result<Graph> graph = parseGraph(text, "", nullptr);
    ASSERT_TRUE(graph);
    EXPECT_EQ(writeGraph(*graph), text);
}

TEST_P(Sample, HasEveryNodeOnTheCanvasLeftToRight) {
    const Result<Graph> graph = readGraph(samplePath(GetParam()), nullptr);
    ASSERT_TRUE(graph);
    std::vector<const std::vector<Node>*> canvases{&graph->nodes};
    for (const Group& group : graph->groups) canvases.push_back(&group.nodes);
    for (const std::vector<Node>* nodes : canvases) {
        std::vector<std::array<double, 2>> taken;
        for (const Node& node : *nodes) {
            ASSERT_TRUE(node.at) << node.id;
            EXPECT_EQ(std::count(taken.begin(), taken.end(), *node.at), 0)
                << node.id << " covers another node";
            taken.push_back(*node.at);
            for (const auto& [name, input] : node.inputs) {
                const Link* link = std::get_if<Link>(&input.value);
                if (!link) continue;
                EXPECT_LT((*findNode(*nodes, link->node)->at)[0], (*node.at)[0])
                    << link->node << " feeds " << node.id << " from the right";
            }
        }
    }
}

TEST_P(Sample, IsABoundedSolidNeitherEmptyNorFull) {
    const Program program = programOf(GetParam());
    const Region region = findRegion(program.ir, program.distance(), program.parameters());
    ASSERT_EQ(region.extent, Extent::bounded);
    const Box around = padded(region.box, 64, 4.0);
    const std::vector<double> values = valuesAt(program, randomPoints(around, 20'000));
    const auto inside = std::count_if(values.begin(), values.end(), [](double f) { return f < 0.0; });
    EXPECT_GT(inside, 200);
    EXPECT_LT(inside, 19'000);
}

TEST_P(Sample, WithEveryParameterLiveIsTheSameField) {
    const Result<Graph> graph = readGraph(samplePath(GetParam()), nullptr);
    ASSERT_TRUE(graph);
    CompileOptions options;
    options.liveExposed = true;
    const Result<Program> live = compile(*graph, options);
    ASSERT_TRUE(live) << format(live.error());
    EXPECT_EQ(live->live.empty(), graph->parameters.empty());
    const Program folded = programOf(GetParam());
    const std::vector<Point> points = randomPoints({{-2, -2, -2}, {2, 2, 2}}, 2'000);
    const std::vector<double> a = valuesAt(folded, points), b = valuesAt(*live, points);
    for (std::size_t i = 0; i < points.size(); ++i) ASSERT_NEAR(a[i], b[i], 1e-9);
}

INSTANTIATE_TEST_SUITE_P(All, Sample, testing::ValuesIn(sampleNames()),
                         [](const auto& sample) { return sample.param; });

TEST(Samples, AreAllInTheGallery) {
    const std::string gallery = textOf(std::string(FIELDWRIGHT_SOURCE_DIR) + "/samples/README.md");
    EXPECT_GE(sampleNames().size(), 16u);
    for (const std::string& name : sampleNames())
        EXPECT_NE(gallery.find(name + ".field.json"), std::string::npos) << name;
}

/// The reference tower of docs/benchmarks.md, written here once more.
double referenceTower(const Point& p) {
    const auto box = [](double x, double y, double z, double hx, double hy, double hz) {
        return std::max({std::abs(x) - hx, std::abs(y) - hy, std::abs(z) - hz});
    };
    const auto modulo = [](double x, double m) { return x - m * std::floor(x / m); };
    double c[3];
    for (int axis = 0; axis < 3; ++axis) c[axis] = std::abs(modulo(p[axis], 0.5) - 0.25) - 0.15;
    double d = box(p[0], p[1], p[2], 1, 2, 1);
    d = std::max(d, -std::min({std::max(c[0], c[1]), std::max(c[1], c[2]), std::max(c[0], c[2])}));
    const double floors =
        box(modulo(p[0], 1) - 0.5, modulo(p[1] + 0.25, 1) - 0.5, modulo(p[2], 1) - 0.5, 0.45, 0.2, 0.45);
    return std::max(d, -floors);
}

TEST(Samples, TowerIsTheReferenceTower) {
    const Program program = programOf("tower");
    const std::vector<Point> points = randomPoints({{-2.5, -2.5, -2.5}, {2.5, 2.5, 2.5}}, 50'000);
    const std::vector<double> values = valuesAt(program, points);
    for (std::size_t i = 0; i < points.size(); ++i) ASSERT_NEAR(values[i], referenceTower(points[i]), 1e-12);
}

TEST(Samples, TheTypedTowerIsTheWiredOne) {
    const Program wired = programOf("talk_6_combined"), typed = programOf("tower_expression");
    // Inside the box the two are one field; outside, the listing's fmod truncates where the nodes' modulo
    // floors.
    const std::vector<Point> inside = randomPoints({{-1, -2, -1}, {1, 2, 1}}, 50'000);
    const std::vector<double> a = valuesAt(wired, inside), b = valuesAt(typed, inside);
    for (std::size_t i = 0; i < inside.size(); ++i) ASSERT_NEAR(a[i], b[i], 1e-12);
    const std::vector<Point> around = randomPoints({{-3, -3, -3}, {3, 3, 3}}, 50'000);
    const std::vector<double> c = valuesAt(wired, around), d = valuesAt(typed, around);
    for (std::size_t i = 0; i < around.size(); ++i) ASSERT_EQ(c[i] < 0.0, d[i] < 0.0);
}

}  // namespace fw::samples_test
