#include "editor/panels/playback.h"

#include <algorithm>
#include <cmath>

#include "editor/panels/properties.h"

namespace fw::editor {

namespace {

/// The part of the timeline that is played over and over; none if all of it is.
std::optional<TimeRange> rangeOf(const Timeline& timeline) {
    if (!timeline.range) return std::nullopt;
    const TimeRange range{std::max(timeline.range->from, 0.0), std::min(timeline.range->to, timeline.length)};
    return range.from < range.to ? std::optional(range) : std::nullopt;
}

}  // namespace

double playedTime(const Timeline& timeline, double seconds) {
    if (const auto range = rangeOf(timeline)) {
        const double length = range->to - range->from, past = seconds - range->from;
        return past < length ? seconds : range->from + past - length * std::floor(past / length);
    }
    Timeline bar;
    bar.length = timeline.length, bar.loop = timeline.loop;
    return timelineTime(bar, seconds);
}

void playOn(Editor& editor) {
    Viewport& view = editor.viewport;
    if (!view.playing) return;
    const Timeline* timeline = timelineOf(editor);
    if (!timeline) {
        view.playing = false;
        return;
    }
    editor.panelState.played += double(ImGui::GetIO().DeltaTime);
    view.seconds = playedTime(*timeline, editor.panelState.played);
    if (timeline->loop == Loop::once && !rangeOf(*timeline) && view.seconds >= timeline->length)
        view.playing = false;
}

void togglePlay(Editor& editor) {
    Viewport& view = editor.viewport;
    view.playing = !view.playing;
    const Timeline* timeline = timelineOf(editor);
    if (!view.playing || !timeline) return;
    const std::optional<TimeRange> range = rangeOf(*timeline);
    const bool atEnd = view.seconds >= (range ? range->to : timeline->length);
    editor.panelState.played = !atEnd ? view.seconds : range ? range->from : 0.0;
}

void showTime(Editor& editor, double seconds) {
    editor.viewport.seconds = std::max(seconds, 0.0);
    editor.panelState.played = editor.viewport.seconds;
}

}  // namespace fw::editor
