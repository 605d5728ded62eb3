// Triangle meshes to fields: ours beside OpenVDB, beside every sample against every triangle, and beside the
// slide's sweeps; and what meshing such a field costs.
//
// Meshes: a torus of 100,000 triangles, and every mesh file in the folder that FIELDWRIGHT_MESHES names.
#include <dlfcn.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>

#include "graph/assets/triangle_tree.h"
#include "runtime/bake/mesh_field_baker.h"
#include "runtime/play/session.h"
#include "shaders/shared.h"
#include "tests/bench/tables.h"
#include "tests/bench/vdb/mesh_to_volume.h"

#include "shaders/bake/bake.h"

namespace fw::bench {
namespace {

constexpr int kThreads = 2;          // of OpenVDB
constexpr int kNaiveChunk = 50'000;  // triangles: some drivers end a loop after 65,535 turns
constexpr int kNaiveShare = 16;      // one sample in so many is measured naively
constexpr double kLeastOverNaive = 100, kMostOverBox = 3;

struct Input {
    std::string name;
    TriangleMeshPtr mesh;
};

TriangleMeshPtr torus() {
    constexpr uint32_t around = 400, across = 125;
    auto mesh = std::make_shared<TriangleMesh>();
    for (uint32_t i = 0; i < around; ++i)
        for (uint32_t j = 0; j < across; ++j) {
            const double a = 2.0 * std::numbers::pi * i / around, b = 2.0 * std::numbers::pi * j / across;
            const double r = 1.0 + 0.4 * std::cos(b) + 0.02 * std::sin(12 * a + 5 * b);
            mesh->positions.emplace_back(r * std::cos(a), 0.4 * std::sin(b), -r * std::sin(a));
            const uint32_t k = (i + 1) % around, l = (j + 1) % across;
            const uint32_t p = i * across + j, q = k * across + j, s = k * across + l, t = i * across + l;
            mesh->indices.insert(mesh->indices.end(), {p, q, s, p, s, t});
        }
    mesh->hash = 1;
    return mesh;
}

std::vector<Input> inputs(Bench& bench) {
    std::vector<Input> list{{"torus", torus()}};
    const char* folder = std::getenv("FIELDWRIGHT_MESHES");
    if (!folder) return list;
    std::vector<std::string> names;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error))
        names.push_back(entry.path().filename().string());
    std::ranges::sort(names);
    for (const std::string& name : names) {
        Result<TriangleMeshPtr> mesh = readTriangleMesh(std::string(folder) + "/all.field.json", name);
        if (mesh)
            list.push_back({std::filesystem::path(name).stem().string(), *mesh});
        else
            bench.fail(mesh.error().message);
    }
    return list;
}

MeshToVolume* openvdb() {
    static void* const module = ::dlopen(FIELDWRIGHT_BENCH_VDB, RTLD_NOW | RTLD_LOCAL);
    return module ? reinterpret_cast<MeshToVolume*>(::dlsym(module, "fieldwrightMeshToVolume")) : nullptr;
}

gpu::BakePush pushFor(const VolumeGrid& grid) {
    gpu::BakePush push{};
    push.size = grid.size;
    push.cell = float(grid.cell);
    return push;
}
glm::uvec3 groupsOf(std::size_t items) { return {uint32_t((items + BAKE_GROUP - 1) / BAKE_GROUP), 1, 1}; }

/// Milliseconds of the naive kernel for all samples, from a share of them.
double naive(Bench& bench, const MeshInGrid& mesh) {
    const Device& device = bench.device();
    const Pipeline kernel = createComputePipeline(device, {.name = "bench/naive_field.comp"});
    std::vector<glm::vec4> corners;
    for (const uint32_t index : mesh.solid.indices) corners.emplace_back(mesh.solid.positions[index], 0.0f);
    const Buffer in = createBuffer(device, corners.size() * sizeof corners[0]);
    upload(device, in, corners);
    gpu::BakePush push = pushFor(mesh.grid);
    push.items = uint32_t(mesh.grid.samples() / kNaiveShare);
    const Buffer least = createBuffer(device, 8ull * push.items);
    const auto run = [&](int share) {
        const auto start = Clock::now();
        Commands commands(device);
        fill(commands, least, 0x7f7fffff);
        barrier(commands);
        const int count = int(mesh.solid.source.size()) / share;
        for (push.axis = 0; push.axis < count; push.axis = push.slice) {
            push.slice = std::min(count, push.axis + kNaiveChunk);
            const Descriptor bound[] = {{0, in}, {1, least}};
            dispatch(commands, kernel, groupsOf(push.items), push, bound);
            barrier(commands);
        }
        submit(commands);
        return millisecondsSince(start);
    };
    run(1000);  // warms up
    return run(1) * kNaiveShare;
}

/// The slide's sweeps from distances that are known within `band` cells, rounded to nothing if `voxels`:
/// their time, and how far from ours they end, in cells.
std::pair<double, double> slideSweeps(Bench& bench, const FieldVolume& volume, double band, bool voxels) {
    const Device& device = bench.device();
    const Pipeline kernel = createComputePipeline(device, {.name = "bench/slide_sweep.comp"});
    const std::size_t samples = volume.grid.samples();
    std::vector<float> seeds(samples);
    const auto distance = [&](std::size_t i) {
        return std::bit_cast<float>(volume.words[2 * i]) / float(volume.grid.cell);
    };
    for (std::size_t i = 0; i < samples; ++i)
        seeds[i] = std::abs(distance(i)) > band ? 1e9f
                   : voxels                     ? std::copysign(1e-3f, distance(i))
                                                : distance(i);
    const Buffer cells = createBuffer(device, 4 * samples);
    gpu::BakePush push = pushFor(volume.grid);
    const auto run = [&] {
        upload(device, cells, seeds);
        const auto start = Clock::now();
        Commands commands(device);
        for (push.axis = 0; push.axis < 3; ++push.axis) {
            const auto rows =
                std::size_t(push.size[(push.axis + 1) % 3]) * std::size_t(push.size[(push.axis + 2) % 3]);
            const Descriptor bound[] = {{1, cells}};
            dispatch(commands, kernel, groupsOf(rows), push, bound);
            barrier(commands);
        }
        submit(commands);
        return millisecondsSince(start);
    };
    const Figure figure = measure(bench.options.repeats, run);
    const std::vector<float> result = download<float>(device, cells, samples);
    double worst = 0.0;
    for (std::size_t i = 0; i < samples; ++i)
        worst = std::max(worst, std::abs(double(std::abs(result[i])) - std::abs(distance(i))));
    return {figure.median(), worst};
}

void bakeTable(Bench& bench) {
    Table table{
        .title = "Meshes to fields, all of the grid (ms)",
        .header = {"mesh", "triangles", "resolution", "samples", "all", "topology", "prepare", "scatter",
                   "list", "sign", "sweep", "pack", "finish", "OpenVDB", "its band of 3", "naive"}};
    Table slide{.title = "The slide's ways to fill the grid (ms; cells off at most)",
                .header = {"mesh", "resolution", "our sweeps", "rows, from exact distances", "off",
                           "rows, from voxels", "off"}};
    for (const Input& input : inputs(bench))
        for (const int resolution : bench.sizes({64, 128, 256})) {
            const MeshFieldRecipe recipe{.mesh = input.mesh, .resolution = resolution};
            std::vector<StageTime> stages;
            const MeshFieldBaker plain = meshFieldBaker([&] { return &bench.device(); }, {.cached = false});
            const MeshFieldBaker timed = meshFieldBaker([&] { return &bench.device(); },
                                                        {.cached = false, .stages = &stages, .timed = true});
            Result<FieldVolumePtr> made = plain(recipe);
            if (!made) {
                bench.fail(made.error().message);
                continue;
            }
            const Figure all = measure(bench.options.repeats, [&] {
                const auto start = Clock::now();
                made = plain(recipe);
                return millisecondsSince(start);
            });
            if (!timed(recipe)) continue;
            stages.clear();
            (void)timed(recipe);
            const FieldVolume& volume = **made;
            const Result<MeshInGrid> mesh = meshInGrid(recipe);
            std::vector<std::string> row{input.name, count(mesh->solid.source.size()),
                                         std::to_string(resolution), count(volume.grid.samples()), text(all)};
            double sweep = 0.0;
            for (const char* name :
                 {"topology", "prepare", "scatter", "list", "sign", "sweep", "pack", "finish"}) {
                double sum = 0.0;
                for (const StageTime& stage : stages)
                    if (stage.name == name) sum += stage.milliseconds;
                if (name == std::string_view("sweep")) sweep = sum;
                row.push_back(number(sum));
            }
            MeshToVolume* const vdb = openvdb();
            double full = 0.0;
            for (const bool whole : {true, false}) {
                if (!vdb || (whole && resolution > 128)) {
                    row.push_back("–");
                    continue;
                }
                const double took = vdb({input.mesh->positions, input.mesh->indices, volume.grid.cell,
                                         whole ? float(resolution) : 3.0f, kThreads});
                if (whole) full = took;
                row.push_back(number(took));
            }
            double naively = 0.0;
            if (resolution <= 128) naively = naive(bench, *mesh);
            row.push_back(naively > 0.0 ? number(naively) : "–");
            table.rows.push_back(row);
            if (naively > 0.0)
                table.notes.push_back(input.name + " at " + std::to_string(resolution) + ": OpenVDB takes " +
                                      number(full / all.median()) + " times as long, the naive kernel " +
                                      number(naively / all.median()) + " times.");
            const auto [exact, exactOff] = slideSweeps(bench, volume, kBand, false);
            const auto [voxels, voxelsOff] = slideSweeps(bench, volume, 0.87, true);
            slide.rows.push_back({input.name, std::to_string(resolution), number(sweep), number(exact),
                                  number(exactOff), number(voxels), number(voxelsOff)});
        }
    table.notes.push_back(
        "OpenVDB: meshToVolume with " + std::to_string(kThreads) +
        " threads, distances as far as the grid is long; once. It finds no topology. Naive: one "
        "sample in " +
        std::to_string(kNaiveShare) + " was measured. At least " + number(kLeastOverNaive) +
        " times as fast as that is wanted at 64.");
    print(table, bench.options.markdown);
    print(slide, bench.options.markdown);
}

/// What meshing the field of a mesh costs beside a box in its place.
void meshingTable(Bench& bench) {
    Table table{.title = "Meshing the field of a mesh, at 256 (ms)",
                .header = {"field", "triangles", "all", "cull", "sample", "vertices", "beside the box"}};
    double box = 0.0;
    const auto time = [&](const std::string& name, Program program, const Box& region) {
        Result<Device> device = createDevice({.pick = bench.options.device});
        if (!device) return bench.fail(format(device.error()));
        Session session(std::move(*device));
        session.setProgram(std::move(program));
        Result<MesherResult> mesh = Error{};
        const Figure all = measure(bench.options.repeats, [&] {
            const auto start = Clock::now();
            mesh = session.polygonise({.region = region, .resolution = 256});
            finish(session.device());
            return millisecondsSince(start);
        });
        mesh = session.polygonise({.region = region, .resolution = 256}, true);
        if (!mesh) return bench.fail(mesh.error().message);
        if (box == 0.0) box = all.median();
        std::vector<std::string> row{name, count(mesh->triangles), text(all)};
        for (const char* wanted : {"cull", "sample", "vertices"}) {
            double sum = 0.0;
            for (const StageTime& stage : mesh->stages)
                if (stage.name == wanted) sum += stage.milliseconds;
            row.push_back(number(sum));
        }
        row.push_back(number(all.median() / box));
        table.rows.push_back(row);
    };
    for (const Input& input : inputs(bench)) {
        const Result<FieldVolumePtr> volume = meshFieldBaker(
            [&] { return &bench.device(); }, {.cached = false})({.mesh = input.mesh, .resolution = 128});
        if (!volume) continue;
        const VolumeGrid& grid = (*volume)->grid;
        const glm::dvec3 hi = grid.place(grid.size - 1), middle = 0.5 * (grid.origin + hi);
        const Box region{{grid.origin.x, grid.origin.y, grid.origin.z}, {hi.x, hi.y, hi.z}};
        box = 0.0;
        for (const bool boxed : {true, false}) {
            Program program;
            Ir& ir = program.ir;
            for (std::size_t i = 0; i < kDefaultMaterial.size(); ++i)
                program.surface[i + 1] = ir.constant(kDefaultMaterial[i]);
            if (boxed) {
                // The exact box around the mesh.
                std::array<IrId, 3> q;
                for (int axis = 0; axis < 3; ++axis)
                    q[std::size_t(axis)] =
                        ir.add(Op::subtract,
                               ir.add(Op::absolute,
                                      ir.add(Op::subtract, ir.position(axis), ir.constant(middle[axis]))),
                               ir.constant(0.5 * (hi[axis] - grid.origin[axis]) - 3.0 * grid.cell));
                IrId sum = ir.constant(0.0), inside = q[0];
                for (const IrId each : q) {
                    sum =
                        ir.add(Op::add, sum, ir.add(Op::square, ir.add(Op::maximum, each, ir.constant(0.0))));
                    inside = ir.add(Op::maximum, inside, each);
                }
                program.surface[0] = ir.add(Op::add, ir.add(Op::squareRoot, sum),
                                            ir.add(Op::minimum, inside, ir.constant(0.0)));
            } else {
                program.surface[0] = ir.sample(ir.addVolume(*volume), tricubicChannel, {0, 1, 2});
            }
            program.ir = ir.compact(program.surface);
            program.opaque = program.surface;
            program.structureHash = program.ir.hash(program.surface);
            time(boxed ? "box around the " + input.name : input.name + ", 128, tricubic", std::move(program),
                 region);
        }
    }
    table.notes.push_back("At most " + number(kMostOverBox) + " times the box's time is wanted.");
    print(table, bench.options.markdown);
}

}  // namespace

void meshFieldTable(Bench& bench) {
    bakeTable(bench);
    meshingTable(bench);
}

}  // namespace fw::bench
