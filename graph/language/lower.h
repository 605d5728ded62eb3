// Meaning of the field language: a syntax tree into the scalar graph of ir.h, by abstract execution.
//
// Every value is a function of the position, represented by ids of the Ir. Running a statement computes ids,
// so
//   * a call is inlined, a constant `for` is unrolled, a constant `if` runs one side;
//   * an `if` that depends on the position runs both sides and selects, variable by variable; `return`,
//   `break`
//     and `continue` inside it are kept as the condition under which the code that follows still counts
//     ("live");
//   * `a(q)`, a field at another position, is a substitution in a's graph.
//
// Numbers: an integer literal is a float wherever a float is wanted, `/` always divides as float, and
// an `int` truncates what is stored in it. A surface stands for its distance in arithmetic; min and max of
// surfaces keep the material of the side taken; assigning a float to a variable that holds a surface replaces
// its distance.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "graph/ir/ir.h"
#include "graph/language/parser.h"
#include "graph/library/node_type.h"

namespace fw {
struct MeshRecipe;
struct ParticleRecipe;
}  // namespace fw

namespace fw::language {

/// A typed value: componentCount(type) ids, or a text, points or an image known at compile time.
struct Value {
    Type type = Type::scalar;
    std::array<IrId, 9> ids{};
    std::string text{};
    std::shared_ptr<const std::vector<double>> points{};  ///< x, y pairs
    uint32_t image = 0;                                   ///< number among Ir::images()
    std::shared_ptr<const MeshRecipe> mesh{};  ///< of a surface that stands for a mesh: how that is made
    /// Of particles: their stages, whose numbers are ids of the Lowering's ir.
    std::shared_ptr<const ParticleRecipe> particles{};

    IrId id() const { return ids[0]; }
};

/// What a code text sees.
struct Scope {
    std::vector<std::pair<std::string, Value>> inputs;
    std::vector<OutputSpec> outputs;   ///< wanted results; the first is what `return` yields
    bool anyResult = false;            ///< the first output takes the type that the code returns
    bool refusesZeroDivision = false;  ///< a division by the constant 0 is an error (a user's code)
};

/// One compilation's state.
struct Lowering {
    Ir ir;
    IrId time = 0;            ///< seconds
    std::size_t steps = 0;    ///< expressions and statements run so far, bounded by kMaxSteps
    int calls = 0;            ///< depth of calls, bounded by kMaxCalls
    std::string graphPath{};  ///< the file that paths of images are relative to
    std::map<std::string, FieldImagePtr> images{};  ///< by path: those that were read
};

inline constexpr std::size_t kMaxSteps = 4'000'000;
inline constexpr int kMaxCalls = 64;
/// Operations visited by moving fields to other positions, in one compilation.
inline constexpr std::size_t kMaxSubstituted = 2'000'000;

/// Runs `tree` in `scope`; one value for each output. The Error names the place inside the code.
Result<std::vector<Value>> lower(Lowering& state, const Tree& tree, const Scope& scope);

/// Runs the body of a library node on its inputs, one value for each entry of `type.inputs`.
Result<std::vector<Value>> lowerNode(Lowering& state, const NodeType& type, std::vector<Value> inputs);

/// The value of an input that is neither given nor linked.
Value defaultValue(Lowering& state, const InputSpec& input);

/// `value` as `type`: surface <-> float (distance, default material), bool and int to float, float to vec2
/// and vec3 (splat), string to image (a path: the file is read). An Error without a place if there is no such
/// conversion.
Result<Value> convert(Lowering& state, const Value& value, Type type);

Value constantValue(Lowering& state, Type type, std::span<const double> numbers);
/// The surface of nothing: far away everywhere.
Value emptySurface(Lowering& state);
inline constexpr double kEmptyDistance = 1e9;

}  // namespace fw::language
