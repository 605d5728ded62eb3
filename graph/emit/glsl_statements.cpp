#include "graph/emit/glsl_statements.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace fw {

namespace {

/// The template with %a … replaced by what `operand(letter)` gives.
void fill(std::string& out, std::string_view pattern, const std::function<std::string(char)>& operand) {
    for (std::size_t i = 0; i < pattern.size(); ++i) {
        if (pattern[i] == '%' && i + 1 < pattern.size())
            out += operand(pattern[++i]);
        else
            out += pattern[i];
    }
}

}  // namespace

std::string glslLiteral(double value) {
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

namespace {

/// Along y, x and z: the orders that the sampling of bricks knows.
constexpr std::array<SampleOrder, 3> kOrders = {{{2, 0, 1}, {2, 1, 0}, {0, 1, 2}}};
constexpr double kSampleWeight = 8;  ///< of what is done with a sample's sign, in additions

int stageIn(const SampleOrder& order, std::size_t positions) {
    return positions >> order[2] & 1 ? 2 : positions >> order[1] & 1 ? 1 : 0;
}

}  // namespace

const SampleOrder& sampleOrder(const Program& program) {
    const Ir& ir = program.ir;
    std::vector<bool> needed(ir.size(), false);
    needed[program.distance()] = true;
    std::array<double, 8> weight{};  // by PositionMask
    for (IrId id = static_cast<IrId>(ir.size()); id-- > 0;) {
        if (!needed[id]) continue;
        weight[ir[id].positions] += opInfo(ir[id].op).weight;
        for (int i = 0; i < opInfo(ir[id].op).arity; ++i) needed[ir[id].operands[i]] = true;
    }
    const auto cost = [&](const SampleOrder& order) {  // of a brick
        double sum = 729 * kSampleWeight;
        for (std::size_t positions = 0; positions < weight.size(); ++positions)
            sum += weight[positions] * std::array{9, 81, 729}[std::size_t(stageIn(order, positions))];
        return sum;
    };
    const SampleOrder& best = *std::ranges::min_element(kOrders, {}, cost);
    return cost(best) < 0.9 * cost(kOrders[0]) ? best : kOrders[0];
}

int GlslStatements::stageOf(const IrNode& node) const { return stageIn(order, node.positions); }

Op GlslStatements::leafOf(int stage) const {
    return static_cast<Op>(static_cast<int>(Op::positionX) + order[std::size_t(stage)]);
}

std::string GlslStatements::along() const {
    return order == kOrders[0] ? "" : "#define FIELD_ALONG " + std::to_string(order[2]) + "\n";
}

std::vector<IrId> GlslStatements::operandsOf(IrId id, bool grouped) const {
    const auto group = program.families.groups.find(id);
    if (!grouped || group == program.families.groups.end())
        return {ir[id].operands.begin(), ir[id].operands.begin() + opInfo(ir[id].op).arity};
    std::vector<IrId> all = group->second.others;
    for (uint32_t family : group->second.families) {
        const std::vector<IrId>& inputs = program.families.all[family].inputs;
        all.insert(all.end(), inputs.begin(), inputs.end());
    }
    return all;
}

std::vector<bool> GlslStatements::neededBy(std::span<const IrId> roots, bool grouped) const {
    std::vector<bool> needed(ir.size(), false);
    for (IrId root : roots) needed[root] = true;
    for (IrId id = static_cast<IrId>(ir.size()); id-- > 0;)
        if (needed[id])
            for (IrId operand : operandsOf(id, grouped)) needed[operand] = true;
    return needed;
}

std::string GlslStatements::value(IrId id) const {
    if (ir.isConstant(id)) return glslLiteral(ir.number(id));
    if (ir[id].op == Op::parameter) return "fieldP" + std::to_string(static_cast<int>(ir.number(id)));
    if (ir[id].op == Op::column) return "c" + std::to_string(static_cast<int>(ir.number(id)));
    const std::string name = "v" + std::to_string(id);
    return stageOf(ir[id]) == 2 ? name + suffix : name;
}

std::string GlslStatements::interval(IrId id) const {
    return isInline(ir[id]) ? "vec2(" + value(id) + ")" : "i" + std::to_string(id);
}

std::string GlslStatements::layerNumber(IrId id) const {
    return std::to_string(static_cast<int>(ir.number(id)));
}

void GlslStatements::statement(std::string_view type, const std::string& name, IrId id,
                               std::string_view pattern) {
    text += "    ";
    text += type;
    text += " " + name + " = ";
    fill(text, pattern, [&](char letter) {
        return letter == 'i'   ? layerNumber(id)
               : letter == 's' ? sample(id)
                               : value(ir[id].operands[letter - 'a']);
    });
    text += ";\n";
}

void GlslStatements::valueStatements(const std::vector<bool>& needed) {
    for (IrId id = 0; id < ir.size(); ++id)
        if (needed[id] && !isInline(ir[id])) valueStatement(id);
}

void GlslStatements::intervalStatement(IrId id) {
    text += "    vec2 " + interval(id) + " = ";
    fill(text, opInfo(ir[id].op).glslInterval, [&](char letter) {
        return letter == 'i' ? layerNumber(id) : interval(ir[id].operands[letter - 'a']);
    });
    text += ";\n";
}

GlslStatements::Derivatives GlslStatements::noDerivatives() const {
    Derivatives known;
    known.fill(std::vector<std::string>(ir.size()));
    return known;
}

void GlslStatements::gradientStatement(IrId id, Derivatives& known) {
    const std::string_view pattern = opInfo(ir[id].op).glslSample;
    if (!pattern.empty()) statement("vec4", sample(id), id, pattern);
    valueStatement(id, pattern.empty() ? opInfo(ir[id].op).glsl : "%s.w");
    for (int axis = 0; axis < 3; ++axis) known[axis][id] = derivative(id, axis, known[axis]);
}

std::string GlslStatements::derivative(IrId id, int axis, const std::vector<std::string>& known) {
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
        expression = value(ir[id].operands[1 - varying]) + " * " + of(varying);
    } else {
        fill(expression, pattern, [&](char letter) -> std::string {
            if (letter == 'v') return value(id);
            if (letter == 's') return sample(id);
            if (letter == 'i') return layerNumber(id);
            if (letter >= 'a') return value(ir[id].operands[letter - 'a']);
            return of(letter - 'A').empty() ? "0.0" : of(letter - 'A');
        });
    }
    const std::string result = std::string("g") + "xyz"[axis] + std::to_string(id);
    text += "    float " + result + " = " + expression + ";\n";
    return result;
}

GlslStages::GlslStages(GlslStatements& statements, const Program& program, bool grouped,
                       std::function<bool(IrId)> define)
    : to(statements), ir(program.ir), own(std::move(define)) {
    const IrId root = program.distance();
    wanted = to.neededBy(std::span(&root, 1), grouped);
    lastReader.assign(ir.size(), -1);
    lastReader[root] = 2;
    for (IrId id = 0; id < ir.size(); ++id)
        if (wanted[id])
            for (IrId operand : to.operandsOf(id, grouped))
                lastReader[operand] = std::max(lastReader[operand], to.stageOf(ir[id]));
}

bool GlslStages::kept(IrId id, int stage) const {
    return wanted[id] && !to.isInline(ir[id]) && to.stageOf(ir[id]) <= stage && lastReader[id] > stage;
}

void GlslStages::unpack(int stage, const std::string& from) {
    for (IrId id = 0; id < ir.size(); ++id) {
        if (!kept(id, stage)) continue;
        const std::string name = to.value(id);
        to.text += "    ";
        to.text += to.typeOf(id);
        to.text += " " + name + " = " + from + "." + name + ";\n";
    }
}

void GlslStages::define(int stage) const {
    for (IrId id = 0; id < ir.size(); ++id) {
        if (!wanted[id] || to.isInline(ir[id]) || to.stageOf(ir[id]) != stage) continue;
        if (own && own(id)) continue;
        to.valueStatement(id, ir[id].op == to.leafOf(stage) ? "at" : opInfo(ir[id].op).glsl);
    }
}

void GlslStages::structure(int stage, const std::string& type) {
    to.text += "struct " + type + " { float unused;";
    for (IrId id = 0; id < ir.size(); ++id)
        if (kept(id, stage)) to.text += " " + std::string(to.typeOf(id)) + " " + to.value(id) + ";";
    to.text += " };\n";
}

void GlslStages::pack(int stage, const std::string& type) {
    to.text += "    return " + type + "(0.0";
    for (IrId id = 0; id < ir.size(); ++id)
        if (kept(id, stage)) to.text += ", " + to.value(id);
    to.text += ");\n}\n";
}

void GlslStages::planeFunction() {
    structure(0, "FieldPlane");
    to.text += "FieldPlane fieldPlane(float at) {\n";
    define(0);
    pack(0, "FieldPlane");
}

void GlslStages::rowFunction() {
    structure(1, "FieldRow");
    to.text += "FieldRow fieldRow(FieldPlane plane, float at) {\n";
    unpack(0, "plane");
    define(1);
    pack(1, "FieldRow");
}

}  // namespace fw
