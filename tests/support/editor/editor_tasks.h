// docs/editor-tasks.md: ten jobs of a newcomer, each done in the real window, with what it takes of clicks,
// drags and keys. The table of that page has the counts; with FIELDWRIGHT_UPDATE_TASKS=1 they are written
// there. With FIELDWRIGHT_LONG=1 each is done in the former way too, which the last columns count. Here is
// what all have in common; the jobs are in editor_tasks_*_test.cpp.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "graph/compile/compile.h"
#include "graph/document/json.h"
#include "tests/support/editor/program.h"

namespace fw::editor::test::editor_tasks {

/// What File, New makes, but that its picture is soon there.
extern const char* const kNew;
/// What the first job leaves, without a handle.
extern const char* const kMug;

/// A person at the editor: what is done again and again, by the ways of now and by the former ones.
struct Person : Program {
    using Program::Program;

    /// Where everything is, for the test's own eyes: what is seen counts nothing.
    void look() {
        save();
        frameAll();
    }
    /// Room on the canvas for what is to come.
    void makeRoom(int notches = -3) {
        frameAll();
        zoom(notches);
    }
    /// A place of the canvas, counted in nodes.
    ImVec2 spot(float column, float row) const { return view.toScreen({230 * column, 180 * row}); }

    /// From the menu, to this place.
    void addAt(const std::string& search, ImVec2 place) {
        moveTo(place);
        keys("Shift+A");
        type(search + "\n");
        save();
    }
    /// The menu is open: what is found comes wired to what is selected; all but the last with Tab, which
    /// opens it anew.
    void chooseWired(const std::vector<std::string>& searches) {
        for (const std::string& search : searches) {
            type(search);
            keys(&search == &searches.back() ? "Shift+Enter" : "Tab");
        }
    }
    void addWired(const std::vector<std::string>& searches) {
        keys("Shift+A");
        chooseWired(searches);
    }
    /// The first values of the selected node, which its first digit begins.
    void values(const std::string& typed) { type(typed + "\n"); }
    /// The same, and the menu for what is next.
    void valuesThen(const std::string& typed, const std::vector<std::string>& searches) {
        type(typed);
        keys("Shift+Enter");
        chooseWired(searches);
    }
    /// The values as they were begun formerly.
    void formerValues(const std::string& typed) {
        keys("Enter");
        type(typed + "\n");
    }
    /// A wire to an empty place, and what comes there.
    void lead(const std::string& from, const std::string& search, ImVec2 place) {
        drag({output(from), place});
        type(search + "\n");
        save();
    }
    void wire(const std::string& from, const std::string& to, const std::string& name) {
        drag({output(from), input(to, name)});
        save();
    }
    void remove(const std::string& node) {
        click(title(node));
        keys("X");
    }
};

/// What is on the way of the first failure is not waited for any more.
bool failed();

using Way = std::function<void(Person&)>;

/// Does the job in a window of its own: as it is done now, and in the former way.
void count(const std::string& job, const char* document, const Way& now, const Way& former,
           const Way& expect);

/// What was saved, compiled, and where it is solid.
struct Solid {
    explicit Solid(const Graph& graph) : program(compile(graph)) {
        EXPECT_TRUE(program) << format(program.error()) << "\n" << writeGraph(graph);
    }
    bool at(double x, double y, double z) const {
        return program && evaluate(program->ir, program->distance(), {}, Point{x, y, z}) < 0.0;
    }
    Result<fw::Program> program;
};

/// The document's only node of this type.
const Node* onlyOf(const Graph& graph, const std::string& type);

}  // namespace fw::editor::test::editor_tasks
