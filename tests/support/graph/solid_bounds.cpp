#include "tests/support/graph/solid_bounds.h"

#include <algorithm>
#include <cmath>

#include "graph/evaluate/evaluate.h"

namespace fw::test {

namespace {

double alongDirection(const Point& p, std::size_t direction) {
    return direction % 2 ? p[direction / 2] : -p[direction / 2];
}

Point plus(const Point& p, const Point& step, double scale) {
    return {p[0] + scale * step[0], p[1] + scale * step[1], p[2] + scale * step[2]};
}

class SolidSampler {
  public:
    SolidSampler(const Ir& ir, IrId root, std::span<const double> parameters,
                 const SolidBoundsOptions& samplerOptions)
        : options(samplerOptions), tape(makeTape(ir, root, parameters)), random(samplerOptions.seed) {}

    SolidBounds run(std::span<const SceneAnchor> anchors, const std::optional<Box>& claimed) {
        for (const SceneAnchor& anchor : anchors) sampleAnchor(anchor);
        sampleFar(anchors);
        // Some of the inside points of each anchor, so that no solid is overlooked.
        for (std::size_t direction = 0; direction < 6; ++direction) climb(direction, startsOf(direction));
        if (claimed && result.found)
            for (int pass = 0; pass < 3; ++pass)
                if (!scanSlabs(*claimed)) break;
        for (std::size_t axis = 0; axis < 3; ++axis)
            result.reliable[axis] = result.found && converged[2 * axis] && converged[2 * axis + 1];
        return result;
    }

  private:
    struct Sample {
        Point point;
        double step;  ///< distance to neighbouring samples
    };

    std::vector<double> valuesAt(const std::vector<Point>& points) {
        std::vector<double> values(points.size());
        machine.evaluate(tape, points, values);
        result.evaluations += points.size();
        return values;
    }

    void addInside(const Point& point) {
        for (std::size_t direction = 0; direction < 6; ++direction) {
            const double along = alongDirection(point, direction);
            if (result.found && along <= alongDirection(result.extremes[direction], direction)) continue;
            result.extremes[direction] = point;
            (direction % 2 ? result.box.hi : result.box.lo)[direction / 2] = point[direction / 2];
        }
        result.found = true;
    }

    /// A jittered grid over the anchor's cube; where it finds little inside, a descent from the lowest
    /// values.
    void sampleAnchor(const SceneAnchor& anchor) {
        const int cells = options.gridCells;
        const double step = 2.0 * anchor.radius / cells;
        std::vector<Point> points;
        for (int k = 0; k < cells; ++k)
            for (int j = 0; j < cells; ++j)
                for (int i = 0; i < cells; ++i)
                    points.push_back({anchor.centre[0] - anchor.radius + step * (i + random.between(0, 1)),
                                      anchor.centre[1] - anchor.radius + step * (j + random.between(0, 1)),
                                      anchor.centre[2] - anchor.radius + step * (k + random.between(0, 1))});
        // Around the cube, in case that the solid is larger than estimated.
        for (int i = 0; i < cells * cells; ++i)
            points.push_back(
                plus(anchor.centre, random.direction(), anchor.radius * random.between(0.8, 3.0)));
        std::vector<double> values = valuesAt(points);
        std::vector<Sample> inside = insideOf(points, values, step);
        if (inside.size() < 30) {
            for (const Sample& sample : descend(points, values, step)) inside.push_back(sample);
        }
        anchored.push_back(std::move(inside));
    }

    std::vector<Sample> insideOf(const std::vector<Point>& points, const std::vector<double>& values,
                                 double step) {
        std::vector<Sample> inside;
        for (std::size_t i = 0; i < points.size(); ++i)
            if (values[i] < 0.0) addInside(points[i]), inside.push_back({points[i], step});
        return inside;
    }

    std::vector<Sample> descend(const std::vector<Point>& points, const std::vector<double>& values,
                                double step) {
        std::vector<std::pair<double, Point>> lowest;
        for (std::size_t i = 0; i < points.size(); ++i)
            if (values[i] >= 0.0) lowest.push_back({values[i], points[i]});
        const std::size_t kept = std::min<std::size_t>(lowest.size(), 40);
        std::partial_sort(lowest.begin(), lowest.begin() + std::ptrdiff_t(kept), lowest.end());
        lowest.resize(kept);
        constexpr int kProposals = 8, kRounds = 16;
        std::vector<Sample> inside;
        for (int round = 0; round < kRounds; ++round, step *= 0.65) {
            std::vector<Point> proposed;
            for (const auto& [value, point] : lowest)
                for (int i = 0; i < kProposals; ++i)
                    proposed.push_back(plus(point, random.direction(), step * random.between(0.3, 1.0)));
            const std::vector<double> found = valuesAt(proposed);
            for (std::size_t i = 0; i < proposed.size(); ++i) {
                auto& [value, point] = lowest[i / kProposals];
                if (found[i] < 0.0) addInside(proposed[i]), inside.push_back({proposed[i], step});
                if (found[i] < value) value = found[i], point = proposed[i];
            }
            if (inside.size() > 200) break;
        }
        return inside;
    }

    /// Random points at distances from a thousandth of a unit to a million units, around the origin and the
    /// anchors.
    void sampleFar(std::span<const SceneAnchor> anchors) {
        std::vector<Point> points;
        std::vector<double> distances;
        for (int i = 0; i < options.farSamples; ++i) {
            const Point centre = anchors.empty() || random.chance(0.3)
                                     ? Point{}
                                     : anchors[std::size_t(random.below(int(anchors.size())))].centre;
            const double distance = std::pow(10.0, random.between(-3, 6));
            points.push_back(plus(centre, random.direction(), distance));
            distances.push_back(distance);
        }
        const std::vector<double> values = valuesAt(points);
        std::vector<Sample> inside;
        for (std::size_t i = 0; i < points.size(); ++i)
            if (values[i] < 0.0) addInside(points[i]), inside.push_back({points[i], 0.3 * distances[i]});
        anchored.push_back(std::move(inside));
    }

    /// The inside points from which to climb: the farthest of all and the farthest of each anchor.
    std::vector<Sample> startsOf(std::size_t direction) {
        constexpr std::size_t kOfAll = 4, kOfAnchor = 2;
        const auto farther = [&](const Sample& a, const Sample& b) {
            return alongDirection(a.point, direction) > alongDirection(b.point, direction);
        };
        const auto keepFarthest = [&](std::vector<Sample>& samples, std::size_t count) {
            const std::size_t kept = std::min(count, samples.size());
            std::partial_sort(samples.begin(), samples.begin() + std::ptrdiff_t(kept), samples.end(),
                              farther);
            samples.resize(kept);
        };
        std::vector<Sample> all, starts;
        for (const std::vector<Sample>& inside : anchored) {
            std::vector<Sample> farthest = inside;
            keepFarthest(farthest, kOfAll);
            all.insert(all.end(), farthest.begin(), farthest.end());
            keepFarthest(farthest, kOfAnchor);
            starts.insert(starts.end(), farthest.begin(), farthest.end());
        }
        keepFarthest(all, kOfAll);
        starts.insert(starts.end(), all.begin(), all.end());
        return starts;
    }

    /// Moves the inside points as far along the direction as it finds a way inside the solid.
    void climb(std::size_t direction, std::vector<Sample> climbers) {
        constexpr std::size_t kProposals = 12;
        Point axis{};
        axis[direction / 2] = direction % 2 ? 1.0 : -1.0;
        double gain = 0.0;
        for (int round = 0; round < options.climbRounds && !climbers.empty(); ++round) {
            std::vector<Point> at, proposed;
            for (const Sample& climber : climbers) at.push_back(climber.point);
            std::vector<ValueGradient> slopes(at.size());
            evaluateGradient(machine, tape, at, slopes);
            result.evaluations += 2 * at.size();
            for (std::size_t i = 0; i < climbers.size(); ++i)
                propose(climbers[i], axis, slopes[i].gradient, kProposals, proposed);
            const std::vector<double> values = valuesAt(proposed);
            const double before = alongDirection(result.extremes[direction], direction);
            for (std::size_t i = 0; i < climbers.size(); ++i) {
                Sample& climber = climbers[i];
                const double from = alongDirection(climber.point, direction);
                double best = from;
                for (std::size_t j = i * kProposals; j < (i + 1) * kProposals; ++j) {
                    if (!(values[j] < 0.0)) continue;
                    addInside(proposed[j]);
                    const double along = alongDirection(proposed[j], direction);
                    if (along > best) best = along, climber.point = proposed[j];
                }
                climber.step *= best > from + 0.3 * climber.step ? 1.6 : best > from ? 1.0 : 0.55;
            }
            gain = alongDirection(result.extremes[direction], direction) - before;
            // Climbers that are far behind the best one, and no longer move, are dropped.
            const double extent = length(direction / 2), best = before + gain;
            std::erase_if(climbers, [&](const Sample& climber) {
                const double behind = best - alongDirection(climber.point, direction);
                return climber.step < 1e-7 * extent || (round > 8 && behind > 60.0 * climber.step);
            });
        }
        converged[direction] = gain <= 2e-3 * length(direction / 2);
    }

    void propose(const Sample& climber, const Point& axis, const Point& gradient, std::size_t count,
                 std::vector<Point>& proposed) {
        const double slope = std::hypot(gradient[0], gradient[1], gradient[2]);
        Point inward{}, tangent = axis;
        if (slope > 0.0 && std::isfinite(slope)) {
            double dot = 0.0;
            for (std::size_t i = 0; i < 3; ++i) inward[i] = -gradient[i] / slope, dot += inward[i] * axis[i];
            for (std::size_t i = 0; i < 3; ++i) tangent[i] = axis[i] - dot * inward[i];
            const double width = std::hypot(tangent[0], tangent[1], tangent[2]);
            if (width > 1e-9)
                for (double& x : tangent) x /= width;
        }
        const double step = climber.step;
        for (std::size_t i = 0; i < count; ++i) {
            switch (i) {
                case 0: proposed.push_back(plus(climber.point, axis, step)); break;
                case 1: proposed.push_back(plus(climber.point, axis, 0.2 * step)); break;
                case 2: proposed.push_back(plus(climber.point, tangent, step)); break;
                case 3:
                    proposed.push_back(plus(plus(climber.point, tangent, step), inward, 0.1 * step));
                    break;
                case 4:
                    proposed.push_back(plus(plus(climber.point, tangent, 3 * step), inward, 0.03 * step));
                    break;
                default: {
                    Point way = random.direction();
                    if (way[0] * axis[0] + way[1] * axis[1] + way[2] * axis[2] < 0.0)
                        for (double& x : way) x = -x;
                    proposed.push_back(plus(climber.point, way, step * random.between(0.1, 1.5)));
                }
            }
        }
    }

    /// Samples between each bound and the claimed one. Returns whether that found the solid there.
    bool scanSlabs(const Box& claimed) {
        bool any = false;
        for (std::size_t direction = 0; direction < 6; ++direction) {
            const std::size_t axis = direction / 2;
            const double extent = length(axis);
            const double found = direction % 2 ? result.box.hi[axis] : result.box.lo[axis];
            const double bound = direction % 2 ? claimed.hi[axis] : claimed.lo[axis];
            const double gap = direction % 2 ? bound - found : found - bound;
            if (!(gap > 0.01 * extent)) continue;
            std::vector<Point> points;
            for (int i = 0; i < options.slabSamples; ++i) {
                Point p{};
                for (std::size_t j = 0; j < 3; ++j) p[j] = random.between(claimed.lo[j], claimed.hi[j]);
                // Half of the samples are in the tenth of the slab next to the solid.
                const double share = random.between(0.0, i % 2 ? 1.0 : 0.1);
                p[axis] = found + (bound - found) * share;
                points.push_back(p);
            }
            const std::vector<double> values = valuesAt(points);
            std::vector<Sample> inside = insideOf(points, values, 0.1 * gap);
            if (inside.empty()) {
                inside = descend(points, values, 0.1 * gap);
                std::erase_if(inside, [&](const Sample& sample) {
                    return direction % 2 ? sample.point[axis] <= found : sample.point[axis] >= found;
                });
            }
            if (inside.empty()) continue;
            any = true;
            anchored.push_back(std::move(inside));
            climb(direction, startsOf(direction));
        }
        return any;
    }

    double length(std::size_t axis) const { return result.box.hi[axis] - result.box.lo[axis]; }

    const SolidBoundsOptions options;
    const Tape tape;
    TapeMachine<double> machine;
    SceneRandom random;
    SolidBounds result;
    std::array<bool, 6> converged{};
    std::vector<std::vector<Sample>> anchored;  // inside points, by anchor; the far ones come last
};

}  // namespace

SolidBounds sampleSolid(const Ir& ir, IrId root, std::span<const double> parameters,
                        std::span<const SceneAnchor> anchors, const std::optional<Box>& claimed,
                        const SolidBoundsOptions& options) {
    return SolidSampler(ir, root, parameters, options).run(anchors, claimed);
}

double distanceOutside(const Box& box, const Point& point) {
    double outside = -INFINITY;
    for (std::size_t axis = 0; axis < 3; ++axis)
        outside = std::max({outside, box.lo[axis] - point[axis], point[axis] - box.hi[axis]});
    return outside;
}

}  // namespace fw::test
