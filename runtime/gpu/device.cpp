#include "runtime/gpu/device.h"

#include <sched.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <future>
#include <set>

#include "graph/base/words.h"
#include "runtime/gpu/precision.h"
#include "runtime/system/behind.h"
#include "runtime/system/cache_file.h"

namespace fw {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

/// What the layer said of any device of this process.
struct {
    std::mutex mutex;
    std::vector<std::string> messages;
} messagesOfAll;

/// FIELDWRIGHT_VALIDATION; empty where it asks for nothing.
std::string askedFor() {
    const char* variable = std::getenv("FIELDWRIGHT_VALIDATION");
    return variable && std::strcmp(variable, "0") != 0 ? variable : "";
}

VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                         VkDebugUtilsMessageTypeFlagsEXT,
                                         const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    auto* record = static_cast<DeviceRecord*>(user);
    {
        std::lock_guard lock(record->mutex);
        record->messages.emplace_back(data->pMessage);
    }
    std::lock_guard lock(messagesOfAll.mutex);
    messagesOfAll.messages.emplace_back(data->pMessage);
    if (!askedFor().empty()) std::fprintf(stderr, "validation layer: %s\n", data->pMessage);
    return VK_FALSE;
}

VkDebugUtilsMessengerCreateInfoEXT messengerInfo(DeviceRecord* record) {
    auto info =
        zeroed<VkDebugUtilsMessengerCreateInfoEXT>(VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT);
    info.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    info.messageType =
        VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
    info.pfnUserCallback = onMessage;
    info.pUserData = record;
    return info;
}

bool hasLayer(const char* name) {
    uint32_t count = 0;
    vkEnumerateInstanceLayerProperties(&count, nullptr);
    std::vector<VkLayerProperties> layers(count);
    vkEnumerateInstanceLayerProperties(&count, layers.data());
    return std::any_of(layers.begin(), layers.end(),
                       [&](const VkLayerProperties& layer) { return !std::strcmp(layer.layerName, name); });
}

VkInstance createInstance(std::vector<const char*> extensions, DeviceRecord* record) {
    auto application = zeroed<VkApplicationInfo>(VK_STRUCTURE_TYPE_APPLICATION_INFO);
    application.pApplicationName = "fieldwright";
    application.apiVersion = VK_API_VERSION_1_3;
    auto info = zeroed<VkInstanceCreateInfo>(VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO);
    info.pApplicationInfo = &application;
    VkDebugUtilsMessengerCreateInfoEXT messenger = messengerInfo(record);
    // Beside the use of each call the layer looks at the order of reads and writes; "gpu" has it look at what
    // shaders reach, too.
    constexpr VkValidationFeatureEnableEXT kEnabled[] = {
        VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT,
        VK_VALIDATION_FEATURE_ENABLE_GPU_ASSISTED_EXT,
        VK_VALIDATION_FEATURE_ENABLE_GPU_ASSISTED_RESERVE_BINDING_SLOT_EXT};
    auto validated = zeroed<VkValidationFeaturesEXT>(VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT);
    validated.enabledValidationFeatureCount = askedFor() == "gpu" ? 3 : 1;
    validated.pEnabledValidationFeatures = kEnabled;
    if (record) {
        if (!hasLayer(kValidationLayer))
            throw SystemError(
                std::string(kValidationLayer) +
                " is not installed: install vulkan-validationlayers or unset FIELDWRIGHT_VALIDATION");
        info.enabledLayerCount = 1;
        info.ppEnabledLayerNames = &kValidationLayer;
        info.pNext = &messenger;
        messenger.pNext = &validated;
        extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
        extensions.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);
    }
    info.enabledExtensionCount = uint32_t(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    VkInstance instance = VK_NULL_HANDLE;
    check(vkCreateInstance(&info, nullptr, &instance), "creating a Vulkan instance");
    return instance;
}

struct Candidate {
    VkPhysicalDevice physical;
    VkPhysicalDeviceProperties properties;
    DeviceInfo info;
    int rank;
    VkDriverId driver;
};

std::vector<Candidate> candidates(VkInstance instance) {
    uint32_t count = 0;
    if (vkEnumeratePhysicalDevices(instance, &count, nullptr) != VK_SUCCESS) return {};
    std::vector<VkPhysicalDevice> handles(count);
    check(vkEnumeratePhysicalDevices(instance, &count, handles.data()), "listing the Vulkan devices");
    std::vector<Candidate> all;
    for (VkPhysicalDevice physical : handles) {
        auto driver =
            zeroed<VkPhysicalDeviceDriverProperties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES);
        auto properties = zeroed<VkPhysicalDeviceProperties2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2);
        properties.pNext = &driver;
        vkGetPhysicalDeviceProperties2(physical, &properties);
        struct Kind {
            int rank;
            const char* name;
        };
        auto kindOf = [](VkPhysicalDeviceType type) -> Kind {
            switch (type) {
                case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU: return {0, "discrete"};
                case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU: return {1, "integrated"};
                case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU: return {2, "virtual"};
                case VK_PHYSICAL_DEVICE_TYPE_CPU: return {3, "software"};
                default: return {4, "other"};
            }
        };
        Kind kind = kindOf(properties.properties.deviceType);
        VkPhysicalDeviceMemoryProperties memory;
        vkGetPhysicalDeviceMemoryProperties(physical, &memory);
        uint64_t largest = 0;
        for (uint32_t i = 0; i < memory.memoryHeapCount; ++i)
            if (memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT)
                largest = std::max<uint64_t>(largest, memory.memoryHeaps[i].size);
        const DeviceCapabilities has = capabilitiesOf(physical);
        all.push_back({physical, properties.properties,
                       DeviceInfo{properties.properties.deviceName, kind.name,
                                  std::string(driver.driverName) + " " + driver.driverInfo,
                                  properties.properties.apiVersion, largest, missing(has).empty(), has,
                                  limitsOf(physical)},
                       kind.rank, driver.driverID});
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const Candidate& a, const Candidate& b) { return a.rank < b.rank; });
    return all;
}

std::string lowered(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    return text;
}

/// The candidate that `pick` asks for, or the first usable one.
Result<const Candidate*> choose(const std::vector<Candidate>& all, const std::string& pick) {
    std::string list;
    for (std::size_t i = 0; i < all.size(); ++i)
        list += (i ? ", " : "") + std::to_string(i) + " '" + all[i].info.name + "'";
    const Candidate* found = nullptr;
    bool number = !pick.empty() && pick.size() < 4 && std::all_of(pick.begin(), pick.end(), ::isdigit);
    for (std::size_t i = 0; i < all.size() && !found; ++i) {
        if (pick.empty() ? all[i].info.usable
            : number     ? std::size_t(std::stoi(pick)) == i
                         : lowered(all[i].info.name).find(lowered(pick)) != std::string::npos)
            found = &all[i];
    }
    if (!pick.empty() && !found)
        return Error{.message = "no device matches '" + pick + "'; there are: " + list};
    if (found && !found->info.usable)
        return Error{.message = "device '" + found->info.name + "' lacks " +
                                listed(missing(found->info.has)) + "; there are: " + list};
    if (!found)
        throw SystemError(
            all.empty() ? "no Vulkan device found: install mesa-vulkan-drivers, which has one in software"
                        : "no Vulkan device has all that is needed; there are: " + list);
    return found;
}

bool everythingMappable(const VkPhysicalDeviceMemoryProperties& memory) {
    constexpr VkMemoryPropertyFlags kMapped = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT |
                                              VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT |
                                              VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    for (uint32_t i = 0; i < memory.memoryHeapCount; ++i)
        if (!(memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT)) return false;
    for (uint32_t i = 0; i < memory.memoryTypeCount; ++i)
        if ((memory.memoryTypes[i].propertyFlags & kMapped) == kMapped) return true;
    return false;
}

std::string pipelineCachePath(const VkPhysicalDeviceProperties& properties) {
    static const char* digits = "0123456789abcdef";
    std::string name;
    for (uint8_t byte : properties.pipelineCacheUUID) name += {digits[byte >> 4], digits[byte & 15]};
    return cachePath("pipelines", name);
}

std::set<pid_t> threadsOfProcess() {
    std::set<pid_t> threads;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator("/proc/self/task", error))
        threads.insert(std::atoi(entry.path().filename().c_str()));
    return threads;
}

/// Gives each thread that is not in `before` a processor of its own, in turn. The workers of a software
/// device wake at the same moment from the same thread, and Linux then tends to leave both of two on one
/// processor: half the speed, for as long as the program runs.
void spreadThreads(const std::set<pid_t>& before) {
    cpu_set_t allowed;
    if (sched_getaffinity(0, sizeof allowed, &allowed) != 0) return;
    int processor = -1;
    for (pid_t thread : threadsOfProcess()) {
        if (before.contains(thread)) continue;
        do processor = (processor + 1) % CPU_SETSIZE;
        while (!CPU_ISSET(processor, &allowed));
        cpu_set_t one;
        CPU_ZERO(&one);
        CPU_SET(processor, &one);
        sched_setaffinity(thread, sizeof one, &one);
    }
}

void createLogicalDevice(Device& device, const DeviceOptions& options) {
    Features offered, wanted;
    vkGetPhysicalDeviceFeatures2(device.physical, &offered.core);
    const VkPhysicalDeviceFeatures& core = offered.core.features;
    wanted.core.features.geometryShader = device.has.geometryShader;
    wanted.core.features.fragmentStoresAndAtomics = core.fragmentStoresAndAtomics;
    wanted.core.features.vertexPipelineStoresAndAtomics = core.vertexPipelineStoresAndAtomics;
    wanted.core.features.shaderInt64 = core.shaderInt64;
    wanted.core.features.fillModeNonSolid = core.fillModeNonSolid;
    wanted.core.features.shaderStorageImageExtendedFormats = VK_TRUE;
    wanted.v12.scalarBlockLayout = VK_TRUE;
    wanted.v12.bufferDeviceAddress = device.has.deviceAddresses;
    wanted.v12.shaderOutputLayer = offered.v12.shaderOutputLayer;
    wanted.v12.shaderBufferInt64Atomics = device.has.int64Atomics;
    wanted.v12.hostQueryReset = offered.v12.hostQueryReset;
    wanted.v13.synchronization2 = VK_TRUE;
    wanted.v13.dynamicRendering = VK_TRUE;
    wanted.v13.maintenance4 = VK_TRUE;

    float priority = 1.0f;
    auto queue = zeroed<VkDeviceQueueCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO);
    queue.queueFamilyIndex = device.queueFamily;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    std::vector<const char*> extensions;
    if (device.has.pushDescriptors) extensions.push_back(VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME);
    if (options.presentation) extensions.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
    auto info = zeroed<VkDeviceCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO);
    info.pNext = &wanted.core;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    info.enabledExtensionCount = uint32_t(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    const std::set<pid_t> threads = threadsOfProcess();
    check(vkCreateDevice(device.physical, &info, nullptr, &device.handle), "opening the Vulkan device");
    if (device.software) spreadThreads(threads);
    vkGetDeviceQueue(device.handle, device.queueFamily, 0, &device.queue);
    // The layer knows what shaders reach through sets alone.
    if (device.has.pushDescriptors && askedFor() != "gpu")
        device.pushDescriptors = reinterpret_cast<PFN_vkCmdPushDescriptorSetKHR>(
            vkGetDeviceProcAddr(device.handle, "vkCmdPushDescriptorSetKHR"));
}

void createPools(Device& device) {
    auto pool = zeroed<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
    pool.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
    pool.queueFamilyIndex = device.queueFamily;
    check(vkCreateCommandPool(device.handle, &pool, nullptr, &device.commandPool), "creating a command pool");
    auto fence = zeroed<VkFenceCreateInfo>(VK_STRUCTURE_TYPE_FENCE_CREATE_INFO);
    check(vkCreateFence(device.handle, &fence, nullptr, &device.fence), "creating a fence");

    std::vector<uint32_t> stored = readCacheFile(pipelineCachePath(device.properties), 0);
    device.pipelineCacheKey = hashBytes(stored.data(), stored.size() * 4);
    auto cache = zeroed<VkPipelineCacheCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO);
    cache.initialDataSize = stored.size() * 4;
    cache.pInitialData = stored.data();
    check(vkCreatePipelineCache(device.handle, &cache, nullptr, &device.pipelineCache),
          "creating the pipeline cache");
}

void savePipelineCache(const Device& device) {
    std::size_t size = 0;
    constexpr std::size_t kHeaderOnly = 32;  // the header that Vulkan prescribes, with nothing behind it
    if (vkGetPipelineCacheData(device.handle, device.pipelineCache, &size, nullptr) != VK_SUCCESS ||
        size <= kHeaderOnly)
        return;
    std::vector<uint32_t> data((size + 3) / 4);
    if (vkGetPipelineCacheData(device.handle, device.pipelineCache, &size, data.data()) != VK_SUCCESS) return;
    if (hashBytes(data.data(), data.size() * 4) != device.pipelineCacheKey)
        writeCacheFile(pipelineCachePath(device.properties), 0, data);
}

}  // namespace

void check(VkResult result, const char* what) {
    if (result >= 0) return;
    auto reason = [&]() -> std::string {
        switch (result) {
            case VK_ERROR_OUT_OF_HOST_MEMORY:
                return "the system is out of memory; a lower resolution needs less";
            case VK_ERROR_OUT_OF_DEVICE_MEMORY:
            case VK_ERROR_OUT_OF_POOL_MEMORY:
            case VK_ERROR_FRAGMENTATION: return "the device is out of memory; a lower resolution needs less";
            case VK_ERROR_MEMORY_MAP_FAILED:
                return "the system has no room to show the device's memory; a lower resolution needs less";
            case VK_ERROR_DEVICE_LOST: return "the device was lost (its driver crashed or was reset)";
            case VK_ERROR_SURFACE_LOST_KHR: return "the window's surface was lost";
            case VK_ERROR_INITIALIZATION_FAILED: return "the driver failed to start";
            case VK_ERROR_LAYER_NOT_PRESENT: return "a layer is not installed";
            case VK_ERROR_EXTENSION_NOT_PRESENT: return "an extension is missing";
            case VK_ERROR_FEATURE_NOT_PRESENT: return "a feature is missing";
            case VK_ERROR_INCOMPATIBLE_DRIVER:
                return "no Vulkan driver is installed; install mesa-vulkan-drivers";
            case VK_ERROR_FORMAT_NOT_SUPPORTED: return "an image format is not supported";
            default: return "Vulkan error " + std::to_string(int(result));
        }
    };
    const std::string message = std::string(what) + " failed: " + reason();
    switch (result) {
        case VK_ERROR_DEVICE_LOST:
        case VK_ERROR_SURFACE_LOST_KHR: throw DeviceLost(message);
        case VK_ERROR_OUT_OF_HOST_MEMORY:
        case VK_ERROR_OUT_OF_DEVICE_MEMORY:
        case VK_ERROR_OUT_OF_POOL_MEMORY:
        case VK_ERROR_FRAGMENTATION:
        case VK_ERROR_MEMORY_MAP_FAILED: throw DeviceTooSmall(message);
        default: throw SystemError(message);
    }
}

Device::Device(Device&& other) noexcept : DeviceState(std::exchange(static_cast<DeviceState&>(other), {})) {}

Device& Device::operator=(Device&& other) noexcept {
    std::swap(static_cast<DeviceState&>(*this), static_cast<DeviceState&>(other));
    return *this;
}

Device::~Device() {
    if (instance && record)  // before the instance that they were made with
        record->sibling.reset(), record->siblingBehind.reset();
    if (handle) {
        vkDeviceWaitIdle(handle);
        record->written.reset(), record->read.reset();
        if (pipelineCache) {
            savePipelineCache(*this);
            vkDestroyPipelineCache(handle, pipelineCache, nullptr);
        }
        for (const SentCommands& each : record->sent)
            for (VkDescriptorPool pool : each.pools) vkDestroyDescriptorPool(handle, pool, nullptr);
        for (VkDescriptorPool pool : record->freePools) vkDestroyDescriptorPool(handle, pool, nullptr);
        vkDestroyFence(handle, fence, nullptr);
        vkDestroyCommandPool(handle, commandPool, nullptr);
        vkDestroyDevice(handle, nullptr);
    }
    if (messenger) {
        auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(instance, "vkDestroyDebugUtilsMessengerEXT"));
        destroy(instance, messenger, nullptr);
    }
    if (instance) vkDestroyInstance(instance, nullptr);
}

std::vector<std::string> Device::validationMessages() const {
    if (!record) return {};
    std::lock_guard lock(record->mutex);
    return record->messages;
}

std::vector<std::string> validationMessages() {
    std::lock_guard lock(messagesOfAll.mutex);
    return messagesOfAll.messages;
}

std::vector<DeviceInfo> listDevices() {
    Device holder;
    try {
        holder.instance = createInstance({}, nullptr);
    } catch (const SystemError&) { return {}; }
    std::vector<DeviceInfo> infos;
    for (const Candidate& candidate : candidates(holder.instance)) infos.push_back(candidate.info);
    return infos;
}

Result<Device> createDevice(const DeviceOptions& options) {
    const bool validation = options.validation || !askedFor().empty();
    Device device;
    device.asked = options;
    device.record = std::make_shared<DeviceRecord>();
    device.instance = createInstance(options.instanceExtensions, validation ? device.record.get() : nullptr);
    if (validation) {
        auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(device.instance, "vkCreateDebugUtilsMessengerEXT"));
        VkDebugUtilsMessengerCreateInfoEXT info = messengerInfo(device.record.get());
        check(create(device.instance, &info, nullptr, &device.messenger),
              "listening to the validation layer");
    }

    std::vector<Candidate> all = candidates(device.instance);
    Result<const Candidate*> choice = choose(all, options.pick);
    if (!choice) return choice.error();
    device.physical = (*choice)->physical;
    device.properties = (*choice)->properties;
    device.queueFamily = *universalQueueFamily(device.physical);
    vkGetPhysicalDeviceMemoryProperties(device.physical, &device.memory);
    device.limits = (*choice)->info.limits;
    device.has = (*choice)->info.has;
    device.software = device.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    device.unifiedMemory = everythingMappable(device.memory);
    device.timestamps = !device.software && device.properties.limits.timestampComputeAndGraphics;
    createLogicalDevice(device, options);
    createPools(device);
    if ((*choice)->driver != VK_DRIVER_ID_MESA_LLVMPIPE) device.precision = measurePrecision(device);
    return device;
}

Device reopenDevice(const DeviceOptions& asked) {
    const DeviceOptions again = asked;  // it may be the lost one's, and that goes
    Result<Device> device = createDevice(again);
    if (!device)
        throw SystemError(
            "the device was lost (its driver crashed or was reset), and none opens in its place: " +
            device.error().message);
    return std::move(*device);
}

SystemError lostAgain(const DeviceLost& lost) {
    return SystemError(
        std::string(lost.what()) +
        ", and again after it was opened anew: lower the resolution or the picture's size, end "
        "other programs that use it, pick another device, or update its driver");
}

const Device& siblingOf(const Device& device, bool behind) {
    std::lock_guard lock(device.record->mutex);
    std::unique_ptr<Device>& sibling = behind ? device.record->siblingBehind : device.record->sibling;
    if (sibling) return *sibling;
    auto made = std::make_unique<Device>();
    static_cast<DeviceState&>(*made) = device;
    made->instance = VK_NULL_HANDLE;  // the device's own
    made->messenger = VK_NULL_HANDLE;
    made->handle = VK_NULL_HANDLE;
    made->record = std::make_shared<DeviceRecord>();
    const auto open = [&] { createLogicalDevice(*made, {}); };
    if (behind)  // its threads come from one that lets others go before it
        std::async(std::launch::async, [&] { workBehind(), open(); }).get();
    else
        open();
    createPools(*made);
    sibling = std::move(made);
    return *sibling;
}

void waitIdle(const Device& device) { check(vkDeviceWaitIdle(device.handle), "waiting for the device"); }

}  // namespace fw
