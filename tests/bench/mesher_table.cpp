// Our mesher beside the plain C++ baseline and a tuned program, and how far each of its stages is from what
// the device can do.
#include <fstream>
#include <map>

#include "graph/emit/glsl.h"
#include "runtime/mesher/mesher.h"
#include "runtime/stages/mesh_stages.h"
#include "tests/bench/baseline.h"
#include "tests/bench/peaks.h"
#include "tests/bench/tables.h"
#include "tests/bench/tuned.h"
#include "tests/bench/verify.h"

namespace fw::bench {
namespace {

/// How many times faster than the baseline the tower must be.
constexpr std::pair<int, double> kWanted[] = {{128, 1.6}, {256, 8}, {512, 12}};
/// How many times as long as the tuned program a field may take, at these cells.
constexpr int kTunedCells = 256;
constexpr double mostOfTuned(Field field) {
    return field == Field::tower || field == Field::csg ? 1.25 : 1.5;
}
/// Greatest growth of our time on the tower from 256 to 1024 cells.
constexpr double kMostGrowth = 20;

/// From this size on the baseline takes seconds a run, and counts fewer of them.
constexpr int kLongRun = 1024;

double availableMemory() {
    std::ifstream file("/proc/meminfo");
    for (std::string line; std::getline(file, line);)
        if (line.starts_with("MemAvailable:")) return 1024 * std::strtod(line.c_str() + 13, nullptr);
    return 0;
}

/// Adds the row of a field beside the tuned program, whose mesh must be as sound and as large as ours.
void addTuned(Bench& bench, Table& table, Field field, int cells, const MesherResult& mesh,
              const Figure& ours) {
    Tuned tuned(cells);
    const Figure theirs = measure(bench.options.repeats, [&] { return tuned.run(field); });
    const std::string name = "tuned, " + std::string(fieldName(field)) + " at " + std::to_string(cells);
    if (const std::string fault = faultOf(tuned.indices(), tuned.positions().size()); !fault.empty())
        bench.fail(name + ": " + fault);
    const double triangles = double(tuned.indices().size() / 3), expected = double(mesh.triangles);
    if (std::abs(triangles - expected) > (field == Field::gyroid ? 1e-4 : 0) * expected)
        bench.fail(name + ": " + count(uint64_t(triangles)) + " triangles, ours " + count(mesh.triangles));
    const double part = ours.median() / theirs.median();
    table.rows.push_back(
        {std::string(fieldName(field)), std::to_string(cells), text(theirs), text(ours), number(part)});
    if (cells == kTunedCells)
        table.notes.push_back(std::string(fieldName(field)) + " at " + std::to_string(cells) + ": at most " +
                              number(mostOfTuned(field)) + " times the tuned program wanted, " +
                              (part <= mostOfTuned(field) ? "met" : "missed") + " (" + number(part) + ").");
}

struct Ours {
    MesherResult result;
    Figure total;                                        ///< ms, field and mesh in device memory
    std::vector<std::pair<std::string, Figure>> stages;  ///< ms each, submitted one by one
};

/// Meshes the field, checks the mesh against what is expected of it, and times it.
std::optional<Ours> timeMesher(Bench& bench, MesherPipelines& pipelines, MesherBuffers& buffers, Field field,
                               int cells, MeshMethod method, std::vector<std::string>& refusals) {
    MesherConfig config{.origin = glm::vec3(-regionHalf(field)),
                        .cellSize = glm::vec3(2 * regionHalf(field) / float(cells)),
                        .cells = glm::ivec3(cells),
                        .method = method};
    const std::string name = std::string(fieldName(field)) + " at " + std::to_string(cells);
    const auto run = [&] {
        Result<MesherResult> result = runMesher(bench.device(), pipelines, buffers, config);
        finish(bench.device());
        if (!result) throw SystemError(name + ": " + result.error().message);
        return std::move(*result);
    };
    Ours ours;
    const Result<MesherResult> first = runMesher(bench.device(), pipelines, buffers, config);
    if (!first) return refusals.push_back(name + ": " + first.error().message + "."), std::nullopt;
    ours.result = *first;
    {
        const Mesh mesh = downloadMesh(bench.device(), buffers, ours.result);
        if (const std::string fault = faultOf(mesh.indices, mesh.positions.size()); !fault.empty())
            return bench.fail(name + ": " + fault), std::nullopt;
    }
    ours.total = measure(bench.options.repeats, [&] {
        const auto start = Clock::now();
        run();
        return millisecondsSince(start);
    });
    config.timed = true;
    for (int i = 0; i < bench.options.repeats; i++) {
        const std::vector<StageTime> stages = run().stages;
        ours.stages.resize(stages.size());
        for (std::size_t s = 0; s < stages.size(); s++) {
            ours.stages[s].first = stages[s].name;
            ours.stages[s].second.runs.push_back(stages[s].milliseconds);
        }
    }
    for (auto& [stage, figure] : ours.stages) std::ranges::sort(figure.runs);
    return ours;
}

/// Adds the row of the stages' medians; the first one gives the header.
void addStages(Table& table, Field field, int cells, const Ours& ours) {
    std::vector<std::string> row = {std::string(fieldName(field)), std::to_string(cells)};
    if (table.header.size() == 2)
        for (const auto& [stage, figure] : ours.stages) table.header.push_back(stage);
    for (const auto& [stage, figure] : ours.stages) row.push_back(number(figure.median()));
    table.rows.push_back(row);
}

/// Operations of a field: all of them, and those of sampling a brick's 9 planes of 9 rows of 9 samples, where
/// what does not change along a row or a plane is computed once for it.
struct FieldOperations {
    double all = 0, brick = 0;
};

FieldOperations operationsOf(const Program& program) {
    std::array<IrId, 1> root = {program.distance()};
    const Ir field = program.ir.compact(root);
    FieldOperations operations;
    for (IrId id = 0; id < field.size(); id++) {
        if (opInfo(field[id].op).arity == 0) continue;
        const int positions = field[id].positions;
        operations.all += 1;
        operations.brick += positions & dependsOnY ? 729 : positions & dependsOnX ? 81 : 9;
    }
    return operations;
}

/// The least that a stage must do, whatever its method: bytes it reads and writes, and operations of the
/// field. What it also does in integers is not counted.
struct Work {
    double bytes = 0, operations = 0;
};

Work leastWork(const std::string& stage, const MesherResult& mesh, double gridBricks, FieldOperations field) {
    const double bricks = mesh.bricks, vertices = mesh.vertices, triangles = mesh.triangles;
    const double rows = gridBricks, planes = bricks * 9 * 12, lookup = bricks * 16 * 16;
    if (stage == "cull") return {rows, gridBricks * 2 * field.all};
    if (stage == "compact") return {rows + bricks * 36, 0};
    if (stage == "sample") return {planes, bricks * field.brick};
    if (stage == "connect") return {planes + 12 * triangles + 4 * vertices, 0};
    if (stage == "classify") return {planes + lookup, 0};
    if (stage == "triangles") return {planes + lookup + 12 * triangles + 4 * vertices, 0};
    // Two evaluations find the root and one component of the gradient, two the others, each with a
    // derivative.
    if (stage == "vertices") return {20 * vertices, vertices * 4 * 2 * field.all};
    return {};
}

/// Cells of the meshes that stages are timed on, and the most that one may take of the time to make the mesh.
constexpr int kStageCells = 256;
constexpr double kMostOfMaking = 0.5;
constexpr const char* kStageNames[] = {"sort", "smooth", "normals", "subdivide", "project"};

/// Times one iteration of smoothing and one level of subdivision, each with what it needs, and adds the
/// field's rows; `making` is the time of the mesh itself.
void addMeshStages(Bench& bench, Table& table, Field field, const Program& program,
                   MesherPipelines& pipelines, const Figure& making) {
    const MesherConfig config{.origin = glm::vec3(-regionHalf(field)),
                              .cellSize = glm::vec3(2 * regionHalf(field) / float(kStageCells)),
                              .cells = glm::ivec3(kStageCells)};
    MeshStagePipelines stagePipelines = createMeshStagePipelines(bench.device());
    stagePipelines.project = createProjection(bench.device(), emitField(program));
    const MeshStageConfig stageConfig{.pipelines = &stagePipelines,
                                      .lo = glm::vec3(-regionHalf(field)),
                                      .hi = glm::vec3(regionHalf(field)),
                                      .timed = true};
    const MeshStage smooth{.kind = MeshStage::Kind::smooth}, subdivide{.kind = MeshStage::Kind::subdivide};
    MesherBuffers buffers;
    MeshStageBuffers stageBuffers;
    std::map<std::string, Figure> figures;
    MesherResult made;
    for (int run = -1; run < bench.options.repeats; run++)
        for (const MeshStage& stage : {smooth, subdivide}) {
            const Result<MesherResult> meshed = runMesher(bench.device(), pipelines, buffers, config);
            finish(bench.device());
            if (!meshed) return bench.fail(meshed.error().message);
            made = *meshed;
            MesherResult changed = made;
            const Done ran =
                runMeshStages(bench.device(), stageBuffers, buffers, changed, {&stage, 1}, stageConfig);
            if (!ran)
                return table.notes.push_back(std::string(fieldName(field)) + ": " + ran.error().message +
                                             ".");
            if (run < 0) {  // to warm up, and to be checked
                const Mesh mesh = downloadMesh(bench.device(), buffers, changed);
                if (const std::string fault = faultOf(mesh.indices, mesh.positions.size()); !fault.empty())
                    return bench.fail(std::string(fieldName(field)) + ", changed: " + fault);
                continue;
            }
            for (const StageTime& time : changed.stages)
                if (stage.kind == MeshStage::Kind::smooth || time.name == "subdivide" ||
                    time.name == "project")
                    figures[time.name].runs.push_back(time.milliseconds);
        }
    for (const char* name : kStageNames) {
        Figure& figure = figures[name];
        std::ranges::sort(figure.runs);
        const double part = figure.median() / making.median();
        table.rows.push_back({std::string(fieldName(field)), count(made.triangles), text(making), name,
                              text(figure), number(part), part <= kMostOfMaking ? "met" : "missed"});
    }
}

}  // namespace

void mesherTable(Bench& bench) {
    Table speed{.title = "Field to mesh, beside the plain C++ baseline (ms)",
                .header = {"field", "cells", "vertices", "triangles", "baseline", "ours", "times faster"}};
    Table limit{.title = "Beside the tuned C++ program (ms)",
                .header = {"field", "cells", "tuned", "ours", "times that"}};
    Table stages{.title = "Where the mesher's time goes (ms, each stage submitted and awaited by itself)",
                 .header = {"field", "cells"}};
    Table peak{.title = "The mesher's stages and the device's peaks (tower)",
               .header = {"stage", "cells", "ms", "least MB", "least 10⁶ operations", "ms at the peaks",
                          "times that"}};
    Table dual{.title = "Dual contouring: sharp edges (ms)",
               .header = {"field", "cells", "vertices", "triangles", "pinches", "ours", "of the baseline",
                          "of marching cubes"}};
    Table dualStages{.title = "Where dual contouring's time goes (ms, likewise)",
                     .header = {"field", "cells"}};
    Table meshStages{.title = "What is done to a mesh afterwards, at 256 cells (ms, likewise)",
                     .header = {"field", "triangles", "making the mesh", "stage", "ms", "of making",
                                "at most " + number(kMostOfMaking)}};
    const Peaks peaks = measurePeaks(bench.device(), bench.options.repeats);
    double tower256 = 0;
    bool everAhead = true;

    for (Field field : kFields) {
        const std::optional<Program> program = benchProgram(bench, field);
        if (!program) continue;
        MesherPipelines pipelines = createMesherPipelines(bench.device(), emitField(*program));
        for (int cells : bench.sizes({128, 256, 512, 1024})) {
            const std::string name = std::string(fieldName(field)) + " at " + std::to_string(cells);
            const double side = cells + 1;
            std::optional<Figure> theirs;
            uint64_t expectedVertices = 0, expectedTriangles = 0;
            if (cells < kLongRun || availableMemory() > 16 * side * side * side) {
                Baseline baseline(cells);
                const int repeats =
                    cells < kLongRun ? bench.options.repeats : std::min(bench.options.repeats, 3);
                theirs = measure(repeats, [&] { return baseline.run(field).totalMs(); });
                expectedVertices = baseline.positions().size();
                expectedTriangles = baseline.indices().size() / 3;
                if (const std::string fault = faultOf(baseline.indices(), expectedVertices); !fault.empty())
                    bench.fail("baseline, " + name + ": " + fault);
            }
            MesherBuffers buffers;
            const std::optional<Ours> ours =
                timeMesher(bench, pipelines, buffers, field, cells, MeshMethod::marchingCubes, speed.notes);
            if (!ours) continue;
            if (theirs) {
                // Samples whose sign hangs on the last bit of a sine may fall either way.
                const double off = std::abs(double(ours->result.triangles) - double(expectedTriangles));
                if (field == Field::gyroid ? off > 1e-4 * double(expectedTriangles)
                                           : off > 0 || ours->result.vertices != expectedVertices)
                    bench.fail(name + ": the baseline has " + count(expectedVertices) + " vertices and " +
                               count(expectedTriangles) + " triangles, ours " + count(ours->result.vertices) +
                               " and " + count(ours->result.triangles));
            }
            const double ratio = theirs ? theirs->median() / ours->total.median() : 0;
            everAhead = everAhead && (!theirs || ratio > 1);
            speed.rows.push_back({std::string(fieldName(field)), std::to_string(cells),
                                  count(ours->result.vertices), count(ours->result.triangles),
                                  theirs ? text(*theirs) : "–", text(ours->total),
                                  theirs ? number(ratio) : "–"});
            addTuned(bench, limit, field, cells, ours->result, ours->total);
            addStages(stages, field, cells, *ours);
            if (cells == kStageCells)
                addMeshStages(bench, meshStages, field, *program, pipelines, ours->total);
            if (const std::optional<Ours> sharp = timeMesher(bench, pipelines, buffers, field, cells,
                                                             MeshMethod::dualContouring, dual.notes)) {
                const double part = theirs ? sharp->total.median() / theirs->median() : 0;
                dual.rows.push_back(
                    {std::string(fieldName(field)), std::to_string(cells), count(sharp->result.vertices),
                     count(sharp->result.triangles), count(sharp->result.pinches), text(sharp->total),
                     theirs ? number(part) : "–", number(sharp->total.median() / ours->total.median())});
                addStages(dualStages, field, cells, *sharp);
                if (cells == 256 && theirs) {
                    const double most = field == Field::tower ? 0.6 : 1.0;
                    dual.notes.push_back(std::string(fieldName(field)) + " at 256: at most " + number(most) +
                                         " of the baseline wanted, " + (part <= most ? "met" : "missed") +
                                         " (" + number(part) + ").");
                }
            }

            if (field != Field::tower) continue;
            for (const auto& [size, factor] : kWanted)
                if (size == cells && theirs)
                    speed.notes.push_back("Tower at " + std::to_string(cells) + ": at least " +
                                          number(factor) + " times as fast as the baseline wanted, " +
                                          (ratio >= factor ? "met" : "missed") + " (" + number(ratio) + ").");
            if (cells == 256) tower256 = ours->total.median();
            if (cells == 1024 && tower256 > 0) {
                const double growth = ours->total.median() / tower256;
                speed.notes.push_back("Tower from 256 to 1024 cells: " + number(growth) +
                                      " times the time, at most " + number(kMostGrowth) + " wanted, " +
                                      (growth <= kMostGrowth ? "met" : "missed") + ".");
            }
            const FieldOperations operations = operationsOf(*program);
            const double bricks = std::pow(std::ceil(double(cells + 2) / 8), 3);
            for (const auto& [stage, figure] : ours->stages) {
                const Work work = leastWork(stage, ours->result, bricks, operations);
                const double best = std::max(work.bytes / peaks.gigabytes.median(),
                                             work.operations / peaks.gigaflops.median()) *
                                    1e-6;
                peak.rows.push_back({stage, std::to_string(cells), number(figure.median()),
                                     number(work.bytes * 1e-6), number(work.operations * 1e-6), number(best),
                                     number(figure.median() / best)});
            }
        }
    }
    speed.notes.push_back(std::string("Ahead of the baseline on every row: ") + (everAhead ? "yes" : "no") +
                          ".");
    speed.notes.push_back(
        "Ours is the wall clock from the call to its return, the counts read back; every mesh was checked to "
        "be closed "
        "and oriented, and its counts to equal the baseline's (gyroid: within 0.01 %). The baseline makes no "
        "normals, ours does.");
    peak.notes = {"Measured in this run: " + text(peaks.gigaflops) + " · 10⁹ floating-point operations/s, " +
                      text(peaks.gigabytes) + " · 10⁹ bytes/s copied between buffers.",
                  "The least work counts the bytes that must pass between stages and the field's operations "
                  "(each as one, at the "
                  "multiply-add rate), and no integer or bit operations, of which the stages classify and "
                  "triangles consist."};
    limit.notes.push_back(
        "Tuned: planes streamed through the cache, signs as bits, -O3 -march=native -ffast-math, two "
        "threads, no "
        "normals (tests/bench/tuned.h).");
    print(speed, bench.options.markdown);
    print(limit, bench.options.markdown);
    print(stages, bench.options.markdown);
    print(dual, bench.options.markdown);
    print(dualStages, bench.options.markdown);
    print(peak, bench.options.markdown);
    print(meshStages, bench.options.markdown);
}

}  // namespace fw::bench
