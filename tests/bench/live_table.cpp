// Edits: what a changed parameter costs if it is live, and what a changed structure costs.
#include <cmath>
#include <random>

#include "graph/check/typed_parameter.h"
#include "graph/document/json.h"
#include "graph/document/named_parameters.h"
#include "graph/emit/glsl.h"
#include "runtime/mesher/host.h"
#include "runtime/mesher/mesher.h"
#include "runtime/play/player.h"
#include "tests/bench/tables.h"
#include "tests/bench/verify.h"

namespace fw::bench {
namespace {

constexpr int kCells = 128;
constexpr double kMostLiveMs = 8, kMostStructureMs = 150;
constexpr int kStructureNodes = 200;

/// Meshes and checks; ms of the run.
double meshOnce(Bench& bench, MesherPipelines& pipelines, MesherBuffers& buffers, const MesherConfig& config,
                MesherResult& result) {
    const auto start = Clock::now();
    Result<MesherResult> made = runMesher(bench.device(), pipelines, buffers, config);
    finish(bench.device());
    const double elapsed = millisecondsSince(start);
    if (!made) throw SystemError(made.error().message);
    result = std::move(*made);
    return elapsed;
}

void checkMesh(Bench& bench, const char* what, const MesherBuffers& buffers, const MesherResult& result) {
    const Mesh mesh = downloadMesh(bench.device(), buffers, result);
    if (const std::string fault = faultOf(mesh.indices, mesh.positions.size()); !fault.empty())
        bench.fail(std::string(what) + ": " + fault);
}

/// What the device is asked for in a frame of what is played.
void playedTable(Bench& bench) {
    Table table{.title = "A frame that is played, a tenth of a second on (640x360, 64 cells)",
                .header = {"sample", "ms", "submissions", "awaited"}};
    constexpr int kPlayedFrames = 12;
    for (const char* sample : {"dam_break", "fountain", "moving_booleans"}) {
        PlayerOptions options{.device = bench.options.device, .resolution = 64};
        Result<Player> player = Player::open(benchSample(sample), options);
        if (!player) return bench.fail(format(player.error()));
        const RenderOptions render{.width = 640, .height = 360};
        Picture picture;
        Figure figure;
        const DeviceRecord& device = *player->device().record;
        uint64_t submitted = 0, awaited = 0;
        for (int frame = -4; frame < kPlayedFrames; ++frame) {
            if (frame == 0) submitted = device.submissions, awaited = device.waits;
            const auto start = Clock::now();
            player->seek(0.1 * (frame + 4));
            if (const Result<bool> shown = player->show(render, picture); !shown)
                return bench.fail(format(shown.error()));
            if (frame >= 0) figure.runs.push_back(millisecondsSince(start));
        }
        std::ranges::sort(figure.runs);
        table.rows.push_back({sample, text(figure),
                              number(double(device.submissions - submitted) / kPlayedFrames),
                              number(double(device.waits - awaited) / kPlayedFrames)});
    }
    table.notes = {
        "Steps, samples, mesh and picture are sent one behind the other. Awaited are the mesh, for its "
        "triangles, and the picture: wanted at most 2."};
    print(table, bench.options.markdown);
}

}  // namespace

Graph chainOfBoxes(int nodes, double difference) {
    Graph graph;
    std::mt19937 random(1);
    const auto anywhere = [&](double low, double high) {
        return low + (high - low) * double(random() >> 8) / double(1 << 24);
    };
    const auto holding = [](auto value) {
        InputValue input;
        input.value = std::move(value);
        return input;
    };
    const auto numbers = [&](double x, double y, double z) { return holding(std::vector<double>{x, y, z}); };
    const auto link = [&](const std::string& node) { return holding(Link{node, ""}); };
    const auto add = [&](std::string id, std::string type) -> Node& {
        Node& node = graph.nodes.emplace_back();
        node.id = std::move(id), node.type = std::move(type);
        return node;
    };
    std::string last;
    for (int i = 0; int(graph.nodes.size()) + 3 < nodes || last.empty(); i++) {
        const std::string number = std::to_string(i);
        const double size = 0.1 + (i == 0 ? difference : 0);
        add("box" + number, "box_max")
            .set("half_extents", numbers(anywhere(size, 0.6), anywhere(0.1, 0.6), anywhere(0.1, 0.6)));
        Node& moved = add("moved" + number, "translate");
        moved.set("surface", link("box" + number));
        moved.set("offset", numbers(anywhere(-1.6, 1.6), anywhere(-1.6, 1.6), anywhere(-1.6, 1.6)));
        if (last.empty()) {
            last = "moved0";
            continue;
        }
        Node& joined = add("joined" + number, i % 3 == 2 ? "subtract" : "union");
        joined.set("a", link(last));
        joined.set("b", link("moved" + number));
        last = joined.id;
    }
    add("out", "output").set("surface", link(last));
    return graph;
}

void liveTable(Bench& bench) {
    const Device& device = bench.device();
    const Result<Graph> graph = readGraph(benchGraph(Field::tower), nullptr);
    if (!graph) return bench.fail(format(graph.error()));
    // The tubes' width in two graphs: the code must be the same, so one set of pipelines serves both.
    CompileOptions exposed;
    exposed.liveExposed = true;
    const Result<Program> program = compile(*graph, exposed);
    if (!program) return bench.fail(format(program.error()));
    Graph edited = *graph;
    if (const Done set = setParameter(edited, "tubes", "0.1"); !set) return bench.fail(format(set.error()));
    const Result<Program> changed = compile(edited, exposed);
    if (!changed) return bench.fail(format(changed.error()));
    if (changed->structureHash != program->structureHash)
        bench.fail("a live parameter changed the structure's hash");
    const std::string field = emitField(*program);
    if (emitField(*changed) != field) bench.fail("a live parameter changed the code");

    MesherPipelines pipelines = createMesherPipelines(device, field);
    const Buffer parameters = createBuffer(device, 4 * program->live.size(), Memory::upload);
    MesherBuffers buffers;
    const float half = regionHalf(Field::tower);
    const MesherConfig config{.origin = glm::vec3(-half),
                              .cellSize = glm::vec3(2 * half / kCells),
                              .cells = glm::ivec3(kCells),
                              .field = {.parameters = &parameters}};
    MesherResult results[2];
    int turn = 0;
    const Figure figure = measure(bench.options.repeats, [&] {
        const Program& now = turn % 2 == 0 ? *program : *changed;
        const auto start = Clock::now();
        const std::vector<double> values = now.parameters();
        uploadBytes(device, parameters, std::vector<float>(values.begin(), values.end()).data(),
                    4 * values.size());
        meshOnce(bench, pipelines, buffers, config, results[turn++ % 2]);
        return millisecondsSince(start);
    });
    checkMesh(bench, "live tower", buffers, results[(turn - 1) % 2]);
    if (results[0].triangles == results[1].triangles) bench.fail("the live parameter changed nothing");

    Table table{
        .title = "A live parameter changes: the tower's tubes at " + std::to_string(kCells) + " cells (ms)",
        .header = {"what", "ms"},
        .rows = {{"upload and mesh", text(figure)}}};
    table.notes = {
        "Wanted: at most " + number(kMostLiveMs) + " ms, " +
        (figure.median() <= kMostLiveMs ? "met" : "missed") +
        ". No pipeline is built: hash and code are the same before and after (checked), the mesh is not (" +
        count(results[0].triangles) + " and " + count(results[1].triangles) + " triangles)."};
    print(table, bench.options.markdown);
    playedTable(bench);
}

void compileTable(Bench& bench) {
    const Device& device = bench.device();
    Table table{.title = "A structure changes: from the graph to the first mesh at " +
                         std::to_string(kCells) + " cells, no cache knows the code (ms)",
                .header = {"nodes", "check and compile", "first mesh, by the host", "total", "emit GLSL",
                           "pipelines", "mesh by its kernels"}};
    std::random_device seed;
    double total200 = 0;
    for (int nodes : {10, 50, 100, kStructureNodes}) {
        MesherBuffers buffers;
        MesherPipelines pipelines;  // of the structure before, as a session has them
        Figure compiling, hosting, emitting, building, meshing;
        const auto measured = measure(bench.options.repeats, [&] {
            const Graph graph = chainOfBoxes(nodes, double(seed()) * 1e-11);
            const auto start = Clock::now();
            const Result<Program> program = compile(graph);
            if (!program) throw SystemError(format(program.error()));
            const double compiled = millisecondsSince(start);
            const MesherConfig config{.origin = glm::vec3(-2.5f),
                                      .cellSize = glm::vec3(5.0f / kCells),
                                      .cells = glm::ivec3(kCells)};
            MesherResult result;
            MesherHost host(program->ir, program->distance(), program->parameters());
            MesherConfig byHost = config;
            byHost.host = &host;
            meshOnce(bench, pipelines, buffers, byHost, result);
            const double total = millisecondsSince(start);
            if (compiling.runs.empty()) checkMesh(bench, "chain of boxes, by the host", buffers, result);

            // What goes on behind the first mesh.
            const auto behind = Clock::now();
            const std::string field = emitField(*program);
            const double emitted = millisecondsSince(behind);
            pipelines = createMesherPipelines(device, field, false, pipelines);
            const double built = millisecondsSince(behind);
            meshOnce(bench, pipelines, buffers, config, result);
            compiling.runs.push_back(compiled);
            hosting.runs.push_back(total - compiled);
            emitting.runs.push_back(emitted);
            building.runs.push_back(built - emitted);
            meshing.runs.push_back(millisecondsSince(behind) - built);
            if (compiling.runs.size() == 1) checkMesh(bench, "chain of boxes", buffers, result);
            return total;
        });
        std::vector<std::string> row = {std::to_string(nodes)};
        for (Figure* part : {&compiling, &hosting, &emitting, &building, &meshing}) {
            part->runs.erase(part->runs.begin(), part->runs.begin() + 2);  // those to warm up
            std::ranges::sort(part->runs);
            row.push_back(number(part->median()));
            if (part == &hosting) row.push_back(text(measured));
        }
        table.rows.push_back(row);
        if (nodes == kStructureNodes) total200 = measured.median();
    }
    table.notes = {
        "Wanted for " + std::to_string(kStructureNodes) + " nodes: at most " + number(kMostStructureMs) +
            " ms, " + (total200 <= kMostStructureMs ? "met." : "missed."),
        "The first mesh comes from shortened tapes on the host; kernels are compiled behind it and take "
        "over when they are ready."};
    print(table, bench.options.markdown);
}

}  // namespace fw::bench
