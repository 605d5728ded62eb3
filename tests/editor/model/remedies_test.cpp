// What is offered about a finding: it makes the finding go away, and is what a person would do.
#include <gtest/gtest.h>

#include "editor/document/remedies.h"
#include "tests/support/editor/graphs.h"

namespace fw::editor::remedies_test {

using test::graphOf;

std::vector<std::string> labelsOf(const Graph& graph, std::size_t finding = 0) {
    const std::vector<Error> findings = checkStructure(graph);
    std::vector<std::string> labels;
    if (finding >= findings.size()) return {"no finding"};
    for (const Remedy& remedy : remediesOf(graph, findings[finding])) labels.push_back(remedy.label);
    return labels;
}

using Labels = std::vector<std::string>;
const std::string kOut = R"({"id": "out", "type": "output", "inputs": {"surface": {"from": "a"}}})";

TEST(Remedies, AreWhatAPersonWouldDo) {
    EXPECT_EQ(labelsOf(graphOf(R"({"id": "a", "type": "sphre"}, )" + kOut)),
              (Labels{"Make it a Sphere", "Remove the node"}));
    EXPECT_EQ(labelsOf(graphOf(R"({"id": "a", "type": "sphere", "inputs": {"radus": 2}}, )" + kOut)),
              (Labels{"Call it radius", "Take it off"}));
    EXPECT_EQ(labelsOf(graphOf(R"({"id": "a", "type": "sphere", "inputs": {"radius": -2}}, )" + kOut)),
              (Labels{"Make it 0", "Back to its default"}));
    EXPECT_EQ(
        labelsOf(graphOf(R"({"id": "a", "type": "sphere", "inputs": {"radius": {"from": "b"}}}, )" + kOut)),
        (Labels{"Take off the wire"}));
    EXPECT_EQ(labelsOf(graphOf(R"({"id": "a", "type": "sphere", "code": "return 1;"}, )" + kOut)),
              (Labels{"Take off the code"}));
    EXPECT_EQ(
        labelsOf(graphOf(kOut + R"(, {"id": "a", "type": "sphere"}, {"id": "b", "type": "output"})"), 1),
        (Labels{"Remove the node"}));
    EXPECT_EQ(labelsOf(graphOf(R"({"id": "a", "type": "sphere", "at": [10, 20]})")),
              (Labels{"Add an output"}));
}

TEST(Remedies, AnOutputShowsWhatNothingUses) {
    const Graph graph = graphOf(
        R"({"id": "a", "type": "sphere", "at": [0, 0]}, {"id": "b", "type": "translate", "at": [200, 0], "inputs": {"surface": {"from": "a"}}})");
    const std::vector<Error> findings = checkStructure(graph);
    ASSERT_EQ(findings.size(), 1u);
    const Graph mended = remediesOf(graph, findings[0]).at(0).mend(graph);
    ASSERT_EQ(mended.nodes.size(), 3u);
    EXPECT_EQ(std::get<Link>(mended.nodes[2].input("surface")->value).node, "b");
    EXPECT_EQ(test::errorsOf(mended), "");
}

TEST(Remedies, MakeTheFindingGo) {
    // Everything that can be wrong, from the file that has it.
    const Result<Graph> all =
        readGraph(FIELDWRIGHT_SOURCE_DIR "/tests/data/bad/check-everything.field.json", nullptr);
    ASSERT_TRUE(all);
    const auto standing = [](const Graph& graph, const Error& finding) {
        for (const Error& each : checkStructure(graph))
            if (each.node == finding.node && each.input == finding.input && each.message == finding.message)
                return true;
        return false;
    };
    std::size_t offered = 0, errors = 0;
    for (const Error& finding : checkStructure(*all)) {
        const std::vector<Remedy> remedies = remediesOf(*all, finding);
        errors += finding.severity == Error::Severity::error;
        offered += finding.severity == Error::Severity::error && !remedies.empty();
        for (const Remedy& remedy : remedies) {
            EXPECT_FALSE(remedy.label.empty());
            EXPECT_FALSE(standing(remedy.mend(*all), finding)) << remedy.label << ": " << format(finding);
        }
    }
    EXPECT_GT(2 * offered, errors) << offered << " of " << errors;
    // One after the other until nothing is offered any more.
    Graph graph = *all;
    for (int step = 0; step < 200; ++step) {
        bool mended = false;
        for (const Error& finding : checkStructure(graph)) {
            const std::vector<Remedy> remedies = remediesOf(graph, finding);
            if (remedies.empty() || finding.severity != Error::Severity::error) continue;
            graph = remedies[0].mend(graph);
            mended = true;
            break;
        }
        if (!mended) break;
    }
    EXPECT_LT(checkStructure(graph).size(), checkStructure(*all).size() / 2);
}

TEST(Remedies, AreNoneForWhatIsNotThere) {
    const Graph graph = graphOf(R"({"id": "a", "type": "sphere"}, )" + kOut);
    EXPECT_TRUE(remediesOf(graph, Error{.message = "nothing", .node = "a", .input = "radius"}).empty());
    EXPECT_TRUE(remediesOf(graph, Error{.message = "nothing", .node = "none"}).empty());
}

}  // namespace fw::editor::remedies_test
