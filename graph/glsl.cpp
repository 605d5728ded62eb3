#include "graph/glsl.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <functional>
#include <string_view>

namespace fw {

namespace {

std::string name(char prefix, IrId id) { return prefix + std::to_string(id); }

std::string literal(double value) {
    const auto narrow = static_cast<float>(value);
    if (!std::isfinite(narrow)) {
        if (std::isnan(narrow)) return "uintBitsToFloat(0x7fc00000u)";
        return narrow > 0 ? "uintBitsToFloat(0x7f800000u)" : "uintBitsToFloat(0xff800000u)";
    }
    char digits[32];
    const auto end = std::to_chars(digits, digits + sizeof digits, narrow).ptr;
    std::string text(digits, end);
    if (text.find_first_of(".e") == std::string::npos) text += ".0";
    return narrow < 0.0f ? "(" + text + ")" : text;
}

/// The template with %a … replaced by what `operand(letter)` gives.
void fill(std::string& out, std::string_view pattern, const std::function<std::string(char)>& operand) {
    for (std::size_t i = 0; i < pattern.size(); ++i) {
        if (pattern[i] == '%' && i + 1 < pattern.size())
            out += operand(pattern[++i]);
        else
            out += pattern[i];
    }
}

class Emitter {
  public:
    explicit Emitter(const Program& program_) : program(program_), ir(program_.ir) {}

    std::string run() {
        for (IrId id = 0; id < ir.size(); ++id) {
            const Op op = ir[id].op;
            usesNoise |= op == Op::gradientNoise || op == Op::simplexNoise || op == Op::worleyNoise ||
                         op == Op::cellHash;
        }
        parameters();
        images();
        if (usesNoise) text += "#include \"lib/noise.glsl\"\n";
        text +=
            "float fieldPower(float a, float b) { return a > 0.0 ? pow(a, b) : b > 0.0 ? 0.0 : b < 0.0 ? "
            "1e30 : 1.0; }\n"
            "float fieldArcTangent2(float y, float x) { return y == 0.0 && x == 0.0 ? 0.0 : atan(y, x); }\n";
        value();
        gradient();
        interval();
        rows();
        material();
        return std::move(text);
    }

  private:
    void parameters() {
        text += "struct FieldMaterial { vec3 baseColor; float roughness; float metallic; vec3 emission; };\n";
        if (!program.live.empty())
            text += "layout(set = 0, binding = " + std::to_string(kFieldParametersBinding) +
                    ", std430) readonly buffer FieldParameters { float fieldParameters[]; };\n";
        for (std::size_t slot = 0; slot < program.live.size(); ++slot)
            text += "float fieldP" + std::to_string(slot) + ";\n";
        text += "void fieldBegin() {\n";
        for (std::size_t slot = 0; slot < program.live.size(); ++slot)
            text +=
                "    fieldP" + std::to_string(slot) + " = fieldParameters[" + std::to_string(slot) + "];\n";
        text += "}\n";
    }

    /// Two functions for each layer that is sampled, its place, size and bounds folded in.
    void images() {
        if (ir.images().empty()) return;
        // A shader that samples none must not declare the buffer, so that nothing need be bound there.
        const IrId distance = program.distance();
        const std::vector<bool> needed = neededBy(std::span(&distance, 1));
        bool paintOnly = true;
        for (IrId id = 0; id < ir.size(); ++id) paintOnly &= !(needed[id] && ir[id].op == Op::image);
        if (paintOnly) text += "#ifdef FIELD_MATERIAL\n";
        text += "layout(set = 0, binding = " + std::to_string(kFieldImagesBinding) +
                ", std430) readonly buffer FieldImages { uint fieldImages[]; };\n"
                "#include \"lib/image.glsl\"\n";
        std::vector<bool> sampled(ir.images().size() * kImageLayers, false);
        for (IrId id = 0; id < ir.size(); ++id)
            if (ir[id].op == Op::image) sampled[static_cast<std::size_t>(ir[id].number)] = true;
        std::size_t first = 0;
        for (std::size_t number = 0; number < sampled.size(); ++number) {
            const FieldImage& image = *ir.images()[number / kImageLayers];
            const ImageLayer& layer = image.layers[number % kImageLayers];
            if (sampled[number]) {
                const std::string where = std::to_string(first) + "u, ivec2(" + std::to_string(image.width) +
                                          ", " + std::to_string(image.height) + "), ";
                const std::string channel = std::to_string(layer.channel);
                const auto pair = [](double a, double b) {
                    return "vec2(" + literal(a) + ", " + literal(b) + ")";
                };
                text += "vec3 fieldImage" + std::to_string(number) + "(vec2 uv) { return imageSample(" +
                        where + "uv, " + channel + "); }\n" + "vec2 fieldImageRange" +
                        std::to_string(number) + "(vec2 u, vec2 v) { return imageRange(" + where + "u, v, " +
                        channel + ", " + pair(layer.slopeU, layer.slopeV) + ", " +
                        pair(layer.least, layer.most) + "); }\n";
            }
            if (layer.channel + 1 == kImageLayers) first += image.texels.size();
        }
        if (paintOnly) text += "#endif\n";
    }

    std::vector<bool> neededBy(std::span<const IrId> roots) const {
        std::vector<bool> needed(ir.size(), false);
        for (IrId root : roots) needed[root] = true;
        for (IrId id = static_cast<IrId>(ir.size()); id-- > 0;)
            if (needed[id])
                for (int i = 0; i < opInfo(ir[id].op).arity; ++i) needed[ir[id].operands[i]] = true;
        return needed;
    }

    /// The value of an operand in scalar code: its variable, or the literal.
    std::string scalarOperand(IrId id) const {
        if (ir.isConstant(id)) return literal(ir.number(id));
        if (ir[id].op == Op::parameter) return "fieldP" + std::to_string(static_cast<int>(ir.number(id)));
        return name('v', id);
    }
    std::string intervalOperand(IrId id) const {
        if (ir.isConstant(id)) return "vec2(" + literal(ir.number(id)) + ")";
        if (ir[id].op == Op::parameter) return "vec2(" + scalarOperand(id) + ")";
        return name('i', id);
    }
    std::string layerNumber(IrId id) const { return std::to_string(static_cast<int>(ir.number(id))); }
    static bool isInline(const IrNode& node) { return node.op == Op::constant || node.op == Op::parameter; }
    std::string_view typeOf(IrId id) const { return opInfo(ir[id].op).boolean ? "bool" : "float"; }

    void scalarStatement(IrId id, std::string_view pattern) {
        text += "    ";
        text += typeOf(id);
        text += " " + name('v', id) + " = ";
        fill(text, pattern, [&](char letter) {
            return letter == 'i' ? layerNumber(id) : scalarOperand(ir[id].operands[letter - 'a']);
        });
        text += ";\n";
    }

    void scalarStatements(const std::vector<bool>& needed) {
        for (IrId id = 0; id < ir.size(); ++id)
            if (needed[id] && !isInline(ir[id])) scalarStatement(id, opInfo(ir[id].op).glsl);
    }

    void value() {
        const IrId root = program.distance();
        text += "#ifdef FIELD_VALUE\nfloat fieldValue(vec3 p) {\n";
        scalarStatements(neededBy(std::span(&root, 1)));
        text += "    return " + scalarOperand(root) + ";\n}\n#endif\n";
    }

    /// The derivative of a value along an axis: a number, a variable's name or an expression of one, empty if
    /// it is zero. Emits the statement that defines it, if it takes one.
    std::string derivative(IrId id, int axis, const std::vector<std::string>& known) {
        const IrNode& node = ir[id];
        const std::string_view pattern = opInfo(node.op).glslGradient;
        if (!(node.positions >> axis & 1) || pattern.empty()) return {};
        if (opInfo(node.op).arity == 0) return std::string(pattern);
        const auto of = [&](int i) -> const std::string& { return known[node.operands[i]]; };
        bool varies = false;
        for (int i = 0; i < opInfo(node.op).arity; ++i) varies |= !of(i).empty();
        if (!varies) return {};
        // Sums and multiples of constants, the bulk of a field, need no statement or a shorter one.
        std::string expression;
        if (node.op == Op::add && (of(0).empty() || of(1).empty())) return of(0) + of(1);
        if (node.op == Op::subtract && of(1).empty()) return of(0);
        if (node.op == Op::subtract && of(0).empty()) {
            expression = "-" + of(1);
        } else if (node.op == Op::multiply && (of(0).empty() || of(1).empty())) {
            const int varying = of(0).empty() ? 1 : 0;
            expression = scalarOperand(node.operands[1 - varying]) + " * " + of(varying);
        } else {
            fill(expression, pattern, [&](char letter) -> std::string {
                if (letter == 'v') return name('v', id);
                if (letter == 'i') return layerNumber(id);
                if (letter >= 'a') return scalarOperand(node.operands[letter - 'a']);
                return of(letter - 'A').empty() ? "0.0" : of(letter - 'A');
            });
        }
        const std::string result = std::string("g") + "xyz"[axis] + std::to_string(id);
        text += "    float " + result + " = " + expression + ";\n";
        return result;
    }

    void gradient() {
        const IrId root = program.distance();
        const std::vector<bool> needed = neededBy(std::span(&root, 1));
        std::array<std::vector<std::string>, 3> derivatives;
        derivatives.fill(std::vector<std::string>(ir.size()));
        text += "#ifdef FIELD_GRADIENT\nvec4 fieldGradient(vec3 p) {\n";
        for (IrId id = 0; id < ir.size(); ++id) {
            if (!needed[id] || isInline(ir[id])) continue;
            scalarStatement(id, opInfo(ir[id].op).glsl);
            for (int axis = 0; axis < 3; ++axis)
                derivatives[axis][id] = derivative(id, axis, derivatives[axis]);
        }
        text += "    return vec4(";
        for (int axis = 0; axis < 3; ++axis) {
            const std::string& slope = derivatives[axis][root];
            text += (slope.empty() ? "0.0" : slope) + ", ";
        }
        text += scalarOperand(root) + ");\n}\n#endif\n";
    }

    void interval() {
        const IrId root = program.distance();
        const std::vector<bool> needed = neededBy(std::span(&root, 1));
        text +=
            "#ifdef FIELD_INTERVAL\n#include \"lib/interval.glsl\"\nvec2 fieldInterval(vec3 lo, vec3 hi) {\n";
        for (IrId id = 0; id < ir.size(); ++id) {
            if (!needed[id] || isInline(ir[id])) continue;
            text += "    vec2 " + name('i', id) + " = ";
            fill(text, opInfo(ir[id].op).glslInterval, [&](char letter) {
                return letter == 'i' ? layerNumber(id) : intervalOperand(ir[id].operands[letter - 'a']);
            });
            text += ";\n";
        }
        text += "    vec3 reach = max(abs(lo), abs(hi));\n    return iMargin(" + intervalOperand(root) +
                ", reach.x + reach.y + reach.z);\n}\n#endif\n";
    }

    /// 0: constant along x and y; 1: along y; 2: varies with y.
    int stageOf(IrId id) const {
        const uint8_t positions = ir[id].positions;
        return positions & dependsOnY ? 2 : positions & dependsOnX ? 1 : 0;
    }

    void rows() {
        const IrId root = program.distance();
        const std::vector<bool> needed = neededBy(std::span(&root, 1));
        // Values a later stage reads are members of the struct that the earlier stage returns.
        std::vector<int> lastReader(ir.size(), -1);
        lastReader[root] = 2;
        for (IrId id = 0; id < ir.size(); ++id)
            if (needed[id])
                for (int i = 0; i < opInfo(ir[id].op).arity; ++i) {
                    int& reader = lastReader[ir[id].operands[i]];
                    reader = std::max(reader, stageOf(id));
                }
        const auto kept = [&](IrId id, int stage) {
            return needed[id] && !isInline(ir[id]) && stageOf(id) <= stage && lastReader[id] > stage;
        };
        const auto members = [&](int stage, const std::function<void(IrId)>& visit) {
            for (IrId id = 0; id < ir.size(); ++id)
                if (kept(id, stage)) visit(id);
        };
        const auto statements = [&](int stage, const char* axis) {
            for (IrId id = 0; id < ir.size(); ++id) {
                if (!needed[id] || isInline(ir[id]) || stageOf(id) != stage) continue;
                const bool leaf = ir[id].op >= Op::positionX && ir[id].op <= Op::positionZ;
                scalarStatement(id, leaf ? axis : opInfo(ir[id].op).glsl);
            }
        };
        const auto unpack = [&](int stage, const char* from) {
            members(stage, [&](IrId id) {
                text += "    ";
                text += typeOf(id);
                text += " " + name('v', id) + " = " + from + "." + name('v', id) + ";\n";
            });
        };
        const auto structure = [&](int stage, const char* type) {
            text += std::string("struct ") + type + " { float unused;";
            members(stage,
                    [&](IrId id) { text += " " + std::string(typeOf(id)) + " " + name('v', id) + ";"; });
            text += " };\n";
        };
        const auto pack = [&](int stage, const char* type) {
            text += std::string("    return ") + type + "(0.0";
            members(stage, [&](IrId id) { text += ", " + name('v', id); });
            text += ");\n}\n";
        };
        text += "#ifdef FIELD_ROWS\n";
        structure(0, "FieldPlane");
        structure(1, "FieldRow");
        text += "FieldPlane fieldPlane(float z) {\n";
        statements(0, "z");
        pack(0, "FieldPlane");
        text += "FieldRow fieldRow(FieldPlane plane, float x) {\n";
        unpack(0, "plane");
        statements(1, "x");
        pack(1, "FieldRow");
        text += "float fieldAt(FieldRow row, float y) {\n";
        unpack(1, "row");
        statements(2, "y");
        text += "    return " + scalarOperand(root) + ";\n}\n#endif\n";
    }

    void material() {
        const std::span<const IrId> roots(program.surface.data() + 1, 8);
        text += "#ifdef FIELD_MATERIAL\nFieldMaterial fieldMaterial(vec3 p) {\n";
        scalarStatements(neededBy(roots));
        text += "    return FieldMaterial(vec3(" + scalarOperand(roots[0]) + ", " + scalarOperand(roots[1]) +
                ", " + scalarOperand(roots[2]) + "), " + scalarOperand(roots[3]) + ", " +
                scalarOperand(roots[4]) + ", vec3(" + scalarOperand(roots[5]) + ", " +
                scalarOperand(roots[6]) + ", " + scalarOperand(roots[7]) + "));\n}\n#endif\n";
    }

    const Program& program;
    const Ir& ir;
    std::string text;
    bool usesNoise = false;
};

}  // namespace

std::string emitField(const Program& program) { return Emitter(program).run(); }

}  // namespace fw
