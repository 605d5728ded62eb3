#include "tests/support/editor/editor_tasks.h"

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <sstream>

#include "tests/support/graph/triangle_meshes.h"

namespace fw::editor::test::editor_tasks {

namespace fs = std::filesystem;
using fw::test::readText;
using fw::test::writeText;

const std::string kPage = FIELDWRIGHT_SOURCE_DIR "/docs/editor-tasks.md";

const char* const kNew = R"({"fieldwright": 1, "nodes": [
    {"id": "box", "type": "box", "at": [0, 0]},
    {"id": "output", "type": "output", "at": [260, 0], "inputs": {"surface": {"from": "box"}, "resolution": 16}}]})";
const char* const kMug = R"({"fieldwright": 1, "nodes": [
    {"id": "body", "type": "cylinder", "at": [0, 0], "inputs": {"radius": 0.4, "half_height": 0.5}},
    {"id": "hollow", "type": "cylinder", "at": [0, 200], "inputs": {"radius": 0.35, "half_height": 0.5}},
    {"id": "up", "type": "translate", "at": [220, 200], "inputs": {"surface": {"from": "hollow"}, "offset": [0, 0.05, 0]}},
    {"id": "cup", "type": "subtract", "at": [440, 0], "inputs": {"a": {"from": "body"}, "b": {"from": "up"}}},
    {"id": "output", "type": "output", "at": [660, 0], "inputs": {"surface": {"from": "cup"}, "resolution": 16}}]})";

/// A cube from -1 to 1.
std::string cubeText() {
    const TriangleMesh cube = fw::test::cubeFile();
    std::string text;
    for (const glm::vec3& p : cube.positions)
        text += "v " + std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z) + "\n";
    for (std::size_t i = 0; i < cube.indices.size(); i += 3)
        text += "f " + std::to_string(cube.indices[i] + 1) + " " + std::to_string(cube.indices[i + 1] + 1) +
                " " + std::to_string(cube.indices[i + 2] + 1) + "\n";
    return text;
}

bool isLong() { return std::getenv("FIELDWRIGHT_LONG") != nullptr; }
bool updates() { return std::getenv("FIELDWRIGHT_UPDATE_TASKS") != nullptr; }

bool failed() { return testing::Test::HasFailure(); }

std::vector<std::string> cells(const std::string& line) {
    std::vector<std::string> all;
    std::istringstream words(line.substr(1));
    for (std::string cell; std::getline(words, cell, '|');) {
        const std::size_t first = cell.find_first_not_of(' '), last = cell.find_last_not_of(' ');
        all.push_back(first == std::string::npos ? std::string() : cell.substr(first, last - first + 1));
    }
    return all;
}

std::vector<std::string> cellsOf(const Effort& effort) {
    return {std::to_string(effort.clicks), std::to_string(effort.drags), std::to_string(effort.keys),
            std::to_string(effort.all())};
}

/// The table's row of this job against what was counted. `former` only where that was done too.
void compare(const std::string& job, const Effort& now, const std::optional<Effort>& former) {
    std::istringstream page(readText(kPage));
    std::string written, row;
    bool found = false;
    for (std::string line; std::getline(page, line); written += line + "\n") {
        if (!line.starts_with("| " + job + " |")) continue;
        found = true;
        std::vector<std::string> counted = cells(line);
        counted.resize(9);
        const std::vector<std::string> before = counted, those = cellsOf(now);
        std::ranges::copy(those, counted.begin() + 1);
        if (former) std::ranges::copy(cellsOf(*former), counted.begin() + 5);
        line = "|";
        for (const std::string& cell : counted) line += " " + cell + " |";
        EXPECT_TRUE(updates() || before == counted) << "docs/editor-tasks.md should have the row\n" << line;
    }
    EXPECT_TRUE(found) << "docs/editor-tasks.md has no row of " << job;
    if (updates()) writeText(kPage, written);
}

void count(const std::string& job, const char* document, const Way& now, const Way& former,
           const Way& expect) {
    const auto done = [&](const Way& way) -> std::optional<Effort> {
        Person person(document);
        EXPECT_TRUE(person.works()) << "Xvfb, xdotool or xclip is not installed: run ./.install test";
        if (!person.works()) return {};
        fs::create_directory(person.path("elsewhere"));
        writeText(person.path("elsewhere/cube.obj"), cubeText());
        person.look();
        person.effort = {};
        way(person);
        const Effort taken = person.effort;
        if (!failed()) person.save();
        if (!failed()) expect(person);
        return taken;
    };
    const std::optional<Effort> counted = done(now);
    if (failed()) return;
    // Of this the former way is reckoned: a file and a command, not keys in the window.
    const bool reckoned = job == "A turntable";
    const std::optional<Effort> before = isLong() && !reckoned ? done(former) : std::nullopt;
    if (!failed()) compare(job, *counted, before);
}

const Node* onlyOf(const Graph& graph, const std::string& type) {
    const Node* found = nullptr;
    for (const Node& node : graph.nodes)
        if (node.type == type) {
            EXPECT_EQ(found, nullptr) << "several of " << type;
            found = &node;
        }
    EXPECT_NE(found, nullptr) << "no " << type << " in\n" << writeGraph(graph);
    return found;
}

}  // namespace fw::editor::test::editor_tasks
