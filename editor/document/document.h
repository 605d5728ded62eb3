// The graph under edit and its history.
//
// Undo is snapshots of the value, not commands: whatever changes the graph makes another one and hands it
// over with a name. A snapshot shares with its neighbours every node that did not change, so that a thousand
// steps of a thousand nodes take megabytes. What a person does in one go (a drag, typing a number) is one
// gesture and one step. Nothing here draws, compiles or touches files.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <string>

#include "graph/document/graph.h"

namespace fw::editor {

inline constexpr std::size_t kMostSteps = 1000;  ///< of undo

/// A graph whose unchanged parts are shared with other snapshots.
struct Snapshot;

class Document {
  public:
    /// The graph as it was opened or made; nothing to undo, nothing to save.
    explicit Document(Graph graph);

    const Graph& graph() const { return current; }
    /// Another number after every change of the graph: what was made of an earlier one is out of date.
    uint64_t revision() const { return changes; }

    /// One step of undo from the graph as it is to `next`; nothing if they are equal. `name` is what the menu
    /// calls it: "Add Box". Inside a gesture as update().
    void apply(std::string name, Graph next);

    /// A gesture: all that happens until end() is one step. cancel() goes back to where it began. There is
    /// none in a gesture.
    void begin(std::string name);
    void update(Graph next);
    void end();
    void cancel();
    bool inGesture() const { return gesture != nullptr; }

    bool canUndo() const;
    bool canRedo() const;
    /// What the next undo takes back, the next redo does again; empty if there is none.
    const std::string& undoName() const;
    const std::string& redoName() const;
    /// False if there is nothing to undo or a gesture is under way.
    bool undo();
    bool redo();

    /// Whether the graph is another than the one last saved or opened.
    bool unsaved() const;
    void markSaved();
    /// The file holds something else now, or is gone: unsaved until it is saved again.
    void markUnsaved();
    /// What was made of the graph is out of date for another reason: a file that it reads was changed.
    void outdate() { ++changes; }
    /// The file that the graph is of. Not part of the history.
    void setPath(std::string path);

  private:
    struct Step {
        std::string name;
        std::shared_ptr<const Snapshot> after;
    };

    Graph current;
    uint64_t changes = 1;
    std::deque<Step> steps;                   ///< the first is what was opened
    std::size_t at = 0;                       ///< the step that `current` is, unless a gesture is under way
    std::shared_ptr<const Snapshot> saved;    ///< null: none is
    std::shared_ptr<const Snapshot> gesture;  ///< what the gesture began with
    std::string gestureName;
};

}  // namespace fw::editor
