// Keys that do something to nodes.
#include <gtest/gtest.h>

#include "editor/document/frames.h"
#include "graph/document/named_parameters.h"
#include "tests/editor/program/shortcut_cases.h"

namespace fw::editor::test::shortcut_cases {

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

const Cases& graphCases() {
    static const Cases all = {
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
        {"node.keep",
         [](Program& p, const std::string& keys) {
             // With what feeds it, under the name that is proposed.
             pick(p, {"cut"});
             p.keys(keys);
             p.waitFor("with 2 nodes that feed it");
             p.type("\n");
             p.waitFor("kept as cut in the library");
             const std::string kept = fw::test::readText(p.path("data/fieldwright/library/cut.field.json"));
             for (const char* type : {"\"box\"", "\"sphere\"", "\"subtract\""})
                 EXPECT_NE(kept.find(type), std::string::npos) << kept;
             EXPECT_EQ(kept.find("\"output\""), std::string::npos) << kept;
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
        {"canvas.left", [](Program& p, const std::string& keys) { step(p, "cut", keys, {"box"}); }},
        {"canvas.add_left",
         [](Program& p, const std::string& keys) {
             step(p, "cut", keys, {"cut", "box"});
         }},
        {"canvas.right", [](Program& p, const std::string& keys) { step(p, "box", keys, {"cut"}); }},
        {"canvas.add_right",
         [](Program& p, const std::string& keys) {
             step(p, "box", keys, {"box", "cut"});
         }},
        {"canvas.up", [](Program& p, const std::string& keys) { step(p, "ball", keys, {"box"}); }},
        {"canvas.add_up",
         [](Program& p, const std::string& keys) {
             step(p, "ball", keys, {"ball", "box"});
         }},
        {"canvas.down", [](Program& p, const std::string& keys) { step(p, "box", keys, {"ball"}); }},
        {"canvas.add_down",
         [](Program& p, const std::string& keys) {
             step(p, "box", keys, {"box", "ball"});
         }},
        {"canvas.move_left", [](Program& p, const std::string& keys) { nudge(p, keys, -1, 0); }},
        {"canvas.move_right", [](Program& p, const std::string& keys) { nudge(p, keys, 1, 0); }},
        {"canvas.move_up", [](Program& p, const std::string& keys) { nudge(p, keys, 0, -1); }},
        {"canvas.move_down", [](Program& p, const std::string& keys) { nudge(p, keys, 0, 1); }},
    };
    return all;
}

}  // namespace fw::editor::test::shortcut_cases
