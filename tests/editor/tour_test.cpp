// The tour: each of its steps is noticed when it is done, and when it is taken back.
#include "editor/panels/tour.h"

#include <gtest/gtest.h>

#include "editor/document/document.h"
#include "editor/document/edits.h"
#include "editor/files/samples.h"
#include "graph/check/check.h"
#include "graph/document/json.h"

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
