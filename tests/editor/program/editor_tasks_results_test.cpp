// Jobs that end with a file for others: a turntable and a print.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "graph/check/check.h"
#include "tests/support/editor/editor_tasks.h"

namespace fw::editor::test::editor_tasks_results_test {

using namespace editor_tasks;

namespace fs = std::filesystem;
using fw::test::readText;
using fw::test::runProgram;
using fw::test::writeText;

/// A dialog's choice: what its row shows is clicked, then the entry.
void choose(Person& person, const std::string& row, const std::string& entry) {
    const Area label = person.waitFor(row);
    person.click({label.hi.x + 250, label.centre().y});
    person.clickOn(entry);
}

TEST(EditorTasks, ATurntable) {
    const auto first = [](Person& person) { return person.path("document_turntable/000000_of_120.png"); };
    count(
        "A turntable", kMug,
        [&](Person& person) {
            person.keys("Ctrl+Shift+E");
            const Area line = person.waitFor("width, height");
            const Effort before = person.effort;
            for (const auto& [was, wanted] : {std::pair("1280", "64"), std::pair("720", "48")}) {
                const Area numbers{{line.hi.x, line.lo.y - 6}, {1280, line.hi.y + 6}};
                person.clickOn(was, numbers);  // small ones for the test's sake
                person.type(std::string(wanted) + "\n");
                person.waitFor(wanted, numbers);
            }
            person.effort = before;
            person.clickOn("A picture");
            person.clickOn("A turntable");
            person.waitFor("Folder");
            const Area close = person.waitFor("Close");
            person.clickOn("Render", Area{{0, close.lo.y - 6}, {close.lo.x, close.hi.y + 6}});
            const Effort done = person.effort;
            EXPECT_TRUE(eventually([&] { return fs::exists(first(person)); }));
            person.clickOn("Cancel");
            person.waitFor("cancelled after");
            person.keys("Escape");
            person.waitUntilGone("cancelled after");
            person.effort = done;
        },
        [&](Person& person) {
            // Without a dialog: a track of the camera, typed into the file, and a command.
            const std::string track =
                "\"timeline\": {\"length\": 4, \"tracks\": [{\"scene\": \"camera.position\", "
                "\"interpolation\": \"cubic\", "
                "\"keys\": [{\"time\": 0, \"value\": [3, 1, 0]}, {\"time\": 1, \"value\": [0, 1, 3]}, "
                "{\"time\": 2, \"value\": [-3, 1, 0]}, {\"time\": 3, \"value\": [0, 1, -3]}, {\"time\": 4, "
                "\"value\": [3, 1, "
                "0]}]}]}";
            std::string text = readText(person.file());
            text.insert(text.find("\"nodes\""), track + ", ");
            const Result<Graph> moved = parseGraph(text, "", nullptr);
            ASSERT_TRUE(moved) << format(moved.error());
            EXPECT_TRUE(check(*moved).empty());
            const std::string command =
                "fieldwright render document.field.json -o document_turntable --from 0 --to 4 --fps 30\n";
            person.effort.keys += int(track.size() + command.size()) + 2;
            fs::create_directory(person.path("document_turntable"));
            writeText(first(person), "");
        },
        [&](Person& person) { EXPECT_TRUE(fs::exists(first(person))); });
}

TEST(EditorTasks, APrint) {
    const auto print = [](Person& person) {
        person.keys("Ctrl+E");
        choose(person, "Format", "3mf");
        // The list covers the rows below, of which this format has one less: what comes after them moves up.
        EXPECT_TRUE(eventually([&] {
            const Picture now = person.screen();
            const auto seen = [&](const char* words) { return person.reader.find(now, words).has_value(); };
            return seen("Browse …") && !seen("marked as one") && seen("found from the solid");
        })) << "the rows of the format";
        const Area close = person.waitFor("Close");
        person.clickOn("Export", Area{{0, close.lo.y - 6}, {close.lo.x, close.hi.y + 6}});
        person.waitFor("Watertight: every edge has two triangles.");
        const Effort done = person.effort;
        person.keys("Escape");
        person.waitUntilGone("Watertight: every edge has two triangles.");
        person.effort = done;
    };
    count(
        "A print", kMug,
        [&](Person& person) {
            person.addWired({"scale"});
            person.values("0.1");
            print(person);
        },
        [&](Person& person) {
            person.makeRoom(-1);
            person.lead("cup", "scale", person.spot(2.2f, 1.2f));
            person.formerValues("0.1");
            person.save();
            person.wire("scale", "output", "surface");
            print(person);
        },
        [](Person& person) {
            // In millimetres, as printers have it.
            const std::string model =
                runProgram("unzip -p '" + person.path("document.3mf") + "' 3D/3dmodel.model").output;
            double low = 1e9, high = -1e9;
            for (std::size_t at = 0; (at = model.find(" y=\"", at)) != std::string::npos; ++at) {
                const double y = std::atof(&model[at + 4]);
                low = std::min(low, y), high = std::max(high, y);
            }
            EXPECT_NEAR(high - low, 100.0, 2.0) << model.substr(0, 1000);
        });
}

}  // namespace fw::editor::test::editor_tasks_results_test
