// Functions of the device that are off: intervals allow for it, so that no box with surface is dropped.
#include "runtime/gpu/precision.h"

#include <gtest/gtest.h>

#include "graph/compile/compile.h"
#include "graph/document/json.h"
#include "graph/emit/glsl.h"
#include "runtime/mesher/mesher.h"
#include "tests/support/gpu.h"

namespace fw::precision_test {

// As far off as Vulkan lets functions be, to either side by chance.
constexpr const char* kNoisy = R"(
float noiseOf(float x) {
    uint bits = floatBitsToUint(x) * 747796405u + 2891336453u;
    bits = (bits >> 15 ^ bits) * 277803737u;
    return float(bits >> 8) / 8388608.0 - 1.0;
}
float noisySine(float x) { return sin(x) + 4.88e-4 * noiseOf(x); }
vec2 noisySine(vec2 x) { return vec2(noisySine(x.x), noisySine(x.y)); }
float noisyArcTangent(float x) { return atan(x) * (1.0 + 4.88e-4 * noiseOf(x)); }
float noisyArcTangent(float y, float x) { return atan(y, x) * (1.0 + 4.88e-4 * noiseOf(x)); }
vec2 noisyArcTangent(vec2 y, vec2 x) { return vec2(noisyArcTangent(y.x, x.x), noisyArcTangent(y.y, x.y)); }
vec2 noisyArcTangent(vec2 x) { return vec2(noisyArcTangent(x.x), noisyArcTangent(x.y)); }
#define sin noisySine
#define atan noisyArcTangent
)";

constexpr float kSineError = 4.8829e-4f, kArcTangentError = 4.883e-4f;

/// The triangles of a field of this code, with intervals or with every sample taken.
std::vector<uint32_t> trianglesOf(const Device& device, const std::string& code, bool sparse) {
    const Result<Graph> graph = parseGraph(R"({"fieldwright": 1, "nodes": [
        {"id": "waves", "type": "expression", "code": ")" +
                                               code + R"("},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "waves"}}}]})",
                                           "waves", nullptr);
    if (!graph) throw SystemError(format(graph.error()));
    const Result<Program> program = compile(*graph);
    if (!program) throw SystemError(format(program.error()));
    MesherPipelines pipelines = createMesherPipelines(device, kNoisy + emitField(*program), false);
    MesherBuffers buffers;
    MesherConfig config;
    config.origin = glm::vec3(-1.0f);
    config.cellSize = glm::vec3(2.0f / 96);
    config.cells = glm::ivec3(96);
    config.sparse = sparse;
    const Result<MesherResult> result = runMesher(device, pipelines, buffers, config);
    if (!result) throw SystemError(format(result.error()));
    return downloadMesh(device, buffers, *result).indices;
}

// Its arc sine, of all, is off by up to 1.8e-4.
TEST(Precision, MesaSoftwareIsPrecise) {
    const Device& device = test::device();
    if (!device.software) GTEST_SKIP() << "a hardware device";
    const Precision found = measurePrecision(device);
    EXPECT_EQ(found.sine, 0.0f);
    EXPECT_LT(found.curves, 2.6e-4f);
}

struct NoisyDevice : testing::TestWithParam<const char*> {};

TEST_P(NoisyDevice, LosesNoSurface) {
    Result<Device> device = createDevice({.validation = true});
    ASSERT_TRUE(device);
    device->precision = {kSineError, kArcTangentError};
    const std::vector<uint32_t> all = trianglesOf(*device, GetParam(), false);
    EXPECT_GT(all.size(), 300u);
    EXPECT_EQ(trianglesOf(*device, GetParam(), true), all);
}

// Solids that are there only because the functions are off, or hardly there: specks far from each other.
INSTANTIATE_TEST_SUITE_P(Fields, NoisyDevice,
                         testing::Values("1.0003 - sin(7 * p.x + 3 * p.y + 5 * p.z)",
                                         "1.0002 - sin(3 * p.y + p.x * p.z)",
                                         "0.9998 + sin(40 * p.z + 3 * p.x + p.y)", "atan(p.x + 2) - 0.78575",
                                         "max(0.7857 - atan(1 + p.x * p.x + p.y * p.y), p.z)"));

}  // namespace fw::precision_test
