#include "editor/controls/number.h"

#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "editor/shell/letters.h"
#include "editor/shell/theme.h"
#include "graph/document/unit.h"
#include "graph/language/typed_number.h"

namespace fw::editor {

namespace {

using State = NumberHand::State;

constexpr float kStillInNumber = 3.0f;  // pixels that a click may move
constexpr float kNumberRounding = 3.0f;
constexpr float kLeastTyped = 90.0f;  // pixels: the text field of a narrow number is wider than the number

bool pressedKey(ImGuiKey key) { return ImGui::IsKeyPressed(ImGui::GetKeyIndex(key)); }

double kept(double number, const NumberRange& range) {
    return std::clamp(range.whole ? std::round(number) : number, range.min, range.max);
}

/// What a frame of the text field came to.
struct Typed {
    std::optional<double> number = {};  ///< that was entered
    bool ended = false;                 ///< the field is to go
    int tab = 0;
    bool all = false, next = false;  ///< it was entered with Ctrl, with Shift
};

/// One frame of it, in place of the number, at ImGui's cursor.
Typed typeNumber(TypedNumber& edit, float width,
                 const std::function<Result<double>(std::string_view)>& numberOf) {
    ImGui::SetNextItemWidth(width);
    if (!edit.opened) ImGui::SetKeyboardFocusHere();
    if (!edit.begun.empty() && ImGui::GetActiveID() == ImGui::GetID("##typed")) {
        ImVector<ImWchar>& queue =
            ImGui::GetIO().InputQueueCharacters;  // over the text, all of which is selected
        for (auto letter = edit.begun.rbegin(); letter != edit.begun.rend(); ++letter)
            queue.insert(queue.begin(), ImWchar(*letter));
        edit.begun.clear();
    }
    // It takes Tab for itself, which would go to whatever comes next.
    const bool entered =
        ImGui::InputText("##typed", edit.text, sizeof edit.text,
                         ImGuiInputTextFlags_AutoSelectAll | ImGuiInputTextFlags_EnterReturnsTrue |
                             ImGuiInputTextFlags_AllowTabInput | ImGuiInputTextFlags_CallbackCharFilter,
                         [](ImGuiInputTextCallbackData* typed) { return typed->EventChar == '\t' ? 1 : 0; });
    const bool left = edit.opened && ImGui::IsItemDeactivated();
    const bool tab = edit.opened && ImGui::IsItemActive() && pressedKey(ImGuiKey_Tab);
    edit.opened = true;
    if (!edit.complaint.empty()) ImGui::SetTooltip("%s", edit.complaint.c_str());
    if (pressedKey(ImGuiKey_Escape)) return {.ended = true};
    if (!entered && !left && !tab) return {};
    const Result<double> number = numberOf(edit.text);
    if (!number) {
        edit.complaint = number.error().message;
        edit.opened = false;  // and goes on
        return {.ended = left && !entered};
    }
    if (tab) ImGui::ClearActiveID();
    const ImGuiIO& io = ImGui::GetIO();
    return {.number = *number,
            .ended = true,
            .tab = !tab          ? 0
                   : io.KeyShift ? -1
                                 : 1,
            .all = entered && io.KeyCtrl,
            .next = entered && io.KeyShift};
}

}  // namespace

TypedNumber::TypedNumber(double number) {
    std::snprintf(text, sizeof text, "%s", numberText(number).c_str());
}

void NumberHand::type(Document& document, std::string name, std::string_view whose, int which,
                      double number) {
    *this = {.state = State::typing,
             .hand = document.begin(std::move(name)),
             .id = std::string(whose),
             .part = which,
             .moves = {},
             .start = number,
             .travelled = 0,
             .typed = TypedNumber(number)};
}

std::set<std::string> heldBy(const NumberHand& hand) {
    if (hand.state != State::dragging || hand.moves.empty()) return {};
    return {hand.moves};
}

void NumberHand::follow(const Document& document) {
    if (state != State::none && !document.holds(hand)) *this = {};
}

namespace {

/// The number to the right, and its unit behind it where there is room for both.
void drawNumber(const NumberLook& look, const std::string& number, const std::string& unit) {
    const float margin = 0.35f * look.size;
    const auto wide = [&](const std::string& text) {
        return look.font->CalcTextSizeA(look.size, FLT_MAX, 0.0f, text.c_str()).x;
    };
    const std::string behind = unit.empty() || unit.starts_with("°") ? unit : " " + unit;
    if (unit.empty() || wide(number) + wide(behind) > look.place.width() - 2 * margin)
        return drawFieldText(look, number, true);
    NumberLook before = look;
    before.place.hi.x -= wide(behind);
    drawFieldText(before, number, true);
    const ImVec2 at(before.place.hi.x - margin, look.place.centre().y - 0.5f * look.size);
    ImGui::GetWindowDrawList()->AddText(look.font, look.size, {std::floor(at.x), std::floor(at.y)},
                                        themeColor(ThemeColor::quiet), behind.c_str());
}

/// The text field over a number; has the keyboard until Enter, Tab, Escape or a click elsewhere.
NumberDone typeOver(NumberHand& hand, Document& document, const NumberRange& range, const NumberLook& look,
                    const std::function<void(Hand, double)>& set,
                    const std::function<void(Hand, double)>& setAll) {
    const Area& place = look.place;
    ImGui::SetCursorScreenPos(place.lo);
    ImGui::PushFont(look.font);
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding,
                        ImVec2(4, std::max(0.0f, 0.5f * (place.height() - look.font->FontSize))));
    const auto numberOf = [&document, unit = range.unit](std::string_view text) {
        return typedNumber(text, unit, unitOf(document.graph()));
    };
    const Typed typed = typeNumber(hand.typed, std::max(place.width(), kLeastTyped), numberOf);
    ImGui::PopStyleVar();
    ImGui::PopFont();
    const Hand held = hand.hand;
    if (!typed.ended) {
        document.hold(held, [set, range, held, numberOf, text = std::string(hand.typed.text)] {
            if (const Result<double> number = numberOf(text)) set(held, kept(*number, range));
        });
        return {};
    }
    hand = {};
    if (typed.number) (typed.all && setAll ? setAll : set)(held, kept(*typed.number, range));
    document.end(held);
    return {.tab = typed.tab, .next = typed.next};
}

void drag(NumberHand& hand, Document& document, const NumberRange& range, const std::string& name,
          const std::function<void(Hand, double)>& set) {
    const ImGuiIO& io = ImGui::GetIO();
    document.hold(hand.hand);
    hand.travelled += io.MouseDelta.x * (io.KeyShift ? 0.1f : io.KeyAlt ? 10.0f : 1.0f);
    // With what it has travelled: a quick hand is there in one frame.
    if (hand.state == State::pressed && std::abs(ImGui::GetMouseDragDelta(0, 0.0f).x) > kStillInNumber)
        hand.state = State::dragging;
    if (pressedKey(ImGuiKey_Escape)) {
        // What is not the document's is taken back here.
        if (hand.state == State::dragging) set(hand.hand, hand.start);
        document.cancel(hand.hand);
        hand = {};
    } else if (!ImGui::IsMouseDown(0)) {
        if (hand.state == State::pressed)
            return hand.type(document, name, std::string(hand.id), hand.part, hand.start);
        document.end(hand.hand);
        hand = {};
    } else if (hand.state == State::dragging && io.MouseDelta.x != 0.0f) {
        // To what a person would write: three digits of the step.
        const double grain = std::pow(10.0, std::floor(std::log10(range.speed * (io.KeyShift ? 0.1 : 1.0))));
        const double moved = hand.start + double(hand.travelled) * range.speed;
        set(hand.hand, kept(std::round(moved / grain) * grain, range));
    }
}

}  // namespace

NumberDone showNumber(NumberHand& hand, Document& document, std::string_view id, int part, double number,
                      const NumberRange& range, const std::string& name, const NumberLook& look,
                      const std::function<void(Hand, double)>& set,
                      const std::function<void(Hand, double)>& setAll) {
    const bool mine = hand.is(id, part);
    if (mine && hand.state == State::typing) return typeOver(hand, document, range, look, set, setAll);
    const bool hovered =
        look.enabled && hand.state == State::none && ImGui::IsMouseHoveringRect(look.place.lo, look.place.hi);
    drawField(look.place, mine, hovered);
    if (look.animated)
        ImGui::GetWindowDrawList()->AddRect(look.place.lo, look.place.hi, themeColor(ThemeColor::active),
                                            kNumberRounding);
    drawNumber(look, numberText(number), unitSign(range.unit, unitOf(document.graph())));
    if (hovered || mine) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    if (mine) return drag(hand, document, range, name, set), NumberDone{};
    if (!hovered || !ImGui::IsMouseClicked(0)) return {};
    if (ImGui::GetIO().KeyCtrl) return {.reset = true};
    hand = {.state = State::pressed,
            .hand = document.begin(name),
            .id = std::string(id),
            .part = part,
            .moves = {},
            .start = number,
            .travelled = 0,
            .typed = {}};
    return {};
}

void drawField(const Area& place, bool active, bool hovered) {
    const ImU32 fill = ImGui::GetColorU32(active    ? ImGuiCol_FrameBgActive
                                          : hovered ? ImGuiCol_FrameBgHovered
                                                    : ImGuiCol_FrameBg);
    ImGui::GetWindowDrawList()->AddRectFilled(place.lo, place.hi, fill, kNumberRounding);
}

void drawFieldText(const NumberLook& look, const std::string& text, bool toTheRight) {
    const Area& place = look.place;
    const float margin = 0.35f * look.size;
    const std::string fits = fitted(text, place.width() - 2 * margin, look.font, look.size);
    const ImVec2 extent = look.font->CalcTextSizeA(look.size, FLT_MAX, 0.0f, fits.c_str());
    const ImVec2 at(toTheRight ? place.hi.x - margin - extent.x : place.lo.x + margin,
                    place.centre().y - 0.5f * extent.y);
    ImGui::GetWindowDrawList()->AddText(look.font, look.size, {std::floor(at.x), std::floor(at.y)},
                                        ImGui::GetColorU32(ImGuiCol_Text), fits.c_str());
}

std::string numberText(double number) {
    char text[32];
    std::snprintf(text, sizeof text, "%.9g", number == 0.0 ? 0.0 : number);
    return text;
}

}  // namespace fw::editor
