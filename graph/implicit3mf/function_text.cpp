#include "graph/implicit3mf/function_text.h"

#include <algorithm>
#include <cmath>

#include "graph/base/words.h"

namespace fw::threemf {

namespace {

const char* kindOf(Op op) {
    switch (op) {
        case Op::absolute: return "abs";
        case Op::sign: return "sign";
        case Op::floor: return "floor";
        case Op::ceil: return "ceil";
        case Op::exponential: return "exp";
        case Op::sine: return "sin";
        case Op::cosine: return "cos";
        case Op::tangent: return "tan";
        case Op::arcTangent: return "atan";
        case Op::add: return "addition";
        case Op::subtract: return "subtraction";
        case Op::multiply: return "multiplication";
        case Op::divide: return "division";
        case Op::minimum: return "min";
        case Op::maximum: return "max";
        case Op::modulo: return "mod";
        case Op::truncatedModulo: return "fmod";
        case Op::arcTangent2: return "atan2";
        case Op::logicalAnd: return "multiplication";
        case Op::logicalOr: return "max";
        default: return nullptr;
    }
}

const char* refusalOf(Op op) {
    switch (op) {
        case Op::gradientNoise:
        case Op::simplexNoise:
        case Op::worleyNoise:
        case Op::cellWall:
        case Op::cellHash:
            return "is of random numbers, which 3MF's functions cannot make: take it out, or export a mesh";
        case Op::outline:
            return "is of letters, a drawing or points, which 3MF's functions have no node for: export a "
                   "mesh";
        case Op::spline: return "is along a spline, which 3MF's functions have no node for: export a mesh";
        case Op::parameter:
        case Op::column: return "is live: export it at one time";
        default: return nullptr;
    }
}

/// That of the resource, which gets `next` if it has none.
template <class Of>
int numberOf(std::vector<std::pair<const Of*, int>>& known, const Of* of, int& next) {
    for (const auto& [each, number] : known)
        if (each == of) return number;
    return known.emplace_back(of, next++).second;
}

}  // namespace

FunctionText::FunctionText(const Program& program_, FunctionResources& resources_)
    : program(program_), resources(resources_) {
    nodes =
        "<i:decomposevector identifier=\"parts\"><i:in><i:vectorref identifier=\"A\" "
        "ref=\"inputs.pos\"/></i:in>"
        "<i:out><i:scalar identifier=\"x\"/><i:scalar identifier=\"y\"/><i:scalar identifier=\"z\"/></i:out>"
        "</i:decomposevector>\n";
    count = 1;
}

void FunctionText::fail(IrId id, const std::string& what) {
    if (!problem.empty()) return;
    problem = what;
    troubled = program.origins[program.ir.origin(id)];
}

std::string FunctionText::value(IrId root) {
    // In the order of ids, so that each stands behind its operands, however deep they go.
    std::vector<IrId> wanted{root};
    std::vector<bool> seen(program.ir.size());
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        const IrNode& node = program.ir[wanted[i]];
        if (seen[wanted[i]]) continue;
        seen[wanted[i]] = true;
        for (int k = 0; k < opInfo(node.op).arity; ++k) wanted.push_back(node.operands[std::size_t(k)]);
    }
    std::ranges::sort(wanted);
    for (const IrId id : wanted) {
        if (known.contains(id) || !problem.empty()) continue;
        std::string text = made(id);
        known[id] = std::move(text);
    }
    return problem.empty() ? known[root] : std::string();
}

std::string FunctionText::node(const std::string& kind,
                               const std::vector<std::pair<const char*, std::string>>& inputs,
                               const std::string& attributes) {
    const std::string id = "n" + std::to_string(count++);
    const bool vector = kind == "composevector";
    nodes += "<i:" + kind + " identifier=\"" + id + "\"" + attributes + ">";
    if (!inputs.empty()) {
        nodes += "<i:in>";
        for (const auto& [name, from] : inputs) {
            const std::string_view as = name;
            const char* type = as == "mesh" || as == "functionID" ? "resource"
                               : as == "pos"                      ? "vector"
                                                                  : "scalar";
            nodes.append("<i:").append(type).append("ref identifier=\"").append(name);
            nodes.append("\" ref=\"").append(from).append("\"/>");
        }
        nodes += "</i:in>";
    }
    const char* output = kind == "constant" || kind == "constresourceid" ? "value"
                         : kind == "mesh" || kind == "unsignedmesh"      ? "distance"
                         : kind == "functioncall"                        ? "red"
                                                                         : "result";
    nodes.append("<i:out><i:")
        .append(vector                      ? "vector"
                : kind == "constresourceid" ? "resourceid"
                                            : "scalar");
    nodes.append(" identifier=\"").append(output).append("\"/></i:out></i:").append(kind).append(">\n");
    return id + "." + output;
}

std::string FunctionText::apply(const char* kind, const std::string& a) { return node(kind, {{"A", a}}); }
std::string FunctionText::apply(const char* kind, const std::string& a, const std::string& b) {
    return node(kind, {{"A", a}, {"B", b}});
}
std::string FunctionText::select(const std::string& a, const std::string& b, const std::string& less,
                                 const std::string& other) {
    return node("select", {{"A", a}, {"B", b}, {"C", less}, {"D", other}});
}

std::string FunctionText::number(double value) {
    std::string& text = numbers[value];
    if (text.empty()) text = node("constant", {}, " value=\"" + exactNumber(value) + "\"");
    return text;
}

std::string FunctionText::resource(int id) {
    std::string& text = ids[id];
    if (text.empty()) text = node("constresourceid", {}, " value=\"" + std::to_string(id) + "\"");
    return text;
}

std::string FunctionText::place(const std::string& x, const std::string& y, const std::string& z) {
    return node("composevector", {{"x", x}, {"y", y}, {"z", z}});
}

/// Whether a value cannot be below 0, as far as its operation tells.
bool FunctionText::neverNegative(IrId id) const {
    const IrNode& node = program.ir[id];
    const auto operand = [&](std::size_t k) { return neverNegative(node.operands[k]); };
    switch (node.op) {
        case Op::constant: return node.number >= 0.0;
        case Op::square:
        case Op::absolute:
        case Op::squareRoot:
        case Op::exponential: return true;
        case Op::add: return operand(0) && operand(1);
        case Op::maximum: return program.ir.isConstant(node.operands[0]) && operand(0);
        default: return false;
    }
}

std::string FunctionText::sampled(const IrNode& node, IrId id) {
    const SampledLayer layer = program.ir.layer(node);
    if (layer.volume) {
        const FieldVolume& volume = *layer.volume->volume;
        if (!volume.mesh || layer.volume->channel > trilinearChannel) {
            fail(id, volume.mesh
                         ? "is of a mesh's colours, which 3MF's functions cannot have: give it one colour"
                         : "is of particles or was measured on a grid, which 3MF's functions cannot hold: "
                           "export a mesh");
            return {};
        }
        const int object = numberOf(resources.meshes, &volume, resources.next);
        bool inside = false;  // one without is the distance to a sheet
        for (std::size_t i = 0; i < volume.grid.samples() && !inside; ++i) inside = volume.words[2 * i] >> 31;
        const std::string at =
            place(known[node.operands[0]], known[node.operands[1]], known[node.operands[2]]);
        return this->node(inside ? "mesh" : "unsignedmesh", {{"pos", at}, {"mesh", resource(object)}});
    }
    if (layer.image->channel != kGreyLayer) {
        fail(id,
             "is of a picture's colours, which 3MF's functions have otherwise: take its grey, or export a "
             "mesh");
        return {};
    }
    const int function = numberOf(resources.pictures, layer.image->image, resources.next);
    const std::string at = place(known[node.operands[0]], known[node.operands[1]], number(0.5));
    return this->node("functioncall", {{"functionID", resource(function)}, {"pos", at}});
}

std::string FunctionText::made(IrId id) {
    const IrNode& node = program.ir[id];
    if (const char* refusal = refusalOf(node.op)) return fail(id, refusal), std::string();
    const auto operand = [&](std::size_t k) -> const std::string& { return known[node.operands[k]]; };
    const auto above = [&](double least, std::size_t k) { return apply("max", operand(k), number(least)); };
    if (const char* kind = kindOf(node.op))
        return opInfo(node.op).arity == 1 ? apply(kind, operand(0)) : apply(kind, operand(0), operand(1));
    switch (node.op) {
        case Op::constant: return number(node.number);
        case Op::positionX: return "parts.x";
        case Op::positionY: return "parts.z";
        case Op::positionZ: return apply("subtraction", number(0.0), "parts.y");
        case Op::negate: return apply("subtraction", number(0.0), operand(0));
        case Op::round: return apply("floor", apply("addition", operand(0), number(0.5)));
        case Op::truncate:
            return apply("multiplication", apply("sign", operand(0)),
                         apply("floor", apply("abs", operand(0))));
        case Op::squareRoot:
            return apply("sqrt", neverNegative(node.operands[0]) ? operand(0) : above(0.0, 0));
        case Op::square: return apply("multiplication", operand(0), operand(0));
        case Op::logarithm: return apply("log", above(1e-30, 0));
        case Op::arcSine: return apply("asin", apply("min", above(-1.0, 0), number(1.0)));
        case Op::arcCosine: return apply("acos", apply("min", above(-1.0, 0), number(1.0)));
        case Op::power: return apply("pow", above(0.0, 0), operand(1));
        case Op::logicalNot: return apply("subtraction", number(1.0), operand(0));
        case Op::less: return select(operand(0), operand(1), number(1.0), number(0.0));
        case Op::lessEqual: return select(operand(1), operand(0), number(0.0), number(1.0));
        case Op::equal:
            return select(operand(0), operand(1), number(0.0),
                          select(operand(1), operand(0), number(0.0), number(1.0)));
        case Op::select: {
            const IrNode& condition = program.ir[node.operands[0]];
            const std::string yes = operand(1), no = operand(2);
            if (condition.op == Op::less)
                return select(known[condition.operands[0]], known[condition.operands[1]], yes, no);
            if (condition.op == Op::lessEqual)
                return select(known[condition.operands[1]], known[condition.operands[0]], no, yes);
            return select(number(0.5), operand(0), yes, no);
        }
        case Op::smoothMinimum: {  // min(a, b) - h h / 4 max(k, 1e-9), h = max(k - |a - b|, 0)
            const std::string apart = apply("abs", apply("subtraction", operand(0), operand(1)));
            const std::string h = apply("max", apply("subtraction", operand(2), apart), number(0.0));
            const std::string depth = apply("division", number(0.25), above(1e-9, 2));
            return apply("subtraction", apply("min", operand(0), operand(1)),
                         apply("multiplication", apply("multiplication", h, h), depth));
        }
        case Op::image:
        case Op::volume: return sampled(node, id);
        default: return fail(id, "is of what 3MF's functions have no node for: export a mesh"), std::string();
    }
}

}  // namespace fw::threemf
