// The op table: every scalar operation of the IR with its name, arity and meanings.
//
// * value: double x double ... -> double, the reference
// * interval: Interval x Interval ... -> Interval, containing the value of every point of its operands
// * gradient: forward mode, the derivative of the result from the operands' derivatives, one direction at a
// time
// * the same three as GLSL text
//
// Adding an op is one row of the table in ops.cpp, and its name in the enum. Everything else, the folding of
// constants, the CPU evaluators, the GLSL emitters and the tests, is driven by the row.
//
// In the GLSL templates %a %b %c %d are the operands, %v is the result's value, %A %B %C %D are the
// operands' derivatives along a direction, and %i is the number of the layer that the operation
// samples. Booleans are 0 or 1 on the CPU and `bool` in GLSL; their intervals
// are vec2(0|1, 0|1). Sums and roots round in GLSL intervals as they do in values; see lib/interval.glsl.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "graph/assets/image.h"
#include "graph/assets/volume.h"
#include "graph/base/interval.h"

namespace fw {

/// Order is the order of rows in the table. Files never store these numbers.
enum class Op : uint8_t {
    // leaves
    constant,
    parameter,
    positionX,
    positionY,
    positionZ,
    // one operand
    negate,
    absolute,
    sign,
    floor,
    ceil,
    round,
    truncate,
    squareRoot,
    square,
    exponential,
    logarithm,
    sine,
    cosine,
    tangent,
    arcSine,
    arcCosine,
    arcTangent,
    logicalNot,
    // two operands
    add,
    subtract,
    multiply,
    divide,
    minimum,
    maximum,
    power,
    modulo,
    truncatedModulo,
    arcTangent2,
    less,
    lessEqual,
    equal,
    logicalAnd,
    logicalOr,
    // three operands: condition, then, else; a, b, width of the blend
    select,
    smoothMinimum,
    // four operands: x, y, z, seed
    gradientNoise,
    simplexNoise,
    worleyNoise,
    cellHash,
    // two operands: u, v; which layer of which image is part of the node
    image,
    // three operands: x, y, z; which layer of which volume is part of the node
    volume,
    count
};

inline constexpr int kMaxArity = 4;

/// What an operation samples: nothing, but for `image` and `volume`.
struct SampledLayer {
    const ImageLayer* image = nullptr;
    const VolumeLayer* volume = nullptr;
};

struct OpInfo {
    Op op;
    const char* name;
    int arity;
    bool boolean;      ///< the result is a truth value
    bool commutative;  ///< operands may be swapped
    // The last argument of each is what Ir::layer() gives for the node.
    double (*value)(const double* operands, SampledLayer layer);
    Interval (*interval)(const Interval* operands, SampledLayer layer);
    /// value and one component of the result's derivative over arrays: `operands[i]` and `derivatives[i]`
    /// hold `count` numbers each.
    void (*values)(const double* const* operands, double* results, std::size_t count, SampledLayer layer);
    void (*gradients)(const double* const* operands, const double* results, const double* const* derivatives,
                      double* slopes, std::size_t count, SampledLayer layer);
    const char* glsl;
    const char* glslInterval;
    const char* glslGradient;  ///< "" where the derivative is zero everywhere
};

const OpInfo& opInfo(Op op);
std::span<const OpInfo> opTable();

}  // namespace fw
