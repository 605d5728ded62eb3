// The samples are laid out to be read: no node covers another, and wires lead to the right.
#include <gtest/gtest.h>

#include <filesystem>

#include "editor/canvas/boxes.h"
#include "editor/files/samples.h"
#include "graph/document/json.h"

namespace fw::editor::samples_places_test {

TEST(SamplesPlaces, NoNodeCoversAnotherAndWiresLeadToTheRight) {
    const std::vector<Sample> samples = listSamples(FIELDWRIGHT_SOURCE_DIR "/samples");
    ASSERT_GT(samples.size(), 30u);
    for (const Sample& sample : samples) {
        const Result<Graph> read = readGraph(sample.path, nullptr);
        ASSERT_TRUE(read) << format(read.error());
        std::vector<std::string> scopes{""};
        for (const Group& group : read->groups) scopes.push_back(group.id);
        for (const std::string& scope : scopes) {
            const Boxes boxes(*read, scope);
            const std::string where = sample.label + (scope.empty() ? "" : ", group " + scope) + ": ";
            for (const NodeBox& box : boxes.nodes)
                EXPECT_TRUE(box.node->at) << where << box.node->id << " has no place";
            for (std::size_t i = 0; i < boxes.nodes.size(); ++i)
                for (std::size_t k = i + 1; k < boxes.nodes.size(); ++k)
                    EXPECT_FALSE(boxes.nodes[i].area.grown(4).overlaps(boxes.nodes[k].area))
                        << where << boxes.nodes[i].node->id << " and " << boxes.nodes[k].node->id;
            for (const Wire& wire : boxes.wires)
                EXPECT_LT(boxes.start(wire).x, boxes.end(wire).x)
                    << where << boxes.nodes[wire.from].node->id << " to " << boxes.nodes[wire.to].node->id;
        }
    }
}

}  // namespace fw::editor::samples_places_test
