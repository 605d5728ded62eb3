// The nodes of 3MF's implicit functions that work on each component of their operands alike, and what they
// are here.
//
// A division by 0 gives what other programs' processors give, something very large with the sign of the
// dividend, for functions rely on it: a blend of radius 0, (b - a) / 0 clamped, is the lesser of the two.
// Elsewhere, where a function has no value (the root of a negative number) and a level set would take its
// fallback value, an operation gives the number that the node of our library gives.
#pragma once

#include <array>
#include <span>
#include <string_view>

namespace fw::threemf {

struct Operation {
    std::string_view kind;                   ///< as the specification has it
    std::string_view other;                  ///< as files have it too; may be empty
    std::array<std::string_view, 4> inputs;  ///< the operands, in order; empty behind the last
    std::string_view math, vectorMath;       ///< the `op` of the node `math`, `vector_math`; empty: none
    std::string_view code;                   ///< of operands a, b, c and d, for what no node does
    std::string_view vectorCode;             ///< of vectors, where that is another; else empty

    std::size_t count() const {
        std::size_t n = 0;
        while (n < inputs.size() && !inputs[n].empty()) ++n;
        return n;
    }
};

std::span<const Operation> operations();
/// That of the kind, by either name; nullptr if there is none.
const Operation* operation(std::string_view kind);

}  // namespace fw::threemf
