// libFuzzer: any bytes are read as the code of an expression. What compiles must evaluate at a point and over
// a box that holds it, the bounds containing the value; what is refused must be refused with a place.
//
//   cmake --preset fuzz && cmake --build --preset fuzz --target fuzz_language
//   build/fuzz/fuzz_language -max_total_time=60 -max_len=2048 -rss_limit_mb=500 -timeout=10
//   -dict=tests/fuzz/language.dict CORPUS

#include <cmath>
#include <cstdint>
#include <string_view>

#include "graph/evaluate/evaluate.h"
#include "graph/language/lower.h"
#include "tests/fuzz/require.h"

namespace {

bool isRefusal(const fw::Error& error) {
    return !error.message.empty() && error.codeLine > 0 && error.codeColumn > 0;
}

bool everyOperationIsFinite(const fw::Ir& ir, const fw::Point& point) {
    std::vector<double> values;
    for (fw::IrId id = 0; id < ir.size(); ++id) {
        const fw::IrNode& node = ir[id];
        double operands[fw::kMaxArity] = {};
        for (int i = 0; i < fw::opInfo(node.op).arity; ++i) operands[i] = values[node.operands[i]];
        values.push_back(id < 3                        ? point[id]
                         : node.op == fw::Op::constant ? node.number
                                                       : fw::opInfo(node.op).value(operands, ir.layer(node)));
        if (!std::isfinite(values.back())) return false;
    }
    return true;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, std::size_t size) {
    using namespace fw;
    const std::string_view code(reinterpret_cast<const char*>(data), size);
    language::Lowering state;
    state.time = state.ir.constant(0.25);
    // Loops and copies may cost what a user's may, but here only the last part of it.
    state.steps = language::kMaxSteps - 20'000;
    language::Value field{Type::scalar, {state.ir.add(Op::absolute, state.ir.position(0))}};
    language::Value vector = language::constantValue(state, Type::vec3, std::array{1.0, -2.0, 0.5});
    const Result<language::Value> whole =
        language::lowerText(state, code, {{"a", field}, {"v", vector}, {"s", language::emptySurface(state)}});
    if (!whole) {
        require(isRefusal(whole.error()), "an error has a message and a place in the code");
        return 0;
    }

    const int count = componentCount(whole->type);
    const Point point{0.3, -0.7, 1.1};
    const Box box{{0.25, -1.0, 1.0}, {0.5, -0.5, 1.25}};
    // Where an intermediate result is no number (x % 0, 0/0 of fields), comparisons of it have no meaning.
    if (!everyOperationIsFinite(state.ir, point)) return 0;
    for (int i = 0; i < count; ++i) {
        const IrId root = whole->ids[i];
        const double value = evaluate(state.ir, root, {}, point);
        const Interval range = evaluateInterval(state.ir, root, {}, box);
        // Bounds are rounded outward in steps that a long sum of large numbers can exceed.
        const double slack = 1e-6 * (1.0 + std::abs(value));
        if (std::isfinite(value) && std::abs(value) < 1e6)
            require(!(value < range.lo - slack) && !(value > range.hi + slack),
                    "the bounds over a box contain the value at a point of it");
    }
    return 0;
}
