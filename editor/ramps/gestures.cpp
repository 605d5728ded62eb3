#include "editor/ramps/gestures.h"

#include <imgui_internal.h>

#include <algorithm>
#include <cmath>

#include "editor/editor.h"
#include "graph/document/input_value.h"

namespace fw::editor {

std::set<std::string> RampHand::held() const {
    if (does != Does::move || input.empty()) return {};
    return {input};
}

void RampHand::follow(const Document& document) {
    if (does != Does::nothing && !document.holds(hand)) does = Does::nothing;
}

namespace ramps {

namespace {

using Does = RampHand::Does;

constexpr float kStillInRamp = 3.0f;                     // pixels that a click may move
constexpr double kKeyStep = 0.01, kFineKeyStep = 0.001;  // of what is seen

/// A key that is held goes on, but not for a frame that took long.
bool pressedInRamp(ImGuiKey key) {
    return ImGui::IsKeyPressed(ImGui::GetKeyIndex(key), ImGui::GetIO().DeltaTime < 0.1f);
}

/// The entry that is nearest to the mouse, within reach.
std::optional<std::size_t> entryAt(const Shown& shown, const Sheet& sheet, ImVec2 mouse, float near) {
    std::optional<std::size_t> found;
    float least = near;
    const auto selected = selectedOf(shown);
    for (std::size_t i = 0; i < shown.list.count(); ++i) {
        const auto entry = shown.list.entry(i);
        const ImVec2 at = sheet.toScreen(entry[0], sheet.planar ? entry[1] : 0.0);
        const float away =
            sheet.planar ? std::hypot(at.x - mouse.x, at.y - mouse.y) : std::abs(at.x - mouse.x);
        // Of two in one place the selected one lies above the other.
        if (away < least || (away == least && selected == i)) found = i, least = away;
    }
    return found;
}

/// The numbers of an entry where the mouse is; `of` what it was.
std::vector<double> under(const Sheet& sheet, ImVec2 mouse, std::span<const double> of) {
    std::vector<double> numbers(of.begin(), of.end());
    const double x = sheet.xAt(mouse.x);
    numbers[0] = rounded(sheet.planar ? x : std::clamp(x, sheet.x.lo, sheet.x.hi), sheet.x,
                         double(sheet.place.width()));
    if (sheet.planar) numbers[1] = rounded(sheet.yAt(mouse.y), sheet.y, double(sheet.place.height()));
    return numbers;
}

void begin(const Shown& shown, const Sheet& sheet, const List& list, std::size_t entry, bool added) {
    RampHand& hand = shown.editor.panelState.ramp;
    hand.input = shown.path(), hand.selected = entry;
    hand.hand = shown.editor.document.begin(step(shown, added ? "Add" : "Move"));
    hand.does = added ? Does::move : Does::press;
    hand.from = ImGui::GetIO().MousePos;
    hand.added = added, hand.away = false;
    hand.before = list, hand.entry = entry;
    hand.x = sheet.x, hand.y = sheet.y;
    if (added) shown.editor.document.update(hand.hand, shown.with(list));
}

void press(const Shown& shown, const Sheet& sheet, float near) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    if (const auto entry = entryAt(shown, sheet, mouse, near))
        return begin(shown, sheet, shown.list, *entry, false);
    std::vector<double> numbers = under(sheet, mouse, std::array{0.0, 0.0});
    if (!sheet.planar) {
        numbers.resize(1);
        for (const double channel : colorAt(shown.list, shown.interpolation, numbers[0]))
            numbers.push_back(channel);
    }
    const auto more = inserted(shown.list, numbers);
    if (!more)
        return say(shown.editor,
                   "there are " + std::to_string(kMostStops) + " already, as many as there can be");
    begin(shown, sheet, more->list, more->entry, true);
}

/// A frame of what was begun. `whole` and what lies near to it is where the entry stays.
void go(const Shown& shown, const Sheet& sheet, const Area& whole) {
    RampHand& hand = shown.editor.panelState.ramp;
    Document& document = shown.editor.document;
    if (!document.hold(hand.hand)) return void(hand.does = Does::nothing);
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const bool down = ImGui::IsMouseDown(0);
    if (pressedInRamp(ImGuiKey_Escape)) {
        document.cancel(hand.hand);
        hand.does = Does::nothing;
        return;
    }
    if (hand.does == Does::press &&
        std::hypot(mouse.x - hand.from.x, mouse.y - hand.from.y) > kStillInRamp * shown.editor.shell.scale())
        hand.does = Does::move;
    if (hand.does == Does::move) {
        const float room = 1.5f * ImGui::GetFontSize();
        const bool away = !(sheet.planar ? whole.grown(room).contains(mouse)
                                         : mouse.y > whole.lo.y - room && mouse.y < whole.hi.y + room);
        const auto fewer = away ? removed(hand.before, hand.entry) : std::nullopt;
        hand.away = fewer.has_value();
        const Edited next =
            fewer ? *fewer
                  : replaced(hand.before, hand.entry, under(sheet, mouse, hand.before.entry(hand.entry)));
        hand.selected = next.entry;
        if (!(next.list == shown.list)) document.update(hand.hand, shown.with(next.list));
    }
    if (down) return;
    const Does did = std::exchange(hand.does, Does::nothing);
    if (did == Does::move && hand.away) {
        // What it is called is known only now. Of one that this press added nothing is left to be called.
        const auto fewer = removed(hand.before, hand.entry);
        document.cancel(hand.hand);
        if (!hand.added) shown.apply(step(shown, "Remove").c_str(), fewer->list, fewer->entry);
        return;
    }
    document.end(hand.hand);
}

void hearKeys(const Shown& shown, const Sheet& sheet) {
    RampHand& hand = shown.editor.panelState.ramp;
    if (hand.input != shown.path()) hand.input = shown.path(), hand.selected = 0;
    const std::size_t count = shown.list.count();
    if (count == 0) return;
    hand.selected = std::min(hand.selected, count - 1);
    const std::size_t at = hand.selected;
    const ImGuiIO& io = ImGui::GetIO();
    if (io.KeyCtrl || io.KeyAlt) return;
    if (pressedInRamp(ImGuiKey_Escape)) return ImGui::ClearActiveID();
    if (pressedInRamp(ImGuiKey_Tab)) {
        if (!io.KeyShift && at + 1 < count) ++hand.selected;
        if (io.KeyShift && at > 0) --hand.selected;
        return;
    }
    if (pressedInRamp(ImGuiKey_Home)) return void(hand.selected = 0);
    if (pressedInRamp(ImGuiKey_End)) return void(hand.selected = count - 1);
    if (pressedInRamp(ImGuiKey_Delete) || pressedInRamp(ImGuiKey_Backspace)) {
        if (const auto fewer = removed(shown.list, at))
            return shown.apply(step(shown, "Remove").c_str(), fewer->list, fewer->entry);
        return say(shown.editor, "the last one stays");
    }
    if (pressedInRamp(ImGuiKey_Insert)) {
        if (const auto more = divided(shown.list, at, shown.interpolation))
            return shown.apply(step(shown, "Add").c_str(), more->list, more->entry);
        return;
    }
    const int right = int(pressedInRamp(ImGuiKey_RightArrow)) - int(pressedInRamp(ImGuiKey_LeftArrow)),
              up = int(pressedInRamp(ImGuiKey_UpArrow)) - int(pressedInRamp(ImGuiKey_DownArrow));
    if (right == 0 && (up == 0 || !sheet.planar)) return;
    const double by = io.KeyShift ? kFineKeyStep : kKeyStep;
    std::vector<double> numbers(shown.list.entry(at).begin(), shown.list.entry(at).end());
    const auto shift = [&](double& number, int steps, const Range& range) {
        if (steps != 0) number = rounded(number + steps * by * range.span(), range, 1.0 / kFineKeyStep);
    };
    shift(numbers[0], right, sheet.x);
    if (sheet.planar) shift(numbers[1], up, sheet.y);
    const Edited next = replaced(shown.list, at, numbers);
    shown.apply(step(shown, "Move").c_str(), next.list, next.entry);
}

/// Takes the keyboard, as ImGui's text fields do.
void takeKeyboard(ImGuiID id) {
    ImGuiWindow* window = ImGui::GetCurrentWindow();
    ImGui::SetActiveID(id, window);
    ImGui::SetFocusID(id, window);
    ImGui::FocusWindow(window);
}

/// What of the keyboard is not ImGui's, as long as the item has it: Tab goes on behind the last entry.
void keepKeys(const Shown& shown) {
    ImGuiContext& g = *ImGui::GetCurrentContext();
    g.ActiveIdAllowOverlap = !g.IO.MouseDown[0];  // what lies elsewhere can be clicked at once
    g.ActiveIdUsingNavDirMask |= 0xF;
    g.ActiveIdUsingNavInputMask |= 1u << ImGuiNavInput_Cancel;
    for (const ImGuiKey key : {ImGuiKey_Home, ImGuiKey_End, ImGuiKey_Delete, ImGuiKey_Backspace})
        g.ActiveIdUsingKeyInputMask |= ImU64(1) << key;
    const std::size_t at = selectedOf(shown).value_or(0);
    const bool more = g.IO.KeyShift ? at > 0 : at + 1 < shown.list.count();
    const ImU64 tab = ImU64(1) << ImGuiKey_Tab;
    g.ActiveIdUsingKeyInputMask =
        more ? g.ActiveIdUsingKeyInputMask | tab : g.ActiveIdUsingKeyInputMask & ~tab;
}

}  // namespace

std::string Shown::path() const { return (scope.empty() ? "" : scope + "/") + node + "." + input; }

Graph Shown::with(const List& other) const {
    return setInput(editor.document.graph(), scope, {node, input}, listValue(other.type, other.numbers));
}

void Shown::apply(const char* name, const List& other, std::size_t selected) const {
    editor.panelState.ramp.input = path();
    editor.panelState.ramp.selected = selected;
    editor.document.apply(name, with(other));
}

ImVec2 Sheet::toScreen(double at, double height) const {
    const double u = (at - x.lo) / x.span(), v = planar ? (height - y.lo) / y.span() : 0.0;
    return {place.lo.x + float(u) * place.width(), place.hi.y - float(v) * place.height()};
}
double Sheet::xAt(float pixel) const {
    return x.lo + x.span() * double(pixel - place.lo.x) / double(std::max(place.width(), 1.0f));
}
double Sheet::yAt(float pixel) const {
    return y.lo + y.span() * double(place.hi.y - pixel) / double(std::max(place.height(), 1.0f));
}

std::optional<std::size_t> selectedOf(const Shown& shown) {
    const RampHand& hand = shown.editor.panelState.ramp;
    if (hand.input != shown.path() || shown.list.count() == 0) return {};
    return std::min(hand.selected, shown.list.count() - 1);
}

std::string step(const Shown& shown, const char* done) {
    return std::string(done) + (shown.list.type == Type::stops ? " Stop" : " Point");
}

bool followHand(const Shown& shown, const Sheet& sheet, const Area& whole, float near) {
    RampHand& hand = shown.editor.panelState.ramp;
    ImGuiContext& g = *ImGui::GetCurrentContext();
    const ImGuiID id = ImGui::GetID("##entries");
    const ImRect area(whole.lo, whole.hi);
    ImGui::SetCursorScreenPos(whole.lo);
    ImGui::ItemSize(area.GetSize(), ImGui::GetStyle().FramePadding.y);
    if (!ImGui::ItemAdd(area, id, nullptr, ImGuiItemFlags_Inputable)) return false;
    const bool asked = (g.LastItemData.StatusFlags & ImGuiItemStatusFlags_FocusedByTabbing) != 0 ||
                       g.NavActivateId == id || g.NavActivateInputId == id;
    const bool hovered = ImGui::ItemHoverable(area, id);
    const bool mine = hand.does != Does::nothing && hand.input == shown.path();
    const bool clicked = hovered && g.IO.MouseClicked[0] && !mine && !shown.editor.document.held();
    if (asked || clicked) takeKeyboard(id);
    if (g.ActiveId == id && g.IO.MouseClicked[0] && !hovered && !mine) ImGui::ClearActiveID();
    if (hovered && !mine && entryAt(shown, sheet, g.IO.MousePos, near))
        ImGui::SetMouseCursor(sheet.planar ? ImGuiMouseCursor_Hand : ImGuiMouseCursor_ResizeEW);
    if (clicked)
        press(shown, sheet, near);
    else if (mine)
        go(shown, sheet, whole);
    else if (g.ActiveId == id && !asked)
        hearKeys(shown, sheet);
    if (g.ActiveId == id) keepKeys(shown);
    ImGui::RenderNavHighlight(area, id);
    return g.ActiveId == id;
}

void showAddAndRemove(const Shown& shown) {
    const auto selected = selectedOf(shown);
    const bool stop = shown.list.type == Type::stops;
    ImGui::BeginDisabled(shown.list.count() >= kMostStops);
    if (ImGui::Button("+"))
        if (const auto more = divided(shown.list, selected.value_or(0), shown.interpolation))
            shown.apply(step(shown, "Add").c_str(), more->list, more->entry);
    ImGui::EndDisabled();
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("Add a %s half way to the next (Insert)", stop ? "stop" : "point");
    ImGui::SameLine();
    ImGui::BeginDisabled(!selected || shown.list.count() < 2);
    if (ImGui::Button("×"))
        if (const auto fewer = removed(shown.list, *selected))
            shown.apply(step(shown, "Remove").c_str(), fewer->list, fewer->entry);
    ImGui::EndDisabled();
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Remove the selected %s (Delete)", stop ? "stop" : "point");
}

}  // namespace ramps
}  // namespace fw::editor
