// Meaning of the field language: checked code into the scalar graph of ir.h, by abstract execution.
//
// Every value is a function of the position, represented by ids of the Ir. Running an instruction computes
// ids, so
//   * a call is inlined, a `for` is unrolled, an `if` whose condition is known runs one side;
//   * an `if` that depends on the position runs both sides and selects, for each variable that one of them
//   assigned;
//   * `return`, `break` and `continue` under a condition that depends on the position take along what the
//   variables are then, and the
//     condition under which they are reached ("live"). Who stays goes on as if nobody had left; where the
//     loop ends, or the iteration, the variables of those who left are selected by their conditions. So a
//     loop's own variable is known in every iteration though some places have left it.
//   * `a(q)`, a field at another position, is a substitution in a's graph.
//
// Calls are frames on a stack of this file, not of the processor.
//
// Numbers: an integer literal is a float wherever a float is wanted, `/` always divides as float, and an
// `int` truncates what is stored in it. A surface stands for its distance in arithmetic; min and max of
// surfaces keep the material of the side taken; assigning a float to a variable that holds a surface replaces
// its distance.
#pragma once

#include <string_view>
#include <vector>

#include "graph/language/code.h"

namespace fw::language {

inline constexpr std::size_t kMaxSteps = 4'000'000;
/// Operations visited by moving fields to other positions, in one compilation.
inline constexpr std::size_t kMaxSubstituted = 2'000'000;

/// What lowering is told beside the code.
struct LowerOptions {
    std::vector<OutputSpec> outputs = {};  ///< as they were declared to resolve()
    bool refusesZeroDivision = false;      ///< a division by the constant 0 is an error (a user's code)
};

/// Runs `code` on its inputs, one value for each that was declared; one value for each output, or the one
/// result. The Error names the place inside the code: what is no constant and must be one, loops and fields
/// that are too large.
Result<std::vector<Value>> lower(Lowering& state, const Code& code, std::vector<Value> inputs,
                                 const LowerOptions& options);

/// Runs the body of a library node on its inputs, one value for each entry of `type.inputs`.
Result<std::vector<Value>> lowerNode(Lowering& state, const NodeType& type, std::vector<Value> inputs);

/// resolve() and lower() of a text that sees these inputs. Error: the first that is found.
Result<Value> lowerText(Lowering& state, std::string_view text,
                        const std::vector<std::pair<std::string, Value>>& inputs = {});

}  // namespace fw::language
