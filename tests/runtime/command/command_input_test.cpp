// Graphs at fault, through the real program: each is refused with one message that says what and where, with
// status 1, soon, in little memory, and without a file.
#include <gtest/gtest.h>

#include <tuple>

#include "tests/support/command.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::command_input_test {

using test::expectRefusal;
using test::runCommand;
using test::TempDir;

/// A document whose node `a` goes to the output.
std::string document(const std::string& nodes, const std::string& more = "") {
    return R"({"fieldwright": 1, "nodes": [)" + nodes +
           R"(, {"id": "out", "type": "output", "inputs": {"surface": {"from": "a"}}}])" + more + "}";
}
std::string ball(const std::string& radius) {
    return document(R"({"id": "a", "type": "sphere", "inputs": {"radius": )" + radius + "}}");
}
std::string code(const std::string& text) {
    return document(R"({"id": "a", "type": "expression", "code": ")" + text + "\"}");
}
std::string repeated(const std::string& text, int times) {
    std::string result;
    for (int i = 0; i < times; ++i) result += text;
    return result;
}

/// Exports the document and expects it to be refused with all of `parts`.
void expectBadGraph(const std::string& text, const std::vector<std::string>& parts,
                    const std::vector<std::string>& arguments = {}, double maxSeconds = test::kMostSeconds) {
    SCOPED_TRACE(text.substr(0, 300));
    const TempDir folder;
    const std::string path = folder.path("bad.field.json");
    test::writeText(path, text);
    std::vector<std::string> words = {"export", path, "-o", folder.path("bad.glb")};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<std::string> said = {"bad.field.json:"};
    said.insert(said.end(), parts.begin(), parts.end());
    expectRefusal(runCommand(words), 1, said, maxSeconds);
    EXPECT_EQ(folder.names(), std::vector<std::string>{"bad.field.json"});
}

TEST(CommandInput, FilesThatCannotBeRead) {
    const TempDir folder;
    const std::string mesh = folder.path("a.glb");
    expectRefusal(runCommand({"export", folder.path("none.field.json"), "-o", mesh}), 1,
                  {"none.field.json: error: there is no such file"});
    expectRefusal(runCommand({"export", folder.folder.string(), "-o", mesh}), 1, {"this is a folder"});
    expectRefusal(runCommand({"export", "", "-o", mesh}), 1, {"error"});
    EXPECT_TRUE(folder.names().empty());
}

TEST(CommandInput, TextsThatAreNoGraph) {
    expectBadGraph("solid ball\nfacet", {":1:1: error: expected a value"});
    expectBadGraph("", {":1:1: error: the file is empty"});
    expectBadGraph(std::string("\0\0\0\0", 4), {":1:1: error"});
    expectBadGraph(ball("1").substr(0, 60), {":1:", "error"});
    expectBadGraph("[1, 2]", {":1:1: error"});
    expectBadGraph("{}", {"error", "fieldwright"});
    expectBadGraph(R"({"fieldwright": 2, "nodes": []})", {":1:17: error", "2"});
    expectBadGraph(R"({"fieldwright": "one", "nodes": []})", {":1:17: error"});
    expectBadGraph(R"({"fieldwright": 1, "nodes": []})", {"no node of type 'output'"});
    expectBadGraph(std::string(1'000'000, '['), {":1:65: error", "64"});
    expectBadGraph(std::string((16 << 20) + 1, ' '), {"error", "16"});
}

TEST(CommandInput, NodesThatAreNotInTheLibrary) {
    expectBadGraph(document(R"({"id": "a", "type": "spere"})"),
                   {":1:30: error: node 'a'", "'spere'", "did you mean 'sphere'?"});
    expectBadGraph(document(R"({"id": "a", "type": "sphere", "inputs": {"radios": 1}})"),
                   {"error: node 'a'", "'radios'", "did you mean 'radius'?"});
    expectBadGraph(ball("\"big\""), {":1:81: error: node 'a', input 'radius'", "not the string 'big'"});
    expectBadGraph(ball("[1, 2, 3]"), {"node 'a', input 'radius'", "not an array of 3 numbers"});
    expectBadGraph(ball("-1"), {"node 'a', input 'radius'", "at least 0"});
    expectBadGraph(document(R"({"id": "a", "type": "union", "inputs": {"a": {"from": "b"}}})"),
                   {"node 'a', input 'a'", "'b'"});
    expectBadGraph(document(R"({"id": "a", "type": "sphere"}, {"id": "a", "type": "box"})"),
                   {":1:61: error: node 'a'", "two nodes have the id 'a'"});
    expectBadGraph(document(R"({"id": "a", "type": "translate", "inputs": {"surface": {"from": "v"}}},
                               {"id": "v", "type": "vector"})"),
                   {"node 'a', input 'surface'", "gives vec3 but this input takes surface"});
}

TEST(CommandInput, NamesThatWouldForgeLines) {
    expectBadGraph(document(R"({"id": "a\nb: error: \u001b[31m\u0000\u009b", "type": "spere"})"),
                   {"error: node 'a?b: error: ?[31m?"
                    "?': unknown",
                    "did you mean 'sphere'?"});
    const std::string name(100'000, 'x');
    const TempDir folder;
    const std::string path = folder.path("long.field.json");
    test::writeText(path, document("{\"id\": \"" + name + "\", \"type\": \"spere\"}"));
    const test::CommandResult result = runCommand({"export", path, "-o", folder.path("a.glb")});
    EXPECT_EQ(result.status, 1);
    EXPECT_LT(result.errors.size(), 2000u);
    EXPECT_LT(runCommand({"eval", path, "--at", "0", "0", "0", "--set", name + "=" + name}).errors.size(),
              2000u);
}

TEST(CommandInput, LoopsOfLinksAndOfGroups) {
    expectBadGraph(document(R"({"id": "a", "type": "shell", "inputs": {"surface": {"from": "b"}}},
                               {"id": "b", "type": "shell", "inputs": {"surface": {"from": "a"}}})"),
                   {"error: node '", "cycle"});
    expectBadGraph(document(R"({"id": "a", "type": "reroute", "inputs": {"value": {"from": "a"}}})"),
                   {"cycle"});
    expectBadGraph(document(R"({"id": "a", "type": "group", "group": "g"})",
                            R"(, "groups": [{"id": "g", "outputs": [{"name": "surface", "type": "surface"}],
        "nodes": [{"id": "again", "type": "group", "group": "g"},
                  {"id": "end", "type": "group_output", "inputs": {"surface": {"from": "again"}}}]}])"),
                   {"group", "contains itself"});
}

TEST(CommandInput, NumbersThatAreNone) {
    expectBadGraph(ball("NaN"), {":1:", "error"});
    expectBadGraph(ball("Infinity"), {":1:", "error"});
    expectBadGraph(ball("-Infinity"), {":1:", "error"});
    expectBadGraph(ball("1e999"), {":1:", "error"});
    expectBadGraph(document(R"({"id": "d", "type": "math", "inputs": {"op": "divide", "a": 1, "b": 0}},
                               {"id": "a", "type": "sphere", "inputs": {"radius": {"from": "d"}}})"),
                   {"error"});
    expectBadGraph(code("return length(p) - 1 / 0;"), {"node 'a', code 1:22: division by zero"});
    expectBadGraph(code("return length(p) - 1 / (2 - 2);"), {"node 'a', code 1:22: division by zero"});
    expectBadGraph(code("return length(p) - 1e999;"), {"node 'a', code 1:20", "out of range"});
    expectBadGraph(code("return mod(p.x, 0);"), {"node 'a', code 1:8: division by zero"});
}

TEST(CommandInput, CodeWithoutEnd) {
    expectBadGraph(code("while (true) {} return 1;"), {"node 'a', code 1:1", "'while'"});
    expectBadGraph(code("for (int i = 0; i >= 0; i++) {} return 1;"), {"node 'a', code 1:"});
    expectBadGraph(code("for (int i = 0; i < 1; i += 0) p.x += 1; return 1;"), {"node 'a', code 1:"});
    expectBadGraph(code("for (;;) {} return 1;"), {"node 'a', code 1:1", "no condition"});
    expectBadGraph(code("float f(float x) { return f(x); } return f(1);"), {"code 1:", "calls itself"});
    expectBadGraph(
        code("float f(float x) { return g(x); } float g(float x) { return f(x) + f(-x); } return f(1);"),
        {"code 1:", "calls itself"});
    expectBadGraph(code("return p.x" + repeated(" + p.x", 1'000'000) + ";"), {"code 1:", "200000"});
    expectBadGraph(code("return " + repeated("(", 100'000) + "1;"), {"code 1:", "nested deeper"});
    // Long but allowed: the region search spends its whole budget of steps, about 2 s.
    expectBadGraph(code("d = p.x; " + repeated("d = sin(d) + cos(d);", 15'000) + "return d;"),
                   {"cannot be proven bounded"}, {}, 2.5 * test::kMostSeconds);
    expectBadGraph(code("d = p.x; for (int i = 0; i < 1000000; i++) d = sin(d + i); return d;"),
                   {"code 1:", "operations"});
}

TEST(CommandInput, CodeThatMultipliesItsCost) {
    // Many variables times many branches, many names, many functions: each alone is allowed.
    std::string variables, branches, functions, chain = "float f0(float x) { return x + p.x; } ";
    for (int i = 0; i < 12'000; ++i) {
        variables += "v" + std::to_string(i) + "=p.x;";
        branches += "if (p.x > " + std::to_string(i) + ") v1 = 1;";
    }
    for (int i = 0; i < 8'000; ++i) functions += "float f" + std::to_string(i) + "(float x) { return x; } ";
    for (int i = 1; i < 40; ++i) {
        const std::string before = "f" + std::to_string(i - 1);
        chain += "float f" + std::to_string(i) + "(float x) { return " + before + "(x) + " + before +
                 "(x * 1.1); } ";
    }
    expectBadGraph(code(variables + branches + "return nothing;"), {"code 1:"});
    expectBadGraph(code(functions + repeated("v = f0(p.x);", 12'000) + "return nothing;"), {"code 1:"});
    expectBadGraph(code(chain + "return f39(1);"), {"code 1:"});
    // A long field looked up at many constant positions leaves nothing but work.
    expectBadGraph(document(R"({"id": "long", "type": "expression", "code": "d = p.x; )" +
                            repeated("d = floor(d * 0.5);", 1'000) +
                            R"("}, {"id": "a", "type": "expression", "inputs": {"f": {"from": "long"}},
                     "code": "s = 0; for (int i = 0; i < 90000; i++) s += f(vec3(i)); return s;"})"),
                   {"node 'a', code 1:", "moves its fields"});
}

TEST(CommandInput, SolidsThatCannotBeMeshed) {
    expectBadGraph(document(R"({"id": "a", "type": "plane"})"),
                   {"node 'a' (Plane) is unbounded: intersect it with a box, or give a region (--region, or "
                    "region_min and region_max of a polygonize node)"});
    expectBadGraph(document(R"({"id": "b", "type": "sphere"},
                               {"id": "a", "type": "repeat", "inputs": {"surface": {"from": "b"}}})"),
                   {"node 'a' (Repeat) is unbounded"});
    expectBadGraph(code("return 1;"), {"the solid is empty: the field is nowhere negative; "});
    expectBadGraph(ball("0"), {"the solid is empty"});
    expectBadGraph(document(R"({"id": "b", "type": "sphere"},
        {"id": "c", "type": "translate", "inputs": {"surface": {"from": "b"}, "offset": [3, 0, 0]}},
        {"id": "a", "type": "intersect", "inputs": {"a": {"from": "b"}, "b": {"from": "c"}}})"),
                   {"the solid is empty"});
    expectBadGraph(ball("1"), {"does not pass through the region"},
                   {"--region", "2", "2", "2", "3", "3", "3"});
    expectBadGraph(document(R"({"id": "a", "type": "box", "inputs": {"half_extents": [100, 0.001, 100]}})"),
                   {"empty or thinner than a cell of 6.9 m: raise the resolution"}, {"--resolution", "32"});
    expectBadGraph(ball("1"), {"too small"}, {"--region", "1e9", "0", "0", "1000000001", "1", "1"});
    expectBadGraph(ball("1e-30"), {"too small"});
    expectBadGraph(ball("1"), {"too large"}, {"--region", "-1e30", "-1", "-1", "1e30", "1", "1"});
    expectBadGraph(R"({"fieldwright": 1, "nodes": [{"id": "out", "type": "output"}]})", {"error"});
}

}  // namespace fw::command_input_test
