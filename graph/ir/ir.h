// The intermediate representation: one hash-consed graph of scalar operations in SSA form.
//
// A field is an id of this graph read as a function of the position (x, y, z) and of the live parameters.
// Because equal operations on equal operands get the same id, evaluating a field at another position is a
// substitution of the three position leaves (`substitute`), sharing what does not change; repeated evaluation
// at one position costs nothing. Operands always have smaller ids than their users, so a scan in order of ids
// is a topological one.
//
// `add` folds constants and applies identities that hold for real numbers (x + 0, min(x, x), --x, select of
// equals …); values may thus differ from the written expression by rounding, and where the written one is not
// a number. Lifetime: an Ir grows during one compilation; `compact` leaves a small copy of what the roots
// need.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "graph/ir/ops.h"

namespace fw {

using IrId = uint32_t;

inline constexpr std::size_t kMaxIrOperations = 200'000;
/// Factors up to this one are folded: floats hold them and their inverses.
inline constexpr double kMaxFactor = 1e30;

/// Which of x, y, z a value depends on; 0 for what is constant over space.
enum PositionMask : uint8_t { dependsOnX = 1, dependsOnY = 2, dependsOnZ = 4 };

struct IrNode {
    Op op;
    uint8_t positions = 0;                   ///< PositionMask
    bool varies = false;                     ///< depends on the position or on a live parameter
    std::array<IrId, kMaxArity> operands{};  ///< the first opInfo(op).arity are used
    /// Of a constant; the slot of a parameter; the place of a column; the layer of a sample (Ir::layer).
    double number = 0.0;
};

/// Whether an operation samples what its node's own number names.
constexpr bool samplesLayer(Op op) {
    return op == Op::image || op == Op::volume || op == Op::outline || op == Op::spline;
}

/// Whether a node's own number is part of what it is.
constexpr bool ownsNumber(Op op) {
    return op == Op::constant || op == Op::parameter || op == Op::column || samplesLayer(op);
}

class Ir {
  public:
    Ir();

    IrId constant(double value);
    /// The live parameter in `slot` of the parameter buffer.
    IrId parameter(uint32_t slot);
    IrId position(int axis) const { return static_cast<IrId>(axis); }

    /// The number of the image among images(), which it joins if it is new.
    uint32_t addImage(const FieldImagePtr& image);
    const std::vector<FieldImagePtr>& images() const { return pictures; }
    /// A channel of an image of images() at (u, v); see image.h.
    IrId sample(uint32_t image, int channel, IrId u, IrId v);
    /// The number of the volume among volumes(), which it joins if it is new.
    uint32_t addVolume(const FieldVolumePtr& volume);
    const std::vector<FieldVolumePtr>& volumes() const { return grids; }
    /// Puts in its place the volume of the same particles at some time.
    void replaceVolume(std::size_t number, FieldVolumePtr volume);
    /// A channel of a volume of volumes() at (x, y, z); see volume.h.
    IrId sample(uint32_t volume, VolumeChannel channel, std::array<IrId, 3> place);
    /// The number of the outline among outlines(), which it joins if it is new.
    uint32_t addOutline(const OutlinePtr& outline);
    const std::vector<OutlinePtr>& outlines() const { return polygons; }
    /// The distance to an outline of outlines() at (x, y); see outline.h.
    IrId sample(uint32_t outline, IrId x, IrId y);
    /// The number of the spline's table among splines(), which it joins if it is new.
    uint32_t addSpline(const SplineTablePtr& spline);
    const std::vector<SplineTablePtr>& splines() const { return curves; }
    /// What a spline of splines() tells of a place; see spline_table.h.
    IrId sample(uint32_t spline, SplineChannel channel, std::array<IrId, 3> place);
    /// What a node samples.
    SampledLayer layer(const IrNode& node) const;

    /// Operations that are new from here on are of this origin; at first 0. Returns the one before.
    uint32_t setOrigin(uint32_t of) { return std::exchange(origin_, of); }
    uint32_t origin(IrId id) const { return origins[id]; }
    /// Equal operations of different origins are several from here on, until compact() makes one of them: so
    /// that what alike nodes share is known to be of each.
    void keepOriginsApart() { apart = true; }
    /// Of an operation that compact() made of several: their origins beside origin().
    std::span<const uint32_t> furtherOrigins(IrId id) const {
        const auto found = further.find(id);
        return found == further.end() ? std::span<const uint32_t>() : found->second;
    }

    /// The id of op(operands), folded where possible.
    IrId add(Op op, std::span<const IrId> operands);
    IrId add(Op op, IrId a) { return add(op, std::array{a}); }
    IrId add(Op op, IrId a, IrId b) { return add(op, std::array{a, b}); }
    IrId add(Op op, IrId a, IrId b, IrId c) { return add(op, std::array{a, b, c}); }

    /// The id of the operation with its own number, nothing folded: on operands that are not yet known.
    IrId addAsIs(Op op, double number, std::span<const IrId> operands);

    /// The operation of `id` on other operands, of the same layer where it samples one.
    IrId again(IrId id, std::span<const IrId> operands) {
        return make(nodes[id].op, nodes[id].number, operands);
    }

    const IrNode& operator[](IrId id) const { return nodes[id]; }
    std::size_t size() const { return nodes.size(); }
    bool isConstant(IrId id) const { return nodes[id].op == Op::constant; }
    bool isConstant(IrId id, double value) const { return isConstant(id) && nodes[id].number == value; }
    double number(IrId id) const { return nodes[id].number; }

    /// The value `root` has where the position is (x, y, z): each of those is a field itself. Memoised.
    IrId substitute(IrId root, std::array<IrId, 3> position);

    /// Operations visited by all substitutions so far: their cost.
    std::size_t substituted() const { return visited; }

    /// A copy with only what `roots` need, what they sample included, in a stable order; `roots` are
    /// renumbered. The three position leaves stay ids 0, 1, 2.
    Ir compact(std::span<IrId> roots) const;

    /// Hash of operations, constants, slots, what is sampled and roots: equal for equal code, whatever the
    /// parameters' values.
    uint64_t hash(std::span<const IrId> roots) const;

    /// One line an operation: "%12 = add %3 %7".
    std::string text(std::span<const IrId> roots) const;

  private:
    struct Key {
        Op op;
        std::array<IrId, kMaxArity> operands;
        uint64_t bits;
        uint32_t origin = 0;  ///< where origins are kept apart
        bool operator==(const Key&) const = default;
    };
    struct KeyHash {
        std::size_t operator()(const Key& key) const;
    };

    /// op(operands) with the node's own number.
    IrId make(Op op, double number, std::span<const IrId> operands);
    IrId intern(const IrNode& node);
    /// The identity that makes op(operands) an existing or simpler value, or kNone.
    IrId simplify(Op op, std::span<const IrId> operands);
    /// op(a, b) as an operation on what a and b are made from, their constants folded into one; or kNone. No
    /// interval gets wider: each operand stands once where it stood once or twice.
    IrId collect(Op op, IrId a, IrId b);

    std::vector<IrNode> nodes;
    std::vector<uint32_t> origins;                            ///< of nodes
    uint32_t origin_ = 0;                                     ///< of the next one
    bool apart = false;                                       ///< keepOriginsApart()
    std::unordered_map<IrId, std::vector<uint32_t>> further;  ///< furtherOrigins()
    std::vector<FieldImagePtr> pictures;
    std::vector<FieldVolumePtr> grids;
    std::vector<OutlinePtr> polygons;
    std::vector<SplineTablePtr> curves;
    std::unordered_map<Key, IrId, KeyHash> known;
    std::unordered_map<Key, std::unordered_map<IrId, IrId>, KeyHash> substitutions;
    std::size_t remembered = 0;  ///< entries in `substitutions`
    std::size_t visited = 0;
};

}  // namespace fw
