// Values edited where they stand: numbers, switches and choices, on a node of the canvas and in the inspector
// alike.
//
// A number is dragged (Shift: a tenth as fast; Alt: ten times as fast), or clicked and typed, as a number or
// an expression of the field language ("2*pi/3"); Ctrl+click gives back the default. A drag is one gesture of
// the document, and what it moves is `held`, so that the preview can follow without compiling.
#pragma once

#include <imgui.h>

#include <functional>
#include <optional>
#include <set>
#include <string>

#include "editor/canvas/boxes.h"
#include "editor/document/document.h"

namespace fw::editor {

/// A text field that a number is typed into.
struct TypedNumber {
    char text[256] = {};
    bool opened = false;  ///< it has had its first frame
    std::string complaint;

    TypedNumber() = default;
    explicit TypedNumber(double number);
};
/// One frame of it, in place of the number, at ImGui's cursor.
struct Typed {
    std::optional<double> number = {};  ///< that was entered
    bool ended = false;                 ///< the field is to go
    int tab = 0;                        ///< and the number after it, or before it, to be typed next: 1 or -1
};
Typed typeNumber(TypedNumber& edit, float width);

/// The one field that is being edited.
struct FieldEdit {
    enum class State : unsigned char { none, pressed, dragging, typing } state = State::none;
    std::string scope;
    Plug input;
    int component = 0;
    double start = 0.0;   ///< the number when the drag began
    float travelled = 0;  ///< pixels of the drag, those of Shift and Alt counted as they were
    TypedNumber typed;

    bool is(std::string_view of, const Plug& plug, int part) const {
        return state != State::none && scope == of && input == plug && component == part;
    }
    /// To be typed in the next frame, from the number that it is.
    void type(std::string_view of, const Plug& plug, int part, double number);
    /// "node.input" of what the hand holds, in a group "group/node.input"; nothing otherwise.
    std::set<std::string> held() const;
};

/// What the timeline makes of an input at the time shown, and how that is changed: by a key there.
struct MovedField {
    std::vector<double> numbers;
    std::vector<float> keys;  ///< where keys are, as shares of the timeline
    float now = 0.0f;         ///< the time shown, the same
    /// The document with these numbers at that time.
    std::function<Graph(const Graph&, const std::vector<double>&)> set;
};

/// What the text says: a number or a constant expression. Error: why not.
Result<double> numberOf(std::string_view text);
/// As short as it is exact to nine digits.
std::string numberText(double number);

/// The numbers of the row's input: as given, else the default's.
std::vector<double> numbersOf(const Row& row);
/// The value with one component replaced, kept within the input's range and whole if it must be.
InputValue withComponent(const Row& row, int component, double number);
/// The words that stand for a value without fields: "position", "a.png", "12 points".
std::string valueText(const Row& row);

/// One field of a row of the node, in this place of the window; `font` at `size` pixels. Keys and mouse are
/// heard of only if `enabled`. Changes go to the document: of what the timeline moves, as keys at the time
/// shown.
void showField(FieldEdit& edit, Document& document, std::string_view scope, const NodeBox& box,
               const Row& row, int component, const Area& place, ImFont* font, float size, bool enabled,
               const MovedField* moved = nullptr);

/// The text of an input for a tooltip: name, type, range, unit, and what it means.
std::string describe(const Row& row);

}  // namespace fw::editor
