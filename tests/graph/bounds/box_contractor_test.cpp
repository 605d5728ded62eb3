// Property tests of BoxContractor and frameCut() against sampled points, which share no code with them.
#include "graph/bounds/box_contractor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>

#include "graph/bounds/frame_cut.h"
#include "graph/language/lower.h"
#include "tests/support/graph/random_code.h"
#include "tests/support/graph/random_graph.h"
#include "tests/support/graph/solid_writer.h"

namespace fw::box_contractor_test {

bool isLong() { return std::getenv("FIELDWRIGHT_LONG") != nullptr; }

using test::SolidWriter;
using test::Source;

struct Field {
    Ir ir;
    IrId root = 0;
    std::vector<Interval> parameters;
    std::string name;

    std::optional<Box> contracted(double level, const Box& box) const {
        return BoxContractor(ir, parameters).contract(root, level, box);
    }
};

/// Evaluates by the operations' reference meanings. NaN where an intermediate value is too large or too small
/// for the comparison to hold in spite of rounding.
double valueAt(const Field& field, IrId root, std::span<const double> parameters, const Point& point) {
    static std::vector<double> values;
    values.resize(root + 1);
    for (IrId id = 0; id <= root; ++id) {
        const IrNode& node = field.ir[id];
        const OpInfo& info = opInfo(node.op);
        double operands[kMaxArity] = {};
        for (int i = 0; i < info.arity; ++i) operands[i] = values[node.operands[std::size_t(i)]];
        values[id] = id < 3                     ? point[id]
                     : node.op == Op::parameter ? parameters[std::size_t(node.number)]
                     : info.arity == 0          ? node.number
                                                : info.value(operands, field.ir.layer(node));
        const double size = std::abs(values[id]);
        if (size > 1e12 && !std::isnan(size) && info.arity > 0)
            return std::numeric_limits<double>::quiet_NaN();
    }
    return values[root];
}

/// A point inside the solid that a result leaves out.
struct Counterexample {
    Point point;
    std::vector<double> parameters;
    double value = 0.0;
};

bool holds(const Box& box, const Point& point, double slack = 0.0) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double size = slack * (1.0 + std::abs(point[axis]));
        if (point[axis] < box.lo[axis] - size || point[axis] > box.hi[axis] + size) return false;
    }
    return true;
}

/// Searches `within` for points with value <= level outside of `result`: at random, then by climbs outwards
/// from points inside.
std::optional<Counterexample> counterexample(const Field& field, IrId root, double level, const Box& within,
                                             const std::optional<Box>& result, Source& source, int samples) {
    std::vector<double> parameters(field.parameters.size());
    const double slack = 1e-9 * (1.0 + std::abs(level));
    const auto isInside = [&](const Point& point) {
        return holds(within, point) && valueAt(field, root, parameters, point) <= level - slack;
    };
    const auto disproves = [&](const Point& point) {
        if (result && holds(*result, point, 1e-9)) return false;
        // Single points and surfaces, where a field may be NaN, are not part of a solid.
        int neighbours = 0;
        for (int i = 0; i < 6; ++i) {
            Point near = point;
            for (std::size_t axis = 0; axis < 3; ++axis)
                if (within.lo[axis] < within.hi[axis])
                    near[axis] += 1e-8 * (1.0 + std::abs(near[axis])) * source.between(-1.0, 1.0);
            neighbours += isInside(near);
        }
        return neighbours >= 4;
    };
    for (int draw = 0; draw < 3; ++draw) {
        for (std::size_t i = 0; i < parameters.size(); ++i) {
            const Interval range = field.parameters[i];
            const double t = source.unit();
            parameters[i] = t < 0.25 ? range.lo : t < 0.5 ? range.hi : std::lerp(range.lo, range.hi, t);
        }
        std::optional<Box> found;
        std::array<Point, 6> extremes{};
        const auto take = [&](const Point& point) {
            if (!found) found = Box{point, point}, extremes.fill(point);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                if (point[axis] < found->lo[axis]) found->lo[axis] = point[axis], extremes[2 * axis] = point;
                if (point[axis] > found->hi[axis])
                    found->hi[axis] = point[axis], extremes[2 * axis + 1] = point;
            }
        };
        for (int n = 0; n < samples; ++n) {
            Point point;
            const bool isNear = n % 2 == 0 && result;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                point[axis] = source.coordinate();
                const double lo = std::max(within.lo[axis], -6e4), hi = std::min(within.hi[axis], 6e4);
                if (isNear && isBounded(Interval{result->lo[axis], result->hi[axis]})) {
                    const double size = result->hi[axis] - result->lo[axis];
                    point[axis] =
                        source.between(result->lo[axis] - 0.2 * size, result->hi[axis] + 0.2 * size);
                } else if (hi - lo < 20.0 && lo < hi) {
                    point[axis] = source.between(lo, hi);
                }
                point[axis] = std::clamp(point[axis], within.lo[axis], within.hi[axis]);
            }
            if (!isInside(point)) continue;
            if (disproves(point))
                return Counterexample{point, parameters, valueAt(field, root, parameters, point)};
            take(point);
        }
        if (!found) continue;
        for (int n = 0; n < samples; ++n) {
            const std::size_t side = std::size_t(n) % 6;
            Point point = extremes[side];
            const double step = std::pow(10.0, source.between(-4.0, 1.0));
            for (std::size_t axis = 0; axis < 3; ++axis)
                point[axis] += axis == side / 2 ? (side % 2 ? step : -step) * source.unit()
                                                : step * source.between(-1.0, 1.0);
            for (std::size_t axis = 0; axis < 3; ++axis)
                point[axis] =
                    std::clamp(point[axis], std::max(within.lo[axis], -6e4), std::min(within.hi[axis], 6e4));
            if (!isInside(point)) continue;
            if (disproves(point))
                return Counterexample{point, parameters, valueAt(field, root, parameters, point)};
            take(point);
        }
    }
    return std::nullopt;
}

std::string text(const std::optional<Box>& box) {
    if (!box) return "nothing";
    char line[300];
    std::snprintf(line, sizeof line, "(%.10g %.10g %.10g)..(%.10g %.10g %.10g)", box->lo[0], box->lo[1],
                  box->lo[2], box->hi[0], box->hi[1], box->hi[2]);
    return line;
}

/// False if a point disproves the result, which is then reported.
bool expectContains(const Field& field, double level, const Box& within, const std::optional<Box>& result,
                    Source& source, int samples, const char* call) {
    if (result) {
        EXPECT_TRUE(common(within, *result)) << field.name << ": " << call << " left the box";
        for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_LE(result->lo[axis], result->hi[axis]);
    }
    const auto wrong = counterexample(field, field.root, level, within, result, source, samples);
    if (!wrong) return true;
    char at[200];
    std::snprintf(at, sizeof at, "value %.10g <= %.10g at (%.10g, %.10g, %.10g)", wrong->value, level,
                  wrong->point[0], wrong->point[1], wrong->point[2]);
    std::string parameters;
    for (const double value : wrong->parameters) parameters += " " + std::to_string(value);
    ADD_FAILURE() << field.name << "\n"
                  << call << " of " << text(within) << " is " << text(result) << "\nbut has " << at
                  << (parameters.empty() ? "" : " with parameters" + parameters);
    return false;
}

Box randomBox(Source& source) {
    Box box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        double a = source.between(-5.0, 5.0), b = a + source.between(0.0, 6.0);
        if (source.chance(0.1)) b = a;
        if (source.chance(0.25)) a = -kHuge;
        if (source.chance(0.25)) b = kHuge;
        box.lo[axis] = a, box.hi[axis] = b;
    }
    return source.chance(0.4) ? kAllSpace : box;
}

/// Contracts several boxes with one contractor, and each with a fresh one.
bool expectSound(const Field& field, Source& source, int boxes, int samples) {
    BoxContractor reused(field.ir, field.parameters);
    reused.setLimit(20'000'000);
    bool isSound = true;
    for (int n = 0; n < boxes && isSound; ++n) {
        const Box box = n == 0 ? kAllSpace : randomBox(source);
        double level = 0.0;
        if (n > 0 && source.chance(0.4)) {
            std::vector<double> parameters;
            for (const Interval range : field.parameters) parameters.push_back(range.lo);
            Point point;
            for (std::size_t axis = 0; axis < 3; ++axis)
                point[axis] = std::clamp(source.coordinate(), box.lo[axis], box.hi[axis]);
            const double value = valueAt(field, field.root, parameters, point);
            level = std::abs(value) < 1e6 ? value : 0.0;
        }
        enum class Call : unsigned char { plain, thorough, exhaustive };
        const Call kind = source.chance(0.3)   ? Call::thorough
                          : source.chance(0.4) ? Call::exhaustive
                                               : Call::plain;
        const auto contract = [&](BoxContractor& contractor) {
            return kind == Call::plain ? contractor.contract(field.root, level, box)
                   : kind == Call::thorough
                       ? contractor.contractThoroughly(field.root, level, box)
                       : contractor.contractExhaustively(field.root, level, box, 300'000);
        };
        const char* call = kind == Call::plain      ? "contract()"
                           : kind == Call::thorough ? "contractThoroughly()"
                                                    : "contractExhaustively()";
        const std::optional<Box> again = contract(reused);
        BoxContractor fresh(field.ir, field.parameters);
        fresh.setLimit(20'000'000);
        const std::optional<Box> result = contract(fresh);
        // A reused contractor remembers bounds, so the limit of an exhaustive call reaches further.
        if (reused.steps() < 20'000'000 && kind != Call::exhaustive) {
            EXPECT_TRUE(result == again) << field.name << "\n"
                                         << call << " of " << text(box) << " at level " << level << ": fresh "
                                         << text(result) << ", reused " << text(again);
            isSound = result == again;
        }
        isSound = expectContains(field, level, box, result, source, samples, call) && isSound;
        if (!(result == again))
            isSound =
                expectContains(field, level, box, again, source, samples, "a reused contractor's") && isSound;
    }
    // Each point of the solid is in the box of a part that holds it.
    const std::vector<BoxContractor::Part> parts =
        BoxContractor(field.ir, field.parameters).parts(field.root);
    std::optional<Box> all;
    for (const BoxContractor::Part& part : parts) all = all ? joined(*all, part.box) : part.box;
    return expectContains(field, 0.0, kAllSpace, all, source, samples, "parts()") && isSound;
}

std::optional<Field> lowered(const test::CodeText& code, Interval time) {
    language::Lowering state;
    state.time = state.ir.parameter(0);
    const auto inputs = test::inputValues(state, code.inputs);
    const auto value = language::lowerText(state, code.text, inputs);
    if (!value || componentCount(value->type) == 0) return std::nullopt;
    std::array<IrId, 1> root{value->ids[0]};
    Field field{.ir = state.ir.compact(root), .root = 0, .parameters = {time}, .name = code.text};
    field.root = root[0];
    if (field.ir.size() > 600) return std::nullopt;
    if (field.ir.size() < 40) field.name += "\n" + field.ir.text(root);
    return field;
}
Field fieldOf(const std::string& code, Interval time = {0.25, 0.25}) {
    auto field = lowered({code, {}}, time);
    EXPECT_TRUE(field) << code;
    return field ? std::move(*field) : Field{};
}

/// Random operations on the position, constants and two parameters that are intervals.
Field randomField(Source& source) {
    Field field;
    Ir& ir = field.ir;
    for (int i = 0; i < 2; ++i) {
        const double lo = source.between(-3.0, 3.0);
        field.parameters.push_back({lo, source.chance(0.3) ? lo : lo + source.between(0.0, 4.0)});
    }
    std::vector<IrId> numbers{0, 1, 2, ir.parameter(0), ir.parameter(1)}, truths;
    const auto any = [&](const std::vector<IrId>& ids) {
        // Recent ones more often.
        const double t = source.unit();
        return ids[std::size_t((1.0 - t * t) * double(ids.size() - 1) + 0.5)];
    };
    const auto number = [&] {
        return source.chance(0.2) ? ir.constant(std::round(source.between(-40.0, 40.0)) / 10.0)
                                  : any(numbers);
    };
    const std::array frequent{Op::add,      Op::subtract, Op::multiply, Op::minimum,    Op::maximum,
                              Op::absolute, Op::square,   Op::add,      Op::squareRoot, Op::maximum};
    const int count = 6 + int(source.random() % 30);
    for (int n = 0; n < count; ++n) {
        const Op op = source.chance(0.65)
                          ? frequent[source.random() % frequent.size()]
                          : Op(int(Op::negate) + int(source.random() % (int(Op::image) - int(Op::negate))));
        const OpInfo& info = opInfo(op);
        std::array<IrId, kMaxArity> operands{};
        bool possible = true;
        for (int i = 0; i < info.arity; ++i) {
            const bool boolean = (op == Op::select && i == 0) || op == Op::logicalNot ||
                                 op == Op::logicalAnd || op == Op::logicalOr;
            possible = possible && (!boolean || !truths.empty());
            if (possible) operands[std::size_t(i)] = boolean ? any(truths) : number();
        }
        if (!possible) continue;
        const IrId id = ir.add(op, std::span(operands).first(std::size_t(info.arity)));
        (info.boolean ? truths : numbers).push_back(id);
    }
    IrId root = numbers.back();
    if (source.chance(0.5)) root = ir.add(Op::subtract, ir.add(Op::absolute, root), ir.constant(2.0));
    std::array<IrId, 1> roots{root};
    field.ir = ir.compact(roots);
    field.root = roots[0];
    field.name = field.ir.text(roots);
    for (std::size_t i = 0; i < 2; ++i)
        field.name += " [" + std::to_string(field.parameters[i].lo) + ", " +
                      std::to_string(field.parameters[i].hi) + "]";
    return field;
}

TEST(BoxContractorProperty, HoldsRandomOperations) {
    Source source{std::mt19937_64(1)};
    int failures = 0;
    for (int n = 0, count = isLong() ? 20'000 : 400; n < count && failures < 5; ++n) {
        SCOPED_TRACE("field " + std::to_string(n));
        failures += !expectSound(randomField(source), source, 4, 150);
    }
}

TEST(BoxContractorProperty, HoldsRandomCode) {
    std::mt19937 random(5);
    Source source{std::mt19937_64(2)};
    int tried = 0, failures = 0;
    const int count = isLong() ? 4000 : 60;
    for (int n = 0; tried < count && n < 10 * count && failures < 5; ++n) {
        const auto field = lowered(test::randomCode(random, false), {0.0, source.between(0.0, 2.0)});
        if (!field) continue;
        ++tried;
        failures += !expectSound(*field, source, 3, 100);
    }
    EXPECT_GE(tried, failures ? 0 : count / 2);
}

TEST(BoxContractorProperty, HoldsRandomGraphs) {
    Source source{std::mt19937_64(3)};
    int failures = 0;
    for (uint32_t seed = 1; seed <= (isLong() ? 1000u : 30u) && failures < 5; ++seed) {
        auto program = test::randomProgram(seed, 5);
        if (!program || program->ir.size() > 600) continue;
        Field field{.ir = std::move(program->ir), .root = program->distance(), .parameters = {}, .name = {}};
        field.name = "random graph " + std::to_string(seed);
        for (const LiveParameter& live : program->live) field.parameters.push_back({live.value, live.value});
        failures += !expectSound(field, source, 3, 60);
    }
}

TEST(BoxContractorProperty, HoldsRandomSolids) {
    Source source{std::mt19937_64(9)};
    int failures = 0, refused = 0;
    const int count = isLong() ? 8000 : 500;
    for (int n = 0; n < count && failures < 5; ++n) {
        SolidWriter writer{source};
        const std::string root = writer.solid(int(source.random() % 4));
        const double lo = source.between(-2.0, 1.0);
        const auto field = lowered({writer.code + "return " + root + ";", {}},
                                   {lo, source.chance(0.4) ? lo : lo + source.between(0.0, 3.0)});
        refused += !field;
        if (field) failures += !expectSound(*field, source, 3, 120);
    }
    EXPECT_LT(refused, count / 10);
}

TEST(BoxContractorProperty, HoldsCodes) {
    Source source{std::mt19937_64(4)};
    for (const char* code : {
             "return twist(box(p - vec3(1, 0, 0), vec3(0.5, 1, 0.2)), 90);",
             "return bend(box(p, vec3(1, 0.2, 0.3)), 40);",
             "return repeat(sphere(p, 0.3), vec3(2));",
             "return mirror(sphere(p - vec3(2, 1, 0), 0.7), vec3(1, 0, 0));",
             "return max(repeat(sphere(p, 0.3), vec3(1)), box(p, vec3(2)));",
             "return abs(abs(abs(p.x) - 3) - 1) + abs(p.y + p.x) + abs(p.z) - 0.4;",
             "q = vec3(0.8 * p.x + 0.6 * p.y, 0.8 * p.y - 0.6 * p.x, p.z); return max(abs(q.x) - 1, "
             "max(abs(q.y) - 2, abs(q.z) - 3));",
             "q = vec3(0.8 * abs(p.x) + 0.6 * p.y, 0.8 * p.y - 0.6 * abs(p.x), p.z); return length(q - "
             "vec3(2, 1, 0)) - 1;",
             "a = 0.7 * p.y; q = vec3(p.x * cos(a) + p.z * sin(a), p.y, p.z * cos(a) - p.x * sin(a)); return "
             "length(max(abs(q - vec3(1, 0, 0)) - vec3(0.5, 2, 0.3), 0)) - 0.1;",
             "return 0.2 - 1 / (1 + dot(p, p)) - 1 / (1 + dot(p - vec3(3, 0, 0), p - vec3(3, 0, 0)));",
             "return 0.3 - exp(-dot(p, p)) - exp(-dot(p - vec3(2, 1, 0), p - vec3(2, 1, 0)));",
             "return p.x * p.x * p.x * p.x + p.y * p.y * p.y * p.y + p.z * p.z * p.z * p.z - 5 * p.x * p.y - "
             "3;",
             "return (dot(p, p) + 3) * (dot(p, p) + 3) - 16 * (p.x * p.x + p.y * p.y);",
             "return max(length(p) - 2, 0.2 * perlin(p * 2) - 0.05);",
             "return length(p) - 1.5 + 0.3 * perlin(p * 3);",
             "return smooth_min(smooth_min(length(p) - 1, length(p - vec3(2, 0, 0)) - 1, 0.5), p.y * p.y + "
             "abs(p.x) + abs(p.z) - 0.3, 0.8);",
             "return (p.x > 1 ? length(p - vec3(2, 0, 0)) : length(p + vec3(2, 0, 0))) - 1.5;",
             "return p.x > p.y ? length(p) - 1 : abs(p.x) + abs(p.y) + abs(p.z) - 2;",
             "return min(length(p - vec3(4, 2, 3)) - 1, max(p.x / p.y - 1, length(p) - 2));",
             "return max(0 / max(p.x, 0), length(p) - 1);",
             "return min(0 / max(p.x, 0), length(p) - 1);",
             "return abs(p.x + 3 * sin(p.y)) + abs(p.y) + abs(p.z - p.x) - 1;",
             "return max(atan(p.y, p.x) - 1, length(p) - 2);",
             "return pow(abs(p.x), 2.5) + pow(abs(p.y), 0.5) + pow(abs(p.z), 3) - 2;",
             "return mod(p.x, 2) - 1 + dot(p, p) * 0.1;",
             "return max(abs(floor(p.x)) - 1, max(abs(round(p.y)) - 2, abs(ceil(p.z)) - 1));",
             "return p.x * p.y - 1;",
             "return max(p.x * p.y - 1, max(max(-p.x, -p.y), abs(p.z) + p.x + p.y - 3));",
         }) {
        SCOPED_TRACE(code);
        const auto field = lowered({code, {}}, {0.25, 0.25});
        EXPECT_TRUE(field);
        if (field) expectSound(*field, source, isLong() ? 60 : 8, 300);
    }
}

TEST(BoxContractorProperty, HoldsForAllValuesOfParameters) {
    Source source{std::mt19937_64(6)};
    for (const char* code : {
             "return length(p - vec3(time, 0, 0)) - 1;",
             "return box(p - vec3(time, 2 * time, 0), vec3(1, time + 3, 1));",
             "return max(time, length(p) - 1);",
             "return max(abs(p.x) - time, max(abs(p.y) - 1, abs(p.z) - 1));",
             "return time * (length(p) - 1);",
             "return (length(p) - 1) / (time + 4) - 0.2 * time;",
             "return twist(box(p, vec3(0.5, 1, 0.2)), 30 * time);",
             "q = vec3(p.x * cos(time) + p.y * sin(time), p.y * cos(time) - p.x * sin(time), p.z); return "
             "box(q, vec3(1, 2, 0.5));",
             "return smooth_min(length(p) - 1, length(p - vec3(2, 0, 0)) - 1, time + 3);",
         }) {
        SCOPED_TRACE(code);
        for (int n = 0; n < 3; ++n) {
            const double lo = source.between(-2.0, 2.0);
            expectSound(fieldOf(code, {lo, lo + source.between(0.0, 4.0)}), source, isLong() ? 60 : 5, 200);
        }
    }
}

void expectSoundCode(const std::string& code, Interval time = {0.25, 0.25}) {
    Source source{std::mt19937_64(7)};
    expectSound(fieldOf(code, time), source, 6, 1000);
}

TEST(BoxContractor, TurnsSolidsThatAParameterMoves) {
    expectSoundCode(
        "x = p.x - time; return max(abs(0.8 * x + 0.6 * p.y), max(abs(0.8 * p.y - 0.6 * x), abs(p.z))) - 1;",
        {0.0, 10.0});
}
TEST(BoxContractor, ReplacesMinimaOfParameters) {
    expectSoundCode(
        "m = max(p.x, time); return max(abs(0.8 * m + 0.6 * p.y), max(abs(0.8 * p.y - 0.6 * m), "
        "abs(p.z) + abs(p.x))) - 9;",
        {0.0, 10.0});
}
TEST(BoxContractor, KeepsParametersFromOneOperandToTheNext) {
    expectSoundCode(
        "return min(max(time, length(p) - 0.1), max(abs(p.x - time), max(abs(p.y), abs(p.z))) - 1);",
        {-0.5, 3.0});
}
TEST(BoxContractor, BlendsOfNegativeWidthAreSharp) {
    expectSoundCode("return smooth_min(length(p) - 1, length(p - vec3(5, 0, 0)) - 1, -2);");
    expectSoundCode("return smooth_min(length(p) - 1, length(p - vec3(5, 0, 0)) - 1, time);", {-3.0, -2.0});
}
TEST(BoxContractor, BlendsOfBlends) {
    // A balanced tree of smooth minima of equal operands is lower than a chain of them.
    std::vector<std::string> terms;
    for (int i = 0; i < 64; ++i)
        terms.push_back("(length(p - vec3(" + std::to_string(i * 1e-4) + ", 0, 0)) - 1)");
    while (terms.size() > 1) {
        std::vector<std::string> next;
        for (std::size_t i = 0; i < terms.size(); i += 2)
            next.push_back("smooth_min(" + terms[i] + ", " + terms[i + 1] + ", 1)");
        terms = next;
    }
    expectSoundCode("return " + terms[0] + ";");
}
TEST(BoxContractor, NearlyParallelCoordinates) {
    expectSoundCode("return max(abs(p.x + 0.000000000008 * p.y), abs(p.z)) - 1;");
}

TEST(BoxContractor, ConstantsBeyondTheLargestEnd) {
    for (const char* code : {
             "return 0.5 * min(1e38, length(p) - 1) + 0.1 * sin(p.x);",
             "return abs(min(1e38, length(p) - 1) + p.x) - 2;",
             "return p.x + 0.1 * sin(p.y) + (p.y < 1e38 ? 1 : 2);",
             "return length(p) - 1 + 0.1 * sin(max(p.x, -1e38));",
             "return abs(p.x + (p.y > 1e38 ? 3 : 1)) + abs(p.y) + abs(p.z) - 2;",
         })
        expectSoundCode(code);
}
TEST(BoxContractor, MinimaWithConstants) {
    expectSoundCode("q = min(p * p.z, vec3(0)); return length(q) - 1;");
    expectSoundCode("q = min(p, vec3(0)); return length(q) - 1;");
    expectSoundCode("s = trunc(length(p) - 1); q = min(vec3(s), vec3(0)); return length(q) - 1;");
    expectSoundCode(
        "q = p.x < 3 ? vec3(0.75) : p; q = min(min(q, vec3(trunc(length(p) - 1))), min(p * p.z, vec3(0))); "
        "return "
        "length(q) - 1;");
    expectSoundCode("q = min(p, vec3(mod(0 * p.x, 2))); return length(q) - 1;");
    expectSoundCode("float d = min(length(p) - 1, 0.0 / max(p.x, 0)); return length(min(p, vec3(d))) - 1;");
}
TEST(BoxContractor, RootsOfHugeValues) {
    const Field field =
        fieldOf("x = p.x * p.x; x = x * x * p.x; return 100000000000000000000.0 - sqrt(x * x);");
    const Box box{{5e4, 0, 0}, {6e4, 1, 1}};
    EXPECT_LT(field.ir.size(), 40u);
    std::vector<double> none{0.25};
    EXPECT_TRUE(field.contracted(0.0, box)) << "but it is negative there";
}
TEST(BoxContractor, BlendsOfUnboundedWidth) {
    const Field field =
        fieldOf("return smooth_min(length(p) - 1, length(p - vec3(3, 0, 0)) - 1, p.x * p.x);");
    const auto box = field.contracted(0.0, kAllSpace);
    ASSERT_TRUE(box);
    EXPECT_FALSE(isBounded(*box)) << text(box);
}

TEST(FrameCut, SeparatesTheRootFromTheVariables) {
    Source source{std::mt19937_64(8)};
    int cuts = 0;
    for (int n = 0, count = isLong() ? 20'000 : 1000; n < count; ++n) {
        const Field field = randomField(source);
        const Ir& ir = field.ir;
        const auto isNumber = [&](IrId id) { return ir[id].positions == 0; };
        std::vector<IrId> variables{0, 1, 2};
        if (isNumber(field.root) || field.root < 3) continue;
        const auto walk = [&](std::span<const IrId> removed, std::vector<IrId>& cone) {
            std::vector<bool> seen(ir.size());
            std::vector<IrId> pending{field.root};
            bool reaches = false;
            while (!pending.empty()) {
                const IrId id = pending.back();
                pending.pop_back();
                if (isNumber(id) || seen[id] || std::ranges::find(removed, id) != removed.end()) continue;
                seen[id] = true;
                if (id < 3) {
                    reaches = true;
                    continue;
                }
                cone.push_back(id);
                for (int i = 0; i < opInfo(ir[id].op).arity; ++i)
                    pending.push_back(ir[id].operands[std::size_t(i)]);
            }
            std::ranges::sort(cone);
            return reaches;
        };
        std::vector<IrId> cone, rest;
        ASSERT_TRUE(walk({}, cone));
        const auto operandsOf = [&](IrId id) {
            std::vector<IrId> operands;
            for (int i = 0; i < opInfo(ir[id].op).arity; ++i)
                if (const IrId operand = ir[id].operands[std::size_t(i)]; !isNumber(operand))
                    operands.push_back(operand);
            return operands;
        };
        const CutSide side = n % 2 ? CutSide::root : CutSide::variables;
        const auto mayCut = [&](IrId id) { return n % 3 > 0 || id % 4 > 0; };
        const std::vector<IrId> cut = frameCut(cone, variables, side, operandsOf, mayCut);
        ASSERT_LE(cut.size(), 3u);
        if (cut.empty()) continue;
        ++cuts;
        EXPECT_EQ(std::ranges::count(cut, field.root), 0);
        EXPECT_TRUE(std::ranges::all_of(cut, mayCut));
        EXPECT_FALSE(walk(cut, rest)) << field.name;
        // No vertex of the cut is superfluous.
        for (std::size_t i = 0; i < cut.size(); ++i) {
            std::vector<IrId> fewer = cut;
            fewer.erase(fewer.begin() + std::ptrdiff_t(i));
            EXPECT_TRUE(walk(fewer, rest)) << field.name;
        }
    }
    EXPECT_GT(cuts, 50);
}

}  // namespace fw::box_contractor_test
