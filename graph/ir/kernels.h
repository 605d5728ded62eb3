// The loops that apply one operation to rows of numbers, made from the scalar meanings of the op table's
// rows.
//
// What an operation means is written once, as a lambda over any floating-point type (ops.cpp); here it
// becomes loops over float and double, with operands that are rows or single numbers. Each loop is compiled
// twice, for every x86-64 processor and for those with AVX2, and the table is chosen when the program runs.
// No version fuses a product with a sum, so all give the same bits: those of the meaning itself. A meaning
// whose branches forbid vectors has a part most(), and needsAll() tells of its value where the whole must be
// asked.
//
// Included by ops.cpp alone.
#pragma once

#include <type_traits>
#include <utility>

#include "graph/ir/ops.h"

#if defined(__x86_64__) || defined(__i386__)
#define FIELDWRIGHT_AVX2 [[gnu::target("avx2")]]
#else
#define FIELDWRIGHT_AVX2
#endif

namespace fw {

/// Calls a meaning, with the layer if it takes one.
template <class Meaning, class... Arguments>
[[gnu::always_inline]] inline constexpr auto call(SampledLayer layer, Arguments... arguments) {
    if constexpr (std::is_invocable_v<Meaning, Arguments..., SampledLayer>)
        return Meaning{}(arguments..., layer);
    else
        return Meaning{}(arguments...);
}

/// `numbers` is the mask of the operands that are single numbers.
template <class Value, int numbers, class T, std::size_t... i>
[[gnu::always_inline]] inline void valueLoop(const T* const* operands, T* __restrict__ results,
                                             std::size_t count, SampledLayer layer,
                                             std::index_sequence<i...>) {
    const T* const rows[] = {operands[i]...};
    const T held[] = {*operands[i]...};
    constexpr bool inParts = requires { Value::most(*rows); };
    for (std::size_t k = 0; k < count; ++k) {
        const T x[] = {((numbers >> i & 1) ? held[i] : rows[i][k])...};
        if constexpr (inParts)
            results[k] = Value::most(&x[0]);
        else
            results[k] = T(call<Value>(layer, &x[0]));
    }
    if constexpr (inParts)
        for (std::size_t k = 0; k < count; ++k) {
            const T x[] = {((numbers >> i & 1) ? held[i] : rows[i][k])...};
            if (Value::needsAll(&x[0], results[k])) results[k] = Value{}(&x[0]);
        }
}

template <class Slope, int numbers, class T, std::size_t... i>
[[gnu::always_inline]] inline void slopeLoop(const T* const* operands, const T* results,
                                             const T* const* derivatives, T* __restrict__ slopes,
                                             std::size_t count, SampledLayer layer,
                                             std::index_sequence<i...>) {
    const T *const rows[] = {operands[i]...}, *const moves[] = {derivatives[i]...};
    const T held[] = {*operands[i]...};
    constexpr bool inParts = requires { Slope::most(*rows, *rows); };
    for (std::size_t k = 0; k < count; ++k) {
        const T x[] = {((numbers >> i & 1) ? held[i] : rows[i][k])...};
        const T d[] = {((numbers >> i & 1) ? T(0) : moves[i][k])...};
        if constexpr (inParts)
            slopes[k] = Slope::most(&x[0], &d[0]);
        else
            slopes[k] = T(call<Slope>(layer, &x[0], results[k], &d[0]));
    }
    if constexpr (inParts)
        for (std::size_t k = 0; k < count; ++k) {
            const T x[] = {((numbers >> i & 1) ? held[i] : rows[i][k])...};
            if (!Slope::needsAll(&x[0], results[k])) continue;
            const T d[] = {((numbers >> i & 1) ? T(0) : moves[i][k])...};
            slopes[k] = Slope{}(&x[0], results[k], &d[0]);
        }
}

template <class Value, int arity, int numbers, class T>
[[gnu::flatten]] void plainValues(const T* const* operands, T* results, std::size_t count,
                                  SampledLayer layer) {
    valueLoop<Value, numbers>(operands, results, count, layer, std::make_index_sequence<arity>());
}
template <class Value, int arity, int numbers, class T>
FIELDWRIGHT_AVX2 [[gnu::flatten]] void wideValues(const T* const* operands, T* results, std::size_t count,
                                                  SampledLayer layer) {
    valueLoop<Value, numbers>(operands, results, count, layer, std::make_index_sequence<arity>());
}
template <class Slope, int arity, int numbers, class T>
[[gnu::flatten]] void plainSlopes(const T* const* operands, const T* results, const T* const* derivatives,
                                  T* slopes, std::size_t count, SampledLayer layer) {
    slopeLoop<Slope, numbers>(operands, results, derivatives, slopes, count, layer,
                              std::make_index_sequence<arity>());
}
template <class Slope, int arity, int numbers, class T>
FIELDWRIGHT_AVX2 [[gnu::flatten]] void wideSlopes(const T* const* operands, const T* results,
                                                  const T* const* derivatives, T* slopes, std::size_t count,
                                                  SampledLayer layer) {
    slopeLoop<Slope, numbers>(operands, results, derivatives, slopes, count, layer,
                              std::make_index_sequence<arity>());
}

template <class Value, class Slope, int arity, class T, bool wide, int numbers>
constexpr void setForm(OpKernels<T>& kernels) {
    if constexpr (wide) {
        kernels.values[numbers] = wideValues<Value, arity, numbers, T>;
        kernels.slopes[numbers] = wideSlopes<Slope, arity, numbers, T>;
    } else {
        kernels.values[numbers] = plainValues<Value, arity, numbers, T>;
        kernels.slopes[numbers] = plainSlopes<Slope, arity, numbers, T>;
    }
}

/// The forms that fields use: one of two operands a number; of three, those behind the first; of four, the
/// last.
template <class Value, class Slope, int arity, class T, bool wide>
constexpr OpKernels<T> makeKernels() {
    OpKernels<T> kernels{};
    if constexpr (arity > 0) setForm<Value, Slope, arity, T, wide, 0>(kernels);
    if constexpr (arity == 2) {
        setForm<Value, Slope, arity, T, wide, 1>(kernels);
        setForm<Value, Slope, arity, T, wide, 2>(kernels);
    }
    if constexpr (arity == 3) {
        setForm<Value, Slope, arity, T, wide, 2>(kernels);
        setForm<Value, Slope, arity, T, wide, 4>(kernels);
        setForm<Value, Slope, arity, T, wide, 6>(kernels);
    }
    if constexpr (arity == 4) setForm<Value, Slope, arity, T, wide, 8>(kernels);
    return kernels;
}

template <class Value, class Slope, int arity, class T, bool wide>
inline constexpr OpKernels<T> kKernels = makeKernels<Value, Slope, arity, T, wide>();

}  // namespace fw
