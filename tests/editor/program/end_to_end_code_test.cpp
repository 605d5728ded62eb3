// Code typed in the real window: what is marked and offered while it is typed, what reaches the document and
// when, read off the screen and from the saved file.
#include <gtest/gtest.h>

#include "editor/code/view.h"
#include "editor/shell/theme.h"
#include "tests/support/editor/program.h"

namespace fw::editor::test::end_to_end_code_test {

using fw::test::readText;

constexpr const char* kDocument = R"({"fieldwright": 1, "nodes": [
    {"id": "ball", "type": "sphere", "at": [0, 220]},
    {"id": "wave", "type": "expression", "at": [260, 0], "code": "return length(p) - radius;",
     "inputs": {"radius": 1, "solid": {"from": "ball"}}},
    {"id": "out", "type": "output", "at": [520, 0], "inputs": {"surface": {"from": "wave"}, "resolution": 16}}],
    "parameters": [{"name": "size", "node": "wave", "input": "radius"}]})";

#define NEEDS_PROGRAM(program) \
    ASSERT_TRUE((program).works()) << "Xvfb, xdotool or xclip is not installed: run ./.install test"

/// The expression is selected; where its code is, from below its heading to the window's end.
Area openCode(Program& program) {
    program.frameAll();
    // More room for the inspector: the bar above it is dragged.
    const float tabs = program.waitFor("Inspector").lo.y, bar = tabs - 12;
    if (bar > 250) program.drag({{1050, bar}, {1050, bar - 60}, {1050, 200}});
    EXPECT_TRUE(eventually([&] { return program.waitFor("Inspector").lo.y < 250; }));
    program.click(program.title("wave"));
    program.waitFor("no exact distance");  // what the check says moves the rest down when it comes
    const Area heading = program.waitFor("Ctrl+Enter applies it");
    return {{program.view.panel.hi.x, heading.hi.y}, {1275, 795}};
}

/// The keyboard is in it, at its very end.
Area enterCode(Program& program) {
    const Area code = openCode(program);
    program.click(program.waitForCode("length", code).centre());
    program.keys("Ctrl+End");
    return code;
}

std::string codeOf(const Graph& graph) { return findNode(graph.nodes, "wave")->code; }

/// How many pixels of a part of the screen have this colour, nearly.
int pixelsOf(Program& program, const Area& part, ImU32 color) {
    const Picture seen = program.screen(part);
    int count = 0;
    for (std::size_t i = 0; i + 3 < seen.pixels.size(); i += 4) {
        bool same = true;
        for (int c = 0; c < 3; ++c)
            same &= std::abs(int(seen.pixels[i + std::size_t(c)]) - int((color >> (8 * c)) & 255u)) < 40;
        count += same;
    }
    return count;
}

/// Below a word: where its wave is.
Area below(const Area& word) { return {{word.lo.x, word.hi.y - 1}, {word.hi.x, word.hi.y + 4}}; }

TEST(EndToEndCode, IsAppliedByCtrlEnterAndTheKeyboardStays) {
    Program program(kDocument);
    NEEDS_PROGRAM(program);
    const std::string original = program.save();
    enterCode(program);
    program.keys("Ctrl+A");
    program.type("float q = radius * 2;\nif (q > 1) {\nq = 1;\n}\nreturn length(p) - q;");
    program.keys("Ctrl+Enter");
    // It goes on where it was.
    program.type(" // twice");
    EXPECT_EQ(codeOf(program.saved()),
              "float q = radius * 2;\nif (q > 1) {\n    q = 1;\n}\nreturn length(p) - q; // twice");
    // Two steps: what was applied, and what saving took along.
    program.click(program.nowhere());
    program.keys("Ctrl+Z");
    EXPECT_EQ(codeOf(program.saved()),
              "float q = radius * 2;\nif (q > 1) {\n    q = 1;\n}\nreturn length(p) - q;");
    program.keys("Ctrl+Z");
    EXPECT_EQ(program.save(), original);
}

TEST(EndToEndCode, EditsByKeys) {
    Program program(kDocument);
    NEEDS_PROGRAM(program);
    enterCode(program);
    program.keys("Ctrl+A");
    program.type("a = 1;\nb = 2;\nreturn a + b;");
    program.keys("Up");
    program.keys("Alt+Up");      // b before a
    program.keys("Ctrl+D");      // b twice
    program.keys("Ctrl+Slash");  // the second a comment
    program.keys("Ctrl+End");
    program.keys("Shift+Ctrl+Left", 2);  // "b;"
    program.type("3.5;");
    EXPECT_EQ(codeOf(program.saved()), "b = 2;\n// b = 2;\na = 1;\nreturn a + 3.5;");
    program.click(program.waitForCode("return").centre());
    program.keys("Ctrl+Home");
    program.keys("Shift+Down");
    program.keys("Ctrl+X");
    program.keys("Ctrl+End");
    program.keys("Enter");
    program.keys("Ctrl+V");
    program.keys("Ctrl+Z", 2);
    program.keys("Ctrl+Y", 2);
    EXPECT_EQ(codeOf(program.saved()), "// b = 2;\na = 1;\nreturn a + 3.5;\nb = 2;\n");
}

TEST(EndToEndCode, TheMouseSelectsWordsAndLines) {
    Program program(kDocument);
    NEEDS_PROGRAM(program);
    const Area code = openCode(program);
    const Area word = program.waitForCode("length", code);
    program.doubleClick(word.centre());
    program.type("abs");
    EXPECT_EQ(codeOf(program.saved()), "return abs(p) - radius;");
    const Area other = program.waitForCode("radius", code);
    program.drag({{other.lo.x + 1, other.centre().y}, {other.hi.x - 1, other.centre().y}});
    program.type("1");
    EXPECT_EQ(codeOf(program.saved()), "return abs(p) - 1;");
    program.moveTo(program.waitForCode("abs", code).centre());
    program.send("click --repeat 3 --delay 0 1");
    program.type("return 2;");
    EXPECT_EQ(codeOf(program.saved()), "return 2;");
}

TEST(EndToEndCode, WhatIsWrongIsMarkedWhileItIsTyped) {
    Program program(kDocument);
    NEEDS_PROGRAM(program);
    const std::string original = program.save();
    const Area code = enterCode(program);
    const ImU32 error = themeColor(ThemeColor::error);
    program.keys("Ctrl+A");
    program.type("return lenght(p) - radius;");
    program.waitFor("Line 1, column 8: unknown function", code);
    // What is marked touches its letters: it is found by the word before it.
    const Area before = program.waitForCode("return", code);
    const float cell = before.width() / 6.0f;
    const Area word{{before.lo.x + 7 * cell, before.lo.y}, {before.lo.x + 13 * cell, before.hi.y}};
    EXPECT_GT(pixelsOf(program, below(word), error), 10);
    EXPECT_EQ(pixelsOf(program, below(program.waitForCode("radius", code)), error), 0);
    // Nothing of it is in the document.
    EXPECT_EQ(program.title(), "document.field.json - Fieldwright");
    EXPECT_EQ(readText(program.file()), original);
    // What it is, under the mouse.
    program.moveTo(word.centre());
    program.waitFor("unknown function 'lenght': did you mean 'length'?");
    program.moveTo({code.lo.x - 300, 700});
    // Put right, it is gone.
    program.keys("Ctrl+Home");
    program.keys("Ctrl+Right");
    program.keys("Shift+Ctrl+Right");
    program.type("length");
    program.waitUntilGone("Line 1, column 8: unknown function");
    EXPECT_TRUE(eventually([&] { return pixelsOf(program, below(word), error) == 0; }));
    // Lowering finds what the types do not say.
    program.keys("End");
    program.keys("Left");
    program.type(" / 0");
    program.waitFor("division by zero", code);
    // Escape takes it all back, and Ctrl+Z in the code brings it again.
    program.keys("Escape");
    program.waitUntilGone("division by zero");
    EXPECT_EQ(program.save(), original);
}

TEST(EndToEndCode, CompletionsAreTakenAndSignaturesShown) {
    Program program(kDocument);
    NEEDS_PROGRAM(program);
    const Area code = enterCode(program);
    program.keys("Ctrl+A");
    program.type("return smi");
    program.waitForCode("smooth_min");
    program.waitFor("built in");
    program.keys("Enter");
    // The signature, with the argument at hand marked.
    const auto marks = [&](const std::string& argument) {
        return eventually([&] {
            return pixelsOf(program, program.waitForCode(argument), themeColor(ThemeColor::active)) > 5;
        });
    };
    program.waitForCode("smooth_min(");
    EXPECT_TRUE(marks("a,"));
    program.type("length(p), ");
    EXPECT_TRUE(marks("b,"));
    program.type("ra");
    program.waitFor("input");
    program.keys("Tab");
    program.type(", 0.1);");
    EXPECT_EQ(codeOf(program.saved()), "return smooth_min(length(p), radius, 0.1);");

    // By Ctrl+Space everything; Escape closes the list and nothing else; a name that is there ends its line.
    program.click(program.waitForCode("return", code).centre());
    program.keys("Ctrl+End");
    program.type("\nx = radius\n");
    program.type("max");
    program.waitFor("built in");
    program.keys("Escape");
    program.waitUntilGone("built in");
    program.keys("BackSpace", 3);
    program.keys("Ctrl+Space");
    program.waitFor("input");
    program.keys("Down");
    program.keys("Escape");
    program.waitUntilGone("variable");
    EXPECT_EQ(codeOf(program.saved()), "return smooth_min(length(p), radius, 0.1);\nx = radius\n");
}

TEST(EndToEndCode, NamesSayWhatTheyAreAndLeadToTheirPlace) {
    Program program(kDocument);
    NEEDS_PROGRAM(program);
    const Area code = enterCode(program);
    program.moveTo(program.waitForCode("length", code).centre());
    program.waitFor("How long a vector is.");
    program.moveTo({code.lo.x - 300, 700});
    program.keys("Ctrl+A");
    program.type("float waist = 2;\nreturn box(p, waist) + solid;");
    // A variable: its definition is selected.
    program.keys("Ctrl+Left", 4);
    program.keys("F12");
    program.type("middle");
    program.keys("Ctrl+Enter");
    EXPECT_EQ(codeOf(program.saved()), "float middle = 2;\nreturn box(p, waist) + solid;");
    // A node: its page.
    program.click(program.waitForCode("box", code).centre(), 1, "ctrl");
    program.waitFor("Node reference");
    program.waitFor("In files and in code: box");
    program.keys("Escape");
    program.waitUntilGone("Node reference");
    // An input that is fed: what feeds it.
    program.click(program.waitForCode("solid", code).centre(), 1, "ctrl");
    program.waitFor("Sphere  ·  Shapes");
}

TEST(EndToEndCode, AnInputIsRenamedEverywhereAsOneStep) {
    Program program(kDocument);
    NEEDS_PROGRAM(program);
    const std::string original = program.save();
    const Area code = enterCode(program);
    program.click(program.waitForCode("radius", code).centre());
    program.keys("F2");
    program.waitFor("Another name for radius");
    program.type("solid\n");
    program.waitFor("the expression has an input 'solid' already");
    program.keys("Ctrl+A");
    program.type("reach\n");
    program.waitForCode("reach", code);
    const Graph renamed = program.saved();
    EXPECT_EQ(codeOf(renamed), "return length(p) - reach;");
    EXPECT_TRUE(findNode(renamed.nodes, "wave")->input("reach"));
    EXPECT_FALSE(findNode(renamed.nodes, "wave")->input("radius"));
    EXPECT_EQ(renamed.parameters.at(0).input, "reach");
    program.click(program.nowhere());
    program.keys("Ctrl+Z");
    EXPECT_EQ(program.save(), original);
}

TEST(EndToEndCode, AVariableIsRenamedInTheText) {
    Program program(kDocument);
    NEEDS_PROGRAM(program);
    const Area code = enterCode(program);
    program.keys("Ctrl+A");
    program.type("wide = 1; // wide\nreturn wide + p.x;");
    program.click(program.waitForCode("wide", code).centre());
    program.keys("F2");
    program.waitFor("Another name for wide");
    program.type("far\n");
    program.waitForCode("far", code);
    EXPECT_EQ(codeOf(program.saved()), "far = 1; // wide\nreturn far + p.x;");
}

TEST(EndToEndCode, IsShownLargeAndBack) {
    Program program(kDocument);
    NEEDS_PROGRAM(program);
    const Area code = enterCode(program);
    program.keys("F4");
    const Area title = program.waitFor("Code of Expression");
    EXPECT_TRUE(program.view.panel.grown(4).contains(title.centre()));
    const Area word = program.waitForCode("length", program.view.panel);
    program.type(" // large");
    program.waitForCode("//", program.view.panel);
    EXPECT_EQ(program.title(), "document.field.json - Fieldwright") << "it is still being typed";
    program.click(word.centre());
    program.keys("End");
    program.keys("Escape");
    program.waitUntilGone("Code of Expression");
    program.waitForCode("length", code);
    program.type("!");
    EXPECT_EQ(codeOf(program.saved()), "return length(p) - radius; // large!");
    program.clickOn("↗");
    program.waitFor("Code of Expression");
}

TEST(EndToEndCode, IsFound) {
    Program program(kDocument);
    NEEDS_PROGRAM(program);
    const Area code = enterCode(program);
    program.keys("Ctrl+A");
    program.type("a = radius;\nb = radius;\nreturn a + b;");
    program.keys("Ctrl+F");
    program.waitFor("Find", code);
    program.type("radius");
    program.waitFor("2 found", code);
    program.type("\n");  // on to the second
    program.keys("Escape");
    program.waitUntilGone("2 found");
    program.type("7");
    EXPECT_EQ(codeOf(program.saved()), "a = radius;\nb = 7;\nreturn a + b;");
}

TEST(EndToEndCode, UndoFromTheMenuTakesBackWhatWasTyped) {
    Program program(kDocument);
    NEEDS_PROGRAM(program);
    const std::string original = program.save();
    const Area code = enterCode(program);
    program.type(" // more yet");
    program.waitForCode("more", code);
    program.clickOn("Edit");
    program.clickOn("Undo Change Code");
    EXPECT_EQ(program.save(), original);
    program.waitForCode("length", code);
    EXPECT_FALSE(program.reader.find(program.screen(), "more", kFontSize, code, Reader::Face::code));
}

TEST(EndToEndCode, AnotherNodeOrDocumentEndsTheTyping) {
    Program program(kDocument);
    NEEDS_PROGRAM(program);
    enterCode(program);
    program.type(" // left");
    program.click(program.title("ball"));
    program.waitFor("Sphere  ·  Shapes");
    EXPECT_EQ(codeOf(program.saved()), "return length(p) - radius; // left");
    // Deleted, with its text under the hand: the text goes with it.
    enterCode(program);
    program.type(" more");
    program.click(program.title("wave"));
    program.keys("Delete");
    EXPECT_FALSE(findNode(program.saved().nodes, "wave"));
    program.keys("Ctrl+Z");
    EXPECT_EQ(codeOf(program.saved()), "return length(p) - radius; // left more");
}

TEST(EndToEndCode, NothingChangesUnderWhatIsTypedButItIsAskedAboutThen) {
    Program program(kDocument);
    NEEDS_PROGRAM(program);
    std::string other = program.save();
    const Area code = enterCode(program);
    program.type(" // mine yet");
    program.waitForCode("mine", code);
    const std::string radius = "\"radius\": 1";
    ASSERT_NE(other.find(radius), std::string::npos) << other;
    fw::test::writeText(program.file(), other.replace(other.find(radius), radius.size(), "\"radius\": 2"));
    program.keys("Ctrl+Enter");
    program.waitFor("Another program changed");
    program.clickOn("Keep mine");
    const Graph graph = program.saved();
    EXPECT_EQ(codeOf(graph), "return length(p) - radius; // mine yet");
    EXPECT_EQ(std::get<double>(findNode(graph.nodes, "wave")->input("radius")->value), 1.0);
}

TEST(EndToEndCode, NewInputsFollowEachOther) {
    Program program(kDocument);
    NEEDS_PROGRAM(program);
    openCode(program);
    program.clickOn("new input's name");
    program.type("period\nhalf_width\n");
    const Graph graph = program.saved();
    EXPECT_TRUE(findNode(graph.nodes, "wave")->input("period"));
    EXPECT_TRUE(findNode(graph.nodes, "wave")->input("half_width"));
}

TEST(EndToEndCode, TheCaretRestsAfterAWhile) {
    code::View view;
    view.touched = code::now();
    EXPECT_TRUE(std::isinf(code::nextBlink(view))) << "the keyboard is elsewhere";
    view.inside = true;
    EXPECT_GT(code::nextBlink(view), 0.0);
    EXPECT_LT(code::nextBlink(view), 1.0);
    view.touched -= 60.0;
    EXPECT_TRUE(std::isinf(code::nextBlink(view)));
}

}  // namespace fw::editor::test::end_to_end_code_test
