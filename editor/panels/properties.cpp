#include "editor/panels/properties.h"

#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>

#include "editor/shell/theme.h"
#include "graph/assets/image.h"

namespace fw::editor {

namespace {

constexpr float kNameShare = 0.38f;  // of a panel's width

float toDisplay(double linear) { return float(encodeSrgb(std::clamp(linear, 0.0, 1.0))); }

double toLinear(float display) {
    const double linear = decodeSrgb(double(std::clamp(display, 0.0f, 1.0f)));
    return std::round(linear * 1e5) / 1e5;  // no more digits than the picker can tell apart
}

/// Keeps what is being typed, and hands it over when the field has lost the keyboard.
void followText(Editor& editor, ImGuiID id, const std::string& before, const std::string& now,
                std::function<void(Editor&, const std::string&)> commit) {
    TextEdit& edit = editor.panelState.text;
    if (ImGui::GetActiveID() == id) {
        // A field further down was left for this one.
        if (edit.field != id && edit.field != 0 && edit.commit) edit.commit(editor, edit.text);
        edit.field = id;
        edit.frame = ImGui::GetFrameCount();
        edit.text = now;
        edit.commit = std::move(commit);
    } else if (edit.field == id) {
        edit = {};
        if (now != before) commit(editor, now);
    }
}

/// What the field shows: what is being typed in it, else the document's text.
std::string shownText(const Editor& editor, const char* id, const std::string& text) {
    const TextEdit& edit = editor.panelState.text;
    return edit.field == ImGui::GetID(id) ? edit.text : text;
}

/// Whether Enter or Space was pressed on it.
bool chosenByKey(ImGuiID item) {
    const ImGuiContext& context = *ImGui::GetCurrentContext();
    return context.NavActivateId == item || context.NavActivateInputId == item;
}

}  // namespace

bool beginProperties(const char* id) {
    if (!ImGui::BeginTable(id, 2, ImGuiTableFlags_SizingStretchProp | ImGuiTableFlags_NoPadOuterX))
        return false;
    ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthStretch, kNameShare);
    ImGui::TableSetupColumn("value", ImGuiTableColumnFlags_WidthStretch, 1.0f - kNameShare);
    return true;
}

void endProperties() { ImGui::EndTable(); }

void propertyRow(const std::string& name, const std::string& tip, float room) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(name.c_str());
    if (!tip.empty() && ImGui::IsItemHovered()) {
        ImGui::BeginTooltip();
        ImGui::PushTextWrapPos(30.0f * ImGui::GetFontSize());
        ImGui::TextUnformatted(tip.c_str());
        ImGui::PopTextWrapPos();
        ImGui::EndTooltip();
    }
    ImGui::TableNextColumn();
    ImGui::SetNextItemWidth(-std::max(room, FLT_MIN));
}

void wrapped(ImU32 color, const std::string& text) {
    ImGui::PushStyleColor(ImGuiCol_Text, color);
    ImGui::PushTextWrapPos(0.0f);
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::PopStyleColor();
}

Touched dragNumbers(Editor& editor, const char* id, std::span<double> numbers, const NumberRange& range) {
    constexpr float kStill = 3.0f;  // pixels that a click may move
    const bool least = std::isfinite(range.min), most = std::isfinite(range.max);
    NumberEdit& edit = editor.panelState.number;
    const ImGuiID field = ImGui::GetID(id);
    Touched touched;
    ImGui::PushID(id);
    ImGui::PushMultiItemsWidths(int(numbers.size()), ImGui::CalcItemWidth());
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        if (i > 0) ImGui::SameLine(0.0f, ImGui::GetStyle().ItemInnerSpacing.x);
        ImGui::PushID(int(i));
        const double before = numbers[i];
        if (edit.field == field && edit.part == i) {
            edit.frame = ImGui::GetFrameCount();
            const Typed typed = typeNumber(edit.typed, ImGui::CalcItemWidth());
            if (typed.number) {
                numbers[i] = std::clamp(*typed.number, range.min, range.max);
                touched.changed |= numbers[i] != before;
            }
            const std::size_t next = i + std::size_t(typed.tab);
            if (typed.ended) edit = {};
            if (typed.tab != 0 && next < numbers.size())
                edit = {field, ImGui::GetFrameCount(), next, TypedNumber(numbers[next])};
        } else {
            const bool byKey = chosenByKey(ImGui::GetID("##number"));
            if (!byKey)
                touched.changed |= ImGui::DragScalar(
                    "##number", ImGuiDataType_Double, &numbers[i], float(range.speed),
                    least ? &range.min : nullptr, most ? &range.max : nullptr, "%.6g",
                    ImGuiSliderFlags_NoInput | (least || most ? ImGuiSliderFlags_AlwaysClamp : 0));
            touched.active |= !byKey && ImGui::IsItemActive();
            const bool clicked = !byKey && ImGui::IsItemDeactivated() && ImGui::IsMouseReleased(0) &&
                                 ImGui::GetIO().MouseDragMaxDistanceSqr[0] < kStill * kStill;
            if (byKey || clicked) edit = {field, ImGui::GetFrameCount(), i, TypedNumber(numbers[i])};
            if (!std::isfinite(numbers[i])) numbers[i] = before;
        }
        ImGui::PopItemWidth();
        ImGui::PopID();
    }
    ImGui::PopID();
    return touched;
}

Touched pickColor(const char* id, std::span<double> linear) {
    // A picker knows colours up to white: what is brighter is one of them times its strength.
    const double strength = std::max({1.0, linear[0], linear[1], linear[2]});
    float shown[3];
    for (std::size_t i = 0; i < 3; ++i) shown[i] = toDisplay(linear[i] / strength);
    Touched touched;
    ImGui::PushID(id);
    const float height = ImGui::GetFrameHeight();
    if (ImGui::ColorButton("##color", {shown[0], shown[1], shown[2], 1.0f},
                           ImGuiColorEditFlags_NoTooltip | ImGuiColorEditFlags_NoDragDrop,
                           {1.6f * height, height}))
        ImGui::OpenPopup("picker");
    if (ImGui::BeginPopup("picker")) {
        ImGui::SetNextItemWidth(14.0f * ImGui::GetFontSize());
        touched.changed =
            ImGui::ColorPicker3("##picker", shown,
                                ImGuiColorEditFlags_NoSidePreview | ImGuiColorEditFlags_DisplayRGB |
                                    ImGuiColorEditFlags_DisplayHex | ImGuiColorEditFlags_PickerHueBar);
        touched.active = ImGui::IsItemActive();
        ImGui::EndPopup();
    }
    ImGui::PopID();
    if (touched.changed)
        for (std::size_t i = 0; i < 3; ++i) linear[i] = toLinear(shown[i]) * strength;
    return touched;
}

bool chooseName(const char* id, std::span<const std::string> names, std::size_t& chosen) {
    bool taken = false;
    if (!ImGui::BeginCombo(id, chosen < names.size() ? readable(names[chosen]).c_str() : "")) return false;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (ImGui::Selectable(readable(names[i]).c_str(), i == chosen) && i != chosen)
            chosen = i, taken = true;
        if (i == chosen) ImGui::SetItemDefaultFocus();
    }
    ImGui::EndCombo();
    return taken;
}

void follow(Editor& editor, const char* id, const Touched& touched, const std::string& name,
            const std::function<Graph()>& next, const std::string& input) {
    HeldValue& held = editor.panelState.held;
    const ImGuiID field = ImGui::GetID(id);
    if (touched.changed) {
        if (held.field != field) {
            if (held.field != 0) editor.document.end();
            editor.document.begin(name);
            held.field = field;
            held.inputs.clear();
            if (!input.empty()) held.inputs.insert(input);
        }
        editor.document.update(next());
    }
    if (held.field != field) return;
    held.frame = ImGui::GetFrameCount();
    if (touched.active && ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) {
        ImGui::ClearActiveID();
        editor.document.cancel();
        held = {};
    } else if (!touched.active) {
        editor.document.end();
        held = {};
    }
}

void editText(Editor& editor, const char* id, const std::string& text, const char* hint,
              std::function<void(Editor&, const std::string&)> commit) {
    std::string shown = shownText(editor, id, text);
    ImGui::InputTextWithHint(id, hint, &shown);
    followText(editor, ImGui::GetID(id), text, shown, std::move(commit));
}

bool keyButton(const char* id, bool filled, bool animated, const char* tip) {
    const float side = ImGui::GetFrameHeight();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const bool pressed = ImGui::InvisibleButton(id, {0.8f * side, side});
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", tip);
    const ImU32 color = ImGui::IsItemHovered() || animated || ImGui::GetFocusID() == ImGui::GetItemID()
                            ? themeColor(ThemeColor::active)
                            : themeColor(ThemeColor::quiet);
    const ImVec2 c(at.x + 0.4f * side, at.y + 0.5f * side);
    const float r = 0.24f * side;
    const ImVec2 top(c.x, c.y - r), right(c.x + r, c.y), bottom(c.x, c.y + r), left(c.x - r, c.y);
    ImDrawList* list = ImGui::GetWindowDrawList();
    if (filled)
        list->AddQuadFilled(top, right, bottom, left, color);
    else
        list->AddQuad(top, right, bottom, left, color, 1.5f);
    return pressed;
}

void editAnimated(Editor& editor, const char* id, const Track& track, const NumberRange& range,
                  const std::string& name, const std::string& input) {
    const double now = editor.viewport.seconds;
    std::vector<double> value = evaluate(track, now);
    ImGui::PushStyleColor(ImGuiCol_Border, themeColor(ThemeColor::active));
    ImGui::PushStyleVar(ImGuiStyleVar_FrameBorderSize, 1.0f);
    const Touched touched = dragNumbers(editor, id, value, range);
    ImGui::PopStyleVar();
    ImGui::PopStyleColor();
    const Moved moved = movedBy(track);
    follow(
        editor, id, touched, "Set Key of " + name,
        [&] { return setKey(editor.document.graph(), moved, now, value); }, input);
}

void toggleKey(Editor& editor, const Timeline& timeline, const Moved& moved, std::span<const double> value) {
    const double now = editor.viewport.seconds;
    Document& document = editor.document;
    std::vector<double> there(value.begin(), value.end());
    if (const auto track = trackOf(timeline, moved)) {
        if (const auto key = keyAt(timeline.tracks[*track], now))
            return document.apply("Remove Key", removeKey(document.graph(), *track, *key));
        there = evaluate(timeline.tracks[*track], now);
    }
    document.apply("Add Key", setKey(document.graph(), moved, now, there));
}

void finishLost(Editor& editor) {
    const int frame = ImGui::GetFrameCount();
    TextEdit& text = editor.panelState.text;
    if (text.field != 0 && text.frame < frame - 1) {
        const TextEdit lost = std::exchange(text, {});
        if (lost.commit) lost.commit(editor, lost.text);
    }
    HeldValue& held = editor.panelState.held;
    if (held.field != 0 && held.frame < frame - 1) {
        editor.document.end();
        held = {};
    }
    if (editor.panelState.number.frame < frame - 1) editor.panelState.number = {};
    // A number that was dragged or typed in a panel that is gone: the button went up elsewhere.
    FieldEdit& field = editor.panelState.field;
    if (field.state != FieldEdit::State::none && editor.panelState.fieldFrame < frame - 1) {
        if (field.state == FieldEdit::State::dragging) editor.document.end();
        field = {};
    }
}

const Timeline* timelineOf(Editor& editor) {
    PanelState& state = editor.panelState;
    if (state.read != editor.document.revision()) {
        state.read = editor.document.revision();
        const Result<Timeline> timeline = readTimeline(editor.document.graph());
        state.timeline = timeline ? *timeline : Timeline{};
        state.timelineProblem = timeline ? "" : format(timeline.error());
    }
    return state.timelineProblem.empty() ? &state.timeline : nullptr;
}

std::string pathOf(const Editor& editor, std::string_view node) {
    return editor.canvas.scope.empty() ? std::string(node) : editor.canvas.scope + "/" + std::string(node);
}

}  // namespace fw::editor
