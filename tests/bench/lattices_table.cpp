// Lattices: struts in a part beside a gyroid of the same surface.
#include <cmath>

#include "graph/document/json.h"
#include "runtime/measure/mesh_size.h"
#include "runtime/play/session.h"
#include "tests/bench/tables.h"

namespace fw::bench {
namespace {

constexpr double kMostOfGyroid = 2, kStrutCell = 0.1, kThickOfCell = 0.2;  // times; of a ball of radius 1
constexpr int kLatticeCells = 512, kAreaCells = 384, kFittings = 2;

std::string latticeText(const char* kind, double cell) {
    return R"({"fieldwright": 1, "nodes": [{"id": "part", "type": "sphere", "inputs": {"radius": 1}},
              {"id": "cells", "type": "lattice", "inputs": {"kind": ")" +
           std::string(kind) + R"(", "cell": )" + std::to_string(cell) + R"(, "thickness": )" +
           std::to_string(kThickOfCell * cell) + R"(}},
              {"id": "light", "type": "intersect", "inputs": {"a": {"from": "part"}, "b": {"from": "cells"}}},
              {"id": "out", "type": "output", "inputs": {"surface": {"from": "light"}}}]})";
}

Session latticeSession(const Bench& bench, const char* kind, double cell) {
    const Result<Graph> graph = parseGraph(latticeText(kind, cell), "", nullptr);
    if (!graph) throw SystemError(format(graph.error()));
    Result<Program> program = compile(*graph);
    if (!program) throw SystemError(format(program.error()));
    Result<Device> device = createDevice({.pick = bench.options.device});
    if (!device) throw SystemError(format(device.error()));
    Session session(std::move(*device), FieldBy::kernels);
    session.setProgram(std::move(*program));
    return session;
}

double areaOf(const Bench& bench, const char* kind, double cell) {
    Session session = latticeSession(bench, kind, cell);
    const Result<MesherResult> made = session.polygonise({.region = {}, .resolution = kAreaCells});
    if (!made) throw SystemError(format(made.error()));
    const Mesh mesh = session.download(*made);
    return sizeOf(mesh.positions, mesh.indices).area;
}

}  // namespace

void latticesTable(Bench& bench) {
    // The gyroid's area goes with one over its cell, as long as its walls are as thick as before for that
    // cell.
    const double area = areaOf(bench, "octet", kStrutCell);
    double cell = kStrutCell;
    for (int i = 0; i < kFittings; ++i) cell *= areaOf(bench, "gyroid", cell) / area;

    for (const int cells : bench.sizes({kLatticeCells})) {
        Table table{.title = "Lattices in a ball, " + std::to_string(cells) + " cells (ms)",
                    .header = {"lattice", "its cell", "area", "triangles", "mesh", "of the gyroid's"}};
        double gyroid = 0;
        const auto row = [&](const char* kind, double size) {
            Session session = latticeSession(bench, kind, size);
            uint64_t triangles = 0;
            const Figure meshing = measure(bench.options.repeats, [&] {
                const auto start = Clock::now();
                const Result<MesherResult> mesh = session.polygonise({.region = {}, .resolution = cells});
                if (!mesh) throw SystemError(format(mesh.error()));
                triangles = mesh->triangles;
                return millisecondsSince(start);
            });
            if (gyroid <= 0) gyroid = meshing.median();
            table.rows.push_back({kind, number(size), number(areaOf(bench, kind, size)), count(triangles),
                                  text(meshing), number(meshing.median() / gyroid)});
            return meshing.median() / gyroid;
        };
        row("gyroid", cell);
        const double octet = row("octet", kStrutCell);
        for (const char* kind : {"cubic", "kelvin", "diamond", "schwarz p"}) row(kind, kStrutCell);
        table.notes.push_back("Wanted: the octet's 20 x 20 x 20 cells at most " + number(kMostOfGyroid) +
                              " times a gyroid of the same area (" + number(octet) + ").");
        print(table, bench.options.markdown);
    }
}

}  // namespace fw::bench
