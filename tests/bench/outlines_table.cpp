// Drawings and letters: what a thousand segments cost to compile and to mesh, beside a rectangle of the same
// size.
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/bench/solid_figures.h"

namespace fw::bench {
namespace {

constexpr double kMostOutline = 3, kMostLineOfText = 4,
                 kMostOutlineCompile = 100;  // times the rectangle's; ms
constexpr int kOutlineCells = 256;

/// A wavy ring of so many cubic curves, in a folder of its own.
std::string wavySvg(int segments, double difference) {
    std::ostringstream path;
    path << "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'><path d='M90 50";
    for (int i = 1; i <= segments; ++i) {
        const auto at = [&](double step) {
            const double angle = 2 * 3.14159265358979 * step / segments,
                         radius = 36 + difference + 4 * std::cos(40 * angle);
            std::ostringstream place;
            place << 50 + radius * std::cos(angle) << " " << 50 + radius * std::sin(angle);
            return place.str();
        };
        path << "C" << at(i - 0.67) << " " << at(i - 0.33) << " " << at(i);
    }
    path << "Z'/></svg>";
    return path.str();
}

std::string inText(const std::string& text) { return "\"" + text + "\""; }

/// A flat node, extruded.
std::string extrudedText(const std::string& type, const std::string& inputs) {
    return R"({"fieldwright": 1, "nodes": [{"id": "flat", "type": ")" + type + R"(", "inputs": {)" + inputs +
           R"(}}, {"id": "solid", "type": "extrude", "inputs": {"surface": {"from": "flat"}, "half_height": 0.05}},
              {"id": "out", "type": "output", "inputs": {"surface": {"from": "solid"}}}]})";
}

}  // namespace

void outlinesTable(Bench& bench) {
    Table table{.title = "Outlines, extruded, " + std::to_string(kOutlineCells) + " cells (ms)",
                .header = {"solid", "arcs", "compile", "a point on the host (ns)", "triangles", "mesh",
                           "of the rectangle's"}};
    const std::string folder =
        std::filesystem::temp_directory_path() / ("fieldwright-outlines-" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    const std::string file = folder + "/bench.field.json";
    int round = 0;
    const auto row = [&](const char* name, const std::function<std::string(double)>& make,
                         double beside) -> double {
        const SolidFigures figures = measureSolid(
            bench,
            {.text = make,
             .file = file,
             .point =
                 [](int i) {
                     return Point{0.7 * std::sin(i * 1.7), 0.4 * std::sin(i * 2.3), 0.05 * std::sin(i * 3.1)};
                 },
             .cells = kOutlineCells});
        std::size_t arcs = 0;
        for (const OutlinePtr& outline : figures.program.ir.outlines()) arcs += outline->arcs.size();
        const double meshing = figures.meshing.median();
        table.rows.push_back({name, count(arcs), text(figures.compiling), text(figures.sampling),
                              count(figures.triangles), text(figures.meshing),
                              beside > 0 ? number(meshing / beside) : "1"});
        return meshing;
    };
    const auto rectangle = [](double x, double y) {
        return [x, y](double difference) {
            return extrudedText("rectangle", R"("half_extents": [)" + std::to_string(x + difference) + ", " +
                                                 std::to_string(y) + "]");
        };
    };
    std::string line;
    while (line.size() < 200) line += "The quick brown fox jumps over ";
    line.resize(200);
    const double square = row("rectangle", rectangle(0.5, 0.5), 0);
    const double drawing = row(
        "SVG of 1000 curves",
        [&](double difference) {
            const std::string name = "ring" + std::to_string(++round) + ".svg";
            std::ofstream(folder + "/" + name) << wavySvg(1000, difference);
            return extrudedText("svg_file", R"("path": )" + inText(name));
        },
        square);
    const double word = row(
        "text of 48 letters",
        [&](double difference) {
            return extrudedText(
                "text",
                R"("string": "Sphinx of black\nquartz, judge\nmy vow 0123456789", "size": 0.2, "letter_spacing": )" +
                    std::to_string(difference));
        },
        square);
    const double strip = row("long rectangle", rectangle(1, 0.01), 0);
    const double letters = row(
        "line of 200 letters",
        [&](double difference) {
            return extrudedText("text", R"("size": 0.019, "string": )" + inText(line) +
                                            R"(, "letter_spacing": )" + std::to_string(difference));
        },
        strip);
    std::filesystem::remove_all(folder);
    if (square <= 0 || strip <= 0) return;
    table.notes.push_back("Wanted: at most " + number(kMostOutline) +
                          " times the rectangle's mesh for a thousand segments (" + number(drawing / square) +
                          ", " + number(word / square) + "), " + number(kMostLineOfText) +
                          " times for a line of 200 letters (" + number(letters / strip) + "), and " +
                          number(kMostOutlineCompile) + " ms to compile.");
    print(table, bench.options.markdown);
}

}  // namespace fw::bench
