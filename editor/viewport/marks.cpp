#include "editor/viewport/marks.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <nlohmann/json.hpp>

#include "editor/document/scene_edits.h"
#include "editor/editor.h"
#include "editor/shell/theme.h"

namespace fw::editor {

namespace {

using Look = Mark::Look;

constexpr float kMarkRadius = 8.0f;  // pixels, times the scale
constexpr ImU32 kMarkShadow = IM_COL32(0, 0, 0, 150);

glm::dvec3 vectorFrom(const Triple& t) { return {t[0], t[1], t[2]}; }
std::vector<double> numbersFrom(const Triple& t) { return {t.begin(), t.end()}; }

/// Towards the sun.
glm::dvec3 directionTo(const Sun& sun) {
    const double about = glm::radians(sun.azimuth), rise = glm::radians(sun.elevation);
    return {std::sin(about) * std::cos(rise), std::sin(rise), std::cos(about) * std::cos(rise)};
}

glm::dvec3 middleOf(const Box& box) {
    return 0.5 * glm::dvec3(box.lo[0] + box.hi[0], box.lo[1] + box.hi[1], box.lo[2] + box.hi[2]);
}
double reachOf(const Box& box) {
    const double reach =
        0.5 * std::hypot(box.hi[0] - box.lo[0], box.hi[1] - box.lo[1], box.hi[2] - box.lo[2]);
    return std::isfinite(reach) && reach > 0.0 ? reach : 1.0;
}

const Mark* markAt(const std::vector<Mark>& marks, const Lens& lens, ImVec2 mouse, float scale) {
    for (const Mark& mark : marks)
        if (const auto at = lens.project(mark.at))
            if (std::hypot(at->x - mouse.x, at->y - mouse.y) < (kMarkRadius + 2.0f) * scale) return &mark;
    return nullptr;
}

}  // namespace

std::vector<Mark> marksOf(const Scene& scene, const Box& region) {
    std::vector<Mark> marks;
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const Lamp& lamp = scene.lights[i];
        Mark mark;
        mark.part = "lights." + std::to_string(i), mark.name = "Lamp " + std::to_string(i + 1);
        mark.at = vectorFrom(lamp.position), mark.color = vectorFrom(lamp.color);
        if (lamp.type != Lamp::Type::point) mark.to = vectorFrom(lamp.target);
        marks.push_back(std::move(mark));
    }
    if (scene.sun) {
        Mark mark;
        mark.look = Look::sun, mark.part = "sun", mark.name = "Sun";
        mark.at = middleOf(region) + reachOf(region) * directionTo(*scene.sun);
        mark.to = middleOf(region), mark.color = vectorFrom(scene.sun->color);
        marks.push_back(std::move(mark));
    }
    if (scene.camera) {
        Mark mark;
        mark.look = Look::camera, mark.part = "camera", mark.name = "Camera";
        mark.at = vectorFrom(scene.camera->position), mark.to = vectorFrom(scene.camera->target);
        marks.push_back(std::move(mark));
    }
    return marks;
}

std::vector<Handle> handlesOf(const Scene& scene, const std::string& part, const Box& region,
                              const std::set<std::string>& animated) {
    std::vector<Handle> handles;
    const auto add = [&](const std::string& input, Handle::Kind kind, std::vector<double> numbers,
                         const glm::dvec3& origin) -> Handle& {
        Handle& handle = handles.emplace_back();
        handle.kind = kind, handle.input = input, handle.numbers = std::move(numbers), handle.origin = origin;
        handle.scene = input.empty() ? part : part + "." + input;
        for (const std::string& path : animated)
            if (path.starts_with(handle.scene)) handle.refusal = "The timeline moves it: change its keys.";
        return handle;
    };
    using Kind = Handle::Kind;
    if (part == "camera" && scene.camera) {
        add("position", Kind::move, numbersFrom(scene.camera->position), vectorFrom(scene.camera->position));
        add("target", Kind::move, numbersFrom(scene.camera->target), vectorFrom(scene.camera->target));
    }
    if (part == "sun" && scene.sun) {
        const glm::dvec3 to = directionTo(*scene.sun);
        add("", Kind::aim, {to.x, to.y, to.z}, middleOf(region)).count = 1;
    }
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        if (part != "lights." + std::to_string(i)) continue;
        const Lamp& lamp = scene.lights[i];
        const glm::dvec3 at = vectorFrom(lamp.position), to = vectorFrom(lamp.target);
        add("position", Kind::move, numbersFrom(lamp.position), at);
        if (lamp.type != Lamp::Type::point) add("target", Kind::move, numbersFrom(lamp.target), to);
        if (lamp.type == Lamp::Type::spot && glm::distance(at, to) > 1e-6) {
            // The cone is held where it meets the plane through the target: half its angle.
            const glm::dvec3 ray = to - at;
            const glm::dvec3 side = glm::normalize(glm::cross(
                ray, std::abs(ray.y) < 0.9 * glm::length(ray) ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0)));
            Handle& cone = add("angle", Kind::angle, {0.5 * lamp.angle}, at);
            cone.count = 1, cone.axes[0] = ray, cone.axes[1] = side * glm::length(ray);
            cone.least.x = 0.5 * kLeastLampAngle, cone.most.x = 0.5 * kMostLampAngle;
        }
        Handle& size = add("size", Kind::extent, {lamp.size}, at);
        size.count = 1, size.axes[0] = {0.0, -0.5, 0.0}, size.least.x = 0.0;
    }
    return handles;
}

Graph withSceneNumbers(const Graph& graph, const Handle& handle, const std::vector<double>& numbers) {
    Graph next = graph;
    if (handle.kind == Handle::Kind::aim) {
        const glm::dvec3 d = glm::normalize(glm::dvec3(numbers[0], numbers[1], numbers[2]));
        const auto tenths = [](double value) { return std::round(value * 10.0) / 10.0 + 0.0; };
        next = setSceneValue(next, handle.scene + ".azimuth", tenths(glm::degrees(std::atan2(d.x, d.z))));
        next = setSceneValue(next, handle.scene + ".elevation", tenths(glm::degrees(std::asin(d.y))));
    } else if (handle.kind == Handle::Kind::angle) {
        next = setSceneValue(next, handle.scene, 2.0 * numbers[0]);
    } else if (numbers.size() == 1) {
        next = setSceneValue(next, handle.scene, numbers[0]);
    } else {
        next = setSceneValue(next, handle.scene, Json(numbers));
    }
    return readScene(next.scene) ? next : graph;
}

bool marksAreShown(const Editor& editor) {
    return editor.viewport.gizmo.marks || (editor.panels.scene && editor.panels.front == "scene");
}

Scene sceneNow(const Editor& editor) {
    const Result<Scene> scene = readScene(editor.document.graph().scene);
    return scene ? *scene : Scene{};
}

bool followMarks(Editor& editor) {
    Viewport& view = editor.viewport;
    if (!view.hovered || view.drag.busy() || !marksAreShown(editor)) return false;
    const std::vector<Mark> marks = marksOf(sceneNow(editor), view.shown.region);
    const Mark* mark =
        markAt(marks, Lens(view.shown.seen, view.place), ImGui::GetIO().MousePos, editor.shell.scale());
    if (!mark) return false;
    ImGui::SetTooltip("%s", mark->name.c_str());
    if (!ImGui::IsMouseClicked(0)) return false;
    view.gizmo.part = mark->part;
    return true;
}

void showMarks(Editor& editor) {
    Viewport& view = editor.viewport;
    if (!view.texture || !marksAreShown(editor)) return;
    const Lens lens(view.shown.seen, view.place);
    const float scale = editor.shell.scale(), r = kMarkRadius * scale;
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->PushClipRect(view.place.lo, view.place.hi, true);
    for (const Mark& mark : marksOf(sceneNow(editor), view.shown.region)) {
        const auto at = lens.project(mark.at);
        if (!at) continue;
        const bool chosen = view.gizmo.part == mark.part;
        const double most = std::max({mark.color.x, mark.color.y, mark.color.z, 1e-6});
        const auto part = [&](double c) { return int(255.0 * std::sqrt(std::clamp(c / most, 0.0, 1.0))); };
        const ImU32 ink = mark.look == Look::camera
                              ? themeColor(ThemeColor::text)
                              : IM_COL32(part(mark.color.x), part(mark.color.y), part(mark.color.z), 255);
        const ImU32 edge = chosen ? themeColor(ThemeColor::active) : kMarkShadow;
        if (const auto to = mark.to ? lens.project(*mark.to) : std::nullopt)
            list->AddLine(*at, *to, chosen ? edge : IM_COL32(255, 255, 255, 90), scale);
        list->AddCircleFilled(*at, r + 2.0f * scale, edge);
        list->AddCircleFilled(*at, r, IM_COL32(40, 40, 40, 255));
        if (mark.look == Look::camera) {
            list->AddRectFilled({at->x - 0.55f * r, at->y - 0.35f * r}, {at->x + 0.2f * r, at->y + 0.35f * r},
                                ink);
            list->AddTriangleFilled({at->x + 0.2f * r, at->y}, {at->x + 0.65f * r, at->y - 0.35f * r},
                                    {at->x + 0.65f * r, at->y + 0.35f * r}, ink);
            continue;
        }
        list->AddCircleFilled(*at, 0.45f * r, ink);
        if (mark.look == Look::sun)
            for (int i = 0; i < 8; ++i) {
                const float x = std::cos(0.785398f * float(i)), y = std::sin(0.785398f * float(i));
                list->AddLine({at->x + 0.6f * r * x, at->y + 0.6f * r * y},
                              {at->x + 0.9f * r * x, at->y + 0.9f * r * y}, ink, 1.5f * scale);
            }
    }
    list->PopClipRect();
}

}  // namespace fw::editor
