// Text under edit: lines, a cursor with a selection, and a history of its own. A plain value that knows
// neither windows nor what the text means.
//
// Every change goes through replace(), which the history records. Changes of one step are undone together:
// letters of a word typed without a rest are one step, whatever else a key does is one. Positions are bytes
// of UTF-8, always between characters.
#pragma once

#include <compare>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

namespace fw::editor::code {

inline constexpr int kTabWidth = 4;                  ///< columns
inline constexpr std::size_t kMostChanges = 20'000;  ///< that are remembered

/// A place between two characters.
struct Spot {
    int line = 0, byte = 0;
    auto operator<=>(const Spot&) const = default;
};

struct Range {
    Spot from, to;
    bool empty() const { return from == to; }
};

/// Lines that took the place of others: for whoever keeps something by lines.
struct Splice {
    int line = 0, removed = 0, added = 0;
};

struct Text {
    std::vector<std::string> lines = {""};  ///< at least one
    Spot cursor, anchor;                    ///< what lies between them is selected
    int wanted = -1;                        ///< column that up and down keep to; -1: that of the cursor
    uint64_t version = 1;                   ///< another after each change
    std::deque<Splice> splices = {};        ///< the last ones; the last of all led to `version`

    bool selects() const { return cursor != anchor; }
    Range selection() const { return cursor < anchor ? Range{cursor, anchor} : Range{anchor, cursor}; }

    struct Change {
        Spot at;
        std::string removed, added;
        Spot cursor, anchor;  ///< before it
        int step = 0;
    };
    std::vector<Change> changes = {};
    std::size_t done = 0;  ///< changes that are not undone
    int step = 0;
    enum class Typing : unsigned char { none, letters, others, erasing } typing = Typing::none;
    double typed = 0.0;  ///< seconds, when something was typed last
    Spot typedTo;        ///< where the cursor was then
};

/// Without carriage returns.
Text textOf(std::string_view string);
std::string stringOf(const Text& text);
/// Whether stringOf() is this, without making it.
bool is(const Text& text, std::string_view string);
std::string stringOf(const Text& text, Range range);

/// The end of the text; the nearest spot that is in it, between two characters.
Spot endOf(const Text& text);
Spot clamped(const Text& text, Spot spot);
/// The characters next to a spot; line ends are characters.
Spot before(const Text& text, Spot spot);
Spot after(const Text& text, Spot spot);

/// Columns of a fixed width up to the spot: tabs go to the next multiple of kTabWidth.
int columnOf(const Text& text, Spot spot);
/// The spot of a line that is nearest to a column; fractions are rounded.
Spot spotAt(const Text& text, int line, float column);
/// Byte of the whole text, and back.
std::size_t offsetOf(const Text& text, Spot spot);
Spot spotOf(const Text& text, std::size_t offset);
/// Of a 1-based line and column in characters, as errors have it; clamped.
Spot spotOfPlace(const Text& text, int line, int column);

/// What follows is another step of undo.
void newStep(Text& text);
/// Puts `with` in place of the range; the cursor stands behind it. Where that ends.
Spot replace(Text& text, Range range, std::string_view with);
/// Puts the cursor there, and the other end of the selection too unless `selecting`.
void place(Text& text, Spot spot, bool selecting = false);

/// One step back or forward; false if there is none.
bool undo(Text& text);
bool redo(Text& text);

}  // namespace fw::editor::code
