// The values of inputs edited where they stand: numbers (controls/number.h), switches and choices, on a node
// of the canvas and in the inspector alike. Ctrl+click gives back the default.
#pragma once

#include <imgui.h>

#include <functional>
#include <optional>
#include <string>

#include "editor/canvas/boxes.h"
#include "editor/controls/number.h"
#include "graph/library/units.h"

namespace fw::editor {

/// What tells the input's numbers from others: "group/node.input".
std::string inputPath(std::string_view scope, const Plug& input);
/// What the timeline makes of an input at the time shown, and how that is changed: by a key there.
struct MovedField {
    std::vector<double> numbers;
    std::vector<float> keys;  ///< where keys are, as shares of the timeline
    float now = 0.0f;         ///< the time shown, the same
    /// The document with these numbers at that time.
    std::function<Graph(const Graph&, const std::vector<double>&)> set;
};

/// The numbers of the row's input: as given, else the default's.
std::vector<double> numbersOf(const Row& row);
/// What they may be; `start` is where a drag of one begins.
NumberRange rangeOf(const Row& row, double start);
/// The words that stand for a value without fields: "position", "a.png", "12 points".
std::string valueText(const Row& row);
/// The numbers of a list, entry by entry; none if it is no list.
std::vector<double> entriesOf(const Row& row);

/// One field of a row of the node. Changes go to the document: of what the timeline moves, as keys at the
/// time shown. Whether a number was entered with Shift: the next node is wanted.
bool showField(NumberHand& hand, Document& document, std::string_view scope, const NodeBox& box,
               const Row& row, int component, const NumberLook& look, const MovedField* moved = nullptr);
/// Begins to type a number of the node.
void typeField(NumberHand& hand, Document& document, std::string_view scope, const NodeBox& box,
               const Row& row, int component);

/// The text of an input for a tooltip: name, type, unit, range, and what it means.
std::string describe(const Row& row, const LengthUnit& lengths);

}  // namespace fw::editor
