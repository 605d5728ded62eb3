// Pipelines from compiled shaders (see shader.h).
#include <algorithm>
#include <bit>
#include <deque>
#include <exception>
#include <map>
#include <optional>
#include <thread>

#include "runtime/gpu/commands.h"
#include "runtime/gpu/shader.h"
#include "runtime/system/clock.h"

namespace fw {
namespace {

struct ModuleState {
    VkDevice device = VK_NULL_HANDLE;
    VkShaderModule handle = VK_NULL_HANDLE;
};
struct Module : ModuleState {
    Module(const Device& owner, const Spirv& spirv) {
        device = owner.handle;
        auto info = zeroed<VkShaderModuleCreateInfo>(VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO);
        info.codeSize = spirv.size() * 4;
        info.pCode = spirv.data();
        check(vkCreateShaderModule(device, &info, nullptr, &handle), "creating a shader module");
    }
    Module(Module&& other) noexcept : ModuleState(std::exchange(static_cast<ModuleState&>(other), {})) {}
    ~Module() {
        if (handle) vkDestroyShaderModule(device, handle, nullptr);
    }
};

/// Specialization constants 0, 1, ... of four bytes each, and those of the device
/// (shaders/lib/interval.glsl); `info` points into it.
struct Specialization {
    Specialization(const Device& device, const std::vector<uint32_t>& values) : data(values) {
        for (uint32_t i = 0; i < values.size(); ++i) entries.push_back({i, i * 4, 4});
        uint32_t id = 100;
        for (const float error : {device.precision.sine, device.precision.curves}) {
            entries.push_back({id++, uint32_t(data.size()) * 4, 4});
            data.push_back(std::bit_cast<uint32_t>(error));
        }
        info = {uint32_t(entries.size()), entries.data(), data.size() * 4, data.data()};
    }
    Specialization(const Specialization&) = delete;
    std::vector<VkSpecializationMapEntry> entries;
    std::vector<uint32_t> data;
    VkSpecializationInfo info;
};

void createLayout(const Device& device, Pipeline& pipeline) {
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    for (const ShaderBinding& binding : pipeline.shader.bindings)
        bindings.push_back({binding.binding, binding.type, 1, pipeline.shader.stages, nullptr});
    auto set = zeroed<VkDescriptorSetLayoutCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO);
    if (device.pushDescriptors) set.flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_PUSH_DESCRIPTOR_BIT_KHR;
    set.bindingCount = uint32_t(bindings.size());
    set.pBindings = bindings.data();
    check(vkCreateDescriptorSetLayout(device.handle, &set, nullptr, &pipeline.setLayout),
          "creating a descriptor layout");
    VkPushConstantRange push{pipeline.shader.stages, 0, pipeline.shader.pushConstantSize};
    auto layout = zeroed<VkPipelineLayoutCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO);
    layout.setLayoutCount = 1;
    layout.pSetLayouts = &pipeline.setLayout;
    layout.pushConstantRangeCount = push.size ? 1 : 0;
    layout.pPushConstantRanges = &push;
    check(vkCreatePipelineLayout(device.handle, &layout, nullptr, &pipeline.layout),
          "creating a pipeline layout");
}

Spirv compileOrThrow(const Device& device, const ShaderOptions& options, bool* before = nullptr) {
    Result<Spirv> spirv = compileShader(fitted(options, device.limits), before);
    if (!spirv) throw SystemError(format(spirv.error()));
    return std::move(*spirv);
}

/// What a kernel needs more of than the device has would have no meaning there.
void checkFits(const Device& device, const ShaderOptions& options, const ShaderInterface& shader) {
    const auto refuse = [&](const char* what, uint64_t needed, uint64_t most) {
        if (needed > most)
            throw SystemError("shader '" + options.name + "' needs " + std::to_string(needed) + " " + what +
                              ", and device '" + device.name() + "' has " + std::to_string(most) +
                              ": choose another with --device");
    };
    uint64_t invocations = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto constant = std::size_t(shader.localSizeConstant[axis]);
        invocations *=
            constant < options.constants.size() ? options.constants[constant] : shader.localSize[axis];
    }
    refuse("invocations in a work group", invocations, device.limits.invocations);
    refuse("bytes of shared memory", shader.sharedMemory, device.limits.sharedMemory);
    refuse("bytes of push constants", shader.pushConstantSize, device.limits.pushConstants);
}

VkPipelineShaderStageCreateInfo stageInfo(VkShaderStageFlags stage, VkShaderModule module,
                                          const Specialization& constants) {
    auto info = zeroed<VkPipelineShaderStageCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO);
    info.stage = VkShaderStageFlagBits(stage);
    info.module = module;
    info.pName = "main";
    info.pSpecializationInfo = &constants.info;
    return info;
}

Pipeline build(const Device& device, const ShaderOptions& options, const Spirv& spirv) {
    Pipeline pipeline;
    pipeline.device = device.handle;
    pipeline.shader = reflect(spirv);
    checkFits(device, options, pipeline.shader);
    createLayout(device, pipeline);
    Module module(device, spirv);
    Specialization constants(device, options.constants);
    auto info = zeroed<VkComputePipelineCreateInfo>(VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO);
    info.flags = VK_PIPELINE_CREATE_DISPATCH_BASE_BIT;  // dispatchRows() begins at any row
    info.stage = stageInfo(VK_SHADER_STAGE_COMPUTE_BIT, module.handle, constants);
    info.layout = pipeline.layout;
    check(vkCreateComputePipelines(device.handle, device.pipelineCache, 1, &info, nullptr, &pipeline.handle),
          "creating a compute pipeline");
    ++device.record->pipelines;
    return pipeline;
}

}  // namespace

Pipeline::Pipeline(Pipeline&& other) noexcept
    : PipelineState(std::exchange(static_cast<PipelineState&>(other), {})) {}

Pipeline& Pipeline::operator=(Pipeline&& other) noexcept {
    std::swap(static_cast<PipelineState&>(*this), static_cast<PipelineState&>(other));
    return *this;
}

Pipeline::~Pipeline() {
    if (!device) return;
    vkDestroyPipeline(device, handle, nullptr);
    vkDestroyPipelineLayout(device, layout, nullptr);
    vkDestroyDescriptorSetLayout(device, setLayout, nullptr);
}

namespace {

/// A software device turns a kernel into machine code when it first runs, on the queue's one thread. An empty
/// dispatch of each pipeline as soon as it is made lets that go on beside the compiling of the other shaders.
/// About half of the pipelines run first on the device's sibling, on another thread, and are then found in
/// the driver's disk cache. Those that an earlier process compiled are there already, and do without the
/// sibling. With `Compile::behind` all run on it, and the device's own queue is left alone.
class FirstRuns {
  public:
    FirstRuns(const Device& device_, Compile when) : device(device_), behind(when == Compile::behind) {
        if (behind)
            useSibling();
        else
            own.emplace(device);
    }

    /// One call at a time. `pipeline` must stay where it is. `before`: an earlier process compiled it.
    void start(const Pipeline& pipeline, const ShaderOptions& options, const Spirv& spirv, bool before) {
        for (const ShaderBinding& binding : pipeline.shader.bindings)
            if (!isBuffer(binding) && !(behind && binding.format != VK_FORMAT_UNDEFINED)) return;
        if (before && !behind) return run(*own, pipeline);
        if (!triedSibling) useSibling();
        const bool toSibling = behind || (sibling && sibling->words < own->words);
        Lane& lane = toSibling ? *sibling : *own;
        lane.words += spirv.size();
        if (!toSibling) return run(*own, pipeline);
        translated.push_back(build(sibling->device, options, spirv));
        run(*sibling, translated.back());
        later.push_back(&pipeline);
    }

    /// Waits until every pipeline has run.
    void finish() {
        for (std::size_t i = 0; i < later.size(); ++i) {
            check(vkWaitForFences(sibling->device.handle, 1, &sibling->fences[i], VK_TRUE, UINT64_MAX),
                  "waiting for a first run");
            if (own) run(*own, *later[i]);
        }
        if (own) wait(*own);
    }

  private:
    struct Lane {
        explicit Lane(const Device& laneDevice) : device(laneDevice), nothing(createBuffer(device, 256)) {}
        ~Lane() {
            if (!fences.empty()) vkQueueWaitIdle(device.queue);
            for (VkFence fence : fences) vkDestroyFence(device.handle, fence, nullptr);
        }
        const Device& device;
        Buffer nothing;
        std::map<VkFormat, Image> images = {};  // that stand for those a kernel stores to
        std::size_t words = 0;                  // of SPIR-V so far: a measure of its work
        std::vector<std::unique_ptr<Commands>> recorded = {};
        std::vector<VkFence> fences = {};
    };

    /// Of the sibling; it may end on another thread than it began on.
    struct Use {
        ~Use() {
            if (of) of->release();
        }
        std::binary_semaphore* of = nullptr;
    };

    /// One at a time may use the sibling; who must not wait does without.
    void useSibling() {
        triedSibling = true;
        const Device& other = siblingOf(device, behind);
        std::binary_semaphore& unused = other.record->unused;
        if (behind)
            unused.acquire();
        else if (!unused.try_acquire())
            return;
        use.of = &unused;
        sibling.emplace(other);
    }

    static bool isBuffer(const ShaderBinding& binding) {
        return binding.type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER ||
               binding.type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER ||
               binding.type == VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER;
    }
    static void wait(Lane& lane) { check(vkQueueWaitIdle(lane.device.queue), "waiting for first runs"); }

    /// The code that a software device makes of a kernel depends on the images' formats, and on whether their
    /// sides are powers of two: those of pictures seldom are.
    static const Image& imageOf(Lane& lane, Commands& commands, VkFormat format) {
        Image& image = lane.images[format];
        if (image) return image;
        image = createImage(lane.device, {.extent = {3, 3, 1}, .format = format});
        imageBarrier(commands, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
        return image;
    }

    static void run(Lane& lane, const Pipeline& pipeline) {
        Commands& commands = *lane.recorded.emplace_back(std::make_unique<Commands>(lane.device));
        std::vector<Descriptor> descriptors;
        for (const ShaderBinding& binding : pipeline.shader.bindings)
            if (isBuffer(binding))
                descriptors.push_back({binding.binding, lane.nothing});
            else
                descriptors.push_back(
                    {binding.binding, imageOf(lane, commands, binding.format).view, VK_IMAGE_LAYOUT_GENERAL});
        const std::array<std::byte, 256> push{};
        dispatch(commands, pipeline, {0, 0, 0}, push.data(), pipeline.shader.pushConstantSize, descriptors);
        check(vkEndCommandBuffer(commands.handle), "recording a first run");
        auto buffer = zeroed<VkCommandBufferSubmitInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO);
        buffer.commandBuffer = commands.handle;
        auto info = zeroed<VkSubmitInfo2>(VK_STRUCTURE_TYPE_SUBMIT_INFO_2);
        info.commandBufferInfoCount = 1;
        info.pCommandBufferInfos = &buffer;
        auto fence = zeroed<VkFenceCreateInfo>(VK_STRUCTURE_TYPE_FENCE_CREATE_INFO);
        check(vkCreateFence(lane.device.handle, &fence, nullptr, &lane.fences.emplace_back()),
              "creating a fence");
        check(vkQueueSubmit2(lane.device.queue, 1, &info, lane.fences.back()), "submitting a first run");
    }

    const Device& device;
    const bool behind;
    bool triedSibling = false;
    Use use;
    std::deque<Pipeline> translated;  // on the sibling
    std::vector<const Pipeline*> later;
    // After the pipelines, as the sibling's: their work ends before those do. None where another thread has
    // the device's queue, which even the end of a buffer waits for.
    std::optional<Lane> own;
    std::optional<Lane> sibling;
};

}  // namespace

std::vector<Pipeline> createComputePipelines(const Device& device, std::span<const ShaderOptions> shaders,
                                             CompileTimes* times, Compile when) {
    // First runs use the queue from threads of their own, where nothing may wait for what was sent.
    if (when == Compile::now) finish(device);
    std::vector<Pipeline> pipelines(shaders.size());
    std::atomic<std::size_t> next = 0;
    std::mutex mutex;
    std::exception_ptr failure;
    std::optional<FirstRuns> firstRuns;
    if (device.software) firstRuns.emplace(device, when);
    auto work = [&] {
        for (std::size_t i; (i = next++) < shaders.size();) {
            try {
                Clock::time_point start = Clock::now();
                bool before = false;
                Spirv spirv = compileOrThrow(device, shaders[i], &before);
                double compiled = millisecondsSince(start);
                pipelines[i] = build(device, shaders[i], spirv);
                std::lock_guard lock(mutex);
                if (firstRuns) firstRuns->start(pipelines[i], shaders[i], spirv, before);
                if (times) {
                    times->spirv += compiled;
                    times->pipeline += millisecondsSince(start) - compiled;
                }
            } catch (...) {
                std::lock_guard lock(mutex);
                if (!failure) failure = std::current_exception();
            }
        }
    };
    const unsigned most = when == Compile::behind ? 1 : std::max(2u, std::thread::hardware_concurrency());
    const std::size_t threads = std::min<std::size_t>(most, shaders.size());
    std::vector<std::jthread> workers;
    for (std::size_t i = 1; i < threads; ++i) workers.emplace_back(work);
    work();
    workers.clear();
    if (failure) std::rethrow_exception(failure);
    if (firstRuns) firstRuns->finish();
    return pipelines;
}

Pipeline createComputePipeline(const Device& device, const ShaderOptions& shader) {
    return build(device, shader, compileOrThrow(device, shader));
}

Pipeline createGraphicsPipeline(const Device& device, const GraphicsOptions& options) {
    Pipeline pipeline;
    pipeline.device = device.handle;
    std::vector<Module> modules;
    std::vector<std::unique_ptr<Specialization>> constants;
    std::vector<VkPipelineShaderStageCreateInfo> stages;
    for (const ShaderOptions& shader : options.shaders) {
        Spirv spirv = compileOrThrow(device, shader);
        ShaderInterface part = reflect(spirv);
        checkFits(device, shader, part);
        pipeline.shader.stages |= part.stages;
        pipeline.shader.pushConstantSize = std::max(pipeline.shader.pushConstantSize, part.pushConstantSize);
        for (const ShaderBinding& binding : part.bindings) {
            auto same = [&](const ShaderBinding& other) { return other.binding == binding.binding; };
            std::vector<ShaderBinding>& all = pipeline.shader.bindings;
            if (std::none_of(all.begin(), all.end(), same)) all.push_back(binding);
        }
        modules.emplace_back(device, spirv);
        constants.push_back(std::make_unique<Specialization>(device, shader.constants));
        stages.push_back(stageInfo(part.stages, modules.back().handle, *constants.back()));
    }
    createLayout(device, pipeline);

    auto vertices = zeroed<VkPipelineVertexInputStateCreateInfo>(
        VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO);
    const VkVertexInputBindingDescription vertex = {0, options.vertexStride, VK_VERTEX_INPUT_RATE_VERTEX};
    if (options.vertexStride > 0) {
        vertices.vertexBindingDescriptionCount = 1;
        vertices.pVertexBindingDescriptions = &vertex;
        vertices.vertexAttributeDescriptionCount = uint32_t(options.vertexAttributes.size());
        vertices.pVertexAttributeDescriptions = options.vertexAttributes.data();
    }
    auto assembly = zeroed<VkPipelineInputAssemblyStateCreateInfo>(
        VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO);
    assembly.topology = options.topology;
    auto viewport =
        zeroed<VkPipelineViewportStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO);
    viewport.viewportCount = viewport.scissorCount = 1;
    auto raster = zeroed<VkPipelineRasterizationStateCreateInfo>(
        VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO);
    raster.rasterizerDiscardEnable = options.discard;
    raster.cullMode = options.cull;
    raster.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
    raster.lineWidth = 1.0f;
    auto samples = zeroed<VkPipelineMultisampleStateCreateInfo>(
        VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO);
    samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    auto depth = zeroed<VkPipelineDepthStencilStateCreateInfo>(
        VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO);
    depth.depthTestEnable = options.depthTest;
    depth.depthWriteEnable = options.depthWrite;
    depth.depthCompareOp = options.depthCompare;
    std::vector<VkPipelineColorBlendAttachmentState> attachments(options.colorFormats.size(), options.blend);
    auto blend =
        zeroed<VkPipelineColorBlendStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO);
    blend.attachmentCount = uint32_t(attachments.size());
    blend.pAttachments = attachments.data();
    VkDynamicState dynamicStates[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    auto dynamic =
        zeroed<VkPipelineDynamicStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO);
    dynamic.dynamicStateCount = 2;
    dynamic.pDynamicStates = dynamicStates;
    auto rendering = zeroed<VkPipelineRenderingCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO);
    rendering.colorAttachmentCount = uint32_t(options.colorFormats.size());
    rendering.pColorAttachmentFormats = options.colorFormats.data();
    rendering.depthAttachmentFormat = options.depthFormat;

    auto info = zeroed<VkGraphicsPipelineCreateInfo>(VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO);
    info.pNext = &rendering;
    info.stageCount = uint32_t(stages.size());
    info.pStages = stages.data();
    info.pVertexInputState = &vertices;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &viewport;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &samples;
    info.pDepthStencilState = &depth;
    info.pColorBlendState = &blend;
    info.pDynamicState = &dynamic;
    info.layout = pipeline.layout;
    check(vkCreateGraphicsPipelines(device.handle, device.pipelineCache, 1, &info, nullptr, &pipeline.handle),
          "creating a graphics pipeline");
    ++device.record->pipelines;
    return pipeline;
}

}  // namespace fw
