#include "tests/editor/program/shortcut_cases.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace fw::editor::test::shortcut_cases {

void pick(Program& program, const std::vector<std::string>& nodes) {
    for (const std::string& node : nodes)
        program.click(program.title(node), 1, node == nodes[0] ? "" : "shift");
}

Ids nodesAfter(Program& program) {
    Ids ids;
    for (const Node& node : program.saved().nodes) ids.insert(node.id);
    return ids;
}

const Node& nodeAfter(Program& program, const std::string& id) {
    const Node* node = findNode(program.saved().nodes, id);
    if (!node) throw std::runtime_error("no node " + id);
    return *node;
}

std::string source(const Node& node, const std::string& input) {
    const InputValue* value = node.input(input);
    const Link* link = value ? std::get_if<Link>(&value->value) : nullptr;
    return link ? link->node : "";
}

void expectSelected(Program& program, const Ids& selected) {
    program.keys("Delete");
    Ids left = {"box", "ball", "cut", "out"};
    for (const std::string& id : selected) left.erase(id);
    EXPECT_EQ(nodesAfter(program), left);
}

Area picturePart(const Program& program) {
    return {{program.view.panel.hi.x + 20, 120}, {1260, program.pictureEnd() - 40}};
}
Area pictureCorner(const Program& program) {
    return {{program.view.panel.hi.x + 20, program.pictureEnd() - 60}, {1280, program.pictureEnd() + 30}};
}

void waitForLook(Program& program, const std::string& words) {
    program.waitFor(words, pictureCorner(program));
}

void lookUntil(Program& program, const std::string& keys, const std::string& words) {
    EXPECT_TRUE(eventually([&] {
        program.keys(keys);
        return program.sees(words, pictureCorner(program));
    })) << words;
}

}  // namespace fw::editor::test::shortcut_cases
