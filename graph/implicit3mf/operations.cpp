#include "graph/implicit3mf/operations.h"

#include <algorithm>

namespace fw::threemf {

namespace {

constexpr std::array<std::string_view, 4> kOne{"A"}, kTwo{"A", "B"}, kClamp{"A", "min", "max"},
    kFour{"A", "B", "C", "D"};

constexpr Operation kOperations[] = {
    {"addition", "", kTwo, "add", "add", "a + b", ""},
    {"subtraction", "", kTwo, "subtract", "subtract", "a - b", ""},
    {"multiplication", "", kTwo, "multiply", "multiply", "a * b", ""},
    {"division", "", kTwo, "", "", "b == 0.0 ? a * 1e30 : a / b",
     "vec3(b.x == 0.0 ? a.x * 1e30 : a.x / b.x,\n     b.y == 0.0 ? a.y * 1e30 : a.y / b.y,\n"
     "     b.z == 0.0 ? a.z * 1e30 : a.z / b.z)"},
    {"sin", "", kOne, "sin", "sin", "sin(a)", ""},
    {"cos", "", kOne, "cos", "cos", "cos(a)", ""},
    {"tan", "", kOne, "tan", "tan", "tan(a)", ""},
    {"arcsin", "asin", kOne, "asin", "", "asin(a)", ""},
    {"arccos", "acos", kOne, "acos", "", "acos(a)", ""},
    {"arctan", "atan", kOne, "atan", "", "atan(a)", ""},
    {"arctan2", "atan2", kTwo, "atan2", "", "atan2(a, b)", ""},
    {"sinh", "", kOne, "sinh", "", "sinh(a)", ""},
    {"cosh", "", kOne, "cosh", "", "cosh(a)", ""},
    {"tanh", "", kOne, "tanh", "", "tanh(a)", ""},
    {"min", "", kTwo, "min", "min", "min(a, b)", ""},
    {"max", "", kTwo, "max", "max", "max(a, b)", ""},
    {"abs", "", kOne, "abs", "abs", "abs(a)", ""},
    {"fmod", "", kTwo, "fmod", "fmod", "fmod(a, b)", ""},
    {"mod", "", kTwo, "modulo", "modulo", "mod(a, b)", ""},
    {"pow", "", kTwo, "power", "", "pow(a, b)", ""},
    {"sqrt", "", kOne, "sqrt", "", "sqrt(a)", ""},
    {"exp", "", kOne, "exp", "", "exp(a)", ""},
    {"log", "", kOne, "log", "", "log(a)", ""},
    {"log2", "", kOne, "", "", "log2(a)", ""},
    {"log10", "", kOne, "", "", "log(a) / log(10.0)", ""},
    {"clamp", "", kClamp, "clamp", "", "clamp(a, b, c)", ""},
    {"round", "", kOne, "round", "round", "round(a)", ""},
    {"ceil", "", kOne, "ceil", "ceil", "ceil(a)", ""},
    {"floor", "", kOne, "floor", "floor", "floor(a)", ""},
    {"sign", "", kOne, "sign", "sign", "sign(a)", ""},
    {"fract", "", kOne, "fract", "fract", "fract(a)", ""},
    {"select", "", kFour, "", "", "a < b ? c : d",
     "vec3(a.x < b.x ? c.x : d.x, a.y < b.y ? c.y : d.y, a.z < b.z ? c.z : d.z)"},
};

}  // namespace

std::span<const Operation> operations() { return kOperations; }

const Operation* operation(std::string_view kind) {
    const auto found = std::ranges::find_if(kOperations, [&](const Operation& o) {
        return o.kind == kind || (o.other == kind && !kind.empty());
    });
    return found == std::end(kOperations) ? nullptr : &*found;
}

}  // namespace fw::threemf
