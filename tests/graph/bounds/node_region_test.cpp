// The regions of solids that domain nodes make of a box and a ball: found, around the solid, and close to it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>

#include "graph/bounds/region.h"
#include "graph/compile/compile.h"
#include "graph/document/json.h"

namespace fw::node_region_test {

struct Case {
    std::string type, inputs;
};

std::string text(double number) {
    char digits[40];
    std::snprintf(digits, sizeof digits, "%.10g", number);
    return digits;
}
std::string text(const Point& p) { return "[" + text(p[0]) + ", " + text(p[1]) + ", " + text(p[2]) + "]"; }

/// Every domain node over counts, angles and offsets.
std::vector<Case> cases() {
    std::vector<Case> all;
    const auto add = [&](std::string type, std::string inputs) {
        all.push_back({std::move(type), std::move(inputs)});
    };
    for (int count = 1; count <= 12; ++count)
        for (const char* axis : {"[0, 1, 0]", "[1, 0, 0]", "[1, 1, 1]"})
            for (const char* neighbours : {"true", "false"})
                add("polar_repeat", R"("count": )" + std::to_string(count) + R"(, "axis": )" + axis +
                                        R"(, "neighbours": )" + neighbours);
    for (int count = 1; count <= 12; ++count)
        for (const char* neighbours : {"true", "false"})
            add("repeat", R"("period": [2.5, 3, 2.75], "count": [)" + std::to_string(count) + ", 1, " +
                              std::to_string(1 + count % 4) + R"(], "neighbours": )" + neighbours);
    for (double angle : {-150.0, -90.0, -33.0, 0.0, 10.0, 45.0, 60.0, 120.0, 180.0}) {
        const double c = std::cos(angle * 3.14159265358979 / 180),
                     s = std::sin(angle * 3.14159265358979 / 180);
        add("mirror", R"("normal": )" + text(Point{c, s, 0.0}) + R"(, "offset": )" + text(angle / 300));
        add("rotate", R"("angles": )" + text(Point{angle, angle / 2, -angle}));
        add("transform",
            R"("translation": [1, -2, 3], "scale": 0.5, "rotation": )" + text(Point{0.0, angle, angle}));
        add("twist", R"("rate": )" + text(angle / 2));
        add("bend", R"("rate": )" + text(angle / 4));
        add("taper", R"("rate": )" + text(angle / 300));
    }
    for (double size : {0.1, 0.7, 3.0}) {
        add("scale", R"("factor": )" + text(size));
        add("translate", R"("offset": )" + text(Point{10 * size, -size, 3 * size}));
        add("stretch", R"("factors": )" + text(Point{size, 1.0, 2 * size}));
        add("elongate", R"("half_extents": )" + text(Point{size, 0.0, size / 2}));
        add("offset", R"("distance": )" + text(size / 2));
        add("shell", R"("thickness": )" + text(size / 4));
        add("displace", R"("amount": )" + text(-size));
    }
    return all;
}

/// Around what samples within `box` find inside; it may miss a cell of their grid at each side.
std::optional<Box> sampledBounds(const Program& program, const Box& box, int cells) {
    std::vector<Point> points;
    for (int k = 0; k <= cells; ++k)
        for (int j = 0; j <= cells; ++j)
            for (int i = 0; i <= cells; ++i)
                points.push_back({std::lerp(box.lo[0], box.hi[0], double(i) / cells),
                                  std::lerp(box.lo[1], box.hi[1], double(j) / cells),
                                  std::lerp(box.lo[2], box.hi[2], double(k) / cells)});
    std::vector<double> values(points.size());
    evaluate(program.ir, program.distance(), {}, points, values);
    std::optional<Box> bounds;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (values[i] < 0.0)
            bounds = bounds ? joined(*bounds, {points[i], points[i]}) : Box{points[i], points[i]};
    return bounds;
}

class NodeRegion : public testing::TestWithParam<std::string> {};

TEST_P(NodeRegion, IsCloseAroundTheSolid) {
    const bool all = std::getenv("FIELDWRIGHT_LONG");
    const int cells = all ? 40 : 32;
    double worst = 0.0;
    std::string worstCase;
    const std::vector<Case> sweep = cases();
    for (std::size_t n = 0; n < sweep.size(); ++n) {
        const Case& one = sweep[n];
        const bool narrow = one.type == "polar_repeat" && n % 6 == 0;  // every count about y
        if (!all && !narrow && n % 13 != 0) continue;
        SCOPED_TRACE(one.type + " " + one.inputs);
        const Result<Graph> graph =
            parseGraph(R"({"fieldwright": 1, "nodes": [)" + GetParam() + R"(,
                {"id": "it", "type": ")" +
                           one.type + R"(", "inputs": {"surface": {"from": "solid"}, )" + one.inputs + R"(}},
                {"id": "out", "type": "output", "inputs": {"surface": {"from": "it"}}}]})",
                       "graph", nullptr);
        ASSERT_TRUE(graph) << format(graph.error());
        const Result<Program> program = compile(*graph);
        ASSERT_TRUE(program) << format(program.error());
        const Region region = findRegion(program->ir, program->distance(), {});
        if (region.extent == Extent::empty) {  // a mirror that has nothing before it
            EXPECT_FALSE(sampledBounds(*program, {{-4, -4, -4}, {4, 4, 4}}, 60));
            continue;
        }
        EXPECT_EQ(region.extent, Extent::bounded);
        if (region.extent != Extent::bounded) continue;
        const std::optional<Box> inner = sampledBounds(*program, region.box, cells);
        EXPECT_TRUE(inner);
        if (!inner) continue;
        Box around = region.box;
        for (int axis = 0; axis < 3; ++axis) {
            const double width = region.box.hi[axis] - region.box.lo[axis];
            const double sampled = inner->hi[axis] - inner->lo[axis] + 2.0 * width / cells;
            around.lo[axis] -= 0.5 * width, around.hi[axis] += 0.5 * width;
            if (width / sampled > worst) worst = width / sampled, worstCase = one.type + " " + one.inputs;
            EXPECT_LE(width, 1.3 * sampled) << "axis " << axis;
        }
        const std::optional<Box> wide = sampledBounds(*program, around, cells);
        for (int axis = 0; wide && axis < 3; ++axis) {
            EXPECT_GE(wide->lo[axis], region.box.lo[axis]);
            EXPECT_LE(wide->hi[axis], region.box.hi[axis]);
        }
    }
    std::printf("at most %.3f times as wide: %s\n", worst, worstCase.c_str());
}

INSTANTIATE_TEST_SUITE_P(
    Solids, NodeRegion,
    testing::Values(R"({"id": "solid", "type": "box", "inputs": {"half_extents": [0.5, 0.7, 0.4]}})",
                    R"({"id": "ball", "type": "sphere", "inputs": {"radius": 0.3}},
                       {"id": "solid", "type": "translate", "inputs": {"surface": {"from": "ball"}, "offset": [2, 0, 0]}})",
                    R"({"id": "box", "type": "box", "inputs": {"half_extents": [0.5, 0.5, 0.5]}},
                       {"id": "solid", "type": "translate", "inputs": {"surface": {"from": "box"}, "offset": [2, 0.1, 0]}})"));

}  // namespace fw::node_region_test
