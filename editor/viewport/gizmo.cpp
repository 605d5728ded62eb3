#include "editor/viewport/gizmo.h"

#include <algorithm>
#include <cmath>
#include <glm/ext/scalar_constants.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include "graph/document/named_parameters.h"

namespace fw::editor {

namespace {

using Kind = Handle::Kind;

constexpr double kNear = 7.0;         // pixels from a handle to the mouse
constexpr double kEdgeOn = 0.2;       // cosine between a ring's axis and the view
constexpr double kAlongView = 0.985;  // cosine between an axis and the view, beyond which it is not drawn
constexpr int kRingPoints = 64;
constexpr double kMetreStep = 0.1, kDegreeStep = 15.0, kFactorStep = 0.1;
constexpr double kLeastFactor = 1e-3;

glm::dvec2 vec(ImVec2 p) { return {double(p.x), double(p.y)}; }

/// From the eye to the handle, of unit length.
glm::dvec3 viewOf(const Handle& handle, const Lens& lens) { return glm::normalize(handle.origin - lens.eye); }

double lengthOf(const Handle& handle, const Lens& lens, double scale) {
    return kHandlePixels * scale * lens.metresPerPixel(handle.origin);
}

bool edgeOn(const Handle& handle, int axis, const Lens& lens) {
    return std::abs(glm::dot(handle.axes[axis], viewOf(handle, lens))) < kEdgeOn;
}

/// Where the pixel is seen on the plane through the handle across `normal`; none if it runs along it.
std::optional<glm::dvec3> onPlane(const Handle& handle, const glm::dvec3& normal, const Lens& lens,
                                  ImVec2 pixel) {
    const glm::dvec3 ray = lens.ray(pixel);
    const double along = glm::dot(ray, normal);
    if (std::abs(along) < 1e-9) return std::nullopt;
    const double t = glm::dot(handle.origin - lens.eye, normal) / along;
    if (t <= 0.0) return std::nullopt;
    return lens.eye + t * ray;
}

/// How many of the axis' metres it is from the origin to what is nearest to the pixel's ray.
std::optional<double> alongAxis(const Handle& handle, int axis, const Lens& lens, ImVec2 pixel) {
    const glm::dvec3 a = handle.axes[axis], d = glm::normalize(lens.ray(pixel)), w = handle.origin - lens.eye;
    const double aa = glm::dot(a, a), ad = glm::dot(a, d), denominator = aa - ad * ad;
    if (denominator < 1e-6 * aa) return std::nullopt;
    return (ad * glm::dot(d, w) - glm::dot(a, w)) / denominator;
}

/// The angle about a ring's axis, radians.
std::optional<double> aboutAxis(const Handle& handle, int axis, const Lens& lens, ImVec2 pixel,
                                double scale) {
    const glm::dvec3 n = handle.axes[axis], view = viewOf(handle, lens);
    if (edgeOn(handle, axis, lens)) {
        // Along the ring's near side, which runs across the view.
        const glm::dvec3 front = glm::normalize(n * glm::dot(n, view) - view), along = glm::cross(n, front);
        const double length = lengthOf(handle, lens, scale);
        const auto from = lens.project(handle.origin), to = lens.project(handle.origin + length * along);
        if (!from || !to) return std::nullopt;
        const glm::dvec2 tangent = vec(*to) - vec(*from);
        return glm::dot(vec(pixel) - vec(*from), tangent) / glm::dot(tangent, tangent);
    }
    const auto hit = onPlane(handle, n, lens, pixel);
    if (!hit) return std::nullopt;
    const glm::dvec3 u =
        glm::normalize(glm::cross(n, std::abs(n.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
    return std::atan2(glm::dot(*hit - handle.origin, glm::cross(n, u)), glm::dot(*hit - handle.origin, u));
}

/// What the pixel means for a drag: metres along axes, radians, or the share of a factor.
std::optional<glm::dvec3> meaning(const HandleDrag& drag, const Lens& lens, ImVec2 pixel) {
    const Handle& handle = drag.handle;
    glm::dvec3 result(0.0);
    if (drag.axis == kAcrossView) {
        const auto hit = onPlane(handle, lens.forward, lens, pixel);
        if (!hit) return std::nullopt;
        return glm::inverse(handle.axes) * (*hit - handle.origin);
    }
    const auto value = handle.kind == Kind::turn ? aboutAxis(handle, drag.axis, lens, pixel, drag.scale)
                                                 : alongAxis(handle, drag.axis, lens, pixel);
    if (!value) return std::nullopt;
    result[drag.axis] = *value;
    if (handle.kind == Kind::scale)
        result[drag.axis] *= glm::length(handle.axes[drag.axis]) / lengthOf(handle, lens, drag.scale);
    return result;
}

/// To a multiple of a step that is whole or a whole part of 1, as the double that its decimals name.
double rounded(double value, double step) {
    if (step >= 1.0) return std::round(value / step) * step;
    const double parts = std::round(1.0 / step);
    return std::round(value * parts) / parts;
}

double distance(ImVec2 p, ImVec2 a, ImVec2 b) {
    const glm::dvec2 ab = vec(b) - vec(a), ap = vec(p) - vec(a);
    const double length = glm::dot(ab, ab);
    const double t = length > 0.0 ? std::clamp(glm::dot(ap, ab) / length, 0.0, 1.0) : 0.0;
    return glm::length(ap - t * ab);
}

/// Pixels from the mouse to what is drawn of an axis.
double distanceOf(const Handle& handle, int axis, const Lens& lens, ImVec2 mouse, double scale) {
    const auto origin = lens.project(handle.origin);
    if (!origin) return INFINITY;
    if (axis == kAcrossView)
        return handle.kind == Kind::move ? distance(mouse, *origin, *origin) : double(INFINITY);
    if (!isSeen(handle, axis, lens)) return INFINITY;
    if (handle.kind == Kind::turn) {
        double least = INFINITY;
        const std::vector<ImVec2> ring = ringOf(handle, axis, lens, scale);
        for (std::size_t i = 1; i < ring.size(); ++i)
            least = std::min(least, distance(mouse, ring[i - 1], ring[i]));
        return least;
    }
    const auto tip = lens.project(handle.tip(axis, lengthOf(handle, lens, scale)));
    if (!tip) return INFINITY;
    // The shaft of an extent would lie over other handles.
    return handle.kind == Kind::extent ? distance(mouse, *tip, *tip) : distance(mouse, *origin, *tip);
}

}  // namespace

Lens::Lens(const Camera& camera, const Area& place_) : place(place_) {
    const gpu::View view = cameraView(camera, {}, place.width() / std::max(place.height(), 1.0f));
    eye = view.eye, forward = view.forward, right = view.right, up = view.up;
}

std::optional<ImVec2> Lens::project(const glm::dvec3& point) const {
    const glm::dvec3 from = point - eye;
    const double along = glm::dot(from, forward);
    if (along < 1e-6) return std::nullopt;
    const double x = glm::dot(from, right) / (along * glm::dot(right, right)),
                 y = glm::dot(from, up) / (along * glm::dot(up, up));
    const ImVec2 middle = place.centre();
    return ImVec2(middle.x + float(x) * 0.5f * place.width(), middle.y - float(y) * 0.5f * place.height());
}

glm::dvec3 Lens::ray(ImVec2 pixel) const {
    const ImVec2 middle = place.centre();
    return forward + right * double((pixel.x - middle.x) / (0.5f * place.width())) +
           up * double((middle.y - pixel.y) / (0.5f * place.height()));
}

double Lens::metresPerPixel(const glm::dvec3& point) const {
    return std::max(glm::dot(point - eye, forward), 1e-6) * 2.0 * glm::length(up) / double(place.height());
}

glm::dvec3 Handle::tip(int axis, double length) const {
    if (kind == Kind::extent) return origin + axes[axis] * numbers[std::size_t(axis)];
    return origin + glm::normalize(axes[axis]) * length;
}

namespace {

/// Where the grip of this input begins, and where it ends, in the node's space.
glm::dvec3 gripBase(const Node& node, const NodeType& type, const InputSpec& input);
glm::dvec3 gripEnd(const Node& node, const NodeType& type, const InputSpec& input) {
    const glm::dvec3 numbers = vectorOf(inputNumbers(node, input.name));
    if (!input.grip) return numbers;  // a place
    const auto& [x, y, z] = input.grip.along;
    return gripBase(node, type, input) + numbers.x * glm::dvec3(x, y, z);
}
glm::dvec3 gripBase(const Node& node, const NodeType& type, const InputSpec& input) {
    const std::string& from = input.grip.from;
    const bool opposite = from.starts_with('-');
    const int index = inputIndex(type, std::string_view(from).substr(opposite ? 1 : 0));
    if (index < 0) return glm::dvec3(0.0);
    const glm::dvec3 end = gripEnd(node, type, type.inputs[std::size_t(index)]);
    return opposite ? -end : end;
}

}  // namespace

std::vector<Handle> handlesOf(const Node& node, const Placement& placement,
                              const std::set<std::string>& animated) {
    const NodeType* type = findNodeType(node.type);
    if (!type || type->outputs.empty() || type->outputs.front().type != Type::surface) return {};
    // What stands about a node's place is turned and scaled there.
    glm::dvec3 centre(0.0);
    const bool moves = std::ranges::count(type->inputs, Type::surface, &InputSpec::type) == 1;
    for (const InputSpec& input : type->inputs)
        if (moves && isPlace(input)) centre = vectorOf(inputNumbers(node, input.name));
    std::vector<Handle> handles;
    for (const InputSpec& input : type->inputs) {
        Handle handle{.node = node.id, .input = input.name, .numbers = inputNumbers(node, input.name)};
        if (isPlace(input))
            handle.kind = Kind::move;
        else if (isAngles(input))
            handle.kind = Kind::turn;
        else if (isFactor(input))
            handle.kind = Kind::scale;
        else if (isExtent(input))
            handle.kind = Kind::extent;
        else if (input.grip)
            handle.kind = Kind::extent, handle.count = 1, handle.least = input.min;
        else
            continue;
        const InputValue* given = node.input(input.name);
        const Link* link = given ? std::get_if<Link>(&given->value) : nullptr;
        if (link)
            handle.numbers = input.value.numbers, handle.refusal = "It is wired: " + link->node + " sets it.";
        if (node.muted) handle.refusal = "The node is muted.";
        if (animated.contains(node.id + "." + input.name))
            handle.refusal = "The timeline moves it: change its keys.";
        if (input.type == Type::vec3 && handle.numbers.size() == 1)
            handle.numbers.resize(3, handle.numbers[0]);
        const glm::dvec3 numbers = vectorOf(handle.numbers);
        handle.origin = placement.of(handle.kind == Kind::move     ? numbers
                                     : handle.kind == Kind::extent ? glm::dvec3(0.0)
                                                                   : centre);
        handle.axes = placement.linear;
        if (input.grip) {
            const auto& [x, y, z] = input.grip.along;
            handle.origin = placement.of(gripBase(node, *type, input));
            handle.axes[0] = placement.linear * glm::dvec3(x, y, z);
        }
        if (handle.kind == Kind::turn) {
            // Turns about x come first: what follows turns their axis too.
            const glm::dmat3 axes(turned({0, numbers.y, numbers.z})[0], turned({0, 0, numbers.z})[1],
                                  glm::dvec3(0, 0, 1));
            for (int i = 0; i < 3; ++i) handle.axes[i] = glm::normalize(placement.linear * axes[i]);
        }
        handles.push_back(std::move(handle));
    }
    return handles;
}

bool isSeen(const Handle& handle, int axis, const Lens& lens) {
    if (handle.kind == Kind::turn) return true;
    return std::abs(glm::dot(glm::normalize(handle.axes[axis]), viewOf(handle, lens))) < kAlongView;
}

std::vector<ImVec2> ringOf(const Handle& handle, int axis, const Lens& lens, double scale) {
    const glm::dvec3 n = handle.axes[axis], view = viewOf(handle, lens);
    const double length = lengthOf(handle, lens, scale);
    // It begins where it is farthest from the eye, so that the near part is in one piece.
    const glm::dvec3 away = view - n * glm::dot(n, view);
    const glm::dvec3 u = glm::length(away) > 1e-3 ? glm::normalize(away)
                                                  : glm::normalize(glm::cross(n, glm::dvec3(0.3, 0.5, 0.8)));
    const glm::dvec3 v = glm::cross(n, u);
    const bool facing = std::abs(glm::dot(n, view)) > 0.95;
    std::vector<ImVec2> points;
    for (int i = 0; i <= kRingPoints; ++i) {
        const double angle = 2.0 * glm::pi<double>() * i / kRingPoints;
        const glm::dvec3 from = u * std::cos(angle) + v * std::sin(angle);
        if (!facing && glm::dot(from, view) > 0.02) continue;
        if (const auto point = lens.project(handle.origin + length * from)) points.push_back(*point);
    }
    return points;
}

std::optional<HandleHit> handleAt(const std::vector<Handle>& handles, const Lens& lens, ImVec2 mouse,
                                  double scale) {
    std::optional<HandleHit> hit;
    double least = kNear * scale;
    for (std::size_t i = 0; i < handles.size(); ++i)
        for (const int axis : {kAcrossView, 0, 1, 2}) {
            if (axis >= handles[i].count && axis != kAcrossView) continue;
            const double away = distanceOf(handles[i], axis, lens, mouse, scale);
            if (away < least) hit = HandleHit{i, axis}, least = axis == kAcrossView ? 0.0 : away;
        }
    return hit;
}

HandleDrag takeHandle(const Handle& handle, int axis, const Lens& lens, ImVec2 mouse, double scale) {
    HandleDrag drag{.handle = handle, .axis = axis, .scale = scale};
    drag.last = meaning(drag, lens, mouse).value_or(glm::dvec3(0.0));
    return drag;
}

std::vector<double> dragTo(HandleDrag& drag, const Lens& lens, ImVec2 mouse, bool fine, bool snapped) {
    const Handle& handle = drag.handle;
    if (const auto now = meaning(drag, lens, mouse)) {
        glm::dvec3 by = *now - drag.last;
        if (handle.kind == Kind::turn)
            for (int i = 0; i < 3; ++i) by[i] = std::remainder(by[i], 2.0 * glm::pi<double>());
        drag.travelled += by * (fine ? 0.1 : 1.0);
        drag.last = *now;
    }
    const double pixel = lens.metresPerPixel(handle.origin) * (fine ? 0.1 : 1.0);
    // To what a person would write: as many digits as the hand can tell apart.
    const auto grain = [&](double worth) { return std::pow(10.0, std::floor(std::log10(worth))); };
    std::vector<double> numbers = handle.numbers;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const bool one = numbers.size() == 1;
        const double by = one ? drag.travelled[drag.axis] : drag.travelled[int(i)];
        if (!one && drag.axis != kAcrossView && drag.axis != int(i)) continue;
        double& number = numbers[i];
        switch (handle.kind) {
            case Kind::move:
            case Kind::extent:
                number = rounded(number + by,
                                 snapped ? kMetreStep : grain(pixel / glm::length(handle.axes[int(i)])));
                if (handle.kind == Kind::extent) number = std::max(number, handle.least);
                break;
            case Kind::turn:
                number = rounded(number + glm::degrees(by), snapped ? kDegreeStep : fine ? 0.01 : 0.1);
                break;
            case Kind::scale:
                number = rounded(number * std::max(1.0 + by, kLeastFactor), snapped ? kFactorStep
                                                                            : fine  ? 0.001
                                                                                    : 0.01);
                number = std::max(number, snapped ? kFactorStep : kLeastFactor);
                break;
        }
        if (number == 0.0) number = 0.0;  // no -0
    }
    return numbers;
}

}  // namespace fw::editor
