// Keys of documents, of what is shown and of where the keyboard is.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/editor/program/shortcut_cases.h"

namespace fw::editor::test::shortcut_cases {

using fw::test::readText;
using fw::test::writeText;

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
    program.waitForChange(before, {{program.view.panel.hi.x + 20, program.pictureEnd() + 60}, {1260, 700}});
}

/// The keyboard steers the picture, wherever the mouse is.
void toPicture(Program& program, const std::string& keys) {
    program.keys(keys);
    lookUntil(program, "7", "Top · perspective");
    program.keys("0");
    waitForLook(program, "Whole solid");
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

void waitForNew(Program& program) {
    EXPECT_TRUE(eventually([&] { return program.title().starts_with("untitled"); }));
}

/// Closes the document in front, behind which this one is.
void closeBefore(Program& program, const std::string& title) {
    program.keys("Ctrl+W");
    program.waitForTitle(title);
}

/// From a new document back to the one that there was; the new one is closed then.
void fromNewDocument(Program& program, const std::string& keys) {
    const std::string title = program.title();
    program.keys("Ctrl+N");
    waitForNew(program);
    program.keys(keys);
    program.waitForTitle(title);
    program.keys("Alt+PageDown");
    waitForNew(program);
    closeBefore(program, title);
}

const Cases& windowCases() {
    static const Cases all = {
        {"file.new",
         [](Program& p, const std::string& keys) {
             const std::string title = p.title();
             p.keys(keys);
             waitForNew(p);
             closeBefore(p, title);
         }},
        {"file.next_document", fromNewDocument},
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
             waitForNew(p);
             p.open(p.file());
         }},
        {"file.open",
         [](Program& p, const std::string& keys) {
             const std::string title = p.title();
             writeText(p.path("other.field.json"), R"({"fieldwright": 1, "nodes": []})");
             p.keys(keys);
             p.keys("Ctrl+A");
             p.type("other.field.json\n");
             p.waitForTitle("other.field.json - Fieldwright");
             closeBefore(p, title);
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
             const std::string title = p.title(), before = p.save();
             p.keys(keys);
             p.keys("Ctrl+A");
             p.type("copy\n");
             p.waitForTitle("copy.field.json - Fieldwright");
             EXPECT_EQ(readText(p.path("copy.field.json")), before);
             p.open(p.file());
             p.keys("Alt+PageUp");
             p.waitForTitle("copy.field.json - Fieldwright");
             closeBefore(p, title);
         }},
        {"file.export",
         [](Program& p, const std::string& keys) {
             p.keys(keys);
             p.waitFor("Close");
             p.keys("Escape");
             p.waitUntilGone("Close");
         }},
        {"file.render",
         [](Program& p, const std::string& keys) {
             p.keys(keys);
             p.waitFor("Samples");
             p.keys("Escape");
             p.waitUntilGone("Samples");
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
             p.waitFor("Node reference");
             p.waitFor("Meaning");
             p.keys("Escape");
             p.waitUntilGone("Node reference");
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
        {"view.probe",
         [](Program& p, const std::string& keys) {
             p.keys(keys);
             p.waitFor("Selected nodes only");
             p.keys(keys);
             p.waitUntilGone("Selected nodes only");
         }},
    };
    return all;
}

}  // namespace fw::editor::test::shortcut_cases
