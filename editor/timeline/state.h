// What the timeline remembers from one frame to the next: where it looks, what is selected, what is under the
// hand. None of it is of the document.
#pragma once

#include <imgui.h>

#include <string>
#include <vector>

#include "editor/document/key_selection.h"
#include "editor/timeline/time_view.h"

namespace fw::editor {

/// What the button that went down on the timeline does until it goes up. It changes `base`, the document as
/// it was then, so that what is passed over on the way comes back.
struct TimelineHand {
    enum class Does : unsigned char {
        nothing,
        press,  ///< on a key: a click, or the beginning of a move
        box,
        move,
        scale,
        slope,
        pan,
        scrub,
        range,
        marker,
    } does = Does::nothing;
    Hand hand = Hand::none;  ///< of the document
    bool changes = false;    ///< it has changed the document
    ImVec2 begin{0, 0};      ///< pixels
    double time = 0.0;       ///< of what was taken: a key, an edge, a marker, the range's other end
    double value = 0.0;      ///< under the mouse then
    double pivot = 0.0;      ///< the time that a scale leaves where it is
    Graph base;              ///< the document then
    KeySelection selection;  ///< then
    Moved moved;             ///< of the key
    std::size_t component = 0, marker = 0;
    KeySide side = KeySide::out;
    bool adds = false;   ///< to what is selected: Shift or Ctrl was held
    bool alone = false;  ///< a click leaves this key alone selected
    Moved boxed;         ///< the row in which the box began
};

struct TimelineState {
    uint64_t document = 0;  ///< Viewport::document, that all of this is of
    uint64_t revision = 0;  ///< of the document, that the selection is of
    TimeView view;
    ValueView values;
    bool frameTimes = true, frameValues = true;  ///< with the next frame
    bool onlySelected = false;                   ///< of what is then framed
    bool curves = false;                         ///< rather than rows
    bool frames = false;                         ///< times are said as frames, rather than seconds
    float scroll = 0.0f, scrolled = 0.0f;        ///< of the rows, pixels: as it is, and as the names have it
    KeySelection selection;
    std::optional<Moved> row;   ///< the row that was chosen last
    std::vector<Moved> hidden;  ///< whose curves are not shown
    TimelineHand hand;

    double menuTime = 0.0;         ///< where a menu was opened, seconds
    std::optional<Moved> menuRow;  ///< in which row
    std::size_t menuMarker = 0;
    bool opensRowMenu = false;
    std::optional<Plug> fieldMenu;  ///< the input whose keys a menu on the canvas is of
    double renames = -1.0;          ///< the time of the marker that is to be renamed; none below 0

    bool shows(const Moved& moved) const;
};

/// The keys in a box: in the rows from the first to the last, between two times.
KeySelection keysInRows(const Timeline& timeline, std::size_t first, std::size_t last, double from,
                        double to);
/// The keys with a value in the box of the shown curves.
KeySelection keysInCurves(const Timeline& timeline, const TimelineState& state, double from, double to,
                          double lo, double hi);
/// The key of the track nearest to the time, within `reach` seconds.
std::optional<std::size_t> keyNear(const Track& track, double time, double reach);
/// Where the keys' values lie: least and most of the shown curves, or of what is selected of them alone.
std::optional<std::pair<double, double>> valuesShown(const Timeline& timeline, const TimelineState& state);
/// The next key's or marker's time after `time`, or the one before for -1; none beyond the last.
std::optional<double> nextTime(std::vector<double> times, double time, int direction);

}  // namespace fw::editor
