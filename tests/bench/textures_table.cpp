// Textures: what unwrapping, baking and writing take of an export, stage by stage.
#include <filesystem>

#include "graph/document/json.h"
#include "runtime/export/export.h"
#include "runtime/play/mesh_program.h"
#include "runtime/textures/bake.h"
#include "runtime/textures/tangents.h"
#include "runtime/textures/textured.h"
#include "tests/bench/tables.h"

namespace fw::bench {
namespace {

constexpr int kTextureSize = 2048;

struct Textured {
    const char* name;
    const char* file;
};
constexpr Textured kTextured[] = {
    {"duck", "meshes/duck"}, {"tower", "tower"}, {"painted hill", "painted_hill"}};

void addTexturesRow(Bench& bench, const Textured& row, Table& table) {
    const std::string path =
        std::string(FIELDWRIGHT_BENCH_GRAPHS "/../../../samples/") + row.file + ".field.json";
    const Result<Graph> graph = readGraph(path, nullptr);
    if (!graph) return bench.fail(format(graph.error()));
    Result<Program> program = compileAtTime(*graph, 0);
    if (!program) return bench.fail(format(program.error()));
    Result<Device> device = createDevice({.pick = bench.options.device});
    if (!device) return bench.fail(format(device.error()));
    const int cells = bench.options.sizes.empty() ? 128 : bench.options.sizes.front();
    Session session(std::move(*device));
    session.setProgram(std::move(*program));
    const Result<MesherResult> meshed = session.polygonise({.region = {}, .resolution = cells});
    if (!meshed) return bench.fail(format(meshed.error()));
    const Mesh mesh = session.download(*meshed, MaterialParts::besideTextures);
    const Program onHost = session.onHost();

    std::vector<double> charts, unwrapped, baked, written;
    std::size_t count = 0;
    double covered = 0;
    const std::filesystem::path folder = std::filesystem::temp_directory_path();
    const std::string file = (folder / "fieldwright-bench-textures.glb").string();
    for (int i = 0; i < bench.options.repeats; ++i) {
        auto start = Clock::now();
        (void)chartsOf(mesh);
        charts.push_back(millisecondsSince(start));
        start = Clock::now();
        const Result<Unwrapping> made = unwrap(mesh, kTextureSize);
        if (!made) return bench.fail(format(made.error()));
        unwrapped.push_back(millisecondsSince(start));
        count = made->charts.count(), covered = made->covered;
        auto begun = Clock::now();
        const Result<Mesh> whole = textured(mesh, onHost, kTextureSize, [&](const char* stage) {
            if (std::string(stage) == "bake") begun = Clock::now();
        });
        if (!whole) return bench.fail(format(whole.error()));
        baked.push_back(millisecondsSince(begun));
        start = Clock::now();
        if (const Result<ExportedFiles> files = exportMesh(*whole, file); !files)
            return bench.fail(format(files.error()));
        written.push_back(millisecondsSince(start));
    }
    std::error_code ignored;
    std::filesystem::remove(file, ignored);
    const auto shown = [](std::vector<double> runs) {
        std::ranges::sort(runs);
        return text(Figure{std::move(runs)});
    };
    table.rows.push_back({row.name, fw::bench::count(mesh.triangleCount()), std::to_string(count),
                          number(100 * covered), shown(charts), shown(unwrapped), shown(baked),
                          shown(written)});
}

}  // namespace

void texturesTable(Bench& bench) {
    Table table{.title = "Textures of 2048 x 2048 texels: base colour, finish and occlusion, normals (ms)",
                .header = {"solid", "triangles", "charts", "covered (%)", "charts alone", "unwrap", "bake",
                           "write GLB"}};
    for (const Textured& row : kTextured) addTexturesRow(bench, row, table);
    print(table, bench.options.markdown);
}

}  // namespace fw::bench
