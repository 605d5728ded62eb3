#include "tests/bench/talk_stages.h"

#include <bit>
#include <cassert>
#include <glm/glm.hpp>

#include "tests/bench/case_table.h"

namespace fw::bench {
namespace {

// Places in the argument buffer, as talk_arguments.comp writes them.
constexpr VkDeviceSize kDrawPoints = 0, kDispatchVertices = 16, kDispatchTriangles = 28, kDrawIndexed = 40;
constexpr VkDeviceSize kCounts = 60, kArgumentBytes = 80;

// Room for the indexed mesh, per square of the cells along an edge; the densest of the benchmark's fields
// has 17.
constexpr VkDeviceSize kVerticesPerSquare = 32, kTrianglesPerSquare = 64;

std::vector<uint32_t> packedCases() {
    std::vector<uint32_t> words(256 * 16);
    for (int pattern = 0; pattern < 256; pattern++) {
        uint32_t* row = &words[pattern * 16];
        *row++ = caseTable()[pattern].count;
        for (CaseEdge edge : caseTable()[pattern])
            *row++ = edge.x | edge.y << 1 | edge.z << 2 | edge.axis << 3;
    }
    return words;
}

/// Parallel projection that looks at the origin from (1, 1, 1), depth reversed: 1 is nearest.
glm::mat4 viewOf(float half) {
    const float radius = half * std::sqrt(3.0f);
    const glm::vec3 viewer = glm::normalize(glm::vec3(1)),
                    right = glm::normalize(glm::cross({0, 1, 0}, viewer));
    const glm::vec3 up = glm::cross(viewer, right);
    glm::mat4 rows(glm::vec4(right / radius, 0), glm::vec4(up / radius, 0),
                   glm::vec4(viewer / (2 * radius), 0.5f), glm::vec4(0, 0, 0, 1));
    return glm::transpose(rows);
}

GraphicsOptions depthPass() {
    return {.depthFormat = VK_FORMAT_D32_SFLOAT, .depthTest = true, .depthWrite = true};
}

Pipeline pointPass(const Device& device, const char* vertexShader, bool capture) {
    GraphicsOptions options = depthPass();
    options.topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
    options.shaders = {{.name = vertexShader}, {.name = "bench/talk_cell.geom"}};
    if (capture) options.shaders[1].defines = {"CAPTURE"};
    return createGraphicsPipeline(device, options);
}

std::array<Descriptor, 8> resources(const TalkStages& s) {
    return {Descriptor(0, s.sampleBuffer),  Descriptor(1, s.caseBuffer),     Descriptor(2, s.cellPyramid),
            Descriptor(3, s.vertexPyramid), Descriptor(4, s.argumentBuffer), Descriptor(5, s.lookupBuffer),
            Descriptor(6, s.vertexBuffer),  Descriptor(7, s.indexBuffer)};
}

/// Work groups of 64 x 4 x 1 over a cube of `side` items.
glm::uvec3 groupsOver(uint32_t side) { return {(side + 63) / 64, (side + 3) / 4, side}; }

/// Builds the levels above the lowest of a histopyramid.
void recordPyramid(Commands& commands, const TalkStages& s, const Buffer& pyramid) {
    const Descriptor bound[] = {Descriptor(0, s.sampleBuffer), Descriptor(1, s.caseBuffer),
                                Descriptor(2, pyramid)};
    for (uint32_t level = s.grid.levels; level-- > 0;) {
        TalkGrid push = s.grid;
        push.level = level;
        const uint32_t side = 1u << level;
        dispatch(commands, s.reduce, {(side + 7) / 8, (side + 7) / 8, side}, push, bound);
        barrier(commands);
    }
}

/// Draws inside a pass that clears and keeps the depth image.
template <class Draw>
void recordDepthPass(Commands& commands, const TalkStages& s, Draw&& draw) {
    imageBarrier(commands, s.depth, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL);
    const VkExtent2D extent = {s.depth.extent.width, s.depth.extent.height};
    VkRenderingAttachmentInfo attachment = {};
    attachment.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
    attachment.imageView = s.depth.view;
    attachment.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
    attachment.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    VkRenderingInfo info = {};
    info.sType = VK_STRUCTURE_TYPE_RENDERING_INFO;
    info.renderArea.extent = extent;
    info.layerCount = 1;
    info.pDepthAttachment = &attachment;
    vkCmdBeginRendering(commands.handle, &info);
    // A negative height keeps y upwards, and with it the winding.
    VkViewport viewport = {0, float(extent.height), float(extent.width), -float(extent.height), 0, 1};
    VkRect2D scissor = {{}, extent};
    vkCmdSetViewport(commands.handle, 0, 1, &viewport);
    vkCmdSetScissor(commands.handle, 0, 1, &scissor);
    draw();
    vkCmdEndRendering(commands.handle);
    barrier(commands);
}

void drawPoints(Commands& commands, const TalkStages& s, TalkWay way, const Pipeline& pipeline,
                std::span<const Descriptor> bound) {
    fw::bind(commands, pipeline, &s.grid, sizeof s.grid, bound);
    if (way == TalkWay::everyCell)
        vkCmdDraw(commands.handle, 1u << (3 * s.grid.levels), 1, 0, 0);
    else
        vkCmdDrawIndirect(commands.handle, s.argumentBuffer.handle, kDrawPoints, 1, 0);
}

}  // namespace

TalkStages createTalkStages(const Device& device, const TalkOptions& options) {
    assert(std::has_single_bit(unsigned(options.cells)));
    if (!device.has.geometryShader)
        throw SystemError("device '" + device.name() + "' has no geometry shaders");
    TalkStages s{.device = device};
    const VkDeviceSize cells = options.cells, cubed = cells * cells * cells;
    s.grid = {.view = viewOf(options.half),
              .origin = glm::vec3(-options.half),
              .spacing = 2 * options.half / float(options.cells),
              .levels = uint32_t(std::countr_zero(unsigned(options.cells))),
              .level = 0};

    const ShaderOptions shaders[] = {{.name = "bench/talk_sample.comp", .field = options.field},
                                     {.name = "bench/talk_activity.comp"},
                                     {.name = "bench/talk_counts.comp"},
                                     {.name = "bench/talk_reduce.comp"},
                                     {.name = "bench/talk_arguments.comp"},
                                     {.name = "bench/talk_vertices.comp"},
                                     {.name = "bench/talk_indices.comp"}};
    std::vector<Pipeline> compute = createComputePipelines(device, shaders);
    Pipeline* places[] = {&s.sample,    &s.activity, &s.counts, &s.reduce,
                          &s.arguments, &s.vertices, &s.indices};
    for (std::size_t i = 0; i < compute.size(); i++) *places[i] = std::move(compute[i]);
    s.drawEvery = pointPass(device, "bench/talk_every_cell.vert", false);
    s.drawActive = pointPass(device, "bench/talk_active_cell.vert", false);
    s.captureEvery = pointPass(device, "bench/talk_every_cell.vert", true);
    s.captureActive = pointPass(device, "bench/talk_active_cell.vert", true);
    s.drawIndexed = createMeshPass(device, 3);

    const VkDeviceSize nodes = (8 * cubed - 1) / 7;
    s.sampleBuffer = createBuffer(device, 4 * (cells + 1) * (cells + 1) * (cells + 1));
    s.caseBuffer = createBuffer(device, 256 * 16 * 4);
    upload(device, s.caseBuffer, packedCases());
    s.cellPyramid = createBuffer(device, 4 * nodes);
    s.vertexPyramid = createBuffer(device, 4 * nodes);
    s.argumentBuffer = createBuffer(device, kArgumentBytes);
    s.lookupBuffer = createBuffer(device, 4 * cubed);
    s.vertexBuffer = createBuffer(device, 12 * kVerticesPerSquare * cells * cells);
    s.indexBuffer = createBuffer(device, 12 * kTrianglesPerSquare * cells * cells);
    const uint32_t pixels = uint32_t(options.imageSize);
    s.depth = createImage(
        device, {.extent = {pixels, pixels, 1},
                 .format = VK_FORMAT_D32_SFLOAT,
                 .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT});
    return s;
}

void recordGeneration(Commands& commands, const TalkStages& s, TalkWay way) {
    const uint32_t side = 1u << s.grid.levels;
    const auto bound = resources(s);
    beginStage(commands, "sample");
    dispatch(commands, s.sample, {(side + 16) / 16, (side + 16) / 16, side + 1}, s.grid, bound);
    barrier(commands);
    if (way == TalkWay::everyCell) return;

    const bool indexed = way == TalkWay::indexed;
    beginStage(commands, "classify");
    dispatch(commands, indexed ? s.counts : s.activity, groupsOver(side), s.grid, bound);
    barrier(commands);
    beginStage(commands, "histopyramid");
    recordPyramid(commands, s, s.cellPyramid);
    if (indexed) recordPyramid(commands, s, s.vertexPyramid);
    dispatch(commands, s.arguments, {1, 1, 1}, s.grid, bound);
    barrier(commands);
    if (!indexed) return;

    beginStage(commands, "vertices");
    dispatchIndirect(commands, s.vertices, s.argumentBuffer, kDispatchVertices, s.grid, bound);
    barrier(commands);
    beginStage(commands, "indices");
    dispatchIndirect(commands, s.indices, s.argumentBuffer, kDispatchTriangles, s.grid, bound);
    barrier(commands);
}

void recordPass(Commands& commands, const TalkStages& s, TalkWay way) {
    if (way == TalkWay::indexed) {
        recordMeshPass(commands, s, s.drawIndexed, s.vertexBuffer, s.indexBuffer, s.argumentBuffer,
                       kDrawIndexed);
        return;
    }
    beginStage(commands, "pass");
    recordDepthPass(commands, s, [&] {
        drawPoints(commands, s, way, way == TalkWay::everyCell ? s.drawEvery : s.drawActive, resources(s));
    });
}

Pipeline createMeshPass(const Device& device, uint32_t floatsPerVertex) {
    GraphicsOptions options = depthPass();
    options.shaders = {{.name = "bench/talk_mesh.vert", .constants = {floatsPerVertex}}};
    return createGraphicsPipeline(device, options);
}

void recordMeshPass(Commands& commands, const TalkStages& s, const Pipeline& pass, const Buffer& meshVertices,
                    const Buffer& meshIndices, const Buffer& arguments, VkDeviceSize offset) {
    beginStage(commands, "pass");
    recordDepthPass(commands, s, [&] {
        const Descriptor bound[] = {Descriptor(0, s.sampleBuffer), Descriptor(1, s.caseBuffer),
                                    Descriptor(6, meshVertices)};
        fw::bind(commands, pass, &s.grid, sizeof s.grid, bound);
        vkCmdBindIndexBuffer(commands.handle, meshIndices.handle, 0, VK_INDEX_TYPE_UINT32);
        vkCmdDrawIndexedIndirect(commands.handle, arguments.handle, offset, 1, 0);
    });
}

Mesh captureMesh(const TalkStages& s, TalkWay way) {
    Mesh mesh;
    const VkDeviceSize side = VkDeviceSize(1) << s.grid.levels;
    if (way == TalkWay::indexed) {
        Commands commands(s.device);
        recordGeneration(commands, s, way);
        submit(commands);
        const std::vector<uint32_t> counts = download<uint32_t>(s.device, s.argumentBuffer, 2, kCounts);
        assert(counts[0] <= kVerticesPerSquare * side * side &&
               counts[1] <= kTrianglesPerSquare * side * side);
        mesh.positions = download<glm::vec3>(s.device, s.vertexBuffer, counts[0]);
        mesh.indices = download<uint32_t>(s.device, s.indexBuffer, 3 * counts[1]);
        return mesh;
    }
    const Buffer captured = createBuffer(s.device, 4 + 36 * kTrianglesPerSquare * side * side);
    const auto common = resources(s);
    std::vector<Descriptor> bound(common.begin(), common.end());
    bound.emplace_back(8, captured);
    Commands commands(s.device);
    fill(commands, captured, 0, 0, 4);
    recordGeneration(commands, s, way);
    recordDepthPass(commands, s, [&] {
        drawPoints(commands, s, way, way == TalkWay::everyCell ? s.captureEvery : s.captureActive, bound);
    });
    submit(commands);
    const uint32_t triangles = download<uint32_t>(s.device, captured, 1)[0];
    assert(triangles <= kTrianglesPerSquare * side * side);
    mesh.positions = download<glm::vec3>(s.device, captured, 3 * triangles, 4);
    mesh.indices.resize(mesh.positions.size());
    for (uint32_t i = 0; i < mesh.indices.size(); i++) mesh.indices[i] = i;
    return mesh;
}

std::vector<float> readDepth(const TalkStages& s) {
    const VkExtent3D extent = s.depth.extent;
    const Buffer pixels =
        createBuffer(s.device, 4 * VkDeviceSize(extent.width) * extent.height, Memory::readback);
    Commands commands(s.device);
    imageBarrier(commands, s.depth, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
                 VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 0, 1};
    region.imageExtent = extent;
    vkCmdCopyImageToBuffer(commands.handle, s.depth.handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                           pixels.handle, 1, &region);
    imageBarrier(commands, s.depth, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                 VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL);
    barrier(commands);
    submit(commands);
    return download<float>(s.device, pixels, std::size_t(extent.width) * extent.height);
}

}  // namespace fw::bench
