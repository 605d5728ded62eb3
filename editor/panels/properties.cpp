#include "editor/panels/properties.h"

#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>

#include "editor/shell/letters.h"
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
    Document& document = editor.document;
    if (ImGui::GetActiveID() == id) {
        if (edit.field != id) edit = {id, document.begin("Type"), {}};
        edit.text = now;
        document.hold(edit.hand, [&editor, before, now, commit = std::move(commit)] {
            if (now != before) commit(editor, now);
        });
    } else if (edit.field == id) {
        document.end(std::exchange(edit, {}).hand);
        if (now != before) commit(editor, now);
    }
}

/// What the field shows: what is being typed in it, else the document's text.
std::string shownText(const Editor& editor, const char* id, const std::string& text) {
    const TextEdit& edit = editor.panelState.text;
    return edit.field == ImGui::GetID(id) ? edit.text : text;
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
    ImGui::TextUnformatted(fitted(name, ImGui::GetContentRegionAvail().x).c_str());
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

NumberRow::NumberRow(int count_, float whole_)
    : at(ImGui::GetCursorScreenPos()), whole(std::max(whole_, 20.0f)), count(count_) {}

NumberRow::Place NumberRow::place(int part, bool typed) const {
    const float gap = ImGui::GetStyle().ItemInnerSpacing.x, high = ImGui::GetFrameHeight();
    const float wide = std::max((whole - gap * float(count - 1)) / float(count), 1.0f),
                x = at.x + float(part) * (wide + gap);
    Place place{.area = {{x, at.y}, {x + wide, at.y + high}}};
    if (typed) return place;  // the text field stands there
    ImGui::SetCursorScreenPos(place.area.lo);
    ImGui::PushID(part);
    const bool pressed = ImGui::InvisibleButton("##number", {wide, high});
    ImGui::PopID();
    place.hovered = ImGui::IsItemHovered();
    if (ImGui::IsItemFocused() && ImGui::GetIO().NavVisible)
        ImGui::GetWindowDrawList()->AddRect(place.area.lo, place.area.hi, themeColor(ThemeColor::active),
                                            3.0f);
    place.byKey = pressed && !ImGui::IsMouseReleased(0);
    return place;
}

void NumberRow::end() const {
    // One item of them all, with words beside it on the line of theirs.
    const ImVec2 size(whole, ImGui::GetFrameHeight());
    ImGui::SetCursorScreenPos(at);
    ImGui::ItemSize(size, ImGui::GetStyle().FramePadding.y);
    ImGui::ItemAdd({at, {at.x + size.x, at.y + size.y}}, 0);
}

namespace {

using SetNumbers = std::function<void(Hand, std::span<const double>)>;

void showNumbers(Editor& editor, const char* id, std::span<const double> numbers, const NumberRange& range,
                 const std::string& name, const SetNumbers& set, const std::string& input, bool animated) {
    NumberHand& hand = editor.panelState.number;
    const std::string key = std::to_string(ImGui::GetID(id));
    const std::vector<double> all(numbers.begin(), numbers.end());
    const auto count = int(all.size());
    const NumberRow row(count, ImGui::CalcItemWidth());
    ImGui::PushID(id);
    for (int i = 0; i < count; ++i) {
        const NumberRow::Place at = row.place(i, hand.types(key, i));
        const double number = all[std::size_t(i)];
        if (at.byKey && hand.state == NumberHand::State::none)
            hand.type(editor.document, name, key, i, number);
        const NumberLook look{at.area, ImGui::GetFont(), ImGui::GetFontSize(), at.hovered, animated};
        const NumberDone done = showNumber(
            hand, editor.document, key, i, number, range, name, look,
            [set, all, i](Hand by, double to) {
                std::vector<double> now = all;
                now[std::size_t(i)] = to;
                set(by, now);
            },
            [set, count](Hand by, double to) { set(by, std::vector<double>(std::size_t(count), to)); });
        if (hand.is(key, i)) hand.moves = input;
        if (const int next = i + done.tab; done.tab != 0 && next >= 0 && next < count)
            hand.type(editor.document, name, key, next, all[std::size_t(next)]);
    }
    ImGui::PopID();
    row.end();
}

}  // namespace

void editNumbers(Editor& editor, const char* id, std::span<const double> numbers, const NumberRange& range,
                 const std::string& name, const NumbersEdit& edit, const std::string& input, bool animated) {
    showNumbers(
        editor, id, numbers, range, name,
        [&editor, edit](Hand by, std::span<const double> to) {
            editor.document.update(by, edit(editor.document.graph(), to));
        },
        input, animated);
}

void dragNumbers(Editor& editor, const char* id, std::span<const double> numbers, const NumberRange& range,
                 const std::function<void(std::span<const double>)>& set) {
    showNumbers(
        editor, id, numbers, range, "", [set](Hand, std::span<const double> to) { set(to); }, {}, false);
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
    Document& document = editor.document;
    const ImGuiID field = ImGui::GetID(id);
    if (touched.changed) {
        if (held.field != field) {
            held = {field, document.begin(name), {}};
            if (!input.empty()) held.inputs.insert(input);
        }
        document.update(held.hand, next());
    }
    if (held.field != field) return;
    document.hold(held.hand);
    if (touched.active && ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) {
        ImGui::ClearActiveID();
        document.cancel(std::exchange(held, {}).hand);
    } else if (!touched.active) {
        document.end(std::exchange(held, {}).hand);
    }
}

void editText(Editor& editor, const char* id, const std::string& text, const char* hint,
              std::function<void(Editor&, const std::string&)> commit) {
    std::string shown = shownText(editor, id, text);
    ImGui::InputTextWithHint(id, hint, &shown);
    followText(editor, ImGui::GetID(id), text, shown, std::move(commit));
}

void editLines(Editor& editor, const char* id, const std::string& text,
               std::function<void(Editor&, const std::string&)> commit) {
    std::string shown = shownText(editor, id, text);
    const auto lines = 1 + float(std::ranges::count(shown, '\n'));
    const float height =
        std::clamp(lines, 2.0f, 8.0f) * ImGui::GetTextLineHeight() + 2 * ImGui::GetStyle().FramePadding.y;
    ImGui::InputTextMultiline(id, &shown, {ImGui::CalcItemWidth(), height});
    followText(editor, ImGui::GetID(id), text, shown, std::move(commit));
}

namespace {

/// A square button with a folder on it.
bool folderButton(const char* id) {
    const float side = ImGui::GetFrameHeight();
    const bool pressed = ImGui::Button(id, {side, side});
    const ImVec2 at = ImGui::GetItemRectMin();
    const auto part = [&](float x, float y) { return ImVec2(at.x + x * side, at.y + y * side); };
    const ImVec2 outline[] = {part(0.2f, 0.3f),  part(0.42f, 0.3f), part(0.5f, 0.39f),
                              part(0.8f, 0.39f), part(0.8f, 0.72f), part(0.2f, 0.72f)};
    ImGui::GetWindowDrawList()->AddPolyline(outline, 6, ImGui::GetColorU32(ImGuiCol_Text), ImDrawFlags_Closed,
                                            0.06f * side);
    return pressed;
}

}  // namespace

void editFile(Editor& editor, const char* id, const std::string& path, const FileKind& kind, float room,
              const std::function<void(Editor&, const std::string&)>& commit) {
    ImGui::SetNextItemWidth(-room - ImGui::GetFrameHeight() - ImGui::GetStyle().ItemSpacing.x);
    editText(editor, id, path, ("the path of " + anyOf(kind)).c_str(), commit);
    ImGui::SameLine();
    ImGui::PushID(id);
    if (folderButton("##browse")) pickFile(editor, kind, path, commit);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Choose %s", anyOf(kind).c_str());
    ImGui::PopID();
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
    editNumbers(
        editor, id, evaluate(track, now), range, "Set Key of " + name,
        [moved = movedBy(track), now](const Graph& graph, std::span<const double> value) {
            return setKey(graph, moved, now, {value.begin(), value.end()});
        },
        input, true);
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

void followHands(Editor& editor) {
    PanelState& state = editor.panelState;
    const Document& document = editor.document;
    state.number.follow(document);
    state.ramp.follow(document);
    if (state.held.field != 0 && !document.holds(state.held.hand)) state.held = {};
    if (state.text.field == 0 || document.holds(state.text.hand)) return;
    // Its words are the document's by now: the field must not go on with them over what came since.
    if (ImGui::GetActiveID() == state.text.field) ImGui::ClearActiveID();
    state.text = {};
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
