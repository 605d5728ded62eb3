// What copying writes can be pasted anywhere, and what cannot be pasted explains itself.
#include "editor/document/clipboard.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "tests/support/editor/random_edits.h"

namespace fw::editor::clipboard_test {

using editor::test::structuralErrors;

Graph sample(const std::string& name) {
    const Result<Graph> graph =
        readGraph(std::string(FIELDWRIGHT_SOURCE_DIR) + "/samples/" + name + ".field.json", nullptr);
    EXPECT_TRUE(graph) << format(graph.error());
    return graph ? *graph : Graph{};
}

NodeIds idsOf(const Graph& graph, std::string_view scope = "") {
    NodeIds ids;
    for (const Node& node : nodesOf(graph, scope)) ids.push_back(node.id);
    return ids;
}

Graph pasted(const Graph& graph, const std::string& text) {
    const Result<Edited> result = pasteNodes(graph, "", text, {0, 0});
    EXPECT_TRUE(result) << text << "\n" << format(result.error());
    return result ? result->graph : Graph{};
}

std::string refusalOf(const Graph& graph, const std::string& text) {
    const Result<Edited> result = pasteNodes(graph, "", text, {0, 0});
    return result ? "pasted" : format(result.error());
}

const std::string* sourceOf(const Graph& graph, const std::string& node, const std::string& input) {
    const InputValue* value = graph.node(node) ? graph.node(node)->input(input) : nullptr;
    const Link* link = value ? std::get_if<Link>(&value->value) : nullptr;
    return link ? &link->node : nullptr;
}

TEST(Copy, AWholeSampleIntoNothingIsTheSample) {
    for (const Graph& graph : editor::test::graphsToEdit(30)) {
        const std::string text = copyNodes(graph, "", idsOf(graph));
        const Result<Graph> read = parseGraph(text, "", nullptr);
        ASSERT_TRUE(read) << format(read.error());
        EXPECT_EQ(read->nodes, graph.nodes);
        const Result<Edited> result = pasteNodes(Graph{}, "", text, {0, 0});
        ASSERT_TRUE(result) << format(result.error());
        ASSERT_EQ(result->graph.nodes.size(), graph.nodes.size());
        for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
            Node node = result->graph.nodes[i];
            EXPECT_TRUE(node.at);
            node.at = graph.nodes[i].at;
            EXPECT_EQ(node, graph.nodes[i]);
        }
    }
}

TEST(Copy, KeepsWiresAmongTheNodesOnly) {
    const Graph graph = sample("table_and_stool");
    const std::string text = copyNodes(graph, "", NodeIds{"stool", "beside"});
    const Result<Graph> part = parseGraph(text, "", nullptr);
    ASSERT_TRUE(part);
    EXPECT_EQ(part->groups.size(), 1u) << "what the stool is made of";
    EXPECT_TRUE(part->parameters.empty());
    const Graph twice = pasted(graph, text);
    EXPECT_EQ(twice.groups.size(), 1u) << "the same group is there";
    ASSERT_TRUE(twice.node("stool_2") && twice.node("beside_2"));
    EXPECT_EQ(*sourceOf(twice, "beside_2", "surface"), "stool_2");
    const std::string alone = copyNodes(graph, "", NodeIds{"both"});
    EXPECT_EQ(sourceOf(pasted(Graph{}, alone), "both", "a"), nullptr);
    EXPECT_TRUE(parseGraph(copyNodes(graph, "", NodeIds{"both"}), "", nullptr)->groups.empty());
}

TEST(Paste, RenamesAGroupThatIsAnother) {
    const Graph graph = sample("table_and_stool");
    Graph other = graph;
    other.groups[0].nodes[1].label = "Another plate";
    const Graph both = pasted(graph, copyNodes(other, "", NodeIds{"table"}));
    ASSERT_EQ(both.groups.size(), 2u);
    EXPECT_EQ(both.groups[1].id, "furniture_2");
    EXPECT_EQ(both.nodes.back().group, "furniture_2");
    EXPECT_TRUE(structuralErrors(both).empty());
}

TEST(Paste, TakesFilesAndPartsOfFiles) {
    const Graph graph = sample("tower");
    const std::string node = R"({"id": "ball", "type": "sphere"})";
    for (const std::string& text :
         std::vector<std::string>{node, "[" + node + "]", "{\"nodes\": [" + node + "]}", "  " + node + ",\n",
                                  "\xEF\xBB\xBF" + node, "```json\n" + node + "\n```\n",
                                  "{\xC2\xA0\"id\": \"ball\",\xC2\xA0\"type\": \"sphere\"}",
                                  "{\"fieldwright\": 1, \"nodes\": [" + node + "]}"}) {
        const Graph more = pasted(graph, text);
        EXPECT_EQ(more.nodes.size(), graph.nodes.size() + 1) << text;
        EXPECT_EQ(more.nodes.back().type, "sphere") << text;
        EXPECT_TRUE(more.nodes.back().at) << text;
    }
    const Graph two = pasted(graph, node +
                                        ",\n{\"id\": \"up\", \"type\": \"translate\", \"inputs\": "
                                        "{\"surface\": {\"from\": \"ball\"}}},");
    EXPECT_EQ(two.nodes.size(), graph.nodes.size() + 2);
    EXPECT_EQ(*sourceOf(two, "up", "surface"), "ball");
}

TEST(Paste, PutsTheMiddleWhereItIsAskedFor) {
    const Graph graph = sample("tower");
    const Result<Edited> result = pasteNodes(Graph{}, "", writeGraph(graph), {5000, -3000});
    ASSERT_TRUE(result);
    double low = 1e9, high = -1e9;
    for (const Node& node : result->graph.nodes) {
        low = std::min(low, (*node.at)[0]), high = std::max(high, (*node.at)[0] + 180);
        EXPECT_NEAR((*node.at)[1], -3000, 2000);
    }
    EXPECT_NEAR(0.5 * (low + high), 5000, 40);
}

TEST(Paste, LeavesOutWhatStandsOnce) {
    const Graph graph = sample("tower");
    const Graph twice = pasted(graph, writeGraph(graph));
    EXPECT_EQ(std::ranges::count(twice.nodes, "output", &Node::type), 1);
    EXPECT_EQ(twice.nodes.size(), 2 * graph.nodes.size() - 1);
    EXPECT_TRUE(structuralErrors(twice).empty());
    EXPECT_EQ(refusalOf(graph, R"({"id": "out", "type": "output"})"),
              "clipboard: error: the text has no nodes that can stand here");
    const Graph table = sample("table_and_stool");
    const Result<Edited> inside = pasteNodes(table, "furniture", writeGraph(graph), {0, 0});
    ASSERT_TRUE(inside);
    EXPECT_TRUE(structuralErrors(inside->graph).empty());
    EXPECT_EQ(pasteNodes(table, "furniture", copyNodes(table, "", NodeIds{"table"}), {}).error().message,
              "group 'furniture' contains itself: furniture -> furniture; remove this node");
}

TEST(Paste, ExplainsWhatItCannotTake) {
    const Graph graph = sample("tower");
    EXPECT_EQ(refusalOf(graph, " \n"), "error: there is no text to paste: copy nodes or a graph file first");
    EXPECT_EQ(refusalOf(graph, "3").substr(0, 51), "clipboard:1:1: error: this is no part of a graph: e");
    EXPECT_EQ(refusalOf(graph, "{\"a\": 1}").substr(0, 51),
              "clipboard:1:1: error: this is no part of a graph: e");
    EXPECT_EQ(refusalOf(graph, "Hello, world").substr(0, 21), "clipboard:1:1: error:");
    EXPECT_EQ(refusalOf(graph, R"({"id": "a", "type": "sphree"})"),
              "clipboard:1:1: error: node 'a': unknown node type 'sphree'; did you mean 'sphere'?");
    EXPECT_EQ(
        refusalOf(graph, "[\n  {\"id\": \"ball\", \"type\": \"sphere\", \"inputs\": {\"radius\": -3}}]"),
        "clipboard:2:57: error: node 'ball', input 'radius': the value -3 is out of range: it must be "
        "at least 0");
    EXPECT_EQ(refusalOf(graph, R"({"id": "a", "type": 3})"),
              "clipboard:1:21: error: node 'a': \"type\" must be a string, not a number");
    EXPECT_EQ(refusalOf(graph, R"({"nodes": [{"id": "a"}]})").substr(0, 23), "clipboard:1:12: error: ");
    EXPECT_EQ(refusalOf(graph, "\n\n{\"nodes\": [{\"id\": \"a\"}]}").substr(0, 23),
              "clipboard:3:12: error: ");
    EXPECT_EQ(refusalOf(graph, R"({"fieldwright": 2, "nodes": []})").substr(0, 23),
              "clipboard:1:17: error: ");
}

TEST(Paste, NoTextBreaksTheGraph) {
    // A sample's text with bytes taken out or changed: refused, or sound.
    std::ifstream file(std::string(FIELDWRIGHT_SOURCE_DIR) + "/samples/table_and_stool.field.json");
    std::ostringstream whole;
    whole << file.rdbuf();
    const Graph graph = sample("tower");
    std::mt19937 random(5);
    int taken = 0;
    for (int i = 0; i < 600; ++i) {
        std::string text = whole.str();
        for (int k = 0; k < 1 + i % 3; ++k) {
            const std::size_t at = random() % text.size();
            if (random() % 2)
                text.erase(at, 1 + random() % 4);
            else
                text[at] = "{}[],:\"a1_- "[random() % 12];
        }
        const Result<Edited> result = pasteNodes(graph, "", text, {0, 0});
        if (!result) {
            EXPECT_FALSE(result.error().message.empty());
            continue;
        }
        ++taken;
        ASSERT_TRUE(structuralErrors(result->graph).empty()) << structuralErrors(result->graph)[0] << text;
    }
    EXPECT_GT(taken, 30);
}

}  // namespace fw::editor::clipboard_test
