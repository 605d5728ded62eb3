// The op table: every scalar operation of the IR with its name, arity and meanings.
//
// * value: T x T ... -> T, of which that in double is the reference
// * interval: Interval x Interval ... -> Interval, containing the value of every point of its operands
// * gradient: forward mode, the derivative of the result from the operands' derivatives, one direction at a
// time
// * the same three as GLSL text
//
// Adding an op is one row of the table in ops.cpp, and its name in the enum. Everything else, the folding of
// constants, the CPU evaluators, the GLSL emitters and the tests, is driven by the row.
//
// In the GLSL templates %a %b %c %d are the operands, %v is the result's value, %A %B %C %D are the
// operands' derivatives along a direction, %s is the variable that holds `glslSample`, and %i is the number
// of the layer that the operation samples. Booleans are 0 or 1 on the CPU and `bool` in GLSL; their intervals
// are vec2(0|1, 0|1). Sums and roots round in GLSL intervals as they do in values; see lib/interval.glsl.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "graph/assets/image.h"
#include "graph/assets/volume.h"
#include "graph/base/interval.h"
#include "graph/curves/spline_table.h"
#include "graph/outlines/outline.h"

namespace fw {

/// Order is the order of rows in the table. Files never store these numbers.
enum class Op : uint8_t {
    // leaves
    constant,
    parameter,
    column,
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
    cellWall,
    cellHash,
    // two operands: u, v; which layer of which image is part of the node
    image,
    // three operands: x, y, z; which layer of which volume is part of the node
    volume,
    // two operands: x, y; of which outline is part of the node
    outline,
    // three operands: x, y, z; which channel of which spline is part of the node
    spline,
    count
};

inline constexpr int kMaxArity = 4;

/// What an operation samples: nothing, but for `image`, `volume`, `outline` and `spline`.
struct SampledLayer {
    const ImageLayer* image = nullptr;
    const VolumeLayer* volume = nullptr;
    const Outline* outline = nullptr;
    const SplineTable* spline = nullptr;
    SplineChannel channel = {};
};

/// An operation over rows of `count` numbers. An operand is a row, or a single number where its bit in the
/// index is set; a form that is null is not there, and its numbers must be put into rows. Results overlap no
/// operand.
template <class T>
struct OpKernels {
    static constexpr int kForms = 9;
    void (*values[kForms])(const T* const* operands, T* results, std::size_t count, SampledLayer layer);
    /// One component of the results' derivative from those of the operands. A number has none: its place in
    /// `derivatives` is not read.
    void (*slopes[kForms])(const T* const* operands, const T* results, const T* const* derivatives, T* slopes,
                           std::size_t count, SampledLayer layer);
};

/// How far a value in single precision may be from the exact one of its operands.
enum class Rounding : uint8_t {
    none,       ///< not at all
    result,     ///< by some of its own last places
    magnitude,  ///< by some last places of the greatest of result and operands, which may themselves be off
                ///< by that when whole numbers are taken of them
    noise,      ///< as magnitude, and of 1: they are sums of such terms
};

struct OpInfo {
    Op op;
    const char* name;
    int arity;
    bool boolean;      ///< the result is a truth value
    bool commutative;  ///< operands may be swapped
    Rounding rounding;
    // The last argument of each is what Ir::layer() gives for the node.
    double (*value)(const double* operands, SampledLayer layer);
    Interval (*interval)(const Interval* operands, SampledLayer layer);
    const OpKernels<double>* doubles[2];  ///< for any processor, and for those with AVX2
    const OpKernels<float>* floats[2];
    const char* glsl;
    const char* glslInterval;
    const char* glslGradient;  ///< "" where the derivative is zero everywhere
    /// The derivatives by the first three operands and the value, a vec4, where one pass gives them all; else
    /// "".
    const char* glslSample;
    int weight;  ///< of the code that it becomes, and about of its time; an addition is 1
};

const OpInfo& opInfo(Op op);
std::span<const OpInfo> opTable();

/// The kernels of all operations for this processor, in the order of the table.
template <class T>
std::span<const OpKernels<T>* const> opKernels();
template <>
std::span<const OpKernels<double>* const> opKernels<double>();
template <>
std::span<const OpKernels<float>* const> opKernels<float>();

/// An interval that contains every value of the operation in single precision, over operands of which the
/// same holds.
Interval singlePrecisionInterval(const OpInfo& info, std::span<const Interval> operands, SampledLayer layer);

}  // namespace fw
