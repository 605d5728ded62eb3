// Whatever check() accepts compiles: random programs and mutations of known code, as documents, through
// glslang. No device runs them.
#include <gtest/gtest.h>

#include <cstdlib>

#include "graph/check/check.h"
#include "graph/compile/compile.h"
#include "graph/emit/glsl.h"
#include "graph/language/lower.h"
#include "runtime/gpu/shader.h"
#include "tests/support/gpu.h"
#include "tests/support/graph/random_code.h"

namespace fw::language_glsl_test {

/// The type of what the code gives; none if it is refused.
std::optional<Type> resultOf(const test::CodeText& code) {
    language::Lowering state;
    state.time = state.ir.constant(0.25);
    const auto inputs = test::inputValues(state, code.inputs);
    const Result<language::Value> value = language::lowerText(state, code.text, inputs);
    return value ? std::optional(value->type) : std::nullopt;
}

bool isOfTheWhole(const Error& error) {
    return error.message.find("not a number anywhere") != std::string::npos ||
           error.message.find("operations") != std::string::npos;
}

template <class Make>
void expectAcceptedCompiles(uint32_t seed, Make make) {
    const test::TemporaryCache cache;
    const int wanted = std::getenv("FIELDWRIGHT_LONG") ? 10'000 : 500;
    std::mt19937 random(seed);
    int compiled = 0, refused = 0;
    for (int tries = 0; compiled < wanted && tries < 10 * wanted; ++tries) {
        const test::CodeText code = make(random);
        const std::optional<Type> type = resultOf(code);
        if (!type) continue;
        const Graph graph = test::codeDocument(code, *type);
        const std::vector<Error> findings = check(graph);
        // At 0 s a divisor may be 0, which passes check().
        const Result<Program> program = compile(graph, {.time = 0.3});
        if (!program || hasErrors(findings)) {
            // What only the whole field tells stops compile() alone, and what is in range at 0 s may be out
            // of it later.
            ASSERT_TRUE(hasErrors(findings) || isOfTheWhole(program.error()) || compile(graph, {.time = 0.0}))
                << format(program.error()) << "\n"
                << code.text;
            ++refused;
            continue;
        }
        // Larger ones say no more, and take glslang seconds.
        if (program->ir.size() > 800) continue;
        const std::string field = emitField(*program);
        const Result<Spirv> spirv = compileShader({.name = "field/evaluate.comp", .field = field});
        ASSERT_TRUE(spirv) << format(spirv.error()) << "\n" << code.text << "\n" << field;
        ++compiled;
    }
    testing::Test::RecordProperty("refused", refused);
    EXPECT_EQ(compiled, wanted);
    EXPECT_LT(refused, wanted);
}

TEST(LanguageGlsl, RandomProgramsCompile) {
    expectAcceptedCompiles(3, [](std::mt19937& random) { return test::randomCode(random, false); });
}

TEST(LanguageGlsl, MutationsOfKnownCodeCompile) {
    const std::vector<test::CodeText>& known = test::knownCodes();
    expectAcceptedCompiles(
        4, [&](std::mt19937& random) { return test::mutated(known[random() % known.size()], random); });
}

}  // namespace fw::language_glsl_test
