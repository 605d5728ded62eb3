// Buffers and images: thin, move-only, each with its own allocation.
//
// Few and large is the habit here (a stage holds a handful of buffers for as long as the resolution stays),
// so there is no suballocator. On a device with unified memory, software devices among them, every buffer is
// mapped. Others are written and read through two staging buffers that a device keeps: to copy what is small
// through one of its own took 0.85 ms on a graphics card, and takes 0.05. A resource must die before its
// device and after the work that uses it.
#pragma once

#include <cstring>
#include <span>

#include "runtime/gpu/device.h"
#include "runtime/system/large_pages.h"

namespace fw {

/// Where a buffer lives.
enum class Memory {
    device,    ///< fastest for the device; mapped only where memory is unified
    upload,    ///< mapped, written by the host
    readback,  ///< mapped and cached, read by the host
};

struct BufferState {
    VkDevice device = VK_NULL_HANDLE;
    VkBuffer handle = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkDeviceSize size = 0;                 ///< bytes that may be used
    VkDeviceSize allocated = 0;            ///< bytes that were allocated for it
    void* mapped = nullptr;                ///< host address, null if the memory is not host-visible
    VkDeviceAddress address = 0;           ///< 0 where the device has no buffer addresses
    VkBufferView texels = VK_NULL_HANDLE;  ///< all of it as texels of four 32-bit words, where it has so many
    std::shared_ptr<DeviceRecord> record;
};

struct Buffer : BufferState {
    Buffer() = default;
    Buffer(Buffer&& other) noexcept;
    Buffer& operator=(Buffer&& other) noexcept;
    ~Buffer();
    explicit operator bool() const { return handle != VK_NULL_HANDLE; }

    /// The content as elements of T; only where `mapped`, and not while recordings run that were sent: throws
    /// SystemError.
    template <class T>
    std::span<T> as() const {
        mustRest();
        return {static_cast<T*>(mapped), size / sizeof(T)};
    }

  private:
    void mustRest() const;
};

/// A buffer of `size` bytes, or a little more, so that its texels are whole; usable as storage, uniform,
/// indirect, vertex, index, copy source and target. The content is undefined; with validation no zeros.
/// Throws DeviceTooSmall if memory runs out: what the device has, or what it says is left beside other
/// programs.
Buffer createBuffer(const Device& device, VkDeviceSize size, Memory memory = Memory::device);

/// Replaces the buffer by one of at least `size` bytes unless it is as large already; the content is then
/// lost. Returns whether it was replaced. The device must not be using it.
bool reserve(const Device& device, Buffer& buffer, VkDeviceSize size, Memory memory = Memory::device);

/// `size` bytes of a buffer from `offset`, and the host's.
struct Piece {
    const Buffer& buffer;
    void* data;
    std::size_t size;
    VkDeviceSize offset = 0;
};
struct ConstPiece {
    const Buffer& buffer;
    const void* data;
    std::size_t size;
    VkDeviceSize offset = 0;
};

/// Copies bytes into buffers, in no order. Many pieces take one wait, where one by one each took its own.
void uploadPieces(const Device& device, std::span<const ConstPiece> pieces);

/// Copies bytes out of buffers, likewise. Whoever writes them must have been submitted.
void downloadPieces(const Device& device, std::span<const Piece> pieces);

/// The same of one piece.
inline void uploadBytes(const Device& device, const Buffer& buffer, const void* data, std::size_t size,
                        VkDeviceSize offset = 0) {
    const ConstPiece piece{buffer, data, size, offset};
    uploadPieces(device, {&piece, 1});
}
inline void downloadBytes(const Device& device, const Buffer& buffer, void* data, std::size_t size,
                          VkDeviceSize offset = 0) {
    const Piece piece{buffer, data, size, offset};
    downloadPieces(device, {&piece, 1});
}

template <class T>
void upload(const Device& device, const Buffer& buffer, const std::vector<T>& data) {
    uploadBytes(device, buffer, data.data(), data.size() * sizeof(T));
}
template <class T>
std::vector<T> download(const Device& device, const Buffer& buffer, std::size_t count,
                        VkDeviceSize byteOffset = 0) {
    std::vector<T> data;
    resizeInLargePages(data, count);
    downloadBytes(device, buffer, data.data(), count * sizeof(T), byteOffset);
    return data;
}

struct ImageOptions {
    VkExtent3D extent = {1, 1, 1};
    VkFormat format = VK_FORMAT_R8G8B8A8_UNORM;
    VkImageUsageFlags usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                              VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    VkImageType type = VK_IMAGE_TYPE_2D;
    uint32_t mips = 1;
    uint32_t layers = 1;
    VkImageCreateFlags flags = 0;
};

struct ImageState {
    VkDevice device = VK_NULL_HANDLE;
    VkImage handle = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkDeviceSize allocated = 0;
    VkImageView view = VK_NULL_HANDLE;  ///< of all mips and layers
    VkFormat format = VK_FORMAT_UNDEFINED;
    VkImageAspectFlags aspect = 0;
    VkExtent3D extent = {};
    uint32_t mips = 1, layers = 1;
    std::shared_ptr<DeviceRecord> record;
};

struct Image : ImageState {
    Image() = default;
    Image(Image&& other) noexcept;
    Image& operator=(Image&& other) noexcept;
    ~Image();
    explicit operator bool() const { return handle != VK_NULL_HANDLE; }
};

/// An image in device memory with a view of all of it; its layout is undefined until a barrier sets one.
Image createImage(const Device& device, const ImageOptions& options);

/// A view of one mip level and `layers` layers; the caller destroys it with vkDestroyImageView.
VkImageView createView(const Image& image, VkImageViewType type, uint32_t mip, uint32_t layer = 0,
                       uint32_t layers = 1);

struct SamplerState {
    VkDevice device = VK_NULL_HANDLE;
    VkSampler handle = VK_NULL_HANDLE;
};

struct Sampler : SamplerState {
    Sampler() = default;
    Sampler(Sampler&& other) noexcept : SamplerState(std::exchange(static_cast<SamplerState&>(other), {})) {}
    Sampler& operator=(Sampler&& other) noexcept {
        std::swap(static_cast<SamplerState&>(*this), static_cast<SamplerState&>(other));
        return *this;
    }
    ~Sampler() {
        if (handle) vkDestroySampler(device, handle, nullptr);
    }
};

Sampler createSampler(const Device& device, VkFilter filter, VkSamplerAddressMode address);

}  // namespace fw
