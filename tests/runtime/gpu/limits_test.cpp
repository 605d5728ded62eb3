// Devices with less than the one that tests run on: every limit lowered to what Vulkan 1.3 guarantees and
// below, and without what is merely liked. What is made there must be what is made with all of it, to the
// bit, or refused with words of what would fit.
#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>

#include "graph/document/json.h"
#include "runtime/play/player.h"
#include "tests/support/gpu.h"

namespace fw::limits_test {

using Lower = std::function<void(Device&)>;

Device lowered(const Lower& lower) {
    Result<Device> device = createDevice({.validation = true});
    if (!device) throw SystemError(format(device.error()));
    lower(*device);
    return std::move(*device);
}

/// A sample's mesh and picture at a time.
struct Made {
    Mesh mesh;
    Picture picture;
};

/// `between` lowers the device further once the mesh is made.
Made make(const std::string& sample, const Lower& lower, double seconds = 0, int resolution = 40,
          const Lower& between = {}) {
    const Result<Graph> graph =
        readGraph(FIELDWRIGHT_SOURCE_DIR "/samples/" + sample + ".field.json", nullptr);
    if (!graph) throw SystemError(format(graph.error()));
    Result<Player> player = Player::create(*graph, lowered(lower), {.resolution = resolution});
    if (!player) throw SystemError(format(player.error()));
    player->seek(seconds);
    Result<Mesh> mesh = player->mesh();
    if (!mesh) throw SystemError(format(mesh.error()));
    if (between) between(const_cast<Device&>(player->device()));  // which the player owns
    Result<Picture> picture =
        player->frame({.width = 200, .height = 150, .samples = 1, .primary = Primary::drawn});
    if (!picture) throw SystemError(format(picture.error()));
    EXPECT_EQ(player->device().validationMessages(), std::vector<std::string>());
    return {std::move(*mesh), std::move(*picture)};
}

void expectSame(const Made& a, const Made& b) {
    EXPECT_GT(a.mesh.indices.size(), 0u);
    EXPECT_EQ(a.mesh.positions, b.mesh.positions);
    EXPECT_EQ(a.mesh.indices, b.mesh.indices);
    EXPECT_TRUE(a.picture.pixels == b.picture.pixels);
}

void none(Device&) {}
/// The invocations of a work group that Fieldwright needs (capabilities.cpp) are more than Vulkan 1.3
/// promises.
constexpr uint32_t kInvocations = 256;

/// All else that Vulkan 1.3 lets a device lack.
void least(Device& device) {
    DeviceLimits most = leastLimits();
    most.invocations = kInvocations;
    device.limits = lowered(device.limits, most);
    device.pushDescriptors = nullptr;
    device.has.int64Atomics = device.has.geometryShader = false;
}
void fewGroups(Device& device) { device.limits.groups = 64; }

/// A graphics card: the host sees nothing of its memory, and stands in for no kernel.
void card(Device& device) { device.unifiedMemory = device.software = false; }

struct Case {
    const char* sample;
    double seconds;
};
void PrintTo(const Case& of, std::ostream* out) { *out << of.sample; }

/// A solid with materials; families; stages; a mesh's field; a fluid.
class Limits : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Samples, Limits,
                         testing::Values(Case{"csg_part", 0}, Case{"dusk_city", 0}, Case{"eroded_duck", 0},
                                         Case{"drop_in_bowl", 0.2}),
                         [](const auto& of) { return std::string(of.param.sample); });

TEST_P(Limits, TheLeastIsEnough) {
    const auto [sample, seconds] = GetParam();
    if (sample != std::string("csg_part") && !std::getenv("FIELDWRIGHT_LONG"))
        GTEST_SKIP() << "a quarter of a minute: with FIELDWRIGHT_LONG";
    expectSame(make(sample, none, seconds), make(sample, least, seconds));
}

TEST_P(Limits, FewGroupsAreSpreadAndSliced) {
    const auto [sample, seconds] = GetParam();
    expectSame(make(sample, none, seconds), make(sample, fewGroups, seconds));
}

TEST_P(Limits, MemoryThatTheHostDoesNotSeeHoldsTheSame) {
    const auto [sample, seconds] = GetParam();
    expectSame(make(sample, none, seconds), make(sample, card, seconds));
}

TEST(Limits, AMeshThatIsLargerThanKernelsSeeIsDrawnWhole) {
    constexpr uint64_t kRange = 1 << 18;
    const Made own = make("csg_part", none, 0, 64);
    EXPECT_GT(own.mesh.indices.size() * 4, kRange);
    expectSame(own,
               make("csg_part", none, 0, 64, [](Device& device) { device.limits.storageRange = kRange; }));
}

TEST(Limits, AMeshThatIsLargerThanKernelsWriteIsRefusedWithWhatWouldFit) {
    const Made own = make("csg_part", none, 0, 96);
    for (const int bits : {27, 26, 24, 20, 18}) {
        const uint64_t range = (uint64_t(1) << bits) - 1;
        const auto few = [&](Device& device) { device.limits.storageRange = range; };
        const bool fits = own.mesh.positions.size() * 16 <= range && own.mesh.indices.size() * 4 <= range;
        try {
            expectSame(own, make("csg_part", few, 0, 96));
            EXPECT_TRUE(fits) << range;
        } catch (const SystemError& error) {
            EXPECT_FALSE(fits) << error.what();
            const std::string said = error.what(), about = "choose a lower resolution, of about ";
            const std::size_t at = said.find(about);
            ASSERT_NE(at, std::string::npos) << said;
            EXPECT_NO_THROW(make("csg_part", few, 0, std::stoi(said.substr(at + about.size())))) << said;
        }
    }
}

TEST(Limits, EveryKernelIsWithinWhatEveryDeviceHas) {
    const DeviceLimits most = leastLimits();
    for (const EmbeddedShader& shader : embeddedShaders()) {
        const std::string name = shader.name;
        if (!name.ends_with(".comp") || name.starts_with("bench/")) continue;
        const Result<Spirv> spirv = compileShader(fitted({.name = name}, most));
        ASSERT_TRUE(spirv) << name << ": " << format(spirv.error());
        const ShaderInterface of = reflect(*spirv);
        EXPECT_LE(of.localSize[0] * of.localSize[1] * of.localSize[2], kInvocations) << name;
        EXPECT_LE(of.sharedMemory, most.sharedMemory) << name;
        EXPECT_LE(of.pushConstantSize, most.pushConstants) << name;
        for (const ShaderBinding& binding : of.bindings)
            EXPECT_NE(binding.type, VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER) << name;
    }
}

TEST(Limits, AKernelThatDoesNotFitIsRefusedWithWords) {
    const auto refusal = [](const Lower& lower, const std::string& text) -> std::string {
        const Device device = lowered(lower);
        try {
            createComputePipeline(device, {.name = "test.comp", .constants = {64}, .text = text});
        } catch (const SystemError& error) { return error.what(); }
        return {};
    };
    const char* wide = "layout(local_size_x_id = 0) in; void main() {}";
    EXPECT_EQ(refusal(none, wide), "");
    EXPECT_NE(refusal([](Device& d) { d.limits.invocations = 32; }, wide).find("needs 64 invocations"),
              std::string::npos);
    const char* sharing = R"(
layout(local_size_x = 64) in;
layout(binding = 0) buffer Out { uint result[]; };
shared uvec3 words[100];
void main() { words[gl_LocalInvocationIndex] = uvec3(1); barrier(); result[0] = words[1].x; })";
    EXPECT_EQ(refusal(none, sharing), "");
    EXPECT_NE(
        refusal([](Device& d) { d.limits.sharedMemory = 1024; }, sharing).find("needs 1600 bytes of sh"),
        std::string::npos);
    const char* pushing = R"(
layout(local_size_x = 64) in;
layout(binding = 0) buffer Out { uint result[]; };
layout(push_constant) uniform Push { uint words[40]; };
void main() { result[0] = words[gl_LocalInvocationIndex % 40]; })";
    EXPECT_NE(refusal(least, pushing).find("needs 160 bytes of push constants"), std::string::npos);
}

TEST(Limits, WhatIsBoundOrRunBeyondThemIsRefusedWithWords) {
    const Device device = lowered([](Device& d) { d.limits.storageRange = 1 << 16, d.limits.groups = 100; });
    const Pipeline pipeline = createComputePipeline(
        device, {.name = "test.comp",
                 .text = "layout(local_size_x = 1) in; layout(binding = 0) buffer Out { uint result[]; };\n"
                         "void main() { result[0] = 1; }"});
    const Buffer fits = createBuffer(device, 1 << 16), tooLarge = createBuffer(device, (1 << 16) + 16);
    Commands commands(device);
    const Descriptor bound[] = {{0, fits}}, whole[] = {{0, tooLarge}};
    EXPECT_NO_THROW(dispatch(commands, pipeline, {100, 1, 1}, nullptr, 0, bound));
    EXPECT_NO_THROW(dispatch(commands, pipeline, spread(device, 5000), nullptr, 0, bound));
    EXPECT_THROW(dispatch(commands, pipeline, {1, 1, 1}, nullptr, 0, whole), SystemError);
    EXPECT_THROW(dispatch(commands, pipeline, {1, 101, 1}, nullptr, 0, bound), SystemError);
    submit(commands);
}

TEST(Limits, FieldsOnGridsThatAreTooLargeAreRefused) {
    const auto few = [](Device& device) {
        device.limits.texelElements = 1 << 10;
        device.limits.storageRange = 1 << 14;
    };
    try {
        make("eroded_duck", few);
        FAIL() << "a field of more samples than the device can read was used";
    } catch (const SystemError& error) {
        EXPECT_NE(std::string(error.what()).find("lower their resolution"), std::string::npos)
            << error.what();
    }
}

TEST(Limits, DescriptorSetsComeFromPoolsThatAreUsedAgain) {
    const Device device = lowered(least);
    const Pipeline pipeline = createComputePipeline(
        device, {.name = "test.comp",
                 .text = "layout(local_size_x = 1) in; layout(binding = 0) buffer Out { uint result[]; };\n"
                         "void main() { atomicAdd(result[0], 1); }"});
    const Buffer counted = createBuffer(device, 16);
    upload(device, counted, std::vector<uint32_t>(4));
    constexpr uint32_t kDispatches = 1000;  // more than a pool has sets
    const Descriptor bound[] = {{0, counted}};
    for (int turn = 0; turn < 3; ++turn) {
        Commands commands(device);
        for (uint32_t i = 0; i < kDispatches; ++i) dispatch(commands, pipeline, {1, 1, 1}, nullptr, 0, bound);
        submit(commands);
    }
    EXPECT_EQ(download<uint32_t>(device, counted, 1)[0], 3 * kDispatches);
    // A driver may give more sets than a pool was made for; none of three recordings needs a pool of its own.
    EXPECT_GE(device.record->freePools.size(), 1u);
    EXPECT_LE(device.record->freePools.size(), 4u);
    EXPECT_EQ(device.validationMessages(), std::vector<std::string>());
}

TEST(Limits, SumsAreRightInAGroupSmallerThanASubgroup) {
    Device& device = test::device();
    const Pipeline pipeline = test::computePipeline(R"(
#define HISTOPYRAMID_LANES 4
#define HISTOPYRAMID_TYPE uint
#include "lib/histopyramid.glsl"
layout(local_size_x = HISTOPYRAMID_LANES) in;
layout(binding = 0, scalar) buffer Out { uint before[4]; uint total; };
void main() {
    uint sum, own = gl_LocalInvocationIndex + 1;
    before[gl_LocalInvocationIndex] = sumBefore(own, sum);
    total = sum;
})");
    if (device.limits.subgroupSize <= 4) GTEST_SKIP() << "no group is smaller than the device's subgroups";
    const Buffer out = createBuffer(device, 32);
    upload(device, out, std::vector<uint32_t>(8, 77));
    Commands commands(device);
    const Descriptor bound[] = {{0, out}};
    dispatch(commands, pipeline, {1, 1, 1}, nullptr, 0, bound);
    barrier(commands);
    submit(commands);
    EXPECT_EQ(download<uint32_t>(device, out, 5), (std::vector<uint32_t>{0, 1, 3, 6, 10}));
}

}  // namespace fw::limits_test
