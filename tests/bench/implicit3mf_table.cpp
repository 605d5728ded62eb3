// Implicit 3MF files: what it costs to make graphs of them, to compile these, and to mesh them. One that is
// made here, of as many nodes as the largest of the files of another program, and those, where they are.
#include <unistd.h>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "graph/compile/compile.h"
#include "graph/implicit3mf/import.h"
#include "graph/implicit3mf/package.h"
#include "runtime/mesher/mesher.h"
#include "runtime/play/session.h"
#include "tests/bench/tables.h"

namespace fw::bench {
namespace {

constexpr double kMostImport = 200;  // ms
constexpr int kImplicitCells = 256, kFunctions = 48, kBalls = 18;

std::string nodeText(const std::string& kind, const std::string& id, const std::string& in,
                     const std::string& out, const std::string& attributes = {}) {
    return "<i:" + kind + " identifier=\"" + id + "\"" + attributes + "><i:in>" + in + "</i:in><i:out>" +
           out + "</i:out></i:" + kind + ">";
}

/// Functions that call one another, of twenty nodes each: balls that move away from each other.
std::string manyFunctions() {
    const auto scalar = [](const char* name, const std::string& from) {
        return std::string("<i:scalarref identifier=\"") + name + "\" ref=\"" + from + "\"/>";
    };
    const auto vector = [](const char* name, const std::string& from) {
        return std::string("<i:vectorref identifier=\"") + name + "\" ref=\"" + from + "\"/>";
    };
    const std::string result = "<i:scalar identifier=\"result\"/>",
                      moved = "<i:vector identifier=\"result\"/>";
    std::string text =
        "<model unit=\"millimeter\"><resources><object id=\"1\"><mesh><vertices>"
        "<vertex x=\"-99\" y=\"-99\" z=\"-99\"/><vertex x=\"99\" y=\"99\" z=\"99\"/></vertices><triangles>"
        "<triangle v1=\"0\" v2=\"1\" v3=\"0\"/></triangles></mesh></object>";
    for (int f = 0; f < kFunctions; ++f) {
        std::string nodes, last = "first.result";
        nodes += nodeText("constvec", "step", "", "<i:vector identifier=\"vector\"/>",
                          " x=\"0.3\" y=\"0.04\" z=\"0.2\"");
        nodes += nodeText("length", "first", vector("A", "inputs.pos"), result);
        for (int i = 0; i < kBalls / 3; ++i) {
            const std::string n = std::to_string(i);
            nodes += nodeText("subtraction", "m" + n,
                              vector("A", i ? "m" + std::to_string(i - 1) + ".result" : "inputs.pos") +
                                  vector("B", "step.vector"),
                              moved);
            nodes += nodeText("length", "l" + n, vector("A", "m" + n + ".result"), result);
            nodes += nodeText("min", "u" + n, scalar("A", last) + scalar("B", "l" + n + ".result"), result);
            last = "u" + n + ".result";
        }
        if (f > 0) {
            nodes += nodeText("constresourceid", "f", "", "<i:resourceid identifier=\"value\"/>",
                              " value=\"" + std::to_string(9 + f) + "\"");
            nodes += nodeText(
                "functioncall", "c",
                "<i:resourceref identifier=\"functionID\" ref=\"f.value\"/>" + vector("pos", "m5.result"),
                "<i:scalar identifier=\"shape\"/>");
            nodes += nodeText("min", "both", scalar("A", last) + scalar("B", "c.shape"), result);
            last = "both.result";
        } else {
            nodes += nodeText("constant", "r", "", "<i:scalar identifier=\"value\"/>", " value=\"2\"");
            nodes += nodeText("subtraction", "size", scalar("A", last) + scalar("B", "r.value"), result);
            last = "size.result";
        }
        text += "<i:implicitfunction id=\"" + std::to_string(10 + f) + "\" displayname=\"row\"><i:in>" +
                "<i:vector identifier=\"pos\"/></i:in>" + nodes + "<i:out>" + scalar("shape", last) +
                "</i:out></i:implicitfunction>";
    }
    return text + "<object id=\"99\"><v:levelset functionid=\"" + std::to_string(9 + kFunctions) +
           "\" channel=\"shape\" meshid=\"1\" meshbboxonly=\"true\"/></object></resources><build><item "
           "objectid=\"99\"/></build></model>";
}

}  // namespace

void implicit3mfTable(Bench& bench) {
    Table table{
        .title = "Implicit 3MF files, " + std::to_string(kImplicitCells) + " cells (ms)",
        .header = {"file", "nodes", "groups", "import", "compile", "operations", "triangles", "mesh"}};
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("fieldwright-3mf-" + std::to_string(getpid()));
    double most = 0;
    const auto row = [&](const std::string& name, const std::string& bytes) {
        std::optional<Imported> imported;
        const Figure importing = measure(bench.options.repeats, [&] {
            const auto start = Clock::now();
            Result<Imported> made = import3mf(bytes, name, "bench_3mf");
            if (!made) throw SystemError(format(made.error()));
            const double took = millisecondsSince(start);
            imported = std::move(*made);
            return took;
        });
        most = std::max(most, importing.median());
        for (const FileBeside& file : imported->files) {
            std::filesystem::create_directories((folder / file.path).parent_path());
            std::ofstream(folder / file.path, std::ios::binary) << file.bytes;
        }
        imported->graph.path = (folder / "bench.field.json").string();
        std::optional<Program> program;
        const Figure compiling = measure(bench.options.repeats, [&] {
            const auto start = Clock::now();
            Result<Program> made = compile(imported->graph);
            if (!made) throw SystemError(format(made.error()));
            const double took = millisecondsSince(start);
            program = std::move(*made);
            return took;
        });
        std::size_t nodes = imported->graph.nodes.size();
        for (const Group& group : imported->graph.groups) nodes += group.nodes.size();
        const std::size_t operations = program->ir.size();
        Result<Device> device = createDevice({.pick = bench.options.device});
        if (!device) return bench.fail(format(device.error()));
        Session session(std::move(*device), FieldBy::sooner);
        session.setProgram(std::move(*program));
        uint64_t triangles = 0;
        const Figure meshing = measure(bench.options.repeats, [&] {
            const auto start = Clock::now();
            const Result<MesherResult> mesh =
                session.polygonise({.region = {}, .resolution = kImplicitCells});
            if (!mesh) throw SystemError(format(mesh.error()));
            triangles = mesh->triangles;
            return millisecondsSince(start);
        });
        table.rows.push_back({name, count(nodes), count(imported->graph.groups.size()), text(importing),
                              text(compiling), count(operations), count(triangles), text(meshing)});
    };
    row("made here", threemf::packed({{"3D/3dmodel.model", manyFunctions()}}));
    const char* given = std::getenv("FIELDWRIGHT_CORPUS");
    const std::filesystem::path corpus =
        std::filesystem::path(given ? given : "../shared/corpus") / "implicit3mf";
    for (const char* name : {"2x_wing", "foundation", "heartvase_001", "3mf-implicit", "SphereInACage"}) {
        std::ifstream in(corpus / (std::string(name) + ".3mf"), std::ios::binary);
        if (in) row(name, std::string(std::istreambuf_iterator<char>(in), {}));
    }
    std::filesystem::remove_all(folder);
    table.notes.push_back("Wanted: at most " + number(kMostImport) + " ms to import the largest (" +
                          number(most) + ").");
    print(table, bench.options.markdown);
}

}  // namespace fw::bench
