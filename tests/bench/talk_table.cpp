// The table of the slide "Performance": what a mesh costs to make, and what each further pass over it costs.
#include <cstddef>

#include "graph/emit/glsl.h"
#include "runtime/mesher/mesher.h"
#include "tests/bench/baseline.h"
#include "tests/bench/tables.h"
#include "tests/bench/talk_stages.h"
#include "tests/bench/verify.h"

namespace fw::bench {
namespace {

struct Row {
    std::string name, slide;
    Figure generate, pass;
};

double sumOf(const std::vector<StageTime>& stages) {
    double sum = 0;
    for (const StageTime& stage : stages) sum += stage.milliseconds;
    return sum;
}

/// ms on the device for what `record` records.
template <class Record>
Figure timeOf(Bench& bench, Record&& record) {
    return measure(bench.options.repeats, [&] {
        Commands commands(bench.device(), true);
        record(commands);
        submit(commands);
        return sumOf(commands.stages);
    });
}

const char* wayName(TalkWay way) {
    switch (way) {
        case TalkWay::everyCell: return "geometry shader over every cell";
        case TalkWay::compactedCells: return "geometry shader over compacted cells";
        default: return "compute, indexed, dense grid";
    }
}

/// Cells along an edge of the slide's grid, and its figures on a GeForce 570.
constexpr int kSlideCells = 128;
const char* slideOf(TalkWay way) {
    switch (way) {
        case TalkWay::everyCell: return "11 a pass";
        case TalkWay::compactedCells: return "5 a pass";
        default: return "2 + 0.4 a pass";
    }
}

void talkTableAt(Bench& bench, int cells) {
    const std::optional<Program> program = benchProgram(bench, Field::tower);
    if (!program) return;
    const std::string field = emitField(*program);
    const float half = regionHalf(Field::tower);
    Baseline baseline(cells);
    baseline.run(Field::tower);
    const uint64_t triangles = baseline.indices().size() / 3;

    const TalkStages talk = createTalkStages(bench.device(), {.cells = cells, .half = half, .field = field});
    std::vector<Row> rows;
    for (TalkWay way : kTalkWays) {
        const Mesh mesh = captureMesh(talk, way);
        if (mesh.triangleCount() != triangles)
            bench.fail(std::string(wayName(way)) + ": " + count(mesh.triangleCount()) +
                       " triangles, the baseline has " + count(triangles));
        if (way == TalkWay::indexed)
            if (const std::string fault = faultOf(mesh.indices, mesh.positions.size()); !fault.empty())
                bench.fail(std::string(wayName(way)) + ": " + fault);
        Row row{wayName(way), cells == kSlideCells ? slideOf(way) : "–", {}, {}};
        row.generate = timeOf(bench, [&](Commands& commands) { recordGeneration(commands, talk, way); });
        row.pass = timeOf(bench, [&](Commands& commands) { recordPass(commands, talk, way); });
        rows.push_back(std::move(row));
    }

    MesherPipelines pipelines = createMesherPipelines(bench.device(), field);
    const Pipeline pass = createMeshPass(bench.device(), sizeof(gpu::MeshVertex) / sizeof(float));
    MesherBuffers buffers;
    const MesherConfig config{.origin = glm::vec3(-half),
                              .cellSize = glm::vec3(2 * half / float(cells)),
                              .cells = glm::ivec3(cells)};
    Row ours{"ours: sparse bricks, indexed", "–", {}, {}};
    ours.generate = measure(bench.options.repeats, [&] {
        const auto start = Clock::now();
        const Result<MesherResult> result = runMesher(bench.device(), pipelines, buffers, config);
        finish(bench.device());
        const double elapsed = millisecondsSince(start);
        if (!result) throw SystemError(result.error().message);
        if (result->triangles != triangles) bench.fail("ours: " + count(result->triangles) + " triangles");
        return elapsed;
    });
    ours.pass = timeOf(bench, [&](Commands& commands) {
        recordMeshPass(commands, talk, pass, buffers.vertices, buffers.triangles, buffers.counts,
                       offsetof(gpu::MesherCounts, draw));
    });
    rows.push_back(ours);

    Table table{.title = "The talk's stages, " + std::to_string(cells) + "³ cells, tower (ms)",
                .header = {"way", "the slide", "to generate", "a further pass", "first pass, ours faster by",
                           "six passes, ours faster by"}};
    const auto cost = [](const Row& row, int passes) {
        return row.generate.median() + passes * row.pass.median();
    };
    for (const Row& row : rows)
        table.rows.push_back({row.name, row.slide, text(row.generate), text(row.pass),
                              number(cost(row, 1) / cost(ours, 1)), number(cost(row, 6) / cost(ours, 6))});
    const bool order = cost(rows[0], 1) > cost(rows[1], 1) && rows[1].pass.median() > rows[2].pass.median();
    table.notes = {
        "The slide: 128³ cells on a GeForce 570, its own scene. To generate includes sampling the field; the "
        "geometry "
        "shader ways make triangles anew in every pass. A pass keeps depth alone, 1024 x 1024.",
        "All four draw the same " + count(triangles) + " triangles (checked). Ours writes normals too.",
        std::string("Same order as the slide's (every cell > compacted > indexed, a pass): ") +
            (order ? "yes." : "no.")};
    print(table, bench.options.markdown);
}

}  // namespace

void talkTable(Bench& bench) {
    if (!bench.device().has.geometryShader) {
        std::printf("The talk's stages are left out: the device has no geometry shaders.\n\n");
        return;
    }
    for (int cells : bench.sizes({kSlideCells})) {
        if (std::has_single_bit(unsigned(cells)) && cells <= 256)
            talkTableAt(bench, cells);
        else
            std::printf("The talk's stages are left out at %d cells: powers of two up to 256 only.\n\n",
                        cells);
    }
}

}  // namespace fw::bench
