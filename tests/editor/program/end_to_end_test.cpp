// The real program from end to end: work that a crash would take, the clipboard, a thousand nodes, and how it
// looks.
#include <gtest/gtest.h>

#include <filesystem>

#include "graph/document/json.h"
#include "tests/support/editor/program.h"

namespace fw::editor::test::end_to_end_test {

using fw::test::readText;

const std::string kTower = FIELDWRIGHT_SOURCE_DIR "/samples/tower.field.json";

TEST(EndToEnd, WorkIsGivenBackAfterTheProgramWasKilled) {
    Program program(readText(kTower));
    ASSERT_TRUE(program.works()) << "Xvfb, xdotool or xclip is not installed: run ./.install test";
    program.frameAll();
    program.click(program.title("room"));
    program.keys("Ctrl+D");
    const std::string wanted = program.save();
    program.keys("Ctrl+Z");
    const std::string before = program.save();
    ASSERT_NE(wanted, before);
    program.keys("Ctrl+Y");
    // The copy comes by itself, some time after the change.
    const std::filesystem::path copies = program.path("state/fieldwright/recovery");
    const auto copied = [&] {
        std::error_code none;
        for (const auto& entry : std::filesystem::directory_iterator(copies, none))
            if (entry.path().extension() == ".json") return true;
        return false;
    };
    ASSERT_TRUE(eventually(copied));
    program.kill();
    EXPECT_EQ(readText(program.file()), before);

    program.start({program.file()});
    program.clickOn("Restore");
    program.waitForTitle("document.field.json * - Fieldwright");
    EXPECT_EQ(program.save(), wanted);
    EXPECT_TRUE(eventually([&] { return !copied(); }));
}

TEST(EndToEnd, PastesWhatOtherProgramsCopied) {
    Program program;
    ASSERT_TRUE(program.works()) << "Xvfb, xdotool or xclip is not installed: run ./.install test";
    program.frameAll();
    program.clipboard(readText(kTower));
    program.moveTo(program.nowhere());
    program.keys("Ctrl+V");
    EXPECT_EQ(program.saved().nodes.size(), 8u);
    const std::string pasted = program.save();

    // All of it out and in again.
    program.keys("Ctrl+A");
    program.keys("Ctrl+X");
    EXPECT_EQ(program.saved().nodes.size(), 0u);
    EXPECT_NE(program.clipboard().find("half_extents"), std::string::npos);
    program.keys("Ctrl+V");
    EXPECT_EQ(program.saved().nodes.size(), 8u);

    const std::string before = program.save();
    for (const char* garbage : {"hello", "", "{\"nodes\": [", "{\"nodes\": [{\"id\": 3}]}"}) {
        program.clipboard(garbage);
        program.keys("Ctrl+V");
        program.waitFor("cannot paste:");
        EXPECT_EQ(program.save(), before) << garbage;
        program.waitUntilGone("cannot paste:");
    }
}

TEST(EndToEnd, AThousandNodes) {
    Graph graph;
    for (int i = 0; i < 1000; ++i) {
        Node node;
        node.id = "n" + std::to_string(i);
        node.type = i == 999 ? "output" : i % 3 == 2 ? "subtract" : "box";
        node.at = {{double(i % 40) * 240.0, double(i / 40) * 220.0}};
        const auto link = [](int from) { return InputValue{.value = Link{"n" + std::to_string(from), ""}}; };
        if (node.type == "subtract") node.inputs = {{"a", link(i - 2)}, {"b", link(i - 1)}};
        if (node.type == "output") node.inputs = {{"surface", link(0)}};
        graph.nodes.push_back(node);
    }
    const std::string text = writeGraph(graph);
    Program program(text);
    ASSERT_TRUE(program.works()) << "Xvfb, xdotool or xclip is not installed: run ./.install test";
    EXPECT_EQ(program.save(), text);
    program.frameAll();
    EXPECT_LT(program.view.zoom, 0.25f);  // all of them are seen
    program.zoom(6);
    program.pan({-180, 90});

    program.keys("Ctrl+A");
    const auto seen = std::ranges::find_if(graph.nodes, [&](const Node& node) {
        return program.view.panel.grown(-150).contains(program.title(node.id));
    });
    ASSERT_NE(seen, graph.nodes.end());
    const ImVec2 from = program.title(seen->id);
    program.drag({from, {from.x + 60, from.y - 40}});
    const Graph moved = program.saved();
    for (std::size_t i = 0; i < moved.nodes.size(); ++i)
        for (std::size_t k = 0; k < 2; ++k)
            EXPECT_EQ((*moved.nodes[i].at)[k] - (*graph.nodes[i].at)[k], (*moved.nodes[0].at)[k]);
    EXPECT_NEAR((*moved.nodes[0].at)[0], 60 / program.view.unit(), 1.5);
    program.keys("Ctrl+Z");
    EXPECT_EQ(program.save(), text);
}

TEST(EndToEnd, LooksAsItDid) {
    Program program(readText(kTower));
    ASSERT_TRUE(program.works()) << "Xvfb, xdotool or xclip is not installed: run ./.install test";
    program.frameAll();
    const Area panel = program.view.panel;
    const Area part{panel.lo, {panel.lo.x + 620, panel.lo.y + 560}};
    const auto expect = [&](const std::string& name) {
        program.moveTo({640, 795});  // where nothing is lit by the mouse
        program.expectGolden(name, part);
    };
    expect("tower_framed");
    program.click(program.title("pierced"));
    program.keys("F");
    program.view.frame(Boxes(program.graph(), "").find("pierced")->area);
    expect("tower_100");
    program.zoom(-5);
    expect("tower_50");
    program.zoom(12);
    expect("tower_200");

    program.moveTo({panel.lo.x + 150, panel.lo.y + 60});
    program.keys("Home");
    program.keys("Shift+A");
    program.type("sub");
    expect("add_menu");
    program.keys("Escape");
    program.keys("Ctrl+A");
    program.keys("Delete");
    expect("empty");
}

}  // namespace fw::editor::test::end_to_end_test
