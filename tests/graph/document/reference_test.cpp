// The generated reference of the node library.
#include "graph/library/reference.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

namespace fw::reference_test {

TEST(Reference, PageInDocsIsCurrent) {
    std::ifstream file(FIELDWRIGHT_SOURCE_DIR "/docs/nodes.md", std::ios::binary);
    ASSERT_TRUE(file) << "docs/nodes.md is missing";
    const std::string committed{std::istreambuf_iterator<char>(file), {}};
    EXPECT_TRUE(committed == nodesMarkdown())
        << "docs/nodes.md is not current: fieldwright nodes --markdown > docs/nodes.md";
}

TEST(Reference, PageNamesEveryNodeAndInputOnce) {
    const std::string page = nodesMarkdown();
    for (const NodeType& type : nodeTypes()) {
        const std::size_t at = page.find("### " + type.label + "\n\n`" + type.id + "`");
        ASSERT_NE(at, std::string::npos) << type.id;
        EXPECT_EQ(page.find("### " + type.label + "\n", at + 1), std::string::npos) << type.id;
        const std::size_t end = page.find("\n#", at + 1);
        std::size_t row = at;
        for (const InputSpec& input : type.inputs) {
            row = page.find("\n| `" + input.name + "` |", row);
            EXPECT_LT(row, end) << type.id << "." << input.name;
        }
    }
}

TEST(Reference, LinksLeadToHeadings) {
    EXPECT_EQ(referenceLink(*findNodeType("sphere")), "nodes.md#sphere");
    EXPECT_EQ(referenceLink(*findNodeType("infinite_cylinder")), "nodes.md#infinite-cylinder");
    EXPECT_EQ(referenceLink(*findNodeType("box_max")), "nodes.md#box-max-norm");
}

TEST(Reference, JsonHoldsTheTable) {
    const nlohmann::json all = nlohmann::json::parse(nodesJson());
    ASSERT_EQ(all.at("nodes").size(), nodeTypes().size());
    for (std::size_t i = 0; i < nodeTypes().size(); i++) {
        const NodeType& type = nodeTypes()[i];
        const nlohmann::json& node = all["nodes"][i];
        EXPECT_EQ(node.at("id"), type.id);
        ASSERT_EQ(node.at("inputs").size(), type.inputs.size());
        EXPECT_EQ(node.at("outputs").size(), type.outputs.size());
        EXPECT_EQ(node.contains("distance"), bool(type.exactness)) << type.id;
    }
    const nlohmann::json& box =
        all["nodes"][static_cast<std::size_t>(findNodeType("box") - nodeTypes().data())];
    EXPECT_EQ(box["inputs"][1]["default"], nlohmann::json({1, 1, 1}));
    EXPECT_EQ(box["inputs"][1]["min"], 0);
    EXPECT_EQ(box["inputs"][0]["default"], "position");
    EXPECT_EQ(box["distance"], "exact");
    const nlohmann::json& mesh =
        all["nodes"][static_cast<std::size_t>(findNodeType("mesh_file") - nodeTypes().data())];
    EXPECT_EQ(mesh["inputs"][0]["files"], nlohmann::json({".glb", ".gltf", ".obj", ".stl", ".ply"}));
}

TEST(Reference, ClassesAreNamed) {
    const auto text = [](const char* id) { return exactnessText(*findNodeType(id)); };
    EXPECT_EQ(text("sphere"), "exact");
    EXPECT_EQ(text("box_frame"), "exact outside");
    EXPECT_EQ(text("box_max"), "exact inside");
    EXPECT_EQ(text("gyroid"), "a bound");
    EXPECT_EQ(text("union"), "exact outside");
    EXPECT_EQ(text("subtract"), "exact inside");
    EXPECT_EQ(text("twist"), "distorted");
    EXPECT_EQ(text("math"), "");
}

}  // namespace fw::reference_test
