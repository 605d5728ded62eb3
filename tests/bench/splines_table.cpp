// Tubes along splines beside a torus.
#include <cmath>
#include <sstream>

#include "tests/bench/solid_figures.h"

namespace fw::bench {
namespace {

/// A tube through so many points on a knotted ring of radius 1, `tapered` from point to point.
std::string tubeText(int knots, bool tapered, double difference) {
    std::ostringstream text;
    text
        << R"({"fieldwright": 1, "nodes": [{"id": "way", "type": "spline", "inputs": {"closed": true, "knots": [)";
    for (int i = 0; i < knots; ++i) {
        const double angle = 2 * 3.14159265358979 * i / knots;
        text << (i > 0 ? ", [" : "[") << std::cos(angle) * (1 + 0.2 * std::sin(7 * angle) + difference)
             << ", " << 0.3 * std::sin(5 * angle) << ", " << std::sin(angle) << ", "
             << (tapered ? 1 + 0.3 * std::sin(3 * angle) : 1) << ", 0]";
    }
    text << R"(]}}, {"id": "tube", "type": "tube", "inputs": {"spline": {"from": "way"}, "radius": 0.1}},
              {"id": "out", "type": "output", "inputs": {"surface": {"from": "tube"}}}]})";
    return text.str();
}
std::string torusText(double difference) {
    return R"({"fieldwright": 1, "nodes": [{"id": "ring", "type": "torus", "inputs": {"major_radius": )" +
           std::to_string(1 + difference) + R"(, "minor_radius": 0.1}},
              {"id": "out", "type": "output", "inputs": {"surface": {"from": "ring"}}}]})";
}

}  // namespace

void splinesTable(Bench& bench) {
    Table table{.title = "Tubes along splines, 256 cells (ms)",
                .header = {"solid", "arcs", "compile", "a point on the host (ns)", "triangles", "mesh",
                           "of the torus'", "a picture's sample", "of the torus'"}};
    std::optional<SolidFigures> torus;
    const auto row = [&](const char* name, std::function<std::string(double)> make) {
        SolidFigures figures = measureSolid(
            bench,
            {.text = std::move(make),
             .point =
                 [](int i) {
                     return Point{1.3 * std::sin(i * 1.7), 0.4 * std::sin(i * 2.3), 1.3 * std::sin(i * 3.1)};
                 },
             .picture = true});
        if (!torus) torus = figures;
        std::size_t arcs = 0;
        for (const SplineTablePtr& spline : figures.program.ir.splines()) arcs += spline->spline->arcs.size();
        table.rows.push_back(
            {name, count(arcs), text(figures.compiling), text(figures.sampling), count(figures.triangles),
             text(figures.meshing), number(figures.meshing.median() / torus->meshing.median()),
             text(figures.picturing), number(figures.picturing.median() / torus->picturing.median())});
    };
    row("torus", torusText);
    for (const int knots : {8, 40, 200})
        for (const bool tapered : {false, true}) {
            const std::string name =
                "through " + std::to_string(knots) + " points" + (tapered ? ", tapered" : "");
            row(name.c_str(), [=](double difference) { return tubeText(knots, tapered, difference); });
        }
    print(table, bench.options.markdown);
}

}  // namespace fw::bench
