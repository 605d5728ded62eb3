// The tour: each of its steps is noticed when it is done, and when it is taken back; and it is walked to its
// end by doing what it asks for, which leaves docs/graphs/tour.field.json to the byte.
#include "editor/panels/tour.h"

#include <gtest/gtest.h>

#include "editor/document/document.h"
#include "editor/document/edits.h"
#include "editor/files/samples.h"
#include "graph/check/check.h"
#include "graph/document/json.h"
#include "tests/support/editor/driven_editor.h"
#include "tests/support/editor/kept_graph.h"
#include "tests/support/editor/reader.h"

namespace fw::editor::tour_test {

TEST(Tour, NoticesEveryStepAndItsUndoing) {
    ASSERT_EQ(samplesFolder(), FIELDWRIGHT_SOURCE_DIR "/samples");
    const Result<Graph> tower = readGraph(samplesFolder() + "/tower.field.json", nullptr);
    ASSERT_TRUE(tower);
    Document document(*tower);
    EXPECT_EQ(tourStepsDone(document.graph()), 0u);
    EXPECT_EQ(tourStepsDone(Graph{}), 0u);

    const auto change = [&](Graph next) { document.apply("Step", std::move(next)); };
    const auto add = [&](const char* type) {
        Edited edited = addNode(document.graph(), "", type, {0, 600});
        const std::string id = edited.nodes.at(0);
        change(std::move(edited.graph));
        return id;
    };
    const auto set = [&](const std::string& node, const char* input, std::vector<double> value) {
        change(setInput(document.graph(), "", {node, input}, InputValue{.value = std::move(value)}));
    };
    const std::string box = add("box");
    EXPECT_EQ(tourStepsDone(document.graph()), 1u);
    set(box, "half_extents", {0.15, 1, 1});
    EXPECT_EQ(tourStepsDone(document.graph()), 1u) << "it ends in the wall";
    set(box, "half_extents", {0.15, 0.5, 2});
    EXPECT_EQ(tourStepsDone(document.graph()), 2u);
    const std::string repeat = add("repeat");
    EXPECT_EQ(tourStepsDone(document.graph()), 2u);
    change(connect(document.graph(), "", {box, "surface"}, {repeat, "surface"}));
    EXPECT_EQ(tourStepsDone(document.graph()), 3u);
    set(repeat, "period", {0.5, 0, 0});
    EXPECT_EQ(tourStepsDone(document.graph()), 3u);
    set(repeat, "count", {4, 0, 0});
    EXPECT_EQ(tourStepsDone(document.graph()), 4u);
    const std::string cut = add("subtract");
    EXPECT_EQ(tourStepsDone(document.graph()), 4u);
    change(dropOnWire(document.graph(), "", {"out", "surface"}, cut));
    EXPECT_EQ(tourStepsDone(document.graph()), 5u);
    change(connect(document.graph(), "", {repeat, "surface"}, {cut, "b"}));
    EXPECT_EQ(tourStepsDone(document.graph()), kTourSteps);
    for (const Error& finding : check(document.graph()))
        EXPECT_NE(finding.severity, Error::Severity::error) << format(finding);

    for (std::size_t before = kTourSteps; document.undo();) {
        const std::size_t now = tourStepsDone(document.graph());
        EXPECT_LE(now, before);
        before = now;
    }
    EXPECT_EQ(tourStepsDone(document.graph()), 0u);
}

TEST(Tour, IsWalkedToItsEnd) {
    test::DrivenEditor editor;
    NEEDS_EDITOR(editor);
    test::Reader reader;
    const auto graph = [&]() -> const Graph& { return editor->document.graph(); };
    const auto expectStep = [&](std::size_t done, const char* words) {
        EXPECT_EQ(tourStepsDone(graph()), done);
        EXPECT_TRUE(reader.find(editor.capture(), words, kFontSize, editor->canvas.view.panel)) << words;
    };
    const auto place = [&](float x, float y) { return editor->canvas.view.toScreen(ImVec2(x, y)); };
    const auto add = [&](const char* search, float x, float y) {
        editor.moveTo(place(x, y));
        editor.send("key --delay 0 shift+a type --delay 0 --args 1 " + std::string(search) + " key Return");
        return editor->canvas.active;
    };
    const auto set = [&](const std::string& node, const char* input, const std::vector<const char*>& texts) {
        for (std::size_t i = 0; i < texts.size(); ++i) {
            editor.click(editor.field(node, input, int(i)));
            editor.send("type --delay 0 --args 1 '" + std::string(texts[i]) + "' key Return");
        }
    };
    editor->panels.top = kLeastPart;  // nobody looks at its picture
    editor.keys("F3");
    editor.send("type --delay 0 --args 1 tour key Return");
    ASSERT_TRUE(editor->windows.tour);
    ASSERT_EQ(graph().nodes.size(), 8u);
    test::lookExactly(editor->canvas.view, {480, 200});
    editor.settle();
    expectStep(0, "A box for the window");

    const std::string box = add("box", 0, 536);
    expectStep(1, "Long and narrow");
    set(box, "half_extents", {"0.15", "0.5", "2"});
    expectStep(2, "Repeat it");
    editor.drag(editor.socket(box, "surface", true), place(240, 536));
    editor.send("type --delay 0 --args 1 repeat key Return");
    const std::string repeat = editor->canvas.active;
    expectStep(3, "Four in a row");
    set(repeat, "period", {"0.5", "0", "0"});
    set(repeat, "count", {"4", "0", "0"});
    expectStep(4, "A place to cut");
    const std::string cut = add("subtract", 480, 536);
    const ImVec2 from = editor.socket("hollow", "surface", true), to = editor.socket("out", "surface", false),
                 title = editor.title(cut),
                 middle = editor->canvas.view.toScreen(editor->boxes->find(cut)->area.centre());
    editor.drag(title,
                {title.x + 0.5f * (from.x + to.x) - middle.x, title.y + 0.5f * (from.y + to.y) - middle.y});
    expectStep(5, "Cut");
    editor.drag(editor.socket(repeat, "surface", true), editor.socket(cut, "b", false));
    expectStep(kTourSteps, "There is the row of windows");

    const std::string file = editor.path("tour.field.json");
    editor.keys("ctrl+s ctrl+a");
    editor.type(file);
    editor.keys("Return");
    test::expectKept(fw::test::readText(file), "tour.field.json");
}

TEST(Tour, SurvivesWhatFilesMayHold) {
    const Result<Graph> loop = parseGraph(R"({"fieldwright": 1, "nodes": [
        {"id": "a", "type": "subtract", "inputs": {"a": {"from": "b"}}},
        {"id": "b", "type": "subtract", "inputs": {"a": {"from": "a"}}},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "a"}}}]})",
                                          "", nullptr);
    ASSERT_TRUE(loop);
    EXPECT_EQ(tourStepsDone(*loop), 0u);
}

}  // namespace fw::editor::tour_test
