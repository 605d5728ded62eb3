#include "editor/viewport/gizmo.h"

#include <algorithm>
#include <cmath>
#include <glm/ext/scalar_constants.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

namespace fw::editor {

namespace {

using Kind = Handle::Kind;

constexpr double kNear = 7.0;         // pixels from a handle to the mouse
constexpr double kEdgeOn = 0.2;       // cosine between a ring's axis and the view
constexpr double kAlongView = 0.985;  // cosine between an axis and the view, beyond which it is not drawn
constexpr int kRingPoints = 64;
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
    const glm::dvec3 a = handle.axes[axis], d = glm::normalize(lens.ray(pixel)),
                     w = handle.base(axis) - lens.eye;
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

/// The angle of the arc at which the pixel is seen, radians; where the arc is seen edge-on, along its
/// tangent.
std::optional<double> onArc(const Handle& handle, const Lens& lens, ImVec2 pixel) {
    const glm::dvec3 &u = handle.axes[0], &v = handle.axes[1];
    const glm::dvec3 n = glm::normalize(glm::cross(u, v));
    if (std::abs(glm::dot(n, viewOf(handle, lens))) < kEdgeOn) {
        const double angle = glm::radians(handle.numbers[0]);
        const glm::dvec3 tip = handle.tip(0, 0.0), tangent = v * std::cos(angle) - u * std::sin(angle);
        const auto from = lens.project(tip), to = lens.project(tip + tangent);
        if (!from || !to) return std::nullopt;
        const glm::dvec2 across = vec(*to) - vec(*from);
        if (glm::dot(across, across) < 1.0) return std::nullopt;
        return angle + glm::dot(vec(pixel) - vec(*from), across) / glm::dot(across, across);
    }
    const auto hit = onPlane(handle, n, lens, pixel);
    if (!hit) return std::nullopt;
    const glm::dvec3 from = *hit - handle.origin;
    return std::atan2(glm::dot(from, v) / glm::dot(v, v), glm::dot(from, u) / glm::dot(u, u));
}

glm::dvec3 directionOf(const Handle& handle) {
    const glm::dvec3 given = handle.axes * vectorOf(handle.numbers);
    return glm::length(given) > 0.0 ? glm::normalize(given) : glm::dvec3(0, 1, 0);
}

/// Where the pixel is seen on the ball that a direction's tip goes about on, in its radii.
glm::dvec3 onBall(const Handle& handle, const Lens& lens, ImVec2 pixel, double scale) {
    const glm::dvec3 ray = glm::normalize(lens.ray(pixel)), from = lens.eye - handle.origin;
    const double radius = lengthOf(handle, lens, scale), middle = -glm::dot(from, ray);
    const glm::dvec3 nearest = from + middle * ray;
    const double inside = radius * radius - glm::dot(nearest, nearest);
    if (inside <= 0.0) return glm::normalize(nearest);
    const bool behind = glm::dot(directionOf(handle), viewOf(handle, lens)) > 0.0;
    return (nearest + ray * (behind ? std::sqrt(inside) : -std::sqrt(inside))) / radius;
}

/// What the pixel means for a drag: metres along axes, radians, or the share of a factor.
std::optional<glm::dvec3> meaning(const HandleDrag& drag, const Lens& lens, ImVec2 pixel) {
    const Handle& handle = drag.handle;
    glm::dvec3 result(0.0);
    if (handle.kind == Kind::aim) return onBall(handle, lens, pixel, drag.scale);
    if (drag.axis == kAcrossView) {
        const auto hit = onPlane(handle, lens.forward, lens, pixel);
        if (!hit) return std::nullopt;
        return glm::inverse(handle.axes) * (*hit - handle.origin);
    }
    const auto value = handle.kind == Kind::turn    ? aboutAxis(handle, drag.axis, lens, pixel, drag.scale)
                       : handle.kind == Kind::angle ? onArc(handle, lens, pixel)
                                                    : alongAxis(handle, drag.axis, lens, pixel);
    if (!value) return std::nullopt;
    result[drag.axis] = *value;
    if (handle.kind == Kind::scale)
        result[drag.axis] *= glm::length(handle.axes[drag.axis]) / lengthOf(handle, lens, drag.scale);
    return result;
}

/// To a multiple of a step, as the double that its decimals name if the step is a whole part of 1.
double rounded(double value, double step) {
    if (step >= 1.0 || std::abs(std::round(1.0 / step) * step - 1.0) > 1e-9)
        return std::round(value / step) * step;
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
    const bool atTip = handle.kind == Kind::extent || handle.kind == Kind::angle || handle.kind == Kind::aim;
    const auto origin = lens.project(handle.origin);
    if (!origin && !atTip) return INFINITY;
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
    return atTip ? distance(mouse, *tip, *tip) : distance(mouse, *origin, *tip);
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
    if (kind == Kind::extent) return base(axis) + axes[axis] * numbers[std::size_t(axis)];
    if (kind == Kind::aim) return origin + directionOf(*this) * length;
    if (kind == Kind::angle) {
        const double angle = glm::radians(numbers[0]);
        return origin + axes[0] * std::cos(angle) + axes[1] * std::sin(angle);
    }
    return origin + glm::normalize(axes[axis]) * length;
}

bool isSeen(const Handle& handle, int axis, const Lens& lens) {
    if (handle.kind == Kind::turn || handle.kind == Kind::angle || handle.kind == Kind::aim) return true;
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

namespace {

/// The direction as the node's numbers, of unit length; in steps of so many degrees, if any, from the
/// horizon and about the vertical.
std::vector<double> aimed(const Handle& handle, const glm::dvec3& seen, double step) {
    glm::dvec3 d = glm::inverse(handle.axes) * seen;
    if (!(glm::length(d) >= 1e-9) || !std::isfinite(glm::length(d))) return handle.numbers;
    d = glm::normalize(d);
    if (step > 0.0) {
        const double rise = glm::radians(rounded(glm::degrees(std::asin(std::clamp(d.y, -1.0, 1.0))), step)),
                     about = glm::radians(rounded(glm::degrees(std::atan2(d.x, d.z)), step));
        d = {std::sin(about) * std::cos(rise), std::sin(rise), std::cos(about) * std::cos(rise)};
    }
    std::vector<double> numbers;
    for (int i = 0; i < 3; ++i) numbers.push_back(rounded(d[i], 0.001) + 0.0);  // no -0
    return numbers;
}

}  // namespace

std::vector<ImVec2> arcOf(const Handle& handle, const Lens& lens) {
    std::vector<ImVec2> points;
    const double last = glm::radians(handle.numbers[0]);
    for (int i = 0; i <= kRingPoints; ++i) {
        const double angle = last * i / kRingPoints;
        if (const auto point = lens.project(handle.origin + handle.axes[0] * std::cos(angle) +
                                            handle.axes[1] * std::sin(angle)))
            points.push_back(*point);
    }
    return points;
}

std::vector<double> dragTo(HandleDrag& drag, const Lens& lens, ImVec2 mouse, bool fine, const Steps& steps) {
    const Handle& handle = drag.handle;
    if (const auto now = meaning(drag, lens, mouse)) {
        glm::dvec3 by = *now - drag.last;
        if (handle.kind == Kind::turn || handle.kind == Kind::angle)
            for (int i = 0; i < 3; ++i) by[i] = std::remainder(by[i], 2.0 * glm::pi<double>());
        drag.travelled += by * (fine ? 0.1 : 1.0);
        drag.last = *now;
    }
    const double pixel = lens.metresPerPixel(handle.origin) * (fine ? 0.1 : 1.0);
    // To what a person would write: as many digits as the hand can tell apart.
    const auto grain = [&](double worth) { return std::pow(10.0, std::floor(std::log10(worth))); };
    if (handle.kind == Kind::aim)
        return aimed(handle, directionOf(handle) + drag.travelled, steps.on ? steps.degrees : 0.0);
    const bool snapped = steps.on && !drag.target;
    if (drag.target && handle.kind == Kind::move)
        drag.travelled = glm::inverse(handle.axes) * (*drag.target - handle.origin);
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
                                 snapped ? steps.metres : grain(pixel / glm::length(handle.axes[int(i)])));
                if (handle.kind == Kind::extent)
                    number = std::max(std::min(number, handle.most[int(i)]), handle.least[int(i)]);
                break;
            case Kind::angle:
                number = rounded(number + glm::degrees(by), snapped ? steps.degrees : fine ? 0.01 : 0.1);
                number = std::max(std::min(number, handle.most.x), handle.least.x);
                break;
            case Kind::aim: break;
            case Kind::turn:
                number = rounded(number + glm::degrees(by), snapped ? steps.degrees : fine ? 0.01 : 0.1);
                break;
            case Kind::scale:
                number = rounded(number * std::max(1.0 + by, kLeastFactor), snapped ? steps.factor
                                                                            : fine  ? 0.001
                                                                                    : 0.01);
                number = std::max(number, snapped ? steps.factor : kLeastFactor);
                break;
        }
        if (number == 0.0) number = 0.0;  // no -0
    }
    // Behind a factor of 0 a metre of the picture is no number there.
    const bool known = std::ranges::all_of(numbers, [](double number) { return std::isfinite(number); });
    return known ? numbers : handle.numbers;
}

}  // namespace fw::editor
