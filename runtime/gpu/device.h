// The Vulkan device: one instance, one physical device, one queue that does everything.
//
// A plain move-only struct in the manner of niagara: handles and what was found out about the device, no
// framework around them. It outlives every Buffer, Image, Pipeline and Commands made from it. Recording and
// submitting belong to one thread at a time; creating pipelines and resources may run on several.
#pragma once

#include <vulkan/vulkan.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <semaphore>
#include <string>
#include <vector>

#include "graph/base/result.h"
#include "runtime/gpu/capabilities.h"

namespace fw {

/// The driver crashed or was reset. What was made from the device is good for nothing but to be destroyed;
/// the work can begin again on another that is opened in its place.
struct DeviceLost : SystemError {
    using SystemError::SystemError;
};

/// The device has no room: memory that it lacks, or more of a buffer than it shows a kernel. Less at once may
/// do: tiles, a lower resolution.
struct DeviceTooSmall : SystemError {
    using SystemError::SystemError;
};

struct DeviceOptions {
    std::string pick =
        {};  ///< index in listDevices() or part of a name, without regard to case; empty: chosen
    /// Load the validation layer, which looks at synchronization too. FIELDWRIGHT_VALIDATION=1 in the
    /// environment asks for the same and has its messages on standard error, FIELDWRIGHT_VALIDATION=gpu also
    /// for what shaders reach.
    bool validation = false;
    std::vector<const char*> instanceExtensions = {};  ///< what a window system needs
    bool presentation = false;                         ///< VK_KHR_swapchain
};

/// What `fieldwright info` says of a device.
struct DeviceInfo {
    std::string name;
    std::string kind;         ///< "discrete", "integrated", "virtual", "software", "other"
    std::string driver;       ///< name and version as the driver states them
    uint32_t apiVersion = 0;  ///< as VK_MAKE_API_VERSION packs it
    uint64_t memory = 0;      ///< bytes of the largest device-local heap
    bool usable = false;      ///< has all that Fieldwright needs
    DeviceCapabilities has;
    DeviceLimits limits;
};

struct Device;

/// A recording that was sent and not yet waited for: what is freed then.
struct SentCommands {
    VkCommandBuffer handle;
    std::vector<VkDescriptorPool> pools;
};

struct Buffer;

/// What the validation layer said, the bytes of device memory that are and were in use, the number of
/// pipelines that were built, of recordings that were submitted and of those that were waited for, the
/// descriptor pools that no recording uses, what runs, the buffers through which the host writes and reads
/// those that it does not see (resources.h), and the siblings.
struct DeviceRecord {
    std::mutex mutex;
    std::vector<std::string> messages;
    std::vector<VkDescriptorPool> freePools;
    std::vector<SentCommands> sent;
    std::atomic<uint64_t> allocated = 0, peak = 0, pipelines = 0, submissions = 0, waits = 0;
    std::shared_ptr<Buffer> written, read;
    std::unique_ptr<Device> sibling, siblingBehind;
    std::binary_semaphore unused{1};  ///< of a sibling: nobody uses it
};

/// What its functions err by beyond what intervals allow for anyway: precision.h.
struct Precision {
    float sine = 0.0f;  ///< of sines and cosines, absolute
    float curves =
        0.0f;  ///< of powers, exponentials, logarithms and inverse sines to tangents: of 1 + their size
};

/// The plain part of a Device, so that moving it is one exchange.
struct DeviceState {
    VkInstance instance = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    VkDevice handle = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;
    uint32_t queueFamily = 0;
    VkCommandPool commandPool = VK_NULL_HANDLE;
    VkFence fence = VK_NULL_HANDLE;
    VkPipelineCache pipelineCache = VK_NULL_HANDLE;
    uint64_t pipelineCacheKey =
        0;  ///< of the content that was loaded; what did not change is not written again
    PFN_vkCmdPushDescriptorSetKHR pushDescriptors = nullptr;  ///< without it, sets come from pools

    DeviceOptions asked;  ///< as createDevice() was

    VkPhysicalDeviceProperties properties = {};
    VkPhysicalDeviceMemoryProperties memory = {};
    DeviceLimits limits;
    DeviceCapabilities has;
    Precision precision;
    bool software = false;                 ///< a CPU device: its timestamps lie, and copies to it are wasted
    bool unifiedMemory = false;            ///< device-local memory is host-visible: every buffer is mapped
    bool timestamps = false;               ///< usable ones
    std::shared_ptr<DeviceRecord> record;  ///< address stays put when the device moves
};

struct Device : DeviceState {
    Device() = default;
    Device(Device&& other) noexcept;
    Device& operator=(Device&& other) noexcept;
    ~Device();

    std::string name() const { return properties.deviceName; }
    /// Warnings and errors of the validation layer so far; empty without it.
    std::vector<std::string> validationMessages() const;
};

/// Warnings and errors of the validation layer so far, of all devices of this process.
std::vector<std::string> validationMessages();

/// Every Vulkan device, the preferred first (discrete, integrated, virtual, software). Empty where Vulkan has
/// none.
std::vector<DeviceInfo> listDevices();

/// Opens the preferred usable device, or the one that `options.pick` names; an Error where nothing matches
/// it. Throws SystemError where Vulkan or a usable device is missing.
Result<Device> createDevice(const DeviceOptions& options = {});

/// A device in place of one that was lost, as that was asked for. Throws SystemError where there is none any
/// more.
Device reopenDevice(const DeviceOptions& asked);

/// Of a device that was lost a second time within the same work: no DeviceLost, and says what to do.
SystemError lostAgain(const DeviceLost& lost);

/// Does the work; if a device is lost meanwhile, calls `renew`, which opens another in its place, and does
/// the work once more. Throws lostAgain() if one is lost then.
template <class Work, class Renew>
auto onceMoreIfLost(Work work, Renew renew) -> decltype(work()) {
    try {
        return work();
    } catch (const DeviceLost&) {}  // what the work held is gone now
    try {
        renew();
        return work();
    } catch (const DeviceLost& lost) { throw lostAgain(lost); }
}

/// A device that opens beside other work, or at its first use.
class OpeningDevice {
  public:
    /// With std::launch::async it opens from now on, with deferred at the first use.
    OpeningDevice(std::launch when, const DeviceOptions& options)
        : opening(std::async(when, [options] { return createDevice(options); })) {}
    /// Whether get() need not wait; false of one that opens at its first use.
    bool isOpen() const {
        return opened || opening.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    }
    /// Waits until it is open. As createDevice().
    Result<Device>& get() {
        if (!opened) opened.emplace(opening.get());
        return *opened;
    }
    /// The same, and nullptr in place of an Error.
    const Device* orNone() { return get() ? &**opened : nullptr; }

  private:
    std::future<Result<Device>> opening;
    std::optional<Result<Device>> opened;
};

/// Another logical device on the same physical one, opened at the first call. A software device translates
/// kernels on the one thread of its queue; the sibling's queue has a thread of its own, and what it
/// translated is in the driver's disk cache. `behind`: one whose thread lets others go before it
/// (runtime/system/behind.h).
const Device& siblingOf(const Device& device, bool behind = false);

/// Waits for the device to be idle.
void waitIdle(const Device& device);

/// A Vulkan struct with its type set and all else zero.
template <class T>
T zeroed(VkStructureType type) {
    T value{};
    value.sType = type;
    return value;
}

/// Throws SystemError with a sentence for the result unless it is a success, of the kinds above where it is
/// such a failure; `what` names the action.
void check(VkResult result, const char* what);

/// $XDG_CACHE_HOME/fieldwright, or ~/.cache/fieldwright; empty where neither variable is set.
std::string cacheFolder();

}  // namespace fw
