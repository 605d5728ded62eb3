#include "editor/timeline/actions.h"

#include <algorithm>
#include <cmath>

#include "editor/document/key_edits.h"
#include "editor/panels/playback.h"
#include "editor/panels/properties.h"

namespace fw::editor {

namespace {

constexpr float kLeastForCurves = 0.45f;  // of the window's height

TimelineState& stateOf(Editor& editor) { return editor.panelState.timelinePanel; }

void applyKeys(Editor& editor, std::string name, KeysEdited edited) {
    editor.document.apply(std::move(name), std::move(edited.graph));
    stateOf(editor).selection = std::move(edited.selection);
}

/// "Delete Key", "Delete Keys".
std::string ofKeys(const Editor& editor, const char* verb) {
    return std::string(verb) + (editor.panelState.timelinePanel.selection.size() == 1 ? " Key" : " Keys");
}

}  // namespace

bool timelineOpen(const Editor& editor) { return editor.panels.timeline; }
bool anyKeys(const Editor& editor) {
    return editor.panels.timeline && !editor.panelState.timelinePanel.selection.empty();
}

void copySelectedKeys(Editor& editor) {
    copyText(editor, copyKeys(editor.document.graph(), stateOf(editor).selection));
}

void deleteSelectedKeys(Editor& editor) {
    editor.document.apply(ofKeys(editor, "Delete"),
                          withoutKeys(editor.document.graph(), stateOf(editor).selection));
    stateOf(editor).selection.clear();
}

void cutSelectedKeys(Editor& editor) {
    copySelectedKeys(editor);
    deleteSelectedKeys(editor);
}

void pasteKeysHere(Editor& editor) {
    const char* text = ImGui::GetClipboardText();
    std::size_t left = 0;
    const std::optional<Moved>& row = stateOf(editor).row;
    Result<KeysEdited> pasted = pasteKeys(editor.document.graph(), text ? text : "", editor.viewport.seconds,
                                          row ? &*row : nullptr, &left);
    if (!pasted) return say(editor, "cannot paste: " + pasted.error().message);
    applyKeys(editor, "Paste Keys", std::move(*pasted));
    if (left > 0)
        say(editor, std::to_string(left) + (left == 1 ? " key was" : " keys were") +
                        " left out: nothing here moves what they moved");
}

void duplicateSelectedKeys(Editor& editor) {
    const Timeline* timeline = timelineOf(editor);
    if (!timeline) return;
    const KeySelection& selection = stateOf(editor).selection;
    const auto [first, last] = selection.span();
    const double later =
        nearestFrame(last - first, timeline->framesPerSecond) + 1.0 / timeline->framesPerSecond;
    applyKeys(editor, ofKeys(editor, "Duplicate"), duplicatedKeys(editor.document.graph(), selection, later));
}

void selectAllKeys(Editor& editor) {
    if (const Timeline* timeline = timelineOf(editor)) stateOf(editor).selection = allKeys(*timeline);
}

void invertKeys(Editor& editor) {
    TimelineState& state = stateOf(editor);
    if (const Timeline* timeline = timelineOf(editor)) state.selection = inverted(state.selection, *timeline);
}

void nudgeKeys(Editor& editor, int frames) {
    const Timeline* timeline = timelineOf(editor);
    if (!timeline) return;
    applyKeys(editor, ofKeys(editor, "Move"),
              retimed(editor.document.graph(), stateOf(editor).selection,
                      {.shift = double(frames) / timeline->framesPerSecond}));
}

void putKeysOnFrames(Editor& editor) {
    const Timeline* timeline = timelineOf(editor);
    if (!timeline) return;
    applyKeys(editor, ofKeys(editor, "Move"),
              retimed(editor.document.graph(), stateOf(editor).selection,
                      {.framesPerSecond = timeline->framesPerSecond}));
}

void goToKey(Editor& editor, int direction) {
    const Timeline* timeline = timelineOf(editor);
    if (!timeline) return;
    const TimelineState& state = stateOf(editor);
    std::vector<double> times;
    for (const Track& track : timeline->tracks)
        if (!state.curves || state.shows(movedBy(track)))
            for (const Key& key : track.keys) times.push_back(key.time);
    if (const auto time = nextTime(std::move(times), editor.viewport.seconds, direction))
        showTime(editor, *time);
}

void goToMarker(Editor& editor, int direction) {
    const Timeline* timeline = timelineOf(editor);
    if (!timeline) return;
    std::vector<double> times;
    for (const Marker& marker : timeline->markers) times.push_back(marker.time);
    if (const auto time = nextTime(std::move(times), editor.viewport.seconds, direction))
        showTime(editor, *time);
}

void addMarkerHere(Editor& editor) {
    const Timeline* timeline = timelineOf(editor);
    if (!timeline) return;
    const double time = editor.viewport.playing
                            ? nearestFrame(editor.viewport.seconds, timeline->framesPerSecond)
                            : editor.viewport.seconds;
    for (const Marker& marker : timeline->markers)
        if (std::abs(marker.time - time) <= kSameTime) {
            stateOf(editor).renames = marker.time;
            return;
        }
    editor.document.apply("Add Marker", addMarker(editor.document.graph(), time, freshMarkerName(*timeline)));
}

void showAllTimes(Editor& editor) {
    TimelineState& state = stateOf(editor);
    state.frameTimes = state.frameValues = true, state.onlySelected = false;
}

void showSelectedTimes(Editor& editor) {
    TimelineState& state = stateOf(editor);
    state.frameTimes = state.frameValues = true, state.onlySelected = true;
}

void toggleCurves(Editor& editor) {
    TimelineState& state = stateOf(editor);
    state.curves = !state.curves;
    if (!state.curves) return;
    state.frameValues = true, state.onlySelected = false;
    editor.panels.low = std::max(editor.panels.low, kLeastForCurves);
}

}  // namespace fw::editor
