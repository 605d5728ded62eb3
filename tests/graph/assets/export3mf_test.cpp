// Graphs as implicit 3MF files: read again they are the same field, the standard's schemas take them, and
// what cannot be written is named.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>

#include "graph/compile/compile.h"
#include "graph/document/json.h"
#include "graph/implicit3mf/export.h"
#include "graph/implicit3mf/import.h"
#include "graph/implicit3mf/package.h"
#include "tests/support/graph/expression_graph.h"
#include "tests/support/graph/picture_file.h"
#include "tests/support/graph/random_graph.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::export3mf_test {

namespace fs = std::filesystem;

const LengthUnit& unit(const char* name) { return *lengthUnit(name); }

std::string modelOf(const std::string& bytes) {
    return *threemf::Package::open(bytes)->part("3D/3dmodel.model", 256u << 20);
}

/// The file as a program again, with its pictures and meshes in a folder.
struct Again {
    explicit Again(const std::string& bytes) {
        Result<Imported> made = import3mf(bytes, "a.3mf", "a_3mf");
        EXPECT_TRUE(made) << format(made.error());
        if (!made) return;
        for (const FileBeside& file : made->files) {
            fs::create_directories(fs::path(folder.path(file.path)).parent_path());
            test::writeText(folder.path(file.path), file.bytes);
        }
        made->graph.path = folder.path("a.field.json");
        Result<Program> compiled = compile(made->graph);
        EXPECT_TRUE(compiled) << format(compiled.error());
        if (compiled) program = std::move(*compiled), fine = true;
        graph = std::move(made->graph);
    }
    test::TempDir folder;
    Graph graph;
    Program program;
    bool fine = false;
};

/// How many of the points in the box have another value, by more than 1e-6 of the box's size.
std::size_t differences(const Program& one, const Program& again, const Box& box, std::size_t count) {
    std::mt19937 random(1);
    std::vector<Point> points(count);
    double size = 0.0;
    for (int axis = 0; axis < 3; ++axis) size = std::max(size, box.hi[axis] - box.lo[axis]);
    for (Point& p : points)
        for (int axis = 0; axis < 3; ++axis)
            p[axis] = std::uniform_real_distribution<double>(box.lo[axis], box.hi[axis])(random);
    std::vector<double> a(count), b(count);
    evaluate(one.ir, one.surface[distanceComponent], {}, points, a);
    evaluate(again.ir, again.surface[distanceComponent], {}, points, b);
    std::size_t apart = 0;
    for (std::size_t i = 0; i < count; ++i) {
        double bounds = -1e300;  // the level set is cut by its bounds
        for (int axis = 0; axis < 3; ++axis)
            bounds = std::max({bounds, box.lo[axis] - points[i][axis], points[i][axis] - box.hi[axis]});
        apart += !(std::abs(std::max(a[i], bounds) - b[i]) <= 1e-6 * size);
    }
    return apart;
}

TEST(Export3mf, IsTheSameFieldAgain) {
    // Every operation that there is, wherever it has jumps or edges.
    const char* const codes[] = {
        "length(p) - 1",
        "max(abs(p.x), max(abs(p.y), abs(p.z))) - 1",
        "smooth_min(length(p - vec3(0.4, 0, 0)) - 0.5, length(p + vec3(0.4, 0, 0)) - 0.5, 0.3)",
        "length(p) - 0.8 + 0.1 * sin(9 * p.x) * cos(7 * p.y) * tan(0.4 * p.z)",
        "length(vec3(mod(p.x, 0.5) - 0.25, fmod(p.y, 0.7), fract(3 * p.z))) - 0.3",
        "length(p) - 0.7 - 0.05 * floor(4 * p.x) + 0.03 * ceil(3 * p.y) - 0.02 * round(5 * p.z) + 0.01 * "
        "trunc(6 * p.x)",
        "length(p) - 0.7 - 0.1 * atan2(p.x, p.z) - 0.05 * atan(3 * p.y) + 0.1 * asin(1.5 * p.x) - 0.1 * "
        "acos(1.5 * p.y)",
        "length(p) - 0.8 + 0.1 * exp(-4 * dot(p, p)) - 0.05 * log(p.x + 0.5) + 0.05 * sqrt(p.y) + 0.02 * "
        "pow(p.z, 1.5)",
        "p.x < 0.2 && p.y <= 0.3 || !(p.z > 0.1) ? length(p) - 0.9 : length(p) - 0.6",
        "p.x == 0.25 ? 1 : length(p) - 0.9 * sign(p.y + 2) + (p.z >= 0 ? 0.1 : 0)",
        "length(p) - 0.9 + 0.05 / (p.x + 3) - 0.01 * sinh(p.y) + 0.02 * tanh(p.z) - 0.01 * cosh(p.x)",
    };
    for (const char* code : codes) {
        const Result<Program> program = compile(test::expressionGraph(code));
        ASSERT_TRUE(program) << code << format(program.error());
        const Box box{{-1.3, -1.1, -1.2}, {1.2, 1.25, 1.35}};
        const Result<Exported3mf> file = export3mf(*program, box, unit("mm"), "part");
        ASSERT_TRUE(file) << code << " " << format(file.error());
        const Again again(file->bytes);
        ASSERT_TRUE(again.fine) << code;
        EXPECT_EQ(unitOf(again.graph).name, std::string("mm"));
        EXPECT_LE(differences(*program, again.program, box, 100'000), 1u) << code;
    }
}

TEST(Export3mf, SamplesAreTheSameOrRefusedByName) {
    std::size_t written = 0, refused = 0;
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(fs::path(FIELDWRIGHT_SOURCE_DIR) / "samples"))
        if (entry.path().string().ends_with(kGraphEnding)) files.push_back(entry.path());
    std::ranges::sort(files);
    for (const fs::path& path : files) {
        const Result<Graph> graph = readGraph(path.string(), nullptr);
        ASSERT_TRUE(graph);
        const Result<Program> program = compile(*graph, {.bake = boxInPlace});
        if (!program || !program->ir.volumes().empty()) continue;
        const Region region = findRegion(*program);
        if (region.extent != Extent::bounded) continue;
        const Result<Exported3mf> file = export3mf(*program, region.box, unit("m"), path.stem().string());
        if (!file) {
            ++refused;
            EXPECT_NE(file.error().node, "") << path;
            EXPECT_NE(file.error().message, "") << path;
            continue;
        }
        if (file->nodes > 8000) continue;  // more than a document has room for
        const Again again(file->bytes);
        ASSERT_TRUE(again.fine) << path;
        ++written;
        EXPECT_LE(differences(*program, again.program, region.box, 20'000), 2u) << path;
    }
    EXPECT_GE(written, 15u);
    EXPECT_GE(refused, 2u);
}

TEST(Export3mf, TheImportedSampleIsWhatItsFileHolds) {
    const std::string folder = std::string(FIELDWRIGHT_SOURCE_DIR) + "/samples/";
    const Result<Graph> design = readGraph(folder + "implicit/hub.field.json", nullptr),
                        sample = readGraph(folder + "imported_part.field.json", nullptr);
    ASSERT_TRUE(design && sample);
    const Result<Program> program = compile(*design);
    ASSERT_TRUE(program) << format(program.error());
    std::ifstream file(folder + "implicit/hub.3mf", std::ios::binary);
    const Again again(std::string(std::istreambuf_iterator<char>(file), {}));
    ASSERT_TRUE(again.fine);
    EXPECT_LE(differences(*program, again.program, findRegion(*program).box, 20'000), 2u);
    const auto functions = [](const Graph& graph) {
        Graph bare;
        bare.groups = graph.groups;
        for (Group& group : bare.groups)
            for (Node& node : group.nodes) node.at.reset();
        return writeGraph(bare);
    };
    EXPECT_EQ(functions(again.graph), functions(*sample));
}

TEST(Export3mf, RandomGraphsAreTheSameOrRefusedByName) {
    std::size_t written = 0;
    for (uint32_t seed = 0; seed < 120; ++seed) {
        const std::optional<Program> program = test::randomProgram(seed, 12);
        if (!program || !program->ir.volumes().empty()) continue;
        const Box box{{-2, -2, -2}, {2, 2, 2}};
        const Result<Exported3mf> file = export3mf(*program, box, unit("m"), "random");
        if (!file) {
            EXPECT_NE(file.error().message, "") << seed;
            continue;
        }
        const Again again(file->bytes);
        ASSERT_TRUE(again.fine) << seed;
        ++written;
        EXPECT_LE(differences(*program, again.program, box, 2'000), 4u) << seed;
    }
    EXPECT_GE(written, 20u);
}

TEST(Export3mf, ColoursPicturesAndMeshesComeBack) {
    test::TempDir folder;
    std::vector<uint8_t> rgb;
    for (int i = 0; i < 8 * 5 * 3; ++i) rgb.push_back(uint8_t(i * 37));
    test::writePictureFile(folder.path("relief.png"), 8, 5, rgb);
    test::writeText(folder.path("cube.obj"),
                    "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n"
                    "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
    const auto compiled = [&](const std::string& nodes) {
        Result<Graph> graph = parseGraph(R"~({"fieldwright": 1, "nodes": [)~" + nodes + "]}",
                                         folder.path("a.field.json"), nullptr);
        EXPECT_TRUE(graph);
        Result<Program> program = compile(*graph);
        EXPECT_TRUE(program) << format(program.error());
        return std::move(*program);
    };
    const Box box{{-2, -2, -2}, {2, 2, 2}};
    const Program relief = compiled(
        R"~({"id": "a", "type": "expression", "code": "length(p) - 1 - 0.2 * image_grey(\"relief.png\", p.x, p.z)"
},
           {"id": "m", "type": "material", "inputs": {"surface": {"from": "a"}, "base_color": {"from": "where"}}},
           {"id": "where", "type": "position"},
           {"id": "out", "type": "output", "inputs": {"surface": {"from": "m"}}})~");
    const Result<Exported3mf> file = export3mf(relief, box, unit("in"), "relief");
    ASSERT_TRUE(file) << format(file.error());
    const Again again(file->bytes);
    ASSERT_TRUE(again.fine);
    EXPECT_EQ(differences(relief, again.program, box, 20'000), 0u);
    for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(evaluate(again.program.ir, again.program.surface[std::size_t(baseColorComponent + k)], {},
                             Point{0.1, 0.2, 0.3}),
                    0.1 * (k + 1), 1e-12);
    EXPECT_EQ(unitOf(again.graph).name, std::string("in"));

    const Program cube = compiled(
        R"~({"id": "f", "type": "mesh_file", "inputs": {"path": "cube.obj"}},
           {"id": "s", "type": "mesh_to_field", "inputs": {"mesh": {"from": "f"}, "resolution": 32}},
           {"id": "t", "type": "translate", "inputs": {"surface": {"from": "s"}, "offset": [0.25, 0.5, 0.75]}},
           {"id": "out", "type": "output", "inputs": {"surface": {"from": "t"}}})~");
    const Result<Exported3mf> meshed = export3mf(cube, box, unit("mm"), "cube");
    ASSERT_TRUE(meshed) << format(meshed.error());
    const Again cubeAgain(meshed->bytes);
    ASSERT_TRUE(cubeAgain.fine);
    const auto at = [&](const Point& p) {
        return evaluate(cubeAgain.program.ir, cubeAgain.program.surface[0], {}, p);
    };
    EXPECT_NEAR(at({0.25, 0.5, 0.75}), -1, 0.02);
    EXPECT_NEAR(at({1.75, 0.5, 0.75}), 0.5, 0.02);
}

TEST(Export3mf, WhatCannotBeWrittenIsNamed) {
    const auto why = [](const std::string& nodes) {
        const Result<Graph> graph =
            parseGraph(R"~({"fieldwright": 1, "nodes": [)~" + nodes + "]}", "", nullptr);
        const Result<Program> program = compile(*graph);
        EXPECT_TRUE(program) << format(program.error());
        const Result<Exported3mf> file = export3mf(*program, {{-2, -2, -2}, {2, 2, 2}}, unit("m"), "part");
        return file ? std::string() : format(file.error());
    };
    const std::string noisy = why(
        R"~({"id": "ball", "type": "sphere"}, {"id": "bumps", "type": "noise"},
           {"id": "rough", "type": "displace", "inputs": {"surface": {"from": "ball"}, "amount": {"from": "bumps"}}},
           {"id": "out", "type": "output", "inputs": {"surface": {"from": "rough"}}})~");
    EXPECT_NE(noisy.find("node 'bumps'"), noisy.npos) << noisy;
    EXPECT_NE(noisy.find("random numbers"), noisy.npos) << noisy;
    const std::string words = why(
        R"~({"id": "word", "type": "text"},
           {"id": "solid", "type": "extrude", "inputs": {"surface": {"from": "word"}}},
           {"id": "out", "type": "output", "inputs": {"surface": {"from": "solid"}}})~");
    EXPECT_NE(words.find("letters"), words.npos) << words;
    const std::string cells = why(
        R"~({"id": "cells", "type": "voronoi_foam"},
           {"id": "out", "type": "output", "inputs": {"surface": {"from": "cells"}}})~");
    EXPECT_NE(cells.find("random numbers"), cells.npos) << cells;
    const std::string rounded = why(
        R"~({"id": "box", "type": "box"},
           {"id": "round", "type": "round_edges", "inputs": {"surface": {"from": "box"}, "resolution": 16}},
           {"id": "out", "type": "output", "inputs": {"surface": {"from": "round"}}})~");
    EXPECT_NE(rounded.find("measured on a grid"), rounded.npos) << rounded;
}

/// The elements of that name, each as a document of its own.
std::vector<std::string> elementsOf(const std::string& model, const std::string& name) {
    std::vector<std::string> all;
    const std::string uris =
        " xmlns:v=\"http://schemas.3mf.io/3dmanufacturing/volumetric/2022/01\""
        " xmlns:i=\"http://schemas.3mf.io/3dmanufacturing/implicit/2023/12\"";
    for (std::size_t at = 0; (at = model.find("<" + name + " ", at)) != model.npos;) {
        const std::size_t opened = model.find('>', at), closed = model.find("</" + name + ">", at);
        const std::size_t end = model[opened - 1] == '/' ? opened + 1 : closed + name.size() + 3;
        std::string text = model.substr(at, end - at);
        text.insert(name.size() + 1, uris);
        all.push_back(text);
        at = end;
    }
    return all;
}

TEST(Export3mf, IsValidByTheStandardsSchemas) {
    const fs::path schemas = fs::path(FIELDWRIGHT_SOURCE_DIR) / "../shared/reference/3mf-implicit";
    if (!fs::exists(schemas)) GTEST_SKIP() << "no schemas here";
    test::TempDir folder;
    // As published they are at odds with the specification's own examples and with every file that there is:
    // what stands in elements is to have no namespace, a function is to end with a foreign element, abs and
    // sqrt are to have two operands, constresourceid stands nowhere, and four nodes have other names. And
    // xmllint takes no numbers as large as theirs.
    for (const char* name : {"implicit.xsd", "volumetric.xsd"}) {
        std::string text = test::readText((schemas / name).string());
        /// Between these two words, if they are given.
        const auto replace = [&](const std::string& from, const std::string& to,
                                 const std::string& behind = "", const std::string& before = "") {
            std::size_t at = text.find(behind), end = text.npos;
            while ((at = text.find(from, at)) != text.npos) {
                if (!before.empty()) end = text.find(before, text.find(behind));
                if (at >= end) return;
                text.replace(at, from.size(), to);
                at += to.size();
            }
        };
        replace("maxOccurs=\"2147483647\"", "maxOccurs=\"unbounded\"");
        replace("maxOccurs=\"1073741824\"", "maxOccurs=\"unbounded\"");
        if (std::string_view(name) == "implicit.xsd") {
            replace("elementFormDefault=\"unqualified\"", "elementFormDefault=\"qualified\"");
            replace("<xs:any namespace=\"##other\" processContents=\"lax\" />",
                    "<xs:any namespace=\"##other\" processContents=\"lax\" minOccurs=\"0\" />");
            for (const char* one : {"CT_Abs", "CT_Sqrt"})
                replace("minOccurs=\"2\" maxOccurs=\"2\"", "",
                        "complexType name=\"" + std::string(one) + "\"", "\n\t</xs:complexType>");
            replace("ref=\"resourceid\"", "ref=\"constresourceid\"", "group name=\"BasicNodeTypes\"",
                    "</xs:group>");
            for (const char* angle : {"sin", "cos", "tan2", "tan"})
                replace("\"arc" + std::string(angle) + "\"", "\"a" + std::string(angle) + "\"");
        }
        test::writeText(folder.path(name), text);
    }
    const Result<Program> program = compile(test::expressionGraph(
        "q = vec3(mod(p.x, 0.5), fmod(p.y, 0.7), round(p.z));\n"
        "d = length(p) - 0.7 - 0.1 * atan2(p.x, p.z) + asin(p.y) - acos(p.z) + atan(p.x) + sqrt(p.x) + "
        "pow(p.y, 2.5);\n"
        "d = smooth_min(d, length(q) - image_grey(\"\", p.x, p.y), 0.2);\n"
        "return with_material(p.x < 0.2 ? d : d + sign(p.y) * exp(p.z) / (3 + p.x), p, 0.5, 0, vec3(0));"));
    ASSERT_TRUE(program) << format(program.error());
    const Result<Exported3mf> file = export3mf(*program, {{-2, -2, -2}, {2, 2, 2}}, unit("m"), "all");
    ASSERT_TRUE(file) << format(file.error());
    const std::string model = modelOf(file->bytes);
    const std::pair<const char*, const char*> parts[] = {{"i:implicitfunction", "implicit.xsd"},
                                                         {"v:functionfromimage3d", "volumetric.xsd"},
                                                         {"v:image3d", "volumetric.xsd"},
                                                         {"v:volumedata", "volumetric.xsd"},
                                                         {"v:levelset", "volumetric.xsd"}};
    for (const auto& [element, schema] : parts) {
        const std::vector<std::string> all = elementsOf(model, element);
        EXPECT_FALSE(all.empty()) << element;
        for (const std::string& text : all) {
            test::writeText(folder.path("part.xml"), text);
            const test::ProgramResult judged = test::runProgram(
                "xmllint --noout --schema " + folder.path(schema) + " " + folder.path("part.xml"));
            EXPECT_EQ(judged.status, 0) << element << "\n" << judged.output.substr(0, 2000);
        }
    }
}

}  // namespace fw::export3mf_test
