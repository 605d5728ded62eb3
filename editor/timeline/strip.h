// The part of the timeline with times across it: ruler, markers, the bar of the selection, and below them
// rows of keys or curves.
//
//     mouse                          does
//     drag in the ruler              scrubs; with Ctrl marks the range that is played, a click takes it away
//     click, drag on a marker        goes there; moves it; a double click renames it
//     click, drag on a key           selects it (Shift adds, Ctrl adds or takes away); moves what is selected
//     drag in an empty place         selects by a box
//     the bar above the keys         moves what is selected, its ends scale (Shift: about the time shown)
//     double click                   adds a key
//     drag on a tangent              turns it (Alt: this side alone)
//     wheel, middle drag             zooms time to the cursor (Ctrl: values); pans (also by Shift or
//     sideways) right click                    menu of keys, of a row, of the ruler
//
// A drag goes from frame to frame and catches on markers; with Alt it goes freely, and Escape takes it back.
// All in ImGui's current window. Lifetime: a Strip is of one frame.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "editor/document/key_edits.h"
#include "editor/editor.h"

namespace fw::editor {

/// What is shown in this frame, and where.
struct Strip {
    Editor& editor;
    const Timeline& timeline;  ///< of the document as it is until the frame's end: edits wait in `later`
    TimelineState& state;
    Area ruler = {}, markers = {}, bar = {}, body = {};     ///< pixels, one below the other
    float high = 20.0f;                                     ///< of a row
    bool hovered = false, active = false, pressed = false;  ///< of the item that takes the mouse
    std::vector<std::function<void()>> later = {};          ///< done when all is drawn

    const Graph& graph() const { return editor.document.graph(); }
    float scale() const { return editor.shell.scale(); }
    /// Seconds that are `pixels` of the interface wide.
    double seconds(float pixels) const { return double(pixels * scale()) * state.view.perPixel(); }
    /// The top of a row, and the row at a place; beyond the last if there is none.
    float rowTop(std::size_t row) const { return body.lo.y + float(row) * high - state.scroll; }
    std::size_t rowAt(float y) const;
    /// The time where the mouse is, on a frame unless Alt is held, within the timeline.
    double timeUnderMouse() const;
    std::vector<double> markerTimes() const;
};

/// What is at a place of the body.
struct StripHit {
    enum class What : unsigned char { nothing, key, slope } what = What::nothing;
    std::size_t track = 0, key = 0, component = 0;
    KeySide side = KeySide::out;
};

/// The ruler with the range and the time shown, the markers, the bar of the selection.
void drawRuler(const Strip& strip);
void drawMarkers(const Strip& strip);
void drawBar(const Strip& strip);
/// A line down through all at the time shown, and where the timeline ends.
void drawTimes(const Strip& strip);

void drawRows(const Strip& strip, const StripHit& hit);
StripHit hitRows(const Strip& strip, ImVec2 at);

void drawCurves(const Strip& strip, const StripHit& hit);
StripHit hitCurves(const Strip& strip, ImVec2 at);

/// Which marker is at a place; none if there is none.
std::optional<std::size_t> markerAt(const Strip& strip, ImVec2 at);
/// What of the bar is under the mouse.
enum class BarPart : unsigned char { nothing, first, last, middle };
BarPart barAt(const Strip& strip, ImVec2 at);

/// What the mouse does. `hit` is what is under it in the body.
void followHand(Strip& strip, const StripHit& hit);
/// The menus, where they are open, and the name of a marker that is being typed.
void showStripMenus(Strip& strip);

/// A key as it looks everywhere.
void drawDiamond(ImDrawList* list, ImVec2 centre, float radius, ImU32 fill, ImU32 edge);

}  // namespace fw::editor
