// What the code editor knows of the language: what names mean, colours, brackets, calls, completions, pages,
// marks of errors, other names.
#include <gtest/gtest.h>

#include <algorithm>

#include "editor/code/builtin_pages.h"
#include "editor/code/check.h"
#include "editor/code/entries.h"
#include "editor/document/expression_inputs.h"
#include "graph/language/builtins.h"
#include "graph/language/resolve.h"
#include "tests/support/editor/graphs.h"

namespace fw::editor::test::code_language_test {

using namespace fw::editor::code;
using language::CodeNames;
using language::NameUse;
using Kind = NameUse::Kind;

constexpr const char* kCode =
    "float ring(vec2 q, float r) { return abs(length(q) - r); }\n"
    "vec3 c = p; // c of old\n"
    "for (int i = 0; i < 3; i++) { float w = a * i; c.x += w; }\n"
    "d = Sphere(c, a);\n"
    "if (p.y > b(p)) { a = 2; }\n"
    "return ring(c.xz, a) + d + nothing;\n";

/// "name:kind" of each use.
std::vector<std::string> usesOf(std::string_view code, std::vector<std::string> inputs) {
    static const char* const kKinds[] = {"word",     "type",    "constant", "input",  "variable",
                                         "function", "builtin", "node",     "member", "unknown"};
    const CodeNames names = language::namesOf(code, std::move(inputs));
    std::vector<std::string> all;
    for (const NameUse& use : names.uses)
        all.push_back(std::string(code.substr(use.begin, use.length)) + ":" + kKinds[std::size_t(use.kind)]);
    return all;
}

TEST(CodeNames, AreWhatTheLanguageTakesThemFor) {
    const std::vector<std::string> uses = usesOf(kCode, {"a", "b"});
    const auto has = [&](const std::string& use) { return std::ranges::count(uses, use); };
    EXPECT_EQ(has("ring:function"), 2);
    EXPECT_EQ(has("q:variable"), 2);
    EXPECT_EQ(has("r:variable"), 2);
    EXPECT_EQ(has("a:input"), 4);
    EXPECT_EQ(has("b:input"), 1);
    EXPECT_EQ(has("c:variable"), 4);
    EXPECT_EQ(has("i:variable"), 4);
    EXPECT_EQ(has("w:variable"), 2);
    EXPECT_EQ(has("d:variable"), 2) << "assigning declares";
    EXPECT_EQ(has("Sphere:node"), 1);
    EXPECT_EQ(has("length:builtin"), 1);
    EXPECT_EQ(has("p:constant"), 3);
    EXPECT_EQ(has("nothing:unknown"), 1);
    EXPECT_EQ(has("xz:member"), 1);
    EXPECT_EQ(has("return:word"), 2);
}

TEST(CodeNames, EndWithTheirBlocks) {
    const std::string code = "{ float w = 1; } float r = w; float f(float w) { return w; } w";
    const CodeNames names = language::namesOf(code, {"w"});
    std::vector<Kind> kinds;
    for (const NameUse& use : names.uses)
        if (code.substr(use.begin, use.length) == "w") kinds.push_back(use.kind);
    EXPECT_EQ(kinds, (std::vector{Kind::variable, Kind::input, Kind::variable, Kind::variable, Kind::input}));
}

TEST(CodeNames, AreFoundInHalfWrittenCode) {
    for (const char* code : {"float a = max(", "float a = 1\nfloat b = a;", "for (int i = 0; i <", "if (a",
                             "float f(vec3", "} } float a;", "return a a a", "\"open", "/* open", "float = ;",
                             "€ 3abc .. )(", "f(float f(float f(", "const", "else else", "{{{{{{"}) {
        const CodeNames names = language::namesOf(code, {"in"});
        for (std::size_t i = 1; i < names.uses.size(); ++i)
            EXPECT_LT(names.uses[i - 1].begin, names.uses[i].begin) << code;
    }
    EXPECT_EQ(usesOf("float a = 1\nfloat b = a;", {})[3], "b:variable");
    EXPECT_EQ(usesOf("float a = 1\nfloat b = a;", {})[4], "a:variable");
    const std::string deep(100'000, '{');
    language::namesOf(deep, {});
}

/// Every sample's code has names that the checker knows: none is unknown where resolve() finds nothing.
TEST(CodeNames, AgreeWithTheChecker) {
    int codes = 0;
    for (const char* sample : {"tower_expression", "dusk_city", "camera_flight", "table_and_stool"}) {
        const Result<Graph> graph =
            readGraph(std::string(FIELDWRIGHT_SOURCE_DIR "/samples/") + sample + ".field.json", nullptr);
        if (!graph) continue;
        for (const Node& node : graph->nodes) {
            if (node.code.empty()) continue;
            std::vector<std::string> inputs;
            for (const auto& [name, value] : node.inputs) inputs.push_back(name);
            for (const NameUse& use : language::namesOf(node.code, inputs).uses)
                EXPECT_NE(use.kind, Kind::unknown) << node.code.substr(use.begin, use.length) << " in\n"
                                                   << node.code;
            ++codes;
        }
    }
    for (const NodeType& type : nodeTypes()) {
        std::vector<std::string> inputs;
        for (const InputSpec& input : type.inputs) inputs.push_back(input.name);
        for (const NameUse& use : language::namesOf(type.body, inputs).uses)
            EXPECT_NE(use.kind, Kind::unknown)
                << type.body.substr(use.begin, use.length) << " in " << type.id;
        ++codes;
    }
    EXPECT_GT(codes, 100);
}

/// A letter for each byte of a line by its ink.
std::string inksOf(const std::string& code, int line, std::vector<std::string> inputs = {}) {
    const Text text = textOf(code);
    Colouring colouring;
    const NamesOfText names = readNames(code, text.version, std::move(inputs));
    std::string inks(text.lines[std::size_t(line)].size(), ' ');
    const std::vector<Stretch> pieces = colouring.line(text, line);
    for (std::size_t k = 0; k < pieces.size(); ++k)
        for (int i = 0; i < pieces[k].length; ++i)
            inks[std::size_t(pieces[k].begin + i)] =
                ".wtcifnsCu!"[std::size_t(colouring.ink(text, line, k, &names))];
    return inks;
}

TEST(CodeColours, AreByMeaning) {
    EXPECT_EQ(inksOf("vec3 q = abs(a) * 2.5; // no", 0, {"a"}),  //
              "tttt . . fff.i. . ccc. CCCCC");
    EXPECT_EQ(inksOf("return sphere(p, r);", 0), "wwwwww nnnnnn.c. u..");
    EXPECT_EQ(inksOf("p.x = PI;", 0), "c.. . cc.");
    EXPECT_EQ(inksOf("a; /* b\nc */ d = \"e\";", 1), "CCCC . . sss.");
    EXPECT_EQ(inksOf("€ = 1;", 0), "!!! . c.");
    EXPECT_EQ(inksOf("größer", 0), "uu!!!!uu") << "a name ends where it has no letter of the language";
}

TEST(CodeColours, UseOlderNamesUntilThereAreNewOnes) {
    Text text = textOf("float a = 1;\nreturn a + b;");
    const NamesOfText names = readNames(stringOf(text), text.version, {"b"});
    Colouring colouring;
    place(text, {1, 0});
    type(text, "x", 0);
    const std::vector<Stretch> pieces = colouring.line(text, 1);
    EXPECT_EQ(colouring.ink(text, 1, pieces.size() - 2, &names), Ink::input);
    EXPECT_EQ(colouring.ink(text, 1, 0, &names), Ink::plain) << "not unknown while nobody has looked";
}

TEST(CodeColours, AreReadableOnTheirPaper) {
    const auto linear = [](ImU32 color, int shift) {
        const double c = double((color >> shift) & 255u) / 255.0;
        return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
    };
    const auto luminance = [&](ImU32 color) {
        return 0.2126 * linear(color, 0) + 0.7152 * linear(color, 8) + 0.0722 * linear(color, 16);
    };
    for (int i = 0; i <= int(Ink::wrong); ++i)
        EXPECT_GE((luminance(inkColor(Ink(i))) + 0.05) / (luminance(paperColor()) + 0.05), 4.5) << i;
}

TEST(CodeBrackets, BelongToEachOther) {
    Text text = textOf("f(a, (b), \")\" /* ) */ {\n[0]})");
    Colouring colouring;
    const auto pair = [&](Spot at) {
        place(text, at);
        const auto found = brackets(text, colouring);
        return found ? std::to_string(found->first.line) + ":" + std::to_string(found->first.byte) + " " +
                           std::to_string(found->second.line) + ":" + std::to_string(found->second.byte)
                     : std::string("none");
    };
    EXPECT_EQ(pair({0, 1}), "0:1 1:4");
    EXPECT_EQ(pair({0, 2}), "0:1 1:4") << "behind it";
    EXPECT_EQ(pair({1, 5}), "0:1 1:4");
    EXPECT_EQ(pair({1, 0}), "1:0 1:2");
    EXPECT_EQ(pair({0, 0}), "none");
    EXPECT_EQ(pair({0, 11}), "none") << "inside a text";
    text = textOf("((");
    colouring = {};
    EXPECT_EQ(pair({0, 0}), "0:0 0:0") << "it has none";
}

TEST(CodeCalls, AreAroundTheCursor) {
    const auto callOf = [](const std::string& words) {
        const std::size_t bar = words.find('|');
        Text text = textOf(words.substr(0, bar) + words.substr(bar + 1));
        Colouring colouring;
        const auto call = callAt(text, colouring, spotOf(text, bar));
        return call ? call->name + " " + std::to_string(call->argument) : std::string("none");
    };
    EXPECT_EQ(callOf("x = clamp(|"), "clamp 0");
    EXPECT_EQ(callOf("x = clamp(a, max(b, c), |"), "clamp 2");
    EXPECT_EQ(callOf("x = clamp(a, max(b, |c"), "max 1");
    EXPECT_EQ(callOf("x = clamp(a,\n  (b + |"), "clamp 1") << "a bracket of its own";
    EXPECT_EQ(callOf("x = clamp(a); |"), "none");
    EXPECT_EQ(callOf("x = cla|mp(a);"), "none");
    EXPECT_EQ(callOf("if (a, |"), "none");
    EXPECT_EQ(callOf("x = f(\",,\", |"), "f 1");
}

std::vector<std::string> completions(const std::string& words, std::vector<CodeInput> inputs = {}) {
    const std::size_t bar = words.find('|');
    const std::string code = words.substr(0, bar) + words.substr(bar + 1);
    std::size_t from = bar;
    while (from > 0 && inWord(code[from - 1])) --from;
    std::vector<std::string> names;
    for (const CodeInput& input : inputs) names.push_back(input.name);
    const CodeNames known = language::namesOf(code, names);
    const std::vector<Entry> own = entriesAt(known, inputs, from);
    std::vector<std::string> found;
    for (const Entry* entry : ranked(own, code.substr(from, bar - from))) found.push_back(entry->name);
    return found;
}

TEST(CodeCompletion, KnowsTheLibraryTheInputsAndTheCode) {
    EXPECT_EQ(completions("x = cla|").at(0), "clamp");
    EXPECT_EQ(completions("x = smin|").at(0), "smooth_min") << "letters in that order";
    EXPECT_EQ(completions("x = mat|", {{"matter", "float", ""}}).at(0), "matter") << "one's own first";
    EXPECT_EQ(completions("float radius = 1; x = ra|").at(0), "radius");
    const std::vector<std::string> after = completions("{ float radius = 1; } x = radiu|");
    EXPECT_EQ(std::ranges::count(after, "radius"), 0) << "it is gone";
    EXPECT_EQ(completions("float ring(float a) { return a; } x = ri|").at(0), "ring");
    const std::vector<std::string> all = completions("|", {{"a", "float", ""}});
    EXPECT_EQ(all.at(0), "a");
    for (const char* name : {"return", "vec3", "sphere", "mix", "PI"})
        EXPECT_EQ(std::ranges::count(all, name), 1) << name;
    EXPECT_EQ(std::ranges::count(all, "group"), 0) << "no function";
    EXPECT_TRUE(completions("qqq|").empty());
}

TEST(CodeCompletion, EveryFunctionHasAPage) {
    std::vector<std::string> pages;
    for (const BuiltinPage& page : builtinPages()) {
        pages.emplace_back(page.name);
        EXPECT_TRUE(page.doc.ends_with('.')) << page.name;
        EXPECT_TRUE(page.signature.starts_with(std::string(page.name) + "(")) << page.name;
        // As many arguments as the function takes at most; one that ends with "…" takes more.
        const std::vector<std::string> arguments = argumentsOf(page.signature);
        const language::Builtin* builtin = language::findBuiltin(page.name);
        ASSERT_TRUE(builtin) << page.name;
        if (!arguments.empty() && arguments.back() == "…") continue;
        EXPECT_EQ(int(arguments.size()), builtin->most) << page.name;
    }
    std::ranges::sort(pages);
    EXPECT_EQ(pages, language::builtinNames());
    const Entry* sphere = libraryEntry("Sphere", Kind::node);
    ASSERT_TRUE(sphere);
    EXPECT_EQ(sphere->arguments.size(), findNodeType("sphere")->inputs.size());
    EXPECT_EQ(sphere->argumentDocs.size(), sphere->arguments.size());
}

constexpr const char* kGraph = R"({"fieldwright": 1, "nodes": [
    {"id": "ball", "type": "sphere"},
    {"id": "code", "type": "expression", "inputs": {"r": 2, "s": {"from": "ball"}}, "code": "return r;"},
    {"id": "out", "type": "output", "inputs": {"surface": {"from": "code"}}}],
    "parameters": [{"name": "size", "node": "code", "input": "r"}],
    "timeline": {"duration": 1, "tracks": [{"node": "code", "input": "r", "keys": [{"time": 0, "value": 1}]}]}})";

std::vector<std::string> findingsIn(const std::string& code) {
    std::vector<std::string> all;
    for (const Error& finding : findingsOf(parsed(kGraph), "", "code", code))
        all.push_back(std::to_string(finding.codeLine) + ":" + std::to_string(finding.codeColumn) + " " +
                      finding.message);
    return all;
}

TEST(CodeCheck, FindsWhatTheDocumentWould) {
    EXPECT_TRUE(findingsIn("return r;").empty());
    EXPECT_TRUE(findingsIn("return min(s, r);").empty()) << "by what feeds it";
    EXPECT_EQ(findingsIn("return lenght(p);").at(0), "1:8 unknown function 'lenght': did you mean 'length'?");
    EXPECT_EQ(findingsIn("float a = 1;\nreturn a +;").at(0).substr(0, 4), "2:11");
    EXPECT_EQ(findingsIn("float a = 1;\nreturn a / 0;").at(0), "2:10 division by zero") << "lowered";
    EXPECT_TRUE(findingsOf(parsed(kGraph), "gone", "code", "x").empty());
    EXPECT_TRUE(findingsOf(parsed(kGraph), "", "gone", "x").empty());
}

TEST(CodeCheck, MarksTheTokenAndGoesWithItsLine) {
    Text text = textOf("float ä = 1;\nreturn lenght(p) * ;");
    Error error{.message = "m", .codeLine = 2, .codeColumn = 8};
    std::vector<Mark> marks = marksOf(text, {error, {.message = "end", .codeLine = 9, .codeColumn = 9}});
    EXPECT_EQ(stringOf(text, marks.at(0).range), "lenght");
    EXPECT_EQ(stringOf(text, marks.at(1).range), ";");
    const uint64_t before = text.version;
    place(text, {0, 0});
    breakLine(text);
    type(text, "x", 0);
    moveMarks(marks, text, text.version - before);
    EXPECT_EQ(stringOf(text, marks.at(0).range), "lenght");
    EXPECT_EQ(marks.at(0).range.from.line, 2);
}

TEST(CodeRename, IsByTokens) {
    EXPECT_EQ(renamedInCode("// r\nx = r + v.r + rr; s = \"r\"; r(p) /* r */;", "r", "radius"),
              "// r\nx = radius + v.r + rr; s = \"r\"; radius(p) /* r */;");
    EXPECT_EQ(renamedInCode("{ float r = r; r = 2; } return r;", "r", "q"),
              "{ float r = q; r = 2; } return q;")
        << "a variable hides it";
    EXPECT_EQ(renamedInCode("r = r * 2; float f(float r) { return r; } return 2.*r;", "r", "q"),
              "q = q * 2; float f(float r) { return r; } return 2.*q;");
}

TEST(CodeRename, TakesParametersAndTracksAlong) {
    Graph graph = parsed(kGraph);
    graph = setCode(graph, "", "code", "float t = 1; return r * t * sin(r);");
    const auto renamed = [&](const char* to) { return renameExpressionInput(graph, "", {"code", "r"}, to); };
    const Result<Graph> made = renamed("radius");
    ASSERT_TRUE(made);
    EXPECT_EQ(made->node("code")->code, "float t = 1; return radius * t * sin(radius);");
    EXPECT_TRUE(made->node("code")->input("radius"));
    EXPECT_EQ(made->parameters.at(0).input, "radius");
    const std::string text = writeGraph(*made);
    EXPECT_EQ(text.find("\"r\""), std::string::npos) << text;
    EXPECT_TRUE(errorsOf(*made).empty()) << errorsOf(*made);
    for (const char* taken : {"s", "t", "sin", "return", "vec3", "2r"}) EXPECT_FALSE(renamed(taken)) << taken;
}

}  // namespace fw::editor::test::code_language_test
