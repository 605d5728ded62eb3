#include "editor/canvas/fields.h"

#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "editor/shell/theme.h"
#include "graph/language/lower.h"

namespace fw::editor {

namespace {

using State = FieldEdit::State;

constexpr float kStillInField = 3.0f;  // pixels that a click may move
constexpr float kFieldRounding = 3.0f;

bool isInteger(const Row& row) { return row.type == Type::integer; }

std::string shorten(const std::string& text, ImFont* font, float size, float width) {
    if (font->CalcTextSizeA(size, FLT_MAX, 0.0f, text.c_str()).x <= width) return text;
    std::string cut = text;
    while (!cut.empty() && font->CalcTextSizeA(size, FLT_MAX, 0.0f, (cut + "…").c_str()).x > width) {
        do cut.pop_back();
        while (!cut.empty() && (cut.back() & 0xC0) == 0x80);
    }
    return cut + "…";
}

/// What a pixel of a drag adds.
double stepOf(const Row& row, double start) {
    if (isInteger(row)) return 0.1;
    const double span = row.spec ? row.spec->max - row.spec->min : INFINITY;
    if (std::isfinite(span)) return span / 250.0;
    return std::max(std::abs(start), 0.5) / 100.0;
}

std::string setName(const NodeBox& box, const Row& row) {
    return "Set " + readable(row.name) + " of " + titleOf(box);
}

void set(Document& document, std::string_view scope, const NodeBox& box, const Row& row,
         std::optional<InputValue> value) {
    // The name first: applying the change ends what `box` and `row` refer to.
    std::string name = setName(box, row);
    document.apply(std::move(name),
                   setInput(document.graph(), scope, {box.node->id, row.name}, std::move(value)));
}

void drawFrame(const Area& place, bool active, bool hovered) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImU32 fill = ImGui::GetColorU32(active    ? ImGuiCol_FrameBgActive
                                          : hovered ? ImGuiCol_FrameBgHovered
                                                    : ImGuiCol_FrameBg);
    list->AddRectFilled(place.lo, place.hi, fill, kFieldRounding);
}

/// Along the frame's lower edge, where the keys are over the timeline, and the time shown.
void drawKeys(const Area& place, const MovedField& moved) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddRect(place.lo, place.hi, themeColor(ThemeColor::active), kFieldRounding);
    // Below the digits.
    const float margin = 3.0f, left = place.lo.x + margin, wide = place.width() - 2.0f * margin,
                high = std::max(std::floor(0.12f * place.height()), 2.0f), bottom = place.hi.y - 1.0f;
    const auto mark = [&](float share, float half, ImU32 color) {
        const float x = std::floor(left + share * wide);
        list->AddRectFilled({x - half, bottom - high}, {x + half + 1.0f, bottom}, color);
    };
    for (float share : moved.keys) mark(share, 0.0f, themeColor(ThemeColor::quiet));
    mark(moved.now, 0.5f, themeColor(ThemeColor::active));
}

void drawText(const Area& place, ImFont* font, float size, const std::string& text, bool toTheRight,
              ImU32 color) {
    const float margin = 0.35f * size;
    const std::string fits = shorten(text, font, size, place.width() - 2 * margin);
    const ImVec2 extent = font->CalcTextSizeA(size, FLT_MAX, 0.0f, fits.c_str());
    const ImVec2 at(toTheRight ? place.hi.x - margin - extent.x : place.lo.x + margin,
                    place.centre().y - 0.5f * extent.y);
    ImGui::GetWindowDrawList()->AddText(font, size, {std::floor(at.x), std::floor(at.y)}, color,
                                        fits.c_str());
}

/// The number field after this one on the node, or before it, is typed next; none beyond its ends.
void typeNext(FieldEdit& edit, std::string_view scope, const NodeBox& box, const Row& row, int component,
              int by) {
    std::ptrdiff_t at = &row - box.rows.data();
    component += by;
    const auto next = [&]() -> const Row& { return box.rows[std::size_t(at)]; };
    while (component < 0 || component >= next().fields || !next().typed()) {
        at += by;
        if (at < 0 || at >= std::ssize(box.rows)) return;
        component = by > 0 ? 0 : next().fields - 1;
    }
    edit.type(scope, {box.node->id, next().name}, component, numbersOf(next()).at(std::size_t(component)));
}

/// The number in its place, in the input or, if the timeline moves it, in a key.
Graph withNumber(const Graph& graph, std::string_view scope, const NodeBox& box, const Row& row,
                 int component, double number, const MovedField* moved) {
    InputValue value = withComponent(row, component, number);
    if (!moved) return setInput(graph, scope, {box.node->id, row.name}, std::move(value));
    const auto* one = std::get_if<double>(&value.value);
    std::vector<double> numbers = moved->numbers;
    const auto at = std::size_t(component);
    numbers.at(at) = one ? *one : std::get<std::vector<double>>(value.value).at(at);
    return moved->set(graph, numbers);
}

std::string nameOfChange(const NodeBox& box, const Row& row, const MovedField* moved) {
    return moved ? "Set Key of " + readable(row.name) : setName(box, row);
}

/// The text field over a number; takes the keyboard until Enter, Tab, Escape or a click elsewhere.
void typeField(FieldEdit& edit, Document& document, std::string_view scope, const NodeBox& box,
               const Row& row, int component, const Area& place, ImFont* font, const MovedField* moved) {
    if (moved && !edit.typed.opened && edit.typed.complaint.empty())
        edit.typed = TypedNumber(moved->numbers.at(std::size_t(component)));
    ImGui::SetCursorScreenPos(place.lo);
    ImGui::PushFont(font);
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding,
                        ImVec2(4, std::max(0.0f, 0.5f * (place.height() - font->FontSize))));
    const Typed typed = typeNumber(edit.typed, std::max(place.width(), 90.0f));
    ImGui::PopStyleVar();
    ImGui::PopFont();
    if (!typed.ended) return;
    edit = {};
    if (typed.tab != 0) typeNext(edit, scope, box, row, component, typed.tab);
    if (!typed.number) return;
    std::string name = nameOfChange(box, row, moved);
    document.apply(std::move(name),
                   withNumber(document.graph(), scope, box, row, component, *typed.number, moved));
}

void dragNumber(FieldEdit& edit, Document& document, std::string_view scope, const NodeBox& box,
                const Row& row, int component, const MovedField* moved) {
    const ImGuiIO& io = ImGui::GetIO();
    const float speed = io.KeyShift ? 0.1f : io.KeyAlt ? 10.0f : 1.0f;
    edit.travelled += io.MouseDelta.x * speed;
    if (edit.state == State::pressed && std::abs(ImGui::GetMouseDragDelta(0, 0.0f).x) > kStillInField) {
        edit.state = State::dragging;  // with what it has travelled: a quick hand is there in one frame
        document.begin(nameOfChange(box, row, moved));
    }
    if (!ImGui::IsMouseDown(0)) {
        if (edit.state == State::dragging) {
            document.end();
            edit = {};
            return;
        }
        edit.type(edit.scope, edit.input, component, edit.start);
        return;
    }
    if (edit.state == State::dragging && ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) {
        document.cancel();
        edit = {};
    } else if (edit.state == State::dragging && io.MouseDelta.x != 0.0f) {
        const double wanted = edit.start + double(edit.travelled) * stepOf(row, edit.start);
        // To what a person would write: three digits of the step.
        const double grain =
            std::pow(10.0, std::floor(std::log10(stepOf(row, edit.start) * (io.KeyShift ? 0.1 : 1.0))));
        const double number = std::round(wanted / grain) * grain;
        document.update(withNumber(document.graph(), scope, box, row, component, number, moved));
    }
}

void showChoice(Document& document, std::string_view scope, const NodeBox& box, const Row& row,
                const Area& place, ImFont* font, float size, bool enabled) {
    const bool hovered = enabled && ImGui::IsMouseHoveringRect(place.lo, place.hi);
    drawFrame(place, false, hovered);
    const auto* given = row.value ? std::get_if<std::string>(&row.value->value) : nullptr;
    const std::string chosen = given ? *given : row.spec->value.text;
    drawText(place, font, size, readable(chosen) + " ▾", false, ImGui::GetColorU32(ImGuiCol_Text));
    const std::string popup = box.node->id + "." + row.name;
    if (hovered && ImGui::IsMouseClicked(0)) {
        if (ImGui::GetIO().KeyCtrl) return set(document, scope, box, row, std::nullopt);
        ImGui::OpenPopup(popup.c_str());
    }
    if (!ImGui::BeginPopup(popup.c_str())) return;
    std::optional<std::string> wanted;
    for (const std::string& option : row.spec->options)
        if (ImGui::Selectable(readable(option).c_str(), option == chosen)) wanted = option;
    ImGui::EndPopup();
    if (wanted) set(document, scope, box, row, InputValue{.value = *wanted});
}

void showSwitch(Document& document, std::string_view scope, const NodeBox& box, const Row& row,
                const Area& place, ImFont* font, float size, bool enabled) {
    const bool hovered = enabled && ImGui::IsMouseHoveringRect(place.lo, place.hi);
    const bool on = numbersOf(row).at(0) != 0.0;
    drawFrame(place, on, hovered);
    drawText(place, font, size, on ? "✓ on" : "off", false, ImGui::GetColorU32(ImGuiCol_Text));
    if (!hovered || !ImGui::IsMouseClicked(0)) return;
    if (ImGui::GetIO().KeyCtrl)
        set(document, scope, box, row, std::nullopt);
    else
        set(document, scope, box, row, InputValue{.value = !on});
}

}  // namespace

TypedNumber::TypedNumber(double number) {
    std::snprintf(text, sizeof text, "%s", numberText(number).c_str());
}

Typed typeNumber(TypedNumber& edit, float width) {
    ImGui::SetNextItemWidth(width);
    if (!edit.opened) ImGui::SetKeyboardFocusHere();
    // It takes Tab for itself, which would go to whatever comes next; and no blanks, of which Tab is one.
    const bool entered =
        ImGui::InputText("##typed", edit.text, sizeof edit.text,
                         ImGuiInputTextFlags_AutoSelectAll | ImGuiInputTextFlags_EnterReturnsTrue |
                             ImGuiInputTextFlags_AllowTabInput | ImGuiInputTextFlags_CharsNoBlank);
    const bool left = edit.opened && ImGui::IsItemDeactivated();
    const auto pressed = [](ImGuiKey key) { return ImGui::IsKeyPressed(ImGui::GetKeyIndex(key)); };
    const bool tab = edit.opened && ImGui::IsItemActive() && pressed(ImGuiKey_Tab);
    edit.opened = true;
    if (!edit.complaint.empty()) ImGui::SetTooltip("%s", edit.complaint.c_str());
    if (pressed(ImGuiKey_Escape)) return {.ended = true};
    if (!entered && !left && !tab) return {};
    const Result<double> number = numberOf(edit.text);
    if (!number) {
        edit.complaint = number.error().message;
        edit.opened = false;  // and goes on
        return {.ended = left && !entered};
    }
    if (tab) ImGui::ClearActiveID();
    return {.number = *number, .ended = true, .tab = !tab ? 0 : ImGui::GetIO().KeyShift ? -1 : 1};
}

void FieldEdit::type(std::string_view of, const Plug& plug, int part, double number) {
    state = State::typing;
    scope = std::string(of), input = plug, component = part, start = number;
    typed = TypedNumber(number);
}

std::set<std::string> FieldEdit::held() const {
    if (state != State::dragging) return {};
    return {(scope.empty() ? "" : scope + "/") + input.node + "." + input.name};
}

Result<double> numberOf(std::string_view text) {
    language::Lowering state;
    const Result<language::Value> value =
        language::lowerText(state, "return float(" + std::string(text) + ");");
    if (!value) return value.error();
    const IrId id = value->id();
    if (!state.ir.isConstant(id)) return Error{.message = "this depends on the position or the time"};
    if (!std::isfinite(state.ir.number(id))) return Error{.message = "this is no finite number"};
    return state.ir.number(id);
}

std::string numberText(double number) {
    char text[32];
    std::snprintf(text, sizeof text, "%.9g", number == 0.0 ? 0.0 : number);
    return text;
}

std::vector<double> numbersOf(const Row& row) {
    const std::size_t count = row.type ? std::size_t(componentCount(*row.type)) : 0;
    std::vector<double> numbers;
    if (row.value) {
        if (const auto* number = std::get_if<double>(&row.value->value)) numbers = {*number};
        if (const auto* flag = std::get_if<bool>(&row.value->value)) numbers = {*flag ? 1.0 : 0.0};
        if (const auto* list = std::get_if<std::vector<double>>(&row.value->value)) numbers = *list;
    }
    if (numbers.empty() && row.spec) numbers = row.spec->value.numbers;
    // One number stands for a vector of it.
    numbers.resize(count, numbers.size() == 1 ? numbers[0] : 0.0);
    return numbers;
}

InputValue withComponent(const Row& row, int component, double number) {
    std::vector<double> numbers = numbersOf(row);
    if (isInteger(row)) number = std::round(number);
    if (row.spec) {
        number = std::clamp(number, row.spec->min, row.spec->max);
        if (row.spec->positive) number = std::max(number, 1e-6);
    }
    numbers.at(std::size_t(component)) = number;
    if (numbers.size() == 1) return {.value = numbers[0]};
    return {.value = numbers};
}

std::string valueText(const Row& row) {
    if (row.value) {
        if (const auto* words = std::get_if<std::string>(&row.value->value)) return *words;
        if (const auto* list = std::get_if<std::vector<double>>(&row.value->value))
            if (row.value->pairs) return std::to_string(list->size() / 2) + " points";
    }
    if (!row.spec) return "";
    if (row.spec->value.kind == InputDefault::Kind::position) return "position";
    if (row.type == Type::points) return std::to_string(row.spec->value.numbers.size() / 2) + " points";
    return row.spec->value.text;
}

void showField(FieldEdit& edit, Document& document, std::string_view scope, const NodeBox& box,
               const Row& row, int component, const Area& place, ImFont* font, float size, bool enabled,
               const MovedField* moved) {
    if (row.type == Type::string) return showChoice(document, scope, box, row, place, font, size, enabled);
    if (row.type == Type::boolean) return showSwitch(document, scope, box, row, place, font, size, enabled);
    const Plug plug{box.node->id, row.name};
    const bool mine = edit.is(scope, plug, component);
    if (mine && edit.state == State::typing)
        return typeField(edit, document, scope, box, row, component, place, font, moved);
    const bool hovered =
        enabled && edit.state == State::none && ImGui::IsMouseHoveringRect(place.lo, place.hi);
    const auto at = std::size_t(component);
    const double number = moved ? std::round(moved->numbers.at(at) * 1e3) / 1e3 : numbersOf(row).at(at);
    drawFrame(place, mine, hovered);
    if (moved) drawKeys(place, *moved);
    drawText(place, font, size, numberText(number), true, ImGui::GetColorU32(ImGuiCol_Text));
    if (moved && hovered && !mine)
        ImGui::SetTooltip("The timeline moves it: a change is a key at the time shown");
    if (hovered || mine) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    if (mine) return dragNumber(edit, document, scope, box, row, component, moved);
    if (!hovered || !ImGui::IsMouseClicked(0)) return;
    if (ImGui::GetIO().KeyCtrl && moved) return;
    if (ImGui::GetIO().KeyCtrl) return set(document, scope, box, row, std::nullopt);
    edit = {};
    edit.state = State::pressed;
    edit.scope = scope;
    edit.input = plug;
    edit.component = component;
    edit.start = number;
}

std::string describe(const Row& row) {
    std::string text = readable(row.name);
    if (row.type) text += "  (" + std::string(typeName(*row.type)) + ")";
    if (!row.spec) return text;
    if (!row.spec->unit.empty()) text += ", " + row.spec->unit;
    const bool least = std::isfinite(row.spec->min), most = std::isfinite(row.spec->max);
    if (row.spec->positive)
        text += ", above 0";
    else if (least && most)
        text += ", " + numberText(row.spec->min) + " to " + numberText(row.spec->max);
    else if (least)
        text += ", at least " + numberText(row.spec->min);
    else if (most)
        text += ", at most " + numberText(row.spec->max);
    if (!row.spec->doc.empty()) text += "\n" + row.spec->doc;
    return text;
}

}  // namespace fw::editor
