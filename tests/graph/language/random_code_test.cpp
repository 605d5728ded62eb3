// Random programs of the field language: each is refused at a place, or means at a point what it means where
// the point is a constant.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>

#include "graph/evaluate/evaluate.h"
#include "graph/language/lower.h"
#include "graph/language/resolve.h"
#include "tests/support/graph/random_code.h"

namespace fw::random_code_test {

using language::Lowering;
using language::Value;

struct Meaning {
    Lowering state;
    Result<Value> value = Error{};

    std::vector<double> at(const Point& point) const {
        const std::span<const IrId> roots(value->ids.data(), std::size_t(componentCount(value->type)));
        return evaluate(state.ir, roots, {}, point);
    }
};

Meaning meaning(const test::CodeText& code, const std::string& before) {
    Meaning made;
    made.state.time = made.state.ir.constant(0.25);
    const auto inputs = test::inputValues(made.state, code.inputs);
    made.value = language::lowerText(made.state, before + code.text, inputs);
    return made;
}

/// The largest number that an operation gives; none if one gives no number, or is decided by the sign of a
/// zero, which constants do not have, or is a power of a negative number, which only constant exponents have.
std::optional<double> largestValue(const Ir& ir, const Point& point) {
    std::vector<double> values;
    double largest = 0.0;
    for (IrId id = 0; id < ir.size(); ++id) {
        const IrNode& node = ir[id];
        double operands[kMaxArity] = {};
        for (int i = 0; i < opInfo(node.op).arity; ++i) operands[i] = values[node.operands[i]];
        values.push_back(id < 3                    ? point[id]
                         : node.op == Op::constant ? node.number
                                                   : opInfo(node.op).value(operands, ir.layer(node)));
        if (!std::isfinite(values.back())) return std::nullopt;
        if (node.op == Op::arcTangent2 && operands[0] == 0.0) return std::nullopt;
        if (node.op == Op::power && operands[0] < 0.0) return std::nullopt;
        largest = std::max(largest, std::abs(values.back()));
    }
    return largest;
}

bool near(const std::vector<double>& a, const std::vector<double>& b, double rounding = 0.0) {
    for (std::size_t i = 0; i < a.size(); ++i)
        if (!(std::abs(a[i] - b[i]) <= 1e-6 * (1.0 + std::abs(a[i])) + rounding)) return false;
    return true;
}

/// With the position stored as a constant, conditions are known that were not: branches are taken that both
/// ran, loops are left that went on. The bounds over a box hold what is found in it.
void expectConstantsAgree(const test::CodeText& code, const Meaning& whole, const Point& point,
                          int& compared) {
    const std::optional<double> largest = largestValue(whole.state.ir, point);
    if (!largest) return;
    const std::vector<double> values = whole.at(point);
    const Box box{{point[0] - 0.05, point[1] - 0.03, point[2] - 0.04},
                  {point[0] + 0.02, point[1] + 0.05, point[2] + 0.01}};
    for (std::size_t i = 0; i < values.size(); ++i) {
        const Interval range = evaluateInterval(whole.state.ir, whole.value->ids[i], {}, box);
        const double slack = 1e-6 * (1.0 + std::abs(values[i]));
        EXPECT_FALSE(std::abs(values[i]) < 1e6 &&
                     (values[i] < range.lo - slack || values[i] > range.hi + slack))
            << "component " << i << ": " << values[i] << " outside " << range.lo << " .. " << range.hi << "\n"
            << code.text;
    }
    // Where a value jumps, rounding decides on which side it is.
    const double step = 1e-9;
    if (!near(values, whole.at({point[0] + step, point[1] - step, point[2] + step}))) return;
    char before[160];
    std::snprintf(before, sizeof before, "p = vec3(%.17g, %.17g, %.17g);\n", point[0], point[1], point[2]);
    const Meaning constant = meaning(code, before);
    if (!constant.value) return;  // an index or a divisor that is now seen to be wrong
    if (constant.value->type != whole.value->type) return;
    // What remains of a division of 1e52 is noise, and what divides by that may be no number on one side
    // alone.
    if (*largest > 1e15 && !largestValue(constant.state.ir, point)) return;
    // Of two numbers that nearly cancel each other their last digits are left: of 1e38 those are 1e22.
    EXPECT_TRUE(near(values, constant.at(point), 1e-14 * *largest))
        << code.text << "\nat " << before << "is " << constant.at(point)[0] << ", not " << values[0];
    ++compared;
}

using language::Instruction;

bool callsFields(const language::Code& code, bool own);

/// Whether the node evaluates an input elsewhere.
bool callsFields(const NodeType& type) {
    static std::map<const NodeType*, bool> known;
    const auto found = known.find(&type);
    if (found != known.end()) return found->second;
    language::Declared declared{.outputs = type.outputs};
    for (const InputSpec& input : type.inputs) declared.inputs.emplace_back(input.name, input.type);
    const language::Resolved resolved = language::resolve(type.body, declared);
    return known[&type] = !resolved.code || callsFields(*resolved.code, true);
}

/// Whether the code, where `own`, or a node that it calls asks for a field elsewhere: of what is constant
/// where the position is, that is another field.
bool callsFields(const language::Code& code, bool own) {
    for (const language::CodeFunction& function : code.functions)
        for (const Instruction& i : function.instructions)
            if (own && i.kind == Instruction::Kind::elsewhere) return true;
    return std::ranges::any_of(code.nodes, [](const NodeType* type) { return callsFields(*type); });
}

bool callsFields(const test::CodeText& code, bool own) {
    language::Declared declared;
    for (const test::CodeInput& input : code.inputs) declared.inputs.emplace_back(input.name, input.type);
    return callsFields(*language::resolve(code.text, declared).code, own);
}

/// `inputsAlone`: what is called as a field is an input in all of these programs.
template <class Make>
void expectSound(uint32_t seed, bool inputsAlone, Make make) {
    const int programs = std::getenv("FIELDWRIGHT_LONG") ? 10'000 : 500;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> coordinate(-1.5, 1.5);
    int accepted = 0, compared = 0;
    for (int i = 0; i < programs; ++i) {
        const test::CodeText code = make(random);
        const Meaning whole = meaning(code, "");
        if (!whole.value) {
            const Error& error = whole.value.error();
            EXPECT_TRUE(!error.message.empty() && error.codeLine > 0 && error.codeColumn > 0)
                << format(error) << "\n"
                << code.text;
            continue;
        }
        ++accepted;
        if (callsFields(code, !inputsAlone)) continue;
        const int points = whole.state.ir.size() < 2000 ? 20 : 2;
        for (int k = 0; k < points; ++k) {
            const Point point{coordinate(random), coordinate(random), coordinate(random)};
            expectConstantsAgree(code, whole, point, compared);
        }
        if (testing::Test::HasFailure()) break;
    }
    testing::Test::RecordProperty("accepted", accepted);
    testing::Test::RecordProperty("compared", compared);
    EXPECT_GT(accepted, programs / 5);
    EXPECT_GT(compared, programs);
}

TEST(RandomCode, ProgramsMeanTheSameWhereThePointIsAConstant) {
    expectSound(1, true, [](std::mt19937& random) { return test::randomCode(random, true); });
}

TEST(RandomCode, MutationsOfKnownCodeMeanTheSameWhereThePointIsAConstant) {
    const std::vector<test::CodeText>& known = test::knownCodes();
    expectSound(2, false,
                [&](std::mt19937& random) { return test::mutated(known[random() % known.size()], random); });
}

TEST(RandomCode, KnownCodesAreAccepted) {
    for (const test::CodeText& code : test::knownCodes()) {
        const Meaning whole = meaning(code, "");
        EXPECT_TRUE(whole.value) << format(whole.value.error()) << "\n" << code.text;
    }
}

}  // namespace fw::random_code_test
