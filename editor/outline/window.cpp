#include "editor/outline/window.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "editor/editor.h"
#include "editor/panels/properties.h"
#include "editor/shell/theme.h"
#include "graph/assets/image.h"

namespace fw::editor {

namespace {

using outline::Points;
using outline::Window;
using Does = Window::Does;

constexpr double kReach = 8.0;  // pixels from a point or a side to the mouse, at scale 1
constexpr double kLeastZoom = 1e-3, kMostZoom = 1e7;
constexpr std::size_t kMostChecked = 600;  // points of an outline that is looked through for crossings

/// The points as the document has them; none if the input is gone, or is wired.
std::optional<Points> pointsOf(const Editor& editor) {
    const Window& window = editor.outline;
    const Node* node = findNode(nodesOf(editor.document.graph(), window.scope), window.node);
    const NodeType* type = node ? findNodeType(node->type) : nullptr;
    const int index = type ? inputIndex(*type, window.input) : -1;
    if (index < 0 || type->inputs[std::size_t(index)].type != Type::points) return std::nullopt;
    Points points{type->inputs[std::size_t(index)].value.numbers, window.selected};
    if (const InputValue* given = node->input(window.input)) {
        const auto* numbers = std::get_if<std::vector<double>>(&given->value);
        if (!numbers) return std::nullopt;
        points.numbers = *numbers;
    }
    std::erase_if(points.selected, [&](std::size_t each) { return each >= points.count(); });
    return points;
}

Graph withPoints(const Editor& editor, const Points& points) {
    const Window& window = editor.outline;
    InputValue value{.value = points.numbers};
    value.entry = entrySize(Type::points);
    return setInput(editor.document.graph(), window.scope, {window.node, window.input}, std::move(value));
}

/// One step of undo, with what is selected after it.
void change(Editor& editor, const char* name, const Points& points) {
    editor.document.apply(name, withPoints(editor, points));
    editor.outline.selected = points.selected;
}

/// Between metres and the window's pixels; y is up.
struct Sheet {
    Area place;
    Position middle;
    double zoom;

    ImVec2 toScreen(Position at) const {
        const ImVec2 centre = place.centre();
        return {centre.x + float((at[0] - middle[0]) * zoom), centre.y - float((at[1] - middle[1]) * zoom)};
    }
    Position toSheet(ImVec2 at) const {
        const ImVec2 centre = place.centre();
        return {middle[0] + double(at.x - centre.x) / zoom, middle[1] - double(at.y - centre.y) / zoom};
    }
};

void frameAll(Window& window, const Points& points, const Area& place) {
    Position lo{-0.5, -0.5}, hi{0.5, 0.5};
    for (std::size_t i = 0; i < points.count(); ++i)
        for (std::size_t axis = 0; axis < 2; ++axis) {
            const double at = points.at(i)[axis];
            lo[axis] = i == 0 ? at : std::min(lo[axis], at);
            hi[axis] = i == 0 ? at : std::max(hi[axis], at);
        }
    window.middle = {0.5 * (lo[0] + hi[0]), 0.5 * (lo[1] + hi[1])};
    // In less of what the numbers are themselves no pixels could be told apart.
    const double least = std::max(1e-6, 1e-9 * std::max({std::abs(lo[0]), std::abs(hi[0]), std::abs(lo[1]),
                                                         std::abs(hi[1])})),
                 wide = std::max(hi[0] - lo[0], least), high = std::max(hi[1] - lo[1], least);
    window.zoom = 0.8 * std::min(double(place.width()) / wide, double(place.height()) / high);
}

void drawGrid(const Window& window, const Sheet& sheet) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    double step = window.step;
    while (step * sheet.zoom < 12.0) step *= 10.0;
    const Position lo = sheet.toSheet({sheet.place.lo.x, sheet.place.hi.y}),
                   hi = sheet.toSheet({sheet.place.hi.x, sheet.place.lo.y});
    constexpr double kMostLines = 2000.0;
    for (std::size_t axis = 0; axis < 2; ++axis) {
        // Counted, since far from the origin the next number may be the same.
        const double first = std::ceil(lo[axis] / step),
                     count = std::min(std::floor(hi[axis] / step) - first, kMostLines);
        for (double i = 0.0; i <= count; ++i) {
            const double k = first + i;
            const ImVec2 at = sheet.toScreen({k * step, k * step});
            const bool zero = k == 0.0;
            const ImU32 color = zero ? axisColor(1 - axis) : themeColor(ThemeColor::grid);
            if (axis == 0)
                list->AddLine({at.x, sheet.place.lo.y}, {at.x, sheet.place.hi.y}, color, zero ? 1.5f : 1.0f);
            else
                list->AddLine({sheet.place.lo.x, at.y}, {sheet.place.hi.x, at.y}, color, zero ? 1.5f : 1.0f);
        }
    }
}

void drawPicture(const Window& window, const Sheet& sheet) {
    if (!window.picture || window.pictureStrength <= 0.0f) return;
    const double wide = window.pictureWidth, high = wide / window.pictureAspect;
    ImGui::GetWindowDrawList()->AddImage(window.picture, sheet.toScreen({-0.5 * wide, 0.5 * high}),
                                         sheet.toScreen({0.5 * wide, -0.5 * high}), {0, 0}, {1, 1},
                                         ImGui::GetColorU32({1, 1, 1, window.pictureStrength}));
}

void drawOutline(const Editor& editor, const Sheet& sheet, const Points& points) {
    const Window& window = editor.outline;
    ImDrawList* list = ImGui::GetWindowDrawList();
    const float scale = editor.shell.scale();
    std::vector<ImVec2> corners;
    for (std::size_t i = 0; i < points.count(); ++i) corners.push_back(sheet.toScreen(points.at(i)));
    const bool crosses = points.count() <= kMostChecked && outline::crossesItself(points);
    list->AddPolyline(corners.data(), int(corners.size()),
                      themeColor(crosses ? ThemeColor::warning : ThemeColor::text), ImDrawFlags_Closed,
                      2.0f * scale);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const bool selected = window.selected.contains(i);
        const float half = (selected ? 5.0f : 4.0f) * scale;
        const ImVec2 c = corners[i];
        list->AddRectFilled({c.x - half, c.y - half}, {c.x + half, c.y + half},
                            themeColor(selected ? ThemeColor::active : ThemeColor::node));
        list->AddRect({c.x - half, c.y - half}, {c.x + half, c.y + half}, themeColor(ThemeColor::text));
    }
    if (window.does == Does::box)
        list->AddRect(window.from, ImGui::GetIO().MousePos, themeColor(ThemeColor::selected));
}

/// The mouse went down.
void press(Editor& editor, const Sheet& sheet, const Points& points, int button) {
    Window& window = editor.outline;
    const ImGuiIO& io = ImGui::GetIO();
    window.from = io.MousePos, window.button = button;
    if (button > 0) return void(window.does = Does::pan);
    const Position at = sheet.toSheet(io.MousePos);
    const double reach = kReach * double(editor.shell.scale()) / sheet.zoom;
    const auto point = outline::pointAt(points, at, reach);
    const bool adds = io.KeyShift || io.KeyCtrl;
    if (ImGui::IsMouseDoubleClicked(0)) {
        Points next = points;
        if (point) {
            next.selected = {*point};
            const Points fewer = outline::removed(next);
            if (fewer == next) return say(editor, "an outline has three points at least");
            return change(editor, "Remove Point", fewer);
        }
        if (const auto spot = outline::sideAt(points, at, INFINITY)) {
            const bool near = outline::sideAt(points, at, reach).has_value();
            next = outline::inserted(points, spot->after, near ? spot->place : at);
            return change(editor, "Add Point",
                          outline::moved(next, {0, 0}, window.snaps ? window.step : 0.0));
        }
        return;
    }
    if (!point) {
        window.kept = adds ? window.selected : outline::Selection{};
        window.selected = window.kept;
        window.does = Does::box;
        return;
    }
    if (adds && window.selected.contains(*point)) return void(window.selected.erase(*point));
    if (!adds && !window.selected.contains(*point)) window.selected.clear();
    window.selected.insert(*point);
    window.before = points, window.before.selected = window.selected;
    window.does = Does::press;
}

void go(Editor& editor, const Sheet& sheet, const Points& points) {
    Window& window = editor.outline;
    const ImGuiIO& io = ImGui::GetIO();
    const bool down = ImGui::IsMouseDown(window.button);
    const ImVec2 by(io.MousePos.x - window.from.x, io.MousePos.y - window.from.y);
    switch (window.does) {
        case Does::nothing: return;
        case Does::pan:
            window.middle[0] -= double(io.MouseDelta.x) / sheet.zoom;
            window.middle[1] += double(io.MouseDelta.y) / sheet.zoom;
            break;
        case Does::box: {
            window.selected = outline::within(points, sheet.toSheet(window.from), sheet.toSheet(io.MousePos));
            window.selected.insert(window.kept.begin(), window.kept.end());
            break;
        }
        case Does::press:
            if (!down || std::hypot(by.x, by.y) < 3.0f * editor.shell.scale()) break;
            window.hand = editor.document.begin(window.selected.size() == 1 ? "Move Point" : "Move Points");
            window.does = Does::move;
            [[fallthrough]];
        case Does::move: {
            if (!editor.document.hold(window.hand)) return void(window.does = Does::nothing);
            if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) {
                editor.document.cancel(window.hand);
                window.does = Does::nothing;
                return;
            }
            const bool snaps = window.snaps != io.KeyCtrl;
            const Points next =
                outline::moved(window.before, {double(by.x) / sheet.zoom, -double(by.y) / sheet.zoom},
                               snaps ? window.step : 0.0);
            if (next.numbers != points.numbers) editor.document.update(window.hand, withPoints(editor, next));
            if (!down) editor.document.end(window.hand);
            break;
        }
    }
    if (!down) window.does = Does::nothing;
}

void followKeys(Editor& editor, const Points& points) {
    Window& window = editor.outline;
    const ImGuiIO& io = ImGui::GetIO();
    if (io.WantTextInput || window.does != Does::nothing) return;
    const auto pressed = [](ImGuiKey key) { return ImGui::IsKeyPressed(ImGui::GetKeyIndex(key)); };
    if (io.KeyCtrl && pressed(ImGuiKey_A)) {
        for (std::size_t i = 0; i < points.count(); ++i) window.selected.insert(i);
    } else if (pressed(ImGuiKey_Delete) || pressed(ImGuiKey_Backspace) ||
               (!io.KeyCtrl && pressed(ImGuiKey_X))) {
        const Points fewer = outline::removed(points);
        if (!points.selected.empty() && fewer == points) say(editor, "an outline has three points at least");
        if (!(fewer == points)) change(editor, "Remove Points", fewer);
    } else if (pressed(ImGuiKey_Home)) {
        window.zoom = 0.0;
    } else if (pressed(ImGuiKey_Escape)) {
        window.open = false;
        editor.panels.next = Part::canvas;
    }
    for (const auto& [key, x, y] : {std::tuple(ImGuiKey_LeftArrow, -1, 0),
                                    {ImGuiKey_RightArrow, 1, 0},
                                    {ImGuiKey_DownArrow, 0, -1},
                                    {ImGuiKey_UpArrow, 0, 1}})
        if (!points.selected.empty() && pressed(key))
            change(editor, "Move Points", outline::moved(points, {x * window.step, y * window.step}, 0.0));
}

void readPicture(Editor& editor, const std::string& path) {
    Window& window = editor.outline;
    const std::filesystem::path file = path;
    const Result<FieldImagePtr> read =
        readImage((file.parent_path() / "x").string(), file.filename().string());
    if (!read) return say(editor, format(read.error()));
    const FieldImage& image = **read;
    Picture picture{image.width, image.height, {}};
    picture.pixels.reserve(4 * image.texels.size());
    for (int y = image.height - 1; y >= 0; --y)
        for (int x = 0; x < image.width; ++x) {
            const uint32_t texel = image.texels[std::size_t(y) * std::size_t(image.width) + std::size_t(x)];
            for (const unsigned shift : {0u, 8u, 16u}) picture.pixels.push_back(uint8_t(texel >> shift));
            picture.pixels.push_back(255);
        }
    window.picture = editor.shell.show(window.picture, picture);
    window.pictureAspect = double(image.width) / double(image.height);
}

void showTools(Editor& editor, const Points& points) {
    Window& window = editor.outline;
    const float em = ImGui::GetFontSize();
    ImGui::Checkbox("Snap", &window.snaps);
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("To the grid, while points are moved; Ctrl turns it around");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(5.0f * em);
    dragNumbers(editor, "##step", std::span(&window.step, 1),
                {.min = 1e-4, .max = 1e3, .speed = 0.01, .unit = "m"},
                [&window](std::span<const double> to) { window.step = to[0]; });
    ImGui::SameLine();
    if (ImGui::Button("Divide")) change(editor, "Divide Sides", outline::divided(points));
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("A point in the middle of each side whose ends are selected");
    ImGui::SameLine();
    if (ImGui::Button("Mirror")) change(editor, "Mirror Outline", outline::mirrored(points, 0));
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("The right side on the left too");
    ImGui::SameLine();
    if (ImGui::Button("Flip x")) change(editor, "Flip Outline", outline::flipped(points, 0));
    ImGui::SameLine();
    if (ImGui::Button("Flip y")) change(editor, "Flip Outline", outline::flipped(points, 1));
    ImGui::SameLine();
    if (ImGui::Button("All")) window.zoom = 0.0;
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Show all of it (Home)");
    ImGui::SameLine();
    if (ImGui::Button("Picture …")) {
        window.browser.endings.assign(kPictureFile.endings.begin(), kPictureFile.endings.end());
        open(window.browser, FileBrowser::Kind::open, workFolder(editor));
    }
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("A picture behind the outline, to draw it after");
    if (window.picture) {
        ImGui::SameLine();
        ImGui::SetNextItemWidth(5.0f * em);
        dragNumbers(editor, "##wide", std::span(&window.pictureWidth, 1),
                    {.min = 1e-3, .max = 1e4, .unit = "m"},
                    [&window](std::span<const double> to) { window.pictureWidth = to[0]; });
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("Width of the picture");
        ImGui::SameLine();
        if (ImGui::SmallButton("×")) editor.shell.forget(std::exchange(window.picture, nullptr));
    }
}

/// Where the selected point is, to be typed; how many there are.
void showPlaceOf(Editor& editor, const Points& points) {
    const Window& window = editor.outline;
    ImGui::AlignTextToFramePadding();
    if (window.selected.size() != 1) {
        ImGui::TextDisabled("%zu points, %zu selected", points.count(), window.selected.size());
        return;
    }
    const std::size_t at = *window.selected.begin();
    ImGui::TextDisabled("Point %zu of %zu", at + 1, points.count());
    ImGui::SameLine();
    ImGui::SetNextItemWidth(14.0f * ImGui::GetFontSize());
    editNumbers(editor, "##place", std::span(points.numbers).subspan(2 * at, 2), {.unit = "m"}, "Move Point",
                [numbers = points.numbers, at, scope = window.scope, plug = Plug{window.node, window.input}](
                    const Graph& graph, std::span<const double> to) {
                    InputValue value{.value = numbers};
                    std::ranges::copy(
                        to, std::get<std::vector<double>>(value.value).begin() + std::ptrdiff_t(2 * at));
                    value.entry = entrySize(Type::points);
                    return setInput(graph, scope, plug, std::move(value));
                });
}

void showSheet(Editor& editor, const Points& points) {
    Window& window = editor.outline;
    const ImVec2 lo = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
    const float below = ImGui::GetFrameHeightWithSpacing();
    const ImVec2 size(std::max(room.x, 50.0f), std::max(room.y - below, 50.0f));
    const Area place{lo, {lo.x + size.x, lo.y + size.y}};
    if (window.zoom <= 0.0) frameAll(window, points, place);
    ImGui::InvisibleButton("##sheet", size,
                           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                               ImGuiButtonFlags_MouseButtonMiddle);
    const bool hovered = ImGui::IsItemHovered();
    const Sheet sheet{place, window.middle, window.zoom};
    if (hovered && window.does == Does::nothing && !editor.document.held())
        for (const int button : {0, 1, 2})
            if (ImGui::IsMouseClicked(button)) press(editor, sheet, points, button);
    go(editor, sheet, points);
    if (const float wheel = ImGui::GetIO().MouseWheel; hovered && wheel != 0.0f) {
        const Position at = sheet.toSheet(ImGui::GetIO().MousePos);
        const double zoom = std::clamp(window.zoom * std::pow(1.2, double(wheel)), kLeastZoom, kMostZoom);
        for (std::size_t axis = 0; axis < 2; ++axis)
            window.middle[axis] = at[axis] + (window.middle[axis] - at[axis]) * window.zoom / zoom;
        window.zoom = zoom;
    }
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddRectFilled(place.lo, place.hi, themeColor(ThemeColor::canvas));
    list->PushClipRect(place.lo, place.hi, true);
    const Sheet now{place, window.middle, window.zoom};
    drawPicture(window, now);
    drawGrid(window, now);
    drawOutline(editor, now, pointsOf(editor).value_or(points));
    list->PopClipRect();
    if (hovered && window.does == Does::nothing) {
        const Position at = now.toSheet(ImGui::GetIO().MousePos);
        char words[64];
        std::snprintf(words, sizeof words, "%.3f, %.3f", at[0], at[1]);
        list->AddText({place.lo.x + 6, place.lo.y + 4}, themeColor(ThemeColor::quiet), words);
    }
}

}  // namespace

void openOutline(Editor& editor, const std::string& node, const std::string& input) {
    Window& window = editor.outline;
    if (!window.shows(editor.canvas.scope, node, input)) {
        window.scope = editor.canvas.scope, window.node = node, window.input = input;
        window.selected.clear();
        window.zoom = 0.0;
        window.does = Does::nothing;
    }
    window.open = window.opened = true;
}

void showOutline(Editor& editor) {
    Window& window = editor.outline;
    window.focused = false;
    if (!window.open) return;
    const std::optional<Points> points = pointsOf(editor);
    if (!points) return void(window.open = false);
    window.selected = points->selected;
    const ImVec2 whole = ImGui::GetMainViewport()->Size;
    const float scale = editor.shell.scale();
    ImGui::SetNextWindowSize(
        {std::min(720.0f * scale, 0.95f * whole.x), std::min(560.0f * scale, 0.9f * whole.y)},
        ImGuiCond_Appearing);
    ImGui::SetNextWindowPos({0.5f * whole.x, 0.5f * whole.y}, ImGuiCond_Appearing, {0.5f, 0.5f});
    if (std::exchange(window.opened, false)) ImGui::SetNextWindowFocus();
    const NodeBox* box = editor.canvas.scope == window.scope ? editor.boxes->find(window.node) : nullptr;
    const std::string title = "Outline of " + (box ? titleOf(*box) : window.node) + "###outline";
    if (ImGui::Begin(title.c_str(), &window.open,
                     ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings |
                         ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse |
                         ImGuiWindowFlags_NoNavInputs)) {
        showTools(editor, *points);
        const std::optional<Points> now = pointsOf(editor);
        if (now) {
            showSheet(editor, *now);
            showPlaceOf(editor, pointsOf(editor).value_or(*now));
        }
        window.focused = ImGui::IsWindowFocused(ImGuiFocusedFlags_ChildWindows);
        if (window.focused && now) followKeys(editor, *now);
        if (const auto path = show(window.browser, scale)) readPicture(editor, *path);
    }
    ImGui::End();
}

}  // namespace fw::editor
