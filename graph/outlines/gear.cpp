#include "graph/outlines/gear.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "graph/outlines/boundary.h"

namespace fw {

namespace {

constexpr double kGearTolerance = 1e-5;  // of the module
constexpr double kDedendum = 1.25;       // modules
constexpr double kMostBacklash = 1.4;    // modules: at the pitch circle a tooth has 1.57

/// Of a gear whose module is 1: half the angle of the space between two teeth, by radius.
class Space {
  public:
    Space(const GearShape& shape, double backlash_)
        : teeth(shape.teeth), pressure(shape.pressureAngle * std::numbers::pi / 180), backlash(backlash_) {}

    double pitch() const { return 0.5 * teeth; }
    double root() const { return pitch() - kDedendum; }
    double base() const { return pitch() * std::cos(pressure); }

    double halfAngle(double radius) const {
        double half = corner(radius);
        if (radius > base()) half = std::max(half, flank(radius));
        return half + 0.5 * backlash / pitch();
    }

  private:
    static double involute(double angle) { return std::tan(angle) - angle; }
    double flank(double radius) const {
        return 0.5 * std::numbers::pi / teeth - involute(pressure) + involute(std::acos(base() / radius));
    }
    /// Of the path of the rack's corner: at x beside the middle the rack has moved by x less half its tip's
    /// width, and the gear with it.
    double corner(double radius) const {
        const double x = std::sqrt(std::max(0.0, radius * radius - root() * root()));
        const double tip = 0.25 * std::numbers::pi - kDedendum * std::tan(pressure);
        return std::atan2(x, root()) - (x - tip) / pitch();
    }

    double teeth, pressure, backlash;
};

}  // namespace

Result<OutlinePtr> outlineOfGear(const GearShape& shape) {
    const double numbers[] = {shape.module, double(shape.teeth), shape.pressureAngle, shape.backlash};
    return keptOutline(outlineKey({"gear"}, numbers), [&]() -> Result<OutlinePtr> {
        const Space space(shape, std::clamp(shape.backlash / shape.module, 0.0, kMostBacklash));
        const double step = std::numbers::pi / shape.teeth;  // half of a tooth with its space
        // Teeth that come to a point end there.
        double top = space.pitch() + 1;
        if (space.halfAngle(top) > step) {
            double below = space.pitch();
            for (int i = 0; i < 60; ++i) {
                const double middle = 0.5 * (below + top);
                (space.halfAngle(middle) < step ? below : top) = middle;
            }
            top = below;
        }
        const auto at = [](double radius, double angle) {
            return radius * glm::dvec2(std::cos(angle), std::sin(angle));
        };
        const double root = std::max(space.root(), 0.05);
        Pen pen(kGearTolerance);
        pen.moveTo(at(root, -step - space.halfAngle(root)));
        for (int tooth = 0; tooth < shape.teeth; ++tooth) {
            const double middle = 2 * step * tooth, before = middle - step, behind = middle + step;
            pen.ellipse({0, 0}, {root, 0}, {0, root}, before - space.halfAngle(root),
                        before + space.halfAngle(root));
            // The corner's path leaves the root like a square root: by the square of the parameter it is
            // smooth there.
            const auto radius = [&](double t) { return root + (top - root) * t * t; };
            const double share = std::sqrt(std::clamp((space.base() - root) / (top - root), 0.0, 1.0));
            const auto rise = [&](double t) { return at(radius(t), before + space.halfAngle(radius(t))); };
            const auto fall = [&](double t) {
                return at(radius(1 - t), behind - space.halfAngle(radius(1 - t)));
            };
            if (share > 0) pen.along(rise, 0, share);
            pen.along(rise, share, 1);
            pen.ellipse({0, 0}, {top, 0}, {0, top}, before + space.halfAngle(top),
                        behind - space.halfAngle(top));
            pen.along(fall, 0, 1 - share);
            if (share > 0) pen.along(fall, 1 - share, 1);
        }
        pen.close();
        const double m = shape.module;
        const std::vector<Contour> contours =
            moved(pen.taken(), {{m, 0}, {0, m}, {0, 0}}, kGearTolerance * m);
        return outlineOf({.fills = {{.contours = contours}}, .clips = {}}, "the gear", "use fewer teeth");
    });
}

}  // namespace fw
