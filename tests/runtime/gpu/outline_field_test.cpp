// Polygons of many corners on the device: samples against the host's, and meshes of known area.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "graph/document/json.h"
#include "graph/evaluate/evaluate.h"
#include "runtime/measure/mesh_report.h"
#include "runtime/play/session.h"
#include "tests/support/device_field.h"
#include "tests/support/gpu.h"

namespace fw::outline_field_test {

/// A wavy ring, and beside it a star that crosses itself, both extruded; metres.
Program outlines(int corners) {
    std::string ring, star;
    for (int i = 0; i < corners; ++i) {
        const double angle = 2 * std::numbers::pi * i / corners, radius = 1 + 0.15 * std::sin(9 * angle);
        ring += (i > 0 ? ", [" : "[") + std::to_string(radius * std::cos(angle)) + ", " +
                std::to_string(radius * std::sin(angle)) + "]";
    }
    for (int i = 0; i < 23; ++i) {
        const double angle = 2 * std::numbers::pi * 9 * i / 23;
        star += (i > 0 ? ", [" : "[") + std::to_string(2 + std::cos(angle)) + ", " +
                std::to_string(std::sin(angle)) + "]";
    }
    const Result<Graph> graph = parseGraph(R"({"fieldwright": 1, "nodes": [
        {"id": "ring", "type": "polygon", "inputs": {"points": [)" +
                                               ring + R"(]}},
        {"id": "star", "type": "polygon", "inputs": {"points": [)" +
                                               star + R"(]}},
        {"id": "both", "type": "union", "inputs": {"a": {"from": "ring"}, "b": {"from": "star"}}},
        {"id": "solid", "type": "extrude", "inputs": {"surface": {"from": "both"}, "half_height": 0.25}},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "solid"}}}]})",
                                           "outlines.field.json", nullptr);
    EXPECT_TRUE(graph) << format(graph.error());
    Result<Program> program = compile(*graph);
    EXPECT_TRUE(program) << format(program.error());
    return std::move(*program);
}

TEST(OutlineField, SamplesEqualTheReference) {
    for (const int corners : {20, 100, 1000}) {
        SCOPED_TRACE(corners);
        const Program program = outlines(corners);
        ASSERT_EQ(program.ir.outlines().size(), 2u);
        std::mt19937 random(5);
        std::uniform_real_distribution<float> unit(-1, 1);
        std::vector<std::array<float, 3>> points;
        for (int i = 0; i < 30'000; ++i) {
            const float scale = i % 8 == 0 ? std::exp2(6 * unit(random) + 6) : 3.0f;
            points.push_back({scale * unit(random), scale * unit(random), unit(random)});
        }
        for (float y = -1.5f; y < 1.5f; y += 0.25f)  // level with corners and edges
            for (float x = -4; x < 4; x += 0.125f) points.push_back({x, y, 0});
        const auto samples = test::evaluateOnDevice(program, points, 0.01f);
        int oblique = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Point p{points[i][0], points[i][1], points[i][2]};
            ValueGradient wanted;
            evaluateGradient(program.ir, program.distance(), {}, std::span(&p, 1), std::span(&wanted, 1));
            const double slack = 2e-6 * (1 + std::abs(p[0]) + std::abs(p[1]));
            ASSERT_NEAR(samples[i].value, wanted.value, slack) << p[0] << " " << p[1];
            ASSERT_NEAR(samples[i].rowValue, wanted.value, slack);
            ASSERT_LE(samples[i].interval[0], wanted.value + slack);
            ASSERT_GE(samples[i].interval[1], wanted.value - slack);
            for (std::size_t axis = 0; axis < 3; ++axis)  // where two edges are as near either may be
                oblique += std::abs(samples[i].gradient[axis] - wanted.gradient[axis]) > 1e-2;
        }
        EXPECT_LT(oblique, 300);
    }
}

TEST(OutlineField, AnExtrudedRingHasItsVolume) {
    Result<Device> device = createDevice({});
    ASSERT_TRUE(device);
    Session session(std::move(*device));
    std::string points;
    double area = 0;
    constexpr int kCorners = 500;
    const auto corner = [](int i) {
        const double angle = 2 * std::numbers::pi * i / kCorners, radius = 1 + 0.15 * std::sin(9 * angle);
        return std::array{radius * std::cos(angle), radius * std::sin(angle)};
    };
    for (int i = 0; i < kCorners; ++i) {
        const auto a = corner(i), b = corner(i + 1);
        area += 0.5 * (a[0] * b[1] - a[1] * b[0]);
        points += (i > 0 ? ", [" : "[") + std::to_string(a[0]) + ", " + std::to_string(a[1]) + "]";
    }
    const Result<Graph> graph = parseGraph(R"({"fieldwright": 1, "nodes": [
        {"id": "ring", "type": "polygon", "inputs": {"points": [)" +
                                               points + R"(]}},
        {"id": "solid", "type": "extrude", "inputs": {"surface": {"from": "ring"}, "half_height": 0.25}},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "solid"}}}]})",
                                           "ring.field.json", nullptr);
    ASSERT_TRUE(graph) << format(graph.error());
    Result<Program> program = compile(*graph);
    ASSERT_TRUE(program) << format(program.error());
    session.setProgram(std::move(*program));
    EXPECT_FALSE(session.byTapes());
    const Result<MesherResult> result = session.polygonise({std::nullopt, 128});
    ASSERT_TRUE(result) << format(result.error());
    const Mesh mesh = session.download(*result);
    const Report report = reportOnMesh(mesh.positions, mesh.indices);
    EXPECT_EQ(report.boundaryEdges + report.nonManifoldEdges, 0u);
    EXPECT_EQ(report.eulerCharacteristic, 2);
    EXPECT_NEAR(report.volume, 0.5 * area, 0.005 * area);
}

}  // namespace fw::outline_field_test
