// The timeline: play and scrub, what is selected, the names of what moves, and beside them the strip of times
// (strip.h).
#include <algorithm>
#include <cmath>

#include "editor/document/parameters.h"
#include "editor/panels/playback.h"
#include "editor/panels/properties.h"
#include "editor/shell/letters.h"
#include "editor/shell/theme.h"
#include "editor/timeline/actions.h"
#include "editor/timeline/strip.h"
#include "graph/document/named_parameters.h"

namespace fw::editor {

namespace {

constexpr float kNames = 11.0f;   // width of the tracks' names, in the font's size
constexpr float kBarHigh = 8.0f;  // pixels of the interface

TimelineState& stateAnew(Editor& editor, const Timeline& timeline) {
    TimelineState& state = editor.panelState.timelinePanel;
    if (state.document != editor.viewport.document) {
        const bool curves = state.curves, frames = state.frames;
        state = {};
        state.document = editor.viewport.document;
        state.curves = curves, state.frames = frames;
    }
    if (state.revision != editor.document.revision()) {
        state.revision = editor.document.revision();
        state.selection = stillThere(state.selection, timeline);
        if (state.row && !trackOf(timeline, *state.row)) state.row.reset();
    }
    return state;
}

void tip(const char* words) {
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", words);
}

void showTransport(Editor& editor, const Timeline& timeline, TimelineState& state) {
    Viewport& view = editor.viewport;
    const double rate = timeline.framesPerSecond, frame = 1.0 / rate;
    const double first = timeline.range ? timeline.range->from : 0.0,
                 last = timeline.range ? std::min(timeline.range->to, timeline.length) : timeline.length;
    if (ImGui::Button("|◀")) showTime(editor, first);
    tip("To the start");
    ImGui::SameLine();
    if (ImGui::Button("◀")) showTime(editor, nearestFrame(view.seconds - frame, rate));
    tip("A frame back");
    ImGui::SameLine();
    if (ImGui::Button(view.playing ? "Pause###play" : "Play###play", {4.5f * ImGui::GetFontSize(), 0}))
        togglePlay(editor);
    ImGui::SameLine();
    if (ImGui::Button("▶"))
        showTime(editor, std::min(nearestFrame(view.seconds + frame, rate), timeline.length));
    tip("A frame on");
    ImGui::SameLine();
    if (ImGui::Button("▶|")) showTime(editor, last);
    tip("To the end");
    besideIfFits(4.0f * ImGui::GetFontSize());
    const float em = ImGui::GetFontSize();
    ImGui::SetNextItemWidth(4.0f * em);
    const double now = view.seconds * rate;
    const double shown = view.playing ? std::floor(now) : std::round(now * 1e3) / 1e3;
    dragNumbers(editor, "##frame", std::span(&shown, 1),
                {.min = 0.0, .max = timeline.length * rate, .speed = 0.2},
                [&editor, rate](std::span<const double> to) {
                    showTime(editor, (ImGui::GetIO().KeyAlt ? to[0] : std::round(to[0])) / rate);
                });
    tip("The frame shown");
    besideIfFits(6.0f * em);
    ImGui::SetNextItemWidth(6.5f * em);
    const std::string words = timeText(view.playing ? std::floor(now) / rate : view.seconds, rate, false);
    if (ImGui::Button((words + "###unit").c_str(), {6.0f * em, 0})) state.frames = !state.frames;
    tip("The time shown. Click: the ruler in frames, or in seconds and frames");
    besideIfFits(9.0f * em);
    ImGui::TextUnformatted("of");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(5.0f * em);
    editNumbers(
        editor, "##length", std::span(&timeline.length, 1),
        {.min = frame, .max = kMostTimelineLength, .speed = 0.05}, "Set Length",
        [](const Graph& graph, std::span<const double> to) { return setTimelineLength(graph, to[0]); });
    tip("Length, seconds");
    ImGui::SameLine();
    ImGui::TextUnformatted("s");
    besideIfFits(7.0f * em);
    ImGui::SetNextItemWidth(4.0f * em);
    editNumbers(editor, "##fps", std::span(&rate, 1), {.min = 1.0, .max = kMostFramesPerSecond, .speed = 0.2},
                "Set Frames per Second", [](const Graph& graph, std::span<const double> to) {
                    return setFramesPerSecond(graph, to[0]);
                });
    tip("Frames per second");
    ImGui::SameLine();
    ImGui::TextUnformatted("fps");
    besideIfFits(7.0f * em);
    ImGui::SetNextItemWidth(7.0f * em);
    auto loop = std::size_t(timeline.loop);
    if (chooseName("##loop", loopNames(), loop))
        editor.document.apply("Set Loop", setLoop(editor.document.graph(), Loop(loop)));
}

/// The inputs that may get a track: exposed parameters, and those of the active node.
void showAddTrack(Editor& editor, const Timeline& timeline) {
    if (ImGui::Button("Add track")) ImGui::OpenPopup("tracks");
    if (!ImGui::BeginPopup("tracks")) return;
    const Graph& graph = editor.document.graph();
    bool any = false;
    std::function<void()> chosen;
    const auto offer = [&](const Moved& moved, const Plug& plug) {
        if (!motionRefusal(graph, plug).empty() || trackOfInput(graph, timeline, plug)) return;
        any = true;
        if (ImGui::MenuItem(nameOf(graph, moved).c_str()))
            chosen = [&editor, &timeline, moved, numbers = inputNumbers(*graph.node(plug.node), plug.name)] {
                toggleKey(editor, timeline, moved, numbers);
            };
    };
    for (const NamedParameter& parameter : namedParameters(graph))
        offer({Track::Target::parameter, "", parameter.name}, {parameter.node, parameter.input});
    const NodeBox* box = editor.canvas.scope.empty() ? editor.boxes->find(editor.canvas.active) : nullptr;
    if (box)
        for (const Row& row : box->rows)
            if (!row.output && !parameterOf(graph, {box->node->id, row.name}))
                offer({Track::Target::input, box->node->id, row.name}, {box->node->id, row.name});
    if (!any)
        ImGui::TextDisabled(
            "Select a node with a number that can move, or expose a parameter.\nValues of the scene have "
            "their key buttons in the scene panel.");
    ImGui::EndPopup();
    if (chosen) chosen();
}

/// The value of the one key that is selected.
void showKeyValue(Editor& editor, const Timeline& timeline, const TimelineState& state, const Track& track,
                  const Key& key) {
    const float em = ImGui::GetFontSize();
    ImGui::AlignTextToFramePadding();
    ImGui::Text("Key at %s", timeText(key.time, timeline.framesPerSecond, state.frames).c_str());
    ImGui::SameLine();
    ImGui::SetNextItemWidth((2.0f + 3.0f * float(key.value.size())) * em);
    NumberRange range;
    if (const auto input = animatedInput(editor.document.graph(), track))
        range.min = input->min, range.max = input->max, range.unit = input->unit;
    editNumbers(editor, "##keyvalue", key.value, range, "Set Key",
                [moved = movedBy(track), time = key.time](const Graph& graph, std::span<const double> to) {
                    return setKey(graph, moved, time, to);
                });
    ImGui::SameLine();
}

/// What is selected: its value, and how it goes on to the next keys.
void showSelected(Editor& editor, const Timeline& timeline, TimelineState& state,
                  std::vector<std::function<void()>>& later) {
    constexpr const char* kTangentNames[] = {"automatic", "flat", "linear", "unified", "broken"};
    static const std::vector<std::string> tangentNames(std::begin(kTangentNames), std::end(kTangentNames));
    const std::size_t count = state.selection.size();
    if (count == 0) return ImGui::TextDisabled("Double click in a row to add a key.");
    const SelectedKeys& first = state.selection.tracks[0];
    const auto at = trackOf(timeline, first.moved);
    const auto index = at ? keyAt(timeline.tracks[*at], first.times[0]) : std::nullopt;
    if (!index) return;
    const Track& track = timeline.tracks[*at];
    const Key& key = track.keys[*index];
    if (count == 1) {
        showKeyValue(editor, timeline, state, track, key);
    } else {
        ImGui::AlignTextToFramePadding();
        ImGui::Text("%zu keys", count);
        ImGui::SameLine();
    }
    const auto edit = [&](const char* name, std::function<Graph(const Graph&, const KeySelection&)> next) {
        later.push_back([&editor, &state, name, next] {
            editor.document.apply(name, next(editor.document.graph(), state.selection));
        });
    };
    const float wide = 5.5f * ImGui::GetFontSize();
    ImGui::SetNextItemWidth(wide);
    auto interpolation = std::size_t(key.interpolation);
    if (chooseName("##interpolation", interpolationNames(), interpolation))
        edit("Set Interpolation", [interpolation](const Graph& graph, const KeySelection& selection) {
            return setInterpolations(graph, selection, Interpolation(interpolation));
        });
    tip("How the value goes from here to the next key");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(wide);
    auto ease = std::size_t(key.ease);
    ImGui::BeginDisabled(key.interpolation == Interpolation::step);
    if (chooseName("##ease", easeNames(), ease))
        edit("Set Ease", [ease](const Graph& graph, const KeySelection& selection) {
            return setEases(graph, selection, Ease(ease));
        });
    ImGui::EndDisabled();
    tip("Whether it starts or ends slowly");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(1.2f * wide);
    auto tangents = std::size_t(tangentsOf(key));
    if (chooseName("##tangents", tangentNames, tangents))
        edit("Set Tangents", [tangents](const Graph& graph, const KeySelection& selection) {
            return setTangents(graph, selection, TangentChoice(tangents));
        });
    tip("The slopes of a cubic curve at the key: found, or its own, the same on both sides or each by "
        "itself");
}

/// The tracks' names, one a row; beside them whether their curves are shown.
void showNames(Strip& strip, float width) {
    TimelineState& state = strip.state;
    const float high = strip.high;
    ImGui::SetCursorScreenPos({strip.body.lo.x - width, strip.body.lo.y});
    ImGui::BeginChild("##names", {width, strip.body.height()}, false,
                      ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NavFlattened);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float gap = 0.4f * ImGui::GetFontSize();
    ImGuiListClipper clipper;
    clipper.Begin(int(strip.timeline.tracks.size()), high);
    while (clipper.Step())
        for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
            const Moved moved = movedBy(strip.timeline.tracks[std::size_t(i)]);
            const std::string name = nameOf(strip.graph(), moved);
            ImGui::PushID(i);
            ImGui::SetCursorScreenPos({at.x, at.y + float(i) * high});
            float room = width - gap;
            if (state.curves) {
                const bool shown = state.shows(moved);
                const float eye = 0.8f * high;
                const ImVec2 corner = ImGui::GetCursorScreenPos();
                if (ImGui::InvisibleButton("##shown", {eye, high - 2.0f})) {
                    if (shown)
                        state.hidden.push_back(moved);
                    else
                        std::erase(state.hidden, moved);
                }
                tip(shown ? "Hide its curve" : "Show its curve");
                const ImVec2 centre(corner.x + 0.5f * eye, corner.y + 0.5f * high - 1.0f);
                if (shown)
                    ImGui::GetWindowDrawList()->AddCircleFilled(centre, 0.2f * high,
                                                                themeColor(ThemeColor::text));
                else
                    ImGui::GetWindowDrawList()->AddCircle(centre, 0.2f * high, themeColor(ThemeColor::quiet));
                ImGui::SetCursorScreenPos({corner.x + eye, corner.y});
                room -= eye;
            }
            if (ImGui::Selectable(name.c_str(), state.row == moved, 0, {room, high - 2.0f}))
                state.row = moved;
            if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", name.c_str());
            if (ImGui::IsItemHovered() && ImGui::IsMouseClicked(1)) {
                state.row = state.menuRow = moved;
                state.menuTime = strip.editor.viewport.seconds;
                state.opensRowMenu = true;
            }
            ImGui::PopID();
        }
    // Wheel and keys scroll the names, the hand the rows: the one that moved leads.
    const float most = std::max(float(strip.timeline.tracks.size()) * high - strip.body.height(), 0.0f);
    state.scroll = std::clamp(state.scroll, 0.0f, most);
    if (state.scrolled != state.scroll)
        ImGui::SetScrollY(state.scroll);
    else
        state.scroll = std::min(ImGui::GetScrollY(), most);
    state.scrolled = state.scroll;
    ImGui::SetCursorScreenPos({at.x, at.y + float(strip.timeline.tracks.size()) * high});
    ImGui::Dummy({1, 1});
    ImGui::EndChild();
}

void lookWhereWished(Strip& strip) {
    TimelineState& state = strip.state;
    const bool some = state.onlySelected && !state.selection.empty();
    if (state.frameTimes) {
        double first = 0.0, last = strip.timeline.length;
        for (const Track& track : strip.timeline.tracks)
            if (!some) last = std::max(last, track.keys.back().time);
        if (some) std::tie(first, last) = state.selection.span();
        state.view.show(first, last);
    }
    state.values.top = strip.body.lo.y, state.values.bottom = strip.body.hi.y;
    if (state.frameValues && state.curves)
        if (const auto range = valuesShown(strip.timeline, state))
            state.values.show(range->first, range->second);
    state.frameTimes = false;
    if (state.curves) state.frameValues = false;
    if (!(state.values.hi > state.values.lo)) state.values.show(0.0, 1.0);
}

/// The strip with its names, in the rest of the window.
void showStrip(Editor& editor, const Timeline& timeline, TimelineState& state,
               std::vector<std::function<void()>>& later) {
    const float em = ImGui::GetFontSize(), high = ImGui::GetFrameHeight(), scale = editor.shell.scale();
    const ImVec2 at = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
    const float names = std::min(kNames * em, 0.3f * room.x);
    const float left = at.x + names, right = at.x + room.x, bottom = at.y + room.y;
    if (right - left < 20.0f || room.y < high) return;
    Strip strip{editor, timeline, state};
    strip.high = high;
    float y = at.y;
    const auto cut = [&](float tall) {
        const Area area{{left, y}, {right, std::min(y + tall, bottom)}};
        y = area.hi.y;
        return area;
    };
    strip.ruler = cut(1.45f * ImGui::GetTextLineHeight() + 8.0f * scale);
    strip.markers = cut(timeline.markers.empty() ? 0.0f : ImGui::GetTextLineHeight() + 8.0f);
    strip.bar = cut(kBarHigh * scale);
    strip.body = cut(bottom - y);
    state.view.left = left, state.view.right = right;
    lookWhereWished(strip);

    ImGui::SetCursorScreenPos(at);
    if (ImGui::Button(state.curves ? "Keys###curves" : "Curves###curves", {names - 0.4f * em, high - 2.0f}))
        later.push_back([&editor] { toggleCurves(editor); });
    tip(state.curves ? "Rows of keys" : "Curves of the values");
    showNames(strip, names);

    ImGui::SetCursorScreenPos({left, at.y});
    ImGui::BeginChild("##strip", {right - left, bottom - at.y}, false,
                      ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse |
                          ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoNavInputs);
    ImGui::InvisibleButton("##times", {right - left, bottom - at.y},
                           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonMiddle);
    strip.hovered = ImGui::IsItemHovered();
    strip.active = ImGui::IsItemActive();
    strip.pressed = strip.hovered && (ImGui::IsMouseClicked(0) || ImGui::IsMouseClicked(2));
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const bool looks = strip.hovered && state.hand.does == TimelineHand::Does::nothing;
    const StripHit hit = !looks ? StripHit{} : state.curves ? hitCurves(strip, mouse) : hitRows(strip, mouse);
    drawRuler(strip);
    if (state.curves)
        drawCurves(strip, hit);
    else {
        ImGui::GetWindowDrawList()->PushClipRect(strip.body.lo, strip.body.hi, true);
        drawRows(strip, hit);
        ImGui::GetWindowDrawList()->PopClipRect();
    }
    drawMarkers(strip);
    drawBar(strip);
    drawTimes(strip);
    if (hit.what == StripHit::What::key && !strip.active) {
        const Key& key = timeline.tracks[hit.track].keys[hit.key];
        ImGui::SetTooltip("%s", timeText(key.time, timeline.framesPerSecond, state.frames).c_str());
    }
    if (strip.hovered && barAt(strip, mouse) != BarPart::nothing)
        ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    followHand(strip, hit);
    showStripMenus(strip);
    ImGui::EndChild();
    later.insert(later.end(), strip.later.begin(), strip.later.end());
}

}  // namespace

void showTimeline(Editor& editor) {
    const Timeline* read = timelineOf(editor);
    if (!read)
        return wrapped(themeColor(ThemeColor::error),
                       "The timeline cannot be read: " + editor.panelState.timelineProblem + ".");
    // It stays as it is until the frame's end: `later` has what makes it another, and what is dragged changes
    // the document alone.
    const Timeline& timeline = *read;
    TimelineState& state = stateAnew(editor, timeline);
    std::vector<std::function<void()>> later;
    showTransport(editor, timeline, state);
    showAddTrack(editor, timeline);
    ImGui::SameLine();
    showSelected(editor, timeline, state, later);
    showStrip(editor, timeline, state, later);
    for (const auto& each : later) each();
}

}  // namespace fw::editor
