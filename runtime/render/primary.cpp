#include "runtime/render/primary.h"

#include <cmath>
#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>

#include "shaders/render/ambient.h"

namespace fw {

namespace {

constexpr uint32_t kMostSteps = 128;
constexpr uint32_t kGroup = 8;  // pixels along each side of a work group

}  // namespace

CameraView viewOf(const PrimaryCamera& camera, float aspect) {
    glm::mat4 projection = glm::perspectiveRH_ZO(camera.fieldOfView, aspect, camera.near, camera.far);
    projection[1][1] *= -1;
    CameraView view;
    view.viewProjection = projection * glm::lookAtRH(camera.eye, camera.target, glm::vec3(0, 1, 0));
    view.inverseViewProjection = glm::inverse(view.viewProjection);
    view.eye = camera.eye;
    return view;
}

Pipeline createPrimary(const Device& device, std::string_view field) {
    return createComputePipeline(device, {.name = "render/primary.comp", .field = field});
}

void drawPrimary(Commands& commands, const Pipeline& primary, const PrimaryCamera& camera, float lipschitz,
                 const Image& depth, const Image& normal, const Buffer* parameters) {
    const VkExtent3D extent = depth.extent;
    const float tangent = std::tan(0.5f * camera.fieldOfView);
    const glm::vec3 forward = glm::normalize(camera.target - camera.eye);
    const glm::vec3 right = glm::normalize(glm::cross(forward, glm::vec3(0, 1, 0)));
    gpu::PrimaryPush push{};
    push.eye = camera.eye;
    push.near = camera.near;
    push.forward = forward;
    push.far = camera.far;
    push.right = right * (tangent * float(extent.width) / float(extent.height));
    push.down = glm::cross(forward, right) * tangent;
    push.pixel = tangent / float(extent.height);
    push.stepScale = std::isfinite(lipschitz) ? 1.0f / std::max(lipschitz, 1.0f) : 0.5f;
    push.width = extent.width;
    push.height = extent.height;
    push.steps = kMostSteps;
    beginStage(commands, "primary");
    std::vector<Descriptor> bound = {{0, depth.view, VK_IMAGE_LAYOUT_GENERAL},
                                     {1, normal.view, VK_IMAGE_LAYOUT_GENERAL}};
    if (parameters) bound.push_back({FIELD_PARAMETERS, *parameters});
    dispatch(commands, primary, {groupsFor(extent.width, kGroup), groupsFor(extent.height, kGroup), 1}, push,
             bound);
    barrier(commands);
}

}  // namespace fw
