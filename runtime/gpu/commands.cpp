#include "runtime/gpu/commands.h"
#include "runtime/system/clock.h"

#include <algorithm>
#include <utility>

namespace fw {
namespace {

constexpr uint32_t kMostStages = 64;

void begin(Commands& commands) {
    auto info = zeroed<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
    info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check(vkBeginCommandBuffer(commands.handle, &info), "recording commands");
}

/// Ends what is recorded, so that the host can read what it wrote, and submits it.
void launch(Commands& commands, VkFence fence, VkSemaphore done) {
    barrier(commands);
    check(vkEndCommandBuffer(commands.handle), "recording commands");
    auto buffer = zeroed<VkCommandBufferSubmitInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO);
    buffer.commandBuffer = commands.handle;
    auto info = zeroed<VkSubmitInfo2>(VK_STRUCTURE_TYPE_SUBMIT_INFO_2);
    info.commandBufferInfoCount = 1;
    info.pCommandBufferInfos = &buffer;
    auto signal = zeroed<VkSemaphoreSubmitInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO);
    signal.semaphore = done;
    signal.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    info.signalSemaphoreInfoCount = done ? 1 : 0;
    info.pSignalSemaphoreInfos = &signal;
    check(vkQueueSubmit2(commands.device.queue, 1, &info, fence), "submitting work to the device");
    ++commands.device.record->submissions;
}

void release(const Device& device, std::vector<VkDescriptorPool>& pools);

/// Waits for the fence and, as it stands behind all that was submitted before, frees what was sent.
void await(const Device& device) {
    check(vkWaitForFences(device.handle, 1, &device.fence, VK_TRUE, UINT64_MAX), "waiting for the device");
    check(vkResetFences(device.handle, 1, &device.fence), "resetting a fence");
    DeviceRecord& record = *device.record;
    ++record.waits;
    for (SentCommands& each : record.sent) {
        vkFreeCommandBuffers(device.handle, device.commandPool, 1, &each.handle);
        release(device, each.pools);
    }
    record.sent.clear();
}

/// Runs and awaits what is recorded; the wall clock time of that in ms.
double run(Commands& commands, VkSemaphore done = VK_NULL_HANDLE) {
    const Clock::time_point before = Clock::now();
    launch(commands, commands.device.fence, done);
    await(commands.device);
    return millisecondsSince(before);
}

void allocate(Commands& commands) {
    auto info = zeroed<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
    info.commandPool = commands.device.commandPool;
    info.commandBufferCount = 1;
    check(vkAllocateCommandBuffers(commands.device.handle, &info, &commands.handle),
          "allocating a command buffer");
    begin(commands);
}

void writeTimestamp(Commands& commands) {
    vkCmdWriteTimestamp2(commands.handle, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, commands.queries,
                         uint32_t(commands.stages.size()));
}

/// Where the driver cannot take descriptors with the commands: sets from pools that belong to one recording
/// until it is done, and then to the next.
constexpr uint32_t kSetsOfAPool = 256;
std::mutex freePoolsUse;  // of any device; a record's own mutex is held by whoever uses the sibling

VkDescriptorPool createPool(const Device& device) {
    // So many of each kind as the largest kernels have on average; what runs out means one more pool.
    constexpr VkDescriptorPoolSize kSizes[] = {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 8 * kSetsOfAPool},
                                               {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 2 * kSetsOfAPool},
                                               {VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, 4 * kSetsOfAPool},
                                               {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 4 * kSetsOfAPool},
                                               {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, kSetsOfAPool},
                                               {VK_DESCRIPTOR_TYPE_SAMPLER, kSetsOfAPool},
                                               {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, kSetsOfAPool}};
    auto info = zeroed<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
    info.maxSets = kSetsOfAPool;
    info.poolSizeCount = uint32_t(std::size(kSizes));
    info.pPoolSizes = kSizes;
    VkDescriptorPool pool = VK_NULL_HANDLE;
    check(vkCreateDescriptorPool(device.handle, &info, nullptr, &pool), "creating a descriptor pool");
    return pool;
}

void addPool(Commands& commands) {
    DeviceRecord& record = *commands.device.record;
    std::lock_guard lock(freePoolsUse);
    if (record.freePools.empty()) {
        commands.pools.push_back(createPool(commands.device));
    } else {
        commands.pools.push_back(record.freePools.back());
        record.freePools.pop_back();
    }
}

/// What was recorded with them is done: they are free.
void release(const Device& device, std::vector<VkDescriptorPool>& pools) {
    if (pools.empty()) return;
    for (VkDescriptorPool pool : pools) vkResetDescriptorPool(device.handle, pool, 0);
    std::lock_guard lock(freePoolsUse);
    device.record->freePools.insert(device.record->freePools.end(), pools.begin(), pools.end());
    pools.clear();
}

/// In place of a recording that is done, or was handed on with its pools.
void beginAnew(Commands& commands) {
    vkFreeCommandBuffers(commands.device.handle, commands.device.commandPool, 1, &commands.handle);
    release(commands.device, commands.pools);
    allocate(commands);
}

/// flush(), and the wall clock time in ms.
double runOn(Commands& commands) {
    const double elapsed = run(commands);
    if (commands.stageOpen && !commands.queries) commands.stages.back().milliseconds += elapsed;
    beginAnew(commands);
    return elapsed;
}

VkDescriptorSet newSet(Commands& commands, const Pipeline& pipeline) {
    if (commands.pools.empty()) addPool(commands);
    auto info = zeroed<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
    info.descriptorSetCount = 1;
    info.pSetLayouts = &pipeline.setLayout;
    const auto allocateFrom = [&](VkDescriptorPool pool, VkDescriptorSet& set) {
        info.descriptorPool = pool;
        return vkAllocateDescriptorSets(commands.device.handle, &info, &set);
    };
    VkDescriptorSet set = VK_NULL_HANDLE;
    VkResult result = allocateFrom(commands.pools.back(), set);
    if (result == VK_ERROR_OUT_OF_POOL_MEMORY || result == VK_ERROR_FRAGMENTED_POOL) {
        addPool(commands);
        result = allocateFrom(commands.pools.back(), set);
    }
    check(result, "allocating a descriptor set");
    return set;
}

/// The one place where descriptors reach the device.
void give(Commands& commands, const Pipeline& pipeline, VkPipelineBindPoint point,
          std::span<VkWriteDescriptorSet> writes) {
    const Device& device = commands.device;
    const auto count = uint32_t(writes.size());
    if (device.pushDescriptors)
        return device.pushDescriptors(commands.handle, point, pipeline.layout, 0, count, writes.data());
    const VkDescriptorSet set = newSet(commands, pipeline);
    for (VkWriteDescriptorSet& write : writes) write.dstSet = set;
    vkUpdateDescriptorSets(device.handle, count, writes.data(), 0, nullptr);
    vkCmdBindDescriptorSets(commands.handle, point, pipeline.layout, 0, 1, &set, 0, nullptr);
}

void checkGroups(const Device& device, glm::uvec3 groups) {
    const uint32_t most = device.limits.groups;
    if (groups.x > most || groups.y > most || groups.z > most)
        throw DeviceTooSmall("device '" + device.name() + "' runs " + std::to_string(most) +
                             " work groups in a row, and " +
                             std::to_string(std::max({groups.x, groups.y, groups.z})) +
                             " are needed; a lower resolution needs less");
}

}  // namespace

Commands::Commands(const Device& owner, bool wantTimes) : device(owner), timed(wantTimes) {
    allocate(*this);
    if (timed && device.timestamps) {
        auto info = zeroed<VkQueryPoolCreateInfo>(VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO);
        info.queryType = VK_QUERY_TYPE_TIMESTAMP;
        info.queryCount = kMostStages + 1;
        check(vkCreateQueryPool(device.handle, &info, nullptr, &queries), "creating timestamp queries");
        vkCmdResetQueryPool(handle, queries, 0, kMostStages + 1);
    }
}

Commands::~Commands() {
    if (queries) vkDestroyQueryPool(device.handle, queries, nullptr);
    vkFreeCommandBuffers(device.handle, device.commandPool, 1, &handle);
    release(device, pools);
}

void beginStage(Commands& commands, const char* name) {
    if (!commands.timed) return;
    assert(commands.stages.size() < kMostStages);
    if (commands.queries) {
        writeTimestamp(commands);
    } else {
        // What is recorded so far belongs to the stage before, or to none.
        flush(commands);
    }
    commands.stages.push_back({name, 0});
    commands.stageOpen = true;
}

void flush(Commands& commands) { runOn(commands); }

uint32_t flushPart(Commands& commands, uint32_t done) {
    constexpr double kLeast = 50.0, kMost = 125.0;  // ms
    const double elapsed = runOn(commands);
    return elapsed < kLeast ? 2 * done : elapsed > kMost ? std::max(done / 2, 1u) : done;
}

void barrier(Commands& commands) {
    auto memory = zeroed<VkMemoryBarrier2>(VK_STRUCTURE_TYPE_MEMORY_BARRIER_2);
    memory.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    memory.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
    memory.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_2_HOST_BIT;
    memory.dstAccessMask =
        VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT | VK_ACCESS_2_HOST_READ_BIT;
    auto info = zeroed<VkDependencyInfo>(VK_STRUCTURE_TYPE_DEPENDENCY_INFO);
    info.memoryBarrierCount = 1;
    info.pMemoryBarriers = &memory;
    vkCmdPipelineBarrier2(commands.handle, &info);
}

void imageBarrier(Commands& commands, const Image& image, VkImageLayout from, VkImageLayout to) {
    imageBarrier(commands, image.handle, image.aspect, from, to);
}

void imageBarrier(Commands& commands, VkImage image, VkImageAspectFlags aspect, VkImageLayout from,
                  VkImageLayout to) {
    auto memory = zeroed<VkImageMemoryBarrier2>(VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2);
    memory.srcStageMask = memory.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    memory.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
    memory.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    memory.oldLayout = from;
    memory.newLayout = to;
    memory.srcQueueFamilyIndex = memory.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    memory.image = image;
    memory.subresourceRange = {aspect, 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS};
    auto info = zeroed<VkDependencyInfo>(VK_STRUCTURE_TYPE_DEPENDENCY_INFO);
    info.imageMemoryBarrierCount = 1;
    info.pImageMemoryBarriers = &memory;
    vkCmdPipelineBarrier2(commands.handle, &info);
}

void fill(Commands& commands, const Buffer& buffer, uint32_t word, VkDeviceSize offset, VkDeviceSize size) {
    vkCmdFillBuffer(commands.handle, buffer.handle, offset, size, word);
}

void bind(Commands& commands, const Pipeline& pipeline, const void* push, std::size_t pushSize,
          std::span<const Descriptor> descriptors) {
    VkPipelineBindPoint point = pipeline.shader.stages == VK_SHADER_STAGE_COMPUTE_BIT
                                    ? VK_PIPELINE_BIND_POINT_COMPUTE
                                    : VK_PIPELINE_BIND_POINT_GRAPHICS;
    vkCmdBindPipeline(commands.handle, point, pipeline.handle);
    assert(pushSize == pipeline.shader.pushConstantSize && "push constants do not match the shader's");
    if (pushSize)
        vkCmdPushConstants(commands.handle, pipeline.layout, pipeline.shader.stages, 0, uint32_t(pushSize),
                           push);

    std::array<VkWriteDescriptorSet, 32> writes;
    uint32_t count = 0;
    for (const ShaderBinding& declared : pipeline.shader.bindings) {
        auto given = std::find_if(descriptors.begin(), descriptors.end(),
                                  [&](const Descriptor& d) { return d.binding == declared.binding; });
        // Worth its time in every build: what lies behind the list would be bound, and a driver may fall for
        // it.
        if (given == descriptors.end())
            throw SystemError("binding " + std::to_string(declared.binding) + " of a shader is not given");
        if (declared.type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER &&
            given->buffer.range > commands.device.limits.storageRange)
            throw DeviceTooSmall("device '" + commands.device.name() + "' shows a kernel " +
                                 std::to_string(commands.device.limits.storageRange >> 10) +
                                 " KiB of a buffer, and " + std::to_string(given->buffer.range >> 10) +
                                 " are needed; a lower resolution needs less");
        VkWriteDescriptorSet& write = writes[count++];
        write = zeroed<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
        write.dstBinding = declared.binding;
        write.descriptorCount = 1;
        write.descriptorType = declared.type;
        write.pBufferInfo = &given->buffer;
        write.pImageInfo = &given->image;
        write.pTexelBufferView = &given->texels;
    }
    if (count) give(commands, pipeline, point, {writes.data(), count});
}

void dispatch(Commands& commands, const Pipeline& pipeline, glm::uvec3 groups, const void* push,
              std::size_t pushSize, std::span<const Descriptor> descriptors) {
    checkGroups(commands.device, groups);
    bind(commands, pipeline, push, pushSize, descriptors);
    vkCmdDispatch(commands.handle, groups.x, groups.y, groups.z);
}

void dispatchRows(Commands& commands, const Pipeline& pipeline, glm::uvec3 groups, const void* push,
                  std::size_t pushSize, std::span<const Descriptor> descriptors) {
    if (!commands.parted) return dispatch(commands, pipeline, groups, push, pushSize, descriptors);
    constexpr uint32_t kFirstGroups = 512;
    checkGroups(commands.device, groups);
    uint32_t rows = std::max(kFirstGroups / std::max(groups.x, 1u), 1u);
    for (uint32_t row = 0; row < groups.y;) {
        const uint32_t now = std::min(rows, groups.y - row);
        bind(commands, pipeline, push, pushSize, descriptors);
        vkCmdDispatchBase(commands.handle, 0, row, 0, groups.x, now, groups.z);
        row += now;
        if (row < groups.y) rows = flushPart(commands, now);
        if (commands.cancel && *commands.cancel) return;
    }
}

void dispatchGroups(Commands& commands, const Pipeline& pipeline, uint64_t groups, const void* push,
                    std::size_t pushSize, std::span<const Descriptor> descriptors) {
    if (!commands.parted || groups <= kPartedRow)
        return dispatch(commands, pipeline, spread(commands.device, groups), push, pushSize, descriptors);
    const uint32_t row = std::max(kPartedRow, groupsFor(groups, commands.device.limits.groups));
    dispatchRows(commands, pipeline, {row, groupsFor(groups, row), 1}, push, pushSize, descriptors);
}

void dispatchIndirect(Commands& commands, const Pipeline& pipeline, const Buffer& arguments,
                      VkDeviceSize offset, const void* push, std::size_t pushSize,
                      std::span<const Descriptor> descriptors) {
    bind(commands, pipeline, push, pushSize, descriptors);
    vkCmdDispatchIndirect(commands.handle, arguments.handle, offset);
}

bool cancelled(Commands& commands) {
    if (!commands.cancel) return false;
    flush(commands);
    return *commands.cancel;
}

namespace {

void submitTelling(Commands& commands, VkSemaphore done) {
    if (commands.queries) writeTimestamp(commands);
    double elapsed = run(commands, done);
    if (!commands.stageOpen) return;
    if (!commands.queries) {
        commands.stages.back().milliseconds += elapsed;
        return;
    }
    std::vector<uint64_t> ticks(commands.stages.size() + 1);
    check(vkGetQueryPoolResults(commands.device.handle, commands.queries, 0, uint32_t(ticks.size()),
                                ticks.size() * 8, ticks.data(), 8,
                                VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
          "reading timestamps");
    for (std::size_t i = 0; i < commands.stages.size(); ++i)
        commands.stages[i].milliseconds =
            double(ticks[i + 1] - ticks[i]) * commands.device.properties.limits.timestampPeriod * 1e-6;
}

}  // namespace

void submit(Commands& commands) { submitTelling(commands, VK_NULL_HANDLE); }

void send(Commands& commands, VkSemaphore done) {
    // Long work is told of and ended between its parts: the device is not to be far behind.
    constexpr std::size_t kMostSent = 8;
    if (commands.timed || commands.device.record->sent.size() >= kMostSent)
        return submitTelling(commands, done);
    launch(commands, VK_NULL_HANDLE, done);
    commands.device.record->sent.push_back(
        {std::exchange(commands.handle, VK_NULL_HANDLE), std::exchange(commands.pools, {})});
}

void sendOn(Commands& commands) {
    if (commands.timed) return;
    send(commands);
    beginAnew(commands);
}

void finish(const Device& device) {
    if (device.record->sent.empty()) return;
    check(vkQueueSubmit2(device.queue, 0, nullptr, device.fence), "submitting work to the device");
    await(device);
}

void update(Commands& commands, const Buffer& buffer, const void* data, std::size_t size) {
    constexpr std::size_t kMostAtOnce = 65536;  // of vkCmdUpdateBuffer
    barrier(commands);
    for (std::size_t at = 0; at < size; at += kMostAtOnce)
        vkCmdUpdateBuffer(commands.handle, buffer.handle, at, std::min(size - at, kMostAtOnce),
                          static_cast<const char*>(data) + at);
    barrier(commands);
}

void copy(Commands& commands, const Buffer& from, VkDeviceSize fromOffset, const Buffer& to,
          VkDeviceSize toOffset, VkDeviceSize size) {
    barrier(commands);
    const VkBufferCopy region{fromOffset, toOffset, size};
    vkCmdCopyBuffer(commands.handle, from.handle, to.handle, 1, &region);
    barrier(commands);
}

}  // namespace fw
