// The history: steps, gestures, what is saved; and that undo and redo give the same bytes.
#include "editor/document/document.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/support/editor/graphs.h"
#include "tests/support/editor/random_edits.h"

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

TEST(Document, GoesToAnyStepOfItsList) {
    Document document(balls(1));
    std::vector<std::string> states{writeGraph(document.graph())};
    for (const char* type : {"box", "torus", "cone"}) {
        document.apply(std::string("Add ") + type, addNode(document.graph(), "", type, {}).graph);
        states.push_back(writeGraph(document.graph()));
    }
    ASSERT_EQ(document.stepCount(), 4u);
    EXPECT_EQ(document.stepName(0), "");
    EXPECT_EQ(document.stepName(3), "Add cone");
    for (const std::size_t step : {1u, 3u, 0u, 2u}) {
        EXPECT_TRUE(document.goTo(step));
        EXPECT_EQ(document.step(), step);
        EXPECT_EQ(writeGraph(document.graph()), states[step]);
    }
    EXPECT_EQ(document.undoName(), "Add torus");
    EXPECT_EQ(document.redoName(), "Add cone");
    const uint64_t revision = document.revision();
    EXPECT_FALSE(document.goTo(2)) << "it is there";
    EXPECT_FALSE(document.goTo(4));
    EXPECT_EQ(document.revision(), revision);
    const Hand hand = document.begin("Drag");
    EXPECT_FALSE(document.goTo(0)) << "a hand holds";
    document.cancel(hand);
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

Graph moved(const Document& document, const char* node) {
    return moveNodes(document.graph(), "", NodeIds{node}, {1.0, 2.0});
}

TEST(Document, WhatAHandDoesIsOneStep) {
    Document document(balls(3));
    const std::string before = writeGraph(document.graph());
    const Hand hand = document.begin("Move");
    for (int i = 0; i < 50; ++i) document.update(hand, moved(document, "sphere"));
    EXPECT_FALSE(document.canUndo()) << "not while a hand moves";
    EXPECT_FALSE(document.undo());
    EXPECT_TRUE(document.unsaved());
    document.end(hand);
    const std::string after = writeGraph(document.graph());
    EXPECT_EQ(document.undoName(), "Move");
    EXPECT_TRUE(document.undo());
    EXPECT_EQ(writeGraph(document.graph()), before);
    EXPECT_FALSE(document.canUndo());
    EXPECT_TRUE(document.redo());
    EXPECT_EQ(writeGraph(document.graph()), after);
}

TEST(Document, ACancelledHandLeavesNothing) {
    Document document(balls(3));
    const std::string before = writeGraph(document.graph());
    Hand hand = document.begin("Move");
    document.update(hand, moved(document, "sphere"));
    const uint64_t revision = document.revision();
    document.cancel(hand);
    EXPECT_EQ(writeGraph(document.graph()), before);
    EXPECT_NE(document.revision(), revision);
    EXPECT_FALSE(document.canUndo());
    EXPECT_FALSE(document.unsaved());
    hand = document.begin("Move");
    document.end(hand);
    EXPECT_FALSE(document.canUndo()) << "nothing has moved";
}

TEST(Document, AnotherChangeEndsTheHand) {
    Document document(balls(3));
    const Hand hand = document.begin("Move");
    document.update(hand, moved(document, "sphere"));
    const std::string dragged = writeGraph(document.graph());
    document.apply("Mute", toggleMuted(document.graph(), "", NodeIds{"sphere_2"}));
    const std::string muted = writeGraph(document.graph());
    EXPECT_FALSE(document.held());
    EXPECT_FALSE(document.hold(hand));
    document.update(hand, balls(1));
    document.cancel(hand);
    document.end(hand);
    EXPECT_EQ(writeGraph(document.graph()), muted) << "a hand that has ended does nothing";
    EXPECT_EQ(document.undoName(), "Mute");
    EXPECT_TRUE(document.undo());
    EXPECT_EQ(writeGraph(document.graph()), dragged) << "what it did is a step before the change";
    EXPECT_EQ(document.undoName(), "Move");
}

TEST(Document, AnotherHandEndsTheFirst) {
    Document document(balls(3));
    const Hand first = document.begin("Move");
    document.update(first, moved(document, "sphere"));
    const Hand second = document.begin("Move Others");
    EXPECT_FALSE(document.holds(first));
    EXPECT_TRUE(document.holds(second));
    document.update(first, balls(1));
    document.update(second, moved(document, "sphere_2"));
    document.end(second);
    EXPECT_EQ(document.undoName(), "Move Others");
    EXPECT_TRUE(document.undo());
    EXPECT_EQ(document.undoName(), "Move");
    EXPECT_TRUE(document.undo());
    EXPECT_EQ(document.graph(), balls(3));
}

TEST(Document, WhatIsPendingIsNotLost) {
    Document document(balls(3));
    const auto label = [&document](const char* words) {
        document.apply("Set Label", setLabel(document.graph(), "", "sphere", words));
    };
    // The change under it was made of a graph that lacks what is typed: that comes on top.
    Hand hand = document.begin("Type");
    document.hold(hand, [&] { label("head"); });
    document.apply("Mute", toggleMuted(document.graph(), "", NodeIds{"sphere"}));
    EXPECT_TRUE(document.graph().node("sphere")->muted);
    EXPECT_EQ(document.graph().node("sphere")->label, "head");
    EXPECT_EQ(document.undoName(), "Set Label");

    hand = document.begin("Type");
    document.hold(hand, [&] { label("foot"); });
    document.settle();
    EXPECT_EQ(document.graph().node("sphere")->label, "foot");
    EXPECT_FALSE(document.held());

    hand = document.begin("Type");
    document.hold(hand,
                  [&, hand] { document.update(hand, setLabel(document.graph(), "", "sphere", "hand")); });
    document.begin("Move");
    EXPECT_EQ(document.graph().node("sphere")->label, "hand");

    hand = document.begin("Type");
    document.hold(hand, [&] { label("none"); });
    document.end(hand);
    EXPECT_EQ(document.graph().node("sphere")->label, "hand") << "its owner has seen to it";
}

TEST(Document, AHandThatNobodyAsksForEnds) {
    Document document(balls(3));
    const Hand hand = document.begin("Move");
    document.update(hand, moved(document, "sphere"));
    document.settleLost();  // the frame in which it began
    for (int frame = 0; frame < 5; ++frame) {
        EXPECT_TRUE(document.hold(hand));
        document.settleLost();
    }
    EXPECT_TRUE(document.holds(hand));
    document.settleLost();
    EXPECT_FALSE(document.holds(hand));
    EXPECT_EQ(document.undoName(), "Move");
}

TEST(Document, RevisionsAndHandsAreOfOneDocumentAlone) {
    std::set<uint64_t> revisions;
    std::set<Hand> hands;
    std::size_t count = 0;
    Document first(balls(2)), second(balls(2));
    for (Document* each : {&first, &second, &first, &second}) {
        revisions.insert(each->revision());
        const Hand hand = each->begin("Move");
        hands.insert(hand);
        each->update(hand, moved(*each, "sphere"));
        revisions.insert(each->revision());
        each->cancel(hand);
        each->outdate();
        count += 2;
    }
    EXPECT_EQ(revisions.size(), count);
    EXPECT_EQ(hands.size(), 4u);
    const Hand of = first.begin("Move");
    EXPECT_FALSE(second.holds(of));
    second.update(of, balls(1));
    EXPECT_EQ(second.graph(), balls(2));
    first = Document(balls(1));
    EXPECT_FALSE(first.holds(of)) << "another document is in its place";
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
            if (i % 7 == 6) {  // by a hand, with something in between
                const Hand hand = document.begin(name);
                document.update(hand, edits.next(document.graph(), name));
                document.update(hand, std::move(next));
                document.end(hand);
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
