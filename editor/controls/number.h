// A number edited where it stands: on a node of the canvas and in every panel alike.
//
// It is dragged (Shift: a tenth as fast; Alt: ten times as fast), or clicked and typed, as a number or an
// expression of the field language ("2*pi/3"), of lengths and angles with units ("1/4in", "3 mm + 1 cm"),
// which are reckoned into the document's (language/typed_number.h): Enter takes it, Ctrl+Enter for all
// numbers of a vector, Tab goes on to the next one, Shift+Enter asks for the next node where it stands on
// one. Ctrl+click gives back the default, where there is one. Escape takes back what the hand did. Whatever
// is done to it between press and release, or while it is typed, is one hand of the document.
//
// Lifetime: a NumberHand lives with what shows the numbers, from frame to frame.
#pragma once

#include <imgui.h>

#include <functional>
#include <limits>
#include <set>
#include <string>

#include "editor/canvas/view.h"
#include "editor/document/document.h"

namespace fw::editor {

/// A text field that a number is typed into.
struct TypedNumber {
    char text[256] = {};
    bool opened = false;  ///< it has had its first frame
    std::string complaint;
    std::string begun;  ///< typed before it was there: takes the place of the text

    TypedNumber() = default;
    explicit TypedNumber(double number);
};

/// The one number that is under the hand, of those that share this.
struct NumberHand {
    enum class State : unsigned char { none, pressed, dragging, typing } state = State::none;
    Hand hand = Hand::none;
    std::string id;       ///< whose number: any text that tells it from the others
    int part = 0;         ///< which of its numbers
    std::string moves;    ///< "group/node.input" if it is the number of one
    double start = 0.0;   ///< the number when the drag began
    float travelled = 0;  ///< pixels of the drag, those of Shift and Alt counted as they were
    TypedNumber typed;

    bool is(std::string_view whose, int which) const {
        return state != State::none && id == whose && part == which;
    }
    bool types(std::string_view whose, int which) const { return state == State::typing && is(whose, which); }
    /// To be typed in the next frame, from the number that it is. `name` is the step's of undo.
    void type(Document& document, std::string name, std::string_view whose, int which, double number);
    /// Forgets it if the document has ended it. Once a frame, before the numbers are shown.
    void follow(const Document& document);
};

/// The input whose number is dragged, which the preview then keeps live.
std::set<std::string> heldBy(const NumberHand& hand);

/// What a number may be. A range that is not finite is none.
struct NumberRange {
    double min = -std::numeric_limits<double>::infinity(), max = std::numeric_limits<double>::infinity();
    double speed = 0.01;  ///< a pixel of a drag; it is rounded to three digits of that
    bool whole = false;
    std::string_view unit = {};  ///< as InputSpec::unit, of a text that stays
};

/// How and where a number stands.
struct NumberLook {
    Area place;  ///< pixels
    ImFont* font = nullptr;
    float size = 0.0f;      ///< of its text, pixels
    bool enabled = true;    ///< the mouse is heard of
    bool animated = false;  ///< the timeline moves it
};

/// What a frame did to it.
struct NumberDone {
    bool reset = false;  ///< Ctrl+click
    int tab = 0;         ///< it was typed, and the number after it, or before it, is next: 1 or -1
    bool next = false;   ///< it was entered with Shift: another node is wanted
};

/// One frame of the number. `name` is what its step of undo is called; `set` makes it another number: while
/// `hand.hand` holds, by Document::update() if it is the document's. It is kept by the document as what is
/// pending, so it refers to nothing that the frame ends. `setAll` does it to all numbers of the vector that
/// it is of.
NumberDone showNumber(NumberHand& hand, Document& document, std::string_view id, int part, double number,
                      const NumberRange& range, const std::string& name, const NumberLook& look,
                      const std::function<void(Hand, double)>& set,
                      const std::function<void(Hand, double)>& setAll = {});

/// A field's background, and words in it, cut where they do not fit.
void drawField(const Area& place, bool active, bool hovered);
void drawFieldText(const NumberLook& look, const std::string& text, bool toTheRight);

/// As short as it is exact to nine digits.
std::string numberText(double number);

}  // namespace fw::editor
