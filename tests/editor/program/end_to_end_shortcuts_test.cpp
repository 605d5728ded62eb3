// The shortcuts of the table of commands, pressed in the real window: each has a case (shortcut_cases.h)
// that sees what it did, in the saved file, on the clipboard or on the screen. Of each command the first, all
// with FIELDWRIGHT_LONG.
#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>
#include <sstream>

#include "editor/commands.h"
#include "tests/editor/program/shortcut_cases.h"

namespace fw::editor::test::end_to_end_shortcuts_test {

using namespace shortcut_cases;

constexpr const char* kDocument = R"({"fieldwright": 1, "nodes": [
    {"id": "box", "type": "box", "at": [0, 0]},
    {"id": "ball", "type": "sphere", "at": [0, 200]},
    {"id": "cut", "type": "subtract", "at": [260, 0], "inputs": {"a": {"from": "box"}, "b": {"from": "ball"}}},
    {"id": "out", "type": "output", "at": [520, 0], "inputs": {"surface": {"from": "cut"}, "resolution": 16}}]})";

/// The same with something that moves, for the keys of the timeline.
constexpr const char* kMoving = R"({"fieldwright": 1, "nodes": [
    {"id": "ball", "type": "sphere", "at": [0, 0]},
    {"id": "out", "type": "output", "at": [260, 0], "inputs": {"surface": {"from": "ball"}, "resolution": 16}}],
  "timeline": {"length": 3, "fps": 30,
    "tracks": [{"node": "ball", "input": "radius", "keys": [
      {"time": 0, "value": 1}, {"time": 1, "value": 2}, {"time": 2, "value": 1}]}],
    "markers": [{"time": 0.5, "name": "one"}, {"time": 1.5, "name": "two"}]}})";

const Case* caseOf(const std::string& command) {
    for (const Cases* cases : {&graphCases(), &windowCases(), &pictureCases(), &timelineCases()})
        if (const auto found = cases->find(command); found != cases->end()) return &found->second;
    return nullptr;
}

/// After it another window is needed.
const std::string kLast = "file.quit";

/// What ids of commands begin with.
std::string areaOf(const Command& command) {
    return std::string(command.id, 0, std::string_view(command.id).find('.'));
}

std::set<std::string> areas() {
    std::set<std::string> all;
    for (const Command& command : commands()) all.insert(areaOf(command));
    return all;
}

class EndToEndShortcuts : public testing::TestWithParam<std::string> {};

TEST_P(EndToEndShortcuts, DoWhatTheTableSays) {
    std::optional<Program> program;
    std::string original;
    for (const Command& command : commands()) {
        if (areaOf(command) != GetParam()) continue;
        std::istringstream words(command.keys);
        const bool all = std::getenv("FIELDWRIGHT_LONG");
        bool first = true;
        for (std::string keys; words >> keys && (all || std::exchange(first, false));) {
            SCOPED_TRACE(std::string(command.id) + ": " + keys);
            const Case* found = caseOf(command.id);
            if (!found) {
                ADD_FAILURE() << "no case presses it: write one";
                continue;
            }
            if (!program) {
                if (GetParam() == "picture")
                    program.emplace(kDocument, 0.35f, 0.27f);
                else
                    program.emplace(GetParam() == "timeline" ? kMoving : kDocument, Program::kLittle);
                ASSERT_TRUE(program->works())
                    << "Xvfb, xdotool or xclip is not installed: run ./.install test";
                original = program->save();
                if (GetParam() == "picture") {
                    program->frameAll();
                    showNormals(*program);
                }
            }
            program->moveTo({200, 60});
            program->frameAll();
            (*found)(*program, keys);
            if (command.id == kLast || HasFailure()) {
                program.reset();
                if (HasFailure()) return;
                continue;
            }
            // All as it was: the steps taken back, nothing selected.
            program->moveTo({200, 60});
            program->keys("Ctrl+Z", 3);
            EXPECT_EQ(program->save(), original);
            program->click(program->nowhere());
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Commands, EndToEndShortcuts, testing::ValuesIn(areas()),
                         [](const auto& area) { return area.param; });

}  // namespace fw::editor::test::end_to_end_shortcuts_test
