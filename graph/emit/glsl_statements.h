// The GLSL statements of single operations, of which glsl.cpp and glsl_families.cpp make functions.
//
// A value of the IR is a variable: v12 its value, i12 its interval, gx12 its derivative along x; c3 is a
// column. Constants are literals, live parameters globals, neither is a variable.
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

/// 0: constant along x and y; 1: along y; 2: varies with y.
int stageOf(const IrNode& node);

class GlslStatements {
  public:
    explicit GlslStatements(const Program& program_) : program(program_), ir(program_.ir) {}

    std::string text;

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
    void valueStatement(IrId id, std::string_view pattern);
    void valueStatement(IrId id) { valueStatement(id, opInfo(ir[id].op).glsl); }
    void valueStatements(const std::vector<bool>& needed);
    void intervalStatement(IrId id);

    using Derivatives = std::array<std::vector<std::string>, 3>;
    /// For every id, along x, y and z: a number, a variable's name or an expression of one, empty if it is
    /// zero.
    Derivatives noDerivatives() const;
    /// Defines the value and its derivatives, and puts those into `known`.
    void gradientStatement(IrId id, Derivatives& known);

    /// While set, what varies with y is one of several variables of the name: v12_3.
    std::string suffix;

  private:
    std::string layerNumber(IrId id) const;
    std::string derivative(IrId id, int axis, const std::vector<std::string>& known);

    const Program& program;
    const Ir& ir;
};

/// The distance in three stages, for sampling whole rows: what depends on z alone, on x and z, and the rest.
/// A later stage gets what it reads of an earlier one as the members of a struct.
class GlslStages {
  public:
    /// `define` may define a value in its own way; it says whether it did.
    GlslStages(GlslStatements& statements, const Program& program, bool grouped,
               std::function<bool(IrId)> define = {});

    void planeFunction();  ///< FieldPlane fieldPlane(float z)
    void rowFunction();    ///< FieldRow fieldRow(FieldPlane plane, float x)
    /// Defines what the stages up to this one left in the struct `from`.
    void unpack(int stage, const std::string& from);
    /// Defines the values of the stage, the position along its axis being `axis`.
    void define(int stage, const std::string& axis) const;

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
