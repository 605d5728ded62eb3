// Jobs that begin with what is there already: a mesh, a library part, a broken file; and a fluid.
#include <gtest/gtest.h>

#include <filesystem>

#include "graph/check/check.h"
#include "tests/support/editor/editor_tasks.h"

namespace fw::editor::test::editor_tasks_sources_test {

using namespace editor_tasks;

namespace fs = std::filesystem;
using fw::test::writeText;

constexpr const char* kShelf = R"({"fieldwright": 1, "nodes": [
    {"id": "output", "type": "output", "at": [660, 0], "inputs": {"resolution": 16}}]})";
constexpr const char* kBroken = R"({"fieldwright": 1, "nodes": [
    {"id": "ball", "type": "spere", "at": [0, 0], "inputs": {"radius": 0.5}},
    {"id": "cube", "type": "mesh_file", "at": [0, 160], "inputs": {"path": "cube.obj"}},
    {"id": "solid", "type": "mesh_to_field", "at": [240, 160], "inputs": {"mesh": {"from": "cube"}, "resolution": 16}},
    {"id": "both", "type": "union", "at": [480, 0], "inputs": {"a": {"from": "ball"}, "b": {"from": "solid"}}},
    {"id": "output", "type": "output", "at": [700, 0], "inputs": {"surface": {"from": "both"}, "resolution": 16}}]})";

const Area kInspector{{700, 440}, {1280, 800}};

TEST(EditorTasks, ACutMesh) {
    count(
        "A cut mesh", kNew,
        [](Person& person) {
            person.remove("box");
            person.drop(person.path("elsewhere/cube.obj"), {200, 300});
            person.addWired({"sub", "box", "trans"});
            person.type("1");
            person.keys("Ctrl+Enter");
            person.keys("Ctrl+S");
        },
        [](Person& person) {
            // A graph reads files from its own folder alone.
            fs::copy_file(person.path("elsewhere/cube.obj"), person.path("cube.obj"));
            person.makeRoom();
            person.addAt("mesh file", person.spot(-1.6f, -1.6f));
            // What is wrong with the node comes between, and moves the inputs down; it has such a word too.
            const Area finding = person.waitFor("named", kInspector);
            const Area label = person.waitFor("Path", Area{{kInspector.lo.x, finding.hi.y}, kInspector.hi});
            person.click({label.hi.x + 200, label.centre().y});
            person.type("cube.obj\n");
            person.save();
            person.lead("mesh_file", "mesh to", person.spot(-0.6f, -1.7f));
            person.lead("mesh_to_field", "sub", person.spot(0.6f, -1.4f));
            person.wire("subtract", "output", "surface");
            person.lead("box", "trans", person.spot(0.4f, 1.2f));
            person.formerValues("1\t1\t1");
            person.save();
            person.wire("translate", "subtract", "b");
            person.keys("Ctrl+S");
        },
        [](Person& person) {
            const Solid cut(person.graph());
            EXPECT_TRUE(cut.at(-0.5, -0.5, -0.5));
            EXPECT_TRUE(cut.at(0.5, -0.5, 0.5));
            EXPECT_FALSE(cut.at(0.5, 0.5, 0.5));
            EXPECT_FALSE(cut.at(-1.2, 0, 0));
        });
}

TEST(EditorTasks, AFluid) {
    count(
        "A fluid", kNew,
        [](Person& person) {
            person.click(person.title("box"));
            person.valuesThen("0.5", {"fluid"});
            person.values("0.1");
            person.keys("Ctrl+S");
        },
        [](Person& person) {
            person.makeRoom();
            person.click(person.title("box"));
            person.formerValues("0.5");
            person.save();
            person.lead("box", "fluid", person.spot(-1, -2));
            person.formerValues("0.1");
            person.save();
            person.lead("sph_fluid", "particles to", person.spot(0.4f, 1));
            person.wire("particles_to_field", "output", "surface");
            person.keys("Ctrl+S");
        },
        [](Person& person) {
            const Graph& graph = person.graph();
            for (const Error& finding : check(graph))
                EXPECT_NE(finding.severity, Error::Severity::error) << format(finding);
            const auto source = [&](const char* type, const char* input) {
                const InputValue* value = onlyOf(graph, type)->input(input);
                const Link* link = value ? std::get_if<Link>(&value->value) : nullptr;
                return link ? link->node : std::string();
            };
            EXPECT_EQ(source("output", "surface"), "particles_to_field");
            EXPECT_EQ(source("particles_to_field", "particles"), "sph_fluid");
            EXPECT_EQ(source("sph_fluid", "source"), "box");
        });
}

TEST(EditorTasks, ALibraryPart) {
    const auto prepare = [](Person& person) { writeText(person.path("shelf.field.json"), kShelf); };
    count(
        "A library part", kMug,
        [&](Person& person) {
            prepare(person);
            person.click(person.title("cup"));
            person.keys("Ctrl+K");
            person.waitFor("with 3 nodes that feed it");
            person.type("\n");
            person.waitFor("kept as cup");
            person.open("shelf.field.json", "sh");
            person.keys("Shift+A");  // what was kept last is the first in the menu
            person.keys("Shift+Enter");
            person.keys("Ctrl+S");
        },
        [&](Person& person) {
            prepare(person);
            person.click(person.title("cup"));
            person.keys("L");
            person.keys("Ctrl+C");
            person.open("shelf.field.json", "shelf");
            person.makeRoom();
            person.moveTo(person.spot(2.1f, -1.3f));
            person.keys("Ctrl+V");
            person.save();
            person.wire("cup", "output", "surface");
            person.keys("Ctrl+S");
        },
        [](Person& person) {
            EXPECT_TRUE(person.file().ends_with("shelf.field.json"));
            EXPECT_EQ(person.graph().nodes.size(), 5u);
            const Solid mug(person.graph());
            EXPECT_TRUE(mug.at(0.38, 0, 0));
            EXPECT_FALSE(mug.at(0, 0.2, 0));
        });
}

TEST(EditorTasks, AMend) {
    count(
        "A mend", kBroken,
        [](Person& person) {
            person.clickOn("Problems (1)");
            person.clickOn("Make it a Sphere");
            if (failed()) return;
            person.clickOn("Find the file …");
            if (failed()) return;
            person.waitFor("1 found");
            person.keys("Ctrl+S");
        },
        [](Person& person) {
            person.makeRoom(-1);
            person.remove("ball");
            person.addAt("sphere", person.spot(0, 0));
            person.formerValues("0.5");
            person.save();
            person.wire("sphere", "both", "a");
            person.click(person.title("cube"));
            // In the field, beside which the error says it too.
            person.clickOn("cube.obj", Area{{person.view.panel.hi.x + 170, 400}, {1280, 800}});
            person.keys("Ctrl+A");
            person.type("elsewhere/cube.obj\n");
            person.keys("Ctrl+S");
        },
        [](Person& person) {
            const Solid both(person.graph());
            EXPECT_EQ(onlyOf(person.graph(), "sphere")->input("radius")->value, InputValue{0.5}.value);
            EXPECT_TRUE(both.at(0.9, 0.9, 0.9)) << "the mesh is read";
            EXPECT_FALSE(both.at(1.1, 0, 0));
        });
}

}  // namespace fw::editor::test::editor_tasks_sources_test
