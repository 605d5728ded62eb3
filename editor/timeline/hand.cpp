// What the mouse does on the strip of times.
#include <algorithm>
#include <cmath>

#include "editor/panels/playback.h"
#include "editor/panels/properties.h"
#include "editor/shell/theme.h"
#include "editor/timeline/strip.h"

namespace fw::editor {

namespace {

using Does = TimelineHand::Does;
using What = StripHit::What;

constexpr float kStillHand = 3.0f;  // pixels that a click may move
constexpr float kCatches = 5.0f;    // pixels of the interface from which a marker catches
constexpr float kRangeGrip = 5.0f;  // the same, of the ends of the range
constexpr double kLeastFactor = 0.01;

bool wentFar(const TimelineHand& hand) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    return std::hypot(mouse.x - hand.begin.x, mouse.y - hand.begin.y) > kStillHand;
}

/// The time that the hand brings what it has taken to.
double broughtTo(const Strip& strip, double taken) {
    const TimelineHand& hand = strip.state.hand;
    const double by = double(ImGui::GetIO().MousePos.x - hand.begin.x) * strip.state.view.perPixel();
    return std::max(snappedTime(taken + by, strip.timeline.framesPerSecond, strip.markerTimes(),
                                strip.seconds(kCatches), ImGui::GetIO().KeyAlt),
                    0.0);
}

void take(Strip& strip, Does does) {
    TimelineHand& hand = strip.state.hand;
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    hand = {};
    hand.does = does;
    hand.hand = strip.editor.document.begin("");
    hand.begin = mouse;
    hand.value = strip.state.values.value(mouse.y);
    hand.adds = ImGui::GetIO().KeyShift || ImGui::GetIO().KeyCtrl;
    hand.base = strip.graph();
    hand.selection = strip.state.selection;
}

void pressKey(Strip& strip, const StripHit& hit) {
    const Track& track = strip.timeline.tracks[hit.track];
    const Moved moved = movedBy(track);
    const double time = track.keys[hit.key].time;
    TimelineState& state = strip.state;
    take(strip, Does::press);
    state.row = moved;
    state.hand.moved = moved, state.hand.time = time, state.hand.component = hit.component;
    if (hit.what == What::slope) {
        state.hand.does = Does::slope;
        state.hand.side = hit.side;
        return;
    }
    const bool there = state.selection.contains(moved, time);
    if (ImGui::GetIO().KeyCtrl) {
        state.selection.toggle(moved, time);
        if (there) state.hand.does = Does::nothing;  // it was let go of
    } else if (!there) {
        if (!ImGui::GetIO().KeyShift) state.selection.clear();
        state.selection.add(moved, time);
    } else {
        state.hand.alone = !ImGui::GetIO().KeyShift;
    }
    state.hand.selection = state.selection;
}

void pressBar(Strip& strip, BarPart part) {
    take(strip, part == BarPart::middle ? Does::move : Does::scale);
    const auto [first, last] = strip.state.selection.span();
    strip.state.hand.time = part == BarPart::last ? last : first;
    strip.state.hand.pivot = part == BarPart::last ? first : last;
}

void pressRuler(Strip& strip) {
    const ImGuiIO& io = ImGui::GetIO();
    if (strip.timeline.range && !io.KeyCtrl) {
        // Its ends, where the band above shows them.
        const auto near = [&](double time) {
            return std::abs(strip.state.view.x(time) - io.MousePos.x) <= kRangeGrip * strip.scale();
        };
        const auto [from, to] = *strip.timeline.range;
        const bool high = io.MousePos.y < strip.ruler.lo.y + 0.45f * strip.ruler.height();
        if (high && (near(from) || near(to))) {
            take(strip, Does::range);
            strip.state.hand.time = near(to) ? from : to;
            return;
        }
    }
    take(strip, io.KeyCtrl ? Does::range : Does::scrub);
    strip.state.hand.time = strip.timeUnderMouse();
}

void addKey(Strip& strip, std::size_t row) {
    const Track& track = strip.timeline.tracks[row];
    const Moved moved = movedBy(track);
    const double time = std::min(strip.timeUnderMouse(), strip.timeline.length);
    const std::vector<double> value = evaluate(track, time);
    strip.later.push_back([&editor = strip.editor, &state = strip.state, moved, time, value] {
        editor.document.apply("Add Key", setKey(editor.document.graph(), moved, time, value));
        state.selection.clear();
        state.selection.add(moved, time);
        state.row = moved;
    });
}

/// The row whose curve is nearest to the mouse.
std::optional<std::size_t> curveUnderMouse(const Strip& strip) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    std::optional<std::size_t> nearest;
    float best = 1e9f;
    for (std::size_t row = 0; row < strip.timeline.tracks.size(); ++row) {
        const Track& track = strip.timeline.tracks[row];
        if (!strip.state.shows(movedBy(track))) continue;
        for (double value : evaluate(track, strip.state.view.time(mouse.x)))
            if (const float off = std::abs(strip.state.values.y(value) - mouse.y); off < best)
                best = off, nearest = row;
    }
    return nearest;
}

void doubleClick(Strip& strip, const StripHit& hit) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    if (const auto marker = markerAt(strip, mouse)) {
        strip.state.renames = strip.timeline.markers[*marker].time;
        strip.state.hand = {};
        return;
    }
    if (!strip.body.contains(mouse) || hit.what != What::nothing) return;
    const std::optional<std::size_t> row =
        strip.state.curves ? curveUnderMouse(strip) : std::optional(strip.rowAt(mouse.y));
    if (row && *row < strip.timeline.tracks.size()) addKey(strip, *row);
    strip.state.hand = {};
}

void press(Strip& strip, const StripHit& hit) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    TimelineState& state = strip.state;
    if (ImGui::IsMouseClicked(2)) return take(strip, Does::pan);
    if (!ImGui::IsMouseClicked(0)) return;
    // Of a quick hand the second press may be a drag of what it has let go of just now.
    const bool bare = strip.body.contains(mouse) && hit.what == What::nothing;
    if (ImGui::IsMouseDoubleClicked(0) && (bare || markerAt(strip, mouse))) return doubleClick(strip, hit);
    if (strip.ruler.contains(mouse)) return pressRuler(strip);
    if (const auto marker = markerAt(strip, mouse)) {
        take(strip, Does::marker);
        state.hand.marker = *marker;
        state.hand.time = strip.timeline.markers[*marker].time;
        return;
    }
    if (const BarPart part = barAt(strip, mouse); part != BarPart::nothing) return pressBar(strip, part);
    if (hit.what != What::nothing) return pressKey(strip, hit);
    if (!strip.body.contains(mouse)) return;
    take(strip, Does::box);
    if (const std::size_t row = strip.rowAt(mouse.y); !state.curves && row < strip.timeline.tracks.size())
        state.row = movedBy(strip.timeline.tracks[row]);
    if (!state.hand.adds) state.selection.clear();
}

void dragBox(Strip& strip) {
    TimelineHand& hand = strip.state.hand;
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    if (!wentFar(hand)) return;
    Area box{hand.begin, hand.begin};
    box.add(mouse);
    const TimeView& view = strip.state.view;
    const KeySelection found =
        strip.state.curves
            ? keysInCurves(strip.timeline, strip.state, view.time(box.lo.x), view.time(box.hi.x),
                           strip.state.values.value(box.hi.y), strip.state.values.value(box.lo.y))
            : keysInRows(strip.timeline, box.lo.y < strip.body.lo.y ? 0 : strip.rowAt(box.lo.y),
                         strip.rowAt(box.hi.y), view.time(box.lo.x), view.time(box.hi.x));
    strip.state.selection = hand.adds ? joined(hand.selection, found) : found;
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddRectFilled(box.lo, box.hi, ImGui::GetColorU32(ImGuiCol_CheckMark, 0.16f));
    list->AddRect(box.lo, box.hi, themeColor(ThemeColor::selected));
}

/// What the drag makes of the document that it began with, and where its keys are then.
KeysEdited dragged(const Strip& strip) {
    const TimelineHand& hand = strip.state.hand;
    const ImGuiIO& io = ImGui::GetIO();
    if (hand.does == Does::scale) {
        const double pivot = io.KeyShift ? strip.editor.viewport.seconds : hand.pivot,
                     arm = hand.time - pivot, to = broughtTo(strip, hand.time) - pivot;
        const double factor = std::abs(arm) < kSameTime ? 1.0 : std::max(to / arm, kLeastFactor);
        return retimed(hand.base, hand.selection,
                       {.pivot = pivot,
                        .factor = factor,
                        .framesPerSecond = io.KeyAlt ? 0.0 : strip.timeline.framesPerSecond});
    }
    ImVec2 by(io.MousePos.x - hand.begin.x, io.MousePos.y - hand.begin.y);
    const bool rises = strip.state.curves && !strip.bar.contains(hand.begin);
    // With Shift in one direction alone.
    if (rises && io.KeyShift) (std::abs(by.x) < std::abs(by.y) ? by.x : by.y) = 0.0f;
    const double shift = by.x == 0.0f ? 0.0 : broughtTo(strip, hand.time) - hand.time;
    const double higher = rises ? double(-by.y) * strip.state.values.perPixel() : 0.0;
    const Graph base = higher != 0.0 ? raised(hand.base, hand.selection, hand.component, higher) : hand.base;
    return retimed(base, hand.selection, {.shift = shift});
}

/// The slope from the key to the mouse.
Graph turned(const Strip& strip) {
    const TimelineHand& hand = strip.state.hand;
    const Result<Timeline> base = readTimeline(hand.base);
    const auto track = base ? trackOf(*base, hand.moved) : std::nullopt;
    const auto key = track ? keyAt(base->tracks[*track], hand.time) : std::nullopt;
    if (!key) return hand.base;
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const double value = base->tracks[*track].keys[*key].value[hand.component],
                 least = strip.seconds(2.0f);  // else it would stand upright
    double along = strip.state.view.time(mouse.x) - hand.time;
    along = hand.side == KeySide::out ? std::max(along, least) : std::min(along, -least);
    const double slope = (strip.state.values.value(mouse.y) - value) / along;
    return setSlope(hand.base, hand.moved, hand.time, hand.component, hand.side, slope,
                    ImGui::GetIO().KeyAlt);
}

std::string nameOfDrag(const TimelineHand& hand) {
    switch (hand.does) {
        case Does::scale: return "Scale Keys";
        case Does::slope: return "Set Tangent";
        case Does::marker: return "Move Marker";
        case Does::range: return "Set Range";
        default: return hand.selection.size() == 1 ? "Move Key" : "Move Keys";
    }
}

/// What the document becomes as the drag goes on.
Graph draggedGraph(Strip& strip) {
    TimelineState& state = strip.state;
    const TimelineHand& hand = state.hand;
    if (hand.does == Does::slope) return turned(strip);
    if (hand.does == Does::marker) {
        const double by = double(ImGui::GetIO().MousePos.x - hand.begin.x) * state.view.perPixel();
        return moveMarker(hand.base, hand.marker,
                          std::max(snappedTime(hand.time + by, strip.timeline.framesPerSecond, {}, 0.0,
                                               ImGui::GetIO().KeyAlt),
                                   0.0));
    }
    if (hand.does == Does::range) {
        const double other = strip.timeUnderMouse();
        return setRange(hand.base, TimeRange{std::min(hand.time, other), std::max(hand.time, other)});
    }
    KeysEdited edited = dragged(strip);
    state.selection = std::move(edited.selection);
    state.revision = 0;  // of the document that it will be
    return std::move(edited.graph);
}

/// A drag that changes the document, or nothing of the kind.
void followDrag(Strip& strip) {
    TimelineHand& hand = strip.state.hand;
    Document& document = strip.editor.document;
    const ImVec2 by = ImGui::GetIO().MouseDelta;
    const bool edits = hand.does == Does::move || hand.does == Does::scale || hand.does == Does::slope ||
                       hand.does == Does::marker || hand.does == Does::range;
    if (!edits || !strip.active || !wentFar(hand) || (by.x == 0.0f && by.y == 0.0f)) return;
    if (!std::exchange(hand.changes, true)) hand.hand = document.begin(nameOfDrag(hand));
    document.update(hand.hand, draggedGraph(strip));
}

void release(Strip& strip) {
    TimelineState& state = strip.state;
    TimelineHand& hand = state.hand;
    const bool still = !wentFar(hand);
    strip.editor.document.end(hand.hand);
    if (hand.does == Does::press && still && hand.alone) {
        state.selection.clear();
        state.selection.add(hand.moved, hand.time);
    }
    if (hand.does == Does::marker && still) showTime(strip.editor, hand.time);
    if (hand.does == Does::range && still && strip.timeline.range && hand.adds)
        strip.later.push_back([&editor = strip.editor] {
            editor.document.apply("Clear Range", setRange(editor.document.graph(), std::nullopt));
        });
    hand = {};
}

void wheel(Strip& strip) {
    const ImGuiIO& io = ImGui::GetIO();
    TimelineState& state = strip.state;
    constexpr float kNotchPixels = 60.0f;
    if (io.MouseWheelH != 0.0f) state.view.pan(double(io.MouseWheelH * kNotchPixels * strip.scale()));
    if (io.MouseWheel == 0.0f) return;
    if (io.KeyShift)
        state.view.pan(double(io.MouseWheel * kNotchPixels * strip.scale()));
    else if (io.KeyCtrl && state.curves)
        state.values.zoom(double(io.MouseWheel), io.MousePos.y);
    else if (io.KeyCtrl)
        state.scroll -= io.MouseWheel * strip.high;
    else
        state.view.zoom(double(io.MouseWheel), io.MousePos.x);
}

}  // namespace

void followHand(Strip& strip, const StripHit& hit) {
    TimelineHand& hand = strip.state.hand;
    const ImGuiIO& io = ImGui::GetIO();
    if (hand.does != Does::nothing && !strip.editor.document.hold(hand.hand)) hand = {};
    if (strip.hovered) wheel(strip);
    if (strip.pressed && hand.does == Does::nothing) press(strip, hit);
    if (hand.does == Does::press && wentFar(hand) && strip.active) hand.does = Does::move;
    if (hand.does == Does::nothing) return;
    // ImGui lets go of what is active as Escape goes down, which is no end of the drag.
    if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) {
        if (hand.changes || hand.does == Does::box) strip.state.selection = hand.selection;
        strip.editor.document.cancel(std::exchange(hand, {}).hand);
        return;
    }
    followDrag(strip);
    if (hand.does == Does::scrub)
        showTime(strip.editor, std::min(strip.timeUnderMouse(), strip.timeline.length));
    if (hand.does == Does::box) dragBox(strip);
    if (hand.does == Does::pan) {
        strip.state.view.pan(double(io.MouseDelta.x));
        if (strip.state.curves)
            strip.state.values.pan(double(io.MouseDelta.y));
        else
            strip.state.scroll -= io.MouseDelta.y;
    }
    if (!strip.active) release(strip);
}

}  // namespace fw::editor
