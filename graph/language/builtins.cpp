#include "graph/language/builtins.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>

namespace fw::language {

namespace {

using Arguments = std::span<const Value>;
using Builtin = Result<Value> (*)(Lowering&, Arguments);

Error problem(std::string message) { return {.message = std::move(message)}; }

bool isVector(Type type) { return type == Type::vec2 || type == Type::vec3; }
bool isNumeric(Type type) { return componentCount(type) > 0; }
Type vectorOf(int components) {
    return components == 3 ? Type::vec3 : components == 2 ? Type::vec2 : Type::scalar;
}

Value scalar(IrId id, Type type = Type::scalar) {
    Value value{type};
    value.ids[0] = id;
    return value;
}

/// A surface as its distance, a bool or int as a float; vectors stay.
Value asNumber(const Value& value) {
    if (isVector(value.type)) return value;
    return scalar(value.ids[0]);
}

IrId component(const Value& value, int i) { return isVector(value.type) ? value.ids[i] : value.ids[0]; }

/// The common width of arguments that join componentwise; an Error if two vectors differ.
Result<int> commonWidth(Arguments arguments) {
    int width = 1;
    for (const Value& argument : arguments) {
        if (!isNumeric(argument.type))
            return problem("a " + std::string(typeName(argument.type)) + " has no arithmetic");
        if (!isVector(argument.type)) continue;
        const int own = componentCount(argument.type);
        if (width != 1 && width != own) return problem("vec2 and vec3 do not mix: write .xy or vec3(…)");
        width = own;
    }
    return width;
}

/// f applied to each component.
template <class F>
Result<Value> componentwise(Arguments arguments, F f) {
    const Result<int> width = commonWidth(arguments);
    if (!width) return width.error();
    Value result{vectorOf(*width)};
    std::array<IrId, 8> operands{};
    for (int i = 0; i < *width; ++i) {
        for (std::size_t k = 0; k < arguments.size(); ++k) operands[k] = component(arguments[k], i);
        result.ids[i] = f(operands);
    }
    return result;
}

template <Op op>
Result<Value> unary(Lowering& s, Arguments a) {
    return componentwise(a, [&](const auto& x) { return s.ir.add(op, x[0]); });
}
template <Op op>
Result<Value> binary(Lowering& s, Arguments a) {
    return componentwise(a, [&](const auto& x) { return s.ir.add(op, x[0], x[1]); });
}

IrId number(Lowering& s, double value) { return s.ir.constant(value); }
IrId scaled(Lowering& s, IrId a, double factor) { return s.ir.add(Op::multiply, a, number(s, factor)); }
IrId reciprocal(Lowering& s, IrId a) { return s.ir.add(Op::divide, number(s, 1.0), a); }

/// min or max of two or more; surfaces keep the material of the side taken, a float takes the first
/// surface's.
Result<Value> extreme(Lowering& s, Arguments arguments, Op op) {
    const auto first = std::find_if(arguments.begin(), arguments.end(),
                                    [](const Value& v) { return v.type == Type::surface; });
    if (first != arguments.end()) {
        const auto surface = [&](const Value& v) {
            if (v.type == Type::surface) return v;
            Value made = *first;
            made.ids[0] = v.ids[0];
            return made;
        };
        Value result = surface(arguments[0]);
        for (const Value& argument : arguments.subspan(1)) {
            if (isVector(argument.type))
                return problem("min and max of a surface and a vector have no meaning");
            const Value other = surface(argument);
            const IrId mine = op == Op::minimum ? s.ir.add(Op::lessEqual, result.ids[0], other.ids[0])
                                                : s.ir.add(Op::lessEqual, other.ids[0], result.ids[0]);
            result.ids[0] = s.ir.add(op, result.ids[0], other.ids[0]);
            for (int i = 1; i < 9; ++i)
                result.ids[i] = s.ir.add(Op::select, mine, result.ids[i], other.ids[i]);
        }
        return result;
    }
    return componentwise(arguments, [&](const auto& x) {
        IrId id = x[0];
        for (std::size_t k = 1; k < arguments.size(); ++k) id = s.ir.add(op, id, x[k]);
        return id;
    });
}

IrId clamped(Lowering& s, IrId x, IrId lo, IrId hi) {
    return s.ir.add(Op::minimum, s.ir.add(Op::maximum, x, lo), hi);
}

IrId mixed(Lowering& s, IrId a, IrId b, IrId t) {
    if (a == b) return a;
    if (s.ir.isConstant(t, 0.0)) return a;
    if (s.ir.isConstant(t, 1.0)) return b;
    return s.ir.add(Op::add, a, s.ir.add(Op::multiply, s.ir.add(Op::subtract, b, a), t));
}

Result<Value> mix(Lowering& s, Arguments a) {
    if (a[0].type == Type::surface && a[1].type == Type::surface) {
        if (isVector(a[2].type)) return problem("surfaces are mixed by one float");
        Value result{Type::surface};
        for (int i = 0; i < 9; ++i) result.ids[i] = mixed(s, a[0].ids[i], a[1].ids[i], a[2].ids[0]);
        return result;
    }
    return componentwise(a, [&](const auto& x) { return mixed(s, x[0], x[1], x[2]); });
}

Result<Value> smoothstep(Lowering& s, Arguments a) {
    return componentwise(a, [&](const auto& x) {
        const IrId span = s.ir.add(Op::subtract, x[1], x[0]);
        const IrId ratio = s.ir.add(Op::divide, s.ir.add(Op::subtract, x[2], x[0]), span);
        const IrId step =
            s.ir.add(Op::select, s.ir.add(Op::less, x[2], x[0]), number(s, 0.0), number(s, 1.0));
        const IrId t = s.ir.add(Op::select, s.ir.add(Op::equal, span, number(s, 0.0)), step,
                                clamped(s, ratio, number(s, 0.0), number(s, 1.0)));
        const IrId slope = s.ir.add(Op::subtract, number(s, 3.0), scaled(s, t, 2.0));
        return s.ir.add(Op::multiply, s.ir.add(Op::square, t), slope);
    });
}

/// x^n for a constant whole n by multiplications, so that negative x works; else max(x, 0)^y.
Result<Value> power(Lowering& s, Arguments a) {
    return componentwise(a, [&](const auto& x) {
        const double exponent = s.ir.isConstant(x[1]) ? s.ir.number(x[1]) : 0.5;
        if (exponent != std::floor(exponent) || std::abs(exponent) > 64.0)
            return s.ir.add(Op::power, x[0], x[1]);
        IrId result = number(s, 1.0), square = x[0];
        for (int n = static_cast<int>(std::abs(exponent)); n > 0;
             n /= 2, square = s.ir.add(Op::square, square))
            if (n % 2 == 1) result = s.ir.add(Op::multiply, result, square);
        return exponent < 0.0 ? reciprocal(s, result) : result;
    });
}

IrId dotOf(Lowering& s, const Value& a, const Value& b, int width) {
    IrId sum = s.ir.add(Op::multiply, component(a, 0), component(b, 0));
    for (int i = 1; i < width; ++i)
        sum = s.ir.add(Op::add, sum, s.ir.add(Op::multiply, component(a, i), component(b, i)));
    return sum;
}
IrId lengthOf(Lowering& s, const Value& a) {
    if (!isVector(a.type)) return s.ir.add(Op::absolute, a.ids[0]);
    return s.ir.add(Op::squareRoot, dotOf(s, a, a, componentCount(a.type)));
}

Result<Value> dot(Lowering& s, Arguments a) {
    const Result<int> width = commonWidth(a);
    if (!width) return width.error();
    return scalar(dotOf(s, a[0], a[1], *width));
}
Result<Value> length(Lowering& s, Arguments a) {
    const Result<int> width = commonWidth(a);
    if (!width) return width.error();
    return scalar(lengthOf(s, a[0]));
}
Result<Value> distance(Lowering& s, Arguments a) {
    if (a.size() == 1) return asNumber(a[0]);
    const Result<Value> difference = arithmetic(s, '-', a[0], a[1]);
    if (!difference) return difference.error();
    return scalar(lengthOf(s, *difference));
}
Result<Value> normalize(Lowering& s, Arguments a) {
    const IrId size = lengthOf(s, a[0]);
    const IrId inverse =
        s.ir.add(Op::select, s.ir.add(Op::less, number(s, 0.0), size), reciprocal(s, size), number(s, 0.0));
    return componentwise(a, [&](const auto& x) { return s.ir.add(Op::multiply, x[0], inverse); });
}
Result<Value> cross(Lowering& s, Arguments a) {
    if (a[0].type != Type::vec3 || a[1].type != Type::vec3) return problem("cross takes two vec3");
    Value result{Type::vec3};
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        result.ids[i] = s.ir.add(Op::subtract, s.ir.add(Op::multiply, a[0].ids[j], a[1].ids[k]),
                                 s.ir.add(Op::multiply, a[0].ids[k], a[1].ids[j]));
    }
    return result;
}
Result<Value> reflect(Lowering& s, Arguments a) {
    const Result<int> width = commonWidth(a);
    if (!width) return width.error();
    const IrId twice = scaled(s, dotOf(s, a[0], a[1], *width), 2.0);
    return componentwise(
        a, [&](const auto& x) { return s.ir.add(Op::subtract, x[0], s.ir.add(Op::multiply, twice, x[1])); });
}

template <Op op>
Result<Value> noise(Lowering& s, Arguments a) {
    if (a[0].type != Type::vec3) return problem("the first argument is a position (vec3)");
    const IrId seed = a.size() > 1 ? component(a[1], 0) : number(s, 0.0);
    return scalar(s.ir.add(op, std::array{a[0].ids[0], a[0].ids[1], a[0].ids[2], seed}));
}
/// Three independent cell hashes: the seeds are a large odd number apart.
Result<Value> hash3(Lowering& s, Arguments a) {
    if (a[0].type != Type::vec3) return problem("the first argument is a position (vec3)");
    Value result{Type::vec3};
    for (int i = 0; i < 3; ++i) {
        const IrId seed =
            s.ir.add(Op::add, a.size() > 1 ? component(a[1], 0) : number(s, 0.0), number(s, 1009.0 * i));
        result.ids[i] = s.ir.add(Op::cellHash, std::array{a[0].ids[0], a[0].ids[1], a[0].ids[2], seed});
    }
    return result;
}

Result<Value> anyOf(Lowering&, Arguments a) { return scalar(a[0].ids[0], Type::boolean); }

/// float(), int(), bool(): the first component.
Result<Value> toScalar(Lowering& s, Arguments a) {
    if (!isNumeric(a[0].type)) return problem("a " + std::string(typeName(a[0].type)) + " is no number");
    if (a[0].type == Type::boolean)
        return scalar(s.ir.add(Op::select, a[0].ids[0], number(s, 1.0), number(s, 0.0)));
    return scalar(a[0].ids[0]);
}
Result<Value> toInteger(Lowering& s, Arguments a) {
    const Result<Value> value = toScalar(s, a);
    if (!value) return value.error();
    return scalar(s.ir.add(Op::truncate, value->ids[0]), Type::integer);
}
Result<Value> toBoolean(Lowering& s, Arguments a) {
    if (a[0].type == Type::boolean) return a[0];
    return scalar(s.ir.add(Op::logicalNot, s.ir.add(Op::equal, a[0].ids[0], number(s, 0.0))), Type::boolean);
}

/// vec2(), vec3(): one float splats; else the arguments' components in order, exactly as many as needed.
Result<Value> toVector(Lowering& s, Arguments arguments, Type type) {
    Value result{type};
    const int width = componentCount(type);
    int filled = 0;
    for (const Value& argument : arguments) {
        if (!isNumeric(argument.type))
            return problem("a " + std::string(typeName(argument.type)) + " is no number");
        const Result<Value> single =
            isVector(argument.type) ? Result<Value>(argument) : toScalar(s, std::span(&argument, 1));
        if (!single) return single.error();
        const int count = isVector(argument.type) ? componentCount(argument.type) : 1;
        for (int i = 0; i < count; ++i) {
            // GLSL takes the first components of a longer vector, if it is the only argument.
            if (filled == width && arguments.size() == 1) return result;
            if (filled == width)
                return problem(std::string(typeName(type)) + "(…) is given too many components");
            result.ids[filled++] = single->ids[i];
        }
    }
    if (filled == 1)
        while (filled < width) result.ids[filled++] = result.ids[0];
    if (filled < width) return problem(std::string(typeName(type)) + "(…) is given too few components");
    return result;
}

Result<Value> withDistance(Lowering&, Arguments a) {
    if (a[0].type != Type::surface) return problem("with_distance takes a surface and a distance");
    Value result = a[0];
    result.ids[0] = component(a[1], 0);
    return result;
}
Result<Value> withMaterial(Lowering& s, Arguments a) {
    const Result<Value> surface = convert(s, a[0], Type::surface);
    const Result<Value> color = convert(s, a[1], Type::vec3), emission = convert(s, a[4], Type::vec3);
    if (!surface || !color || !emission)
        return problem("with_material takes a surface, a colour, two floats and an emission colour");
    Value result = *surface;
    for (int i = 0; i < 3; ++i) {
        result.ids[baseColorComponent + i] = color->ids[i];
        result.ids[emissionComponent + i] = emission->ids[i];
    }
    result.ids[roughnessComponent] = component(a[2], 0);
    result.ids[metallicComponent] = component(a[3], 0);
    return result;
}
Result<Value> countOf(Lowering& s, Arguments a) {
    if (a[0].type != Type::points || !a[0].points) return problem("count takes a list of points");
    return scalar(number(s, static_cast<double>(a[0].points->size() / 2)), Type::integer);
}

/// The (u, v) behind an image: one vec2 or two floats.
Result<std::pair<IrId, IrId>> imagePlace(Arguments a) {
    if (a.size() == 2 && a[1].type == Type::vec2) return std::pair(a[1].ids[0], a[1].ids[1]);
    if (a.size() == 3 && isNumeric(a[1].type) && isNumeric(a[2].type) && !isVector(a[1].type) &&
        !isVector(a[2].type))
        return std::pair(a[1].ids[0], a[2].ids[0]);
    return problem("behind an image stand a vec2, or the floats u and v");
}
Result<Value> imageColor(Lowering& s, Arguments a) {
    const Result<Value> image = convert(s, a[0], Type::image);
    if (!image) return image.error();
    const Result<std::pair<IrId, IrId>> at = imagePlace(a);
    if (!at) return at.error();
    Value result{Type::vec3};
    for (int i = 0; i < 3; ++i) result.ids[i] = s.ir.sample(image->image, i, at->first, at->second);
    return result;
}
Result<Value> imageGrey(Lowering& s, Arguments a) {
    const Result<Value> image = convert(s, a[0], Type::image);
    if (!image) return image.error();
    const Result<std::pair<IrId, IrId>> at = imagePlace(a);
    if (!at) return at.error();
    return scalar(s.ir.sample(image->image, kGreyLayer, at->first, at->second));
}
Result<Value> imageSize(Lowering& s, Arguments a) {
    const Result<Value> image = convert(s, a[0], Type::image);
    if (!image) return image.error();
    const FieldImage& picture = *s.ir.images()[image->image];
    Value result{Type::vec2};
    result.ids[0] = number(s, picture.width);
    result.ids[1] = number(s, picture.height);
    return result;
}

/// Of the grey: its greatest slope along u and along v, or its least and greatest value.
Result<Value> imageBounds(Lowering& s, Arguments a, bool slopes) {
    const Result<Value> image = convert(s, a[0], Type::image);
    if (!image) return image.error();
    const ImageLayer& grey = s.ir.images()[image->image]->layers[kGreyLayer];
    Value result{Type::vec2};
    result.ids[0] = number(s, slopes ? grey.slopeU : grey.least);
    result.ids[1] = number(s, slopes ? grey.slopeV : grey.most);
    return result;
}

struct Entry {
    Builtin call;
    int least, most;  ///< number of arguments
};

// clang-format off
const std::unordered_map<std::string_view, Entry>& table() {
    using S = Lowering&; using A = Arguments; using R = Result<Value>;
    static const std::unordered_map<std::string_view, Entry> entries = {
        {"abs", {unary<Op::absolute>, 1, 1}}, {"sign", {unary<Op::sign>, 1, 1}}, {"floor", {unary<Op::floor>, 1, 1}},
        {"ceil", {unary<Op::ceil>, 1, 1}}, {"round", {unary<Op::round>, 1, 1}}, {"trunc", {unary<Op::truncate>, 1, 1}},
        {"sqrt", {unary<Op::squareRoot>, 1, 1}}, {"exp", {unary<Op::exponential>, 1, 1}}, {"log", {unary<Op::logarithm>, 1, 1}},
        {"sin", {unary<Op::sine>, 1, 1}}, {"cos", {unary<Op::cosine>, 1, 1}}, {"tan", {unary<Op::tangent>, 1, 1}},
        {"asin", {unary<Op::arcSine>, 1, 1}}, {"acos", {unary<Op::arcCosine>, 1, 1}},
        {"atan", {[](S s, A a) -> R { return a.size() == 1 ? unary<Op::arcTangent>(s, a) : binary<Op::arcTangent2>(s, a); }, 1, 2}},
        {"atan2", {binary<Op::arcTangent2>, 2, 2}}, {"mod", {binary<Op::modulo>, 2, 2}}, {"fmod", {binary<Op::truncatedModulo>, 2, 2}},
        {"pow", {power, 2, 2}}, {"cross", {cross, 2, 2}}, {"dot", {dot, 2, 2}}, {"length", {length, 1, 1}},
        {"distance", {distance, 1, 2}}, {"normalize", {normalize, 1, 1}}, {"reflect", {reflect, 2, 2}},
        {"min", {[](S s, A a) -> R { return extreme(s, a, Op::minimum); }, 2, 8}},
        {"max", {[](S s, A a) -> R { return extreme(s, a, Op::maximum); }, 2, 8}},
        {"smooth_min", {[](S s, A a) -> R { return componentwise(a, [&](const auto& x) { return s.ir.add(Op::smoothMinimum, x[0], x[1], x[2]); }); }, 3, 3}},
        {"smooth_max", {[](S s, A a) -> R { return componentwise(a, [&](const auto& x) {
            const auto negative = [&](IrId id) { return s.ir.add(Op::negate, id); };
            return negative(s.ir.add(Op::smoothMinimum, negative(x[0]), negative(x[1]), x[2])); }); }, 3, 3}},
        {"fract", {[](S s, A a) -> R { return componentwise(a, [&](const auto& x) { return s.ir.add(Op::modulo, x[0], number(s, 1.0)); }); }, 1, 1}},
        {"frac", {[](S s, A a) -> R { return callBuiltin(s, "fract", a); }, 1, 1}},
        {"inversesqrt", {[](S s, A a) -> R { return componentwise(a, [&](const auto& x) { return reciprocal(s, s.ir.add(Op::squareRoot, x[0])); }); }, 1, 1}},
        {"rsqrt", {[](S s, A a) -> R { return callBuiltin(s, "inversesqrt", a); }, 1, 1}},
        {"exp2", {[](S s, A a) -> R { return componentwise(a, [&](const auto& x) { return s.ir.add(Op::exponential, scaled(s, x[0], std::numbers::ln2)); }); }, 1, 1}},
        {"log2", {[](S s, A a) -> R { return componentwise(a, [&](const auto& x) { return scaled(s, s.ir.add(Op::logarithm, x[0]), std::numbers::log2e); }); }, 1, 1}},
        {"sinh", {[](S s, A a) -> R { return componentwise(a, [&](const auto& x) {
            const IrId e = s.ir.add(Op::exponential, x[0]); return scaled(s, s.ir.add(Op::subtract, e, reciprocal(s, e)), 0.5); }); }, 1, 1}},
        {"cosh", {[](S s, A a) -> R { return componentwise(a, [&](const auto& x) {
            const IrId e = s.ir.add(Op::exponential, s.ir.add(Op::absolute, x[0])); return scaled(s, s.ir.add(Op::add, e, reciprocal(s, e)), 0.5); }); }, 1, 1}},
        {"tanh", {[](S s, A a) -> R { return componentwise(a, [&](const auto& x) {  // 1 - 2 / (e^2x + 1): each variable once
            const IrId e = s.ir.add(Op::exponential, clamped(s, scaled(s, x[0], 2.0), number(s, -60.0), number(s, 60.0)));
            return s.ir.add(Op::subtract, number(s, 1.0), s.ir.add(Op::divide, number(s, 2.0), s.ir.add(Op::add, e, number(s, 1.0)))); }); }, 1, 1}},
        {"radians", {[](S s, A a) -> R { return componentwise(a, [&](const auto& x) { return scaled(s, x[0], std::numbers::pi / 180.0); }); }, 1, 1}},
        {"degrees", {[](S s, A a) -> R { return componentwise(a, [&](const auto& x) { return scaled(s, x[0], 180.0 / std::numbers::pi); }); }, 1, 1}},
        {"saturate", {[](S s, A a) -> R { return componentwise(a, [&](const auto& x) { return clamped(s, x[0], number(s, 0.0), number(s, 1.0)); }); }, 1, 1}},
        {"clamp", {[](S s, A a) -> R { return componentwise(a, [&](const auto& x) { return clamped(s, x[0], x[1], x[2]); }); }, 3, 3}},
        {"step", {[](S s, A a) -> R { return componentwise(a, [&](const auto& x) {
            return s.ir.add(Op::select, s.ir.add(Op::less, x[1], x[0]), number(s, 0.0), number(s, 1.0)); }); }, 2, 2}},
        {"mix", {mix, 3, 3}}, {"lerp", {mix, 3, 3}}, {"smoothstep", {smoothstep, 3, 3}},
        {"any", {anyOf, 1, 1}}, {"all", {anyOf, 1, 1}},
        {"float", {toScalar, 1, 1}}, {"int", {toInteger, 1, 1}}, {"bool", {toBoolean, 1, 1}},
        {"vec2", {[](S s, A a) -> R { return toVector(s, a, Type::vec2); }, 1, 2}}, {"float2", {[](S s, A a) -> R { return toVector(s, a, Type::vec2); }, 1, 2}},
        {"vec3", {[](S s, A a) -> R { return toVector(s, a, Type::vec3); }, 1, 3}}, {"float3", {[](S s, A a) -> R { return toVector(s, a, Type::vec3); }, 1, 3}},
        {"perlin", {noise<Op::gradientNoise>, 1, 2}}, {"simplex", {noise<Op::simplexNoise>, 1, 2}}, {"worley", {noise<Op::worleyNoise>, 1, 2}},
        {"hash", {noise<Op::cellHash>, 1, 2}}, {"hash3", {hash3, 1, 2}},
        {"with_distance", {withDistance, 2, 2}}, {"with_material", {withMaterial, 5, 5}},
        {"empty", {[](S s, A) -> R { return emptySurface(s); }, 0, 0}}, {"count", {countOf, 1, 1}},
        {"image_color", {imageColor, 2, 3}}, {"image_grey", {imageGrey, 2, 3}}, {"image_size", {imageSize, 1, 1}},
        {"image_range", {[](S s, A a) -> R { return imageBounds(s, a, false); }, 1, 1}},
        {"image_slope", {[](S s, A a) -> R { return imageBounds(s, a, true); }, 1, 1}},
    };
    return entries;
}
// clang-format on

}  // namespace

bool isBuiltin(std::string_view name) { return table().contains(name); }

std::vector<std::string> builtinNames() {
    std::vector<std::string> names;
    for (const auto& entry : table()) names.emplace_back(entry.first);
    std::sort(names.begin(), names.end());
    return names;
}

Result<Value> callBuiltin(Lowering& state, std::string_view name, Arguments arguments) {
    const Entry& entry = table().at(name);
    const int count = static_cast<int>(arguments.size());
    if (count < entry.least || count > entry.most) {
        const std::string wanted = entry.least == entry.most
                                       ? std::to_string(entry.least)
                                       : std::to_string(entry.least) + " to " + std::to_string(entry.most);
        return problem("'" + std::string(name) + "' takes " + wanted + " arguments, not " +
                       std::to_string(count));
    }
    return entry.call(state, arguments);
}

Result<Value> arithmetic(Lowering& state, char operation, const Value& a, const Value& b) {
    const Op op = operation == '+'   ? Op::add
                  : operation == '-' ? Op::subtract
                  : operation == '*' ? Op::multiply
                  : operation == '/' ? Op::divide
                                     : Op::truncatedModulo;
    const std::array<Value, 2> operands = {a, b};
    Result<Value> result =
        componentwise(operands, [&](const auto& x) { return state.ir.add(op, x[0], x[1]); });
    if (result && a.type == Type::integer && b.type == Type::integer && operation != '/')
        result->type = Type::integer;
    return result;
}

Result<Value> choose(Lowering& state, IrId condition, const Value& a, const Value& b) {
    Value x = a, y = b;
    if (x.type != y.type) {
        const Type wanted = x.type == Type::surface || y.type == Type::surface ? Type::surface
                            : isVector(x.type)                                 ? x.type
                            : isVector(y.type)                                 ? y.type
                                                                               : Type::scalar;
        const Result<Value> cx = convert(state, x, wanted), cy = convert(state, y, wanted);
        if (!cx || !cy)
            return problem("the two sides are of different types, " + std::string(typeName(a.type)) +
                           " and " + std::string(typeName(b.type)));
        x = *cx, y = *cy;
    }
    if (x.type == Type::boolean) {  // in logic, so that a select is always a number
        const IrId yes = state.ir.add(Op::logicalAnd, condition, x.ids[0]);
        const IrId no = state.ir.add(Op::logicalAnd, state.ir.add(Op::logicalNot, condition), y.ids[0]);
        return scalar(state.ir.add(Op::logicalOr, yes, no), Type::boolean);
    }
    if (componentCount(x.type) == 0) {
        if (!state.ir.isConstant(condition))
            return problem("texts and points can only be chosen by a constant condition");
        return state.ir.number(condition) != 0.0 ? x : y;
    }
    for (int i = 0; i < componentCount(x.type); ++i)
        x.ids[i] = state.ir.add(Op::select, condition, x.ids[i], y.ids[i]);
    return x;
}

}  // namespace fw::language
