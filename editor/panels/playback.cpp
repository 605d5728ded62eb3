#include "editor/panels/playback.h"

#include <algorithm>

#include "editor/panels/properties.h"

namespace fw::editor {

namespace {

/// The time on the bar after so many seconds of play. It wraps even where nothing but the `time` node moves.
double timeOnBar(const Timeline& timeline, double seconds) {
    Timeline bar = timeline;
    bar.endless = false;
    return timelineTime(bar, seconds);
}

}  // namespace

void playOn(Editor& editor) {
    Viewport& view = editor.viewport;
    if (!view.playing) return;
    const Timeline* timeline = timelineOf(editor);
    if (!timeline) {
        view.playing = false;
        return;
    }
    editor.panelState.played += double(ImGui::GetIO().DeltaTime);
    view.seconds = timeOnBar(*timeline, editor.panelState.played);
    if (timeline->loop == Loop::once && view.seconds >= timeline->length) view.playing = false;
}

void togglePlay(Editor& editor) {
    Viewport& view = editor.viewport;
    view.playing = !view.playing;
    const Timeline* timeline = timelineOf(editor);
    if (!view.playing || !timeline) return;
    const bool atEnd = view.seconds >= timeline->length;
    editor.panelState.played = atEnd ? 0.0 : view.seconds;
}

void showTime(Editor& editor, double seconds) {
    editor.viewport.seconds = std::max(seconds, 0.0);
    editor.panelState.played = editor.viewport.seconds;
}

bool deletesKey(const Editor& editor) {
    const PanelState& state = editor.panelState;
    return state.track && state.key && state.timelineFrame == ImGui::GetFrameCount() - 1;
}

void removeSelectedKey(Editor& editor) {
    PanelState& state = editor.panelState;
    if (!state.track || !state.key) return;
    editor.document.apply("Remove Key", removeKey(editor.document.graph(), *state.track, *state.key));
    state.key.reset();
}

}  // namespace fw::editor
