#include "runtime/gpu/resources.h"

#include <algorithm>
#include <bit>
#include <optional>
#include <vector>

#include "runtime/gpu/commands.h"
#include "runtime/system/large_pages.h"

namespace fw {
namespace {

constexpr VkDeviceSize kTexelSize = 16;  // bytes

/// From so many bytes on, what other programs have is asked for.
constexpr VkDeviceSize kLarge = 16 << 20;

std::string mebibytes(VkDeviceSize size) { return std::to_string((size + (1 << 20) - 1) >> 20) + " MiB"; }

/// The first memory type that has the first of `wishes` that any type has; wishes are ordered from best to
/// needed.
std::optional<uint32_t> memoryType(const Device& device, uint32_t allowed,
                                   std::initializer_list<VkMemoryPropertyFlags> wishes) {
    for (VkMemoryPropertyFlags wish : wishes)
        for (uint32_t i = 0; i < device.memory.memoryTypeCount; ++i)
            if ((allowed >> i & 1) && (device.memory.memoryTypes[i].propertyFlags & wish) == wish) return i;
    return std::nullopt;
}

DeviceTooSmall noRoom(const Device& device, const char* purpose, VkDeviceSize size, const std::string& why) {
    return DeviceTooSmall("device '" + device.name() + "' is out of memory: " + purpose + " of " +
                          mebibytes(size) + " " + why + "; a lower resolution needs less");
}

VkDeviceMemory allocate(const Device& device, const VkMemoryRequirements& needs, uint32_t type,
                        bool addressable, const char* purpose) {
    const uint32_t heap = device.memory.memoryTypes[type].heapIndex;
    const uint64_t used = device.record->allocated + needs.size, most = device.memory.memoryHeaps[heap].size;
    const std::string inUse = mebibytes(device.record->allocated) + " in use";
    if (needs.size > device.limits.allocation || used > most)
        throw noRoom(device, purpose, needs.size, "does not fit beside " + inUse + " of " + mebibytes(most));
    if (needs.size >= kLarge && device.has.memoryBudget)
        if (const uint64_t left = budgetLeft(device.physical, heap); needs.size > left)
            throw noRoom(device, purpose, needs.size,
                         "does not fit into the " + mebibytes(left) + " that are left beside " + inUse +
                             " and what other programs have");
    auto flags = zeroed<VkMemoryAllocateFlagsInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO);
    flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
    auto info = zeroed<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
    info.pNext = addressable ? &flags : nullptr;
    info.allocationSize = needs.size;
    info.memoryTypeIndex = type;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkResult result = vkAllocateMemory(device.handle, &info, nullptr, &memory);
    if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY)
        throw noRoom(device, purpose, needs.size, "was refused with " + inUse);
    check(result, "allocating device memory");
    device.record->allocated = used;
    uint64_t peak = device.record->peak;
    while (peak < used && !device.record->peak.compare_exchange_weak(peak, used)) {}
    return memory;
}

/// A part of a piece, at a place in the staging buffer.
template <class Piece>
struct Staged {
    const Piece* piece;
    std::size_t from, size;
    VkDeviceSize at;
};

/// Calls move(staging, load) with what of the pieces fits into the staging buffer, as often as it takes. Of
/// buffers that are mapped, nothing goes through it.
template <class Piece, class Move>
void throughStaging(const Device& device, std::span<const Piece> pieces, std::shared_ptr<Buffer>& staging,
                    Memory memory, const Move& move) {
    // To submit and await a copy takes a twentieth of a millisecond: little beside what so much takes.
    constexpr VkDeviceSize kLeast = 1 << 16, kMost = 1 << 21;
    VkDeviceSize all = 0;
    for (const Piece& piece : pieces) {
        assert(piece.offset + piece.size <= piece.buffer.size);
        if (!piece.buffer.mapped) all += piece.size;
    }
    if (!all) return;
    if (!staging) staging = std::make_shared<Buffer>();
    reserve(device, *staging, std::clamp(std::bit_ceil(all), kLeast, kMost), memory);
    std::vector<Staged<Piece>> load;
    VkDeviceSize at = 0;
    for (const Piece& piece : pieces)
        for (std::size_t from = 0, size; !piece.buffer.mapped && from < piece.size;
             from += size, at += size) {
            if (at == staging->size) move(*staging, std::exchange(load, {})), at = 0;
            size = std::min<std::size_t>(piece.size - from, staging->size - at);
            load.push_back({&piece, from, size, at});
        }
    move(*staging, load);
}

}  // namespace

Buffer::Buffer(Buffer&& other) noexcept : BufferState(std::exchange(static_cast<BufferState&>(other), {})) {}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
    std::swap(static_cast<BufferState&>(*this), static_cast<BufferState&>(other));
    return *this;
}

Buffer::~Buffer() {
    if (!device) return;
    if (!record->sent.empty()) vkDeviceWaitIdle(device);
    if (texels) vkDestroyBufferView(device, texels, nullptr);
    vkDestroyBuffer(device, handle, nullptr);
    vkFreeMemory(device, memory, nullptr);
    record->allocated -= allocated;
}

void Buffer::mustRest() const {
    if (!record->sent.empty()) throw SystemError("a buffer is looked at while the device may write it");
}

Buffer createBuffer(const Device& device, VkDeviceSize size, Memory memory) {
    Buffer buffer;
    buffer.device = device.handle;
    buffer.record = device.record;
    buffer.size = std::max((size + kTexelSize - 1) / kTexelSize * kTexelSize, kTexelSize);
    if (buffer.size > device.limits.allocation)
        throw DeviceTooSmall("device '" + device.name() + "' cannot hold a buffer of " + mebibytes(size) +
                             ", its limit is " + mebibytes(device.limits.allocation) +
                             "; a lower resolution needs less");
    auto info = zeroed<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
    info.size = buffer.size;
    info.usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT |
                 VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                 VK_BUFFER_USAGE_INDEX_BUFFER_BIT | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT |
                 VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT;
    if (device.has.deviceAddresses) info.usage |= VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;
    check(vkCreateBuffer(device.handle, &info, nullptr, &buffer.handle), "creating a buffer");
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device.handle, buffer.handle, &needs);

    constexpr VkMemoryPropertyFlags kLocal = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
    constexpr VkMemoryPropertyFlags kHost =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    constexpr VkMemoryPropertyFlags kCached = kHost | VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
    std::optional<uint32_t> type;
    switch (memory) {
        case Memory::device:
            type = device.unifiedMemory
                       ? memoryType(device, needs.memoryTypeBits, {kLocal | kCached, kLocal | kHost, kLocal})
                       : memoryType(device, needs.memoryTypeBits, {kLocal, 0});
            break;
        case Memory::upload: type = memoryType(device, needs.memoryTypeBits, {kHost}); break;
        case Memory::readback: type = memoryType(device, needs.memoryTypeBits, {kCached, kHost}); break;
    }
    if (!type)
        throw SystemError("device '" + device.name() + "' has no memory of the kind that a buffer needs");
    buffer.memory = allocate(device, needs, *type, device.has.deviceAddresses, "a buffer");
    buffer.allocated = needs.size;
    check(vkBindBufferMemory(device.handle, buffer.handle, buffer.memory, 0), "binding a buffer's memory");
    VkMemoryPropertyFlags got = device.memory.memoryTypes[*type].propertyFlags;
    if ((got & kHost) == kHost && (memory != Memory::device || device.unifiedMemory)) {
        const VkResult result =
            vkMapMemory(device.handle, buffer.memory, 0, VK_WHOLE_SIZE, 0, &buffer.mapped);
        if (result == VK_ERROR_MEMORY_MAP_FAILED)
            throw noRoom(device, "a buffer", size, "could not be shown to the processor");
        check(result, "mapping a buffer");
    }
    if (buffer.mapped && device.software) wantLargePages(buffer.mapped, buffer.size);
    // Fresh memory of a software device is zero, and hides what is read before it is written.
    if (buffer.mapped && device.messenger) std::memset(buffer.mapped, 0xCD, buffer.size);
    const VkDeviceSize texels = buffer.size / kTexelSize;
    if (!device.limits.texelsInStorage() && texels <= device.limits.texelElements) {
        auto view = zeroed<VkBufferViewCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO);
        view.buffer = buffer.handle;
        view.format = VK_FORMAT_R32G32B32A32_UINT;
        view.range = buffer.size;
        check(vkCreateBufferView(device.handle, &view, nullptr, &buffer.texels),
              "creating a view of a buffer");
    }
    if (device.has.deviceAddresses) {
        auto address = zeroed<VkBufferDeviceAddressInfo>(VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO);
        address.buffer = buffer.handle;
        buffer.address = vkGetBufferDeviceAddress(device.handle, &address);
    }
    return buffer;
}

bool reserve(const Device& device, Buffer& buffer, VkDeviceSize size, Memory memory) {
    if (buffer && buffer.size >= size) return false;
    finish(device);
    buffer = Buffer();  // first, so that the old and the new never stand side by side
    buffer = createBuffer(device, size, memory);
    return true;
}

void uploadPieces(const Device& device, std::span<const ConstPiece> pieces) {
    finish(device);
    throughStaging(device, pieces, device.record->written, Memory::upload,
                   [&](const Buffer& staging, const std::vector<Staged<ConstPiece>>& load) {
                       for (const auto& [piece, from, size, at] : load)
                           std::memcpy(static_cast<char*>(staging.mapped) + at,
                                       static_cast<const char*>(piece->data) + from, size);
                       Commands commands(device);
                       barrier(commands);
                       for (const auto& [piece, from, size, at] : load) {
                           const VkBufferCopy region{at, piece->offset + from, size};
                           vkCmdCopyBuffer(commands.handle, staging.handle, piece->buffer.handle, 1, &region);
                       }
                       submit(commands);
                   });
    for (const ConstPiece& piece : pieces)
        if (piece.buffer.mapped && piece.size)
            std::memcpy(static_cast<char*>(piece.buffer.mapped) + piece.offset, piece.data, piece.size);
}

void downloadPieces(const Device& device, std::span<const Piece> pieces) {
    finish(device);
    throughStaging(device, pieces, device.record->read, Memory::readback,
                   [&](const Buffer& staging, const std::vector<Staged<Piece>>& load) {
                       Commands commands(device);
                       barrier(commands);
                       for (const auto& [piece, from, size, at] : load) {
                           const VkBufferCopy region{piece->offset + from, at, size};
                           vkCmdCopyBuffer(commands.handle, piece->buffer.handle, staging.handle, 1, &region);
                       }
                       submit(commands);
                       for (const auto& [piece, from, size, at] : load)
                           std::memcpy(static_cast<char*>(piece->data) + from,
                                       static_cast<const char*>(staging.mapped) + at, size);
                   });
    for (const Piece& piece : pieces)
        if (piece.buffer.mapped && piece.size)
            std::memcpy(piece.data, static_cast<const char*>(piece.buffer.mapped) + piece.offset, piece.size);
}

Image::Image(Image&& other) noexcept : ImageState(std::exchange(static_cast<ImageState&>(other), {})) {}

Image& Image::operator=(Image&& other) noexcept {
    std::swap(static_cast<ImageState&>(*this), static_cast<ImageState&>(other));
    return *this;
}

Image::~Image() {
    if (!device) return;
    if (!record->sent.empty()) vkDeviceWaitIdle(device);
    if (view) vkDestroyImageView(device, view, nullptr);
    vkDestroyImage(device, handle, nullptr);
    vkFreeMemory(device, memory, nullptr);
    record->allocated -= allocated;
}

Image createImage(const Device& device, const ImageOptions& options) {
    Image image;
    image.device = device.handle;
    image.record = device.record;
    image.format = options.format;
    image.extent = options.extent;
    image.mips = options.mips;
    image.layers = options.layers;
    bool depth = options.usage & VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
    image.aspect = depth ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
    auto info = zeroed<VkImageCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO);
    info.flags = options.flags;
    info.imageType = options.type;
    info.format = options.format;
    info.extent = options.extent;
    info.mipLevels = options.mips;
    info.arrayLayers = options.layers;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage = options.usage;
    check(vkCreateImage(device.handle, &info, nullptr, &image.handle), "creating an image");
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(device.handle, image.handle, &needs);
    std::optional<uint32_t> type =
        memoryType(device, needs.memoryTypeBits, {VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0});
    if (!type)
        throw SystemError("device '" + device.name() + "' has no memory of the kind that an image needs");
    image.memory = allocate(device, needs, *type, false, "an image");
    image.allocated = needs.size;
    check(vkBindImageMemory(device.handle, image.handle, image.memory, 0), "binding an image's memory");
    constexpr VkImageUsageFlags kViewed = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                                          VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                          VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
    if (options.usage & kViewed) {
        VkImageViewType viewType = options.type == VK_IMAGE_TYPE_3D ? VK_IMAGE_VIEW_TYPE_3D
                                   : options.layers > 1             ? VK_IMAGE_VIEW_TYPE_2D_ARRAY
                                                                    : VK_IMAGE_VIEW_TYPE_2D;
        auto view = zeroed<VkImageViewCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO);
        view.image = image.handle;
        view.viewType = viewType;
        view.format = options.format;
        view.subresourceRange = {image.aspect, 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS};
        check(vkCreateImageView(device.handle, &view, nullptr, &image.view), "creating an image view");
    }
    return image;
}

VkImageView createView(const Image& image, VkImageViewType type, uint32_t mip, uint32_t layer,
                       uint32_t layers) {
    auto info = zeroed<VkImageViewCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO);
    info.image = image.handle;
    info.viewType = type;
    info.format = image.format;
    info.subresourceRange = {image.aspect, mip, 1, layer, layers};
    VkImageView view = VK_NULL_HANDLE;
    check(vkCreateImageView(image.device, &info, nullptr, &view), "creating an image view");
    return view;
}

Sampler createSampler(const Device& device, VkFilter filter, VkSamplerAddressMode address) {
    auto info = zeroed<VkSamplerCreateInfo>(VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO);
    info.magFilter = info.minFilter = filter;
    info.mipmapMode =
        filter == VK_FILTER_LINEAR ? VK_SAMPLER_MIPMAP_MODE_LINEAR : VK_SAMPLER_MIPMAP_MODE_NEAREST;
    info.addressModeU = info.addressModeV = info.addressModeW = address;
    info.maxLod = VK_LOD_CLAMP_NONE;
    Sampler sampler;
    sampler.device = device.handle;
    check(vkCreateSampler(device.handle, &info, nullptr, &sampler.handle), "creating a sampler");
    return sampler;
}

}  // namespace fw
