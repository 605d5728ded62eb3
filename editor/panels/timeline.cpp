// The timeline: play and scrub, and a row of keys for everything that moves.
//
//     mouse                   does
//     drag in the ruler       scrubs
//     click, drag on a key    selects it; moves it to another time, frame by frame (Alt: freely)
//     double click in a row   adds a key there
//     Delete                  removes the selected key
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "editor/document/parameters.h"
#include "editor/panels/playback.h"
#include "editor/panels/properties.h"
#include "editor/shell/theme.h"
#include "graph/document/named_parameters.h"

namespace fw::editor {

namespace {

constexpr float kNames = 11.0f;  // width of the tracks' names, in the font's size

/// Where times are on the screen: `length` seconds between two pixels.
struct Ruler {
    float left = 0.0f, right = 0.0f;
    double length = 1.0;

    float x(double time) const { return left + float(time / length) * (right - left); }
    double time(float at) const { return double((at - left) / std::max(right - left, 1.0f)) * length; }
};

double onFrame(const Timeline& timeline, double time) {
    if (ImGui::GetIO().KeyAlt) return time;
    return std::round(time * timeline.framesPerSecond) / timeline.framesPerSecond;
}

/// A step between two lines of the ruler: 1, 2 or 5 of a decade, at least `pixels` wide.
double stepOf(const Ruler& ruler, float pixels) {
    const double least = ruler.length * double(pixels / std::max(ruler.right - ruler.left, 1.0f));
    const double decade = std::pow(10.0, std::floor(std::log10(least)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (factor * decade >= least) return factor * decade;
    return 10.0 * decade;
}

void drawDiamond(ImVec2 c, float r, ImU32 fill, ImU32 edge) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddQuadFilled({c.x, c.y - r}, {c.x + r, c.y}, {c.x, c.y + r}, {c.x - r, c.y}, fill);
    list->AddQuad({c.x, c.y - r}, {c.x + r, c.y}, {c.x, c.y + r}, {c.x - r, c.y}, edge, 1.5f);
}

void showTransport(Editor& editor, const Timeline& timeline) {
    Viewport& view = editor.viewport;
    const double frame = 1.0 / timeline.framesPerSecond;
    if (ImGui::Button("|◀")) showTime(editor, 0.0);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("To the start");
    ImGui::SameLine();
    if (ImGui::Button("◀")) showTime(editor, onFrame(timeline, view.seconds - frame));
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("A frame back");
    ImGui::SameLine();
    if (ImGui::Button(view.playing ? "Pause###play" : "Play###play", {4.5f * ImGui::GetFontSize(), 0}))
        togglePlay(editor);
    ImGui::SameLine();
    if (ImGui::Button("▶"))
        showTime(editor, std::min(onFrame(timeline, view.seconds + frame), timeline.length));
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("A frame on");
    ImGui::SameLine();
    if (ImGui::Button("▶|")) showTime(editor, timeline.length);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("To the end");
    ImGui::SameLine();
    const float em = ImGui::GetFontSize();
    ImGui::SetNextItemWidth(5.0f * em);
    dragNumbers(editor, "##time", std::span(&view.seconds, 1), {.min = 0.0, .max = timeline.length},
                [&editor](std::span<const double> to) { showTime(editor, to[0]); });
    ImGui::SameLine();
    ImGui::TextUnformatted("of");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(5.0f * em);
    editNumbers(
        editor, "##length", std::span(&timeline.length, 1),
        {.min = frame, .max = kMostTimelineLength, .speed = 0.05}, "Set Length",
        [](const Graph& graph, std::span<const double> to) { return setTimelineLength(graph, to[0]); });
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Length, seconds");
    ImGui::SameLine();
    ImGui::TextUnformatted("s");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(4.0f * em);
    editNumbers(
        editor, "##fps", std::span(&timeline.framesPerSecond, 1),
        {.min = 1.0, .max = kMostFramesPerSecond, .speed = 0.2}, "Set Frames per Second",
        [](const Graph& graph, std::span<const double> to) { return setFramesPerSecond(graph, to[0]); });
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Frames per second");
    ImGui::SameLine();
    ImGui::TextUnformatted("fps");
    ImGui::SameLine();
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
    const auto offer = [&](const Moved& moved, const Plug& plug) {
        if (!motionRefusal(graph, plug).empty() || trackOfInput(graph, timeline, plug)) return;
        any = true;
        if (ImGui::MenuItem(nameOf(graph, moved).c_str()))
            toggleKey(editor, timeline, moved, inputNumbers(*graph.node(plug.node), plug.name));
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
}

/// Value and shape of the selected key.
void showKey(Editor& editor, const Timeline& timeline) {
    PanelState& state = editor.panelState;
    if (!state.track || !state.key || *state.track >= timeline.tracks.size() ||
        *state.key >= timeline.tracks[*state.track].keys.size()) {
        state.key.reset();
        return ImGui::TextDisabled("Double click in a row to add a key.");
    }
    Document& document = editor.document;
    const Track& track = timeline.tracks[*state.track];
    const Key key = track.keys[*state.key];
    const Moved moved = movedBy(track);
    const float em = ImGui::GetFontSize();
    ImGui::AlignTextToFramePadding();
    ImGui::Text("Key at %.3g s", key.time);
    ImGui::SameLine();
    ImGui::SetNextItemWidth((3.0f + 3.0f * float(key.value.size())) * em);
    NumberRange range;
    if (const auto input = animatedInput(document.graph(), track))
        range.min = input->min, range.max = input->max;
    editNumbers(editor, "##keyvalue", key.value, range, "Set Key",
                [moved, time = key.time](const Graph& graph, std::span<const double> value) {
                    return setKey(graph, moved, time, {value.begin(), value.end()});
                });
    ImGui::SameLine();
    ImGui::SetNextItemWidth(6.0f * em);
    auto interpolation = std::size_t(key.interpolation);
    if (chooseName("##interpolation", interpolationNames(), interpolation))
        document.apply("Set Interpolation", setInterpolation(document.graph(), *state.track, *state.key,
                                                             Interpolation(interpolation)));
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("How the value goes from here to the next key");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(6.0f * em);
    auto ease = std::size_t(key.ease);
    ImGui::BeginDisabled(key.interpolation == Interpolation::step);
    if (chooseName("##ease", easeNames(), ease))
        document.apply("Set Ease", setEase(document.graph(), *state.track, *state.key, Ease(ease)));
    ImGui::EndDisabled();
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Whether it starts or ends slowly");
    ImGui::SameLine();
    if (ImGui::Button("Remove key")) removeSelectedKey(editor);
}

/// The strip of times: numbers, and the time shown. Dragging in it scrubs.
void showRuler(Editor& editor, const Timeline& timeline, const Ruler& ruler, float high) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::SetCursorScreenPos({ruler.left, at.y});
    ImGui::InvisibleButton("##ruler", {std::max(ruler.right - ruler.left, 1.0f), high});
    if (ImGui::IsItemActive()) {
        const double time = std::clamp(ruler.time(ImGui::GetIO().MousePos.x), 0.0, timeline.length);
        showTime(editor, onFrame(timeline, time));
    }
    const double step = stepOf(ruler, 4.0f * ImGui::GetFontSize());
    for (double time = 0.0; time <= ruler.length + 0.001 * step; time += step) {
        const float x = std::floor(ruler.x(time));
        list->AddLine({x, at.y + 0.6f * high}, {x, at.y + high}, themeColor(ThemeColor::quiet));
        list->AddText({x + 3.0f, at.y}, themeColor(ThemeColor::quiet), numberText(time).c_str());
    }
}

/// Takes hold of a key, moves it, lets it go.
void moveKeys(Editor& editor, const Timeline& timeline, const Ruler& ruler, std::size_t row,
              std::optional<std::size_t> hit, bool pressed, bool active) {
    PanelState& state = editor.panelState;
    const float mouse = ImGui::GetIO().MousePos.x;
    if (pressed) {
        state.track = row;
        state.key = hit;
        if (hit) {
            state.keyBase = editor.document.graph();
            state.keyTaken = *hit;
            state.keyOffset = ruler.x(timeline.tracks[row].keys[*hit].time) - mouse;
        }
    }
    const bool mine = active && state.track == row && state.key;
    Touched touched{false, mine};
    double time = 0.0;
    if (mine && ImGui::IsMouseDragging(0, 3.0f)) {
        time = std::clamp(onFrame(timeline, ruler.time(mouse + state.keyOffset)), 0.0, ruler.length);
        touched.changed = ImGui::GetIO().MouseDelta.x != 0.0f;
    }
    follow(editor, "##keys", touched, "Move Key",
           [&] { return moveKey(state.keyBase, row, state.keyTaken, time); });
    if (!touched.changed) return;
    // The key may have another index now.
    const Result<Timeline> moved = readTimeline(editor.document.graph());
    if (moved && row < moved->tracks.size()) state.key = keyAt(moved->tracks[row], time);
}

void showTrack(Editor& editor, const Timeline& timeline, const Ruler& ruler, std::size_t row, float high) {
    PanelState& state = editor.panelState;
    const Track& track = timeline.tracks[row];
    const Moved moved = movedBy(track);
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const std::string name = nameOf(editor.document.graph(), moved);
    ImGui::PushID(int(row));
    const float names = ruler.left - at.x - 0.5f * ImGui::GetFontSize();
    if (ImGui::Selectable(name.c_str(), state.track == row, 0, {names, high - 2.0f}))
        state.track = row, state.key.reset();
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s\nRight click to remove the track", name.c_str());
    if (ImGui::BeginPopupContextItem("track")) {
        if (ImGui::MenuItem("Remove track"))
            editor.document.apply("Remove Track", removeTrack(editor.document.graph(), row));
        ImGui::EndPopup();
    }

    ImGui::SetCursorScreenPos({ruler.left - 0.5f * high, at.y});
    ImGui::InvisibleButton("##keys", {std::max(ruler.right - ruler.left, 1.0f) + high, high});
    const bool hovered = ImGui::IsItemHovered(), active = ImGui::IsItemActive();
    const bool pressed = ImGui::IsItemActivated();
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const float middle = at.y + 0.5f * high, radius = 0.3f * high;
    list->AddLine({ruler.left, middle}, {ruler.right, middle}, themeColor(ThemeColor::grid));
    std::optional<std::size_t> hit;
    for (std::size_t i = 0; i < track.keys.size(); ++i) {
        const float x = ruler.x(track.keys[i].time);
        if (hovered && std::abs(mouse.x - x) <= radius + 2.0f) hit = i;
    }
    for (std::size_t i = 0; i < track.keys.size(); ++i) {
        const bool selected = state.track == row && state.key == i;
        const ImU32 fill = themeColor(selected ? ThemeColor::selected : ThemeColor::node);
        drawDiamond({ruler.x(track.keys[i].time), middle}, radius, fill,
                    themeColor(hit == i || selected ? ThemeColor::active : ThemeColor::text));
    }
    if (hit && !active) ImGui::SetTooltip("%.4g s", track.keys[*hit].time);
    const bool doubled = hovered && !hit && ImGui::IsMouseDoubleClicked(0);
    moveKeys(editor, timeline, ruler, row, hit, pressed, active);
    if (doubled) {
        const double time = std::clamp(onFrame(timeline, ruler.time(mouse.x)), 0.0, timeline.length);
        editor.document.apply("Add Key", setKey(editor.document.graph(), moved, time, evaluate(track, time)));
    }
    ImGui::PopID();
    ImGui::SetCursorScreenPos({at.x, at.y + high});
}

}  // namespace

void showTimeline(Editor& editor) {
    const Timeline* read = timelineOf(editor);
    if (!read)
        return wrapped(themeColor(ThemeColor::error),
                       "The timeline cannot be read: " + editor.panelState.timelineProblem + ".");
    if (ImGui::IsWindowFocused(ImGuiFocusedFlags_ChildWindows))
        editor.panelState.timelineFrame = ImGui::GetFrameCount();
    const Timeline timeline = *read;  // what is done below makes it another
    showTransport(editor, timeline);
    showAddTrack(editor, timeline);
    ImGui::SameLine();
    showKey(editor, timeline);

    ImGui::BeginChild("##tracks", {0, 0}, false, ImGuiWindowFlags_NoMove);
    const float em = ImGui::GetFontSize(), high = ImGui::GetFrameHeight();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    double length = timeline.length;
    for (const Track& track : timeline.tracks) length = std::max(length, track.keys.back().time);
    const Ruler ruler{at.x + kNames * em, at.x + ImGui::GetContentRegionAvail().x - 2.0f * em, length};
    showRuler(editor, timeline, ruler, high);
    ImGui::SetCursorScreenPos({at.x, at.y + high});
    for (std::size_t row = 0; row < timeline.tracks.size(); ++row)
        showTrack(editor, timeline, ruler, row, high);
    ImDrawList* list = ImGui::GetWindowDrawList();
    const float bottom =
        std::max(ImGui::GetCursorScreenPos().y, ImGui::GetWindowPos().y + ImGui::GetWindowHeight());
    const float end = ruler.x(timeline.length), now = ruler.x(editor.viewport.seconds);
    list->AddLine({end, at.y}, {end, bottom}, themeColor(ThemeColor::edge), 2.0f);
    list->AddLine({now, at.y}, {now, bottom}, themeColor(ThemeColor::active), 2.0f);
    list->AddTriangleFilled({now - 0.4f * em, at.y}, {now + 0.4f * em, at.y}, {now, at.y + 0.6f * em},
                            themeColor(ThemeColor::active));
    ImGui::Dummy({1, 1});
    ImGui::EndChild();
}

}  // namespace fw::editor
