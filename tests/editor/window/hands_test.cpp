// What a hand has begun, in a real window: another document, another program, another key comes in its way,
// and nothing is lost, goes on over what it was not begun on, or leaves the editor deaf.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "editor/commands.h"
#include "editor/document/parameters.h"
#include "graph/document/json.h"
#include "graph/document/named_parameters.h"
#include "tests/support/editor/driven_editor.h"
#include "tests/support/editor/graphs.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::editor::hands_test {

using fw::test::writeText;
using test::DrivenEditor;

constexpr const char* kBall = R"({"fieldwright": 1, "nodes": [
    {"id": "ball", "type": "sphere", "at": [0, 0], "inputs": {"radius": 1}},
    {"id": "moved", "type": "translate", "at": [240, 0],
     "inputs": {"surface": {"from": "ball"}, "offset": [1, 2, 3]}},
    {"id": "out", "type": "output", "at": [480, 0], "inputs": {"surface": {"from": "moved"}, "resolution": 24}}],
    "timeline": {"length": 8, "tracks": [
        {"node": "ball", "input": "radius", "keys": [{"time": 0, "value": 1}, {"time": 8, "value": 2}]}]}})";
constexpr const char* kBlock = R"({"fieldwright": 1, "nodes": [
    {"id": "ball", "type": "sphere", "at": [0, 0], "inputs": {"radius": 3}},
    {"id": "out", "type": "output", "at": [240, 0], "inputs": {"surface": {"from": "ball"}, "resolution": 24}}],
    "timeline": {"length": 2}})";

std::string to(ImVec2 at) {
    return "mousemove " + std::to_string(std::lround(at.x)) + " " + std::to_string(std::lround(at.y));
}
double radius(DrivenEditor& editor) {
    return inputNumbers(*editor->document.graph().node("ball"), "radius").at(0);
}

TEST(Hands, AnotherDocumentHasNothingOfTheOneBefore) {
    DrivenEditor editor;
    NEEDS_EDITOR(editor);
    writeText(editor.path("ball.field.json"), kBall);
    writeText(editor.path("block.field.json"), kBlock);
    openFile(*editor, editor.path("ball.field.json"));
    editor.settle();
    editor->viewport.seconds = 5.5;
    editor->viewport.playing = true;
    editor->panels.timeline = true;
    editor->panelState.search = "ball";
    editor->viewport.pinned = "moved";
    editor->thumbnails.toggle(editor->shell, "ball");
    const uint64_t revision = editor->document.revision();
    editor->canvas.select({"ball"});
    editor.settle();
    // A number is half typed, and a label.
    editor.keys("F2");
    editor.type("half a label");
    EXPECT_TRUE(editor->document.held());
    openFile(*editor, editor.path("block.field.json"));
    editor.settle();
    EXPECT_NE(editor->document.revision(), revision);
    EXPECT_FALSE(editor->document.held());
    EXPECT_FALSE(editor->document.unsaved()) << "what was typed for the other one is in this one";
    EXPECT_EQ(editor->document.graph().node("ball")->label, "");
    EXPECT_EQ(editor->viewport.seconds, 0.0);
    EXPECT_FALSE(editor->viewport.playing);
    EXPECT_EQ(editor->viewport.pinned, "");
    EXPECT_TRUE(editor->thumbnails.shown.empty());
    EXPECT_EQ(editor->panelState.search, "");
    EXPECT_TRUE(editor->canvas.selection.empty());
    editor.type("more");  // goes nowhere
    EXPECT_FALSE(editor->document.unsaved());
}

TEST(Hands, WhatIsTypedIsAmongTheChangesThatAreAskedAbout) {
    DrivenEditor editor;
    NEEDS_EDITOR(editor);
    writeText(editor.path("ball.field.json"), kBlock);
    openFile(*editor, editor.path("ball.field.json"));
    editor->canvas.select({"ball"});
    editor.settle();
    editor.keys("F2");
    editor.type("head");
    EXPECT_FALSE(editor->document.unsaved());
    proceed(*editor, Files::Next::close);
    EXPECT_TRUE(editor->document.unsaved());
    EXPECT_TRUE(editor->files.asks);
    EXPECT_EQ(editor->document.graph().node("ball")->label, "head");
}

TEST(Hands, KeysBetweenPressAndReleaseWait) {
    DrivenEditor editor(test::parsed(kBlock));
    NEEDS_EDITOR(editor);
    editor->canvas.select({"ball"});
    editor.settle();
    const std::string before = writeGraph(editor->document.graph());
    editor.during(to(editor.title("ball")) + " mousedown 1");
    EXPECT_TRUE(editor->document.held());
    editor.during("key --delay 0 Delete ctrl+a x");
    EXPECT_EQ(writeGraph(editor->document.graph()), before);
    editor.send("mouseup 1");
    EXPECT_FALSE(editor->document.held());
    EXPECT_EQ(editor->canvas.active, "ball");
    editor.keys("Delete");
    EXPECT_FALSE(editor->document.graph().node("ball"));
}

TEST(Hands, AChangeUnderADragEndsIt) {
    DrivenEditor editor(test::parsed(kBlock));
    NEEDS_EDITOR(editor);
    const ImVec2 title = editor.title("ball");
    editor.during(to(title) + " mousedown 1");
    editor.during(to({title.x + 40, title.y + 60}));
    editor.during(to({title.x + 80, title.y + 90}));
    EXPECT_EQ(editor->canvas.gesture.kind, CanvasGesture::Kind::move);
    // The node goes, as a reload would take it.
    editor->document.apply("Remove", removeNodes(editor->document.graph(), "", NodeIds{"ball"}, false));
    const std::string after = writeGraph(editor->document.graph());
    editor.during("");
    editor.during(to({title.x + 160, title.y + 20}));
    editor.send("mouseup 1");
    EXPECT_EQ(editor->canvas.gesture.kind, CanvasGesture::Kind::none);
    EXPECT_EQ(writeGraph(editor->document.graph()), after);
    EXPECT_TRUE(editor->document.undo());
    EXPECT_TRUE(editor->document.graph().node("ball")) << "undo brings it back where it was dragged to";
    EXPECT_NE((*editor->document.graph().node("ball")->at)[1], 0.0);
}

TEST(Hands, ANumberThatIsCoveredIsTypedAllTheSame) {
    // The second ball lies over the first one's radius.
    DrivenEditor editor(test::parsed(R"({"fieldwright": 1, "nodes": [
        {"id": "ball", "type": "sphere", "at": [0, 0], "inputs": {"radius": 1}},
        {"id": "other", "type": "sphere", "at": [4, 20]}]})"));
    NEEDS_EDITOR(editor);
    editor->canvas.select({"ball"});
    editor.settle();
    editor.keys("Return");
    editor.type("2.5");
    editor.keys("Return");
    EXPECT_EQ(radius(editor), 2.5);
    EXPECT_FALSE(editor->document.held());
    // The canvas hears again.
    editor.keys("ctrl+z");
    EXPECT_EQ(radius(editor), 1.0);
    // What is not seen any more ends by itself, with what was typed.
    editor.keys("Return");
    editor.type("4");
    editor->canvas.view.zoom = kLeastZoom;
    editor.settle();
    EXPECT_FALSE(editor->document.held());
    EXPECT_EQ(radius(editor), 4.0);
}

TEST(Hands, ModifiersMeanTheSameOnTheCanvasAndInThePanels) {
    constexpr const char* kGraph = R"({"fieldwright": 1, "nodes": [
        {"id": "ball", "type": "sphere", "at": [0, 0], "inputs": {"radius": 1}}]})";
    DrivenEditor editor(test::parsed(kGraph));
    NEEDS_EDITOR(editor);
    // As a parameter it is in a second panel, where a drag of a pixel counts another step.
    const auto travelled = [&](ImVec2 from, const char* modifier) {
        const double before = radius(editor);
        const std::string down = modifier[0] ? std::string("keydown ") + modifier : "",
                          up = modifier[0] ? std::string(" keyup ") + modifier : "";
        editor.during(to(from) + " " + down + " mousedown 1");
        for (const float by : {20.0f, 40.0f, 60.0f}) editor.during(to({from.x + by, from.y}));
        editor.send("mouseup 1" + up);
        const double by = radius(editor) - before;
        EXPECT_TRUE(editor->document.undo());
        editor.settle();
        return by;
    };
    const ImVec2 onCanvas = editor.field("ball", "radius", 0);
    const double plain = travelled(onCanvas, "");
    EXPECT_GT(plain, 0.0);
    EXPECT_NEAR(travelled(onCanvas, "shift"), 0.1 * plain, 0.02 * plain);
    EXPECT_NEAR(travelled(onCanvas, "alt"), 10.0 * plain, 0.2 * plain);

    editor->document.apply("Expose", exposeInput(editor->document.graph(), {"ball", "radius"}));
    editor->panels.wanted = "parameters";
    editor.settle();
    // Where the mouse says that it would drag something.
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImVec2 inPanel(size.x * (1.0f - 0.5f * editor->panels.side), 0.0f);
    for (float y = editor->panels.top * size.y + 40.0f; y < size.y - 20.0f && inPanel.y == 0.0f; y += 6.0f) {
        editor.moveTo({inPanel.x, y});
        if (ImGui::GetMouseCursor() == ImGuiMouseCursor_ResizeEW) inPanel.y = y + 6.0f;
    }
    ASSERT_GT(inPanel.y, 0.0f) << "the parameter's value is seen";
    const double there = travelled(inPanel, "");
    EXPECT_GT(there, 0.0);
    EXPECT_NEAR(travelled(inPanel, "shift"), 0.1 * there, 0.02 * there);
    EXPECT_NEAR(travelled(inPanel, "alt"), 10.0 * there, 0.2 * there);
}

TEST(Hands, TheWayOutOfAGroupIsAClick) {
    DrivenEditor editor(*readGraph(FIELDWRIGHT_SOURCE_DIR "/samples/table_and_stool.field.json", nullptr));
    NEEDS_EDITOR(editor);
    const std::string group = editor->document.graph().groups.at(0).id;
    for (int times = 0; times < 5; ++times) {
        enter(*editor, group);
        editor.settle();
        ASSERT_EQ(editor->boxes->scope, group);
        const ImVec2 canvas = editor->canvas.view.panel.lo;
        editor.click({canvas.x + 30.0f, canvas.y - 12.0f});
        ASSERT_EQ(editor->canvas.scope, "") << "the word Document, above the canvas";
        EXPECT_EQ(editor->boxes->scope, "");
    }
}

TEST(Hands, TheMinimapDoesNotFlyAway) {
    DrivenEditor editor(test::parsed(kBlock));
    NEEDS_EDITOR(editor);
    const Area map = minimapArea(editor->canvas.view), shows = minimapShows(editor->canvas, *editor->boxes);
    editor.during(to(map.centre()) + " mousedown 1");
    for (int i = 0; i < 30; ++i) editor.during(to({map.hi.x - 1.0f - float(i % 2), map.hi.y - 1.0f}));
    editor.send("mouseup 1");
    EXPECT_LE(editor->canvas.view.middle.x, shows.hi.x + 1.0f);
    EXPECT_LE(editor->canvas.view.middle.y, shows.hi.y + 1.0f);
}

TEST(Hands, SeveralNodesAreShownTogether) {
    DrivenEditor editor(test::graphOf(R"({"id": "a", "type": "box", "at": [0, 0]},
        {"id": "b", "type": "sphere", "at": [0, 240]}, {"id": "n", "type": "time", "at": [0, 480]},
        {"id": "out", "type": "output", "at": [240, 0], "inputs": {"surface": {"from": "a"}, "resolution": 16}})"));
    NEEDS_EDITOR(editor);
    const std::string before = writeGraph(editor->document.graph());
    editor->canvas.select({"a", "b", "n", "out"});
    editor.settle();
    editor.keys("slash");
    EXPECT_EQ(editor->viewport.pinned, "a + b") << "what makes no surface is left out";
    EXPECT_EQ(marksOf(*editor).pinned, (std::set<std::string>{"a", "b"}));
    editor.keys("slash");
    EXPECT_EQ(editor->viewport.pinned, "");
    editor.keys("slash");
    EXPECT_EQ(writeGraph(editor->document.graph()), before);
    // A new id goes along, and what is removed is not shown.
    editor->canvas.select({"b"});
    editor.settle();
    editor.keys("F2 Tab ctrl+a");
    editor.type("ball");
    editor.keys("Return");
    EXPECT_EQ(editor->viewport.pinned, "a + ball");
    editor->document.apply("Remove", removeNodes(editor->document.graph(), "", NodeIds{"a"}, true));
    editor.settle();
    EXPECT_EQ(editor->viewport.pinned, "ball");
}

TEST(Hands, WhatIsShownFollowsItsNode) {
    DrivenEditor editor(test::parsed(kBall));
    NEEDS_EDITOR(editor);
    editor->viewport.pinned = "moved";
    editor->thumbnails.toggle(editor->shell, "moved");
    editor->canvas.select({"moved"});
    editor.settle();
    editor.keys("F2 Tab ctrl+a");  // from its label to its id
    editor.type("away");
    editor.keys("Return");
    ASSERT_TRUE(editor->document.graph().node("away"));
    EXPECT_EQ(editor->viewport.pinned, "away");
    EXPECT_TRUE(editor->thumbnails.shown.contains("away"));
    EXPECT_FALSE(editor->thumbnails.shown.contains("moved"));
    editor->document.apply("Remove", removeNodes(editor->document.graph(), "", NodeIds{"away"}, true));
    editor.settle();
    EXPECT_EQ(editor->viewport.pinned, "");
    EXPECT_TRUE(editor->thumbnails.shown.empty());
}

TEST(Hands, AQuestionAsideThatFailsIsSaid) {
    DrivenEditor editor(test::parsed(kBall));
    NEEDS_EDITOR(editor);
    editor->viewport.aside.ask([]() -> Aside::Answer { throw std::runtime_error("the moon is down"); });
    for (int i = 0; i < 500 && editor->notice != "the moon is down"; ++i)
        editor.settle(), fw::test::rest(0.01);
    EXPECT_EQ(editor->notice, "the moon is down");
}

TEST(Hands, AChangeOutsideIsNotSavedOver) {
    DrivenEditor editor;
    NEEDS_EDITOR(editor);
    const std::string path = editor.path("ball.field.json");
    writeText(path, kBall);
    openFile(*editor, path);
    editor.settle();
    editor->document.apply("Set", setNumber(editor->document.graph(), "", {"out", "resolution"}, 0, 32));
    writeText(path, kBlock);
    editor.keys("ctrl+s");  // at once: nothing has looked at the file since
    EXPECT_EQ(fw::test::readText(path), kBlock);
    EXPECT_TRUE(editor->files.outside);
    editor.keys("Escape");
    EXPECT_FALSE(editor->files.outside);
    EXPECT_EQ(fw::test::readText(path), kBlock) << "neither saved nor loaded";
    EXPECT_TRUE(editor->document.unsaved());
    editor.keys("ctrl+s");  // it is not decided yet
    EXPECT_TRUE(editor->files.outside);
    EXPECT_EQ(fw::test::readText(path), kBlock);
    EXPECT_TRUE(editor->document.unsaved());
}

TEST(Hands, TwoCopiesThatWereLeftAreBothRestored) {
    // As two editors leave them that were killed: copies without a lock.
    DrivenEditor editor;
    NEEDS_EDITOR(editor);
    const std::string folder = recoveryFolder();
    std::filesystem::create_directories(folder);
    writeText(folder + "/1-0.field.json", kBall);
    writeText(folder + "/2-0.field.json", kBlock);
    startFiles(*editor, {});
    editor.settle();
    ASSERT_EQ(editor->files.left.size(), 2u);
    ASSERT_TRUE(editor->files.offers);
    for (const LeftCopy& copy : std::vector(editor->files.left)) restore(*editor, copy);
    editor.settle();
    EXPECT_TRUE(editor->document.unsaved());
    const std::string last = writeGraph(editor->document.graph());
    ASSERT_EQ(editor->tabs.all.size(), 2u);
    turnTabs(*editor, 1);
    EXPECT_TRUE(editor->document.unsaved());
    std::set<std::string> both = {last, writeGraph(editor->document.graph())};
    const auto asRead = [](const char* text) { return writeGraph(placeAll(test::parsed(text))); };
    EXPECT_EQ(both, (std::set<std::string>{asRead(kBall), asRead(kBlock)}));
    // Of each there is a copy again, in place of the one that was left.
    EXPECT_TRUE(std::filesystem::exists(editor->files.recovery.path()));
    EXPECT_FALSE(std::filesystem::exists(folder + "/1-0.field.json"));
    EXPECT_FALSE(std::filesystem::exists(folder + "/2-0.field.json"));
}

TEST(Hands, AHundredStepsAreTakenBackAcrossScopes) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "a quarter of a minute: with FIELDWRIGHT_LONG";
    DrivenEditor editor(*readGraph(FIELDWRIGHT_SOURCE_DIR "/samples/table_and_stool.field.json", nullptr));
    NEEDS_EDITOR(editor);
    ASSERT_FALSE(editor->document.graph().groups.empty());
    const std::string group = editor->document.graph().groups[0].id;
    const std::string before = writeGraph(editor->document.graph());
    const auto press = [&](const std::string& keys) {
        for (int i = 0; i < 10; ++i) {
            std::string ten;
            for (int k = 0; k < 10; ++k) ten += keys + " ";
            // GLFW takes a second press within a millisecond for the first one, told twice.
            editor.send("key --delay 4 " + ten);
        }
    };
    for (int step = 0; step < 100; ++step) {
        // Now inside the group, now outside: what is added there is selected there.
        if (step % 10 == 0) enter(*editor, step % 20 == 0 ? group : "");
        const double x = 10.0 * step;
        apply(*editor, "Add",
              addNode(editor->document.graph(), editor->canvas.scope, step % 3 == 0 ? "box" : "sphere",
                      {x, 900}));
        if (step % 10 == 9) editor.settle();
    }
    const std::string after = writeGraph(editor->document.graph());
    EXPECT_EQ(editor->document.stepCount(), 101u);
    press("ctrl+z");
    EXPECT_EQ(editor->document.step(), 0u);
    EXPECT_EQ(writeGraph(editor->document.graph()), before);
    enter(*editor, group);
    press("ctrl+y");
    EXPECT_EQ(editor->document.step(), 100u);
    EXPECT_EQ(writeGraph(editor->document.graph()), after);
}

TEST(Hands, AListOfTheStepsLeadsToEach) {
    DrivenEditor editor;
    NEEDS_EDITOR(editor);
    for (const char* type : {"box", "torus", "cone"})
        apply(*editor, std::string("Add ") + type, addNode(editor->document.graph(), "", type, {0, 0}));
    editor.keys("ctrl+h");
    EXPECT_EQ(editor->panels.front, "history");
    editor.keys("Down space");  // the first is marked
    EXPECT_EQ(editor->document.step(), 1u);
    EXPECT_EQ(editor->document.graph().nodes.size(), 1u);
    editor.keys("ctrl+h");
    EXPECT_FALSE(editor->panels.history);
}

TEST(Hands, TheCameraFollowsThemAsOneIsUsedTo) {
    DrivenEditor editor(test::graphOf(R"({"id": "a", "type": "box", "at": [0, 0]},
        {"id": "out", "type": "output", "at": [240, 0], "inputs": {"surface": {"from": "a"}, "resolution": 16}})"));
    NEEDS_EDITOR(editor);
    editor.waitForPicture();
    Viewport& view = editor->viewport;
    const auto drag = [&](int button, const std::string& held) {
        view.ownCamera = false;
        const ImVec2 at(view.place.lo.x + 60, view.place.lo.y + 60);
        const auto place = [](float x, float y) {
            return "mousemove " + std::to_string(int(x)) + " " + std::to_string(int(y)) + " ";
        };
        const std::string down = held.empty() ? "" : "keydown " + held + " ",
                          up = held.empty() ? "" : "keyup " + held;
        editor.send(place(at.x, at.y) + down + "mousedown " + std::to_string(button) + " " +
                    place(at.x + 20, at.y + 10) + place(at.x + 40, at.y + 20) + "mouseup " +
                    std::to_string(button) + " " + up);
        if (!view.ownCamera) return std::string("nothing");
        const Camera before = view.shown.seen, after = view.orbit.camera();
        const auto away = [](const Camera& camera) {
            double sum = 0.0;
            for (std::size_t i = 0; i < 3; ++i) sum += std::pow(camera.position[i] - camera.target[i], 2);
            return std::sqrt(sum);
        };
        if (std::abs(away(after) - away(before)) > 1e-3 * away(before)) return std::string("zoom");
        double moved = 0.0;
        for (std::size_t i = 0; i < 3; ++i) moved += std::abs(after.target[i] - before.target[i]);
        return std::string(moved > 1e-6 ? "pan" : "orbit");
    };
    EXPECT_EQ(drag(1, ""), "orbit");
    EXPECT_EQ(drag(1, "shift"), "pan");
    EXPECT_EQ(drag(2, ""), "orbit");
    EXPECT_EQ(drag(3, ""), "pan");
    view.navigation = Navigation::blender;
    EXPECT_EQ(drag(1, ""), "nothing");
    EXPECT_EQ(drag(2, ""), "orbit");
    EXPECT_EQ(drag(2, "shift"), "pan");
    EXPECT_EQ(drag(2, "ctrl"), "zoom");
    view.navigation = Navigation::maya;
    EXPECT_EQ(drag(1, ""), "nothing");
    EXPECT_EQ(drag(1, "alt"), "orbit");
    EXPECT_EQ(drag(2, "alt"), "pan");
    EXPECT_EQ(drag(3, "alt"), "zoom");
    EXPECT_EQ(drag(2, ""), "nothing");

    const auto scroll = [&](int button, const std::string& held) {
        view.ownCamera = false;
        const ImVec2 at = view.place.centre();
        const std::string down = held.empty() ? "" : "keydown " + held + " ",
                          up = held.empty() ? "" : " keyup " + held;
        editor.send("mousemove " + std::to_string(int(at.x)) + " " + std::to_string(int(at.y)) + " " + down +
                    "click " + std::to_string(button) + up);
        const Orbit before = Orbit::from(view.shown.seen), after = view.orbit;
        if (!view.ownCamera) return std::string("nothing");
        if (std::abs(after.distance - before.distance) > 1e-3 * before.distance) return std::string("zoom");
        if (std::abs(after.azimuth - before.azimuth) > 1e-6) return std::string("orbit across");
        if (std::abs(after.elevation - before.elevation) > 1e-6) return std::string("orbit up");
        return std::string("pan");
    };
    constexpr int kUp = 4, kDown = 5, kAcross = 6;  // as X numbers what the wheel does
    EXPECT_EQ(scroll(kUp, ""), "zoom");
    EXPECT_EQ(scroll(kAcross, ""), "nothing");
    view.scrolling = Scrolling::orbits;
    EXPECT_EQ(scroll(kAcross, ""), "orbit across");
    EXPECT_EQ(scroll(kDown, ""), "orbit up");
    EXPECT_EQ(scroll(kDown, "shift"), "pan");
    EXPECT_EQ(scroll(kDown, "ctrl"), "zoom");
    view.scrolling = Scrolling::pans;
    EXPECT_EQ(scroll(kAcross, ""), "pan");
    EXPECT_EQ(scroll(kUp, "shift"), "orbit up");
}

}  // namespace fw::editor::hands_test
