// Recording work, submitting it, and the time of each of its named stages.
//
// A command buffer, recorded and submitted; long work goes on in another. `dispatch` checks what it is given
// against what the shader declares. Stage times: on a GPU timestamp queries around each stage; on a software
// device, whose timestamps lie, a timed recording is submitted and awaited stage by stage and the wall clock
// is read, which costs some 50 microseconds a stage. An untimed recording is one submission, unless it asks
// for more.
//
// Nothing waits for a recording that is sent but what needs it: the next submit(), or the host when it reads,
// writes or frees a buffer. The device does all in the order in which it was given.
//
// Drivers end what takes them seconds, and with it the device: a parted recording runs long passes in parts
// of about a tenth of a second, each awaited. How long they are is found as they run.
#pragma once

#include <atomic>
#include <glm/vec3.hpp>

#include "runtime/gpu/resources.h"
#include "runtime/gpu/shader.h"

namespace fw {

struct StageTime {
    std::string name;
    double milliseconds = 0;
};

/// A command buffer while it is recorded. Move-only in effect: it is made, filled, submitted and dies in one
/// place.
struct Commands {
    explicit Commands(const Device& device, bool timed = false);
    Commands(const Commands&) = delete;
    Commands& operator=(const Commands&) = delete;
    ~Commands();

    const Device& device;
    VkCommandBuffer handle = VK_NULL_HANDLE;
    bool timed = false;
    std::vector<StageTime> stages;         ///< complete after submit, in order of recording
    VkQueryPool queries = VK_NULL_HANDLE;  ///< GPU only
    bool stageOpen = false;
    const std::atomic<bool>* cancel = nullptr;  ///< if given, long work looks at it between its parts
    bool parted = false;  ///< dispatchRows(), and who asks for it, work in parts; not where it is timed
    std::vector<VkDescriptorPool> pools;  ///< of its sets, the last with room; none where sets are pushed
};

/// A resource for one binding of a shader.
struct Descriptor {
    uint32_t binding = 0;
    VkDescriptorBufferInfo buffer = {};
    VkDescriptorImageInfo image = {};
    VkBufferView texels = VK_NULL_HANDLE;

    /// The whole buffer, or `size` bytes from `offset`. At most the limit `storageRange` can be bound.
    Descriptor(uint32_t bindingNumber, const Buffer& b, VkDeviceSize offset = 0,
               VkDeviceSize size = VK_WHOLE_SIZE)
        : binding(bindingNumber),
          buffer{b.handle, offset, size == VK_WHOLE_SIZE ? b.size - offset : size},
          texels(b.texels) {}
    Descriptor(uint32_t bindingNumber, VkImageView view, VkImageLayout layout,
               VkSampler sampler = VK_NULL_HANDLE)
        : binding(bindingNumber), image{sampler, view, layout} {}
};

/// Starts a named stage, which lasts until the next one or the submission. Nothing happens in an untimed
/// recording.
void beginStage(Commands& commands, const char* name);

/// Everything recorded before is done and visible to everything recorded after, host reads included.
void barrier(Commands& commands);

/// The same for one image, which also changes its layout; `from` may be VK_IMAGE_LAYOUT_UNDEFINED to drop the
/// content.
void imageBarrier(Commands& commands, const Image& image, VkImageLayout from, VkImageLayout to);
/// And for one that no Image owns.
void imageBarrier(Commands& commands, VkImage image, VkImageAspectFlags aspect, VkImageLayout from,
                  VkImageLayout to);

/// Sets `size` bytes from `offset` (multiples of 4) to a repeated word.
void fill(Commands& commands, const Buffer& buffer, uint32_t word, VkDeviceSize offset = 0,
          VkDeviceSize size = VK_WHOLE_SIZE);

/// Binds the pipeline with its push constants and resources. Every binding of the shader must be among
/// `descriptors`; those that the shader lacks are passed over, so a caller can give the parameter buffer
/// whether or not the field reads it.
void bind(Commands& commands, const Pipeline& pipeline, const void* push, std::size_t pushSize,
          std::span<const Descriptor> descriptors);

/// Runs a compute shader over `groups` work groups.
void dispatch(Commands& commands, const Pipeline& pipeline, glm::uvec3 groups, const void* push,
              std::size_t pushSize, std::span<const Descriptor> descriptors);

/// The same with the three group counts read from `arguments` at `offset` when it runs.
void dispatchIndirect(Commands& commands, const Pipeline& pipeline, const Buffer& arguments,
                      VkDeviceSize offset, const void* push, std::size_t pushSize,
                      std::span<const Descriptor> descriptors);

/// dispatch() by rows of groups (y), for passes that may take long: in a parted recording some rows at a
/// time, until `commands.cancel` says otherwise.
void dispatchRows(Commands& commands, const Pipeline& pipeline, glm::uvec3 groups, const void* push,
                  std::size_t pushSize, std::span<const Descriptor> descriptors);

inline constexpr uint32_t kPartedRow = 64;  ///< groups of a row, or more where they would be too many rows
/// The same for a kernel that takes its groups one after the other (linearGroup() in lib/groups.glsl) and
/// lets those that are too many run to no effect: fewer than a row.
void dispatchGroups(Commands& commands, const Pipeline& pipeline, uint64_t groups, const void* push,
                    std::size_t pushSize, std::span<const Descriptor> descriptors);

/// Runs what is recorded so far, `done` of the things that a long pass is made of, and returns how many to do
/// next for that to take about a tenth of a second: as many, twice or half as many.
uint32_t flushPart(Commands& commands, uint32_t done);

/// As above, with a struct for the push constants.
template <class Push>
void dispatch(Commands& commands, const Pipeline& pipeline, glm::uvec3 groups, const Push& push,
              std::span<const Descriptor> descriptors) {
    dispatch(commands, pipeline, groups, &push, sizeof(Push), descriptors);
}
template <class Push>
void dispatchGroups(Commands& commands, const Pipeline& pipeline, uint64_t groups, const Push& push,
                    std::span<const Descriptor> descriptors) {
    dispatchGroups(commands, pipeline, groups, &push, sizeof(Push), descriptors);
}
template <class Push>
void dispatchIndirect(Commands& commands, const Pipeline& pipeline, const Buffer& arguments,
                      VkDeviceSize offset, const Push& push, std::span<const Descriptor> descriptors) {
    dispatchIndirect(commands, pipeline, arguments, offset, &push, sizeof(Push), descriptors);
}

/// Runs what is recorded so far and waits for it; recording goes on. For a stage that the host does in
/// between.
void flush(Commands& commands);

/// Whether the work is no longer wanted; what is recorded so far is run first. False, and nothing is run,
/// where it cannot be cancelled.
bool cancelled(Commands& commands);

/// Ends the recording, runs it and waits for it; what it wrote is visible to the host. Fills
/// `commands.stages` if it is timed. Throws SystemError if the device is lost.
void submit(Commands& commands);

/// Ends the recording and lets it run. What uses it is waited for: by the next submit() or finish(), which
/// uploadBytes(), downloadBytes(), look(), reserve() and the ends of buffers and images call; who ends a
/// pipeline calls it himself. Timed recordings are awaited, and so is one behind eight others. The semaphore,
/// if there is one, tells of its end.
void send(Commands& commands, VkSemaphore done = VK_NULL_HANDLE);

/// send() of what is recorded so far; recording goes on. For work that would take too long as one.
void sendOn(Commands& commands);

/// Waits for what was sent, if anything was.
void finish(const Device& device);

/// The first elements of a buffer, once nothing runs that may write them: where they lie, if the host sees
/// them there, else downloaded into `copies`, which must stay.
template <class T>
std::span<const T> look(const Device& device, const Buffer& buffer, std::size_t count,
                        std::vector<T>& copies) {
    finish(device);
    if (buffer.mapped) return buffer.as<T>().first(count);
    return copies = download<T>(device, buffer, count);
}

/// Sets bytes of a buffer (multiples of 4) when the recording runs, behind what was recorded before.
void update(Commands& commands, const Buffer& buffer, const void* data, std::size_t size);

/// Copies bytes between buffers when the recording runs, behind what was recorded before; it is done before
/// what is recorded next.
void copy(Commands& commands, const Buffer& from, VkDeviceSize fromOffset, const Buffer& to,
          VkDeviceSize toOffset, VkDeviceSize size);

/// Group count that covers `items` with `perGroup` each.
constexpr uint32_t groupsFor(uint64_t items, uint32_t perGroup) {
    return uint32_t((items + perGroup - 1) / perGroup);
}

/// So many groups over two axes, each no longer than the device allows; some more run, to no effect.
inline glm::uvec3 spread(const Device& device, uint64_t groups) {
    const uint32_t y = groupsFor(groups > 0 ? groups : 1, device.limits.groups);
    return {groupsFor(groups, y), y, 1};
}

}  // namespace fw
