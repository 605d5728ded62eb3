// The shortcuts of the table of commands, pressed in the real window: each has a case here that sees what it
// did, in the saved file, on the clipboard or on the screen. Of each command the first, all with
// FIELDWRIGHT_LONG.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "editor/commands.h"
#include "editor/document/frames.h"
#include "graph/document/named_parameters.h"
#include "graph/document/scene.h"
#include "graph/document/timeline.h"
#include "tests/editor/program.h"

namespace fw::editor::test::end_to_end_shortcuts_test {

using fw::test::readText;
using fw::test::writeText;

constexpr const char* kDocument = R"({"fieldwright": 1, "nodes": [
    {"id": "box", "type": "box", "at": [0, 0]},
    {"id": "ball", "type": "sphere", "at": [0, 200]},
    {"id": "cut", "type": "subtract", "at": [260, 0], "inputs": {"a": {"from": "box"}, "b": {"from": "ball"}}},
    {"id": "out", "type": "output", "at": [520, 0], "inputs": {"surface": {"from": "cut"}, "resolution": 16}}]})";

/// The same with something that moves, for the keys of the timeline.
constexpr const char* kMoving = R"({"fieldwright": 1, "nodes": [
    {"id": "ball", "type": "sphere", "at": [0, 0]},
    {"id": "out", "type": "output", "at": [260, 0], "inputs": {"surface": {"from": "ball"}, "resolution": 16}}],
  "timeline": {"length": 3, "fps": 30,
    "tracks": [{"node": "ball", "input": "radius", "keys": [
      {"time": 0, "value": 1}, {"time": 1, "value": 2}, {"time": 2, "value": 1}]}],
    "markers": [{"time": 0.5, "name": "one"}, {"time": 1.5, "name": "two"}]}})";

/// The timeline with the keyboard, at its beginning; with all keys selected, or none.
void openTimeline(Program& program, bool all) {
    program.keys("Ctrl+T");
    const Area name = program.waitFor("ball · radius");
    program.click({16, program.waitFor("fps").centre().y});  // the first button
    program.click({300, name.centre().y});
    program.waitFor("Double click in a row to add a key.");
    if (!all) return;
    program.keys("Ctrl+A");
    program.waitFor("3 keys");
}

Timeline timelineAfter(Program& program) {
    const Result<Timeline> timeline = readTimeline(program.saved());
    return timeline ? *timeline : Timeline{};
}

/// Presses the keys on the timeline and says which times its keys have, in frames.
std::vector<int> framesAfter(Program& program, const std::vector<std::string>& presses) {
    openTimeline(program, true);
    for (const std::string& keys : presses) program.keys(keys);
    const Timeline timeline = timelineAfter(program);
    program.keys("Ctrl+T");
    std::vector<int> frames;
    for (const Track& track : timeline.tracks)
        for (const Key& key : track.keys) frames.push_back(int(std::lround(key.time * 30.0)));
    return frames;
}

/// Presses the keys on the timeline and says where a marker is added then, in frames.
int markedAfter(Program& program, const std::vector<std::string>& presses) {
    openTimeline(program, false);
    for (const std::string& keys : presses) program.keys(keys);
    program.keys("M");
    const Timeline timeline = timelineAfter(program);
    program.keys("Ctrl+T");
    return timeline.markers.size() == 3 ? int(std::lround(timeline.markers[2].time * 30.0)) : -1;
}

/// What the timeline's first line says after the keys.
void readTime(Program& program, const std::vector<std::string>& presses, const std::string& words) {
    openTimeline(program, false);
    for (const std::string& keys : presses) program.keys(keys);
    const Area line = program.waitFor("fps");
    program.waitFor(words, Area{{0, line.lo.y - 8}, {line.lo.x, line.hi.y + 8}});
    program.keys("Ctrl+T");
}

void pick(Program& program, const std::vector<std::string>& nodes) {
    for (const std::string& node : nodes)
        program.click(program.title(node), 1, node == nodes[0] ? "" : "shift");
}

std::set<std::string> nodesAfter(Program& program) {
    std::set<std::string> ids;
    for (const Node& node : program.saved().nodes) ids.insert(node.id);
    return ids;
}

const Node& nodeAfter(Program& program, const std::string& id) {
    const Node* node = findNode(program.saved().nodes, id);
    if (!node) throw std::runtime_error("no node " + id);
    return *node;
}

std::string source(const Node& node, const std::string& input) {
    const InputValue* value = node.input(input);
    const Link* link = value ? std::get_if<Link>(&value->value) : nullptr;
    return link ? link->node : "";
}

using Ids = std::set<std::string>;

/// What is left when all that is selected is deleted.
void expectSelected(Program& program, const Ids& selected) {
    program.keys("Delete");
    Ids left = {"box", "ball", "cut", "out"};
    for (const std::string& id : selected) left.erase(id);
    EXPECT_EQ(nodesAfter(program), left);
}

/// From one node to another; both are selected, or the other alone.
void step(Program& program, const std::string& from, const std::string& keys, const Ids& selected) {
    pick(program, {from});
    program.keys(keys);
    expectSelected(program, selected);
}

/// The node moves this way, and no other way.
void nudge(Program& program, const std::string& keys, int x, int y) {
    const Position before = *nodeAfter(program, "ball").at;
    pick(program, {"ball"});
    program.keys(keys);
    const Position after = *nodeAfter(program, "ball").at;
    const auto sign = [](double by) { return (by > 0) - (by < 0); };
    EXPECT_EQ(sign(after[0] - before[0]), x);
    EXPECT_EQ(sign(after[1] - before[1]), y);
}

Area picturePart(const Program& program) { return {{program.view.panel.hi.x + 20, 120}, {1260, 400}}; }
Area pictureCorner(const Program& program) { return {{program.view.panel.hi.x + 20, 380}, {1280, 470}}; }

/// The picture of the solid, once it has come to rest.
Picture restingPicture(Program& program) {
    Picture seen = program.screen(picturePart(program));
    EXPECT_TRUE(eventually([&] {
        fw::test::rest(0.3);
        Picture now = program.screen(picturePart(program));
        const bool rests = now.pixels == seen.pixels && !program.sees("working", Area{{0, 770}, {1280, 800}});
        seen = std::move(now);
        return rests;
    }));
    return seen;
}

/// What to do, with these keys, in a window with the document and nothing selected, and what to see.
using Case = std::function<void(Program&, const std::string& keys)>;

/// The words in the picture's corner.
void waitForLook(Program& program, const std::string& words) {
    program.waitFor(words, pictureCorner(program));
}

/// The mouse over the picture, once there is one, and it is looked at as after these keys.
void lookFirst(Program& program, const std::string& keys, const std::string& words) {
    program.moveTo(picturePart(program).centre());
    EXPECT_TRUE(eventually([&] {
        program.keys(keys);
        return program.sees(words, pictureCorner(program));
    })) << words;
}

/// A view without light, which a processor draws soon: what is looked at is not how it is lit.
void showNormals(Program& program) {
    lookFirst(program, "1", "Front · perspective");
    program.keys("Z", 2);
    program.waitFor("Normals");
    program.keys("0");
    waitForLook(program, "Whole solid");
}

/// From one side, which the picture says, to another, which it says then.
Case lookFrom(const std::string& first, const std::string& firstWords, const std::string& words) {
    return [=](Program& program, const std::string& keys) {
        lookFirst(program, first, firstWords);
        program.keys(keys);
        waitForLook(program, words);
        program.keys("0");
        waitForLook(program, "Whole solid");
        program.moveTo(program.nowhere());
    };
}

/// The camera that is seen by, as it is saved when it becomes the scene's.
Camera cameraSeen(Program& program) {
    program.keys("Ctrl+Alt+0");
    const Result<Scene> scene = readScene(program.saved().scene);
    if (!scene || !scene->camera) throw std::runtime_error("the scene has no camera");
    return *scene->camera;
}

/// What becomes of the camera in front of the solid: where it is by its target then, and where its target is
/// by what it was.
struct Looked {
    double right, up, back;           ///< of the eye, in distances
    double panRight, panUp, panBack;  ///< of the target
};

Looked lookAfter(Program& program, const std::string& keys) {
    lookFirst(program, "1", "Front · perspective");
    const Camera before = cameraSeen(program);
    program.keys(keys);
    const Camera after = cameraSeen(program);
    program.keys("Ctrl+Z", 2);
    program.keys("0");
    program.moveTo(program.nowhere());
    const double distance = before.position[2] - before.target[2];
    const auto& [x, y, z] = after.target;
    return {(after.position[0] - x) / distance, (after.position[1] - y) / distance,
            (after.position[2] - z) / distance, (x - before.target[0]) / distance,
            (y - before.target[1]) / distance,  (z - before.target[2]) / distance};
}

/// Turned by a tenth of a height, about the target.
Case turned(double right, double up) {
    return [=](Program& program, const std::string& keys) {
        const Looked looked = lookAfter(program, keys);
        EXPECT_NEAR(looked.right, right * std::sin(0.3), 1e-3);
        EXPECT_NEAR(looked.up, up * std::sin(0.3), 1e-3);
        EXPECT_NEAR(looked.back, std::cos(0.3), 1e-3);
        EXPECT_NEAR(std::hypot(looked.panRight, looked.panUp, looked.panBack), 0.0, 1e-6);
    };
}

/// The solid goes this way in the picture, the camera the other.
Case panned(int right, int up) {
    return [=](Program& program, const std::string& keys) {
        const Looked looked = lookAfter(program, keys);
        const auto sign = [](double by) { return (by > 1e-3) - (by < -1e-3); };
        EXPECT_EQ(sign(looked.panRight), -right);
        EXPECT_EQ(sign(looked.panUp), -up);
        EXPECT_NEAR(looked.panBack, 0.0, 1e-6);
        EXPECT_NEAR(looked.back, 1.0, 1e-6);
    };
}

Case zoomed(double distance) {
    return [=](Program& program, const std::string& keys) {
        const Looked looked = lookAfter(program, keys);
        EXPECT_NEAR(looked.back, distance, 1e-3);
        EXPECT_NEAR(std::hypot(looked.panRight, looked.panUp, looked.panBack), 0.0, 1e-6);
    };
}

/// Which of the buttons over the picture is lit: unlike the two others, which are alike; "": none.
std::string toolInUse(Program& program) {
    constexpr const char* kTools[] = {"Move", "Rotate", "Scale"};
    const float left = program.view.panel.hi.x;
    const Picture seen = program.screen();
    std::array<uint8_t, 3> colors[3];
    for (std::size_t i = 0; i < 3; ++i) {
        const Area word = program.waitFor(kTools[i], Area{{left, 300}, {left + 100, 470}});
        const auto beside =
            4 * (std::size_t(word.centre().y) * std::size_t(seen.width) + std::size_t(word.lo.x) - 5);
        std::copy_n(&seen.pixels[beside], 3, colors[i].begin());
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const auto &one = colors[(i + 1) % 3], &other = colors[(i + 2) % 3];
        if (one == other && colors[i] != one) return kTools[i];
    }
    return "";
}

/// Another tool is taken up, for the node that is selected.
Case takeUp(const std::string& first, const std::string& firstTool, const std::string& tool) {
    return [=](Program& program, const std::string& keys) {
        pick(program, {"box"});
        program.moveTo(picturePart(program).centre());
        EXPECT_TRUE(eventually([&] {  // once the mouse is known to be over the picture
            program.keys(first);
            return toolInUse(program) == firstTool;
        }));
        program.keys(keys);
        EXPECT_TRUE(eventually([&] { return toolInUse(program) == tool; })) << tool;
        program.moveTo(program.nowhere());
    };
}

/// The tool that measures says what it waits for, until the same keys put it down.
void takeUpMeasure(Program& program, const std::string& keys, const std::string& hint) {
    lookFirst(program, "1", "Front · perspective");
    program.keys(keys);
    program.waitFor(hint);
    program.keys(keys);
    program.waitUntilGone(hint);
}

/// The canvas looks from so much nearer.
void zoomBy(Program& program, const std::string& keys, float by) {
    program.save();
    program.keys(keys);
    program.view.zoomTo(program.view.zoom * by, program.view.panel.centre());
    pick(program, {"ball"});
    expectSelected(program, {"ball"});
}

/// Whether this part of the screen changes by itself.
bool moves(Program& program, const Area& part) {
    const Picture before = program.screen(part);
    fw::test::rest(0.3);
    return program.screen(part).pixels != before.pixels;
}

/// Another side panel is in front.
void turnPanel(Program& program, const std::string& keys) {
    program.save();
    const Picture before = program.screen();
    program.keys(keys);
    program.waitForChange(before, {{program.view.panel.hi.x + 20, 500}, {1260, 700}});
}

/// The keyboard steers the picture, wherever the mouse is.
void toPicture(Program& program, const std::string& keys) {
    const Picture before = restingPicture(program);
    program.keys(keys);
    program.keys("7");
    EXPECT_TRUE(eventually([&] { return program.screen(picturePart(program)).pixels != before.pixels; }));
    program.keys("0");
    program.keys("Alt+1");
}

/// The keyboard steers the panel: arrows take no step on the canvas.
void toPanel(Program& program, const std::string& keys) {
    pick(program, {"box"});
    program.keys(keys);
    program.keys("Right");
    program.keys("Alt+1");
    expectSelected(program, {"box"});
}

/// From a new document back to the one that there was.
void fromNewDocument(Program& program, const std::string& keys) {
    const std::string title = program.title();
    program.keys("Ctrl+N");
    EXPECT_TRUE(eventually([&] { return program.title().starts_with("untitled"); }));
    program.keys(keys);
    EXPECT_TRUE(eventually([&] { return program.title() == title; }));
}

const std::map<std::string, Case>& cases() {
    static const std::map<std::string, Case> all = {
        {"file.new",
         [](Program& p, const std::string& keys) {
             p.keys(keys);
             EXPECT_TRUE(eventually([&] { return p.title().starts_with("untitled"); }));
         }},
        {"file.next_document",
         [](Program& p, const std::string& keys) {
             fromNewDocument(p, keys);
             p.keys("Ctrl+W");
             EXPECT_TRUE(eventually([&] { return p.title().starts_with("untitled"); }));
         }},
        {"file.last_document", fromNewDocument},
        {"file.close",
         [](Program& p, const std::string& keys) {
             pick(p, {"box"});
             p.keys("Delete");
             p.keys(keys);
             p.waitFor("Discard");
             p.keys("Escape");
             p.waitUntilGone("Discard");
             p.keys("Ctrl+Z");
             p.save();
             p.keys(keys);
             EXPECT_TRUE(eventually([&] { return p.title().starts_with("untitled"); }));
         }},
        {"file.open",
         [](Program& p, const std::string& keys) {
             writeText(p.path("other.field.json"), R"({"fieldwright": 1, "nodes": []})");
             p.keys(keys);
             p.keys("Ctrl+A");
             p.type("other.field.json\n");
             p.waitForTitle("other.field.json - Fieldwright");
         }},
        {"file.save",
         [](Program& p, const std::string& keys) {
             const std::string before = p.save();
             pick(p, {"box"});
             p.keys("Delete");
             p.keys(keys);
             EXPECT_TRUE(eventually([&] { return readText(p.file()) != before; }));
         }},
        {"file.save_as",
         [](Program& p, const std::string& keys) {
             const std::string before = p.save();
             p.keys(keys);
             p.keys("Ctrl+A");
             p.type("copy\n");
             p.waitForTitle("copy.field.json - Fieldwright");
             EXPECT_EQ(readText(p.path("copy.field.json")), before);
         }},
        {"file.export",
         [](Program& p, const std::string& keys) {
             p.keys(keys);
             p.waitFor("Close");
         }},
        {"file.render",
         [](Program& p, const std::string& keys) {
             p.keys(keys);
             p.waitFor("Samples");
         }},
        {"edit.undo",
         [](Program& p, const std::string& keys) {
             pick(p, {"box"});
             p.keys("Delete");
             p.keys(keys);
             EXPECT_EQ(nodesAfter(p), (Ids{"box", "ball", "cut", "out"}));
         }},
        {"edit.redo",
         [](Program& p, const std::string& keys) {
             pick(p, {"box"});
             p.keys("Delete");
             p.keys("Ctrl+Z");
             p.keys(keys);
             EXPECT_EQ(nodesAfter(p), (Ids{"ball", "cut", "out"}));
         }},
        {"edit.cut",
         [](Program& p, const std::string& keys) {
             pick(p, {"ball"});
             p.keys(keys);
             EXPECT_EQ(nodesAfter(p), (Ids{"box", "cut", "out"}));
             EXPECT_NE(p.clipboard().find("\"sphere\""), std::string::npos) << p.clipboard();
         }},
        {"edit.copy",
         [](Program& p, const std::string& keys) {
             p.clipboard("something else");
             pick(p, {"ball"});
             p.keys(keys);
             EXPECT_TRUE(eventually([&] { return p.clipboard().find("\"sphere\"") != std::string::npos; }));
             EXPECT_EQ(nodesAfter(p).size(), 4u);
         }},
        {"edit.paste",
         [](Program& p, const std::string& keys) {
             p.clipboard(R"({"nodes": [{"id": "ring", "type": "torus"}]})");
             p.moveTo(p.nowhere());
             p.keys(keys);
             EXPECT_TRUE(nodesAfter(p).contains("ring"));
         }},
        {"edit.duplicate",
         [](Program& p, const std::string& keys) {
             pick(p, {"cut"});
             p.keys(keys);
             ASSERT_TRUE(nodesAfter(p).contains("cut_2"));
             EXPECT_EQ(source(nodeAfter(p, "cut_2"), "a"), "");
         }},
        {"edit.duplicate_wired",
         [](Program& p, const std::string& keys) {
             pick(p, {"cut"});
             p.keys(keys);
             ASSERT_TRUE(nodesAfter(p).contains("cut_2"));
             EXPECT_EQ(source(nodeAfter(p, "cut_2"), "a"), "box");
         }},
        {"edit.delete",
         [](Program& p, const std::string& keys) {
             pick(p, {"cut"});
             p.keys(keys);
             EXPECT_EQ(nodesAfter(p), (Ids{"box", "ball", "out"}));
             EXPECT_EQ(source(nodeAfter(p, "out"), "surface"), "");
         }},
        {"edit.delete_heal",
         [](Program& p, const std::string& keys) {
             pick(p, {"cut"});
             p.keys(keys);
             EXPECT_EQ(nodesAfter(p), (Ids{"box", "ball", "out"}));
             EXPECT_EQ(source(nodeAfter(p, "out"), "surface"), "box");
         }},
        {"edit.select_all",
         [](Program& p, const std::string& keys) {
             p.keys(keys);
             expectSelected(p, {"box", "ball", "cut", "out"});
         }},
        {"edit.invert",
         [](Program& p, const std::string& keys) {
             pick(p, {"ball"});
             p.keys(keys);
             expectSelected(p, {"box", "cut", "out"});
         }},
        {"edit.upstream",
         [](Program& p, const std::string& keys) {
             pick(p, {"cut"});
             p.keys(keys);
             expectSelected(p, {"box", "ball", "cut"});
         }},
        {"edit.downstream",
         [](Program& p, const std::string& keys) {
             pick(p, {"box"});
             p.keys(keys);
             expectSelected(p, {"box", "cut", "out"});
         }},
        {"node.add",
         [](Program& p, const std::string& keys) {
             p.moveTo(p.nowhere());
             p.keys(keys);
             p.type("torus\n");
             EXPECT_TRUE(nodesAfter(p).contains("torus"));
         }},
        {"node.code",
         [](Program& p, const std::string& keys) {
             p.add("expression", p.nowhere());
             p.keys(keys);
             p.waitFor("Code of Expression");
             p.keys("Escape");
             p.waitUntilGone("Code of Expression");
             p.keys("Escape");  // out of the field that it went back to
         }},
        {"node.mute",
         [](Program& p, const std::string& keys) {
             pick(p, {"ball"});
             p.keys(keys);
             EXPECT_TRUE(nodeAfter(p, "ball").muted);
         }},
        {"node.collapse",
         [](Program& p, const std::string& keys) {
             pick(p, {"ball"});
             p.keys(keys);
             EXPECT_TRUE(nodeAfter(p, "ball").collapsed);
         }},
        {"node.thumbnail",
         [](Program& p, const std::string& keys) {
             const Area place = p.view.toScreen(thumbnailArea(*Boxes(p.graph(), "").find("box")));
             pick(p, {"box"});
             p.save();
             const Picture before = p.screen();
             p.keys(keys);
             p.waitForChange(before, place);
             p.keys(keys);
         }},
        {"node.swap",
         [](Program& p, const std::string& keys) {
             pick(p, {"cut"});
             p.keys(keys);
             EXPECT_EQ(source(nodeAfter(p, "cut"), "a"), "ball");
         }},
        {"node.group",
         [](Program& p, const std::string& keys) {
             pick(p, {"box", "ball"});
             p.keys(keys);
             EXPECT_EQ(p.saved().groups.size(), 1u);
             EXPECT_EQ(nodesAfter(p).size(), 3u);
         }},
        {"node.ungroup",
         [](Program& p, const std::string& keys) {
             pick(p, {"box", "ball"});
             p.keys("Ctrl+G");
             EXPECT_EQ(p.saved().groups.size(), 1u);
             p.keys(keys);
             EXPECT_EQ(p.saved().groups.size(), 0u);
             EXPECT_EQ(nodesAfter(p), (Ids{"box", "ball", "cut", "out"}));
         }},
        {"node.enter",
         [](Program& p, const std::string& keys) {
             pick(p, {"box", "ball"});
             p.keys("Ctrl+G");
             p.keys(keys);
             p.waitFor("Document");
             p.keys(keys);
             p.waitUntilGone("Document");
         }},
        {"node.frame",
         [](Program& p, const std::string& keys) {
             pick(p, {"box", "ball"});
             p.keys(keys);
             EXPECT_EQ(framesOf(p.saved()).size(), 1u);
         }},
        {"node.layout",
         [](Program& p, const std::string& keys) {
             const std::string before = p.save();
             p.keys(keys);
             EXPECT_NE(p.save(), before);
             EXPECT_EQ(nodesAfter(p).size(), 4u);
         }},
        {"view.frame",
         [](Program& p, const std::string& keys) {
             pick(p, {"ball"});
             p.keys(keys);
             const ImVec2 before = p.title("box");
             p.view.frame(Boxes(p.graph(), "").find("ball")->area);
             EXPECT_GT(std::abs(p.title("box").x - before.x), 50);
             pick(p, {"box"});
             expectSelected(p, {"box"});
         }},
        {"view.frame_all",
         [](Program& p, const std::string& keys) {
             p.zoom(-4);
             p.pan({150, 80});
             const ImVec2 before = p.title("box");
             p.keys(keys);
             p.view.frame(Boxes(p.graph(), "").around());
             EXPECT_GT(std::abs(p.title("box").x - before.x), 50);
             pick(p, {"box"});
             expectSelected(p, {"box"});
         }},
        {"view.pin",
         [](Program& p, const std::string& keys) {
             // The node shown has a dot near the right end of its title.
             const NodeBox box = *Boxes(p.graph(), "").find("ball");
             const ImVec2 dot = p.view.toScreen({box.area.hi.x - 30, box.area.lo.y + 0.5f * kTitleHeight});
             const Area place = Area{dot, dot}.grown(3);
             pick(p, {"ball"});
             p.save();
             const Picture before = p.screen();
             p.keys(keys);
             p.waitForChange(before, place);
             p.keys(keys);
         }},
        {"view.history",
         [](Program& p, const std::string& keys) {
             pick(p, {"ball"});
             p.keys("Delete");
             p.keys(keys);
             p.clickOn("As it was opened");
             EXPECT_EQ(nodesAfter(p), (Ids{"box", "ball", "cut", "out"}));
             p.keys(keys, 2);  // the click gave it the keyboard
         }},
        {"view.timeline",
         [](Program& p, const std::string& keys) {
             const Picture before = p.screen();
             p.keys(keys);
             p.waitForChange(before,
                             {{p.view.panel.lo.x, p.view.panel.hi.y - 100}, {600, p.view.panel.hi.y}});
             p.keys(keys);
         }},
        {"timeline.cut",
         [](Program& p, const std::string& keys) {
             EXPECT_EQ(framesAfter(p, {keys}), std::vector<int>());
             EXPECT_NE(p.clipboard().find("keys_of"), std::string::npos);
         }},
        {"timeline.copy",
         [](Program& p, const std::string& keys) {
             p.clipboard("nothing");
             EXPECT_EQ(framesAfter(p, {keys}), (std::vector{0, 30, 60}));
             EXPECT_NE(p.clipboard().find("keys_of"), std::string::npos);
         }},
        {"timeline.paste",
         [](Program& p, const std::string& keys) {
             EXPECT_EQ(framesAfter(p, {"Ctrl+C", "Up", keys}), (std::vector{0, 30, 60, 90}));
         }},
        {"timeline.duplicate",
         [](Program& p, const std::string& keys) {
             EXPECT_EQ(framesAfter(p, {keys}), (std::vector{0, 30, 60, 61, 91, 121}));
         }},
        {"timeline.delete",
         [](Program& p, const std::string& keys) { EXPECT_EQ(framesAfter(p, {keys}), std::vector<int>()); }},
        {"timeline.select_all",
         [](Program& p, const std::string& keys) {
             openTimeline(p, false);
             p.keys(keys);
             p.waitFor("3 keys");
             p.keys("Ctrl+T");
         }},
        {"timeline.invert",
         [](Program& p, const std::string& keys) {
             openTimeline(p, true);
             p.keys(keys);
             p.waitUntilGone("3 keys");
             p.keys(keys);
             p.waitFor("3 keys");
             p.keys("Ctrl+T");
         }},
        {"timeline.earlier",
         [](Program& p, const std::string& keys) {
             EXPECT_EQ(framesAfter(p, {"Shift+Right", keys}), (std::vector{9, 39, 69}));
         }},
        {"timeline.later",
         [](Program& p, const std::string& keys) {
             EXPECT_EQ(framesAfter(p, {keys}), (std::vector{1, 31, 61}));
         }},
        {"timeline.much_earlier",
         [](Program& p, const std::string& keys) {
             EXPECT_EQ(framesAfter(p, {"Shift+Right", "Right", keys}), (std::vector{1, 31, 61}));
         }},
        {"timeline.much_later",
         [](Program& p, const std::string& keys) {
             EXPECT_EQ(framesAfter(p, {keys}), (std::vector{10, 40, 70}));
         }},
        {"timeline.next_key",
         [](Program& p, const std::string& keys) { EXPECT_EQ(markedAfter(p, {keys}), 30); }},
        {"timeline.previous_key",
         [](Program& p, const std::string& keys) { EXPECT_EQ(markedAfter(p, {"Up", "Up", keys}), 30); }},
        {"timeline.marker",
         [](Program& p, const std::string& keys) {
             openTimeline(p, false);
             p.keys(keys);
             EXPECT_EQ(timelineAfter(p).markers.size(), 3u);
             p.keys(keys);  // on a marker it asks for its name
             p.type("start\n");
             EXPECT_EQ(timelineAfter(p).markers.back().name, "start");
             p.keys("Ctrl+T");
         }},
        {"timeline.next_marker",
         [](Program& p, const std::string& keys) { readTime(p, {keys, keys}, "1 s 15 f"); }},
        {"timeline.previous_marker",
         [](Program& p, const std::string& keys) { readTime(p, {"Up", "Up", keys, keys}, "15 f"); }},
        {"timeline.selection",
         [](Program& p, const std::string& keys) {
             openTimeline(p, true);
             p.waitFor("3 s");
             p.keys(keys);
             p.waitUntilGone("3 s");
             p.keys("Home");
             p.waitFor("3 s");
             p.keys("Ctrl+T");
         }},
        {"timeline.all",
         [](Program& p, const std::string& keys) {
             openTimeline(p, true);
             p.keys("F");
             p.waitUntilGone("3 s");
             p.keys(keys);
             p.waitFor("3 s");
             p.keys("Ctrl+T");
         }},
        {"timeline.curves",
         [](Program& p, const std::string& keys) {
             openTimeline(p, false);
             p.keys(keys);
             p.waitFor("Keys");
             p.keys(keys);
             p.waitFor("Curves");
             p.keys("Ctrl+T");
         }},
        {"edit.preferences",
         [](Program& p, const std::string& keys) {
             p.keys(keys);
             p.waitFor("Interface scale");
             p.keys("Escape");
             p.waitUntilGone("Interface scale");
         }},
        {"node.connect",
         [](Program& p, const std::string& keys) {
             pick(p, {"cut"});
             p.keys("Delete");
             pick(p, {"ball"});
             p.keys(keys);
             p.type("output\n");
             EXPECT_EQ(source(nodeAfter(p, "out"), "surface"), "ball");
         }},
        {"node.edit",
         [](Program& p, const std::string& keys) {
             pick(p, {"ball"});
             p.keys(keys);
             p.type("1/4\n");
             EXPECT_EQ(inputNumbers(nodeAfter(p, "ball"), "radius"), std::vector{0.25});
         }},
        {"node.rename",
         [](Program& p, const std::string& keys) {
             pick(p, {"ball"});
             p.keys(keys);
             p.type("Globe\n");
             EXPECT_EQ(nodeAfter(p, "ball").label, "Globe");
         }},
        {"view.zoom_in", [](Program& p, const std::string& keys) { zoomBy(p, keys, 1.25f); }},
        {"view.zoom_out", [](Program& p, const std::string& keys) { zoomBy(p, keys, 0.8f); }},
        {"view.play",
         [](Program& p, const std::string& keys) {
             p.keys("Ctrl+T");
             const Area bar = {{p.view.panel.lo.x, p.view.panel.hi.y - 100}, {600, p.view.panel.hi.y}};
             p.save();
             EXPECT_FALSE(moves(p, bar));
             p.keys(keys);
             EXPECT_TRUE(eventually([&] { return moves(p, bar); }));
             p.keys(keys);
             EXPECT_TRUE(eventually([&] { return !moves(p, bar); }));
             p.keys("Ctrl+T");
         }},
        {"view.next_panel",
         [](Program& p, const std::string& keys) {
             turnPanel(p, keys);
             p.keys("Ctrl+PageUp");
         }},
        {"view.previous_panel",
         [](Program& p, const std::string& keys) {
             turnPanel(p, keys);
             p.keys("Ctrl+PageDown");
         }},
        {"view.next_part", toPicture},
        {"view.previous_part", toPanel},
        {"view.to_canvas",
         [](Program& p, const std::string& keys) {
             pick(p, {"box"});
             p.keys("Alt+3");
             p.keys(keys);
             p.keys("Right");
             expectSelected(p, {"cut"});
         }},
        {"view.to_viewport", toPicture},
        {"view.to_side", toPanel},
        {"help.node",
         [](Program& p, const std::string& keys) {
             pick(p, {"ball"});
             p.keys(keys);
             p.waitFor("A ball centred at the origin");
         }},
        {"help.find",
         [](Program& p, const std::string& keys) {
             p.keys(keys);
             p.type("select all\n");
             expectSelected(p, {"box", "ball", "cut", "out"});
         }},
        {"help.shortcuts",
         [](Program& p, const std::string& keys) {
             p.keys(keys);
             p.waitFor("selects by lasso");
             p.keys("Escape");
             p.waitUntilGone("selects by lasso");
         }},
        {"file.quit",
         [](Program& p, const std::string& keys) {
             p.keys(keys);
             EXPECT_EQ(p.waitForEnd(), 0);
         }},
        {"picture.frame",
         [](Program& p, const std::string& keys) {
             lookFirst(p, "1", "Front · perspective");
             p.wheel(picturePart(p).centre(), -8);
             const Camera far = cameraSeen(p);
             p.keys(keys);
             waitForLook(p, "Front · perspective");
             const Camera near = cameraSeen(p);
             const auto away = [](const Camera& camera) { return camera.position[2] - camera.target[2]; };
             EXPECT_LT(away(near), 0.7 * away(far));
             EXPECT_GT(away(near), 1.0);
             for (const double middle : near.target) EXPECT_NEAR(middle, 0.0, 0.5);
         }},
        {"view.probe",
         [](Program& p, const std::string& keys) {
             p.keys(keys);
             p.waitFor("Selected nodes only");
             p.keys(keys);
             p.waitUntilGone("Selected nodes only");
         }},
        {"view.split",
         [](Program& p, const std::string& keys) {
             p.keys(keys);
             p.waitFor("Front · orthographic");
             p.waitFor("Right · orthographic");
             p.waitFor("Top · orthographic");
             p.keys(keys);
             p.waitUntilGone("Front · orthographic");
         }},
        {"picture.next_picture",
         [](Program& p, const std::string& keys) {
             p.keys("Ctrl+Alt+Q");
             p.waitFor("Front · orthographic");
             p.keys("Alt+2");
             p.keys(keys);
             p.keys("Ctrl+1");  // in the second of them
             p.waitFor("Back · orthographic");
             p.keys("1");
             p.waitUntilGone("Back · orthographic");
             p.keys("Ctrl+Alt+Q");
             p.waitUntilGone("Front · orthographic");
             p.keys("Alt+1");
         }},
        {"picture.measure", [](Program& p, const std::string& keys) { takeUpMeasure(p, keys, "Length: click two points"); }},
        {"picture.wall", [](Program& p, const std::string& keys) { takeUpMeasure(p, keys, "Wall: click the solid"); }},
        {"picture.line", [](Program& p, const std::string& keys) {
             takeUpMeasure(p, keys, "Plot: click two points");
             p.keys("Alt+P");  // its panel
         }},
        {"picture.clear",
         [](Program& p, const std::string& keys) {
             lookFirst(p, "1", "Front · perspective");
             p.keys("Shift+M");
             p.waitFor("Length: click two points");
             p.keys(keys);
             p.waitUntilGone("Length: click two points");
         }},
        {"canvas.left", [](Program& p, const std::string& keys) { step(p, "cut", keys, {"box"}); }},
        {"canvas.add_left", [](Program& p, const std::string& keys) { step(p, "cut", keys, {"cut", "box"}); }},
        {"canvas.right", [](Program& p, const std::string& keys) { step(p, "box", keys, {"cut"}); }},
        {"canvas.add_right", [](Program& p, const std::string& keys) { step(p, "box", keys, {"box", "cut"}); }},
        {"canvas.up", [](Program& p, const std::string& keys) { step(p, "ball", keys, {"box"}); }},
        {"canvas.add_up", [](Program& p, const std::string& keys) { step(p, "ball", keys, {"ball", "box"}); }},
        {"canvas.down", [](Program& p, const std::string& keys) { step(p, "box", keys, {"ball"}); }},
        {"canvas.add_down", [](Program& p, const std::string& keys) { step(p, "box", keys, {"box", "ball"}); }},
        {"canvas.move_left", [](Program& p, const std::string& keys) { nudge(p, keys, -1, 0); }},
        {"canvas.move_right", [](Program& p, const std::string& keys) { nudge(p, keys, 1, 0); }},
        {"canvas.move_up", [](Program& p, const std::string& keys) { nudge(p, keys, 0, -1); }},
        {"canvas.move_down", [](Program& p, const std::string& keys) { nudge(p, keys, 0, 1); }},
        {"picture.shading",
         [](Program& p, const std::string& keys) {
             lookFirst(p, "1", "Front · perspective");
             p.waitFor("Normals");
             p.keys(keys);
             p.waitFor("Colours");
         }},
        {"picture.move", takeUp("R", "Scale", "Move")},
        {"picture.rotate", takeUp("R", "Scale", "Rotate")},
        {"picture.scale", takeUp("W", "Move", "Scale")},
        {"picture.snap",
         [](Program& p, const std::string& keys) {
             lookFirst(p, "1", "Front · perspective");
             restingPicture(p);  // and the mouse is there
             p.keys(keys);
             p.waitFor("Snap: drags in the picture");
             p.keys(keys);
             p.waitFor("Snap is off");
         }},
        {"picture.axes",
         [](Program& p, const std::string& keys) {
             lookFirst(p, "1", "Front · perspective");
             restingPicture(p);
             p.keys(keys, 2);
             p.waitFor("Axes: the node's own");
             p.keys(keys);
             p.waitFor("Axes: those of the numbers");
         }},
        {"picture.reset",
         [](Program& p, const std::string& keys) {
             lookFirst(p, "7", "Top · perspective");
             p.keys(keys);
             waitForLook(p, "Whole solid");
         }},
        {"picture.front", lookFrom("7", "Top · perspective", "Front · perspective")},
        {"picture.back", lookFrom("7", "Top · perspective", "Back · perspective")},
        {"picture.right", lookFrom("7", "Top · perspective", "Right · perspective")},
        {"picture.left", lookFrom("7", "Top · perspective", "Left · perspective")},
        {"picture.top", lookFrom("1", "Front · perspective", "Top · perspective")},
        {"picture.bottom", lookFrom("1", "Front · perspective", "Bottom · perspective")},
        {"picture.turn_left", turned(1, 0)},
        {"picture.turn_right", turned(-1, 0)},
        {"picture.turn_up", turned(0, -1)},
        {"picture.turn_down", turned(0, 1)},
        {"picture.pan_left", panned(-1, 0)},
        {"picture.pan_right", panned(1, 0)},
        {"picture.pan_up", panned(0, 1)},
        {"picture.pan_down", panned(0, -1)},
        {"picture.nearer", zoomed(0.88)},
        {"picture.farther", zoomed(1.0 / 0.88)},
        {"picture.to_scene",
         [](Program& p, const std::string& keys) {
             lookFirst(p, "3", "Right · perspective");
             p.keys(keys);
             waitForLook(p, "Scene camera");
             const Result<Scene> scene = readScene(p.saved().scene);
             ASSERT_TRUE(scene && scene->camera);
             const auto &eye = scene->camera->position, &target = scene->camera->target;
             EXPECT_GT(eye[0] - target[0], 1.0);
             EXPECT_NEAR(eye[2], target[2], 1e-6);
         }},
        {"picture.projection",
         [](Program& p, const std::string& keys) {
             lookFirst(p, "1", "Front · perspective");
             const Camera before = cameraSeen(p);
             p.keys(keys);
             waitForLook(p, "Front · orthographic");
             const Camera after = cameraSeen(p);
             EXPECT_EQ(after.fov, kLeastFov);
             EXPECT_GT(after.position[2] - after.target[2], 10.0 * (before.position[2] - before.target[2]));
             // The sides keep it, and so does who goes on from such a camera.
             p.keys("3");
             waitForLook(p, "Right · orthographic");
             p.keys(keys);
             waitForLook(p, "Right · perspective");
             p.keys("Ctrl+Z", 2);
             p.keys("0");
         }},
        {"picture.grid",
         [](Program& p, const std::string& keys) {
             lookFirst(p, "1", "Front · perspective");
             p.keys("5");
             waitForLook(p, "Front · orthographic");
             // The target is at the height of the origin: the line of x goes through the middle, from side
             // to side, beside the solid too.
             const Area part = picturePart(p);
             const auto reddest = [&] {
                 const Picture seen = p.screen(Area{{part.hi.x - 60, part.lo.y}, {part.hi.x - 20, part.hi.y}});
                 int most = 0;
                 for (std::size_t i = 0; i + 3 < seen.pixels.size(); i += 4)
                     most = std::max(most, seen.pixels[i] - std::max(seen.pixels[i + 1], seen.pixels[i + 2]));
                 return most;
             };
             EXPECT_TRUE(eventually([&] { return reddest() < 30; }));
             p.keys(keys);
             EXPECT_TRUE(eventually([&] { return reddest() > 60; }));
             p.keys(keys);
             EXPECT_TRUE(eventually([&] { return reddest() < 30; }));
             p.keys("0");
         }},
        {"picture.keep_view",
         [](Program& p, const std::string& keys) {
             lookFirst(p, "7", "Top · perspective");
             p.keys(keys);
             p.waitFor("kept as view 1");
             EXPECT_NE(readText(p.path("config/fieldwright/editor.json")).find("\"views\""), std::string::npos);
         }},
        {"picture.next_view",
         [](Program& p, const std::string& keys) {
             lookFirst(p, "3", "Right · perspective");
             p.keys("Ctrl+B");
             p.waitFor("kept as view");
             p.keys("5");
             p.keys("7");
             waitForLook(p, "Top · orthographic");
             p.keys("Ctrl+B");
             waitForLook(p, "Top · orthographic");
             p.keys("1");
             waitForLook(p, "Front · orthographic");
             EXPECT_TRUE(eventually([&] {  // round all that are kept
                 p.keys(keys);
                 return p.sees("Right · perspective", pictureCorner(p));
             }));
             EXPECT_TRUE(eventually([&] {
                 p.keys(keys);
                 return p.sees("Top · orthographic", pictureCorner(p));
             }));
             p.keys("0");
         }},
    };
    return all;
}

/// After these another window is needed.
const std::set<std::string> kLast = {"file.new",  "file.next_document", "file.last_document", "file.close",
                                     "file.open", "file.save_as",       "file.export",        "file.render",
                                     "file.quit", "picture.shading",    "help.node"};

/// What ids of commands begin with.
std::string areaOf(const Command& command) {
    return std::string(command.id, 0, std::string_view(command.id).find('.'));
}

std::set<std::string> areas() {
    std::set<std::string> all;
    for (const Command& command : commands()) all.insert(areaOf(command));
    return all;
}

class EndToEndShortcuts : public testing::TestWithParam<std::string> {};

TEST_P(EndToEndShortcuts, DoWhatTheTableSays) {
    std::optional<Program> program;
    std::string original;
    for (const Command& command : commands()) {
        if (areaOf(command) != GetParam()) continue;
        std::istringstream words(command.keys);
        const bool all = std::getenv("FIELDWRIGHT_LONG");
        bool first = true;
        for (std::string keys; words >> keys && (all || std::exchange(first, false));) {
            SCOPED_TRACE(std::string(command.id) + ": " + keys);
            const auto found = cases().find(command.id);
            if (found == cases().end()) {
                ADD_FAILURE() << "no case presses it: write one";
                continue;
            }
            if (!program) {
                program.emplace(GetParam() == "timeline" ? kMoving : kDocument);
                ASSERT_TRUE(program->works())
                    << "Xvfb, xdotool or xclip is not installed: run ./.install test";
                original = program->save();
                if (GetParam() == "picture") {
                    program->frameAll();
                    showNormals(*program);
                }
            }
            program->moveTo({200, 60});
            program->frameAll();
            found->second(*program, keys);
            if (kLast.contains(command.id) || HasFailure()) {
                program.reset();
                if (HasFailure()) return;
                continue;
            }
            // All as it was: the steps taken back, nothing selected.
            program->moveTo({200, 60});
            program->keys("Ctrl+Z", 3);
            EXPECT_EQ(program->save(), original);
            program->click(program->nowhere());
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Commands, EndToEndShortcuts, testing::ValuesIn(areas()),
                         [](const auto& area) { return area.param; });

}  // namespace fw::editor::test::end_to_end_shortcuts_test
