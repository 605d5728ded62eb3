// Warnings of numbers beyond single precision, for solids of which it makes others.
#include "graph/compile/single_precision.h"

#include <gtest/gtest.h>

#include "graph/bounds/region.h"
#include "graph/compile/compile.h"
#include "graph/document/json.h"

namespace fw::single_precision_test {

std::optional<Error> lossOf(const std::string& code) {
    const Result<Graph> graph =
        parseGraph(R"({"fieldwright": 1, "nodes": [{"id": "e", "type": "expression", "code": ")" + code +
                       R"("}, {"id": "out", "type": "output", "inputs": {"surface": {"from": "e"}}}]})",
                   "test", nullptr);
    EXPECT_TRUE(graph);
    const Result<Program> program = compile(*graph);
    EXPECT_TRUE(program);
    const Region region = findRegion(*program);
    EXPECT_EQ(region.extent, Extent::bounded);
    return precisionLoss(*graph, *program, padded(region.box, 64, 1.5));
}

TEST(PrecisionLoss, WarnsWhereTheSolidIsAnotherOne) {
    for (const char* code : {
             "return pow(pow(abs(p.x),16)+pow(abs(p.y),16)+pow(abs(p.z),16),1/16.0)-300;",
             "return pow(pow(abs(p.x),40)+pow(abs(p.y),40)+pow(abs(p.z),40),1/40.0)-10;",
             "return min(length(p-vec3(30,0,0))-5, -log(exp(-32*(length(p)-10)))/32+3);",
             "return min(length(p-vec3(30,0,0))-5, dot(p*1e-25,p*1e-25)-1e-50);",
         }) {
        const std::optional<Error> loss = lossOf(code);
        ASSERT_TRUE(loss) << code;
        EXPECT_EQ(loss->severity, Error::Severity::warning);
        EXPECT_EQ(loss->node, "e");
        EXPECT_NE(loss->message.find("beyond single precision"), std::string::npos) << loss->message;
    }
}

TEST(PrecisionLoss, IsSilentWhereItIsTheSame) {
    for (const char* code : {
             "return length(p) - 1;",
             "return pow(pow(abs(p.x),16)+pow(abs(p.y),16)+pow(abs(p.z),16),1/16.0)-3;",
             // Too large at the corners of the box alone, where it stays outside.
             "return pow(pow(abs(p.x),40)+pow(abs(p.y),40)+pow(abs(p.z),40),1/40.0)-8;",
             "return length(p) - 1 + exp(-400 * dot(p, p)) * 1e-30;",
             "return min(length(p) - 1, 1e30);",
         })
        EXPECT_FALSE(lossOf(code)) << code;
}

}  // namespace fw::single_precision_test
