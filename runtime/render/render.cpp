#include "runtime/render/render.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <limits>

namespace fw {

namespace {

constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;
constexpr uint32_t kRowsAtOnce = 64;  // of shading: between two looks at the cancel flag

Error problem(std::string message) {
    Error error;
    error.message = std::move(message);
    return error;
}

void recordDepth(Commands& commands, const RenderPipelines& pipelines, const MesherBuffers& mesh,
                 const gpu::RenderPush& view, const Image& depth, std::span<const Descriptor> bound) {
    imageBarrier(commands, depth, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL);
    auto attachment = zeroed<VkRenderingAttachmentInfo>(VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO);
    attachment.imageView = depth.view;
    attachment.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
    attachment.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    auto info = zeroed<VkRenderingInfo>(VK_STRUCTURE_TYPE_RENDERING_INFO);
    info.renderArea.extent = {depth.extent.width, depth.extent.height};
    info.layerCount = 1;
    info.pDepthAttachment = &attachment;
    vkCmdBeginRendering(commands.handle, &info);
    // A negative height keeps y upwards, and with it the winding.
    const auto width = float(depth.extent.width), height = float(depth.extent.height);
    const VkViewport viewport = {0, height, width, -height, 0, 1};
    vkCmdSetViewport(commands.handle, 0, 1, &viewport);
    vkCmdSetScissor(commands.handle, 0, 1, &info.renderArea);
    fw::bind(commands, pipelines.depth, &view, sizeof view, bound);
    vkCmdBindIndexBuffer(commands.handle, mesh.triangles.handle, 0, VK_INDEX_TYPE_UINT32);
    vkCmdDrawIndexedIndirect(commands.handle, mesh.counts.handle, offsetof(gpu::MesherCounts, draw), 1, 0);
    vkCmdEndRendering(commands.handle);
    imageBarrier(commands, depth, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
                 VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

}  // namespace

RenderPipelines createRenderPipelines(const Device& device, std::string_view field) {
    RenderPipelines pipelines;
    pipelines.depth = createGraphicsPipeline(device, {.shaders = {{.name = "render/depth.vert"}},
                                                      .depthFormat = kDepthFormat,
                                                      .depthTest = true,
                                                      .depthWrite = true});
    pipelines.shade = createComputePipeline(device, {.name = "render/shade.comp", .field = field});
    return pipelines;
}

Done checkPictureSize(int width, int height) {
    if (std::min(width, height) < kLeastPictureSide || std::max(width, height) > kMostPictureSide ||
        int64_t(width) * height > kMostPicturePixels)
        return problem("a picture's sides are from " + std::to_string(kLeastPictureSide) + " to " +
                       std::to_string(kMostPictureSide) + " pixels, with at most " +
                       std::to_string(kMostPicturePixels) + " in all");
    return done();
}

gpu::RenderPush frame(std::span<const gpu::MeshVertex> points, float aspect) {
    constexpr float kAround = 0.61f,
                    kAbove = 0.38f;      // where the camera stands, radians from +z and the ground
    constexpr float kHalfAngle = 0.25f;  // of view along the picture's shorter side
    constexpr float kFilled = 0.81f;     // of the picture; the rest is margin

    gpu::RenderPush view = {};
    view.forward = -glm::vec3(std::sin(kAround) * std::cos(kAbove), std::sin(kAbove),
                              std::cos(kAround) * std::cos(kAbove));
    const glm::vec3 right = glm::normalize(glm::cross(view.forward, glm::vec3(0, 1, 0)));
    const glm::vec3 up = glm::cross(right, view.forward);
    const float shorter = std::tan(kHalfAngle);
    const glm::vec2 tangent = shorter * glm::max(glm::vec2(aspect, 1 / aspect), glm::vec2(1));

    // A point at (x, y, z) along right, up and forward is in the picture if |x - eye.x| <= t (z - eye.z): the
    // four sides of the view are as far out as the outermost point says.
    const float infinity = std::numeric_limits<float>::infinity();
    glm::vec3 lo(infinity), hi(-infinity);
    glm::vec2 least(infinity), most(-infinity), filled = kFilled * tangent;
    float nearest = infinity;
    for (const gpu::MeshVertex& vertex : points) {
        const glm::vec3 p = vertex.position;
        lo = glm::min(lo, p), hi = glm::max(hi, p);
        const glm::vec2 across(glm::dot(right, p), glm::dot(up, p));
        const float along = glm::dot(view.forward, p);
        least = glm::min(least, across + filled * along);
        most = glm::max(most, across - filled * along);
        nearest = std::min(nearest, along);
    }
    const glm::vec2 at = 0.5f * (least + most), back = (least - most) / (2.0f * filled);
    const float away = std::min({back.x, back.y, nearest - 1e-6f});
    view.eye = right * at.x + up * at.y + view.forward * away;
    view.right = right / tangent.x;
    view.up = up / tangent.y;
    view.near = 0.5f * (nearest - away);
    view.centre = 0.5f * (lo + hi);
    view.radius = std::max(0.5f * glm::length(hi - lo), 1e-6f);
    view.ground = lo.y;
    return view;
}

gpu::RenderPush look(const Camera& camera, std::span<const gpu::MeshVertex> points, float aspect) {
    gpu::RenderPush view = {};
    glm::vec3 lo(std::numeric_limits<float>::infinity()), hi = -lo, target;
    for (int axis = 0; axis < 3; ++axis) {
        view.eye[axis] = float(camera.position[std::size_t(axis)]);
        target[axis] = float(camera.target[std::size_t(axis)]);
    }
    view.forward = glm::normalize(target - view.eye);
    // Straight up or down, what was ahead before is up.
    const glm::vec3 upward = std::abs(view.forward.y) < 0.9999f ? glm::vec3(0, 1, 0) : glm::vec3(0, 0, -1);
    const glm::vec3 right = glm::normalize(glm::cross(view.forward, upward));
    const float tangent = std::tan(glm::radians(0.5f * float(camera.fov)));
    view.right = right / (tangent * aspect);
    view.up = glm::cross(right, view.forward) / tangent;
    float nearest = std::numeric_limits<float>::infinity();
    for (const gpu::MeshVertex& vertex : points) {
        lo = glm::min(lo, vertex.position), hi = glm::max(hi, vertex.position);
        nearest = std::min(nearest, glm::dot(view.forward, vertex.position - view.eye));
    }
    view.centre = 0.5f * (lo + hi);
    view.radius = std::max(0.5f * glm::length(hi - lo), 1e-6f);
    view.ground = lo.y;
    view.near = std::max(0.5f * nearest, 1e-3f * view.radius);
    return view;
}

Camera framingCamera(std::span<const gpu::MeshVertex> points, float aspect) {
    const gpu::RenderPush view = frame(points, aspect);
    const float away = std::max(glm::dot(view.centre - view.eye, view.forward), view.near);
    const glm::vec3 target = view.eye + away * view.forward;
    return {.position = {view.eye.x, view.eye.y, view.eye.z},
            .target = {target.x, target.y, target.z},
            .fov = double(glm::degrees(2.0f * std::atan(1.0f / glm::length(view.up))))};
}

Result<Picture> renderPicture(const Device& device, const RenderPipelines& pipelines,
                              const RenderScene& scene, const RenderOptions& options) {
    if (const Done fits = checkPictureSize(options.width, options.height); !fits) return fits.error();
    const std::size_t pixels = std::size_t(options.width) * std::size_t(options.height);
    // A buffer cannot be bound by no bytes; of an empty mesh nothing is drawn.
    const VkDeviceSize vertexBytes = VkDeviceSize(std::max(scene.vertices, 1u)) * sizeof(gpu::MeshVertex);
    if (vertexBytes > device.properties.limits.maxStorageBufferRange)
        return problem("the mesh has more vertices than device '" + device.name() +
                       "' can draw at once: lower --resolution");

    const auto points = download<gpu::MeshVertex>(device, scene.mesh.vertices, scene.vertices);
    const float aspect = float(options.width) / float(options.height);
    const std::span<const gpu::MeshVertex> seen = options.framed.empty() ? points : options.framed;
    gpu::RenderPush view =
        options.scene.camera ? look(*options.scene.camera, seen, aspect) : frame(seen, aspect);
    // A field without a known constant is trusted half way: its shadows may be a little off.
    view.stepScale = std::isfinite(scene.lipschitz) ? 1.0f / std::max(scene.lipschitz, 1.0f) : 0.5f;
    view.lo = scene.grid.lo;
    view.hi = scene.grid.hi;
    view.cellSize = scene.grid.cellSize;
    view.width = uint32_t(options.width);
    view.height = uint32_t(options.height);

    const Image depth = createImage(
        device, {.extent = {view.width * RENDER_SAMPLES, view.height * RENDER_SAMPLES, 1},
                 .format = kDepthFormat,
                 .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT});
    const Sampler sampler = createSampler(device, VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
    const Buffer shaded = createBuffer(device, 4 * pixels, Memory::readback);
    std::vector<Descriptor> bound = {
        Descriptor(0, depth.view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, sampler.handle),
        Descriptor(1, shaded), Descriptor(2, scene.mesh.vertices, 0, vertexBytes)};
    if (scene.parameters) bound.emplace_back(FIELD_PARAMETERS, *scene.parameters);
    if (scene.images) bound.emplace_back(FIELD_IMAGES, *scene.images);

    {
        Commands commands(device);
        recordDepth(commands, pipelines, scene.mesh, view, depth, bound);
        submit(commands);
    }
    // Rows in bands, each submitted by itself: no device hangs over a heavy field, and Ctrl-C is heard.
    for (uint32_t row = 0; row < view.height; row += kRowsAtOnce) {
        if (options.cancel && *options.cancel) return problem("cancelled");
        if (options.progress) options.progress(int(100 * row / view.height));
        view.firstRow = row;
        const uint32_t rows = std::min(kRowsAtOnce, view.height - row);
        Commands commands(device);
        dispatch(commands, pipelines.shade,
                 {groupsFor(view.width, RENDER_GROUP_X), groupsFor(rows, RENDER_GROUP_Y), 1}, view, bound);
        barrier(commands);
        submit(commands);
    }
    return Picture{options.width, options.height, download<uint8_t>(device, shaded, 4 * pixels)};
}

}  // namespace fw
