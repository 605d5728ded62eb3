#include "graph/document/json.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "graph/library/node_type.h"

namespace fw::json_test {

/// The example that the format was designed with; also the layout that writing keeps.
constexpr const char* kTower = R"({
  "fieldwright": 1,
  "nodes": [
    {"id": "tower", "type": "box", "at": [0, 0], "inputs": {"half_extents": [1, 2, 1]}},
    {"id": "holes", "type": "expression", "at": [0, 160],
     "code": "vec3 c = abs(mod(p, 0.5) - 0.25) - 0.15; return min(max(c.x, c.y), min(max(c.y, c.z), max(c.x, c.z)));"},
    {"id": "cut", "type": "subtract", "at": [240, 0], "inputs": {"a": {"from": "tower"}, "b": {"from": "holes"}}},
    {"id": "out", "type": "output", "at": [480, 0], "inputs": {"surface": {"from": "cut"}}}
  ]
}
)";

Graph parsed(const std::string& text, std::vector<Error>* warnings = nullptr) {
    const Result<Graph> graph = parseGraph(text, "a.field.json", warnings);
    EXPECT_TRUE(graph) << (graph ? "" : format(graph.error()));
    return graph ? *graph : Graph();
}

/// The error of a text that must not be read, as a user sees it.
std::string refusal(const std::string& text) {
    const Result<Graph> graph = parseGraph(text, "a.field.json", nullptr);
    EXPECT_FALSE(graph) << "was read: " << text.substr(0, 200);
    return graph ? "" : format(graph.error());
}

/// A graph with one node whose members are these.
std::string withNode(const std::string& members) {
    return "{\"fieldwright\": 1, \"nodes\": [{\"id\": \"n\", \"type\": \"sphere\", " + members + "}]}";
}
std::string withInput(const std::string& value) { return withNode("\"inputs\": {\"x\": " + value + "}"); }

InputValue inputOf(const std::string& value) {
    const Graph graph = parsed(withInput(value));
    return graph.nodes.empty() ? InputValue() : graph.nodes[0].inputs.at(0).second;
}

TEST(Json, ReadsTheExample) {
    const Graph graph = parsed(kTower);
    ASSERT_EQ(graph.nodes.size(), 4u);
    EXPECT_EQ(graph.path, "a.field.json");
    EXPECT_EQ(graph.nodes[0].id, "tower");
    EXPECT_EQ(graph.nodes[0].type, "box");
    EXPECT_EQ((*graph.nodes[0].at)[1], 0);
    const InputValue* extents = graph.nodes[0].input("half_extents");
    ASSERT_TRUE(extents);
    EXPECT_EQ(std::get<std::vector<double>>(extents->value), (std::vector<double>{1, 2, 1}));
    EXPECT_EQ(std::get<Link>(graph.nodes[2].input("b")->value), (Link{"holes", ""}));
    EXPECT_EQ(graph.nodes[1].code.substr(0, 6), "vec3 c");
    EXPECT_EQ(graph.node("cut"), &graph.nodes[2]);
    EXPECT_EQ(graph.node("nothing"), nullptr);
}

TEST(Json, KnowsWhereThingsStand) {
    const Graph graph = parsed(kTower);
    ASSERT_EQ(graph.nodes.size(), 4u);
    EXPECT_EQ(graph.nodes[0].place.line, 4);
    EXPECT_EQ(graph.nodes[0].place.column, 5);
    EXPECT_EQ(graph.nodes[1].codePlace.line, 6);
    EXPECT_EQ(graph.nodes[1].codePlace.column, 14);
    EXPECT_EQ(graph.nodes[2].input("b")->at.line, 7);
    EXPECT_EQ(graph.nodes[2].input("b")->at.column, 95);
    const Graph other = parsed(
        "\xEF\xBB\xBF{\"fieldwright\": 1,\r\n\t\"x\": \"é€\", \"nodes\": [ ],\n"
        "\"parameters\": [{\"name\":\"a\",\"node\":\"b\",\"input\":\"c\"}],\n"
        "\"groups\": [{\"id\":\"g\",\"outputs\":[{\"name\":\"s\",\"type\":\"surface\"}]}]}");
    EXPECT_EQ(other.parameters.at(0).place.line, 3);
    EXPECT_EQ(other.parameters.at(0).place.column, 16);
    EXPECT_EQ(other.groups.at(0).place.column, 12);
    EXPECT_EQ(other.groups.at(0).outputs.at(0).place.column, 33);
    // A column is a character: é and € before the error count one each.
    EXPECT_NE(refusal("{\"é€\": x}").find("a.field.json:1:8: "), std::string::npos) << refusal("{\"é€\": x}");
}

TEST(Json, ReadsEveryShapeOfInput) {
    EXPECT_EQ(std::get<double>(inputOf("-2.5e-1").value), -0.25);
    EXPECT_TRUE(std::signbit(std::get<double>(inputOf("-0").value)));
    EXPECT_EQ(std::get<bool>(inputOf("true").value), true);
    EXPECT_EQ(std::get<std::string>(inputOf("\"a\\n\\u00e9\\ud83d\\ude00\\\"\"").value), "a\né😀\"");
    EXPECT_EQ(std::get<std::vector<double>>(inputOf("[1, 2]").value), (std::vector<double>{1, 2}));
    EXPECT_TRUE(std::get<std::vector<double>>(inputOf("[]").value).empty());
    const InputValue points = inputOf("[[1, 2], [3, 4]]");
    EXPECT_EQ(points.entry, 2);
    EXPECT_EQ(std::get<std::vector<double>>(points.value), (std::vector<double>{1, 2, 3, 4}));
    EXPECT_EQ(std::get<Link>(inputOf("{\"output\": \"o\", \"from\": \"m\"}").value), (Link{"m", "o"}));
    EXPECT_EQ(std::get<double>(inputOf("5e-324").value), 5e-324);
    EXPECT_EQ(std::get<double>(inputOf("1e-999").value), 0.0);
}

TEST(Json, RefusesWhatIsNoInput) {
    for (const char* value :
         {"null", "[1, true]", "[[1, 2], 3]", "[1, [2, 3]]", "[[1, 2, 3, 4, 5, 6]]", "[[1]]", "[[]]",
          "[\"a\"]", "{}", "{\"node\": \"a\"}", "[[[1, 2]]]", "[null]"}) {
        const std::string error = refusal(withInput(value));
        EXPECT_NE(error.find("node 'n', input 'x'"), std::string::npos) << error;
        EXPECT_NE(error.find("an input is a number, true or false, a string, an array of numbers"),
                  std::string::npos)
            << error;
    }
    EXPECT_NE(refusal(withInput("{\"from\": 3}")).find("\"from\" must be a string, not a number"),
              std::string::npos);
    EXPECT_NE(refusal(withInput("{\"from\": \"a\", \"output\": []}"))
                  .find("\"output\" must be a string, not an array"),
              std::string::npos);
}

struct Refused {
    const char* text;
    const char* place;    ///< line:column
    const char* message;  ///< part of it
};

TEST(Json, RefusesWithPlaceAndReason) {
    const Refused cases[] = {
        {"", "1:1", "the file is empty"},
        {" \n ", "2:2", "the file is empty"},
        {"tower", "1:1", "expected a value"},
        {"[1]", "1:1", "a graph is a JSON object"},
        {"5", "1:1", "a graph is a JSON object"},
        {"{\n\"fieldwright\": 1,\n", "3:1", "the file ends before the object that begins at 1:1 is closed"},
        {"{\"fieldwright\": 1, \"nodes\": [", "1:30", "the file ends before the array that begins at 1:29"},
        {"{\"fieldwright\": 1, \"nodes\"", "1:27", "the file ends before the object"},
        {"{\"fieldwright\": 1, \"nodes\":", "1:28", "the file ends before the object"},
        {"{\"fieldwright\": 1, \"nod", "1:20", "the file ends inside the string"},
        {"{\"fieldwright\": 1, \"nodes\": []}}", "1:32", "text after the end"},
        {"{\"fieldwright\": 1, \"nodes\": []} x", "1:33", "text after the end"},
        {"{\"fieldwright\": 1, \"nodes\": [],}", "1:32", "a comma stands before the closing '}'"},
        {"{\"fieldwright\": 1 \"nodes\": []}", "1:19", "expected ',' or '}'"},
        {"{\"fieldwright\" 1}", "1:16", "expected ':'"},
        {"{fieldwright: 1}", "1:2", "expected a key in double quotes"},
        {"{'fieldwright': 1}", "1:2", "JSON quotes with \""},
        {"{\"a\": NaN}", "1:7", "JSON has no NaN and no infinity"},
        {"{\"a\": nan}", "1:7", "JSON has no NaN and no infinity"},
        {"{\"a\": -Infinity}", "1:7", "JSON has no NaN and no infinity"},
        {"{\"a\": [inf]}", "1:8", "JSON has no NaN and no infinity"},
        {"{\"a\": 1e309}", "1:7", "beyond the range of double"},
        {"{\"a\": -1e99999}", "1:7", "beyond the range of double"},
        {"{\"a\": 01}", "1:7", "not a number as JSON writes it"},
        {"{\"a\": 1.2.3}", "1:7", "not a number as JSON writes it"},
        {"{\"a\": +1}", "1:7", "not a number as JSON writes it"},
        {"{\"a\": .5}", "1:7", "not a number as JSON writes it"},
        {"{\"a\": 5.}", "1:7", "not a number as JSON writes it"},
        {"{\"a\": True}", "1:7", "expected true, false or null"},
        {"{\"a\": tru}", "1:7", "expected true, false or null"},
        {"{ // hello\n}", "1:3", "JSON has no comments"},
        {"{\"a\": 1, \"b\": 2,\n \"a\": 3}", "2:2",
         "the key 'a' stands twice in this object, first in line 1"},
        {"{\"a\": {\"\\u0062\": 1, \"b\": 2}}", "1:21", "the key 'b' stands twice"},
        {"{\"a\": \"x\ny\"}", "1:9", "in a string: control character"},
        {"{\"a\": \"\\x\"}", "1:9", "in a string: forbidden character after backslash"},
        {"{\"a\": \"\\ud800\"}", "1:14", "in a string: surrogate"},
        {"{\"a\": \"\xFF\"}", "1:8", "not UTF-8"},
        {"{\"a\": \"\xC0\x80\"}", "1:8", "not UTF-8"},
        {"{\"a\": \"\xED\xA0\x80\"}", "1:8", "not UTF-8"},
        {"{\"a\": \"\xF4\x90\x80\x80\"}", "1:8", "not UTF-8"},
        {"{\"a\": \"\xE2\x82", "1:8", "not UTF-8"},
        {"{}", "1:1", "this is not a Fieldwright graph"},
        {"{\"fieldwright\": \"1\"}", "1:17", "version of the format and must be 1"},
        {"{\"fieldwright\": 1.5}", "1:17", "version of the format and must be 1"},
        {"{\"fieldwright\": 0}", "1:17", "version of the format and must be 1"},
        {"{\"new\": 3,\n\"fieldwright\": 2}", "2:16",
         "the file has format version 2, this program reads up to version 1: open it with a newer "
         "Fieldwright"},
        {"{\"fieldwright\": 1}", "1:1", "the key \"nodes\" is missing"},
        {"{\"fieldwright\": 1, \"nodes\": {}}", "1:29", "\"nodes\" must be an array of nodes, not an object"},
        {"{\"fieldwright\": 1, \"nodes\": [3]}", "1:30", "a node is an object such as"},
        {"{\"fieldwright\": 1, \"nodes\": [{}]}", "1:30", "the node has no \"id\""},
        {"{\"fieldwright\": 1, \"nodes\": [{\"id\": \"a\"}]}", "1:30", "the node has no \"type\""},
        {"{\"fieldwright\": 1, \"nodes\": [{\"id\": 7}]}", "1:37", "\"id\" must be a string, not a number"},
        {"{\"fieldwright\": 1, \"nodes\": [], \"scene\": []}", "1:42",
         "\"scene\" must be an object, not an array"},
        {"{\"fieldwright\": 1, \"nodes\": [], \"timeline\": 1}", "1:45", "\"timeline\" must be an object"},
        {"{\"fieldwright\": 1, \"nodes\": [], \"frames\": {}}", "1:43", "\"frames\" must be an array"},
        {"{\"fieldwright\": 1, \"nodes\": [], \"groups\": {}}", "1:43", "\"groups\" must be an array"},
        {"{\"fieldwright\": 1, \"nodes\": [], \"groups\": [1]}", "1:44", "a group is an object"},
        {"{\"fieldwright\": 1, \"nodes\": [], \"groups\": [{}]}", "1:44", "the group has no \"id\""},
        {"{\"fieldwright\": 1, \"nodes\": [], \"groups\": [{\"id\": \"g\", \"inputs\": [{\"name\": "
         "\"r\"}]}]}",
         "1:67", "an input of a group is an object such as"},
        {"{\"fieldwright\": 1, \"nodes\": [], \"groups\": [{\"id\": \"g\", \"outputs\": [4]}]}", "1:68",
         "an output of a group is an object such as"},
        {"{\"fieldwright\": 1, \"nodes\": [], \"parameters\": [{}]}", "1:48",
         "the parameter has no \"name\""},
        {"{\"fieldwright\": 1, \"nodes\": [], \"parameters\": [{\"min\": \"a\"}]}", "1:56",
         "\"min\" must be a number"},
    };
    for (const Refused& each : cases) {
        const std::string error = refusal(each.text);
        EXPECT_TRUE(error.starts_with("a.field.json:" + std::string(each.place) + ": error: "))
            << each.text << "\n"
            << error;
        EXPECT_NE(error.find(each.message), std::string::npos) << each.text << "\n" << error;
    }
}

TEST(Json, RefusesWrongTypesOfNodeKeys) {
    const std::pair<const char*, const char*> cases[] = {
        {"\"label\": 1", "\"label\" must be a string, not a number"},
        {"\"muted\": \"yes\"", "\"muted\" must be true or false, not a string"},
        {"\"collapsed\": null", "\"collapsed\" must be true or false, not null"},
        {"\"group\": []", "\"group\" must be a string, not an array"},
        {"\"code\": 5", "\"code\" must be a string, not a number"},
        {"\"at\": [1]", "\"at\" is the place on the canvas: an array of two numbers"},
        {"\"at\": [1, \"2\"]", "\"at\" is the place on the canvas"},
        {"\"at\": {}", "\"at\" is the place on the canvas"},
        {"\"inputs\": []", "\"inputs\" must be an object of input names and values, not an array"},
    };
    for (const auto& [members, message] : cases) {
        const std::string error = refusal(withNode(members));
        EXPECT_NE(error.find(message), std::string::npos) << error;
        EXPECT_NE(error.find("node 'n'"), std::string::npos) << error;
    }
}

TEST(Json, RefusesEveryTruncation) {
    const std::string text = kTower;
    for (std::size_t length = 0; length + 2 < text.size(); ++length)
        EXPECT_NE(refusal(text.substr(0, length)).find("a.field.json:"), std::string::npos);
}

TEST(Json, KeepsItsLimits) {
    const auto nested = [](int depth) { return std::string(depth, '[') + std::string(depth, ']'); };
    const auto withExtra = [](const std::string& value) {
        return "{\"fieldwright\": 1, \"nodes\": [], \"x\": " + value + "}";
    };
    EXPECT_EQ(parsed(withExtra(nested(kMaxNesting - 1))).extra->size(), 1u);
    EXPECT_NE(refusal(withExtra(nested(kMaxNesting))).find("nested deeper than 64"), std::string::npos);
    EXPECT_NE(refusal(std::string(10'000'000, '[')).find("nested deeper than 64"), std::string::npos);
    EXPECT_NE(refusal(std::string(kMaxFileBytes + 1, ' ')).find("larger than 16 MiB"), std::string::npos);

    std::string nodes, many;
    for (std::size_t i = 0; i < kMaxNodes; ++i)
        nodes += (i ? ",{\"id\":\"n" : "{\"id\":\"n") + std::to_string(i) + "\",\"type\":\"sphere\"}";
    EXPECT_EQ(parsed("{\"fieldwright\":1,\"nodes\":[" + nodes + "]}").nodes.size(), kMaxNodes);
    EXPECT_NE(refusal("{\"fieldwright\":1,\"nodes\":[" + nodes + ",{}]}").find("more than 10000 nodes"),
              std::string::npos);
    EXPECT_NE(
        refusal("{\"fieldwright\":1,\"nodes\":[" + nodes + "],\"groups\":[{\"id\":\"g\",\"nodes\":[1]}]}")
            .find("more than 10000 nodes"),
        std::string::npos);

    while (many.size() < kMaxFileBytes - 100) many += "0,";
    EXPECT_NE(refusal(withExtra("[" + many + "0]")).find("more than 2000000 keys and values"),
              std::string::npos);
    std::string keys = "\"k\":0";
    for (int i = 0; i < 300; ++i) keys += ",\"k" + std::to_string(i) + "\":0";
    EXPECT_NE(refusal(withNode("\"inputs\":{" + keys + "}")).find("more than 256 inputs"), std::string::npos);
}

TEST(Json, KeepsUnknownKeysWithAWarning) {
    const std::string text = R"({
  "fieldwright": 1,
  "nodes": [
    {"id": "a", "type": "sphere", "inputs": {"x": {"from": "b", "zoom": 2}}, "lable": "é\n", "2": [1, -0, 1e+300]}
  ],
  "zebra": null,
  "apple": {"deep": [[], {}, true, 18446744073709551615, -9223372036854775808]}
}
)";
    std::vector<Error> warnings;
    const Graph graph = parsed(text, &warnings);
    EXPECT_EQ(writeGraph(graph), text);
    ASSERT_EQ(warnings.size(), 5u);
    EXPECT_EQ(
        format(warnings[0]),
        "a.field.json:4:65: warning: node 'a', input 'x': unknown key 'zoom' is kept but has no effect");
    EXPECT_NE(format(warnings[1]).find("did you mean 'label'?"), std::string::npos);
    EXPECT_EQ(warnings[3].line, 6);
    std::string many = "\"a\": 1";
    for (int i = 0; i < 500; ++i) many += ", \"a" + std::to_string(i) + "\": 1";
    warnings.clear();
    EXPECT_EQ(parsed(withNode(many), &warnings).nodes[0].extra->size(), 501u);
    EXPECT_EQ(warnings.size(), 101u);
    EXPECT_NE(warnings.back().message.find("401 more"), std::string::npos);
}

TEST(Json, KeptJsonIsAValue) {
    KeptJson none, some = Json{{"a", 1}}, copy = some;
    EXPECT_TRUE(none->is_null());
    EXPECT_EQ(none, KeptJson(Json()));
    (*copy)["a"] = 2;
    EXPECT_EQ(*some, (Json{{"a", 1}}));
    EXPECT_NE(some, copy);
    copy = std::move(some);
    EXPECT_EQ((*copy)["a"], 1);
    EXPECT_EQ(some, nullptr);
    copy = *&copy;
    EXPECT_EQ((*copy)["a"], 1);
}

TEST(Json, BringsFormerNamesUpToDate) {
    for (const NodeType& type : nodeTypes())
        for (const std::string& alias : type.aliases) {
            const Graph graph =
                parsed("{\"fieldwright\": 1, \"nodes\": [{\"id\": \"a\", \"type\": \"" + alias + "\"}]}");
            EXPECT_EQ(graph.nodes.at(0).type, type.id);
        }
}

}  // namespace fw::json_test
