// The graph under edit and its history.
//
// Undo is snapshots of the value, not commands: whatever changes the graph makes another one and hands it
// over with a name. A snapshot shares with its neighbours every node that did not change, so that a thousand
// steps of a thousand nodes take megabytes. Nothing here draws, compiles or touches files.
//
// What a person has begun and not ended (a drag, a box around nodes, a text that is typed) is a Hand, of
// which the document knows one at most. It ends when its owner ends it, when another begins, when the graph
// changes in another way, or when its owner asks no more whether it still holds: so nothing that was begun on
// a graph goes on over another one, whoever changed it. Who shows a hand keeps its number beside what it
// looks like.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <string>

#include "graph/document/graph.h"

namespace fw::editor {

inline constexpr std::size_t kMostSteps = 1000;  ///< of undo

/// A graph whose unchanged parts are shared with other snapshots.
struct Snapshot;

/// What a person has begun: a number that no other hand has, of this document or another.
enum class Hand : uint64_t { none };

class Document {
  public:
    /// The graph as it was opened or made; nothing to undo, nothing to save.
    explicit Document(Graph graph);

    const Graph& graph() const { return current; }
    /// Another number after every change of the graph, and for every document of the process: what was made
    /// of another one is out of date.
    uint64_t revision() const { return changes; }

    /// One step of undo from the graph as it is to `next`; nothing if they are equal. `name` is what the menu
    /// calls it: "Add Box". A hand ends: what it has changed is a step before this one, what is still pending
    /// one after it.
    void apply(std::string name, Graph next);

    /// Begins what is one step of undo when it ends; what was begun before is settled.
    Hand begin(std::string name);
    /// Whether the hand has not ended. Its owner asks at each frame, and says what settle() is to call so
    /// that nothing is lost which is only on the screen yet; that may update(), or apply().
    bool hold(Hand hand, std::function<void()> pending = {});
    /// The graph while the hand holds; nothing happens if it does not.
    void update(Hand hand, Graph next);
    /// Ends the hand, without what is pending: all that it did is one step. cancel(): as if it had not begun.
    void end(Hand hand);
    void cancel(Hand hand);
    bool holds(Hand number) const { return number != Hand::none && number == hand.number; }
    bool held() const { return hand.number != Hand::none; }
    /// Ends what was begun, if anything was, with what is pending.
    void settle();
    /// Settles a hand for which hold() was not asked since this was called last. Once a frame.
    void settleLost();

    bool canUndo() const;
    bool canRedo() const;
    /// What the next undo takes back, the next redo does again; empty if there is none.
    const std::string& undoName() const;
    const std::string& redoName() const;
    /// False if there is nothing to undo or a hand holds.
    bool undo();
    bool redo();
    /// The steps that there are: step i is what stepName(i) made, and the first has no name if it is the
    /// graph as it was opened, which kMostSteps later is forgotten; and which of them the graph is.
    std::size_t stepCount() const { return steps.size(); }
    const std::string& stepName(std::size_t step) const { return steps[step].name; }
    std::size_t step() const { return at; }
    /// Undoes, or does again, up to a step that there is. False if it is that step, or a hand holds.
    bool goTo(std::size_t step);

    /// Whether the graph is another than the one last saved or opened.
    bool unsaved() const;
    void markSaved();
    /// The file holds something else now, or is gone: unsaved until it is saved again.
    void markUnsaved();
    /// What was made of the graph is out of date for another reason: a file that it reads was changed.
    void outdate();
    /// The file that the graph is of. Not part of the history.
    void setPath(std::string path);

  private:
    struct Step {
        std::string name;
        std::shared_ptr<const Snapshot> after;
    };

    /// What was begun.
    struct Begun {
        Hand number = Hand::none;
        std::string name = {};
        std::function<void()> pending = {};
        bool changed = false;  ///< the graph is another than steps[at]
        bool asked = true;     ///< hold() was, since settleLost()
    };

    void push(std::string name, Graph next);

    Graph current;
    uint64_t changes;
    std::deque<Step> steps;                 ///< the first is what was opened
    std::size_t at = 0;                     ///< the step that `current` is, but for what the hand changed
    std::shared_ptr<const Snapshot> saved;  ///< null: none is
    Begun hand;
};

}  // namespace fw::editor
