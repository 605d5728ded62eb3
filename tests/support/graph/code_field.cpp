#include "tests/support/graph/code_field.h"

#include <gtest/gtest.h>

#include <array>
#include <utility>

#include "graph/language/lower.h"

namespace fw::test {

CodeField fieldOfCode(const std::string& code, double time) {
    language::Lowering state;
    state.time = state.ir.constant(time);
    const auto value = language::lowerText(state, code);
    EXPECT_TRUE(value) << format(value.error());
    std::array<IrId, 1> root{value->ids[0]};
    Ir ir = state.ir.compact(root);
    return {std::move(ir), root[0]};
}

}  // namespace fw::test
