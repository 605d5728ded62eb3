#include "graph/bounds/projections.h"

#include <cmath>
#include <numbers>

namespace fw {

namespace {

constexpr double kLogarithmFloor = 1e-30;  // the op table's logarithm clamps its argument to this
constexpr double kSlack = 1e-12;           // relative error allowed for elementary functions

/// `value`, increased (or decreased) by the rounding error of a few operations.
double up(double value) { return value + std::abs(value) * kSlack; }
double down(double value) { return value - std::abs(value) * kSlack; }

/// Values beyond kHuge count as somewhat less, so that neither interval is empty.
Interval atMost(double value) { return {-kHuge, std::clamp(value, -0.1 * kHuge, kHuge)}; }
Interval atLeast(double value) { return {std::clamp(value, -kHuge, 0.1 * kHuge), kHuge}; }

/// All x with x * factor in `product` for some factor in `b`.
bool quotients(Interval product, Interval b, Interval& x) {
    if (b.lo > 0.0 || b.hi < 0.0) return intersect(x, product / b);
    if (product.lo <= 0.0 && product.hi >= 0.0) return true;
    if (b.lo == 0.0 && b.hi == 0.0) return false;
    const bool positive = product.lo > 0.0;
    const double nearest = positive ? product.lo : -product.hi;
    if (b.lo == 0.0) {
        const double least = down(nearest / above(b.hi));
        return intersect(x, positive ? atLeast(least) : atMost(-least));
    }
    if (b.hi == 0.0) {
        const double least = down(nearest / -below(b.lo));
        return intersect(x, positive ? atMost(-least) : atLeast(least));
    }
    return true;
}

/// |x| in `magnitude`, whose lower end may be negative.
bool projectMagnitude(Interval magnitude, Interval& x) {
    if (magnitude.hi < 0.0 || !intersect(x, {-magnitude.hi, magnitude.hi})) return false;
    if (magnitude.lo <= 0.0) return true;
    if (x.lo > -magnitude.lo) x.lo = std::max(x.lo, magnitude.lo);
    if (x.hi < magnitude.lo) x.hi = std::min(x.hi, -magnitude.lo);
    return x.lo <= x.hi;
}

bool projectMinimum(Interval result, Interval& a, Interval& b, double blend) {
    const double most = up(result.hi + blend);
    if (!intersect(a, atLeast(result.lo)) || !intersect(b, atLeast(result.lo))) return false;
    if (b.lo > most) return intersect(a, atMost(most));
    if (a.lo > most) return intersect(b, atMost(most));
    return true;
}

bool projectSelect(Interval result, Interval& condition, Interval& a, Interval& b) {
    Interval taken = a, other = b;
    const bool canTake = condition.hi > 0.5 && intersect(taken, result);
    const bool canLeave = condition.lo < 0.5 && intersect(other, result);
    if (canTake && canLeave) return true;
    if (canTake) return a = taken, intersect(condition, {1.0, 1.0});
    if (canLeave) return b = other, intersect(condition, {0.0, 0.0});
    return false;
}

/// `a` < `b` or `a` <= `b`: the strictness does not matter for closed intervals.
bool projectOrder(Interval& a, Interval& b) {
    return intersect(a, atMost(b.hi)) && intersect(b, atLeast(a.lo));
}
bool projectComparison(Interval result, Interval& a, Interval& b) {
    if (result.lo > 0.5) return projectOrder(a, b);
    if (result.hi < 0.5) return projectOrder(b, a);
    return true;
}

bool projectPower(Interval result, Interval& base, Interval exponent) {
    if (!exponent.isPoint() || exponent.lo <= 0.0) return true;
    if (result.hi < 0.0) return false;
    if (result.hi < kHuge && !intersect(base, atMost(up(std::pow(result.hi, 1.0 / exponent.lo)))))
        return false;
    return result.lo <= 1e-300 || intersect(base, atLeast(down(std::pow(result.lo, 1.0 / exponent.lo))));
}

/// The value of an outline, a volume or a spline is at least the distance to a box that holds all of it.
bool projectToBox(double lo, double hi, double distance, Interval& x) {
    const double reach = up(std::max(distance, 0.0)), slack = 1e-6 * (hi - lo) + 1e-12;
    return intersect(x, {down(lo) - reach - slack, up(hi) + reach + slack});
}

bool projectVolume(Interval result, const VolumeLayer& layer, Interval* place) {
    if (layer.channel >= redChannel || result.hi >= kHuge) return true;
    const VolumeGrid& grid = layer.volume->grid;
    for (int axis = 0; axis < 3; ++axis) {
        const double lo = grid.origin[axis], hi = lo + grid.cell * (grid.size[axis] - 1);
        if (!projectToBox(lo, hi, result.hi, place[axis])) return false;
    }
    return true;
}

}  // namespace

bool projectOperands(Op op, Interval result, Interval* x, const SampledLayer& layer) {
    switch (op) {
        case Op::negate: return intersect(x[0], -result);
        case Op::absolute: return projectMagnitude(result, x[0]);
        case Op::sign:
            if (result.hi < 1.0 && !intersect(x[0], atMost(0.0))) return false;
            return result.lo <= -1.0 || intersect(x[0], atLeast(0.0));
        case Op::floor: return intersect(x[0], {std::ceil(result.lo), std::floor(result.hi) + 1.0});
        case Op::ceil: return intersect(x[0], {std::ceil(result.lo) - 1.0, std::floor(result.hi)});
        case Op::round: return intersect(x[0], {std::ceil(result.lo) - 0.5, std::floor(result.hi) + 0.5});
        case Op::truncate: return intersect(x[0], {std::ceil(result.lo) - 1.0, std::floor(result.hi) + 1.0});
        case Op::squareRoot:
            if (result.hi < 0.0 || !intersect(x[0], atMost(up(result.hi * result.hi)))) return false;
            return result.lo <= 0.0 || intersect(x[0], atLeast(down(result.lo * result.lo)));
        case Op::square:
            if (result.hi < 0.0) return false;
            return projectMagnitude({down(std::sqrt(std::max(result.lo, 0.0))),
                                     result.hi < kHuge ? up(std::sqrt(result.hi)) : kHuge},
                                    x[0]);
        case Op::exponential:
            if (result.hi < 0.0) return false;
            if (result.hi < kHuge && !intersect(x[0], atMost(up(std::log(result.hi + 1e-290)) + kSlack)))
                return false;
            return result.lo <= 1e-290 || intersect(x[0], atLeast(down(std::log(result.lo)) - kSlack));
        case Op::logarithm:
            if (result.hi < std::log(kLogarithmFloor) - 1e-6) return false;
            if (result.hi < 69.0 && !intersect(x[0], atMost(up(std::exp(result.hi) * (1.0 + 1e-9)))))
                return false;
            return result.lo <= std::log(kLogarithmFloor) + 1e-6 ||
                   intersect(x[0], atLeast(std::exp(std::min(result.lo, 69.0)) * (1.0 - 1e-9)));
        case Op::sine:
        case Op::cosine: return result.lo <= 1.0 && result.hi >= -1.0;
        case Op::arcSine:
            if (result.hi < 1.57 && !intersect(x[0], atMost(std::sin(std::max(result.hi, -1.6)) + kSlack)))
                return false;
            return result.lo <= -1.57 ||
                   intersect(x[0], atLeast(std::sin(std::min(result.lo, 1.6)) - kSlack));
        case Op::arcTangent:
            if (result.hi < 1.57 &&
                !intersect(x[0], atMost(up(std::tan(std::max(result.hi, -1.5707))) + kSlack)))
                return false;
            return result.lo <= -1.57 ||
                   intersect(x[0], atLeast(down(std::tan(std::min(result.lo, 1.5707))) - kSlack));
        case Op::logicalNot: return intersect(x[0], {1.0 - result.hi, 1.0 - result.lo});
        case Op::add: return intersect(x[0], result - x[1]) && intersect(x[1], result - x[0]);
        case Op::subtract: return intersect(x[0], result + x[1]) && intersect(x[1], x[0] - result);
        case Op::multiply: return quotients(result, x[1], x[0]) && quotients(result, x[0], x[1]);
        case Op::divide:
            return (x[1].lo <= 0.0 && x[1].hi >= 0.0) ||
                   (intersect(x[0], result * x[1]) && quotients(x[0], result, x[1]));
        case Op::minimum: return projectMinimum(result, x[0], x[1], 0.0);
        case Op::maximum: {
            Interval a = -x[0], b = -x[1];
            if (!projectMinimum(-result, a, b, 0.0)) return false;
            return x[0] = -a, x[1] = -b, true;
        }
        case Op::power: return projectPower(result, x[0], x[1]);
        case Op::less:
        case Op::lessEqual: return projectComparison(result, x[0], x[1]);
        case Op::equal: return result.lo < 0.5 || (intersect(x[0], x[1]) && intersect(x[1], x[0]));
        case Op::logicalAnd:
            return result.lo < 0.5 || (intersect(x[0], {1.0, 1.0}) && intersect(x[1], {1.0, 1.0}));
        case Op::logicalOr:
            return result.hi > 0.5 || (intersect(x[0], {0.0, 0.0}) && intersect(x[1], {0.0, 0.0}));
        case Op::select: return projectSelect(result, x[0], x[1], x[2]);
        case Op::smoothMinimum:
            return projectMinimum(result, x[0], x[1],
                                  x[2].hi < kHuge ? 0.25 * std::max(x[2].hi, 0.0) : kHuge);
        case Op::volume: return projectVolume(result, *layer.volume, x);
        case Op::outline: {
            const Outline& outline = *layer.outline;
            return result.hi >= kHuge || (projectToBox(outline.lo.x, outline.hi.x, result.hi, x[0]) &&
                                          projectToBox(outline.lo.y, outline.hi.y, result.hi, x[1]));
        }
        default: return true;
    }
}

}  // namespace fw
