// What the panels remember from one frame to the next: texts that are being typed, values under the hand,
// what is searched for. None of it is of the document.
#pragma once

#include <imgui.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>

#include "editor/canvas/fields.h"
#include "editor/panels/problems.h"
#include "editor/ramps/hand.h"
#include "editor/timeline/state.h"
#include "graph/document/scene.h"
#include "graph/document/timeline.h"

namespace fw::editor {

struct Editor;

/// The one text that is being typed into a panel. It reaches the document when the field loses the keyboard.
struct TextEdit {
    ImGuiID field = 0;  ///< 0: none
    Hand hand = Hand::none;
    std::string text;
};

/// The one value that a hand drags in a panel and that is no number: a colour, a key of the timeline.
struct HeldValue {
    ImGuiID field = 0;  ///< 0: none
    Hand hand = Hand::none;
    std::set<std::string> inputs;  ///< "node.input" of what it moves
};

struct PanelState {
    NumberHand number;
    TextEdit text;
    HeldValue held;
    RampHand ramp;
    ImGuiID refocus = 0;  ///< a text field that gets the keyboard again in the next frame

    std::string newInput;  ///< names typed for inputs to be added
    int newInputType = 0;
    std::string newSocket;
    int newSocketType = int(Type::scalar);

    std::string otherUnit;  ///< that was chosen for the document, until it is said what stays

    ShownProblems problems;
    std::size_t historyAt = 0;  ///< the step of undo that the history showed as the present one

    std::string search;            ///< of the outliner
    std::set<std::string> folded;  ///< the scopes whose nodes it hides

    /// The document's timeline as it was read, or why it could not be: of revision `read`.
    uint64_t read = 0;
    Timeline timeline;
    std::string timelineProblem;
    double played = 0.0;  ///< seconds since play began at 0, beyond the timeline's length when it repeats
    TimelineState timelinePanel;

    /// Inputs under the hand in any panel.
    std::set<std::string> heldInputs() const {
        std::set<std::string> all = heldBy(number);
        all.insert(held.inputs.begin(), held.inputs.end());
        all.merge(ramp.held());
        return all;
    }
};

}  // namespace fw::editor
