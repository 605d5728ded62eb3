// The text that a program is emitted as, where it matters what is in it; what it computes is tested on the
// device.
#include <gtest/gtest.h>

#include <stdexcept>

#include "graph/compile/compile.h"
#include "graph/emit/glsl.h"
#include "tests/support/graph/expression_graph.h"

namespace fw::emit_test {

std::string textOf(const std::string& code) {
    const Result<Program> program = compile(test::expressionGraph(code));
    if (!program) throw std::runtime_error(format(program.error()));
    return emitField(*program);
}

/// The lines from the one that begins the function to the one that ends it.
std::string functionIn(const std::string& text, const std::string& head) {
    const std::size_t begin = text.find(head);
    if (begin == std::string::npos) return {};
    return text.substr(begin, text.find("\n}\n", begin) - begin);
}

int countOf(const std::string& part, const std::string& text) {
    int count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
    return count;
}

TEST(Emit, AGradientSamplesEachNoiseOnce) {
    for (const std::string noise : {"perlin", "simplex", "worley"}) {
        const std::string text = textOf("return p.y + " + noise + "(p * 2, 1) + " + noise + "(p, 2);");
        EXPECT_EQ(countOf("oise", functionIn(text, "vec4 fieldGradient(")), 2) << text;
    }
}

TEST(Emit, RowsGoAlongTheAxisThatSavesMost) {
    const auto along = [](const std::string& place) {
        const std::string text = textOf("q = " + place +
                                        ";\nd = length(q.xy) - 1;\nfor (int i = 1; i < 9; i++) d = max(d, "
                                        "length(q.xy - vec2(i, 0)) - i);\n"
                                        "return max(d, abs(q.z) - 0.3);");
        const std::size_t at = text.find("#define FIELD_ALONG ");
        return at == std::string::npos ? '-' : text[at + 20];
    };
    EXPECT_EQ(along("p"), '2');      // an extrusion along z
    EXPECT_EQ(along("p.zyx"), '0');  // along x
    EXPECT_EQ(along("p.xzy"), '-');  // along y, as it is without
    EXPECT_EQ(textOf("return length(p) - 1;").find("FIELD_ALONG"), std::string::npos);
}

}  // namespace fw::emit_test
