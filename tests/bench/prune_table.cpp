// Many shapes: what a thousand scattered boxes cost beside their densest neighbourhood, blended into one
// another, and compiled as straight code.
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <random>

#include "graph/emit/glsl.h"
#include "runtime/mesher/mesher.h"
#include "runtime/play/session.h"
#include "tests/bench/tables.h"
#include "tests/bench/verify.h"
#include "tests/support/graph/expression_graph.h"

namespace fw::bench {
namespace {

constexpr int kShapes = 1000, kNearest = 50;
constexpr double kLeastGain = 10, kMostShare = 4;  // over straight code; of the nearest shapes' time

struct Shape {
    glm::vec3 centre, half;
};

std::vector<Shape> scattered() {
    std::mt19937 random(7);
    const auto between = [&](float lo, float hi) {
        return lo + (hi - lo) * float(random() >> 8) / float(1 << 24);
    };
    std::vector<Shape> shapes(kShapes);
    for (Shape& shape : shapes)
        for (int i = 0; i < 3; ++i) shape.centre[i] = between(-1, 1), shape.half[i] = between(0.02f, 0.06f);
    return shapes;
}

/// Those that are nearest one another.
std::vector<Shape> densest(const std::vector<Shape>& shapes) {
    std::vector<Shape> best;
    float reach = 1e30f;
    for (const Shape& shape : shapes) {
        const auto away = [&](const Shape& other) { return glm::distance(other.centre, shape.centre); };
        std::vector<Shape> near = shapes;
        std::ranges::nth_element(near, near.begin() + kNearest - 1, {}, away);
        if (away(near[kNearest - 1]) >= reach) continue;
        reach = away(near[kNearest - 1]);
        near.resize(kNearest);
        best = near;
    }
    return best;
}

enum class BallsWay { sharp, blended, straight };

std::optional<Program> unionOf(Bench& bench, const std::vector<Shape>& shapes, BallsWay way) {
    std::string code = "d = 1000.0;\n";
    const auto vector = [](glm::vec3 v) {
        return "vec3(" + std::to_string(v.x) + ", " + std::to_string(v.y) + ", " + std::to_string(v.z) + ")";
    };
    for (const Shape& shape : shapes)
        code += std::string(way == BallsWay::blended ? "d = smooth_min(d, box(p - " : "d = min(d, box(p - ") +
                vector(shape.centre) + ", " + vector(shape.half) + ", 0.01).distance" +
                (way == BallsWay::blended ? ", 0.02);\n" : ");\n");
    Result<Program> program = compile(test::expressionGraph(code + "return d;"));
    if (!program) return bench.fail(format(program.error())), std::nullopt;
    if (way == BallsWay::straight) program->families = {};
    return std::move(*program);
}

/// Frames of a picture: what the 1000 cost beside the 50, and those beside straight code for them.
void picturesTable(Bench& bench, const std::vector<Shape>& all, const std::vector<Shape>& near) {
    Table table{.title = "Many shapes: a frame, 480 x 270, 16 rays of ambient occlusion a pixel (ms)",
                .header = {"shapes", "frame"}};
    const auto time = [&](const char* name, const std::vector<Shape>& shapes, BallsWay way) -> double {
        std::optional<Program> program = unionOf(bench, shapes, way);
        if (!program) return 0;
        Result<Device> device = createDevice({.pick = bench.options.device});
        if (!device) return bench.fail(format(device.error())), 0;
        Session session(std::move(*device));
        session.setProgram(std::move(*program));
        const Result<MesherResult> mesh = session.polygonise({.region = {}, .resolution = 128});
        if (!mesh) return bench.fail(format(mesh.error())), 0;
        const Figure frame = measure(bench.options.repeats, [&] {
            const auto start = Clock::now();
            const Result<Picture> picture =
                session.render(*mesh, {.width = 480, .height = 270, .samples = 1});
            if (!picture) throw SystemError(picture.error().message);
            return millisecondsSince(start);
        });
        table.rows.push_back({name, text(frame)});
        return frame.median();
    };
    const double straight = time("nearest 50, straight code", near, BallsWay::straight),
                 few = time("nearest 50", near, BallsWay::sharp), many = time("1000", all, BallsWay::sharp),
                 blended = time("1000, blended", all, BallsWay::blended);
    if (straight <= 0 || few <= 0 || many <= 0 || blended <= 0) return;
    table.notes.push_back("Straight code takes " + number(straight / few) +
                          " times as long for the 50; the " + "thousand take " + number(many / few) +
                          " times as long as the 50, blended " + number(blended / few) + " times.");
    print(table, bench.options.markdown);
}

}  // namespace

void pruneTable(Bench& bench) {
    const std::vector<Shape> all = scattered(), near = densest(all);
    Table table{.title = "Many shapes: rounded boxes in a union (ms)",
                .header = {"shapes", "cells", "triangles", "all"}};
    for (int cells : bench.sizes({128, 256, 512})) {
        const auto time = [&](const char* name, const std::vector<Shape>& shapes, BallsWay way) -> double {
            const bool straight = way == BallsWay::straight;
            std::optional<Program> program = unionOf(bench, shapes, way);
            if (!program) return 0;
            glm::vec3 low(1e30f), high(-1e30f);
            for (const Shape& shape : shapes)
                low = glm::min(low, shape.centre - shape.half),
                high = glm::max(high, shape.centre + shape.half);
            const glm::vec3 size = high - low;
            const float cell = std::max({size.x, size.y, size.z}) / float(cells - 4);
            MesherConfig config{.origin = low - 2 * cell,
                                .cellSize = glm::vec3(cell),
                                .cells = glm::min(glm::ivec3(size / cell) + 5, glm::ivec3(cells)),
                                .families = &program->families};
            MesherPipelines pipelines = createMesherPipelines(bench.device(), emitField(*program));
            MesherBuffers buffers;
            MesherResult result;
            const auto run = [&] {
                const auto start = Clock::now();
                Result<MesherResult> made = runMesher(bench.device(), pipelines, buffers, config);
                finish(bench.device());
                if (!made) throw SystemError(made.error().message);
                result = std::move(*made);
                return millisecondsSince(start);
            };
            const Figure total = measure(straight ? 1 : bench.options.repeats, run);
            const Mesh mesh = downloadMesh(bench.device(), buffers, result);
            if (const std::string fault = faultOf(mesh.indices, mesh.positions.size()); !fault.empty())
                bench.fail(std::string(name) + ": " + fault);
            config.timed = true;
            run();
            std::vector<std::string> row{name, std::to_string(cells), count(result.triangles), text(total)};
            for (const StageTime& stage : result.stages) {
                if (table.rows.empty()) table.header.push_back(stage.name);
                row.push_back(number(stage.milliseconds));
            }
            if (straight) row.insert(row.begin() + 6, "–");  // nothing is pruned
            table.rows.push_back(std::move(row));
            return total.median();
        };
        const double few = time("nearest 50", near, BallsWay::sharp),
                     many = time("1000", all, BallsWay::sharp),
                     blended = time("1000, blended", all, BallsWay::blended);
        if (few <= 0 || many <= 0 || blended <= 0) return;
        const double share = many / few;
        table.notes.push_back("At " + std::to_string(cells) + " the thousand take " + number(share) +
                              " times as long as the 50 that are nearest one another" +
                              (cells != 256 ? "."
                                            : std::string(", at most ") + number(kMostShare) + " wanted, " +
                                                  (share <= kMostShare ? "met." : "missed.")));
        table.notes.push_back("Blended over 0.02 they take " + number(blended / many) + " times as long.");
        if (cells != 256) continue;
        const double straight = time("1000, straight code", all, BallsWay::straight), gain = straight / many;
        table.notes.push_back("Straight code takes " + number(gain) + " times as long, at least " +
                              number(kLeastGain) + " wanted, " + (gain >= kLeastGain ? "met." : "missed."));
    }
    print(table, bench.options.markdown);
    picturesTable(bench, all, near);
}

}  // namespace fw::bench
