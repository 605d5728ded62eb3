#include "editor/canvas/fields.h"

#include <algorithm>
#include <cmath>

#include "editor/shell/theme.h"

namespace fw::editor {

namespace {

constexpr double kLeastPositive = 1e-6;

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

/// Along the frame's lower edge, where the keys are over the timeline, and the time shown.
void drawKeys(const Area& place, const MovedField& moved) {
    ImDrawList* list = ImGui::GetWindowDrawList();
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

std::string nameOfChange(const NodeBox& box, const Row& row, const MovedField* moved) {
    return moved ? "Set Key of " + readable(row.name) : setName(box, row);
}

/// The number field after this one on the node, or before it: what it takes to type it.
struct NextField {
    std::string name, id;
    int component = 0;
    double number = 0.0;
};
std::optional<NextField> nextField(std::string_view scope, const NodeBox& box, const Row& row, int component,
                                   int by) {
    std::ptrdiff_t at = &row - box.rows.data();
    component += by;
    const auto next = [&]() -> const Row& { return box.rows[std::size_t(at)]; };
    while (component < 0 || component >= next().fields || !next().typed()) {
        at += by;
        if (at < 0 || at >= std::ssize(box.rows)) return std::nullopt;
        component = by > 0 ? 0 : next().fields - 1;
    }
    return NextField{setName(box, next()), inputPath(scope, {box.node->id, next().name}), component,
                     numbersOf(next()).at(std::size_t(component))};
}

/// "5 points"
std::string countText(Type type, std::size_t numbers) {
    const std::size_t count = numbers / std::size_t(entrySize(type));
    const std::string words = std::to_string(count) + " " + std::string(typeName(type));
    return count == 1 ? words.substr(0, words.size() - 1) : words;
}

void showChoice(Document& document, std::string_view scope, const NodeBox& box, const Row& row,
                const NumberLook& look) {
    const Area& place = look.place;
    const bool hovered = look.enabled && ImGui::IsMouseHoveringRect(place.lo, place.hi);
    drawField(place, false, hovered);
    const auto* given = row.value ? std::get_if<std::string>(&row.value->value) : nullptr;
    const std::string chosen = given ? *given : row.spec->value.text;
    drawFieldText(look, readable(chosen) + " ▾", false);
    const std::string popup = inputPath(scope, {box.node->id, row.name});
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
                const NumberLook& look) {
    const bool hovered = look.enabled && ImGui::IsMouseHoveringRect(look.place.lo, look.place.hi);
    const bool on = numbersOf(row).at(0) != 0.0;
    drawField(look.place, on, hovered);
    drawFieldText(look, on ? "✓ on" : "off", false);
    if (!hovered || !ImGui::IsMouseClicked(0)) return;
    if (ImGui::GetIO().KeyCtrl)
        set(document, scope, box, row, std::nullopt);
    else
        set(document, scope, box, row, InputValue{.value = !on});
}

}  // namespace

std::string inputPath(std::string_view scope, const Plug& input) {
    return std::string(scope) + (scope.empty() ? "" : "/") + input.node + "." + input.name;
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

NumberRange rangeOf(const Row& row, double start) {
    NumberRange range;
    range.whole = row.type == Type::integer;
    // What a group or an expression takes it for is not known.
    range.unit = row.spec ? std::string_view(row.spec->unit) : "any";
    if (row.spec) range.min = row.spec->min, range.max = row.spec->max;
    if (row.spec && row.spec->positive) range.min = std::max(range.min, kLeastPositive);
    const double span = range.max - range.min;
    range.speed = range.whole           ? 0.1
                  : std::isfinite(span) ? span / 250.0
                                        : std::max(std::abs(start), 0.5) / 100.0;
    return range;
}

std::vector<double> entriesOf(const Row& row) {
    const auto* given = row.value ? std::get_if<std::vector<double>>(&row.value->value) : nullptr;
    if (given) return listOf(row.value->entry) == row.type ? *given : std::vector<double>();
    return row.spec && entrySize(row.spec->type) > 0 ? row.spec->value.numbers : std::vector<double>();
}

std::string valueText(const Row& row) {
    if (row.value) {
        if (const auto* words = std::get_if<std::string>(&row.value->value)) return *words;
        if (const auto* list = std::get_if<std::vector<double>>(&row.value->value))
            if (const auto type = listOf(row.value->entry)) return countText(*type, list->size());
    }
    if (!row.spec) return "";
    if (row.spec->value.kind == InputDefault::Kind::position) return "position";
    if (row.type && entrySize(*row.type) > 0) return countText(*row.type, row.spec->value.numbers.size());
    return row.spec->value.text;
}

bool showField(NumberHand& hand, Document& document, std::string_view scope, const NodeBox& box,
               const Row& row, int component, const NumberLook& look, const MovedField* moved) {
    if (row.type == Type::string) return showChoice(document, scope, box, row, look), false;
    if (row.type == Type::boolean) return showSwitch(document, scope, box, row, look), false;
    const Plug plug{box.node->id, row.name};
    const std::string id = inputPath(scope, plug);
    const auto at = std::size_t(component);
    const double number = moved ? std::round(moved->numbers.at(at) * 1e3) / 1e3 : numbersOf(row).at(at);
    const NumberRange range = rangeOf(row, hand.is(id, component) ? hand.start : number);
    // Before the change, which ends what `box` and `row` refer to.
    const bool typed = hand.types(id, component);
    const auto before = typed ? nextField(scope, box, row, component, -1) : std::nullopt,
               after = typed ? nextField(scope, box, row, component, 1) : std::nullopt;
    if (typed && moved && !hand.typed.opened && hand.typed.complaint.empty())
        hand.typed = TypedNumber(number);
    const auto to = [&document, group = std::string(scope), plug, component,
                     key = moved ? std::optional(*moved) : std::nullopt](Hand by, double wanted) {
        if (!key) return document.update(by, setNumber(document.graph(), group, plug, component, wanted));
        std::vector<double> numbers = key->numbers;
        numbers.at(std::size_t(component)) = wanted;
        document.update(by, key->set(document.graph(), numbers));
    };
    const auto toAll = [&document, group = std::string(scope), plug, fields = row.fields,
                        key = moved ? std::optional(*moved) : std::nullopt](Hand by, double wanted) {
        if (key)
            return document.update(
                by, key->set(document.graph(), std::vector<double>(key->numbers.size(), wanted)));
        Graph all = document.graph();
        for (int i = 0; i < fields; ++i) all = setNumber(all, group, plug, i, wanted);
        document.update(by, std::move(all));
    };
    NumberLook shown = look;
    shown.animated = moved != nullptr;
    const NumberDone done = showNumber(hand, document, id, component, number, range,
                                       nameOfChange(box, row, moved), shown, to, toAll);
    if (hand.is(id, component)) hand.moves = id;
    if (done.next) return true;
    if (moved && !typed) {
        drawKeys(look.place, *moved);
        if (look.enabled && hand.state == NumberHand::State::none &&
            ImGui::IsMouseHoveringRect(look.place.lo, look.place.hi))
            ImGui::SetTooltip("The timeline moves it: a change is a key at the time shown");
    }
    if (done.reset && !moved)
        set(document, scope, box, row, std::nullopt);
    else if (const auto& next = done.tab < 0 ? before : after; done.tab != 0 && next)
        hand.type(document, next->name, next->id, next->component, next->number);
    return false;
}

void typeField(NumberHand& hand, Document& document, std::string_view scope, const NodeBox& box,
               const Row& row, int component) {
    hand.type(document, setName(box, row), inputPath(scope, {box.node->id, row.name}), component,
              numbersOf(row).at(std::size_t(component)));
}

std::string describe(const Row& row, const LengthUnit& lengths) {
    std::string text = readable(row.name);
    if (row.type) text += "  (" + std::string(typeName(*row.type)) + ")";
    if (!row.spec) return text;
    if (const std::string sign = unitSign(row.spec->unit, lengths); !sign.empty()) text += ", " + sign;
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
