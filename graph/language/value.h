// The values that code computes with, as it is lowered: each a function of the position.
//
// A value is typed, and made of ids of an Ir: one for each scalar that represents it. What is no function of
// the position (texts, lists, an image, a spline) is known when the graph is compiled, and stands beside the
// ids.
#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "graph/ir/ir.h"
#include "graph/library/node_type.h"

namespace fw {
struct MeshRecipe;
struct ParticleRecipe;
struct Spline;
}  // namespace fw

namespace fw::language {

/// A typed value: componentCount(type) ids, or a text, a list or an image known at compile time.
struct Value {
    Type type = Type::scalar;
    std::array<IrId, kSurfaceComponents> ids{};
    std::string text{};
    std::shared_ptr<const std::vector<double>> points{};  ///< of a list, entry by entry
    std::vector<IrId> livePoints{};                       ///< the same where they are live; else empty
    uint32_t image = 0;                                   ///< number among Ir::images()
    std::shared_ptr<const MeshRecipe> mesh{};  ///< of a surface that stands for a mesh: how that is made
    /// Of particles: their stages, whose numbers are ids of the Lowering's ir.
    std::shared_ptr<const ParticleRecipe> particles{};
    std::shared_ptr<const Spline> spline{};  ///< null: of no length

    IrId id() const { return ids[0]; }
};

/// One compilation's state.
struct Lowering {
    Ir ir;
    IrId time = 0;                                  ///< seconds
    std::size_t steps = 0;                          ///< instructions run so far, bounded by kMaxSteps
    std::string graphPath{};                        ///< the file that paths of images are relative to
    double metre = 1;                               ///< how many of the document's units it is
    std::map<std::string, FieldImagePtr> images{};  ///< by path: those that were read
    /// Surfaces through which light passes are nothing: what is made is the opaque part of the whole.
    bool opaquePart = false;
    uint32_t painter = 0;  ///< what is painted from here on is so by this one, Program::painters
    std::vector<std::string>
        remarks{};                  ///< of functions on what they leave away, for the node that is lowered
    std::size_t transmissions = 0;  ///< surfaces that were given a transmission other than 0
};

/// The value of an input that is neither given nor linked.
Value defaultValue(Lowering& state, const InputSpec& input);

/// `value` as `type`, where converts() or standsFor() allow it (surface <-> float: distance, default
/// material; bool and int to float; float to vec2 and vec3: splat; string to image: a path, the file is
/// read). An Error without a place if there is no such conversion, or no such file.
Result<Value> convert(Lowering& state, const Value& value, Type type);

/// Whether code may give a value of one type where another is wanted. As converts() of sockets, but that a
/// boolean is no number; and an int is made of a float by truncating, an image of a string.
bool standsFor(Type from, Type to);

Value constantValue(Lowering& state, Type type, std::span<const double> numbers);
/// What a node that gave transmissions gives, as Lowering::opaquePart has it: nothing where light passes.
void leaveOpaquePart(Lowering& state, Value& surface);
/// The surface of nothing: far away everywhere.
Value emptySurface(Lowering& state);
inline constexpr double kEmptyDistance = 1e9;

}  // namespace fw::language
