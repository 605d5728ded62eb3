// Groups that are copies of files: digests, taking what a file holds, and what the editor says and does.
#include <gtest/gtest.h>

#include <filesystem>

#include "editor/document/clipboard.h"
#include "editor/document/linked_groups.h"
#include "tests/support/editor/driven_editor.h"
#include "tests/support/editor/graphs.h"

namespace fw::editor::linked_groups_test {

namespace fs = std::filesystem;
using fw::test::readText;
using fw::test::writeText;
using test::DrivenEditor;
using test::errorsOf;
using test::parsed;

/// A document with a bolt of two parts, the thread a group within; `radius` of its head.
std::string documentOf(const std::string& radius, const std::string& bolt = "bolt",
                       const std::string& thread = "thread") {
    return R"({"fieldwright": 1, "nodes": [
    {"id": "one", "type": "group", "at": [0, 0], "group": ")" +
           bolt + R"(", "inputs": {"size": 2}},
    {"id": "out", "type": "output", "at": [300, 0], "inputs": {"surface": {"from": "one"}, "resolution": 16}}],
  "groups": [
    {"id": ")" +
           bolt + R"(", "inputs": [{"name": "size", "type": "float", "value": 1}],
     "outputs": [{"name": "surface", "type": "surface"}],
     "nodes": [
      {"id": "in", "type": "group_input", "at": [0, 0]},
      {"id": "head", "type": "sphere", "at": [200, 0], "inputs": {"radius": )" +
           radius + R"(}},
      {"id": "shank", "type": "group", "at": [200, 200], "group": ")" +
           thread + R"("},
      {"id": "both", "type": "union", "at": [400, 0], "inputs": {"a": {"from": "head"}, "b": {"from": "shank"}}},
      {"id": "end", "type": "group_output", "at": [600, 0], "inputs": {"surface": {"from": "both"}}}]},
    {"id": ")" +
           thread + R"(", "outputs": [{"name": "surface", "type": "surface"}],
     "nodes": [
      {"id": "rod", "type": "cylinder", "at": [0, 0]},
      {"id": "end", "type": "group_output", "at": [200, 0], "inputs": {"surface": {"from": "rod"}}}]}]})";
}

TEST(LinkedGroups, DigestsAreOfWhatTheyAreNotOfNames) {
    const std::string digest = digestOf(parsed(documentOf("1")), "bolt");
    EXPECT_EQ(digest.size(), 16u);
    EXPECT_EQ(digest, digestOf(parsed(documentOf("1", "screw", "screw2")), "screw"));
    EXPECT_NE(digest, digestOf(parsed(documentOf("1.5")), "bolt"));
    std::string within = documentOf("1");
    within.replace(within.find("\"cylinder\""), 10, "\"box\"");
    EXPECT_NE(digest, digestOf(parsed(within), "bolt")) << "of a group in it";
    EXPECT_EQ(digestOf(parsed(within), "none"), "");
    EXPECT_EQ(digest, digestOf(linked(parsed(documentOf("1")), "bolt", "a/b.field.json"), "bolt"));
}

TEST(LinkedGroups, AFileShowsItsGroup) {
    const Graph graph = parsed(documentOf("1"));
    const std::string text = textOfGroup(graph, "bolt");
    const Result<ShownGroup> shown = groupShownBy(text, "bolt.field.json");
    ASSERT_TRUE(shown) << format(shown.error());
    EXPECT_EQ(errorsOf(shown->graph), "");
    EXPECT_EQ(digestOf(shown->graph, shown->group), digestOf(graph, "bolt"));
    EXPECT_EQ(shown->graph.groups.size(), 2u);
    EXPECT_FALSE(groupShownBy(R"({"fieldwright": 1, "nodes": [{"id": "a", "type": "box"}]})", "a"));
    EXPECT_FALSE(groupShownBy("nothing", "a"));
}

TEST(LinkedGroups, WhatTheFileHoldsIsTaken) {
    const Graph graph = parsed(documentOf("1"));
    Graph changed = parsed(documentOf("3", "part", "ridges"));
    Group& group = changed.groups[0];
    group.inputs[0].name = "scale";  // another name, so that the value of `size` goes
    const Result<Graph> next = withGroupOf(graph, "bolt", {changed, "part"});
    ASSERT_TRUE(next) << format(next.error());
    EXPECT_EQ(errorsOf(*next), "");
    EXPECT_EQ(digestOf(*next, "bolt"), digestOf(changed, "part"));
    EXPECT_EQ(next->node("one")->input("size"), nullptr);
    EXPECT_EQ(next->group("thread"), nullptr) << "which it alone had";
    EXPECT_NE(next->group("ridges"), nullptr);
    // The same again changes nothing.
    const Result<Graph> again = withGroupOf(*next, "bolt", {changed, "part"});
    ASSERT_TRUE(again);
    EXPECT_EQ(*again, *next);
}

TEST(LinkedGroups, AGroupWithinItselfIsRefused) {
    // The file's bolt uses a group that the document has as one which uses the bolt.
    Graph graph = parsed(documentOf("1"));
    const Result<ShownGroup> own = groupShownBy(textOfGroup(graph, "bolt"), "a");
    ASSERT_TRUE(own);
    const Result<Graph> inThread = withGroupOf(graph, "thread", *own);
    // Its own bolt has the old thread in it, under another name: that is no circle.
    if (inThread) { EXPECT_EQ(errorsOf(*inThread), ""); }
    EXPECT_FALSE(withGroupOf(graph, "none", *own));
}

TEST(LinkedGroups, StatesAreToldByThreeDigests) {
    EXPECT_EQ(linkState("a", "a", "a"), LinkState::same);
    EXPECT_EQ(linkState("a", "b", "b"), LinkState::same);
    EXPECT_EQ(linkState("a", "a", "b"), LinkState::fileChanged);
    EXPECT_EQ(linkState("a", "b", "a"), LinkState::changedHere);
    EXPECT_EQ(linkState("a", "b", "c"), LinkState::bothChanged);
}

TEST(LinkedGroups, AreWrittenAndReadAsTheyWere) {
    const Graph graph = linked(parsed(documentOf("1")), "bolt", "parts/bolt.field.json");
    const std::string text = writeGraph(graph);
    EXPECT_NE(text.find("\"file\": \"parts/bolt.field.json\""), std::string::npos);
    const Graph read = parsed(text);
    EXPECT_EQ(read.group("bolt")->file, "parts/bolt.field.json");
    EXPECT_EQ(read.group("bolt")->taken, digestOf(graph, "bolt"));
    EXPECT_EQ(writeGraph(read), text);
}

TEST(LinkedGroups, TwoDocumentsShareOne) {
    DrivenEditor editor;
    NEEDS_EDITOR(editor);
    const std::string one = editor.path("one.field.json"), other = editor.path("sub/other.field.json"),
                      part = editor.path("parts/bolt.field.json");
    fs::create_directories(editor.path("sub"));
    fs::create_directories(editor.path("parts"));
    writeText(one, documentOf("1"));
    writeText(other, documentOf("1"));
    const auto group = [&] { return *editor->document.graph().group("bolt"); };
    const auto words = [&] {
        editor->files.groups.forget();
        editor->files.groups.look(editor->graph);
        const GroupLinks::Link* link = editor->files.groups.of("bolt");
        return link ? wordsOf(*link) : std::string("no link");
    };
    openFile(*editor, one);
    editor.settle();
    EXPECT_EQ(words(), "no link");
    linkGroup(*editor, "bolt", part);
    editor.settle();
    EXPECT_EQ(group().file, "parts/bolt.field.json");
    EXPECT_EQ(words(), "");
    ASSERT_TRUE(save(*editor));

    openFile(*editor, other);
    editor.settle();
    linkGroup(*editor, "bolt", part);
    editor.settle();
    EXPECT_EQ(group().file, "../parts/bolt.field.json");
    // Changed here, written; the first document is told, and takes it.
    enter(*editor, "bolt");
    editor.settle();
    editor->document.apply("Set", setNumber(editor->document.graph(), "bolt", {"head", "radius"}, 0, 2.5));
    editor.settle();
    EXPECT_NE(words().find("changed here"), std::string::npos) << words();
    EXPECT_EQ(editor->files.groups.findings().size(), 1u);
    EXPECT_EQ(editor->files.groups.findings()[0].node, "one");
    writeGroup(*editor, "bolt");
    editor.settle();
    EXPECT_EQ(words(), "");
    ASSERT_TRUE(save(*editor));

    openFile(*editor, one);
    editor.settle();
    EXPECT_NE(words().find("was changed"), std::string::npos) << words();
    const std::string before = writeGraph(editor->document.graph());
    updateGroup(*editor, "bolt");
    editor.settle();
    EXPECT_EQ(words(), "");
    EXPECT_EQ(std::get<double>(findNode(group().nodes, "head")->input("radius")->value), 2.5);
    editor.keys("ctrl+z");
    EXPECT_EQ(writeGraph(editor->document.graph()), before);
    editor.keys("ctrl+y");
    // Both changed: said so, and what a write replaces is kept.
    editor->document.apply("Set", setNumber(editor->document.graph(), "bolt", {"head", "radius"}, 0, 4));
    std::string elsewhere = readText(part);
    elsewhere.replace(elsewhere.find("2.5"), 3, "3.5");
    writeText(part, elsewhere);
    editor.settle();
    EXPECT_NE(words().find("elsewhere"), std::string::npos) << words();
    writeGroup(*editor, "bolt");
    editor.settle();
    EXPECT_EQ(words(), "");
    ASSERT_FALSE(versionsOf(part).empty());
    EXPECT_EQ(readText(versionsOf(part)[0].path), elsewhere);
    // Gone, damaged, and local again.
    writeText(part, "no graph");
    editor.settle();
    EXPECT_NE(words().find("cannot be used"), std::string::npos) << words();
    updateGroup(*editor, "bolt");
    EXPECT_EQ(std::get<double>(findNode(group().nodes, "head")->input("radius")->value), 4.0);
    fs::remove(part);
    editor.settle();
    EXPECT_NE(words().find("cannot be used"), std::string::npos) << words();
    unlinkGroup(*editor, "bolt");
    editor.settle();
    EXPECT_EQ(words(), "no link");
    EXPECT_TRUE(group().taken.empty());
    // Not into the document's own file.
    linkGroup(*editor, "bolt", one);
    EXPECT_EQ(group().file, "");
    EXPECT_NE(editor->notice.find("own file"), std::string::npos) << editor->notice;
}

TEST(LinkedGroups, PathsFollowADocumentThatIsSavedElsewhere) {
    DrivenEditor editor;
    NEEDS_EDITOR(editor);
    const std::string file = editor.path("a.field.json"), part = editor.path("bolt.field.json");
    fs::create_directories(editor.path("deep/er"));
    writeText(file, documentOf("1"));
    openFile(*editor, file);
    editor.settle();
    linkGroup(*editor, "bolt", part);
    ASSERT_TRUE(writeFile(*editor, editor.path("deep/er/b.field.json")));
    EXPECT_EQ(editor->document.graph().group("bolt")->file, "../../bolt.field.json");
    // So do those of what is copied into another document.
    editor.settle();
    copyText(*editor, copyNodes(editor->document.graph(), "", NodeIds{"one"}));
    writeText(editor.path("deep/c.field.json"), R"({"fieldwright": 1, "nodes": []})");
    openFile(*editor, editor.path("deep/c.field.json"));
    editor.settle();
    EXPECT_NE(pastedText(*editor).find("\"file\": \"../bolt.field.json\""), std::string::npos)
        << pastedText(*editor);
}

}  // namespace fw::editor::linked_groups_test
