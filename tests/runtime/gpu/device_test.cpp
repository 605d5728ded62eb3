// The Vulkan layer: devices, buffers, submission, stage times, and what is said when something is missing.
#include <gtest/gtest.h>
#include <sched.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <set>

#include "tests/support/command.h"
#include "tests/support/gpu.h"
#include "tests/support/graph/temp_dir.h"
#include "tests/support/vulkan_calls.h"

namespace fw::device_test {

TEST(Device, ListNamesAtLeastTheSoftwareDevice) {
    std::vector<DeviceInfo> devices = listDevices();
    ASSERT_FALSE(devices.empty());
    EXPECT_TRUE(std::any_of(devices.begin(), devices.end(), [](const DeviceInfo& d) { return d.usable; }));
    for (const DeviceInfo& info : devices) {
        EXPECT_FALSE(info.name.empty());
        EXPECT_FALSE(info.driver.empty());
        EXPECT_GT(info.memory, 0u);
    }
}

TEST(Device, PickTakesIndexOrPartOfTheNameAndRefusesTheRest) {
    std::vector<DeviceInfo> devices = listDevices();
    Result<Device> byIndex = createDevice({.pick = "0"});
    ASSERT_TRUE(byIndex);
    EXPECT_EQ(byIndex->name(), devices[0].name);
    std::string part = devices[0].name.substr(1, 4);
    std::transform(part.begin(), part.end(), part.begin(), ::toupper);
    Result<Device> byName = createDevice({.pick = part});
    ASSERT_TRUE(byName);
    EXPECT_EQ(byName->name(), devices[0].name);
    Result<Device> missing = createDevice({.pick = "no such device"});
    ASSERT_FALSE(missing);
    EXPECT_NE(missing.error().message.find(devices[0].name), std::string::npos);
    EXPECT_FALSE(createDevice({.pick = "99"}));
}

TEST(Device, ValidationMessagesAreCollected) {
    Result<Device> device = createDevice({.validation = true});
    ASSERT_TRUE(device);
    EXPECT_TRUE(device->validationMessages().empty());
    auto bad = zeroed<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
    bad.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    bad.size = 0;  // not allowed
    VkBuffer buffer = VK_NULL_HANDLE;
    vkCreateBuffer(device->handle, &bad, nullptr, &buffer);
    vkDestroyBuffer(device->handle, buffer, nullptr);
    ASSERT_FALSE(device->validationMessages().empty());
    EXPECT_NE(device->validationMessages()[0].find("VkBufferCreateInfo"), std::string::npos);
    test::forgetValidationMessages();
}

TEST(Device, TwoWritesWithoutABarrierAreAHazardThatIsTold) {
    Device& device = test::device();
    Buffer buffer = createBuffer(device, 64);
    Commands commands(device);
    fill(commands, buffer, 1);
    fill(commands, buffer, 0);
    submit(commands);
    ASSERT_FALSE(device.validationMessages().empty());
    EXPECT_NE(device.validationMessages().back().find("SYNC-HAZARD-WRITE-AFTER-WRITE"), std::string::npos);
    test::forgetValidationMessages();
}

TEST(Resources, BytesSurviveTheRoundTripAndMemoryIsCounted) {
    Device& device = test::device();
    std::vector<uint32_t> data(100'001);
    std::iota(data.begin(), data.end(), 7u);
    download<uint32_t>(device, createBuffer(device, data.size() * 4), data.size());  // staging is kept
    upload(device, createBuffer(device, data.size() * 4), data);
    uint64_t before = device.record->allocated;
    {
        for (Memory memory : {Memory::device, Memory::upload, Memory::readback}) {
            Buffer buffer = createBuffer(device, data.size() * 4, memory);
            upload(device, buffer, data);
            EXPECT_EQ(download<uint32_t>(device, buffer, data.size()), data);
            EXPECT_EQ(download<uint32_t>(device, buffer, 3, 40), (std::vector<uint32_t>{17, 18, 19}));
        }
        Buffer buffer;
        EXPECT_TRUE(reserve(device, buffer, 1000));
        EXPECT_FALSE(reserve(device, buffer, 500));
        EXPECT_TRUE(reserve(device, buffer, 2000));
        EXPECT_GT(device.record->allocated, before);
    }
    EXPECT_EQ(device.record->allocated, before);
    EXPECT_GT(device.record->peak, before);
}

TEST(Resources, PiecesOfBuffersThatTheHostDoesNotSeeAreCopiedTogether) {
    const Device& device = test::device();
    const test::HiddenMemory here;
    constexpr std::size_t kWords = 5 << 20;  // more than are copied at once
    std::vector<uint32_t> large(kWords), small = {1, 2, 3, 4, 5, 6, 7};
    std::iota(large.begin(), large.end(), 7u);
    const Buffer hidden = createBuffer(device, kWords * 4), other = createBuffer(device, 64),
                 seen = createBuffer(device, 64, Memory::readback);
    ASSERT_FALSE(hidden.mapped || other.mapped);
    ASSERT_TRUE(seen.mapped);
    const ConstPiece written[] = {{other, &small[0], 4},       {other, &small[1], 5, 7},
                                  {other, nullptr, 0},         {hidden, large.data(), kWords * 4},
                                  {seen, small.data(), 28, 4}, {other, &small[6], 4, 60}};
    uploadPieces(device, written);
    const uint64_t waits = device.record->waits, allocated = device.record->allocated;
    uploadPieces(device, written);
    EXPECT_EQ(device.record->waits - waits, 11u);  // 20 MiB, and the small ones
    EXPECT_EQ(device.record->allocated, allocated);

    std::vector<uint32_t> all(kWords), seven(7);
    uint32_t first = 0, last = 0, second = 0;
    uint8_t fifth = 0;
    const Piece read[] = {{other, &first, 4},     {hidden, all.data(), kWords * 4},
                          {other, &last, 4, 60},  {seen, seven.data(), 28, 4},
                          {other, &second, 4, 7}, {other, &fifth, 1, 11}};
    downloadPieces(device, read);
    EXPECT_EQ(all, large);
    EXPECT_EQ(seven, small);
    EXPECT_EQ((std::vector<uint32_t>{first, second, fifth, last}), (std::vector<uint32_t>{1, 2, 3, 7}));
}

TEST(Resources, AnImpossibleBufferIsASystemErrorThatSaysSo) {
    Device& device = test::device();
    try {
        createBuffer(device, 1ull << 60);
        FAIL() << "a buffer of an exbibyte was made";
    } catch (const SystemError& error) {
        EXPECT_NE(std::string(error.what()).find("lower resolution"), std::string::npos);
    }
}

/// Flags of the mapping that the address lies in, as the system states them.
std::string flagsOfMapping(const void* address) {
    std::ifstream mappings("/proc/self/smaps");
    bool inside = false;
    for (std::string line; std::getline(mappings, line);) {
        unsigned long long first = 0, end = 0;
        const auto at = reinterpret_cast<std::uintptr_t>(address);
        if (std::sscanf(line.c_str(), "%llx-%llx ", &first, &end) == 2) inside = first <= at && at < end;
        if (inside && line.starts_with("VmFlags:")) return line + " ";
    }
    return {};
}

TEST(Resources, LargeOnesOfASoftwareDeviceLieInLargePages) {
    if (!std::filesystem::exists("/sys/kernel/mm/transparent_hugepage")) GTEST_SKIP() << "of this system";
    constexpr std::size_t kBytes = 64u << 20;
    const Buffer buffer = createBuffer(test::device(), kBytes);
    if (test::device().software) {
        EXPECT_NE(flagsOfMapping(buffer.as<char>().data() + kBytes / 2).find(" hg "), std::string::npos);
    }
    std::vector<int> many;
    resizeInLargePages(many, kBytes / sizeof(int));
    EXPECT_EQ(many.size(), kBytes / sizeof(int));
    EXPECT_NE(flagsOfMapping(&many[many.size() / 2]).find(" hg "), std::string::npos);
}

TEST(Device, DriversOfCardsThatAreNotThereAreNotLoaded) {
    if (std::filesystem::exists("/dev/dri")) GTEST_SKIP() << "there are cards";
    // A driver that cannot be loaded, which the loader tells.
    const test::TempDir folder;
    std::filesystem::create_directories(folder.path("vulkan/icd.d"));
    test::writeText(folder.path("vulkan/icd.d/radeon_icd.test.json"),
                    R"({"file_format_version": "1.0.0",
                        "ICD": {"library_path": "/no/such/driver.so", "api_version": "1.3.0"}})");
    const std::string data = "XDG_DATA_HOME=" + folder.path(""), told = "VK_LOADER_DEBUG=error";
    const auto devices = [&](const std::string& more) {
        return test::runCommand({"info", "--devices"}, {.environment = {data, told, more}});
    };
    const test::CommandResult quiet = devices("LANG=C");
    EXPECT_EQ(quiet.status, 0);
    EXPECT_EQ(quiet.errors.find("/no/such/driver.so"), std::string::npos) << quiet.errors;
    const test::CommandResult kept = devices("VK_LOADER_DRIVERS_DISABLE=none*");
    EXPECT_NE(kept.errors.find("/no/such/driver.so"), std::string::npos) << kept.errors;
}

TEST(Commands, TheHostSeesWhatWasWritten) {
    Device& device = test::device();
    Buffer buffer = createBuffer(device, 64);
    Commands commands(device);
    fill(commands, buffer, 7);
    flush(commands);
    EXPECT_TRUE(test::endedForTheHost());
    fill(commands, buffer, 8);
    submit(commands);
    EXPECT_TRUE(test::endedForTheHost());
}

TEST(Resources, FreshBuffersHoldNoZerosWhereThatIsLookedAt) {
    const Buffer buffer = createBuffer(test::device(), 64);
    if (!buffer.mapped) GTEST_SKIP() << "not mapped";
    EXPECT_EQ(buffer.as<uint32_t>()[3], 0xCDCDCDCDu);
}

constexpr const char* kSquares = R"(
layout(local_size_x = 64) in;
layout(constant_id = 0) const uint bias = 1;
layout(push_constant) uniform Push { uint count; uint factor; };
layout(binding = 0, scalar) readonly buffer In { uint source[]; };
layout(binding = 3, scalar) writeonly buffer Out { uint target[]; };
void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i < count) target[i] = source[i] * factor + bias;
}
)";

TEST(Commands, DispatchComputesAndStagesAreTimed) {
    Device& device = test::device();
    struct Push {
        uint32_t count, factor;
    } push{1000, 3};
    Pipeline pipeline = test::computePipeline(kSquares, {5});
    Buffer source = createBuffer(device, 4000), target = createBuffer(device, 4000),
           arguments = createBuffer(device, 12);
    std::vector<uint32_t> data(1000);
    std::iota(data.begin(), data.end(), 0u);
    upload(device, source, data);
    upload(device, arguments, std::vector<uint32_t>{groupsFor(1000, 64), 1, 1});
    for (bool timed : {false, true}) {
        Commands commands(device, timed);
        beginStage(commands, "clear");
        fill(commands, target, 0);
        barrier(commands);
        beginStage(commands, "squares");
        Descriptor descriptors[] = {
            {0, source}, {3, target}, {15, source}};  // 15 is not the shader's: passed over
        if (timed)
            dispatchIndirect(commands, pipeline, arguments, 0, push, descriptors);
        else
            dispatch(commands, pipeline, {groupsFor(1000, 64), 1, 1}, push, descriptors);
        barrier(commands);
        submit(commands);
        std::vector<uint32_t> result = download<uint32_t>(device, target, 1000);
        for (uint32_t i = 0; i < 1000; ++i) ASSERT_EQ(result[i], i * 3 + 5);
        ASSERT_EQ(commands.stages.size(), timed ? 2u : 0u);
        if (timed) {
            EXPECT_EQ(commands.stages[1].name, "squares");
            EXPECT_GT(commands.stages[1].milliseconds, 0.0);
        }
    }
}

TEST(Commands, PipelinesMadeBehindLeaveTheQueueAlone) {
    Device& device = test::device();
    finish(device);
    const Buffer buffer = createBuffer(device, 64);
    Commands commands(device);
    fill(commands, buffer, 7);
    send(commands);
    // Were it the thread of another's frame, that would have been its queue.
    const std::vector<Pipeline> made =
        createComputePipelines(device, std::array{ShaderOptions{.name = "squares.comp", .text = kSquares}},
                               nullptr, Compile::behind);
    EXPECT_EQ(made.size(), 1u);
    EXPECT_EQ(device.record->sent.size(), 1u);
    finish(device);
}

TEST(Resources, ImagesCanBeWrittenByAShaderAndRead) {
    Device& device = test::device();
    Image image =
        createImage(device, {.extent = {8, 8, 8}, .format = VK_FORMAT_R32_SFLOAT, .type = VK_IMAGE_TYPE_3D});
    Pipeline pipeline = test::computePipeline(R"(
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, r32f) writeonly uniform image3D target;
void main() { imageStore(target, ivec3(gl_GlobalInvocationID), vec4(dot(vec3(gl_GlobalInvocationID), vec3(1, 10, 100)))); }
)");
    Buffer pixels = createBuffer(device, 8 * 8 * 8 * 4, Memory::readback);
    Commands commands(device);
    imageBarrier(commands, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    Descriptor descriptors[] = {{0, image.view, VK_IMAGE_LAYOUT_GENERAL}};
    dispatch(commands, pipeline, {1, 1, 8}, nullptr, 0, descriptors);
    imageBarrier(commands, image, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = image.extent;
    vkCmdCopyImageToBuffer(commands.handle, image.handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, pixels.handle,
                           1, &region);
    barrier(commands);
    submit(commands);
    EXPECT_EQ(download<float>(device, pixels, 1, (5 * 64 + 3 * 8 + 2) * 4)[0], 532.0f);
}

TEST(Device, WorkersOfASoftwareDeviceHaveProcessorsOfTheirOwn) {
    if (!test::device().software) GTEST_SKIP() << "a hardware device";
    cpu_set_t allowed;
    ASSERT_EQ(sched_getaffinity(0, sizeof allowed, &allowed), 0);
    if (CPU_COUNT(&allowed) < 2) GTEST_SKIP() << "one processor";
    std::set<int> processors;
    for (const auto& entry : std::filesystem::directory_iterator("/proc/self/task")) {
        cpu_set_t own;
        if (sched_getaffinity(std::stoi(entry.path().filename()), sizeof own, &own) != 0) continue;
        for (int i = 0; CPU_COUNT(&own) == 1 && i < CPU_SETSIZE; ++i)
            if (CPU_ISSET(i, &own)) processors.insert(i);
    }
    EXPECT_GE(int(processors.size()), std::min(CPU_COUNT(&allowed), 8));
}

}  // namespace fw::device_test
