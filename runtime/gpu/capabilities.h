// What a device can do and how far: what Fieldwright needs of it, what it likes but does without, and what
// bounds its work.
//
// All of it is data: a row a capability, with what follows where it is lacking, and one struct of limits.
// Whoever slices work or refuses it reads the limits of the Device, which a test may lower after it opened
// one.
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace fw {

struct DeviceCapabilities {
    bool vulkan13 = false, scalarBlocks = false, universalQueue = false, subgroups = false,
         storageFormats = false, storesFromFragments = false, largeGroups = false;
    bool pushDescriptors = false, largeTexelBuffers = false, int64Atomics = false, geometryShader = false,
         deviceAddresses = false, memoryBudget = false;
};

/// One of them.
struct Capability {
    const char* name;
    bool DeviceCapabilities::*has;
    const char* without;  ///< what is done where it is lacking; nullptr: Fieldwright cannot run then
};
std::span<const Capability> capabilities();

/// How far work can go. Each is the least over the axes and kinds that it stands for.
struct DeviceLimits {
    uint32_t groups = 0;         ///< work groups along one axis of a dispatch
    uint32_t invocations = 0;    ///< of a work group
    uint32_t sharedMemory = 0;   ///< bytes of a work group
    uint32_t pushConstants = 0;  ///< bytes
    uint64_t storageRange = 0;   ///< bytes that one binding of a storage buffer shows
    uint64_t texelElements = 0;  ///< texels that one binding of a texel buffer shows
    uint64_t allocation = 0;     ///< bytes of a buffer or image
    uint32_t subgroupSize = 0;   ///< lanes

    /// Whether what shaders declare as texel buffers is bound as storage buffers, of which more can be seen.
    bool texelsInStorage() const { return texelElements < storageRange / kTexelBytes; }
    /// Texels of four words that one binding shows, of either kind.
    uint64_t texels() const { return texelsInStorage() ? storageRange / kTexelBytes : texelElements; }

    static constexpr uint64_t kTexelBytes = 16;
};

/// What every device with Vulkan 1.3 has at least; `subgroupSize` is no bound and left alone.
DeviceLimits leastLimits();

/// The lower of each; what is 0 in `most` stays as it is.
DeviceLimits lowered(DeviceLimits limits, const DeviceLimits& most);

DeviceLimits limitsOf(VkPhysicalDevice physical);
DeviceCapabilities capabilitiesOf(VkPhysicalDevice physical);

/// Bytes that this process can still have of a heap as things are now; only where the device has
/// memoryBudget.
uint64_t budgetLeft(VkPhysicalDevice physical, uint32_t heap);

/// The family of queues that draw and compute.
std::optional<uint32_t> universalQueueFamily(VkPhysicalDevice physical);

/// Names of what Fieldwright needs and the device lacks; empty where it can be used.
std::vector<std::string> missing(const DeviceCapabilities& has);

/// The features that are asked for, in one chain of structs that stays in place.
struct Features {
    VkPhysicalDeviceFeatures2 core{};
    VkPhysicalDeviceVulkan12Features v12{};
    VkPhysicalDeviceVulkan13Features v13{};
    Features();
    Features(const Features&) = delete;
};

}  // namespace fw
