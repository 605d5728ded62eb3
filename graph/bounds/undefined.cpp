#include "graph/bounds/undefined.h"

#include <array>
#include <cmath>

#include "graph/ir/ops.h"

namespace fw {

namespace {

/// exp() of more overflows, and of less than the negative is 0.
constexpr double kLargestExponent = 700.0;

/// Properties that an operation's value may have in some volume of space.
struct Volume {
    bool isConstant = false, isPlusInfinity = false, isMinusInfinity = false, isNaN = false;

    bool isInfinite() const { return isPlusInfinity || isMinusInfinity; }
};

class VolumeAnalysis {
  public:
    VolumeAnalysis(const Ir& ir_, std::span<const Interval> everywhere_, std::span<const Interval> nearby_)
        : ir(ir_), everywhere(everywhere_), nearby(nearby_), volumes(ir_.size()) {}

    std::vector<bool> run() {
        std::vector<bool> mayBeNaN(ir.size());
        for (IrId id = 0; id < ir.size(); ++id) {
            volumes[id] = analyse(id);
            mayBeNaN[id] = volumes[id].isNaN;
        }
        return mayBeNaN;
    }

  private:
    Volume analyse(IrId id) const {
        const IrNode& node = ir[id];
        const auto arity = std::size_t(opInfo(node.op).arity);
        const auto mayBeZero = [&](std::size_t i) {
            return volumes[node.operands[i]].isConstant && everywhere[node.operands[i]].contains(0.0);
        };
        std::array<Volume, kMaxArity> operands{};
        bool allConstant = true, anyConstant = false, anyInfinite = false, anyNaN = false;
        bool operandsAreBounded = true;
        for (std::size_t i = 0; i < arity; ++i) {
            operands[i] = volumes[node.operands[i]];
            allConstant = allConstant && operands[i].isConstant;
            anyConstant = anyConstant || operands[i].isConstant;
            anyInfinite = anyInfinite || operands[i].isInfinite();
            anyNaN = anyNaN || operands[i].isNaN;
            operandsAreBounded = operandsAreBounded && isBounded(nearby[node.operands[i]]);
        }
        const Volume &a = operands[0], &b = operands[1], &c = operands[2];
        Volume result{.isConstant = true,
                      .isPlusInfinity = anyInfinite,
                      .isMinusInfinity = anyInfinite,
                      .isNaN = anyNaN};
        const auto overflows = [&] {
            if (!operandsAreBounded) return;
            result.isPlusInfinity |= nearby[id].hi >= kHuge;
            result.isMinusInfinity |= nearby[id].lo <= -kHuge;
        };
        switch (node.op) {
            case Op::positionX:
            case Op::positionY:
            case Op::positionZ: return {};
            case Op::constant:
                result.isPlusInfinity = node.number > 0.0 && std::isinf(node.number);
                result.isMinusInfinity = node.number < 0.0 && std::isinf(node.number);
                result.isNaN = std::isnan(node.number);
                break;
            case Op::negate:
                result.isConstant = allConstant;
                result.isPlusInfinity = a.isMinusInfinity, result.isMinusInfinity = a.isPlusInfinity;
                break;
            case Op::absolute:
            case Op::square:
                result.isConstant = allConstant;
                result.isMinusInfinity = false;
                overflows();
                break;
            case Op::exponential:
                result.isConstant =
                    allConstant || a.isMinusInfinity || nearby[node.operands[0]].lo < -kLargestExponent;
                result.isPlusInfinity = a.isPlusInfinity || nearby[node.operands[0]].hi > kLargestExponent;
                result.isMinusInfinity = false;
                break;
            case Op::logarithm:
                result.isPlusInfinity = a.isPlusInfinity;
                result.isMinusInfinity = a.isConstant && everywhere[node.operands[0]].lo <= 0.0;
                break;
            case Op::squareRoot:
                result.isConstant = allConstant || everywhere[node.operands[0]].lo < 0.0;
                result.isMinusInfinity = false;
                break;
            case Op::sine:
            case Op::cosine:
            case Op::tangent:
                result.isConstant = allConstant;
                result = {.isConstant = allConstant, .isNaN = anyNaN || anyInfinite};
                break;
            case Op::arcTangent:
            case Op::arcTangent2: result = {.isConstant = allConstant || anyInfinite, .isNaN = anyNaN}; break;
            case Op::add:
            case Op::subtract: {
                const bool isSum = node.op == Op::add;
                const bool plus = isSum ? b.isPlusInfinity : b.isMinusInfinity,
                           minus = isSum ? b.isMinusInfinity : b.isPlusInfinity;
                result = {.isConstant = allConstant,
                          .isPlusInfinity = a.isPlusInfinity || plus,
                          .isMinusInfinity = a.isMinusInfinity || minus,
                          .isNaN = anyNaN || (a.isPlusInfinity && minus) || (a.isMinusInfinity && plus)};
                overflows();
                break;
            }
            case Op::multiply: {
                result.isConstant = allConstant || mayBeZero(0) || mayBeZero(1);
                result.isNaN |= (a.isInfinite() && mayBeZero(1)) || (b.isInfinite() && mayBeZero(0));
                const Interval x = nearby[node.operands[0]], y = nearby[node.operands[1]];
                const bool isPositive = (x.lo >= 0.0 && y.lo >= 0.0) || (x.hi <= 0.0 && y.hi <= 0.0);
                result.isMinusInfinity = anyInfinite && !isPositive;
                overflows();
                break;
            }
            case Op::divide:
                result.isConstant = allConstant || mayBeZero(0) || b.isInfinite();
                result.isNaN |= mayBeZero(1) || (a.isInfinite() && b.isInfinite());
                break;
            case Op::power: {
                const Interval exponent = nearby[node.operands[1]];
                result.isPlusInfinity = anyInfinite || (mayBeZero(0) && exponent.lo < 0.0);
                result.isMinusInfinity = false;
                overflows();
                break;
            }
            case Op::minimum:  // ignores a second operand that is NaN
                result = {.isConstant = anyConstant,
                          .isPlusInfinity = a.isPlusInfinity && b.isPlusInfinity,
                          .isMinusInfinity = a.isMinusInfinity || b.isMinusInfinity,
                          .isNaN = a.isNaN};
                break;
            case Op::maximum:
                result = {.isConstant = anyConstant,
                          .isPlusInfinity = a.isPlusInfinity || b.isPlusInfinity,
                          .isMinusInfinity = a.isMinusInfinity && b.isMinusInfinity,
                          .isNaN = a.isNaN};
                break;
            case Op::smoothMinimum:
                result.isConstant = anyConstant;
                result.isNaN |= anyInfinite;
                break;
            case Op::select:
                result.isPlusInfinity = b.isPlusInfinity || c.isPlusInfinity;
                result.isMinusInfinity = b.isMinusInfinity || c.isMinusInfinity;
                result.isNaN = b.isNaN || c.isNaN;
                break;
            case Op::modulo:
            case Op::truncatedModulo:
                result = {.isConstant = allConstant || mayBeZero(0),
                          .isNaN = anyNaN || mayBeZero(1) || a.isInfinite()};
                break;
            // Gradients across a coordinate that does not vary are 0 along others.
            case Op::gradientNoise:
            case Op::simplexNoise:
            case Op::worleyNoise:
            case Op::cellWall: result = {.isConstant = anyConstant, .isNaN = anyNaN || anyInfinite}; break;
            case Op::cellHash:
            case Op::image:
            case Op::volume:
            case Op::outline:
            case Op::spline: result = {.isConstant = true, .isNaN = anyNaN || anyInfinite}; break;
            case Op::less:
            case Op::lessEqual:
            case Op::equal:
            case Op::logicalAnd:
            case Op::logicalOr:
            case Op::logicalNot: result = {.isConstant = true, .isNaN = anyNaN}; break;
            default: break;
        }
        return result;
    }

    const Ir& ir;
    std::span<const Interval> everywhere, nearby;
    std::vector<Volume> volumes;
};

}  // namespace

std::vector<bool> findUndefined(const Ir& ir, std::span<const Interval> everywhere,
                                std::span<const Interval> nearby) {
    return VolumeAnalysis(ir, everywhere, nearby).run();
}

}  // namespace fw
