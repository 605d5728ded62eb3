// A Vulkan layer that makes devices fail as real ones do: it loses them, has no more memory for them, and
// tells a budget. tests/support/faults.h says by which variables it is told what to do; they are read
// whenever a device is made. A lost device has done what was submitted before: what is destroyed then is not
// in use.
#include <unistd.h>
#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <mutex>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace {

struct InstanceCalls {
    VkInstance handle = VK_NULL_HANDLE;
    PFN_vkGetInstanceProcAddr get = nullptr;
    PFN_vkDestroyInstance destroy = nullptr;
    bool hasLost = false;  // a device: its others are not counted any more
    template <class Function>
    Function next(const char* name) const {
        return reinterpret_cast<Function>(get(handle, name));
    }
};

struct DeviceCalls {
    VkDevice handle = VK_NULL_HANDLE;
    InstanceCalls* instance = nullptr;
    PFN_vkGetDeviceProcAddr get = nullptr;
    bool counted = false;              // its submissions are
    std::atomic<bool> lost = false;    // at once
    std::atomic<bool> losing = false;  // when the submission under way is awaited
    template <class Function>
    Function next(const char* name) const {
        return reinterpret_cast<Function>(get(handle, name));
    }
};
#define NEXT(of, name) (of).next<PFN_##name>(#name)

std::mutex use;
std::map<void*, InstanceCalls> instances;
std::map<void*, DeviceCalls> devices;
std::map<VkDeviceMemory, VkDeviceSize> memories;
VkDeviceSize allocated = 0;  // by all devices
long submissions = 0;        // of those that are counted

/// What an object and those made from it have in common.
void* key(const void* object) { return *static_cast<void* const*>(object); }

template <class Calls>
Calls& of(std::map<void*, Calls>& all, const void* object) {
    std::lock_guard lock(use);
    return all.at(key(object));
}

const char* variable(const char* name) {
    const char* value = std::getenv(name);
    return value && *value ? value : nullptr;
}

uint64_t number(const char* name, uint64_t otherwise) {
    const char* value = variable(name);
    return value ? std::strtoull(value, nullptr, 10) : otherwise;
}

/// The layer's link in the chain, which the next layer's then follows.
template <class Link, class Info>
Link* advance(const Info* info, VkStructureType type) {
    for (auto* link = static_cast<const Link*>(info->pNext); link;
         link = static_cast<const Link*>(link->pNext))
        if (link->sType == type && link->function == VK_LAYER_LINK_INFO) return const_cast<Link*>(link);
    return nullptr;
}

/// Whether this submission is one at which a device is to be lost; negative if it is when it is awaited.
int isLast() {
    if (const char* path = variable("FAULTY_LOSE_FILE")) {
        std::ifstream file(path);
        int more = 0;
        if (file >> more) {  // one that is empty is still being written
            if (more <= 1) return unlink(path), 1;
            return std::ofstream(path) << more - 1, 1;
        }
    }
    static std::string told;  // other numbers are counted from the start again
    const std::string list = variable("FAULTY_LOSE") ? variable("FAULTY_LOSE") : "";
    if (std::exchange(told, list) != list) submissions = 0;
    ++submissions;
    std::istringstream numbers(list);
    for (long at = 0; numbers >> at;)
        if (std::abs(at) == submissions) return at < 0 ? -1 : 1;
    return 0;
}

VKAPI_ATTR VkResult VKAPI_CALL createInstance(const VkInstanceCreateInfo* info,
                                              const VkAllocationCallbacks* callbacks, VkInstance* instance) {
    auto* link = advance<VkLayerInstanceCreateInfo>(info, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO);
    const PFN_vkGetInstanceProcAddr get = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const auto create = reinterpret_cast<PFN_vkCreateInstance>(get(VK_NULL_HANDLE, "vkCreateInstance"));
    const VkResult result = create(info, callbacks, instance);
    if (result != VK_SUCCESS) return result;
    std::lock_guard lock(use);
    // Asked for later, the loader may name the layer before this one.
    const auto destroy = reinterpret_cast<PFN_vkDestroyInstance>(get(*instance, "vkDestroyInstance"));
    instances[key(*instance)] = {*instance, get, destroy};
    return result;
}

VKAPI_ATTR void VKAPI_CALL destroyInstance(VkInstance instance, const VkAllocationCallbacks* callbacks) {
    if (!instance) return;
    void* const which = key(instance);
    of(instances, instance).destroy(instance, callbacks);
    std::lock_guard lock(use);
    instances.erase(which);
}

VKAPI_ATTR VkResult VKAPI_CALL createDevice(VkPhysicalDevice physical, const VkDeviceCreateInfo* info,
                                            const VkAllocationCallbacks* callbacks, VkDevice* device) {
    auto* link = advance<VkLayerDeviceCreateInfo>(info, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
    const PFN_vkGetInstanceProcAddr getInstance = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    const PFN_vkGetDeviceProcAddr get = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    InstanceCalls& instance = of(instances, physical);
    const auto create = reinterpret_cast<PFN_vkCreateDevice>(getInstance(instance.handle, "vkCreateDevice"));
    const VkResult result = create(physical, info, callbacks, device);
    if (result != VK_SUCCESS) return result;
    const auto names = info->ppEnabledExtensionNames;
    const bool presents = std::any_of(names, names + info->enabledExtensionCount, [](const char* name) {
        return !std::strcmp(name, VK_KHR_SWAPCHAIN_EXTENSION_NAME);
    });
    const char* only = variable("FAULTY_PRESENTING");
    std::lock_guard lock(use);
    DeviceCalls& calls = devices[key(*device)];
    calls.handle = *device;
    calls.instance = &instance;
    calls.get = get;
    calls.counted = !only || presents == (*only == '1');
    return result;
}

VKAPI_ATTR void VKAPI_CALL destroyDevice(VkDevice device, const VkAllocationCallbacks* callbacks) {
    if (!device) return;
    void* const which = key(device);
    NEXT(of(devices, device), vkDestroyDevice)(device, callbacks);
    std::lock_guard lock(use);
    devices.erase(which);
}

VKAPI_ATTR VkResult VKAPI_CALL queueSubmit2(VkQueue queue, uint32_t count, const VkSubmitInfo2* infos,
                                            VkFence fence) {
    DeviceCalls& calls = of(devices, queue);
    if (calls.counted && !calls.lost) {
        std::unique_lock lock(use);
        const int last = calls.instance->hasLost ? 0 : isLast();
        calls.instance->hasLost |= last != 0;
        lock.unlock();
        if (last > 0) {
            NEXT(calls, vkDeviceWaitIdle)(calls.handle);
            calls.lost = true;
        }
        if (last < 0) calls.losing = true;
    }
    return calls.lost ? VK_ERROR_DEVICE_LOST : NEXT(calls, vkQueueSubmit2)(queue, count, infos, fence);
}

VKAPI_ATTR VkResult VKAPI_CALL waitForFences(VkDevice device, uint32_t count, const VkFence* fences,
                                             VkBool32 all, uint64_t timeout) {
    DeviceCalls& calls = of(devices, device);
    if (calls.lost) return VK_ERROR_DEVICE_LOST;
    const VkResult result = NEXT(calls, vkWaitForFences)(device, count, fences, all, timeout);
    if (!calls.losing) return result;
    NEXT(calls, vkDeviceWaitIdle)(device);
    calls.lost = true;
    return VK_ERROR_DEVICE_LOST;
}

VKAPI_ATTR VkResult VKAPI_CALL deviceWaitIdle(VkDevice device) {
    DeviceCalls& calls = of(devices, device);
    const VkResult result = NEXT(calls, vkDeviceWaitIdle)(device);
    return calls.lost ? VK_ERROR_DEVICE_LOST : result;
}

VKAPI_ATTR VkResult VKAPI_CALL queueWaitIdle(VkQueue queue) {
    DeviceCalls& calls = of(devices, queue);
    const VkResult result = NEXT(calls, vkQueueWaitIdle)(queue);
    return calls.lost ? VK_ERROR_DEVICE_LOST : result;
}

VKAPI_ATTR VkResult VKAPI_CALL allocateMemory(VkDevice device, const VkMemoryAllocateInfo* info,
                                              const VkAllocationCallbacks* callbacks,
                                              VkDeviceMemory* memory) {
    DeviceCalls& calls = of(devices, device);
    const uint64_t most = number("FAULTY_MEMORY", UINT64_MAX);
    {
        std::lock_guard lock(use);
        if (allocated + info->allocationSize > most) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    }
    const VkResult result = NEXT(calls, vkAllocateMemory)(device, info, callbacks, memory);
    if (result != VK_SUCCESS) return result;
    std::lock_guard lock(use);
    memories[*memory] = info->allocationSize;
    allocated += info->allocationSize;
    return result;
}

VKAPI_ATTR void VKAPI_CALL freeMemory(VkDevice device, VkDeviceMemory memory,
                                      const VkAllocationCallbacks* callbacks) {
    DeviceCalls& calls = of(devices, device);
    {
        std::lock_guard lock(use);
        if (const auto found = memories.find(memory); found != memories.end()) {
            allocated -= found->second;
            memories.erase(found);
        }
    }
    NEXT(calls, vkFreeMemory)(device, memory, callbacks);
}

VKAPI_ATTR VkResult VKAPI_CALL mapMemory(VkDevice device, VkDeviceMemory memory, VkDeviceSize offset,
                                         VkDeviceSize size, VkMemoryMapFlags flags, void** data) {
    DeviceCalls& calls = of(devices, device);
    const uint64_t most = number("FAULTY_MAPPED", UINT64_MAX);
    {
        std::lock_guard lock(use);
        if (memories.at(memory) > most) return VK_ERROR_MEMORY_MAP_FAILED;
    }
    return NEXT(calls, vkMapMemory)(device, memory, offset, size, flags, data);
}

PFN_vkVoidFunction VKAPI_CALL getDevice(VkDevice device, const char* name);
PFN_vkVoidFunction VKAPI_CALL getInstance(VkInstance instance, const char* name);

PFN_vkVoidFunction own(const char* name) {
    static const std::map<std::string, PFN_vkVoidFunction> all = {
#define OWN(name, function) {#name, reinterpret_cast<PFN_vkVoidFunction>(static_cast<PFN_##name>(function))}
        OWN(vkGetInstanceProcAddr, getInstance),
        OWN(vkGetDeviceProcAddr, getDevice),
        OWN(vkCreateInstance, createInstance),
        OWN(vkDestroyInstance, destroyInstance),
        OWN(vkCreateDevice, createDevice),
        OWN(vkDestroyDevice, destroyDevice),
        OWN(vkQueueSubmit2, queueSubmit2),
        OWN(vkWaitForFences, waitForFences),
        OWN(vkDeviceWaitIdle, deviceWaitIdle),
        OWN(vkQueueWaitIdle, queueWaitIdle),
        OWN(vkAllocateMemory, allocateMemory),
        OWN(vkFreeMemory, freeMemory),
        OWN(vkMapMemory, mapMemory),
#undef OWN
    };
    const auto found = all.find(name);
    return found == all.end() ? nullptr : found->second;
}

PFN_vkVoidFunction VKAPI_CALL getDevice(VkDevice device, const char* name) {
    if (const PFN_vkVoidFunction function = own(name)) return function;
    return of(devices, device).get(device, name);
}

PFN_vkVoidFunction VKAPI_CALL getInstance(VkInstance instance, const char* name) {
    if (const PFN_vkVoidFunction function = own(name)) return function;
    return instance ? of(instances, instance).get(instance, name) : nullptr;
}

}  // namespace

extern "C" VKAPI_ATTR VkResult VKAPI_CALL
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* interface) {
    interface->loaderLayerInterfaceVersion = 2;
    interface->pfnGetInstanceProcAddr = getInstance;
    interface->pfnGetDeviceProcAddr = getDevice;
    interface->pfnGetPhysicalDeviceProcAddr = nullptr;
    return VK_SUCCESS;
}
