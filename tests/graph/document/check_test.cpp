#include "graph/check/check.h"
#include "graph/compile/compile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "graph/document/json.h"
#include "graph/document/sockets.h"

namespace fw::check_test {

/// Findings of a document whose nodes (and further top-level keys) are these, as a user sees them.
std::vector<std::string> findingsOf(
    const std::string& nodes, const std::string& more = "",
    const std::function<std::vector<Error>(const Graph&)>& find = checkStructure) {
    const Result<Graph> graph =
        parseGraph("{\"fieldwright\": 1, \"nodes\": [" + nodes + "]" + more + "}", "a.field.json", nullptr);
    EXPECT_TRUE(graph) << (graph ? "" : format(graph.error()));
    std::vector<std::string> texts;
    if (graph)
        for (const Error& finding : find(*graph)) texts.push_back(format(finding));
    return texts;
}

std::string joined(const std::vector<std::string>& texts) {
    std::string all;
    for (const std::string& text : texts) all += text + "\n";
    return all;
}

constexpr const char* kBall =
    R"({"id": "ball", "type": "sphere"}, {"id": "out", "type": "output", "inputs": {"surface": {"from": "ball"}}})";

std::vector<std::string> besideBall(const std::string& nodes, const std::string& more = "") {
    return findingsOf(std::string(kBall) + (nodes.empty() ? "" : ", ") + nodes, more);
}

/// Expects exactly one finding, which contains each of these.
void expectOne(const std::vector<std::string>& findings, std::initializer_list<const char*> parts) {
    EXPECT_EQ(findings.size(), 1u) << joined(findings);
    for (const char* part : parts)
        EXPECT_NE(joined(findings).find(part), std::string::npos) << part << "\n" << joined(findings);
}

TEST(Check, FindsNothingInASoundGraph) {
    EXPECT_TRUE(besideBall("").empty()) << joined(besideBall(""));
    EXPECT_TRUE(
        besideBall(
            R"({"id": "e", "type": "expression", "code": "return length(p) - r;", "inputs": {"r": 1, "v": [1, 2, 3]}})")
            .empty());
}

TEST(Check, EveryTypeOfTheLibraryPassesWithItsDefaults) {
    for (const NodeType& type : nodeTypes()) {
        if (type.open || type.id == "output") continue;
        for (const std::string& text : besideBall("{\"id\": \"n\", \"type\": \"" + type.id + "\"}")) {
            const bool empty = text.find("counts as empty space") != std::string::npos;
            const bool stage = text.find("link a node that gives ") != std::string::npos;
            EXPECT_TRUE(empty || stage) << text;
        }
    }
}

TEST(Check, UnknownNames) {
    expectOne(besideBall(R"({"id": "n", "type": "sphre"})"),
              {"error: node 'n': unknown node type 'sphre'; did you mean 'sphere'?"});
    expectOne(besideBall(R"({"id": "n", "type": "qqqqqqqqqq"})"),
              {"unknown node type 'qqqqqqqqqq'; 'fieldwright nodes' lists all"});
    expectOne(besideBall(R"({"id": "n", "type": "sphere", "inputs": {"radus": 2}})"),
              {"node 'n', input 'radus': unknown input of a node of type 'sphere'; did you mean 'radius'?"});
    expectOne(besideBall(R"({"id": "n", "type": "sphere", "inputs": {"zzzzzzzz": 2}})"),
              {"it has p, radius"});
    expectOne(besideBall(R"({"id": "n", "type": "translate", "inputs": {"surface": {"from": "bal"}}})"),
              {"node 'n', input 'surface': there is no node 'bal'; did you mean 'ball'?"});
    expectOne(
        besideBall(
            R"({"id": "n", "type": "translate", "inputs": {"surface": {"from": "ball", "output": "surfac"}}})"),
        {"node 'ball' has no output 'surfac'; did you mean 'surface'?"});
    expectOne(besideBall(R"({"id": "n", "type": "translate", "inputs": {"surface": {"from": "out"}}})"),
              {"node 'out' of type 'output' has no output to link to"});
}

TEST(Check, NamesThePlaceOfAFinding) {
    const std::vector<std::string> findings =
        findingsOf("\n" + std::string(kBall) +
                   ",\n {\"id\": \"n\", \"type\": \"sphere\",\n  \"inputs\": {\"radius\": true}}");
    expectOne(findings,
              {"a.field.json:4:24: error: node 'n', input 'radius': expected a number or a link, not true"});
}

TEST(Check, ValuesThatDoNotFit) {
    const auto box = [](const std::string& input) {
        return besideBall("{\"id\": \"n\", \"type\": \"box\", \"inputs\": {" + input + "}}");
    };
    expectOne(box("\"half_extents\": 1"), {"expected three numbers [x, y, z] or a link, not the number 1"});
    expectOne(box("\"half_extents\": [1, 2]"), {"not an array of 2 numbers"});
    expectOne(box("\"half_extents\": [[1, 2]]"), {"not an array of 1 pair"});
    expectOne(box("\"half_extents\": []"), {"not an empty array"});
    expectOne(box("\"half_extents\": [1, -2, 1]"), {"the value -2 is out of range: it must be at least 0"});
    expectOne(box("\"rounding\": \"soft\""), {"expected a number or a link, not the string 'soft'"});
    expectOne(box("\"rounding\": [1, 2, 3]"), {"not an array of 3 numbers"});
    const auto join = [](const std::string& input) {
        return besideBall(
            "{\"id\": \"n\", \"type\": \"union\", \"inputs\": {\"a\": {\"from\": \"ball\"}, \"b\": "
            "{\"from\": \"ball\"}, " +
            input + "}}");
    };
    expectOne(join("\"profile\": \"rond\""),
              {"'rond' is none of its options; did you mean 'round'?; they are round, chamfer, stairs"});
    expectOne(join("\"profile\": 3"), {"expected a string, not the number 3"});
    expectOne(join("\"steps\": 2.5"), {"expected a whole number, not the number 2.5"});
    expectOne(join("\"steps\": 0"), {"out of range: it must be at least 1 and at most"});
    expectOne(join("\"steps\": 1e12"), {"beyond 32 bits"});
    expectOne(besideBall(R"({"id": "n", "type": "translate", "inputs": {"surface": 1}})"),
              {"expected a link to a node with a surface"});
    for (const char* resolution : {"0", "-5", "1000000000"})
        expectOne(findingsOf("{\"id\": \"b\", \"type\": \"sphere\"}, {\"id\": \"o\", \"type\": \"output\", "
                             "\"inputs\": {\"surface\": {\"from\": \"b\"}, \"resolution\": " +
                             std::string(resolution) + "}}"),
                  {"input 'resolution': the value", "is out of range: it must be at least 1 and at most"});
}

TEST(Check, NumbersThatAreNotFinite) {
    for (const double value : {double(NAN), double(INFINITY), -double(INFINITY)}) {
        Graph graph =
            *parseGraph("{\"fieldwright\": 1, \"nodes\": [" + std::string(kBall) + "]}", "", nullptr);
        graph.nodes[0].set("radius", {value, {}, 0, {}});
        std::vector<Error> findings = checkStructure(graph);
        ASSERT_EQ(findings.size(), 1u);
        EXPECT_EQ(format(findings[0]),
                  "error: node 'ball', input 'radius': the value is not a finite number: give it a number");
    }
}

TEST(Check, LinksThatDoNotFit) {
    expectOne(
        besideBall(
            R"({"id": "p", "type": "position"}, {"id": "n", "type": "sphere", "inputs": {"radius": {"from": "p"}}})"),
        {"node 'p' gives vec3 but this input takes float: expected a number or a link"});
    EXPECT_TRUE(
        besideBall(
            R"({"id": "v", "type": "value"}, {"id": "n", "type": "box", "inputs": {"half_extents": {"from": "v"}}})")
            .empty());
    EXPECT_TRUE(
        besideBall(R"({"id": "n", "type": "sphere", "inputs": {"radius": {"from": "ball"}}})").empty());
    EXPECT_TRUE(
        besideBall(
            R"({"id": "v", "type": "value"}, {"id": "n", "type": "translate", "inputs": {"surface": {"from": "v"}}})")
            .empty());
    // Through reroutes, which have the type of what they are fed with.
    const std::string chain =
        R"({"id": "p", "type": "position"}, {"id": "r", "type": "reroute", "inputs": {"value": {"from": "s"}}},
                                 {"id": "s", "type": "reroute", "inputs": {"value": {"from": "p"}}}, )";
    expectOne(besideBall(chain + R"({"id": "n", "type": "sphere", "inputs": {"radius": {"from": "r"}}})"),
              {"node 'r' gives vec3 but this input takes float"});
    EXPECT_TRUE(
        besideBall(chain + R"({"id": "n", "type": "sphere", "inputs": {"p": {"from": "r"}}})").empty());
    expectOne(
        besideBall(
            R"({"id": "m", "type": "polygonize", "inputs": {"surface": {"from": "ball"}}}, {"id": "n", "type": "sphere", "inputs": {"radius": {"from": "m"}}})"),
        {"node 'm' gives mesh but this input takes float"});
}

TEST(Check, RangesHoldForWhatComesByAWire) {
    const auto compiled = [](const std::string& nodes) {
        return findingsOf(std::string(kBall) + ", " + nodes, "",
                          [](const Graph& graph) { return check(graph); });
    };
    const std::string zero = R"({"id": "v", "type": "value", "inputs": {"value": 0}}, )";
    const auto scaled = [](const std::string& from) {
        return R"({"id": "n", "type": "scale", "inputs": {"surface": {"from": "ball"}, "factor": {"from": ")" +
               from + R"("}}})";
    };
    expectOne(compiled(zero + scaled("v")), {"'factor'", "the value 0 is out of range: it must be above 0"});
    const std::string varies = R"({"id": "x", "type": "expression", "code": "return p.x;"}, )";
    expectOne(compiled(varies + scaled("x")),
              {"warning", "'factor'", "varies over space and may be 0 or less"});
    const std::string above = R"({"id": "x", "type": "expression", "code": "return 1 + abs(p.x);"}, )";
    EXPECT_TRUE(compiled(above + scaled("x")).empty());
    expectOne(compiled(R"({"id": "x", "type": "expression", "code": "return prism(p, 0);"})"),
              {"argument 2 of 'prism' is its sides: the value 0 is out of range"});
}

TEST(Check, NumbersThatNoDeviceHolds) {
    const auto findings = [](const std::string& code) {
        return findingsOf(R"({"id": "e", "type": "expression", "code": ")" + code +
                              R"("}, {"id": "out", "type": "output", "inputs": {"surface": {"from": "e"}}})",
                          "", [](const Graph& graph) { return check(graph); });
    };
    expectOne(findings("return length(p * 1e20) - 1e20;"),
              {"warning", "node 'e'", "numbers grow to", "use smaller ones"});
    EXPECT_TRUE(findings("return (length(p * 1e15) - 1e15) / 1e15;").empty());
    EXPECT_TRUE(findings("return min(length(p) - 1, 1e30);").empty());
}

TEST(Check, CodeIsCheckedBesideAStructureThatIsNotSound) {
    const std::vector<std::string> findings = findingsOf(
        std::string(kBall) +
            R"(, {"id": "a", "type": "nothing"}, {"id": "e", "type": "expression", "code": "a = lenght(p); return 1 + (p.x > 0.);", "inputs": {"q": {"from": "a"}}})",
        "", [](const Graph& graph) { return check(graph); });
    ASSERT_EQ(findings.size(), 3u) << joined(findings);
    EXPECT_NE(findings[0].find("unknown node type 'nothing'"), std::string::npos);
    EXPECT_NE(findings[1].find("node 'e', code 1:5: unknown function 'lenght'"), std::string::npos);
    EXPECT_NE(findings[2].find("found a bool"), std::string::npos);
}

TEST(Check, AGroupKeepsTheClassOfEachOutput) {
    const auto graph = [](const std::string& output) {
        return R"({"fieldwright": 1, "groups": [{"id": "g", "inputs": [{"name": "a", "type": "surface"}, {"name": "b", "type": "surface"}],
            "outputs": [{"name": "first", "type": "surface"}, {"name": "second", "type": "surface"}],
            "nodes": [{"id": "in", "type": "group_input"},
                      {"id": "end", "type": "group_output", "inputs": {"first": {"from": "in", "output": "a"}, "second": {"from": "in", "output": "b"}}}]}],
            "nodes": [{"id": "exact", "type": "sphere"}, {"id": "bent", "type": "twist", "inputs": {"surface": {"from": "exact"}}},
                      {"id": "it", "type": "group", "group": "g", "inputs": {"a": {"from": "exact"}, "b": {"from": "bent"}}},
                      {"id": "out", "type": "output", "inputs": {"surface": {"from": "it", "output": ")" +
               output + R"("}}}]})";
    };
    for (const std::string output : {"first", "second"}) {
        const Result<Graph> read = parseGraph(graph(output), "a.field.json", nullptr);
        ASSERT_TRUE(read) << format(read.error());
        const Result<Program> program = compile(*read);
        ASSERT_TRUE(program) << format(program.error());
        EXPECT_EQ(program->exactness.exact(), output == "first");
        EXPECT_EQ(program->spoiledBy, output == "first" ? "" : "bent");
    }
}

TEST(Check, Conversions) {
    const std::vector<std::pair<Type, Type>> allowed = {
        {Type::scalar, Type::surface}, {Type::surface, Type::scalar},  {Type::scalar, Type::vec3},
        {Type::integer, Type::scalar}, {Type::integer, Type::surface}, {Type::integer, Type::vec3},
        {Type::boolean, Type::scalar}, {Type::scalar, Type::vec2},     {Type::integer, Type::vec2}};
    for (int from = 0; from < kTypes; ++from)
        for (int to = 0; to < kTypes; ++to) {
            const std::pair pair{static_cast<Type>(from), static_cast<Type>(to)};
            EXPECT_EQ(converts(pair.first, pair.second),
                      from == to || std::count(allowed.begin(), allowed.end(), pair) > 0)
                << typeName(pair.first) << " to " << typeName(pair.second);
        }
}

TEST(Check, Ids) {
    expectOne(besideBall(R"({"id": "ball", "type": "sphere"})"),
              {"two nodes have the id 'ball', the first in line 1: rename one"});
    for (const char* id : {"", "Ball", "1a", "a-b", "_a", "a b", "é"})
        expectOne(besideBall("{\"id\": \"" + std::string(id) + "\", \"type\": \"sphere\"}"),
                  {"is no id for a node: use a-z, 0-9 and '_'"});
}

TEST(Check, Cycles) {
    const auto translate = [](const std::string& id, const std::string& from) {
        return "{\"id\": \"" + id + "\", \"type\": \"translate\", \"inputs\": {\"surface\": {\"from\": \"" +
               from + "\"}}}";
    };
    expectOne(besideBall(translate("a", "c") + ", " + translate("b", "a") + ", " + translate("c", "b")),
              {"the nodes form a cycle: a -> b -> c -> a; remove one of these links"});
    expectOne(besideBall(translate("a", "a")), {"node 'a', input 'surface': the nodes form a cycle: a -> a"});
    expectOne(
        besideBall(
            R"({"id": "a", "type": "reroute", "inputs": {"value": {"from": "b"}}}, {"id": "b", "type": "reroute", "inputs": {"value": {"from": "a"}}})"),
        {"the nodes form a cycle"});
    EXPECT_EQ(besideBall(translate("a", "b") + ", " + translate("b", "a") + ", " + translate("c", "d") +
                         ", " + translate("d", "c"))
                  .size(),
              2u);
    std::string ring;
    for (int i = 0; i < 100; ++i)
        ring += (i ? ", " : "") + translate("n" + std::to_string(i), "n" + std::to_string((i + 99) % 100));
    expectOne(besideBall(ring), {"more) -> "});
}

TEST(Check, Output) {
    expectOne(findingsOf(""), {"the graph has no node of type 'output': add one"});
    expectOne(besideBall(R"({"id": "two", "type": "output", "inputs": {"surface": {"from": "ball"}}})"),
              {"node 'two': a graph has one node of type 'output', and 'out' is one already"});
    expectOne(findingsOf(R"({"id": "out", "type": "output"})"),
              {"warning: node 'out': nothing is connected to the output"});
}

TEST(Check, UnconnectedSurfaces) {
    expectOne(besideBall(R"({"id": "n", "type": "union", "inputs": {"a": {"from": "ball"}}})"),
              {"warning: node 'n', input 'b': the input is not connected: it counts as empty space"});
    EXPECT_TRUE(
        besideBall(R"({"id": "n", "type": "union", "muted": true, "inputs": {"a": {"from": "ball"}}})")
            .empty());
}

TEST(Check, Expressions) {
    expectOne(besideBall(R"({"id": "n", "type": "expression"})"),
              {"the expression has no code: add \"code\""});
    expectOne(besideBall(R"({"id": "n", "type": "expression", "code": " \n"})"),
              {"the expression has no code"});
    expectOne(besideBall(R"({"id": "n", "type": "expression", "code": "return r;", "inputs": {"r": "a"}})"),
              {"expected a number, [x, y], [x, y, z] or a link, not the string 'a'"});
    expectOne(besideBall(R"({"id": "n", "type": "expression", "code": "return 1.0;", "inputs": {"2r": 1}})"),
              {"'2r' is no name in code"});
    expectOne(besideBall(R"({"id": "n", "type": "sphere", "code": "return 1.0;"})"),
              {"warning: node 'n': \"code\" has no effect on a node of type 'sphere'"});
}

constexpr const char* kGroup =
    R"({"id": "shell", "inputs": [{"name": "radius", "type": "float", "value": 1}, {"name": "what", "type": "surface"}],
    "outputs": [{"name": "surface", "type": "surface"}, {"name": "size", "type": "float"}],
    "nodes": [{"id": "in", "type": "group_input"}, {"id": "ball", "type": "sphere", "inputs": {"radius": {"from": "in", "output": "radius"}}},
              {"id": "out", "type": "group_output", "inputs": {"surface": {"from": "ball"}, "size": {"from": "in"}}}]})";

std::vector<std::string> withGroup(const std::string& nodes, const std::string& groups = kGroup) {
    return besideBall(nodes, ", \"groups\": [" + groups + "]");
}

TEST(Check, Groups) {
    const std::string instance =
        R"({"id": "n", "type": "group", "group": "shell", "inputs": {"what": {"from": "ball"}, )";
    EXPECT_TRUE(withGroup(instance + "\"radius\": 2}}").empty())
        << joined(withGroup(instance + "\"radius\": 2}}"));
    expectOne(withGroup(instance + "\"radus\": 2}}"),
              {"unknown input of a node of type 'group'; did you mean 'radius'?"});
    expectOne(withGroup(instance + "\"radius\": \"x\"}}"),
              {"expected a number or a link, not the string 'x'"});
    expectOne(
        withGroup(
            instance +
            R"("radius": 1}}, {"id": "m", "type": "translate", "inputs": {"surface": {"from": "n", "output": "sze"}}})"),
        {"node 'n' has no output 'sze'; did you mean 'size'?"});
    expectOne(withGroup(R"({"id": "n", "type": "group", "group": "shell"})"),
              {"warning: node 'n', input 'what': the input is not connected"});
    expectOne(withGroup(R"({"id": "n", "type": "group", "group": "shel"})"),
              {"there is no group 'shel'; did you mean 'shell'?"});
    expectOne(withGroup(R"({"id": "n", "type": "group"})"), {"the node does not say which group it shows"});
    expectOne(withGroup(R"({"id": "n", "type": "group_input"})"),
              {"a node of type 'group_input' belongs inside a group"});
    expectOne(withGroup("", R"({"id": "g", "nodes": [{"id": "o", "type": "output"}]})"),
              {"node 'g/o': a node of type 'output' belongs outside of groups"});
    expectOne(withGroup("", R"({"id": "g", "outputs": [{"name": "s", "type": "float"}], "nodes": []})"),
              {"the group has outputs but no node of type 'group_output'"});
    expectOne(
        withGroup(
            "",
            R"({"id": "g", "nodes": [{"id": "a", "type": "group_output"}, {"id": "b", "type": "group_output"}]})"),
        {"node 'g/b': a group has one node of type 'group_output', and 'a' is one already"});
    expectOne(withGroup("", R"({"id": "g", "inputs": [{"name": "a", "type": "flot"}], "nodes": []})"),
              {"unknown type 'flot'; did you mean 'float'?"});
    expectOne(
        withGroup(
            "",
            R"({"id": "g", "inputs": [{"name": "a", "type": "float"}, {"name": "a", "type": "float"}], "nodes": []})"),
        {"the group has two inputs named 'a'"});
    expectOne(
        withGroup("",
                  R"({"id": "g", "inputs": [{"name": "a", "type": "float", "value": [1, 2]}], "nodes": []})"),
        {"expected a number or a link"});
    expectOne(withGroup("", R"({"id": "g", "nodes": []}, {"id": "g", "nodes": []})"),
              {"two groups have the id 'g'"});
    expectOne(
        withGroup(
            "",
            R"({"id": "g", "nodes": [{"id": "x", "type": "translate", "inputs": {"surface": {"from": "ball"}}}]})"),
        {"node 'g/x', input 'surface': there is no node 'ball' in this group"});
}

TEST(Check, GroupsThatContainThemselves) {
    const auto group = [](const std::string& id, const std::string& inner) {
        return "{\"id\": \"" + id + "\", \"nodes\": [{\"id\": \"x\", \"type\": \"group\", \"group\": \"" +
               inner + "\"}]}";
    };
    expectOne(withGroup("", group("g", "g")),
              {"node 'g/x': group 'g' contains itself: g -> g; remove this node"});
    expectOne(withGroup("", group("a", "b") + ", " + group("b", "c") + ", " + group("c", "a")),
              {"group 'a' contains itself: a -> b -> c -> a"});
}

TEST(Check, GroupsThatMultiply) {
    // Each group holds the one before twice: 2^40 nodes if expanded.
    std::string groups = R"({"id": "g0", "nodes": [{"id": "x", "type": "sphere"}]})";
    for (int i = 1; i <= 40; ++i) {
        const std::string inner = "\"type\": \"group\", \"group\": \"g" + std::to_string(i - 1) + "\"}";
        groups += ", {\"id\": \"g" + std::to_string(i) + "\", \"nodes\": [{\"id\": \"x\", " + inner +
                  ", {\"id\": \"y\", " + inner + "]}";
    }
    expectOne(withGroup(R"({"id": "n", "type": "group", "group": "g40"})", groups),
              {"the graph has more than 200000 nodes"});
    EXPECT_TRUE(withGroup(R"({"id": "n", "type": "group", "group": "g10"})", groups).empty());
    std::string deep = R"({"id": "g0", "nodes": []})";
    for (int i = 1; i <= 2000; ++i)
        deep += ", {\"id\": \"g" + std::to_string(i) +
                "\", \"nodes\": [{\"id\": \"x\", \"type\": \"group\", \"group\": \"g" +
                std::to_string(i - 1) + "\"}]}";
    expectOne(withGroup(R"({"id": "n", "type": "group", "group": "g2000"})", deep),
              {"groups are nested deeper than 64 levels"});
}

TEST(Check, ParameterNodes) {
    const auto node = [](const std::string& inputs, const std::string& list = "") {
        return besideBall(R"({"id": "k", "type": "parameter", "inputs": {)" + inputs + "}}",
                          ", \"parameters\": [" + list + "]");
    };
    EXPECT_TRUE(node(R"("name": "K", "min": 0, "max": 2)").empty());
    EXPECT_TRUE(node("").empty());
    expectOne(node(R"("name": "")"), {"warning: ", "node 'k': nobody can change it: it has no name"});
    expectOne(node(R"("name": "a=b")"), {"warning: ", "its name has a '='"});
    expectOne(node(R"("name": "K", "min": 3)"), {"warning: ", "its min 3 is above its max 1"});
    expectOne(node(R"("name": "K")", R"({"name": "K", "node": "ball", "input": "radius"})"),
              {"warning: ", "a parameter has the name 'K' as well"});
    EXPECT_TRUE(node(R"("name": "K")", R"({"name": "K", "node": "k", "input": "value"})").empty());
    expectOne(node(R"("name": "K"}}, {"id": "l", "type": "parameter", "inputs": {"name": "K")"),
              {"warning: ", "node 'l': nobody can change it: node 'k' has the name 'K' as well"});
}

TEST(Check, Parameters) {
    const auto parameters = [](const std::string& list) {
        return besideBall("", ", \"parameters\": [" + list + "]");
    };
    EXPECT_TRUE(
        parameters(R"({"name": "Size", "node": "ball", "input": "radius", "min": 0, "max": 2})").empty());
    expectOne(parameters(R"({"name": "S", "node": "bal", "input": "radius"})"),
              {"parameter 'S': there is no node 'bal'; did you mean 'ball'?"});
    expectOne(parameters(R"({"name": "S", "node": "ball", "input": "radus"})"),
              {"parameter 'S': node 'ball' has no input 'radus'; did you mean 'radius'?"});
    expectOne(
        parameters(
            R"({"name": "S", "node": "ball", "input": "radius"}, {"name": "S", "node": "ball", "input": "radius"})"),
        {"two parameters are named 'S'"});
    expectOne(parameters(R"({"name": "", "node": "ball", "input": "radius"})"), {"a name is not empty"});
    expectOne(parameters(R"({"name": "S", "node": "ball", "input": "radius", "min": 2, "max": 1})"),
              {"its min 2 is above its max 1"});
    expectOne(parameters(R"({"name": "S", "node": "out", "input": "surface"})"),
              {"warning: ", "parameter 'S' has no effect: the input is linked"});
    expectOne(parameters(R"({"name": "S", "node": "out", "input": "method"})"),
              {"an input of type string cannot be a parameter"});
}

TEST(Check, FindsEverythingInOnePass) {
    const Result<Graph> graph =
        readGraph(FIELDWRIGHT_SOURCE_DIR "/tests/data/bad/check-everything.field.json", nullptr);
    ASSERT_TRUE(graph) << format(graph.error());
    std::string all;
    for (const Error& finding : check(*graph)) {
        EXPECT_TRUE(finding.line > 0 || finding.node.empty());
        all += format(finding) + "\n";
    }
    for (const char* part :
         {"unknown node type 'sphre'", "did you mean 'half_extents'", "not the string 'soft'",
          "two nodes have the id 'box'", "the value -1", "'Cut' is no id", "there is no node 'bx'",
          "has no output 'mesh'", "did you mean 'round'", "gives surface but this input takes vec3",
          "m -> n -> m", "has no code", "the value 0", "'out' is one already", "inner -> outer -> inner",
          "two parameters are named 'Size'", "there is no node 'bal'", "did you mean 'offset'"})
        EXPECT_NE(all.find(part), std::string::npos) << part << " is not among\n" << all;
}

TEST(Check, DivisionsByWhatIsZeroOnlyNowAndThen) {
    const auto findings = [](const std::string& inputs, const std::string& code, const std::string& more) {
        const Result<Graph> graph = parseGraph(
            R"({"fieldwright": 1, "nodes": [{"id": "a", "type": "expression", "inputs": {)" + inputs +
                R"(}, "code": ")" + code +
                R"("}, {"id": "out", "type": "output", "inputs": {"surface": {"from": "a"}}}])" + more + "}",
            "a.field.json", nullptr);
        EXPECT_TRUE(graph) << (graph ? "" : format(graph.error()));
        std::vector<std::string> texts;
        if (graph)
            for (const Error& finding : check(*graph)) texts.push_back(format(finding));
        return texts;
    };
    const std::string k = R"("k": 0)", kn = R"("k": 0, "n": 2)", byK = "return length(p) - 1 / k;";
    const std::string exposed = R"(, "parameters": [{"name": "K", "node": "a", "input": "k"}])";
    const std::string both = R"(, "parameters": [{"name": "K", "node": "a", "input": "k"},
                                                 {"name": "N", "node": "a", "input": "n"}])";
    const std::string moved = R"(, "timeline": {"tracks": [{"node": "a", "input": "k", "keys": [
        {"time": 0, "value": 1}, {"time": 1, "value": 2}]}]})";
    EXPECT_TRUE(findings("", "return length(p) - 1 / time;", "").empty());
    EXPECT_TRUE(findings(k, byK, exposed).empty());
    EXPECT_TRUE(findings(k, byK, moved).empty());
    expectOne(findings(k, byK, ""), {"node 'a', code 1:22: division by zero"});
    for (const std::string& more : {std::string(), exposed, moved})
        expectOne(findings(k, "return length(p) - 1 / (time - time) + 1 / k;", more), {"division by zero"});
    // Where code must know a parameter, what the others would do is not known.
    expectOne(findings(kn, "d = 1 / 0; for (int i = 0; i < n; i++) d += k; return d;", both),
              {"code 1:7: division by zero"});
    EXPECT_TRUE(findings(kn, "d = 1 / time; for (int i = 0; i < n; i++) d += k; return d;", both).empty());
}

TEST(Check, StopsAtAThousandFindings) {
    std::string nodes;
    for (int i = 0; i < 9000; ++i)
        nodes += ", {\"id\": \"n" + std::to_string(i) +
                 "\", \"type\": \"translate\", \"inputs\": {\"surface\": {\"from\": \"no" +
                 std::to_string(i) + "\"}, \"x\": 1}}";
    const std::vector<std::string> findings = findingsOf(kBall + nodes);
    ASSERT_EQ(findings.size(), 1000u);
    EXPECT_NE(findings.back().find("there are 17001 more findings"), std::string::npos) << findings.back();
}

TEST(Check, LongChainsNeedNoStack) {
    // 9,998 nodes in a row, of each kind that is walked along.
    for (const char* type :
         {"\"translate\", \"inputs\": {\"surface\"", "\"reroute\", \"inputs\": {\"value\""}) {
        std::string nodes = kBall, previous = "ball";
        for (int i = 0; i < 9998; ++i) {
            const std::string id = "n" + std::to_string(i);
            nodes += ", {\"id\": \"" + id + "\", \"type\": " + type + ": {\"from\": \"" + previous + "\"}}}";
            previous = id;
        }
        EXPECT_TRUE(findingsOf(nodes).empty());
    }
}

}  // namespace fw::check_test
