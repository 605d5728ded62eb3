// The menus of keys, of a row and of the ruler, and the name of a marker that is being typed.
#include <cmath>

#include "editor/panels/playback.h"
#include "editor/panels/properties.h"
#include "editor/timeline/actions.h"
#include "editor/timeline/strip.h"

namespace fw::editor {

namespace {

constexpr std::pair<TangentChoice, const char*> kTangentChoices[] = {{TangentChoice::automatic, "Automatic"},
                                                                     {TangentChoice::flat, "Flat"},
                                                                     {TangentChoice::linear, "Linear"},
                                                                     {TangentChoice::unified, "Unified"},
                                                                     {TangentChoice::broken, "Broken"}};

/// The first key that is selected, whose choices the menu marks.
const Key* firstSelected(const Strip& strip) {
    if (strip.state.selection.empty()) return nullptr;
    const SelectedKeys& first = strip.state.selection.tracks[0];
    const auto track = trackOf(strip.timeline, first.moved);
    const auto key = track ? keyAt(strip.timeline.tracks[*track], first.times[0]) : std::nullopt;
    return key ? &strip.timeline.tracks[*track].keys[*key] : nullptr;
}

void editLater(Strip& strip, std::string name, std::function<Graph(const Graph&, const KeySelection&)> edit) {
    strip.later.push_back([&editor = strip.editor, &state = strip.state, name = std::move(name), edit] {
        editor.document.apply(name, edit(editor.document.graph(), state.selection));
    });
}

void runLater(Strip& strip, void (*run)(Editor&)) {
    strip.later.push_back([&editor = strip.editor, run] { run(editor); });
}

void showChoices(Strip& strip) {
    const Key* key = firstSelected(strip);
    if (!key) return;
    if (ImGui::BeginMenu("Interpolation")) {
        for (std::size_t i = 0; i < interpolationNames().size(); ++i)
            if (ImGui::MenuItem(readable(interpolationNames()[i]).c_str(), nullptr,
                                std::size_t(key->interpolation) == i))
                editLater(strip, "Set Interpolation", [i](const Graph& graph, const KeySelection& selection) {
                    return setInterpolations(graph, selection, Interpolation(i));
                });
        ImGui::EndMenu();
    }
    if (ImGui::BeginMenu("Ease")) {
        for (std::size_t i = 0; i < easeNames().size(); ++i)
            if (ImGui::MenuItem(readable(easeNames()[i]).c_str(), nullptr, std::size_t(key->ease) == i))
                editLater(strip, "Set Ease", [i](const Graph& graph, const KeySelection& selection) {
                    return setEases(graph, selection, Ease(i));
                });
        ImGui::EndMenu();
    }
    if (ImGui::BeginMenu("Tangents")) {
        for (const auto& [choice, name] : kTangentChoices)
            if (ImGui::MenuItem(name, nullptr, tangentsOf(*key) == choice))
                editLater(strip, "Set Tangents",
                          [choice = choice](const Graph& graph, const KeySelection& selection) {
                              return setTangents(graph, selection, choice);
                          });
        ImGui::EndMenu();
    }
}

void showKeyMenu(Strip& strip) {
    if (!ImGui::BeginPopup("##keymenu")) return;
    const bool any = !strip.state.selection.empty();
    if (ImGui::MenuItem("Cut keys", "Ctrl+X", false, any)) runLater(strip, cutSelectedKeys);
    if (ImGui::MenuItem("Copy keys", "Ctrl+C", false, any)) runLater(strip, copySelectedKeys);
    if (ImGui::MenuItem("Paste keys", "Ctrl+V")) runLater(strip, pasteKeysHere);
    if (ImGui::MenuItem("Duplicate keys", "Ctrl+D", false, any)) runLater(strip, duplicateSelectedKeys);
    if (ImGui::MenuItem("Delete keys", "Delete", false, any)) runLater(strip, deleteSelectedKeys);
    ImGui::Separator();
    showChoices(strip);
    if (ImGui::MenuItem("Onto whole frames", nullptr, false, any)) runLater(strip, putKeysOnFrames);
    ImGui::EndPopup();
}

void showRowMenu(Strip& strip) {
    if (!ImGui::BeginPopup("##rowmenu")) return;
    TimelineState& state = strip.state;
    const auto row = state.menuRow ? trackOf(strip.timeline, *state.menuRow) : std::nullopt;
    if (!row) {
        ImGui::CloseCurrentPopup();
        return ImGui::EndPopup();
    }
    const Moved moved = *state.menuRow;
    const Track& track = strip.timeline.tracks[*row];
    ImGui::TextDisabled("%s", nameOf(strip.graph(), moved).c_str());
    if (ImGui::MenuItem("Add key here")) {
        const double time = state.menuTime;
        const std::vector<double> value = evaluate(track, time);
        strip.later.push_back([&editor = strip.editor, moved, time, value] {
            editor.document.apply("Add Key", setKey(editor.document.graph(), moved, time, value));
        });
    }
    if (ImGui::MenuItem("Select its keys")) {
        state.selection.clear();
        for (const Key& key : track.keys) state.selection.add(moved, key.time);
    }
    if (ImGui::MenuItem("Paste keys", "Ctrl+V")) {
        state.row = moved;
        runLater(strip, pasteKeysHere);
    }
    if (state.curves) {
        ImGui::Separator();
        if (ImGui::MenuItem("Show this curve alone")) {
            state.hidden.clear();
            for (const Track& other : strip.timeline.tracks)
                if (movedBy(other) != moved) state.hidden.push_back(movedBy(other));
            state.frameValues = true, state.onlySelected = false;
        }
        if (ImGui::MenuItem("Show all curves", nullptr, false, !state.hidden.empty())) state.hidden.clear();
    }
    ImGui::Separator();
    if (ImGui::MenuItem("Remove track"))
        strip.later.push_back([&editor = strip.editor, moved] {
            const Result<Timeline> now = readTimeline(editor.document.graph());
            if (const auto at = now ? trackOf(*now, moved) : std::nullopt)
                editor.document.apply("Remove Track", removeTrack(editor.document.graph(), *at));
        });
    ImGui::EndPopup();
}

void showRulerMenu(Strip& strip) {
    if (!ImGui::BeginPopup("##rulermenu")) return;
    const double time = strip.state.menuTime;
    const auto edit = [&](const char* name, std::function<Graph(const Graph&)> next) {
        strip.later.push_back([&editor = strip.editor, name, next] {
            editor.document.apply(name, next(editor.document.graph()));
        });
    };
    const std::optional<TimeRange> range = strip.timeline.range;
    if (ImGui::MenuItem("Add marker here"))
        edit("Add Marker", [time, name = freshMarkerName(strip.timeline)](const Graph& graph) {
            return addMarker(graph, time, name);
        });
    ImGui::Separator();
    if (ImGui::MenuItem("Play from here on", nullptr, false,
                        time < (range ? range->to : strip.timeline.length)))
        edit("Set Range", [time, to = range ? range->to : strip.timeline.length](const Graph& graph) {
            return setRange(graph, TimeRange{time, to});
        });
    if (ImGui::MenuItem("Play up to here", nullptr, false, time > (range ? range->from : 0.0)))
        edit("Set Range", [time, from = range ? range->from : 0.0](const Graph& graph) {
            return setRange(graph, TimeRange{from, time});
        });
    if (ImGui::MenuItem("Play all", nullptr, false, range.has_value()))
        edit("Clear Range", [](const Graph& graph) { return setRange(graph, std::nullopt); });
    ImGui::Separator();
    if (ImGui::MenuItem("Frames", nullptr, strip.state.frames)) strip.state.frames = true;
    if (ImGui::MenuItem("Seconds and frames", nullptr, !strip.state.frames)) strip.state.frames = false;
    ImGui::EndPopup();
}

void showMarkerMenu(Strip& strip) {
    if (!ImGui::BeginPopup("##markermenu")) return;
    const std::size_t marker = strip.state.menuMarker;
    if (marker >= strip.timeline.markers.size()) {
        ImGui::CloseCurrentPopup();
        return ImGui::EndPopup();
    }
    const double time = strip.timeline.markers[marker].time;
    ImGui::TextDisabled("%s", strip.timeline.markers[marker].name.c_str());
    if (ImGui::MenuItem("Go to it")) showTime(strip.editor, time);
    if (ImGui::MenuItem("Rename …")) strip.state.renames = time;
    if (ImGui::MenuItem("Remove marker"))
        strip.later.push_back([&editor = strip.editor, marker] {
            editor.document.apply("Remove Marker", removeMarker(editor.document.graph(), marker));
        });
    ImGui::EndPopup();
}

/// The field that a marker's name is typed into, where it is wished.
void showMarkerName(Strip& strip) {
    constexpr const char* kPopup = "##markername";
    TimelineState& state = strip.state;
    if (state.renames >= 0.0) {
        state.menuMarker = strip.timeline.markers.size();
        for (std::size_t i = 0; i < strip.timeline.markers.size(); ++i)
            if (std::abs(strip.timeline.markers[i].time - state.renames) <= kSameTime) state.menuMarker = i;
        state.renames = -1.0;
        if (state.menuMarker < strip.timeline.markers.size()) {
            ImGui::SetNextWindowPos(
                {strip.state.view.x(strip.timeline.markers[state.menuMarker].time), strip.markers.hi.y},
                ImGuiCond_Appearing);
            ImGui::OpenPopup(kPopup);
        }
    }
    if (!ImGui::BeginPopup(kPopup)) return;
    const std::size_t marker = state.menuMarker;
    if (marker >= strip.timeline.markers.size()) {
        ImGui::CloseCurrentPopup();
        return ImGui::EndPopup();
    }
    if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(12.0f * ImGui::GetFontSize());
    editText(strip.editor, "##name", strip.timeline.markers[marker].name, "name of the marker",
             [marker](Editor& editor, const std::string& text) {
                 editor.document.apply("Rename Marker", renameMarker(editor.document.graph(), marker, text));
             });
    if (ImGui::IsItemDeactivated()) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
}

}  // namespace

void showStripMenus(Strip& strip) {
    TimelineState& state = strip.state;
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    if (strip.hovered && ImGui::IsMouseClicked(1) && state.hand.does == TimelineHand::Does::nothing) {
        state.menuTime = strip.timeUnderMouse();
        const StripHit hit = state.curves ? hitCurves(strip, mouse) : hitRows(strip, mouse);
        if (const auto marker = markerAt(strip, mouse)) {
            state.menuMarker = *marker;
            ImGui::OpenPopup("##markermenu");
        } else if (strip.ruler.contains(mouse) || strip.markers.contains(mouse)) {
            ImGui::OpenPopup("##rulermenu");
        } else if (hit.what != StripHit::What::nothing) {
            const Track& track = strip.timeline.tracks[hit.track];
            const Moved moved = movedBy(track);
            state.row = moved;
            if (!state.selection.contains(moved, track.keys[hit.key].time)) {
                state.selection.clear();
                state.selection.add(moved, track.keys[hit.key].time);
            }
            ImGui::OpenPopup("##keymenu");
        } else if (const std::size_t row = strip.rowAt(mouse.y);
                   !state.curves && row < strip.timeline.tracks.size()) {
            state.menuRow = movedBy(strip.timeline.tracks[row]);
            ImGui::OpenPopup("##rowmenu");
        } else {
            ImGui::OpenPopup("##keymenu");
        }
    }
    if (std::exchange(state.opensRowMenu, false)) ImGui::OpenPopup("##rowmenu");
    showKeyMenu(strip);
    showRowMenu(strip);
    showRulerMenu(strip);
    showMarkerMenu(strip);
    showMarkerName(strip);
}

}  // namespace fw::editor
