#include "graph/language/builtins.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>
#include <unordered_map>

#include "graph/language/ramps.h"
#include "graph/language/splines.h"
#include "graph/outlines/drawing.h"
#include "graph/outlines/gear.h"
#include "graph/outlines/letters.h"

namespace fw::language {

bool isVector(Type type) { return type == Type::vec2 || type == Type::vec3; }
bool isNumber(Type type) { return type == Type::scalar || type == Type::integer || type == Type::surface; }
std::string aType(Type type) {
    const std::string name(typeName(type));
    return (name[0] == 'i' ? "an " : "a ") + name;
}

namespace {

using Arguments = std::span<const Value>;
using Types = std::span<const Type>;

// ---- what types they take and give

TypeProblem expected(int argument, std::string_view what, Type found) {
    std::string message = "expected " + std::string(what) + ", found " + aType(found);
    if (found == Type::boolean) message += ": write float(…), or c ? a : b";
    return {argument, std::move(message)};
}
Type vectorOf(int components) {
    return components == 3 ? Type::vec3 : components == 2 ? Type::vec2 : Type::scalar;
}

/// Numbers and vectors of one width, the numbers joining every component.
TypeResult componentwiseType(Types types) {
    Type common = Type::scalar;
    for (std::size_t i = 0; i < types.size(); ++i) {
        if (!isVector(types[i]) && !isNumber(types[i]))
            return expected(int(i),
                            common == Type::scalar ? "a number or a vector" : "a number or " + aType(common),
                            types[i]);
        if (!isVector(types[i])) continue;
        if (isVector(common) && common != types[i])
            return TypeProblem{int(i), "expected " + aType(common) + ", found " + aType(types[i]) +
                                           ": vec2 and vec3 do not mix: write .xy or vec3(…)"};
        common = types[i];
    }
    return common;
}
/// The same, with one number as the result.
TypeResult measureType(Types types) {
    TypeResult common = componentwiseType(types);
    return std::holds_alternative<Type>(common) ? TypeResult(Type::scalar) : common;
}
/// Of min, max: a surface if one of them is.
TypeResult extremeType(Types types) {
    if (std::ranges::find(types, Type::surface) == types.end()) return componentwiseType(types);
    for (std::size_t i = 0; i < types.size(); ++i)
        if (!isNumber(types[i])) return expected(int(i), "a surface or a number", types[i]);
    return Type::surface;
}
TypeResult mixType(Types types) {
    if (types[0] != Type::surface || types[1] != Type::surface) return componentwiseType(types);
    if (!isNumber(types[2])) return expected(2, "a number, by which surfaces are mixed", types[2]);
    return Type::surface;
}

/// Of functions whose arguments are of certain types: the last of `wanted` stands for the result.
template <Type result, Type... wanted>
TypeResult fixed(Types types) {
    constexpr Type all[] = {wanted..., result};
    for (std::size_t i = 0; i < types.size(); ++i)
        if (!standsFor(types[i], all[i])) {
            const bool number = all[i] == Type::scalar;
            return expected(int(i), number ? std::string("a number") : aType(all[i]), types[i]);
        }
    return result;
}
TypeResult crossType(Types types) {
    for (int i = 0; i < 2; ++i)
        if (types[std::size_t(i)] != Type::vec3) return expected(i, "a vec3", types[std::size_t(i)]);
    return Type::vec3;
}
/// A position, and perhaps a seed.
template <Type result>
TypeResult noiseType(Types types) {
    if (types[0] != Type::vec3) return expected(0, "a position (vec3)", types[0]);
    if (types.size() > 1 && !isNumber(types[1])) return expected(1, "a number, the seed", types[1]);
    return result;
}
TypeResult distanceType(Types types) {
    if (types.size() == 2) return measureType(types);
    return isNumber(types[0]) ? TypeResult(Type::scalar) : expected(0, "a surface", types[0]);
}
/// float(), int(), bool(): the first component of whatever has some.
template <Type result>
TypeResult conversionType(Types types) {
    if (componentCount(types[0]) == 0) return expected(0, "a number", types[0]);
    return result;
}
/// vec2(), vec3(): one number for all components; else the arguments' components in order, exactly as many as
/// needed. GLSL takes the first components of a longer vector, if it is the only argument.
template <Type type>
TypeResult vectorType(Types types) {
    int count = 0;
    for (std::size_t i = 0; i < types.size(); ++i) {
        if (!isVector(types[i]) && !isNumber(types[i]))
            return expected(int(i), "a number or a vector", types[i]);
        count += isVector(types[i]) ? componentCount(types[i]) : 1;
    }
    constexpr int width = componentCount(type);
    if (types.size() == 1 && (count == 1 || count >= width)) return type;
    if (count == width) return type;
    return TypeProblem{-1, std::string(typeName(type)) + "(…) takes " + std::to_string(width) +
                               " components, found " + std::to_string(count)};
}
TypeResult withMaterialType(Types types) {
    if (!isNumber(types[0])) return expected(0, "a surface", types[0]);
    TypeResult rest =
        fixed<Type::surface, Type::vec3, Type::scalar, Type::scalar, Type::vec3>(types.subspan(1, 4));
    for (std::size_t i = 5; i < types.size() && std::holds_alternative<Type>(rest); ++i)
        if (!isNumber(types[i]) && !(i == 7 && types[i] == Type::vec3))
            return expected(int(i), i == 7 ? "a vec3" : "a number", types[i]);
    const auto* problem = std::get_if<TypeProblem>(&rest);
    return problem ? TypeResult(TypeProblem{problem->argument + 1, problem->message}) : rest;
}
TypeResult withDistanceType(Types types) {
    if (types[0] != Type::surface) return expected(0, "a surface", types[0]);
    return isNumber(types[1]) ? TypeResult(Type::surface) : expected(1, "a number, the distance", types[1]);
}
/// An image and, if `place`, where: one vec2 or two numbers.
template <Type result, bool place>
TypeResult imageType(Types types) {
    if (!standsFor(types[0], Type::image))
        return TypeProblem{0, "expected an image or its path, found " + aType(types[0]) + ": " +
                                  aType(types[0]) + " cannot stand for an image"};
    if (!place || (types.size() == 2 && types[1] == Type::vec2) ||
        (types.size() == 3 && isNumber(types[1]) && isNumber(types[2])))
        return result;
    return TypeProblem{1, "behind an image stand a vec2, or the floats u and v"};
}
TypeResult booleanType(Types types) {
    return types[0] == Type::boolean ? TypeResult(Type::boolean) : expected(0, "a comparison", types[0]);
}

// ---- what they are made of

Value scalar(IrId id, Type type = Type::scalar) {
    Value value{type};
    value.ids[0] = id;
    return value;
}

IrId component(const Value& value, int i) { return isVector(value.type) ? value.ids[i] : value.ids[0]; }

int widthOf(Arguments arguments) {
    int width = 1;
    for (const Value& argument : arguments)
        if (isVector(argument.type)) width = componentCount(argument.type);
    return width;
}

/// f applied to each component.
template <class F>
Value componentwise(Arguments arguments, F f) {
    const int width = widthOf(arguments);
    Value result{vectorOf(width)};
    std::array<IrId, 8> operands{};
    for (int i = 0; i < width; ++i) {
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
            const Value other = surface(argument);
            const IrId mine = op == Op::minimum ? s.ir.add(Op::lessEqual, result.ids[0], other.ids[0])
                                                : s.ir.add(Op::lessEqual, other.ids[0], result.ids[0]);
            result.ids[0] = s.ir.add(op, result.ids[0], other.ids[0]);
            for (int i = 1; i < kSurfaceComponents; ++i)
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
        Value result{Type::surface};
        for (int i = 0; i < painterComponent; ++i)
            result.ids[i] = mixed(s, a[0].ids[i], a[1].ids[i], a[2].ids[0]);
        // There is nobody between two painters: it is whose share is larger.
        const auto painter = [&](const Value& v) { return v.ids[painterComponent]; };
        result.ids[painterComponent] =
            painter(a[0]) == painter(a[1])
                ? painter(a[0])
                : s.ir.add(Op::select, s.ir.add(Op::less, a[2].ids[0], number(s, 0.5)), painter(a[0]),
                           painter(a[1]));
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
    const int width = widthOf(a);
    return scalar(dotOf(s, a[0], a[1], width));
}
Result<Value> length(Lowering& s, Arguments a) { return scalar(lengthOf(s, a[0])); }
Result<Value> distance(Lowering& s, Arguments a) {
    if (a.size() == 1) return scalar(a[0].ids[0]);
    return scalar(lengthOf(s, arithmetic(s, '-', a[0], a[1])));
}
Result<Value> normalize(Lowering& s, Arguments a) {
    const IrId size = lengthOf(s, a[0]);
    const IrId inverse =
        s.ir.add(Op::select, s.ir.add(Op::less, number(s, 0.0), size), reciprocal(s, size), number(s, 0.0));
    return componentwise(a, [&](const auto& x) { return s.ir.add(Op::multiply, x[0], inverse); });
}
Result<Value> cross(Lowering& s, Arguments a) {
    Value result{Type::vec3};
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        result.ids[i] = s.ir.add(Op::subtract, s.ir.add(Op::multiply, a[0].ids[j], a[1].ids[k]),
                                 s.ir.add(Op::multiply, a[0].ids[k], a[1].ids[j]));
    }
    return result;
}
Result<Value> reflect(Lowering& s, Arguments a) {
    const int width = widthOf(a);
    const IrId twice = scaled(s, dotOf(s, a[0], a[1], width), 2.0);
    return componentwise(
        a, [&](const auto& x) { return s.ir.add(Op::subtract, x[0], s.ir.add(Op::multiply, twice, x[1])); });
}

template <Op op>
Result<Value> noise(Lowering& s, Arguments a) {
    const IrId seed = a.size() > 1 ? component(a[1], 0) : number(s, 0.0);
    return scalar(s.ir.add(op, std::array{a[0].ids[0], a[0].ids[1], a[0].ids[2], seed}));
}
/// Three independent cell hashes: the seeds are a large odd number apart.
Result<Value> hash3(Lowering& s, Arguments a) {
    Value result{Type::vec3};
    for (int i = 0; i < 3; ++i) {
        const IrId seed =
            s.ir.add(Op::add, a.size() > 1 ? component(a[1], 0) : number(s, 0.0), number(s, 1009.0 * i));
        result.ids[i] = s.ir.add(Op::cellHash, std::array{a[0].ids[0], a[0].ids[1], a[0].ids[2], seed});
    }
    return result;
}

Result<Value> same(Lowering&, Arguments a) { return a[0]; }

Value firstComponent(Lowering& s, const Value& a) {
    if (a.type == Type::boolean)
        return scalar(s.ir.add(Op::select, a.ids[0], number(s, 1.0), number(s, 0.0)));
    return scalar(a.ids[0]);
}
Result<Value> toScalar(Lowering& s, Arguments a) { return firstComponent(s, a[0]); }
Result<Value> toInteger(Lowering& s, Arguments a) {
    return scalar(s.ir.add(Op::truncate, firstComponent(s, a[0]).ids[0]), Type::integer);
}
Result<Value> toBoolean(Lowering& s, Arguments a) {
    if (a[0].type == Type::boolean) return a[0];
    return scalar(s.ir.add(Op::logicalNot, s.ir.add(Op::equal, a[0].ids[0], number(s, 0.0))), Type::boolean);
}

template <Type type>
Result<Value> toVector(Lowering&, Arguments arguments) {
    Value result{type};
    const int width = componentCount(type);
    int filled = 0;
    for (const Value& argument : arguments)
        for (int i = 0; i < (isVector(argument.type) ? componentCount(argument.type) : 1) && filled < width;
             ++i)
            result.ids[filled++] = argument.ids[i];
    while (filled < width) result.ids[filled++] = result.ids[0];
    return result;
}

Result<Value> withDistance(Lowering& s, Arguments a) {
    Value result = *convert(s, a[0], Type::surface);
    result.ids[0] = a[1].ids[0];
    return result;
}
Result<Value> withMaterial(Lowering& s, Arguments a) {
    Value result = *convert(s, a[0], Type::surface);
    const Value color = *convert(s, a[1], Type::vec3), emission = *convert(s, a[4], Type::vec3);
    for (int i = 0; i < 3; ++i) {
        result.ids[baseColorComponent + i] = color.ids[i];
        result.ids[emissionComponent + i] = emission.ids[i];
    }
    result.ids[roughnessComponent] = a[2].ids[0];
    result.ids[metallicComponent] = a[3].ids[0];
    if (a.size() > 5) result.ids[transmissionComponent] = a[5].ids[0];
    if (a.size() > 6) result.ids[iorComponent] = a[6].ids[0];
    if (a.size() > 7)
        std::ranges::copy_n(convert(s, a[7], Type::vec3)->ids.begin(), 3,
                            result.ids.begin() + absorptionComponent);
    result.ids[painterComponent] = number(s, s.painter);
    s.transmissions += !s.ir.isConstant(result.ids[transmissionComponent], 0.0);
    return result;
}
Result<Value> countOf(Lowering& s, Arguments a) {
    return scalar(number(s, static_cast<double>(a[0].points->size() / 2)), Type::integer);
}

/// The distance to a closed outline.
Result<Value> outlineAt(Lowering& s, Arguments a) {
    if (a[1].points->empty()) return scalar(number(s, kEmptyDistance));
    if (a[1].points->size() > 2 * kMaxCorners)
        return Error{"an outline of " + std::to_string(a[1].points->size() / 2) + " points: at most " +
                     std::to_string(kMaxCorners) + " are allowed"};
    return scalar(s.ir.sample(s.ir.addOutline(outlineThrough(*a[1].points)), a[0].ids[0], a[0].ids[1]));
}

/// The distance to an outline at a place. Beyond its box that to the box is never more: it changes no value,
/// but tells intervals where nothing is.
IrId distanceToOutline(Lowering& s, const OutlinePtr& outline, const Value& place) {
    const IrId x = place.ids[0], y = place.ids[1];
    IrId distance = s.ir.sample(s.ir.addOutline(outline), x, y);
    for (const auto& [at, lo, hi] :
         {std::tuple(x, outline->lo.x, outline->hi.x), std::tuple(y, outline->lo.y, outline->hi.y)}) {
        distance = s.ir.add(Op::maximum, distance, s.ir.add(Op::subtract, number(s, lo), at));
        distance = s.ir.add(Op::maximum, distance, s.ir.add(Op::subtract, at, number(s, hi)));
    }
    return distance;
}

/// The distance to what a drawing paints.
Result<Value> drawingAt(Lowering& s, Arguments a) {
    const Result<OutlinePtr> outline = readDrawing(s.graphPath, a[1].text, a[2].text);
    if (!outline) return outline.error();
    for (const std::string& remark : (*outline)->remarks)
        s.remarks.push_back(inQuotes(a[1].text) + ": " + remark);
    return scalar(distanceToOutline(s, *outline, a[0]));
}
/// How long its unit is by its file.
Result<Value> drawingScale(Lowering& s, Arguments a) {
    const Result<OutlinePtr> outline = readDrawing(s.graphPath, a[0].text, a[1].text);
    if (!outline) return outline.error();
    return scalar(number(s, (*outline)->scale * s.metre));
}

/// The distance to a gear.
Result<Value> gearAt(Lowering& s, Arguments a) {
    for (const Value& value : a.subspan(1))
        if (!s.ir.isConstant(value.ids[0]))
            return Error{
                "the numbers of a gear must be known when the graph is compiled: they cannot depend on the "
                "place"};
    const auto at = [&](std::size_t i) { return s.ir.number(a[i].ids[0]); };
    const GearShape shape{std::max(at(1), 1e-6), int(std::clamp(at(2), 3.0, 1000.0)),
                          std::clamp(at(3), 10.0, 35.0), at(4)};
    const Result<OutlinePtr> outline = outlineOfGear(shape);
    if (!outline) return outline.error();
    return scalar(distanceToOutline(s, *outline, a[0]));
}

/// The distance to a text's letters.
Result<Value> lettersAt(Lowering& s, Arguments a) {
    for (std::size_t i = 6; i < 9; ++i)
        if (!s.ir.isConstant(a[i].ids[0]))
            return Error{
                "the spacing of letters must be known when the graph is compiled: it cannot depend on the "
                "place"};
    using Align = TextLayout::Align;
    using Anchor = TextLayout::Anchor;
    TextLayout layout;
    if (!a[2].text.empty()) layout.family = a[2].text;
    layout.fontFile = a[3].text;
    layout.align = a[4].text == "left" ? Align::left : a[4].text == "right" ? Align::right : Align::center;
    layout.anchor = a[5].text == "baseline" ? Anchor::baseline
                    : a[5].text == "top"    ? Anchor::top
                    : a[5].text == "bottom" ? Anchor::bottom
                                            : Anchor::middle;
    layout.letterSpacing = s.ir.number(a[6].ids[0]);
    layout.lineSpacing = s.ir.number(a[7].ids[0]);
    layout.kerning = s.ir.number(a[8].ids[0]) != 0;
    const Result<OutlinePtr> outline = outlineOfText(s.graphPath, a[1].text, layout);
    if (!outline) return outline.error();
    return scalar(*outline ? distanceToOutline(s, *outline, a[0]) : number(s, kEmptyDistance));
}

/// The (u, v) behind an image.
std::pair<IrId, IrId> imagePlace(Arguments a) {
    return a[1].type == Type::vec2 ? std::pair(a[1].ids[0], a[1].ids[1])
                                   : std::pair(a[1].ids[0], a[2].ids[0]);
}
Result<Value> imageColor(Lowering& s, Arguments a) {
    const Result<Value> image = convert(s, a[0], Type::image);
    if (!image) return image.error();
    const auto [u, v] = imagePlace(a);
    Value result{Type::vec3};
    for (int i = 0; i < 3; ++i) result.ids[i] = s.ir.sample(image->image, i, u, v);
    return result;
}
Result<Value> imageGrey(Lowering& s, Arguments a) {
    const Result<Value> image = convert(s, a[0], Type::image);
    if (!image) return image.error();
    const auto [u, v] = imagePlace(a);
    return scalar(s.ir.sample(image->image, kGreyLayer, u, v));
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

Result<Value> fract(Lowering& s, Arguments a) {
    return componentwise(a, [&](const auto& x) { return s.ir.add(Op::modulo, x[0], number(s, 1.0)); });
}
Result<Value> inverseSquareRoot(Lowering& s, Arguments a) {
    return componentwise(a, [&](const auto& x) { return reciprocal(s, s.ir.add(Op::squareRoot, x[0])); });
}

// clang-format off
const std::vector<Builtin>& table() {
    using S = Lowering&; using A = Arguments; using R = Result<Value>;
    static const std::vector<Builtin> entries = {
        {"abs", 1, 1, componentwiseType, unary<Op::absolute>}, {"sign", 1, 1, componentwiseType, unary<Op::sign>}, {"floor", 1, 1, componentwiseType, unary<Op::floor>},
        {"ceil", 1, 1, componentwiseType, unary<Op::ceil>}, {"round", 1, 1, componentwiseType, unary<Op::round>}, {"trunc", 1, 1, componentwiseType, unary<Op::truncate>},
        {"sqrt", 1, 1, componentwiseType, unary<Op::squareRoot>}, {"exp", 1, 1, componentwiseType, unary<Op::exponential>}, {"log", 1, 1, componentwiseType, unary<Op::logarithm>},
        {"sin", 1, 1, componentwiseType, unary<Op::sine>}, {"cos", 1, 1, componentwiseType, unary<Op::cosine>}, {"tan", 1, 1, componentwiseType, unary<Op::tangent>},
        {"asin", 1, 1, componentwiseType, unary<Op::arcSine>}, {"acos", 1, 1, componentwiseType, unary<Op::arcCosine>},
        {"atan", 1, 2, componentwiseType, [](S s, A a) -> R { return a.size() == 1 ? unary<Op::arcTangent>(s, a) : binary<Op::arcTangent2>(s, a); }},
        {"atan2", 2, 2, componentwiseType, binary<Op::arcTangent2>}, {"mod", 2, 2, componentwiseType, binary<Op::modulo>}, {"fmod", 2, 2, componentwiseType, binary<Op::truncatedModulo>},
        {"pow", 2, 2, componentwiseType, power}, {"cross", 2, 2, crossType, cross}, {"dot", 2, 2, measureType, dot}, {"length", 1, 1, measureType, length},
        {"distance", 1, 2, distanceType, distance}, {"normalize", 1, 1, componentwiseType, normalize}, {"reflect", 2, 2, componentwiseType, reflect},
        {"min", 2, 8, extremeType, [](S s, A a) -> R { return extreme(s, a, Op::minimum); }},
        {"max", 2, 8, extremeType, [](S s, A a) -> R { return extreme(s, a, Op::maximum); }},
        {"smooth_min", 3, 3, componentwiseType, [](S s, A a) -> R { return componentwise(a, [&](const auto& x) { return s.ir.add(Op::smoothMinimum, x[0], x[1], x[2]); }); }},
        {"smooth_max", 3, 3, componentwiseType, [](S s, A a) -> R { return componentwise(a, [&](const auto& x) {
            const auto negative = [&](IrId id) { return s.ir.add(Op::negate, id); };
            return negative(s.ir.add(Op::smoothMinimum, negative(x[0]), negative(x[1]), x[2])); }); }},
        {"fract", 1, 1, componentwiseType, fract},
        {"frac", 1, 1, componentwiseType, fract},
        {"inversesqrt", 1, 1, componentwiseType, inverseSquareRoot},
        {"rsqrt", 1, 1, componentwiseType, inverseSquareRoot},
        {"exp2", 1, 1, componentwiseType, [](S s, A a) -> R { return componentwise(a, [&](const auto& x) { return s.ir.add(Op::exponential, scaled(s, x[0], std::numbers::ln2)); }); }},
        {"log2", 1, 1, componentwiseType, [](S s, A a) -> R { return componentwise(a, [&](const auto& x) { return scaled(s, s.ir.add(Op::logarithm, x[0]), std::numbers::log2e); }); }},
        {"sinh", 1, 1, componentwiseType, [](S s, A a) -> R { return componentwise(a, [&](const auto& x) {
            const IrId e = s.ir.add(Op::exponential, x[0]); return scaled(s, s.ir.add(Op::subtract, e, reciprocal(s, e)), 0.5); }); }},
        {"cosh", 1, 1, componentwiseType, [](S s, A a) -> R { return componentwise(a, [&](const auto& x) {
            const IrId e = s.ir.add(Op::exponential, s.ir.add(Op::absolute, x[0])); return scaled(s, s.ir.add(Op::add, e, reciprocal(s, e)), 0.5); }); }},
        {"tanh", 1, 1, componentwiseType, [](S s, A a) -> R { return componentwise(a, [&](const auto& x) {  // 1 - 2 / (e^2x + 1): each variable once
            const IrId e = s.ir.add(Op::exponential, clamped(s, scaled(s, x[0], 2.0), number(s, -60.0), number(s, 60.0)));
            return s.ir.add(Op::subtract, number(s, 1.0), s.ir.add(Op::divide, number(s, 2.0), s.ir.add(Op::add, e, number(s, 1.0)))); }); }},
        {"radians", 1, 1, componentwiseType, [](S s, A a) -> R { return componentwise(a, [&](const auto& x) { return scaled(s, x[0], std::numbers::pi / 180.0); }); }},
        {"degrees", 1, 1, componentwiseType, [](S s, A a) -> R { return componentwise(a, [&](const auto& x) { return scaled(s, x[0], 180.0 / std::numbers::pi); }); }},
        {"saturate", 1, 1, componentwiseType, [](S s, A a) -> R { return componentwise(a, [&](const auto& x) { return clamped(s, x[0], number(s, 0.0), number(s, 1.0)); }); }},
        {"clamp", 3, 3, componentwiseType, [](S s, A a) -> R { return componentwise(a, [&](const auto& x) { return clamped(s, x[0], x[1], x[2]); }); }},
        {"step", 2, 2, componentwiseType, [](S s, A a) -> R { return componentwise(a, [&](const auto& x) {
            return s.ir.add(Op::select, s.ir.add(Op::less, x[1], x[0]), number(s, 0.0), number(s, 1.0)); }); }},
        {"mix", 3, 3, mixType, mix}, {"lerp", 3, 3, mixType, mix}, {"smoothstep", 3, 3, componentwiseType, smoothstep},
        {"any", 1, 1, booleanType, same}, {"all", 1, 1, booleanType, same},
        {"float", 1, 1, conversionType<Type::scalar>, toScalar}, {"int", 1, 1, conversionType<Type::integer>, toInteger}, {"bool", 1, 1, conversionType<Type::boolean>, toBoolean},
        {"vec2", 1, 2, vectorType<Type::vec2>, toVector<Type::vec2>}, {"float2", 1, 2, vectorType<Type::vec2>, toVector<Type::vec2>},
        {"vec3", 1, 3, vectorType<Type::vec3>, toVector<Type::vec3>}, {"float3", 1, 3, vectorType<Type::vec3>, toVector<Type::vec3>},
        {"perlin", 1, 2, noiseType<Type::scalar>, noise<Op::gradientNoise>}, {"simplex", 1, 2, noiseType<Type::scalar>, noise<Op::simplexNoise>}, {"worley", 1, 2, noiseType<Type::scalar>, noise<Op::worleyNoise>},
        {"cell_wall", 1, 2, noiseType<Type::scalar>, noise<Op::cellWall>},
        {"hash", 1, 2, noiseType<Type::scalar>, noise<Op::cellHash>}, {"hash3", 1, 2, noiseType<Type::vec3>, hash3},
        {"with_distance", 2, 2, withDistanceType, withDistance}, {"with_material", 5, 8, withMaterialType, withMaterial},
        {"empty", 0, 0, fixed<Type::surface>, [](S s, A) -> R { return emptySurface(s); }}, {"count", 1, 1, fixed<Type::integer, Type::points>, countOf}, {"outline", 2, 2, fixed<Type::scalar, Type::vec2, Type::points>, outlineAt},
        {"drawing", 3, 3, fixed<Type::scalar, Type::vec2, Type::string, Type::string>, drawingAt}, {"drawing_scale", 2, 2, fixed<Type::scalar, Type::string, Type::string>, drawingScale},
        {"metre", 0, 0, fixed<Type::scalar>, [](S s, A) -> R { return scalar(number(s, s.metre)); }},
        {"gear_outline", 5, 5, fixed<Type::scalar, Type::vec2, Type::scalar, Type::scalar, Type::scalar, Type::scalar>, gearAt},
        {"letters", 9, 9, fixed<Type::scalar, Type::vec2, Type::string, Type::string, Type::string, Type::string, Type::string, Type::scalar, Type::scalar, Type::scalar>, lettersAt},
        {"spline_through", 4, 4, fixed<Type::spline, Type::knots, Type::string, Type::boolean, Type::scalar>, splineThroughKnots},
        {"spline_of_helix", 5, 5, fixed<Type::spline, Type::scalar, Type::scalar, Type::scalar, Type::scalar, Type::boolean>, splineOfHelixAt},
        {"spline_of_drawing", 5, 5, fixed<Type::spline, Type::string, Type::string, Type::integer, Type::scalar, Type::boolean>, splineOfDrawing},
        {"spline_distance", 3, 3, fixed<Type::scalar, Type::vec3, Type::spline, Type::scalar>, splineDistance}, {"spline_place", 2, 2, fixed<Type::vec3, Type::vec3, Type::spline>, splinePlace},
        {"spline_radius", 2, 2, fixed<Type::scalar, Type::vec3, Type::spline>, splineShare}, {"spline_length", 1, 1, fixed<Type::scalar, Type::spline>, splineLength}, {"spline_closed", 1, 1, fixed<Type::boolean, Type::spline>, splineClosed},
        {"color_ramp", 2, 3, fixed<Type::vec3, Type::scalar, Type::stops, Type::string>, colorRamp}, {"curve", 2, 4, fixed<Type::scalar, Type::scalar, Type::points, Type::string, Type::string>, curveThrough},
        {"image_color", 2, 3, imageType<Type::vec3, true>, imageColor}, {"image_grey", 2, 3, imageType<Type::scalar, true>, imageGrey}, {"image_size", 1, 1, imageType<Type::vec2, false>, imageSize},
        {"image_range", 1, 1, imageType<Type::vec2, false>, [](S s, A a) -> R { return imageBounds(s, a, false); }},
        {"image_slope", 1, 1, imageType<Type::vec2, false>, [](S s, A a) -> R { return imageBounds(s, a, true); }},
    };
    return entries;
}
// clang-format on

}  // namespace

const Builtin* findBuiltin(std::string_view name) {
    static const auto index = [] {
        std::unordered_map<std::string_view, const Builtin*> all;
        for (const Builtin& entry : table()) all.emplace(entry.name, &entry);
        return all;
    }();
    const auto found = index.find(name);
    return found == index.end() ? nullptr : found->second;
}

std::vector<std::string> builtinNames() {
    std::vector<std::string> names;
    for (const Builtin& entry : table()) names.emplace_back(entry.name);
    std::sort(names.begin(), names.end());
    return names;
}

TypeResult arithmeticType(Type a, Type b, char operation) {
    const std::array<Type, 2> both = {a, b};
    TypeResult type = componentwiseType(both);
    if (a == Type::integer && b == Type::integer && operation != '/') return Type::integer;
    return type;
}

Value arithmetic(Lowering& state, char operation, const Value& a, const Value& b) {
    const Op op = operation == '+'   ? Op::add
                  : operation == '-' ? Op::subtract
                  : operation == '*' ? Op::multiply
                  : operation == '/' ? Op::divide
                                     : Op::truncatedModulo;
    const std::array<const Value*, 2> operands = {&a, &b};
    const int width = std::max(isVector(a.type) ? componentCount(a.type) : 1,
                               isVector(b.type) ? componentCount(b.type) : 1);
    Value result{vectorOf(width)};
    for (int i = 0; i < width; ++i)
        result.ids[i] = state.ir.add(op, component(*operands[0], i), component(*operands[1], i));
    if (a.type == Type::integer && b.type == Type::integer && operation != '/') result.type = Type::integer;
    return result;
}

std::optional<Type> commonType(Type a, Type b) {
    if (a == b) return a;
    if (isNumber(a) && isNumber(b))
        return a == Type::surface || b == Type::surface ? Type::surface : Type::scalar;
    if (isVector(a) && standsFor(b, a)) return a;
    if (isVector(b) && standsFor(a, b)) return b;
    return std::nullopt;
}

Result<Value> choose(Lowering& state, IrId condition, const Value& a, const Value& b) {
    const Type type = *commonType(a.type, b.type);
    Value x = *convert(state, a, type), y = *convert(state, b, type);
    if (type == Type::boolean) {  // in logic, so that a select is always a number
        const IrId yes = state.ir.add(Op::logicalAnd, condition, x.ids[0]);
        const IrId no = state.ir.add(Op::logicalAnd, state.ir.add(Op::logicalNot, condition), y.ids[0]);
        return scalar(state.ir.add(Op::logicalOr, yes, no), Type::boolean);
    }
    if (componentCount(type) == 0) {
        if (state.ir.isConstant(condition)) return state.ir.number(condition) != 0.0 ? x : y;
        if (x.text == y.text && x.points == y.points && x.image == y.image && x.spline == y.spline) return x;
        return Error{.message =
                         "texts, lists, images and splines can only be chosen by a condition that is known "
                         "when the graph "
                         "is compiled"};
    }
    for (int i = 0; i < componentCount(type); ++i)
        x.ids[i] = state.ir.add(Op::select, condition, x.ids[i], y.ids[i]);
    return x;
}

}  // namespace fw::language
