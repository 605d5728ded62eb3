// The walk over SPIR-V that finds a shader's interface (see shader.h).
#include <algorithm>
#include <glslang/SPIRV/spirv.hpp>
#include <unordered_map>

#include "runtime/gpu/shader.h"

namespace fw {
namespace {

/// What is known of a result id: the operation that defines it and the decorations that matter here.
struct Id {
    spv::Op op = spv::OpNop;
    std::vector<uint32_t> operands =
        {};  // of the defining instruction, without its result id and (for values) type
    uint32_t type = 0;
    spv::StorageClass storage = spv::StorageClassMax;
    int binding = -1, specialization = -1;
    uint32_t arrayStride = 0, constant = 0;
    bool bufferBlock = false;
    std::vector<uint32_t> memberOffsets = {};
};
using Ids = std::unordered_map<uint32_t, Id>;

uint32_t sizeOf(Ids& ids, uint32_t type);

/// Bytes from element to element of an array: what is declared, or, of shared memory, by the usual alignment.
uint32_t strideOf(Ids& ids, const Id& array) {
    if (array.arrayStride) return array.arrayStride;
    const uint32_t size = sizeOf(ids, array.operands[0]);
    return size == 12 ? 16 : size;
}

/// Bytes of a type in a block with explicit layout (no padding at the end).
uint32_t sizeOf(Ids& ids, uint32_t type) {
    Id& id = ids[type];
    switch (id.op) {
        case spv::OpTypeInt:
        case spv::OpTypeFloat: return id.operands[0] / 8;
        case spv::OpTypeBool: return 4;
        case spv::OpTypePointer: return 8;  // a buffer address
        case spv::OpTypeVector: return sizeOf(ids, id.operands[0]) * id.operands[1];
        case spv::OpTypeMatrix: return sizeOf(ids, id.operands[0]) * id.operands[1];
        case spv::OpTypeArray: return ids[id.operands[1]].constant * strideOf(ids, id);
        case spv::OpTypeStruct: {
            uint32_t size = 0;
            for (std::size_t i = 0; i < id.operands.size(); ++i) {
                uint32_t offset = i < id.memberOffsets.size() ? id.memberOffsets[i] : size;
                size = std::max(size, offset + sizeOf(ids, id.operands[i]));
            }
            return size;
        }
        default: return 0;
    }
}

VkDescriptorType descriptorType(Ids& ids, const Id& variable) {
    const Id& pointer = ids[variable.type];
    const Id& pointee = ids[pointer.operands[1]];
    const Id& element = pointee.op == spv::OpTypeArray ? ids[pointee.operands[0]] : pointee;
    switch (element.op) {
        case spv::OpTypeSampledImage: return VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
        case spv::OpTypeSampler: return VK_DESCRIPTOR_TYPE_SAMPLER;
        case spv::OpTypeImage:  // operand 5 says whether it is used with a sampler (1) or as storage (2)
            if (element.operands[1] == spv::DimBuffer) return VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER;
            return element.operands[5] == 1 ? VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE
                                            : VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
        default:
            return variable.storage == spv::StorageClassStorageBuffer || element.bufferBlock
                       ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER
                       : VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    }
}

VkFormat storageFormat(Ids& ids, const Id& variable) {
    const Id& image = ids[ids[variable.type].operands[1]];
    if (image.op != spv::OpTypeImage || image.operands[5] != 2) return VK_FORMAT_UNDEFINED;
    switch (spv::ImageFormat(image.operands[6])) {
        case spv::ImageFormatR32f: return VK_FORMAT_R32_SFLOAT;
        case spv::ImageFormatR32ui: return VK_FORMAT_R32_UINT;
        case spv::ImageFormatRg32ui: return VK_FORMAT_R32G32_UINT;
        case spv::ImageFormatRgba32ui: return VK_FORMAT_R32G32B32A32_UINT;
        case spv::ImageFormatRgba16f: return VK_FORMAT_R16G16B16A16_SFLOAT;
        default: return VK_FORMAT_UNDEFINED;
    }
}

VkShaderStageFlags stageFlag(uint32_t model) {
    switch (model) {
        case spv::ExecutionModelVertex: return VK_SHADER_STAGE_VERTEX_BIT;
        case spv::ExecutionModelGeometry: return VK_SHADER_STAGE_GEOMETRY_BIT;
        case spv::ExecutionModelFragment: return VK_SHADER_STAGE_FRAGMENT_BIT;
        default: return VK_SHADER_STAGE_COMPUTE_BIT;
    }
}

}  // namespace

ShaderInterface reflect(std::span<const uint32_t> spirv) {
    ShaderInterface result;
    Ids ids;
    std::vector<uint32_t> localSizeIds;
    constexpr std::size_t kHeaderWords = 5;
    for (std::size_t at = kHeaderWords; at < spirv.size();) {
        auto op = spv::Op(spirv[at] & 0xffff);
        std::size_t words = spirv[at] >> 16;
        if (words == 0 || at + words > spirv.size()) break;
        const uint32_t* w = &spirv[at];
        at += words;
        auto operandsFrom = [&](std::size_t first) { return std::vector<uint32_t>(w + first, w + words); };
        if (op == spv::OpFunction) break;  // the interface stands before the first function
        switch (op) {
            case spv::OpEntryPoint: result.stages |= stageFlag(w[1]); break;
            case spv::OpExecutionMode:
                if (w[2] == spv::ExecutionModeLocalSize) result.localSize = {w[3], w[4], w[5]};
                break;
            case spv::OpExecutionModeId:  // the ids of constants, which come later
                if (w[2] == spv::ExecutionModeLocalSizeId) localSizeIds = operandsFrom(3);
                break;
            case spv::OpDecorate:
                if (w[2] == spv::DecorationBinding) ids[w[1]].binding = int(w[3]);
                if (w[2] == spv::DecorationSpecId) ids[w[1]].specialization = int(w[3]);
                if (w[2] == spv::DecorationArrayStride) ids[w[1]].arrayStride = w[3];
                if (w[2] == spv::DecorationBufferBlock) ids[w[1]].bufferBlock = true;
                break;
            case spv::OpMemberDecorate:
                if (w[3] == spv::DecorationOffset) {
                    std::vector<uint32_t>& offsets = ids[w[1]].memberOffsets;
                    offsets.resize(std::max<std::size_t>(offsets.size(), w[2] + 1));
                    offsets[w[2]] = w[4];
                }
                break;
            case spv::OpTypeInt:
            case spv::OpTypeFloat:
            case spv::OpTypeBool:
            case spv::OpTypeVector:
            case spv::OpTypeMatrix:
            case spv::OpTypeArray:
            case spv::OpTypeRuntimeArray:
            case spv::OpTypeStruct:
            case spv::OpTypeImage:
            case spv::OpTypeSampler:
            case spv::OpTypeSampledImage:
            case spv::OpTypePointer:
                ids[w[1]].op = op;
                ids[w[1]].operands = operandsFrom(2);
                break;
            case spv::OpConstant:
            case spv::OpSpecConstant: ids[w[2]].constant = w[3]; break;
            case spv::OpVariable:
                ids[w[2]].op = op;
                ids[w[2]].type = w[1];
                ids[w[2]].storage = spv::StorageClass(w[3]);
                break;
            default: break;
        }
    }
    for (auto& [number, id] : ids) {
        if (id.op != spv::OpVariable) continue;
        if (id.storage == spv::StorageClassPushConstant)
            result.pushConstantSize = sizeOf(ids, ids[id.type].operands[1]);
        if (id.storage == spv::StorageClassWorkgroup)
            result.sharedMemory += sizeOf(ids, ids[id.type].operands[1]);
        if (id.binding >= 0)
            result.bindings.push_back(
                {uint32_t(id.binding), descriptorType(ids, id), storageFormat(ids, id)});
    }
    for (std::size_t i = 0; i < localSizeIds.size(); ++i) {
        result.localSize[i] = ids[localSizeIds[i]].constant;
        result.localSizeConstant[i] = ids[localSizeIds[i]].specialization;
    }
    auto byBinding = [](const ShaderBinding& a, const ShaderBinding& b) { return a.binding < b.binding; };
    std::sort(result.bindings.begin(), result.bindings.end(), byBinding);
    // Two views of one buffer may share a binding.
    result.bindings.erase(std::unique(result.bindings.begin(), result.bindings.end()), result.bindings.end());
    return result;
}

}  // namespace fw
