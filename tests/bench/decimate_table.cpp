// Decimation: a million triangles to a tenth, beside meshoptimizer's simplification of the same mesh.
#include <meshoptimizer.h>

#include "runtime/measure/field_measure.h"
#include "runtime/play/session.h"
#include "runtime/stages/decimate.h"
#include "tests/bench/tables.h"
#include "tests/bench/verify.h"

namespace fw::bench {
namespace {

constexpr double kMostRatio = 4;  // of meshoptimizer's time
constexpr std::size_t kPart = 10;

/// Its triangles, of about a tenth, however far they come to lie from the mesh.
std::vector<uint32_t> simplified(const Mesh& mesh) {
    std::vector<uint32_t> indices(mesh.indices.size());
    indices.resize(meshopt_simplify(indices.data(), mesh.indices.data(), mesh.indices.size(),
                                    &mesh.positions[0].x, mesh.positions.size(), sizeof mesh.positions[0],
                                    3 * (mesh.triangleCount() / kPart), 1e9f));
    return indices;
}

uint64_t cutsOf(std::span<const glm::vec3> positions, std::span<const uint32_t> indices) {
    MeasureOptions options;
    options.selfIntersections = true;
    return *reportOnMesh(positions, indices, options).selfIntersections;
}

/// How long `make` takes without the copy that it is given.
template <class Make>
Figure timeOf(int repeats, const Mesh& mesh, Mesh& made, const Make& make) {
    return measure(repeats, [&] {
        made = mesh;
        const auto start = Clock::now();
        make(made);
        return millisecondsSince(start);
    });
}

}  // namespace

void decimateTable(Bench& bench) {
    Table table{.title = "Decimation to a tenth of the triangles (ms)",
                .header = {"field", "cells", "triangles", "meshoptimizer", "Fieldwright", "ratio",
                           "cut each other", "here", "within half a cell"}};
    struct Row {
        Field field;
        int cells;  // that make about a million triangles
    };
    double worst = 0.0;
    for (const Row& row : {Row{Field::tower, 340}, Row{Field::gyroid, 236}, Row{Field::csg, 448}}) {
        std::optional<Program> program = benchProgram(bench, row.field);
        if (!program) return;
        const int cells = bench.options.sizes.empty() ? row.cells : bench.options.sizes[0];
        const double half = regionHalf(row.field);
        const Box region{{-half, -half, -half}, {half, half, half}};
        const MeasureOptions measures = measureOf(*program, region);
        Result<Device> device = createDevice({.pick = bench.options.device});
        if (!device) return bench.fail(format(device.error()));
        Session session(std::move(*device));
        session.setProgram(std::move(*program));
        const Result<MesherResult> result = session.polygonise({.region = region, .resolution = cells});
        if (!result) return bench.fail(format(result.error()));
        const Mesh mesh = session.download(*result);
        std::vector<uint32_t> theirs;
        const Figure other = measure(bench.options.repeats, [&] {
            const auto start = Clock::now();
            theirs = simplified(mesh);
            return millisecondsSince(start);
        });
        Mesh ours, within;
        const std::size_t wanted = mesh.triangleCount() / kPart;
        const Figure own = timeOf(bench.options.repeats, mesh, ours,
                                  [&](Mesh& made) { decimate(made, {.triangles = wanted}, {}); });
        const Figure bounded = timeOf(1, mesh, within, [&](Mesh& made) {
            decimate(made, {.error = half / cells, .triangles = wanted}, measures);
        });
        for (const Mesh* made : {&ours, &within})
            if (const std::string fault = faultOf(made->indices, made->positions.size()); !fault.empty())
                bench.fail(std::string(fieldName(row.field)) + ": " + fault);
        const double ratio = own.median() / other.median();
        worst = std::max(worst, ratio);
        table.rows.push_back({std::string(fieldName(row.field)), std::to_string(cells),
                              count(mesh.triangleCount()), text(other), text(own), number(ratio),
                              count(cutsOf(mesh.positions, theirs)),
                              count(cutsOf(ours.positions, ours.indices)),
                              number(bounded.median()) + ", " + count(within.triangleCount()) + " left"});
    }
    table.notes.push_back(
        "At most " + number(kMostRatio) + " times as long is wanted, " +
        (worst <= kMostRatio ? "met." : "missed.") +
        " Pairs of triangles that cut each other are those of either's result. Within half a "
        "cell the field is asked too, and what is left is measured against it.");
    print(table, bench.options.markdown);
}

}  // namespace fw::bench
