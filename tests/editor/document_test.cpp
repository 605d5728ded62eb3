// The history: steps, gestures, what is saved; and that undo and redo give the same bytes.
#include "editor/document/document.h"

#include <gtest/gtest.h>

#include "tests/editor/graphs.h"
#include "tests/editor/random_edits.h"

namespace fw::editor::document_test {

using editor::test::graphOf;
using editor::test::RandomEdits;

Graph balls(int count) {
    Graph graph;
    for (int i = 0; i < count; ++i) graph = addNode(graph, "", "sphere", {i * 200.0, 0.0}).graph;
    return graph;
}

TEST(Document, BeginsWithNothingToUndoAndSaved) {
    Document document(balls(2));
    EXPECT_FALSE(document.canUndo());
    EXPECT_FALSE(document.canRedo());
    EXPECT_FALSE(document.undo());
    EXPECT_FALSE(document.redo());
    EXPECT_FALSE(document.unsaved());
    EXPECT_EQ(document.undoName(), "");
}

TEST(Document, NamesWhatIsUndoneAndDoneAgain) {
    Document document(balls(1));
    document.apply("Add Box", addNode(document.graph(), "", "box", {}).graph);
    document.apply("Add Torus", addNode(document.graph(), "", "torus", {}).graph);
    EXPECT_EQ(document.undoName(), "Add Torus");
    EXPECT_TRUE(document.undo());
    EXPECT_EQ(document.undoName(), "Add Box");
    EXPECT_EQ(document.redoName(), "Add Torus");
    EXPECT_EQ(document.graph().nodes.size(), 2u);
    document.apply("Add Cone", addNode(document.graph(), "", "cone", {}).graph);
    EXPECT_FALSE(document.canRedo()) << "another edit ends what could be done again";
    EXPECT_TRUE(document.graph().node("cone"));
    EXPECT_FALSE(document.graph().node("torus"));
}

TEST(Document, TakesNoStepForTheSameGraph) {
    Document document(balls(1));
    const uint64_t revision = document.revision();
    document.apply("Nothing", document.graph());
    EXPECT_FALSE(document.canUndo());
    EXPECT_EQ(document.revision(), revision);
}

TEST(Document, TellsZeroFromMinusZero) {
    Document document(graphOf(R"({"id": "a", "type": "plane", "inputs": {"offset": 0}})"));
    document.apply("Set", setInput(document.graph(), "", {"a", "offset"}, InputValue{-0.0}));
    const std::string after = writeGraph(document.graph());
    ASSERT_TRUE(document.undo());
    EXPECT_NE(writeGraph(document.graph()), after);
    ASSERT_TRUE(document.redo());
    EXPECT_EQ(writeGraph(document.graph()), after);
}

TEST(Document, AGestureIsOneStep) {
    Document document(balls(3));
    const std::string before = writeGraph(document.graph());
    document.begin("Move");
    for (int i = 0; i < 50; ++i)
        document.update(moveNodes(document.graph(), "", NodeIds{"sphere"}, {1.0, 2.0}));
    EXPECT_FALSE(document.canUndo()) << "not while a hand moves";
    EXPECT_FALSE(document.undo());
    EXPECT_TRUE(document.unsaved());
    document.apply("Mute", toggleMuted(document.graph(), "", NodeIds{"sphere_2"}));
    document.end();
    const std::string after = writeGraph(document.graph());
    EXPECT_EQ(document.undoName(), "Move");
    EXPECT_TRUE(document.undo());
    EXPECT_EQ(writeGraph(document.graph()), before);
    EXPECT_FALSE(document.canUndo());
    EXPECT_TRUE(document.redo());
    EXPECT_EQ(writeGraph(document.graph()), after);
}

TEST(Document, ACancelledGestureLeavesNothing) {
    Document document(balls(3));
    const std::string before = writeGraph(document.graph());
    document.begin("Move");
    document.update(moveNodes(document.graph(), "", NodeIds{"sphere"}, {1.0, 2.0}));
    const uint64_t revision = document.revision();
    document.cancel();
    EXPECT_EQ(writeGraph(document.graph()), before);
    EXPECT_NE(document.revision(), revision);
    EXPECT_FALSE(document.canUndo());
    EXPECT_FALSE(document.unsaved());
    document.begin("Move");
    document.end();
    EXPECT_FALSE(document.canUndo()) << "nothing has moved";
}

TEST(Document, KnowsWhetherItIsSaved) {
    Document document(balls(1));
    document.apply("Move", moveNodes(document.graph(), "", NodeIds{"sphere"}, {1.0, 0.0}));
    EXPECT_TRUE(document.unsaved());
    document.markSaved();
    EXPECT_FALSE(document.unsaved());
    document.undo();
    EXPECT_TRUE(document.unsaved());
    document.redo();
    EXPECT_FALSE(document.unsaved());
    document.apply("Move", moveNodes(document.graph(), "", NodeIds{"sphere"}, {1.0, 0.0}));
    document.apply("Move back", moveNodes(document.graph(), "", NodeIds{"sphere"}, {-1.0, 0.0}));
    EXPECT_FALSE(document.unsaved()) << "the graph is as it was saved, whatever led to it";
}

TEST(Document, ThePathIsNotPartOfTheHistory) {
    Document document(balls(1));
    document.apply("Add", addNode(document.graph(), "", "box", {}).graph);
    document.setPath("a.field.json");
    document.undo();
    EXPECT_EQ(document.graph().path, "a.field.json");
    document.redo();
    EXPECT_EQ(document.graph().path, "a.field.json");
    Graph next = addNode(document.graph(), "", "box", {}).graph;
    next.path = "";
    document.apply("Add", next);
    EXPECT_EQ(document.graph().path, "a.field.json");
}

TEST(Document, KeepsAThousandSteps) {
    Document document(balls(4));
    const auto move = [&](int i) {
        document.apply(
            "Move " + std::to_string(i),
            moveNodes(document.graph(), "", NodeIds{"sphere_" + std::to_string(2 + i % 3)}, {1.0, 0.0}));
    };
    std::vector<std::string> texts;
    for (int i = 0; i < 1500; ++i) {
        move(i);
        texts.push_back(writeGraph(document.graph()));
    }
    std::size_t steps = 0;
    for (; document.undo(); ++steps) EXPECT_EQ(writeGraph(document.graph()), texts[texts.size() - 2 - steps]);
    EXPECT_EQ(steps, kMostSteps);
    for (; document.redo(); --steps) {}
    EXPECT_EQ(steps, 0u);
    EXPECT_EQ(writeGraph(document.graph()), texts.back());
}

TEST(Document, UndoAndRedoToBothEndsGiveTheSameBytes) {
    uint32_t seed = 0;
    for (const Graph& start : editor::test::graphsToEdit(30)) {
        Document document(start);
        RandomEdits edits(++seed);
        std::vector<std::string> texts{writeGraph(start)};
        for (int i = 0; i < 60; ++i) {
            std::string name;
            Graph next = edits.next(document.graph(), name);
            if (i % 7 == 6) {  // as a gesture, with something in between
                document.begin(name);
                document.update(edits.next(document.graph(), name));
                document.update(std::move(next));
                document.end();
            } else {
                document.apply(name, std::move(next));
            }
            std::string text = writeGraph(document.graph());
            if (text != texts.back()) texts.push_back(std::move(text));
        }
        for (int round = 0; round < 2; ++round) {
            std::size_t at = texts.size() - 1;
            while (document.undo()) ASSERT_EQ(writeGraph(document.graph()), texts.at(--at)) << seed;
            EXPECT_EQ(at, 0u) << seed;
            EXPECT_FALSE(document.unsaved()) << seed;
            while (document.redo()) ASSERT_EQ(writeGraph(document.graph()), texts.at(++at)) << seed;
            EXPECT_EQ(at, texts.size() - 1) << seed;
        }
    }
}

}  // namespace fw::editor::document_test
