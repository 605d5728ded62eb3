// libFuzzer: any bytes are read as the code of an expression, with glslang as the oracle: what compiles to a
// program must be GLSL that compiles.
//
//   cmake --preset fuzz && cmake --build --preset fuzz --target fuzz_language_glsl
//   build/fuzz/fuzz_language_glsl -max_total_time=60 -max_len=2048 -rss_limit_mb=1000 -timeout=20
//   -dict=tests/fuzz/language_glsl.dict CORPUS

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "graph/compile/compile.h"
#include "graph/emit/glsl.h"
#include "graph/language/lower.h"
#include "runtime/gpu/shader.h"
#include "tests/fuzz/require.h"
#include "tests/support/graph/expression_graph.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, std::size_t size) {
    using namespace fw;
    // No folder for caches: every text is compiled.
    static const bool uncached = unsetenv("XDG_CACHE_HOME") == 0 && unsetenv("HOME") == 0;
    (void)uncached;
    const std::string code(reinterpret_cast<const char*>(data), size);
    language::Lowering state;
    state.time = state.ir.constant(0.0);
    state.steps =
        language::kMaxSteps - 20'000;  // as fuzz/language.cpp: the last part of what a user's may cost
    if (!language::lowerText(state, code)) return 0;
    const Graph graph = test::expressionGraph(code);
    const Result<Program> program = compile(graph);
    // Larger ones say no more, and take glslang seconds.
    if (!program || program->ir.size() > 800) return 0;
    const std::string field = emitField(*program);
    const Result<Spirv> spirv = compileShader({.name = "field/evaluate.comp", .field = field});
    if (!spirv) std::fprintf(stderr, "%s\n%s\n", format(spirv.error()).c_str(), field.c_str());
    require(bool(spirv), "what compiles is GLSL that compiles");
    return 0;
}
