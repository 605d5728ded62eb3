// Pictures of fields with many members: lists for boxes of space leave every pixel as it is.
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <random>

#include "graph/document/json.h"
#include "runtime/play/session.h"
#include "tests/support/gpu.h"
#include "tests/support/graph/expression_graph.h"

namespace fw::places_test {

/// Balls that blend into a slab and into one another, among sharp boxes, and round holes in all of it.
std::string manyShapes() {
    std::mt19937 random(5);
    const auto next = [&](float lo, float hi) {
        return std::to_string(lo + (hi - lo) * float(random() >> 8) / float(1 << 24));
    };
    const auto place = [&] {
        return "p - vec3(" + next(-1, 1) + ", " + next(-1, 1) + ", " + next(-1, 1) + ")";
    };
    std::string code = "d = box(p - vec3(0, -1.1, 0), vec3(1.1, 0.1, 1.1), 0.02).distance;\n";
    for (int i = 0; i < 24; ++i)
        code += "d = smooth_min(d, length(" + place() + ") - " + next(0.04f, 0.1f) + ", 0.05);\n";
    for (int i = 0; i < 24; ++i)
        code += "d = min(d, box(" + place() + ", vec3(" + next(0.02f, 0.1f) + "), 0.01).distance);\n";
    for (int i = 0; i < 24; ++i) code += "d = max(d, " + next(0.03f, 0.1f) + " - length(" + place() + "));\n";
    return code + "return d;";
}

Device validatedDevice() {
    Result<Device> device = createDevice({.validation = true});
    if (!device) throw SystemError(format(device.error()));
    return std::move(*device);
}

/// As it is drawn, and the ground truth.
std::array<Picture, 2> picturesOf(const Program& program, RenderOptions options) {
    Session session(validatedDevice());
    session.setProgram(program);
    const Result<MesherResult> mesh = session.polygonise({{}, 48});
    if (!mesh) throw SystemError(format(mesh.error()));
    std::array<Picture, 2> pictures;
    for (const bool reference : {false, true}) {
        options.reference = reference;
        pictures[reference] = *session.render(*mesh, options);
    }
    EXPECT_EQ(session.device().validationMessages(), std::vector<std::string>());
    return pictures;
}

TEST(Places, PicturesAreThoseOfStraightCode) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "half a minute: with FIELDWRIGHT_LONG";
    const Result<Program> program = compile(test::expressionGraph(manyShapes()));
    ASSERT_TRUE(program) << format(program.error());
    ASSERT_GE(program->families.all.size(), 3u);
    Program straight = *program;
    straight.families = {};
    RenderOptions options{.width = 128, .height = 80, .samples = 2};
    options.scene.lights = {{.position = {1, 1.6, 1.2}, .size = 0.2}};
    const std::array listed = picturesOf(*program, options), all = picturesOf(straight, options);
    for (int i = 0; i < 2; ++i) {
        const std::vector<uint8_t>&a = listed[i].pixels, &b = all[i].pixels;
        ASSERT_EQ(a.size(), b.size());
        // The two are different code: rounding may differ.
        std::size_t unlike = 0;
        for (std::size_t at = 0; at < a.size(); ++at) unlike += std::abs(a[at] - b[at]) > 2;
        EXPECT_EQ(unlike, 0u) << (i == 0 ? "picture" : "reference");
    }
}

TEST(Places, ListsFollowTheFieldThatMoves) {
    std::string code = "d = 10.0;";
    for (int i = 0; i < 60; ++i)
        code += " d = min(d, length(p - vec3(" + std::to_string(0.05 * i - 1.5) + ", " +
                std::to_string(0.02 * (i % 7)) + ", " + std::to_string(0.1 * (i % 11) - 0.5) + ")) - 0.04);";
    const Result<Graph> graph = parseGraph(R"({"fieldwright": 1, "nodes": [
        {"id": "many", "type": "expression", "code": ")" +
                                               code + R"( return d;"},
        {"id": "moved", "type": "translate", "inputs": {"surface": {"from": "many"}, "offset": [0, 0, 0]}},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "moved"}}}]})",
                                           "", nullptr);
    ASSERT_TRUE(graph) << format(graph.error());
    const Result<Program> program = compile(*graph, {.live = {"moved.offset"}});
    ASSERT_TRUE(program) << format(program.error());
    ASSERT_FALSE(program->families.empty());
    const RenderOptions options{.width = 96, .height = 64, .samples = 1};
    const auto draw = [&](bool before) {
        Session session(validatedDevice());
        session.setProgram(*program);
        const auto picture = [&] {
            return *session.render(*session.polygonise({Box{{-3, -1, -2}, {3, 1, 2}}, 64}), options);
        };
        const Picture still = before ? picture() : Picture{};
        session.setParameter(0, 1.5);
        Picture moved = picture();
        EXPECT_NE(still.pixels, moved.pixels);
        return moved;
    };
    EXPECT_EQ(draw(true).pixels, draw(false).pixels);
}

}  // namespace fw::places_test
