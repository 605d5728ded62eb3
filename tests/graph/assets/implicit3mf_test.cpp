// Implicit 3MF files as graphs: each node of the standard by its value, image stacks by the standard's rules
// over again, places, units and colours; what is refused and why; and the files of another program.
#include <gtest/gtest.h>
#include <stb/stb_image_write.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <random>

#include "graph/check/check.h"
#include "graph/compile/compile.h"
#include "graph/document/json.h"
#include "graph/document/unit.h"
#include "graph/implicit3mf/import.h"
#include "graph/implicit3mf/model.h"
#include "graph/implicit3mf/package.h"
#include "tests/support/graph/implicit_model.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::implicit3mf_test {

namespace fs = std::filesystem;
using test::kBallFunction;
using test::kLevelSet;
using test::modelPackage;
using test::modelText;

/// An input "A=vector:inputs.pos" as an element.
std::string inputs(const std::string& list) {
    std::string text;
    std::istringstream words(list);
    for (std::string word; words >> word;) {
        const std::size_t equals = word.find('='), colon = word.find(':');
        text += "<i:" + word.substr(equals + 1, colon - equals - 1) + "ref identifier='" +
                word.substr(0, equals) + "' ref='" + word.substr(colon + 1) + "'/>";
    }
    return text;
}

/// <i:KIND identifier='ID'> with inputs as above and outputs "result:scalar".
std::string node(const std::string& kind, const std::string& id, const std::string& given,
                 const std::string& results, const std::string& attributes = "") {
    std::string outputs;
    std::istringstream words(results);
    for (std::string word; words >> word;)
        outputs += "<i:" + word.substr(word.find(':') + 1) + " identifier='" +
                   word.substr(0, word.find(':')) + "'/>";
    return "<i:" + kind + " identifier='" + id + "' " + attributes + "><i:in>" + inputs(given) +
           "</i:in><i:out>" + outputs + "</i:out></i:" + kind + ">";
}

std::string function(int id, const std::string& name, const std::string& nodes, const std::string& result,
                     const std::string& sockets = "<i:vector identifier='pos'/>") {
    return "<i:implicitfunction id='" + std::to_string(id) + "' displayname='" + name + "'><i:in>" + sockets +
           "</i:in>" + nodes + "<i:out>" + inputs(result) + "</i:out></i:implicitfunction>";
}

/// A model whose level set is function 5, of these nodes, where `parts` takes the position apart.
std::string shapeOf(const std::string& nodes, const std::string& result, const std::string& before = "") {
    return modelText(
        before +
            function(
                5, "main",
                node("decomposevector", "parts", "A=vector:inputs.pos", "x:scalar y:scalar z:scalar") + nodes,
                "shape=scalar:" + result) +
            kLevelSet,
        "<item objectid='9'/>");
}

/// A graph beside its files, compiled.
struct Shape {
    explicit Shape(const std::string& bytes) {
        Result<Imported> made = import3mf(bytes, "part.3mf", "part_3mf");
        if (!made) {
            error = format(made.error());
            return;
        }
        for (const FileBeside& file : made->files) {
            fs::create_directories(fs::path(folder.path(file.path)).parent_path());
            test::writeText(folder.path(file.path), file.bytes);
        }
        imported = std::move(*made);
        const Graph again = *parseGraph(writeGraph(imported.graph), folder.path("part.field.json"), nullptr);
        for (const Error& finding : check(again))
            if (finding.severity == Error::Severity::error) error += format(finding) + "\n";
        Result<Program> compiled = compile(again);
        if (!compiled) return;
        program = std::move(*compiled);
    }
    /// In the model's own coordinates, z up.
    double at(double x, double y, double z) const {
        return evaluate(program.ir, program.surface[0], {}, Point{x, z, -y});
    }
    const Node* node(std::string_view type) const {
        for (const Node& each : imported.graph.nodes)
            if (each.type == type) return &each;
        return nullptr;
    }
    test::TempDir folder;
    Imported imported;
    Program program;
    std::string error;
};

std::string whyNot(const std::string& model) { return Shape(modelPackage(model)).error; }

TEST(Implicit3mf, NodesOfNumbersHaveTheirValues) {
    struct Case {
        const char* kind;
        const char* given;
        double (*value)(double, double, double);
    };
    const char* one = "A=scalar:parts.x";
    const char* two = "A=scalar:parts.x B=scalar:parts.y";
    const Case cases[] = {
        {"addition", two, [](double x, double y, double) { return x + y; }},
        {"subtraction", two, [](double x, double y, double) { return x - y; }},
        {"multiplication", two, [](double x, double y, double) { return x * y; }},
        {"division", two, [](double x, double y, double) { return x / y; }},
        {"sin", one, [](double x, double, double) { return std::sin(x); }},
        {"cos", one, [](double x, double, double) { return std::cos(x); }},
        {"tan", one, [](double x, double, double) { return std::tan(x); }},
        {"arcsin", one, [](double x, double, double) { return std::asin(x); }},
        {"asin", one, [](double x, double, double) { return std::asin(x); }},
        {"arccos", one, [](double x, double, double) { return std::acos(x); }},
        {"acos", one, [](double x, double, double) { return std::acos(x); }},
        {"arctan", one, [](double x, double, double) { return std::atan(x); }},
        {"arctan2", two, [](double x, double y, double) { return std::atan2(x, y); }},
        {"atan2", two, [](double x, double y, double) { return std::atan2(x, y); }},
        {"sinh", one, [](double x, double, double) { return std::sinh(x); }},
        {"cosh", one, [](double x, double, double) { return std::cosh(x); }},
        {"tanh", one, [](double x, double, double) { return std::tanh(x); }},
        {"min", two, [](double x, double y, double) { return std::min(x, y); }},
        {"max", two, [](double x, double y, double) { return std::max(x, y); }},
        {"abs", one, [](double x, double, double) { return std::abs(x); }},
        {"fmod", two, [](double x, double y, double) { return std::fmod(x, y); }},
        {"mod", two, [](double x, double y, double) { return x - y * std::floor(x / y); }},
        {"pow", two, [](double x, double y, double) { return x > 0 ? std::pow(x, y) : 0.0; }},
        {"sqrt", one, [](double x, double, double) { return std::sqrt(std::max(x, 0.0)); }},
        {"exp", one, [](double x, double, double) { return std::exp(x); }},
        {"log", one, [](double x, double, double) { return std::log(std::max(x, 1e-30)); }},
        {"log2", one, [](double x, double, double) { return std::log2(std::max(x, 1e-30)); }},
        {"log10", one, [](double x, double, double) { return std::log10(std::max(x, 1e-30)); }},
        {"clamp", "A=scalar:parts.x min=scalar:lo.value max=scalar:hi.value",
         [](double x, double, double) { return std::clamp(x, -0.3, 0.4); }},
        {"select", "A=scalar:parts.x B=scalar:parts.y C=scalar:parts.z D=scalar:hi.value",
         [](double x, double y, double z) { return x < y ? z : 0.4; }},
        {"round", one, [](double x, double, double) { return std::round(x); }},
        {"ceil", one, [](double x, double, double) { return std::ceil(x); }},
        {"floor", one, [](double x, double, double) { return std::floor(x); }},
        {"sign", one, [](double x, double, double) { return double(x > 0) - double(x < 0); }},
        {"fract", one, [](double x, double, double) { return x - std::floor(x); }},
    };
    const std::string constants = node("constant", "lo", "", "value:scalar", "value='-0.3'") +
                                  node("constant", "hi", "", "value:scalar", "value='0.4'");
    const double places[][3] = {{0.3, 0.7, 0.1}, {-0.6, 0.45, -2}, {0.9, -0.35, 0.5}};
    for (const Case& c : cases) {
        const Shape shape(
            modelPackage(shapeOf(constants + node(c.kind, "n", c.given, "result:scalar"), "n.result")));
        EXPECT_EQ(shape.error, "") << c.kind;
        if (!shape.error.empty()) continue;
        for (const auto& p : places)
            EXPECT_NEAR(shape.at(p[0], p[1], p[2]), c.value(p[0], p[1], p[2]), 1e-12) << c.kind;
        // The same of each component of a vector: (x, y, z) with (y, z, x) and so on, then their sum.
        std::string given = c.given;
        for (const char* const* swap =
                 (const char* const[]){"scalar:parts.x", "vector:inputs.pos", "scalar:parts.y",
                                       "vector:b.result", "scalar:parts.z", "vector:c.result",
                                       "scalar:lo.value", "vector:vlo.result", "scalar:hi.value",
                                       "vector:vhi.result", nullptr};
             *swap; swap += 2)
            if (const std::size_t found = given.find(swap[0]); found != given.npos)
                given.replace(found, std::string(swap[0]).size(), swap[1]);
        const std::string more =
            constants + node("vectorfromscalar", "vlo", "A=scalar:lo.value", "result:vector") +
            node("vectorfromscalar", "vhi", "A=scalar:hi.value", "result:vector") +
            node("composevector", "b", "x=scalar:parts.y y=scalar:parts.z z=scalar:parts.x",
                 "result:vector") +
            node("composevector", "c", "x=scalar:parts.z y=scalar:parts.x z=scalar:parts.y",
                 "result:vector") +
            node("constvec", "ones", "", "vector:vector", "x='1' y='10' z='100'") +
            node(c.kind, "n", given, "result:vector") +
            node("dot", "sum", "A=vector:n.result B=vector:ones.vector", "result:scalar");
        const Shape vectors(modelPackage(shapeOf(more, "sum.result")));
        EXPECT_EQ(vectors.error, "") << c.kind;
        const double x = 0.3, y = 0.7, z = 0.45;
        const double sum = c.value(x, y, z) + 10 * c.value(y, z, x) + 100 * c.value(z, x, y);
        if (!vectors.error.empty()) continue;
        EXPECT_NEAR(vectors.at(x, y, z), sum, 1e-10) << c.kind;
    }
}

TEST(Implicit3mf, DivisionByZeroIsVeryLarge) {
    // The blend that programs write, of radius 0: the lesser of the two.
    const std::string blend =
        node("constant", "zero", "", "value:scalar", "value='0'") +
        node("constant", "one", "", "value:scalar", "value='1'") +
        node("subtraction", "d", "A=scalar:parts.y B=scalar:parts.x", "result:scalar") +
        node("division", "q", "A=scalar:d.result B=scalar:zero.value", "result:scalar") +
        node("clamp", "h", "A=scalar:q.result min=scalar:zero.value max=scalar:one.value", "result:scalar") +
        node("multiplication", "m", "A=scalar:d.result B=scalar:h.result", "result:scalar") +
        node("subtraction", "r", "A=scalar:parts.y B=scalar:m.result", "result:scalar");
    const Shape shape(modelPackage(shapeOf(blend, "r.result")));
    ASSERT_EQ(shape.error, "");
    EXPECT_NEAR(shape.at(3, 5, 0), 3, 1e-12);
    EXPECT_NEAR(shape.at(5, 3, 0), 3, 1e-12);
}

TEST(Implicit3mf, MatricesMultiplyRows) {
    const auto matrix = [](const char* text) {
        return node("constmat", "m", "", "matrix:matrix", "matrix='" + std::string(text) + "'");
    };
    const auto applied = [&](const std::string& nodes, const char* from) {
        return modelPackage(
            shapeOf(nodes +
                        node("matvecmultiplication", "v",
                             std::string("A=matrix:") + from + " B=vector:inputs.pos", "result:vector") +
                        node("constvec", "ones", "", "vector:vector", "x='1' y='10' z='100'") +
                        node("dot", "sum", "A=vector:v.result B=vector:ones.vector", "result:scalar"),
                    "sum.result"));
    };
    const char* text = "1 2 0 0  0 1 0.5 0  3 0 1 0  5 6 7 1";
    const Shape plain(applied(matrix(text), "m.matrix"));
    ASSERT_EQ(plain.error, "");
    // x' = x + 3 z + 5, y' = 2 x + y + 6, z' = 0.5 y + z + 7
    EXPECT_NEAR(plain.at(1, 2, 3), 15 + 10 * 10 + 100 * 11, 1e-12);
    const Shape turned(
        applied(matrix(text) + node("transpose", "t", "A=matrix:m.matrix", "result:matrix"), "t.result"));
    ASSERT_EQ(turned.error, "");
    EXPECT_NEAR(turned.at(1, 2, 3), (1 + 4) + 10 * (2 + 1.5) + 100 * (3 + 3), 1e-12);
    const Shape back(
        applied(matrix(text) + node("inverse", "t", "A=matrix:m.matrix", "result:matrix"), "t.result"));
    ASSERT_EQ(back.error, "");
    EXPECT_NEAR(back.at(15, 10, 11), 1 + 20 + 300, 1e-10);
    const Shape rows(applied(
        node("constvec", "a", "", "vector:vector", "x='1' y='2' z='0'") +
            node("constvec", "b", "", "vector:vector", "x='0' y='1' z='0.5'") +
            node("constvec", "c", "", "vector:vector", "x='3' y='0' z='1'") +
            node("constvec", "d", "", "vector:vector", "x='5' y='6' z='7'") +
            node("matrixfromrows", "t",
                 "A=vector:a.vector B=vector:b.vector C=vector:c.vector D=vector:d.vector", "result:matrix"),
        "t.result"));
    ASSERT_EQ(rows.error, "");
    EXPECT_NEAR(rows.at(1, 2, 3), 15 + 100 + 1100, 1e-12);
}

TEST(Implicit3mf, FunctionsAreGroups) {
    const std::string ball =
        function(3, "Ball of size",
                 node("length", "l", "A=vector:inputs.pos", "result:scalar") +
                     node("subtraction", "s", "A=scalar:l.result B=scalar:inputs.radius", "result:scalar"),
                 "shape=scalar:s.result", "<i:vector identifier='pos'/><i:scalar identifier='radius'/>");
    const std::string main =
        node("constant", "r", "", "value:scalar", "displayname='radius' value='2.5'") +
        node("constresourceid", "which", "", "value:resourceid", "value='3'") +
        node("functioncall", "call",
             "functionID=resource:which.value pos=vector:inputs.pos radius=scalar:r.value", "shape:scalar");
    const Shape shape(modelPackage(shapeOf(main, "call.shape", ball)));
    ASSERT_EQ(shape.error, "");
    EXPECT_NEAR(shape.at(3, 0, 4), 2.5, 1e-12);
    const Group* group = shape.imported.graph.group("ball_of_size");
    ASSERT_NE(group, nullptr);
    EXPECT_EQ(group->inputs.size(), 2u);
    const Group* whole = shape.imported.graph.group("main");
    ASSERT_NE(whole, nullptr);
    const Node* call = findNode(whole->nodes, "call");
    ASSERT_NE(call, nullptr);
    EXPECT_EQ(call->group, "ball_of_size");
    EXPECT_EQ(std::get<double>(call->input("radius")->value), 2.5)
        << "a number that one input has stands there";
}

TEST(Implicit3mf, FunctionsTakeFunctions) {
    const std::string twice = function(
        3, "twice",
        node("functioncall", "a", "functionID=resource:inputs.f pos=vector:inputs.pos", "shape:scalar") +
            node("addition", "s", "A=scalar:a.shape B=scalar:a.shape", "result:scalar"),
        "shape=scalar:s.result", "<i:vector identifier='pos'/><i:resourceid identifier='f'/>");
    const std::string size = function(4, "size", node("length", "l", "A=vector:inputs.pos", "result:scalar"),
                                      "shape=scalar:l.result");
    const std::string main =
        node("constresourceid", "which", "", "value:resourceid", "value='3'") +
        node("constresourceid", "of", "", "value:resourceid", "value='4'") +
        node("functioncall", "call",
             "functionID=resource:which.value pos=vector:inputs.pos f=resource:of.value", "shape:scalar");
    const Shape shape(modelPackage(shapeOf(main, "call.shape", twice + size)));
    ASSERT_EQ(shape.error, "");
    EXPECT_NEAR(shape.at(3, 0, 4), 10, 1e-12);
}

// ---- pictures

std::string png(int width, int height, int channels, const std::vector<unsigned char>& bytes) {
    std::string text;
    stbi_write_png_to_func(
        [](void* to, void* data, int size) {
            static_cast<std::string*>(to)->append(static_cast<const char*>(data), std::size_t(size));
        },
        &text, width, height, channels, bytes.data(), width * channels);
    return text;
}

TEST(Implicit3mf, ImageStacksAreSampledByTheStandardsRules) {
    constexpr int kWide = 4, kHigh = 3;
    std::mt19937 random(7);
    for (int trial = 0; trial < 24; ++trial) {
        const int sheets = trial % 2 ? 5 : 1;
        const bool nearest = trial % 3 == 0;
        const char* const styles[] = {"wrap", "mirror", "clamp"};
        const int style[3] = {trial % 3, (trial / 2) % 3, (trial / 4) % 3};
        std::vector<std::vector<unsigned char>> pixels(std::size_t(sheets),
                                                       std::vector<unsigned char>(kWide * kHigh * 3));
        std::vector<threemf::Part> parts;
        std::string list;
        for (int k = 0; k < sheets; ++k) {
            for (unsigned char& byte : pixels[std::size_t(k)])
                byte = static_cast<unsigned char>(random() & 255);
            const std::string name = "volume/s" + std::to_string(k) + ".png";
            parts.push_back({name, png(kWide, kHigh, 3, pixels[std::size_t(k)])});
            list += "<v:imagesheet path='/" + name + "'/>";
        }
        const std::string stack =
            "<v:image3d id='7'><v:imagestack rowcount='3' columncount='4' sheetcount='" +
            std::to_string(sheets) + "'>" + list +
            "</v:imagestack></v:image3d><v:functionfromimage3d id='8' image3did='7' "
            "valueoffset='-0.25' valuescale='2' filter='" +
            (nearest ? "nearest" : "linear") + "' tilestyleu='" + styles[style[0]] + "' tilestylev='" +
            styles[style[1]] + "' tilestylew='" + styles[style[2]] + "'/>";
        const std::string main =
            node("constresourceid", "which", "", "value:resourceid", "value='8'") +
            node("functioncall", "call", "functionID=resource:which.value pos=vector:inputs.pos",
                 "green:scalar");
        const Shape shape(modelPackage(shapeOf(main, "call.green", stack), parts));
        ASSERT_EQ(shape.error, "");

        const auto folded = [](int at, int n, int how) {  // the voxel that stands at `at` beyond the edges
            if (how == 2) return std::clamp(at, 0, n - 1);
            const int period = how == 0 ? n : 2 * n, m = ((at % period) + period) % period;
            return m < n ? m : 2 * n - 1 - m;
        };
        const auto voxel = [&](int column, int up, int sheet) {
            const int c = folded(column, kWide, style[0]), row = kHigh - 1 - folded(up, kHigh, style[1]),
                      s = folded(sheet, sheets, style[2]);
            return pixels[std::size_t(s)][std::size_t((row * kWide + c) * 3 + 1)] / 255.0;
        };
        std::uniform_real_distribution<double> anywhere(-2.3, 2.7);
        for (int i = 0; i < 200; ++i) {
            const double p[3] = {anywhere(random), anywhere(random), anywhere(random)};
            const int n[3] = {kWide, kHigh, sheets};
            double value = 0;
            if (nearest) {
                value = voxel(int(std::floor(p[0] * n[0])), int(std::floor(p[1] * n[1])),
                              int(std::floor(p[2] * n[2])));
            } else {
                int low[3];
                double part[3];
                for (int a = 0; a < 3; ++a) {
                    const double at = p[a] * n[a] - 0.5;
                    low[a] = int(std::floor(at)), part[a] = at - std::floor(at);
                }
                for (int corner = 0; corner < 8; ++corner) {
                    double weight = 1;
                    for (int a = 0; a < 3; ++a) weight *= corner >> a & 1 ? part[a] : 1 - part[a];
                    value += weight *
                             voxel(low[0] + (corner & 1), low[1] + (corner >> 1 & 1), low[2] + (corner >> 2));
                }
            }
            EXPECT_NEAR(shape.at(p[0], p[1], p[2]), 2 * value - 0.25, 1e-9)
                << trial << ": " << p[0] << " " << p[1] << " " << p[2];
        }
    }
}

// ---- objects

TEST(Implicit3mf, ObjectsStandWhereTheyAreBuilt) {
    // Turned by 90 degrees about z (x becomes y), twice as large, moved; and one that is mirrored.
    const std::string set =
        "<object id='9'><v:levelset functionid='5' channel='shape' meshid='1' transform='1 0 0 0 1 0 0 0 1 "
        "-20 0 0'/>"
        "</object>";
    const Shape turned(modelPackage(
        modelText(kBallFunction + set, "<item objectid='9' transform='0 2 0 -2 0 0 0 0 2 100 200 300'/>")));
    ASSERT_EQ(turned.error, "");
    // The ball's centre, (20, 0, 0), is at (100, 240, 300), its radius 20.
    EXPECT_NEAR(turned.at(100, 240, 300), -20, 1e-9);
    EXPECT_NEAR(turned.at(100, 240, 325), 5, 1e-9);
    const Shape mirrored(modelPackage(
        modelText(kBallFunction + set, "<item objectid='9' transform='-1 0 0 0 1 0 0 0 1 0 0 0'/>")));
    ASSERT_EQ(mirrored.error, "");
    EXPECT_NEAR(mirrored.at(-20, 0, 0), -10, 1e-9);
    const Shape both(modelPackage(
        modelText(kBallFunction + set +
                      "<object id='10'><components><component objectid='9'/><component "
                      "objectid='9' transform='1 0 0 0 1 0 0 0 1 0 50 0'/></components></object>",
                  "<item objectid='10'/>")));
    ASSERT_EQ(both.error, "");
    EXPECT_NEAR(both.at(20, 0, 0), -10, 1e-9);
    EXPECT_NEAR(both.at(20, 50, 0), -10, 1e-9);
    EXPECT_GT(both.at(0, 25, 0), 0);
}

TEST(Implicit3mf, UnitsColoursAndBoundsAreTaken) {
    const std::string painted =
        "<m:colorgroup xmlns:m='http://schemas.microsoft.com/3dmanufacturing/material/2015/02' id='2'>"
        "<m:color color='#FF0000FF'/></m:colorgroup>" +
        std::string(kBallFunction) +
        "<object id='9' pid='2' pindex='0'><v:levelset functionid='5' channel='shape' meshid='1'/></object>";
    const Shape inches(modelPackage(modelText(painted, "<item objectid='9'/>", "unit='inch'")));
    ASSERT_EQ(inches.error, "");
    EXPECT_STREQ(unitOf(inches.imported.graph).name, "in");
    ASSERT_NE(inches.node("material"), nullptr);
    EXPECT_EQ(std::get<std::vector<double>>(inches.node("material")->input("base_color")->value),
              (std::vector<double>{1, 0, 0}));
    EXPECT_NE(inches.node("box"), nullptr) << "bounds that are a box are one";
    const Shape feet(modelPackage(modelText(painted, "<item objectid='9'/>", "unit='foot'")));
    ASSERT_EQ(feet.error, "");
    EXPECT_NEAR(feet.at(0, 0, 0), -120, 1e-9);
    // A colour that is a function.
    const Shape field(modelPackage(modelText(
        std::string(kBallFunction) + function(6, "rainbow", "", "color=vector:inputs.pos") +
            "<v:volumedata id='7'><v:color functionid='6' channel='color'/></v:volumedata>"
            "<object id='9'><v:levelset functionid='5' channel='shape' meshid='1' volumeid='7'/></object>",
        "<item objectid='9'/>")));
    ASSERT_EQ(field.error, "");
    EXPECT_NEAR(
        evaluate(field.program.ir, field.program.surface[baseColorComponent + 2], {}, Point{0, 0.5, 0}), 0.5,
        1e-12);
}

TEST(Implicit3mf, MeshesAreFields) {
    const std::string main =
        node("constresourceid", "which", "", "value:resourceid", "value='1'") +
        node("mesh", "m", "pos=vector:inputs.pos mesh=resource:which.value", "distance:scalar");
    const Shape shape(modelPackage(shapeOf(main, "m.distance")));
    ASSERT_EQ(shape.error, "");
    EXPECT_NEAR(shape.at(0, 0, 900), -100, 0.5);
    EXPECT_NEAR(shape.at(0, 1010, 0), 10, 0.5);
    ASSERT_EQ(shape.imported.files.size(), 1u);
    EXPECT_EQ(shape.imported.files[0].path, "part_3mf/mesh_1.ply");
}

// ---- what is refused

TEST(Implicit3mf, WhatMakesNoSenseIsRefusedByName) {
    const auto refused = [](const std::string& model, const char* words) {
        const std::string error = whyNot(model);
        EXPECT_NE(error.find("part.3mf: error:"), error.npos) << error;
        EXPECT_NE(error.find(words), error.npos) << error;
    };
    const auto shape = [](const std::string& nodes, const std::string& result, const std::string& more = "") {
        return shapeOf(nodes, result, more);
    };
    refused(shape(node("abs", "n", "A=scalar:m.result", "result:scalar") +
                      node("abs", "m", "A=scalar:n.result", "result:scalar"),
                  "n.result"),
            "refers to itself by way of others");
    refused(shape(node("abs", "n", "A=scalar:gone.result", "result:scalar"), "n.result"),
            "there is no 'gone.result'");
    refused(shape(node("abs", "n", "A=scalar:inputs.pos", "result:scalar"), "n.result"), "is a vector");
    refused(shape(node("addition", "n", "A=scalar:parts.x B=vector:inputs.pos", "result:scalar"), "n.result"),
            "mixes a scalar with a vector");
    refused(shape(node("abs", "n", "A=scalar:parts.x", "result:vector"), "n.result"), "gives a scalar");
    refused(shape(node("addition", "n", "A=scalar:parts.x", "result:scalar"), "n.result"),
            "is not given 'B'");
    refused(shape(node("beamlattice", "n", "A=scalar:parts.x", "result:scalar"), "n.result"),
            "is of a kind that is not known here");
    refused(shape(node("constresourceid", "f", "", "value:resourceid", "value='5'") +
                      node("functioncall", "n", "functionID=resource:f.value pos=vector:inputs.pos",
                           "shape:scalar"),
                  "n.shape"),
            "calls itself");
    refused(shape(node("constresourceid", "f", "", "value:resourceid", "value='77'") +
                      node("functioncall", "n", "functionID=resource:f.value pos=vector:inputs.pos",
                           "shape:scalar"),
                  "n.shape"),
            "calls the function 77, and there is none");
    refused(shape(node("constant", "n", "", "value:scalar", "value='much'"), "n.value"), "no number");
    refused(modelText(kBallFunction, "<item objectid='9'/>"), "asks for the object 9, and there is none");
    refused(modelText(kBallFunction + std::string(kLevelSet), ""), "it builds nothing");
    refused(modelText(kBallFunction + std::string(kBallFunction), ""), "two resources have the id 5");
    refused(modelText("<object id='9'><components><component objectid='9'/></components></object>",
                      "<item objectid='9'/>"),
            "is a component of itself");
    refused(modelText(kBallFunction + std::string(kLevelSet), "<item objectid='9' transform='1 0 0'/>"),
            "is not of twelve numbers");
    refused(modelText(kBallFunction + std::string(kLevelSet),
                      "<item objectid='9' transform='1 0 0 0 1 0 0 0 0 0 0 0'/>"),
            "makes it flat");
    refused(modelText(kBallFunction + std::string(kLevelSet), "<item objectid='9'/>",
                      "requiredextensions='s' xmlns:s='urn:slices'"),
            "urn:slices");
    refused(modelText(kBallFunction + std::string(kLevelSet), "<item objectid='9'/>", "unit='ell'"),
            "unit 'ell'");
    refused("<model><resources>", "damaged in line 1");
    std::string deep;
    for (int i = 0; i < 100; ++i)
        deep += function(
            100 + i, "f",
            node("constresourceid", "f", "", "value:resourceid", "value='" + std::to_string(101 + i) + "'") +
                node("functioncall", "n", "functionID=resource:f.value pos=vector:inputs.pos",
                     "shape:scalar"),
            "shape=scalar:n.shape");
    refused(shape(node("constresourceid", "f", "", "value:resourceid", "value='100'") +
                      node("functioncall", "n", "functionID=resource:f.value pos=vector:inputs.pos",
                           "shape:scalar"),
                  "n.shape", deep),
            "a graph nests no deeper");
}

TEST(Implicit3mf, DamagedAndBoundlessArchivesAreRefused) {
    const auto why = [](const std::string& bytes) {
        const Result<Imported> imported = import3mf(bytes, "part.3mf", "part_3mf");
        return imported ? "" : imported.error().message;
    };
    EXPECT_NE(why("").find("empty"), std::string::npos);
    EXPECT_NE(why("solid nonsense").find("no ZIP archive"), std::string::npos);
    EXPECT_NE(why(threemf::packed({{"readme.txt", "hello"}})).find("is no 3MF file"), std::string::npos);
    const std::string whole = modelPackage(shapeOf("", "parts.x"));
    EXPECT_EQ(why(whole), "");
    for (std::size_t cut = 1; cut < whole.size(); cut += 37) EXPECT_NE(why(whole.substr(0, cut)), "") << cut;
    EXPECT_NE(
        why(modelPackage(std::string(threemf::kMostModelBytes + 1, ' '))).find("unpacks to more than 64 MB"),
        std::string::npos);
    std::string many = "<model>";
    for (std::size_t i = 0; i < 2 * threemf::kMostElements; ++i) many += "<a/>";
    EXPECT_NE(why(modelPackage(many)).find("elements"), std::string::npos);
}

TEST(Implicit3mf, WhatIsLeftAwayIsNamed) {
    const std::string more =
        "<m:texture2d xmlns:m='urn:m' id='30' path='/a.png'/>"
        "<i:implicitfunction id='31' displayname='odd'><i:in/><i:normalizedistance "
        "identifier='n'><i:in/><i:out/>"
        "</i:normalizedistance><i:out/></i:implicitfunction>";
    const Shape shape(modelPackage(modelText(kBallFunction + more + kLevelSet, "<item objectid='9'/>")));
    ASSERT_EQ(shape.error, "");
    std::string all;
    for (const Error& warning : shape.imported.warnings) all += format(warning) + "\n";
    EXPECT_NE(all.find("warning: the resource 'texture2d' is left away"), all.npos) << all;
    EXPECT_NE(all.find("normalizedistance"), all.npos) << all;
    // Objects that stand beside the model, and what a mesh is parted in.
    std::string other =
        modelText(kBallFunction + std::string(kLevelSet), "<item objectid='9'/><item objectid='1'/>");
    other.replace(other.find("<object id='1'>"), 15, "<object id='1' type='support'>");
    other.replace(other.find("</triangles>"), 12, "</triangles><trianglesets/>");
    const Shape beside(modelPackage(other));
    ASSERT_EQ(beside.error, "");
    all.clear();
    for (const Error& warning : beside.imported.warnings) all += format(warning) + "\n";
    EXPECT_NE(all.find("warning: the object 1, of the type 'support', is left away"), all.npos) << all;
    EXPECT_NE(all.find("warning: 'trianglesets' of the object 1 is left away"), all.npos) << all;
}

// ---- files of another program

TEST(Implicit3mf, FilesOfAnotherProgramBecomeSoundGraphs) {
    const char* given = std::getenv("FIELDWRIGHT_CORPUS");
    const fs::path folder =
        (given ? fs::path(given) : fs::path(FIELDWRIGHT_SOURCE_DIR) / "../shared/corpus") / "implicit3mf";
    if (!fs::exists(folder)) GTEST_SKIP() << "no corpus here (FIELDWRIGHT_CORPUS)";
    std::size_t seen = 0;
    for (const auto& entry : fs::directory_iterator(folder)) {
        if (entry.path().extension() != k3mfEnding) continue;
        ++seen;
        const Shape shape(test::readText(entry.path().string()));
        EXPECT_EQ(shape.error, "") << entry.path();
        const Region region = findRegion(shape.program);
        EXPECT_EQ(region.extent, Extent::bounded) << entry.path();
    }
    EXPECT_GE(seen, 13u);
}

}  // namespace fw::implicit3mf_test
