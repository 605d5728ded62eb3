#include "runtime/gpu/capabilities.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace fw {
namespace {

constexpr uint32_t kMostGroups = 65'535;  // that every device has: more are not asked for
constexpr uint32_t kInvocations = 256;    // of the largest work groups: a tile of 16 x 16 pixels

constexpr std::array kCapabilities = {
    Capability{"Vulkan 1.3", &DeviceCapabilities::vulkan13, nullptr},
    Capability{"scalar block layout", &DeviceCapabilities::scalarBlocks, nullptr},
    Capability{"a queue that draws and computes", &DeviceCapabilities::universalQueue, nullptr},
    Capability{"subgroup arithmetic, votes and ballots", &DeviceCapabilities::subgroups, nullptr},
    Capability{"storage images of all formats", &DeviceCapabilities::storageFormats, nullptr},
    Capability{"stores from fragment shaders", &DeviceCapabilities::storesFromFragments, nullptr},
    Capability{"256 invocations a work group", &DeviceCapabilities::largeGroups, nullptr},
    Capability{"push descriptors", &DeviceCapabilities::pushDescriptors, "descriptor sets from pools"},
    Capability{"large texel buffers", &DeviceCapabilities::largeTexelBuffers, "texels in storage buffers"},
    Capability{"64-bit atomics", &DeviceCapabilities::int64Atomics,
               "fields of meshes are baked on the processor"},
    Capability{"geometry shaders", &DeviceCapabilities::geometryShader, "no 'bench talk'"},
    Capability{"buffer addresses", &DeviceCapabilities::deviceAddresses, "nothing slower"},
    Capability{"memory budgets", &DeviceCapabilities::memoryBudget, "what other programs have is not known"},
};

bool hasExtension(VkPhysicalDevice physical, const char* name) {
    uint32_t count = 0;
    vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> all(count);
    vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, all.data());
    return std::any_of(all.begin(), all.end(), [&](const VkExtensionProperties& extension) {
        return !std::strcmp(extension.extensionName, name);
    });
}

template <class T>
T chained(VkStructureType type, void* next = nullptr) {
    T value{};
    value.sType = type;
    value.pNext = next;
    return value;
}

}  // namespace

std::span<const Capability> capabilities() { return kCapabilities; }

Features::Features() {
    core = chained<VkPhysicalDeviceFeatures2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &v12);
    v12 = chained<VkPhysicalDeviceVulkan12Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES,
                                                    &v13);
    v13 = chained<VkPhysicalDeviceVulkan13Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES);
}

DeviceLimits leastLimits() {
    return {.groups = kMostGroups,
            .invocations = 128,
            .sharedMemory = 16 << 10,
            .pushConstants = 128,
            .storageRange = 1 << 27,
            .texelElements = 1 << 16,
            .allocation = 1 << 30,
            .subgroupSize = 0};
}

DeviceLimits lowered(DeviceLimits limits, const DeviceLimits& most) {
    const auto lower = [](auto& value, auto bound) {
        if (bound != 0) value = std::min(value, bound);
    };
    lower(limits.groups, most.groups);
    lower(limits.invocations, most.invocations);
    lower(limits.sharedMemory, most.sharedMemory);
    lower(limits.pushConstants, most.pushConstants);
    lower(limits.storageRange, most.storageRange);
    lower(limits.texelElements, most.texelElements);
    lower(limits.allocation, most.allocation);
    return limits;
}

DeviceLimits limitsOf(VkPhysicalDevice physical) {
    auto v11 =
        chained<VkPhysicalDeviceVulkan11Properties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES);
    auto all = chained<VkPhysicalDeviceProperties2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &v11);
    vkGetPhysicalDeviceProperties2(physical, &all);
    const VkPhysicalDeviceLimits& most = all.properties.limits;
    const auto leastOf = [](const uint32_t(&axes)[3]) { return std::min({axes[0], axes[1], axes[2]}); };
    return {.groups = std::min(leastOf(most.maxComputeWorkGroupCount), kMostGroups),
            .invocations = std::min(most.maxComputeWorkGroupInvocations, most.maxComputeWorkGroupSize[0]),
            .sharedMemory = most.maxComputeSharedMemorySize,
            .pushConstants = most.maxPushConstantsSize,
            .storageRange = most.maxStorageBufferRange,
            .texelElements = most.maxTexelBufferElements,
            .allocation = v11.maxMemoryAllocationSize,
            .subgroupSize = v11.subgroupSize};
}

uint64_t budgetLeft(VkPhysicalDevice physical, uint32_t heap) {
    auto budget = chained<VkPhysicalDeviceMemoryBudgetPropertiesEXT>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MEMORY_BUDGET_PROPERTIES_EXT);
    auto all = chained<VkPhysicalDeviceMemoryProperties2>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MEMORY_PROPERTIES_2, &budget);
    vkGetPhysicalDeviceMemoryProperties2(physical, &all);
    return budget.heapBudget[heap] - std::min(budget.heapUsage[heap], budget.heapBudget[heap]);
}

std::optional<uint32_t> universalQueueFamily(VkPhysicalDevice physical) {
    uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
    constexpr VkQueueFlags kNeeded = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    for (uint32_t i = 0; i < count; ++i)
        if ((families[i].queueFlags & kNeeded) == kNeeded) return i;
    return std::nullopt;
}

DeviceCapabilities capabilitiesOf(VkPhysicalDevice physical) {
    auto v11 =
        chained<VkPhysicalDeviceVulkan11Properties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES);
    auto all = chained<VkPhysicalDeviceProperties2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &v11);
    vkGetPhysicalDeviceProperties2(physical, &all);
    DeviceCapabilities has;
    has.vulkan13 = all.properties.apiVersion >= VK_API_VERSION_1_3;
    if (!has.vulkan13) return has;
    Features features;
    vkGetPhysicalDeviceFeatures2(physical, &features.core);
    const VkPhysicalDeviceFeatures& core = features.core.features;
    const DeviceLimits limits = limitsOf(physical);
    constexpr VkSubgroupFeatureFlags kSubgroups =
        VK_SUBGROUP_FEATURE_BASIC_BIT | VK_SUBGROUP_FEATURE_VOTE_BIT | VK_SUBGROUP_FEATURE_ARITHMETIC_BIT |
        VK_SUBGROUP_FEATURE_BALLOT_BIT;
    has.vulkan13 =
        features.v13.synchronization2 && features.v13.dynamicRendering && features.v13.maintenance4;
    has.scalarBlocks = features.v12.scalarBlockLayout;
    has.universalQueue = universalQueueFamily(physical).has_value();
    has.subgroups = (v11.subgroupSupportedOperations & kSubgroups) == kSubgroups &&
                    (v11.subgroupSupportedStages & VK_SHADER_STAGE_COMPUTE_BIT) && limits.subgroupSize >= 4;
    has.storageFormats = core.shaderStorageImageExtendedFormats;
    has.storesFromFragments = core.fragmentStoresAndAtomics;
    has.largeGroups = limits.invocations >= kInvocations;
    has.pushDescriptors = hasExtension(physical, VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME);
    has.largeTexelBuffers = !limits.texelsInStorage();
    has.int64Atomics = core.shaderInt64 && features.v12.shaderBufferInt64Atomics;
    has.geometryShader = core.geometryShader;
    has.deviceAddresses = features.v12.bufferDeviceAddress;
    has.memoryBudget = hasExtension(physical, VK_EXT_MEMORY_BUDGET_EXTENSION_NAME);
    return has;
}

std::vector<std::string> missing(const DeviceCapabilities& has) {
    std::vector<std::string> names;
    for (const Capability& capability : kCapabilities)
        if (!capability.without && !(has.*capability.has)) names.emplace_back(capability.name);
    return names;
}

}  // namespace fw
