// Tubes and sweeps on the device: samples against the host's, and meshes of known volume.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "graph/curves/spline.h"
#include "graph/document/json.h"
#include "graph/evaluate/evaluate.h"
#include "runtime/measure/mesh_report.h"
#include "runtime/play/session.h"
#include "tests/support/device_field.h"
#include "tests/support/gpu.h"

namespace fw::spline_field_test {

Program programOf(const std::string& nodes) {
    const Result<Graph> graph = parseGraph(R"({"fieldwright": 1, "nodes": [)" + nodes + R"(,
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "solid"}}}]})",
                                           "splines.field.json", nullptr);
    EXPECT_TRUE(graph) << (graph ? "" : format(graph.error()));
    Result<Program> program = compile(*graph);
    EXPECT_TRUE(program) << (program ? "" : format(program.error()));
    return std::move(*program);
}

const std::string kKnots =
    R"("knots": [[-0.9, 0, 0, 1.5, 0], [-0.3, 0.6, 0.2, 1, 40], [0.3, -0.3, -0.2, 0.6, -30], [0.9, 0.3, 0.1, 0.3, 90]])";
const std::string kEven =
    R"("knots": [[-0.9, 0, 0, 1, 0], [-0.3, 0.6, 0.2, 1, 0], [0.3, -0.3, -0.2, 1, 0], [0.9, 0.3, 0.1, 1, 0]])";

struct Case {
    const char* name;
    std::string nodes;
    int jumps;  ///< places in ten thousand that may lie on the other side of a jump
};
std::vector<Case> cases() {
    const auto spline = [](const std::string& inputs) {
        return R"({"id": "curve", "type": "spline", "inputs": {)" + inputs + "}},";
    };
    const std::string tube =
        R"({"id": "solid", "type": "tube", "inputs": {"spline": {"from": "curve"}, "radius": 0.12)";
    const std::string sweep =
        R"({"id": "flat", "type": "star", "inputs": {"outer_radius": 0.15, "inner_radius": 0.08}},
        {"id": "solid", "type": "sweep", "inputs": {"surface": {"from": "flat"}, "spline": {"from": "curve"}}})";
    return {{"even tube", spline(kEven) + tube + "}}", 0},
            {"tapered tube", spline(kKnots) + tube + "}}", 0},
            {"flat ends", spline(kKnots) + tube + R"(, "ends": "flat"}})", 30},
            {"corners", spline(kEven + R"(, "kind": "straight", "closed": true)") + tube + "}}", 0},
            {"bent pipe", spline(kEven + R"(, "kind": "straight", "bend": 0.2)") + tube + "}}", 0},
            {"twisted sweep", spline(kKnots) + sweep, 60},
            {"closed sweep", spline(kKnots + R"(, "closed": true)") + sweep, 60},
            {"helix",
             R"({"id": "curve", "type": "helix", "inputs": {"turns": 4, "top_radius": 0.2}},)" + sweep, 60}};
}

TEST(SplineField, SamplesEqualTheReference) {
    for (const Case& each : cases()) {
        SCOPED_TRACE(each.name);
        const Program program = programOf(each.nodes);
        std::mt19937 random(5);
        std::uniform_real_distribution<float> unit(-1, 1);
        std::vector<std::array<float, 3>> points;
        for (int i = 0; i < 10'000; ++i) {
            const float scale = i % 8 == 0 ? std::exp2(4 * unit(random) + 4) : 1.2f;
            points.push_back({scale * unit(random), scale * unit(random), scale * unit(random)});
        }
        const auto samples = test::evaluateOnDevice(program, points, 0.01f);
        int off = 0, oblique = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Point p{points[i][0], points[i][1], points[i][2]};
            ValueGradient wanted;
            evaluateGradient(program.ir, program.distance(), {}, std::span(&p, 1), std::span(&wanted, 1));
            const double slack = 2e-5 * (1 + std::abs(p[0]) + std::abs(p[1]) + std::abs(p[2]));
            off += std::abs(samples[i].value - wanted.value) > slack ||
                   std::abs(samples[i].rowValue - wanted.value) > slack;
            ASSERT_LE(samples[i].interval[0], samples[i].value + slack);
            ASSERT_GE(samples[i].interval[1], samples[i].value - slack);
            for (std::size_t axis = 0; axis < 3; ++axis)  // where two places are as near either may be
                oblique += std::abs(samples[i].gradient[axis] - wanted.gradient[axis]) > 2e-2;
        }
        EXPECT_LE(off, each.jumps);
        EXPECT_LT(oblique, 600);
    }
}

double volumeOf(const std::string& nodes, int cells) {
    Result<Device> device = createDevice({});
    EXPECT_TRUE(device);
    Session session(std::move(*device));
    session.setProgram(programOf(nodes));
    const Result<MesherResult> result = session.polygonise({std::nullopt, cells});
    EXPECT_TRUE(result) << (result ? "" : format(result.error()));
    const Mesh mesh = session.download(*result);
    const Report report = reportOnMesh(mesh.positions, mesh.indices);
    EXPECT_EQ(report.boundaryEdges + report.nonManifoldEdges, 0u);
    EXPECT_EQ(report.eulerCharacteristic, 2);
    return report.volume;
}

/// By Pappus' theorem: what is across a spline, times its length, however it bends.
TEST(SplineField, VolumesAreThoseAcrossTimesTheLength) {
    const double length = (*splineOfHelix({.turns = 2}))->length, r = 0.08;
    const std::string helix = R"({"id": "curve", "type": "helix", "inputs": {"turns": 2}},)";
    const double tube = std::numbers::pi * r * r * length;
    EXPECT_NEAR(
        volumeOf(
            helix +
                R"({"id": "solid", "type": "tube", "inputs": {"spline": {"from": "curve"}, "radius": 0.08}})",
            160),
        tube + 4 * std::numbers::pi * r * r * r / 3, 0.01 * tube);
    EXPECT_NEAR(
        volumeOf(helix + R"({"id": "flat", "type": "rectangle", "inputs": {"half_extents": [0.1, 0.06]}},
        {"id": "solid", "type": "sweep", "inputs": {"surface": {"from": "flat"}, "spline": {"from": "curve"}}})",
                 160),
        0.2 * 0.12 * length, 0.01 * 0.2 * 0.12 * length);
}

}  // namespace fw::spline_field_test
