// The inputs of the active node: a row each.
#include <algorithm>
#include <cmath>

#include "editor/document/expression_inputs.h"
#include "editor/document/parameters.h"
#include "editor/panels/inspector.h"
#include "editor/panels/properties.h"
#include "editor/shell/theme.h"
#include "editor/splines/edits.h"
#include "editor/timeline/fields_in_time.h"
#include "graph/document/input_value.h"
#include "graph/document/named_parameters.h"
#include "graph/document/unit.h"

namespace fw::editor {

namespace {

constexpr std::size_t kPointsShown = 12;  // of a list, before it scrolls

/// What the parts of a row share.
struct Input {
    Editor& editor;
    const NodeBox& box;
    const Row& row;
    Plug plug;
    std::string_view scope() const { return editor.canvas.scope; }
    const Graph& graph() const { return editor.document.graph(); }
    std::string setName() const { return "Set " + readable(row.name) + " of " + titleOf(box); }
    void set(std::optional<InputValue> value) const {
        std::string name = value ? setName() : "Reset " + readable(row.name) + " of " + titleOf(box);
        editor.document.apply(std::move(name), setInput(graph(), scope(), plug, std::move(value)));
    }
    /// The input as HeldValue has it.
    std::string held() const { return pathOf(editor, plug.node) + "." + plug.name; }
};

bool isColor(const Row& row) { return row.spec && row.spec->unit == "color" && row.type == Type::vec3; }

/// Numbers side by side, each a field as on the canvas.
void showNumbers(const Input& input, float room) {
    NumberHand& hand = input.editor.panelState.number;
    Document& document = input.editor.document;
    const int count = input.row.type ? componentCount(*input.row.type) : 0;
    const std::string id = inputPath(input.scope(), input.plug);
    const NumberRow row(count, ImGui::GetContentRegionAvail().x - room);
    for (int c = 0; c < count; ++c) {
        const NumberRow::Place at = row.place(c, hand.types(id, c));
        if (at.byKey && hand.state == NumberHand::State::none)
            typeField(hand, document, input.scope(), input.box, input.row, c);
        showField(hand, document, input.scope(), input.box, input.row, c,
                  {at.area, ImGui::GetFont(), ImGui::GetFontSize(), at.hovered});
    }
    row.end();
}

/// A colour's button before its numbers.
void showColor(const Input& input) {
    std::vector<double> numbers = numbersOf(input.row);
    const Touched touched = pickColor("##color", numbers);
    follow(
        input.editor, "##color", touched, input.setName(),
        [&] {
            InputValue value{.value = numbers};
            return setInput(input.graph(), input.scope(), input.plug, std::move(value));
        },
        input.held());
    ImGui::SameLine();
}

void setPoints(const Input& input, std::vector<double> numbers) {
    input.set(listValue(Type::points, std::move(numbers)));
}

void showPoints(const Input& input) {
    std::vector<double> numbers = entriesOf(input.row);
    const std::size_t count = numbers.size() / 2;
    if (ImGui::SmallButton("Draw …")) openOutline(input.editor, input.plug.node, input.plug.name);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("The outline in a window of its own, to be drawn by hand");
    ImGui::SameLine();
    if (!ImGui::TreeNode("points", "%zu points", count)) return;
    const float line = ImGui::GetFrameHeightWithSpacing();
    ImGui::BeginChild("##points", {0, line * float(std::clamp<std::size_t>(count, 1, kPointsShown))});
    std::optional<std::size_t> removed, doubled;
    ImGuiListClipper clipper;
    clipper.Begin(int(count), line);
    while (clipper.Step())
        for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
            const std::size_t at = 2 * std::size_t(i);
            ImGui::PushID(i);
            ImGui::SetNextItemWidth(-2.6f * ImGui::GetFrameHeight());
            editNumbers(input.editor, "##point", std::span(numbers).subspan(at, 2), {.unit = "m"},
                        input.setName(),
                        [numbers, at, scope = std::string(input.scope()), plug = input.plug](
                            const Graph& graph, std::span<const double> to) {
                            InputValue value{.value = numbers};
                            std::ranges::copy(
                                to, std::get<std::vector<double>>(value.value).begin() + std::ptrdiff_t(at));
                            value.entry = entrySize(Type::points);
                            return setInput(graph, scope, plug, std::move(value));
                        });
            ImGui::SameLine();
            if (ImGui::SmallButton("+")) doubled = at;
            if (ImGui::IsItemHovered()) ImGui::SetTooltip("Add a point between this one and the next");
            ImGui::SameLine();
            if (ImGui::SmallButton("×")) removed = at;
            if (ImGui::IsItemHovered()) ImGui::SetTooltip("Remove the point");
            ImGui::PopID();
        }
    ImGui::EndChild();
    ImGui::TreePop();
    if (doubled) {
        const std::size_t next = *doubled + 2 < numbers.size() ? *doubled + 2 : 0;
        const double x = 0.5 * (numbers[*doubled] + numbers[next]),
                     y = 0.5 * (numbers[*doubled + 1] + numbers[next + 1]);
        numbers.insert(numbers.begin() + std::ptrdiff_t(*doubled) + 2, {x, y});
        setPoints(input, std::move(numbers));
    } else if (removed) {
        numbers.erase(numbers.begin() + std::ptrdiff_t(*removed),
                      numbers.begin() + std::ptrdiff_t(*removed) + 2);
        setPoints(input, std::move(numbers));
    }
}

/// Each knot's place in one line, and what else it has in the next.
void showKnots(const Input& input) {
    const std::optional<splines::Knots> knots = splines::knotsOf(*input.box.node);
    if (!knots) return;
    if (!ImGui::TreeNode("knots", "%zu points", knots->count())) return;
    const float line = 2 * ImGui::GetFrameHeightWithSpacing();
    ImGui::BeginChild("##knots",
                      {0, line * float(std::clamp<std::size_t>(knots->count(), 1, kPointsShown / 2))});
    std::optional<splines::Knots> changed;
    const auto part = [&](const char* id, std::size_t at, std::size_t many, const char* unit) {
        std::vector<double> now(knots->numbers.begin() + std::ptrdiff_t(at),
                                knots->numbers.begin() + std::ptrdiff_t(at + many));
        editNumbers(input.editor, id, now, {.unit = unit}, input.setName(),
                    [numbers = knots->numbers, at, scope = std::string(input.scope()), plug = input.plug](
                        const Graph& graph, std::span<const double> to) mutable {
                        std::ranges::copy(to, numbers.begin() + std::ptrdiff_t(at));
                        return setInput(graph, scope, plug, listValue(Type::knots, numbers));
                    });
    };
    ImGuiListClipper clipper;
    clipper.Begin(int(knots->count()), line);
    while (clipper.Step())
        for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
            const auto knot = std::size_t(i);
            ImGui::PushID(i);
            ImGui::SetNextItemWidth(-2.6f * ImGui::GetFrameHeight());
            part("##place", 5 * knot, 3, "m");
            ImGui::SameLine();
            if (ImGui::SmallButton("+")) {
                const SplinePtr spline = splines::splineOf(*knots);
                const bool last = knot + 1 == knots->count() && !knots->closed;
                std::optional<splines::Inserted> with;
                if (last)
                    with = splines::extended(*knots, true);
                else if (spline && knots->kind != SplineKind::bezier && knot + 1 < spline->knots.size())
                    with = splines::inserted(*knots, 0.5 * (spline->knots[knot] + spline->knots[knot + 1]));
                if (with) changed = with->knots;
            }
            if (ImGui::IsItemHovered()) ImGui::SetTooltip("Add a point behind this one");
            ImGui::SameLine();
            if (ImGui::SmallButton("×")) changed = splines::removed(*knots, knot);
            if (ImGui::IsItemHovered()) ImGui::SetTooltip("Remove the point");
            const float third = 0.3f * ImGui::GetContentRegionAvail().x;
            ImGui::SetNextItemWidth(third);
            part("##radius", 5 * knot + 3, 1, "");
            if (ImGui::IsItemHovered()) ImGui::SetTooltip("Radius: a share of that of what is made along it");
            ImGui::SameLine();
            ImGui::SetNextItemWidth(third);
            part("##twist", 5 * knot + 4, 1, "degrees");
            if (ImGui::IsItemHovered()) ImGui::SetTooltip("Twist, degrees");
            ImGui::PopID();
        }
    ImGui::EndChild();
    ImGui::TreePop();
    if (changed) input.set(listValue(Type::knots, changed->numbers));
}

/// What a word among the node's inputs says; the default where it is wired, or is none.
std::string wordOf(const NodeBox& box, std::string_view name) {
    const auto row = std::ranges::find(box.rows, name, &Row::name);
    return row != box.rows.end() && row->type == Type::string && !row->linked ? valueText(*row) : "";
}

void showEntries(const Input& input, float room) {
    const ramps::List list{*input.row.type, entriesOf(input.row)};
    const ramps::Shown shown{input.editor,
                             std::string(input.scope()),
                             input.plug.node,
                             input.plug.name,
                             list,
                             wordOf(input.box, "interpolation"),
                             wordOf(input.box, "ends"),
                             ImGui::GetContentRegionAvail().x - room};
    if (const auto problem = orderProblem(list.type, list.numbers)) {
        wrapped(themeColor(ThemeColor::error), *problem);
        if (ImGui::Button("Mend"))
            shown.apply(list.type == Type::stops ? "Mend Stops" : "Mend Points", ramps::mended(list), 0);
        return;
    }
    if (list.type == Type::stops)
        ramps::showRamp(shown);
    else
        ramps::showCurve(shown);
}

void showText(const Input& input, float room) {
    const FileKind* kind = input.row.spec ? input.row.spec->file : nullptr;
    const Plug plug = input.plug;
    const std::string scope(input.scope()), name = input.setName();
    const auto commit = [plug, scope, name](Editor& in, const std::string& text) {
        in.document.apply(name, setInput(in.document.graph(), scope, plug, InputValue{.value = text}));
    };
    if (kind)
        editFile(input.editor, "##text", valueText(input.row), *kind, room, commit);
    else if (input.row.spec && input.row.spec->lines)
        editLines(input.editor, "##text", valueText(input.row), commit);
    else
        editText(input.editor, "##text", valueText(input.row), "", commit);
}

void showChoice(const Input& input) {
    const std::vector<std::string>& options = input.row.spec->options;
    const std::string chosen = valueText(input.row);
    std::size_t index = std::size_t(std::ranges::find(options, chosen) - options.begin());
    if (chooseName("##choice", options, index)) input.set(InputValue{.value = options[index]});
}

void showLink(const Input& input, float room, std::string& goTo) {
    const Link& link = std::get<Link>(input.row.value->value);
    const NodeBox* source = input.editor.boxes->find(link.node);
    std::string words = "from " + (source ? titleOf(*source) : link.node);
    if (!link.output.empty()) words += " · " + readable(link.output);
    const float cut = ImGui::CalcTextSize("×").x + 2 * ImGui::GetStyle().FramePadding.x;
    const float wide = ImGui::GetContentRegionAvail().x - room - cut - ImGui::GetStyle().ItemSpacing.x;
    ImGui::PushStyleVar(ImGuiStyleVar_ButtonTextAlign, ImVec2(0.0f, 0.5f));
    if (ImGui::Button((words + "###from").c_str(), {std::max(wide, 20.0f), 0}))
        goTo = pathOf(input.editor, link.node);
    ImGui::PopStyleVar();
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s\nClick to go there", words.c_str());
    ImGui::SameLine();
    if (ImGui::Button("×"))
        input.editor.document.apply("Cut Wire", disconnect(input.graph(), input.scope(), input.plug));
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Cut the wire");
}

/// What an input without value starts with when it gets one: zeros.
std::optional<InputValue> firstValue(const Row& row) {
    if (row.type == Type::scalar || row.type == Type::integer) return InputValue{.value = 0.0};
    if (row.type == Type::vec2 || row.type == Type::vec3)
        return InputValue{.value = std::vector<double>(std::size_t(componentCount(*row.type)), 0.0)};
    return std::nullopt;
}

void showUnset(const Input& input) {
    const std::string words = valueText(input.row);
    ImGui::TextDisabled("%s", words.empty() ? "not connected" : words.c_str());
    const std::optional<InputValue> first = firstValue(input.row);
    if (!first) return;
    ImGui::SameLine();
    if (ImGui::SmallButton("Set")) input.set(first);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Give it a value of its own");
}

void showValue(const Input& input, const Track* track, float room, std::string& goTo) {
    const Row& row = input.row;
    if (row.linked) return showLink(input, room, goTo);
    if (track) {
        NumberRange range;
        if (row.spec) range.min = row.spec->min, range.max = row.spec->max, range.unit = row.spec->unit;
        return editAnimated(input.editor, "##animated", *track, range, readable(row.name), input.held());
    }
    if (row.type == Type::string && row.spec && !row.spec->options.empty()) return showChoice(input);
    if (row.type == Type::string || row.type == Type::image) return showText(input, room);
    if (row.type == Type::stops || (row.spec && row.spec->ordered)) return showEntries(input, room);
    if (row.type == Type::points) return showPoints(input);
    if (row.type == Type::knots) return showKnots(input);
    if (row.type == Type::boolean) {
        bool on = numbersOf(row).at(0) != 0.0;
        if (ImGui::Checkbox("##on", &on)) input.set(InputValue{.value = on});
        return;
    }
    const bool number = row.type == Type::scalar || row.type == Type::integer || row.type == Type::vec2 ||
                        row.type == Type::vec3;
    const bool given = row.value || (row.spec && row.spec->value.kind == InputDefault::Kind::numbers);
    if (!number || !given) return showUnset(input);
    if (isColor(row)) showColor(input);
    showNumbers(input, room);
}

/// Rename, type and removal of an expression's input.
void showExpressionMenu(const Input& input) {
    ImGui::Separator();
    const Plug plug = input.plug;
    const std::string scope(input.scope());
    ImGui::SetNextItemWidth(10.0f * ImGui::GetFontSize());
    editText(input.editor, "Name", plug.name, "", [plug, scope](Editor& in, const std::string& text) {
        Result<Graph> renamed = renameExpressionInput(in.document.graph(), scope, plug, text);
        if (!renamed) return say(in, "cannot rename: " + renamed.error().message);
        in.document.apply("Rename Input", std::move(*renamed));
    });
    if (!input.row.linked)
        for (const Type type : kExpressionTypes)
            if (ImGui::MenuItem(std::string(typeName(type)).c_str(), nullptr, input.row.type == type))
                input.editor.document.apply("Set Type of " + readable(plug.name),
                                            setExpressionType(input.graph(), input.scope(), plug, type));
    if (ImGui::MenuItem("Remove input"))
        input.editor.document.apply("Remove Input", setInput(input.graph(), input.scope(), plug, {}));
}

void showMenu(const Input& input) {
    const bool expression = roleOf(input.box.node->type) == NodeRole::expression;
    if (!expression && ImGui::MenuItem("Reset to default", nullptr, false, input.row.value != nullptr))
        input.set(std::nullopt);
    Document& document = input.editor.document;
    if (input.scope().empty()) {
        if (const auto parameter = parameterOf(input.graph(), input.plug)) {
            if (ImGui::MenuItem("Remove parameter"))
                document.apply("Remove Parameter", removeParameter(input.graph(), *parameter));
        } else {
            const std::string refusal = exposureRefusal(input.graph(), input.plug);
            if (ImGui::MenuItem("Expose as parameter", nullptr, false, refusal.empty()))
                document.apply("Expose " + readable(input.plug.name), exposeInput(input.graph(), input.plug));
            if (!refusal.empty() && ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
                ImGui::SetTooltip("%s", refusal.c_str());
        }
    }
    if (input.scope().empty()) {
        ImGui::Separator();
        showKeyEntries(input.editor, input.plug);
    }
    if (expression) showExpressionMenu(input);
}

void showInput(Editor& editor, const NodeBox& box, const Row& row, std::string& goTo) {
    const Input input{editor, box, row, {box.node->id, row.name}};
    const Timeline* timeline = editor.canvas.scope.empty() ? timelineOf(editor) : nullptr;
    const Track* track = nullptr;
    if (timeline)
        if (const auto index = trackOfInput(editor.document.graph(), *timeline, input.plug))
            track = &timeline->tracks[*index];
    const bool movable = timeline && (track || motionRefusal(editor.document.graph(), input.plug).empty());

    const float side = ImGui::GetFrameHeight(), gap = ImGui::GetStyle().ItemSpacing.x;
    const float menu = 0.9f * side, key = movable ? 0.8f * side + gap : 0.0f, room = menu + gap + key;
    propertyRow(readable(row.name), describe(row, unitOf(editor.document.graph())), room);
    const float right = ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x;
    const float top = ImGui::GetCursorPosY();
    const ImVec2 rowBegin = ImGui::GetCursorScreenPos();
    const float rowEnd = rowBegin.x + ImGui::GetContentRegionAvail().x;
    showValue(input, track, room, goTo);
    const ImVec2 after = ImGui::GetCursorPos();
    code::markRow(editor, row.name, rowBegin, {rowEnd, rowBegin.y + side});
    if (movable) {
        const bool here = track && keyAt(*track, editor.viewport.seconds);
        ImGui::SetCursorPos({right - menu - key, top});
        if (keyButton("##key", here, track != nullptr,
                      here ? "Remove the key at the time shown" : "Add a key at the time shown"))
            toggleKey(editor, *timeline,
                      track ? movedBy(*track) : Moved{Track::Target::input, input.plug.node, input.plug.name},
                      inputNumbers(*box.node, input.plug.name));
    }
    ImGui::SetCursorPos({right - menu, top});
    if (ImGui::Button("…", {menu, side})) ImGui::OpenPopup("menu");
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("What else can be done with this input");
    if (ImGui::BeginPopup("menu")) {
        showMenu(input);
        ImGui::EndPopup();
    }
    ImGui::SetCursorPos({after.x, std::max(after.y, ImGui::GetCursorPosY())});
}

}  // namespace

void showInputs(Editor& editor, const NodeBox& box, std::string& goTo) {
    if (!beginProperties("inputs")) return;
    for (const Row& row : box.rows) {
        if (row.output) continue;
        ImGui::PushID(row.name.c_str());
        showInput(editor, box, row, goTo);
        ImGui::PopID();
    }
    endProperties();
}

}  // namespace fw::editor
