// The GLSL statements of single operations, of which glsl.cpp and glsl_families.cpp make functions.
//
// A value of the IR is a variable: v12 its value, i12 its interval, gx12 its derivative along x, s12 what is
// sampled of it; c3 is a column. Constants are literals, live parameters globals, neither is a variable.
//
// Lifetime: made for one text; refers to the Program.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "graph/compile/compile.h"

namespace fw {

/// A float as GLSL reads it, to the bit.
std::string glslLiteral(double value);

/// The axes of planes, rows and samples: what varies along the first alone is computed once a plane, what
/// varies along the first two once a row.
using SampleOrder = std::array<int, 3>;

/// The one by which the least is computed for each sample: rows go along y, unless another axis saves a
/// tenth.
const SampleOrder& sampleOrder(const Program& program);

class GlslStatements {
  public:
    explicit GlslStatements(const Program& program_)
        : program(program_), ir(program_.ir), order(sampleOrder(program_)) {}

    std::string text;

    /// 0: constant along a plane of samples; 1: along a row; 2: varies along a row.
    int stageOf(const IrNode& node) const;
    /// The leaf of the IR that varies in the stage.
    Op leafOf(int stage) const;
    /// FIELD_ALONG of shaders/field.glsl, unless rows go along y.
    std::string along() const;

    /// What the roots need, themselves included. With `grouped`, of a minimum with families its other
    /// operands and what the families take in.
    std::vector<bool> neededBy(std::span<const IrId> roots, bool grouped = false) const;
    /// The ids that a value is made from; `grouped` as above.
    std::vector<IrId> operandsOf(IrId id, bool grouped) const;

    static bool isInline(const IrNode& node) {
        return node.op == Op::constant || node.op == Op::parameter || node.op == Op::column;
    }
    std::string_view typeOf(IrId id) const { return opInfo(ir[id].op).boolean ? "bool" : "float"; }
    std::string value(IrId id) const;
    std::string interval(IrId id) const;

    /// Defines the value. `pattern` is the operation's, or of a position what to take for it.
    void valueStatement(IrId id, std::string_view pattern) { statement(typeOf(id), value(id), id, pattern); }
    void valueStatement(IrId id) { valueStatement(id, opInfo(ir[id].op).glsl); }
    void valueStatements(const std::vector<bool>& needed);
    void intervalStatement(IrId id);

    using Derivatives = std::array<std::vector<std::string>, 3>;
    /// For every id, along x, y and z: a number, a variable's name or an expression of one, empty if it is
    /// zero.
    Derivatives noDerivatives() const;
    /// Defines the value and its derivatives, and puts those into `known`.
    void gradientStatement(IrId id, Derivatives& known);

    /// While set, what varies along a row is one of several variables of the name: v12_3.
    std::string suffix;

  private:
    std::string layerNumber(IrId id) const;
    /// The variable that holds what OpInfo::glslSample gives of the operation.
    static std::string sample(IrId id) { return "s" + std::to_string(id); }
    void statement(std::string_view type, const std::string& name, IrId id, std::string_view pattern);
    std::string derivative(IrId id, int axis, const std::vector<std::string>& known);

    const Program& program;
    const Ir& ir;
    const SampleOrder& order;
};

/// The distance in three stages, for sampling whole rows: what a plane of samples has in common, a row, and
/// the rest. A later stage gets what it reads of an earlier one as the members of a struct.
class GlslStages {
  public:
    /// `define` may define a value in its own way; it says whether it did.
    GlslStages(GlslStatements& statements, const Program& program, bool grouped,
               std::function<bool(IrId)> define = {});

    void planeFunction();  ///< FieldPlane fieldPlane(float at)
    void rowFunction();    ///< FieldRow fieldRow(FieldPlane plane, float at)
    /// Defines what the stages up to this one left in the struct `from`.
    void unpack(int stage, const std::string& from);
    /// Defines the values of the stage, the position along its axis being `at`.
    void define(int stage) const;

    const std::vector<bool>& needed() const { return wanted; }

  private:
    bool kept(IrId id, int stage) const;
    void structure(int stage, const std::string& type);
    void pack(int stage, const std::string& type);

    GlslStatements& to;
    const Ir& ir;
    std::function<bool(IrId)> own;
    std::vector<bool> wanted;
    std::vector<int> lastReader;  // stage that reads a value last
};

}  // namespace fw
