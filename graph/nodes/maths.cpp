// Arithmetic on fields, and the expression node.
//
// Every operation gives a finite number for finite operands: dividing by 0 gives 0, roots and logarithms of
// what has none are those of the nearest number that has one.
#include "graph/compile/graph_lowering.h"
#include "graph/nodes/inputs.h"

namespace fw {

namespace {

/// One operation of math or vector_math: its name and what it returns.
struct Operation {
    const char* name;
    const char* code;
};

constexpr Operation kScalarOperations[] = {
    {"add", "a + b"},
    {"subtract", "a - b"},
    {"multiply", "a * b"},
    {"divide", "b == 0.0 ? 0.0 : a / b"},
    {"multiply_add", "a * b + c"},
    {"negate", "-a"},
    {"abs", "abs(a)"},
    {"sign", "sign(a)"},
    {"min", "min(a, b)"},
    {"max", "max(a, b)"},
    {"power", "b < 0.0 ? pow(a == 0.0 ? 0.0 : 1.0 / a, -b) : pow(a, b)"},
    {"sqrt", "sqrt(max(a, 0.0))"},
    {"inverse_sqrt", "a > 0.0 ? 1.0 / sqrt(a) : 0.0"},
    {"exp", "exp(min(a, 80.0))"},
    {"log", "log(max(a, 1e-30))"},
    {"modulo", "b == 0.0 ? 0.0 : mod(a, b)"},
    {"fmod", "b == 0.0 ? 0.0 : fmod(a, b)"},
    {"fract", "fract(a)"},
    {"floor", "floor(a)"},
    {"ceil", "ceil(a)"},
    {"round", "round(a)"},
    {"trunc", "trunc(a)"},
    {"snap", "b == 0.0 ? a : floor(a / b) * b"},
    {"wrap", "c == b ? b : mod(a - b, c - b) + b"},
    {"ping_pong", "b == 0.0 ? 0.0 : abs(mod(a - b, 2.0 * b) - b)"},
    {"sin", "sin(a)"},
    {"cos", "cos(a)"},
    {"tan", "tan(a)"},
    {"asin", "asin(clamp(a, -1.0, 1.0))"},
    {"acos", "acos(clamp(a, -1.0, 1.0))"},
    {"atan", "atan(a)"},
    {"atan2", "atan2(a, a == 0.0 && b == 0.0 ? 1.0 : b)"},
    {"sinh", "sinh(clamp(a, -80.0, 80.0))"},
    {"cosh", "cosh(clamp(a, -80.0, 80.0))"},
    {"tanh", "tanh(clamp(a, -20.0, 20.0))"},
    {"radians", "radians(a)"},
    {"degrees", "degrees(a)"},
    {"less", "a < b ? 1.0 : 0.0"},
    {"greater", "a > b ? 1.0 : 0.0"},
    {"equal", "abs(a - b) <= c ? 1.0 : 0.0"},
    {"mix", "mix(a, b, c)"},
    {"clamp", "clamp(a, b, c)"},
    {"step", "a < b ? 0.0 : 1.0"},
    {"smoothstep", "smoothstep(b, c, a)"},
    {"smooth_min", "smooth_min(a, b, c)"},
    {"smooth_max", "smooth_max(a, b, c)"},
};

/// Those with a vector result.
constexpr Operation kVectorOperations[] = {
    {"add", "a + b"},
    {"subtract", "a - b"},
    {"multiply", "a * b"},
    {"divide", "ratio(a, b)"},
    {"scale", "a * scale"},
    {"cross", "cross(a, b)"},
    {"project", "b * (dot(b, b) == 0.0 ? 0.0 : dot(a, b) / dot(b, b))"},
    {"reflect", "reflect(a, normalize(b))"},
    {"normalize", "normalize(a)"},
    {"mix", "mix(a, b, scale)"},
    {"modulo",
     "vec3(b.x == 0.0 ? 0.0 : mod(a.x, b.x), b.y == 0.0 ? 0.0 : mod(a.y, b.y), b.z == 0.0 ? 0.0 : mod(a.z, "
     "b.z))"},
    {"fmod",
     "vec3(b.x == 0.0 ? 0.0 : fmod(a.x, b.x), b.y == 0.0 ? 0.0 : fmod(a.y, b.y), b.z == 0.0 ? 0.0 : "
     "fmod(a.z, b.z))"},
    {"snap",
     "vec3(b.x == 0.0 ? a.x : floor(a.x / b.x) * b.x, b.y == 0.0 ? a.y : floor(a.y / b.y) * b.y,\n"
     "    b.z == 0.0 ? a.z : floor(a.z / b.z) * b.z)"},
    {"fract", "fract(a)"},
    {"floor", "floor(a)"},
    {"ceil", "ceil(a)"},
    {"round", "round(a)"},
    {"abs", "abs(a)"},
    {"sign", "sign(a)"},
    {"min", "min(a, b)"},
    {"max", "max(a, b)"},
    {"sin", "sin(a)"},
    {"cos", "cos(a)"},
    {"tan", "tan(a)"},
};

/// Those with a number as result.
constexpr Operation kMeasures[] = {
    {"dot", "dot(a, b)"},
    {"length", "length(a)"},
    {"distance", "length(a - b)"},
};

std::string scalarBody() {
    std::string body;
    for (const Operation& o : kScalarOperations) {
        body += std::string("if (op == \"") + o.name + "\") return " + o.code + ";\n";
    }
    return body + "return 0.0;";
}

std::string vectorBody() {
    std::string body =
        "vec3 ratio(vec3 a, vec3 b) {\n"
        "    return vec3(b.x == 0.0 ? 0.0 : a.x / b.x, b.y == 0.0 ? 0.0 : a.y / b.y, b.z == 0.0 ? 0.0 : a.z "
        "/ b.z);\n"
        "}\n"
        "vec3 v = vec3(0.0);\n"
        "bool measured = false;\n";
    for (const Operation& o : kVectorOperations) {
        body += std::string("if (op == \"") + o.name + "\") v = " + o.code + ";\n";
    }
    for (const Operation& o : kMeasures) {
        body += std::string("if (op == \"") + o.name + "\") { v = vec3(" + o.code + "); measured = true; }\n";
    }
    return body + "vector = v;\nvalue = measured ? v.x : length(v);";
}

std::vector<std::string> names(std::span<const Operation> operations, std::span<const Operation> more = {}) {
    std::vector<std::string> all;
    for (const Operation& o : operations) all.push_back(o.name);
    for (const Operation& o : more) all.push_back(o.name);
    return all;
}

}  // namespace

std::vector<NodeType> mathsNodes() {
    return {
        {.id = "math",
         .label = "Math",
         .category = Category::maths,
         .doc = "Calculates with numbers.",
         .inputs = {choice("op", names(kScalarOperations), "What to calculate; angles are in radians."),
                    anything(scalar("a", 0, "The first number, which the operation works on.")),
                    anything(scalar("b", 1, "The second number: operand, divisor, step or lower limit.")),
                    anything(scalar(
                        "c", 1, "The third number: addend, share, tolerance, blend width or upper limit."))},
         .outputs = {{"value", Type::scalar}},
         .body = scalarBody()},
        {.id = "vector_math",
         .label = "Vector math",
         .category = Category::maths,
         .doc = "Calculates with vectors: the result as a vector, and its length as a value. Dot, length and "
                "distance give a "
                "number, which stands in all three components of the vector too.",
         .inputs = {choice("op", names(kVectorOperations, kMeasures), "What to calculate."),
                    anything(vector("a", {0, 0, 0}, "The first vector, which the operation works on.")),
                    anything(vector("b", {1, 1, 1},
                                    "The second vector: operand, divisor, step or mirror direction.")),
                    scalar("scale", 1, "Factor of scale, share of mix.")},
         .outputs = {{"vector", Type::vec3}, {"value", Type::scalar}},
         .body = vectorBody()},
        {.id = "combine_xyz",
         .label = "Combine xyz",
         .category = Category::maths,
         .doc = "Makes a vector of three numbers.",
         .inputs = {anything(scalar("x", 0, "First component.")),
                    anything(scalar("y", 0, "Second component.")),
                    anything(scalar("z", 0, "Third component."))},
         .outputs = {{"vector", Type::vec3}},
         .body = "return vec3(x, y, z);"},
        {.id = "separate_xyz",
         .label = "Separate xyz",
         .category = Category::maths,
         .doc = "Takes a vector apart into three numbers.",
         .inputs = {vector("vector", {0, 0, 0}, "The vector to take apart.")},
         .outputs = {{"x", Type::scalar}, {"y", Type::scalar}, {"z", Type::scalar}},
         .body = "x = vector.x;\ny = vector.y;\nz = vector.z;"},
        {.id = "map_range",
         .label = "Map range",
         .category = Category::maths,
         .doc = "Stretches one range of numbers onto another.",
         .inputs = {anything(scalar("value", 0, "The number to map.")),
                    anything(scalar("from_min", 0, "Start of the range that the number is in.")),
                    anything(scalar("from_max", 1, "End of the range that the number is in.")),
                    anything(scalar("to_min", 0, "What the start becomes.")),
                    anything(scalar("to_max", 1, "What the end becomes.")),
                    toggle("clamped", false, "Keeps the result between what the start and the end become.")},
         .outputs = {{"value", Type::scalar}},
         .body = R"(
float span = from_max - from_min;
float t = span == 0.0 ? (value < from_min ? 0.0 : 1.0) : (value - from_min) / span;
if (clamped) t = clamp(t, 0.0, 1.0);
return mix(to_min, to_max, t);)"},
        // Both bodies call the function of the language that is called as the node is.
        {.id = "color_ramp",
         .label = "Colour ramp",
         .category = Category::maths,
         .doc = "A colour from a number, by stops along a line that have a colour each. Below the first stop "
                "and "
                "above the last their colours go on.",
         .inputs =
             {scalar("value", 0.5, "The number, on the line along which the stops lie."),
              stops("stops", {0, 0, 0, 0, 1, 1, 1, 1},
                    "At most 32 stops, in order: a position, which may be any number, and a colour, linear "
                    "sRGB, each. Two in one place are a hard edge."),
              choice("interpolation", {"linear", "smooth", "constant"},
                     "What is between two stops, in linear light: linear is an even change, smooth begins "
                     "and ends it slowly, constant keeps the colour up to the next stop.")},
         .outputs = {{"color", Type::vec3}},
         .body = "return color_ramp(value, stops, interpolation);"},
        {.id = "curve",
         .label = "Curve",
         .category = Category::maths,
         .doc = "A number from a number, by a curve through points.",
         .inputs = {scalar("value", 0.5, "The number, along the curve's x."),
                    {.name = "points",
                     .type = Type::points,
                     .value = numbers({0, 0, 1, 1}),
                     .doc = "At most 32 points, x and y each, in order of x. Two with one x are a jump.",
                     .ordered = true},
                    choice(
                        "interpolation", {"smooth", "linear"},
                        "What is between two points: smooth is a curve that rises only where the points do, "
                        "linear a straight line."),
                    choice(
                        "ends", {"linear", "constant"},
                        "What is beyond the first and the last point: linear goes on as steeply as the curve "
                        "ends, constant stays as high.")},
         .outputs = {{"value", Type::scalar}},
         .body = "return curve(value, points, interpolation, ends);"},
        {.id = "mix",
         .label = "Mix",
         .category = Category::maths,
         .doc = "Fades from one colour or vector to another.",
         .inputs = {anything(vector("a", {0, 0, 0}, "Result at factor 0.")),
                    anything(vector("b", {1, 1, 1}, "Result at factor 1.")),
                    share("factor", 0.5, "How far along the way from a to b.")},
         .outputs = {{"value", Type::vec3}},
         .body = "return mix(a, b, factor);",
         .aliases = {"lerp"}},
        {.id = "expression",
         .label = "Expression",
         .category = Category::maths,
         .doc = "Code in the field language, with inputs that you name yourself.",
         .inputs = {},
         .outputs = {{"result", Type::surface}},
         .lower = lowerExpression,
         .aliases = {"code"},
         .open = true,
         .role = NodeRole::expression},
    };
}

}  // namespace fw
