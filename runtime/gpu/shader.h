// GLSL to pipelines: embedded sources, run-time compilation, a disk cache, and layouts by reflection.
//
// The sources under shaders/ travel in the binary. An #include is answered from there, "field.glsl" by the
// caller's text if it gives one. The complete text (includes expanded, defines in front) is hashed together
// with stage and compiler version; SPIR-V of that key comes from the disk cache, and only what is not there
// starts glslang, which costs a few ms for itself. Descriptor bindings, push constants and the work group's
// size are read back from the SPIR-V (a walk over the words, the idea is niagara's), so nothing about a
// shader's interface is written twice. Lifetime: pipelines live per structure of a graph; they are destroyed
// before the device.
#pragma once

#include <array>
#include <span>
#include <string_view>

#include "runtime/gpu/device.h"

namespace fw {

/// One file of shaders/, by its path there ("mesher/cull.comp").
struct EmbeddedShader {
    const char* name;
    const char* source;
};

/// All files, generated from shaders/ by shaders/embed.cmake.
const std::vector<EmbeddedShader>& embeddedShaders();

/// The text of one file; the name must exist.
std::string_view shaderSource(std::string_view name);

/// What turns one file into one shader.
struct ShaderOptions {
    std::string name = {};                  ///< file; its ending (.comp .vert .geom .frag) gives the stage
    std::string_view field = {};            ///< answers #include "field.glsl"; empty: the default field
    std::vector<std::string> defines = {};  ///< "NAME" or "NAME VALUE", put before the text
    std::vector<uint32_t> constants = {};   ///< values of specialization constants 0, 1, ...
    std::string text = {};                  ///< if not empty, used in place of the file's content
    bool texelsInStorage = false;           ///< what is declared as texel buffers becomes storage buffers
};

/// The same shader for a device with these limits, as the functions that make pipelines compile it.
ShaderOptions fitted(ShaderOptions options, const DeviceLimits& limits);

using Spirv = std::vector<uint32_t>;

/// The text with its includes expanded (each file once) and the defines in front: what glslang gets.
/// An include that does not exist is an Error.
Result<std::string> completeSource(const ShaderOptions& options);

/// Compiles, or fetches from the disk cache. Errors carry glslang's message. Safe on several threads.
/// `before` becomes whether an earlier process compiled it.
Result<Spirv> compileShader(const ShaderOptions& options, bool* before = nullptr);

struct ShaderBinding {
    uint32_t binding = 0;
    VkDescriptorType type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    VkFormat format = VK_FORMAT_UNDEFINED;  ///< of a storage image, where the shader names it
    bool operator==(const ShaderBinding&) const = default;
};

/// A shader's interface, or that of all stages of a pipeline together.
struct ShaderInterface {
    VkShaderStageFlags stages = 0;
    std::vector<ShaderBinding> bindings = {};             ///< of set 0, ascending
    uint32_t pushConstantSize = 0;                        ///< bytes
    uint32_t sharedMemory = 0;                            ///< bytes; compute only
    std::array<uint32_t, 3> localSize = {1, 1, 1};        ///< compute only; before specialization,
    std::array<int, 3> localSizeConstant = {-1, -1, -1};  ///< by these constants, where not -1
};

ShaderInterface reflect(std::span<const uint32_t> spirv);

struct PipelineState {
    VkDevice device = VK_NULL_HANDLE;
    VkPipeline handle = VK_NULL_HANDLE;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
    ShaderInterface shader;
};

struct Pipeline : PipelineState {
    Pipeline() = default;
    Pipeline(Pipeline&& other) noexcept;
    Pipeline& operator=(Pipeline&& other) noexcept;
    ~Pipeline();
    explicit operator bool() const { return handle != VK_NULL_HANDLE; }
};

/// What compiling cost, for reports.
struct CompileTimes {
    double spirv = 0,
           pipeline = 0;  ///< ms, added up over shaders (on several threads: more than the wall clock)
};

/// Whether work on the device waits for a compilation, or goes on while one thread compiles behind it.
enum class Compile { now, behind };

/// Compiles and builds one pipeline for each entry, now on all processors; behind on the calling thread
/// alone, which may then be another than the one that submits work. A shader that does not compile throws
/// SystemError with its message, for its text came from this program.
std::vector<Pipeline> createComputePipelines(const Device& device, std::span<const ShaderOptions> shaders,
                                             CompileTimes* times = nullptr, Compile when = Compile::now);
Pipeline createComputePipeline(const Device& device, const ShaderOptions& shader);

/// A pipeline for dynamic rendering. Vertex shaders fetch from storage buffers, unless `vertexStride` asks
/// for the attributes.
struct GraphicsOptions {
    std::vector<ShaderOptions> shaders = {};  ///< vertex, fragment and, where the device has them, geometry
    std::vector<VkFormat> colorFormats = {};
    VkFormat depthFormat = VK_FORMAT_UNDEFINED;
    uint32_t vertexStride = 0;  ///< bytes; 0: no attributes
    std::vector<VkVertexInputAttributeDescription> vertexAttributes = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0}};
    VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    VkCullModeFlags cull = VK_CULL_MODE_BACK_BIT;
    VkCompareOp depthCompare = VK_COMPARE_OP_GREATER;  ///< reversed depth: 1 is near
    bool depthTest = false, depthWrite = false;        ///< only with a depth format
    bool discard = false;  ///< no rasterisation: for shaders that write buffers only
    VkPipelineColorBlendAttachmentState blend = {VK_FALSE,
                                                 VK_BLEND_FACTOR_ONE,
                                                 VK_BLEND_FACTOR_ZERO,
                                                 VK_BLEND_OP_ADD,
                                                 VK_BLEND_FACTOR_ONE,
                                                 VK_BLEND_FACTOR_ZERO,
                                                 VK_BLEND_OP_ADD,
                                                 0xf};
};
Pipeline createGraphicsPipeline(const Device& device, const GraphicsOptions& options);

}  // namespace fw
