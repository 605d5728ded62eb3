// A picture of a mesh that lies in device memory: its depth by rasterisation, then light from the field
// itself.
//
// The mesh is drawn indexed and indirect, for its depth alone, at twice the picture's width and height; a
// compute shader then shades every depth sample and averages (shaders/render/shade.comp says with what
// light). The camera is the scene's; without one it looks down from three quarters, from the side of +x and
// +z, as near as the whole mesh stays in the picture. The same input gives the same bytes on the same device.
//
// Lifetime: pipelines belong to a structure (a field's text), a picture to the caller.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string_view>

#include "graph/scene.h"
#include "runtime/mesher.h"
#include "shaders/render/render.h"

namespace fw {

inline constexpr int kLeastPictureSide = 16, kMostPictureSide = 8192;
inline constexpr int kMostPicturePixels = 32 << 20;  ///< 128 MiB of four bytes, which every device can bind

struct RenderPipelines {
    Pipeline depth, shade;
};

/// `field` is the text that answers #include "field.glsl", empty for the default field.
RenderPipelines createRenderPipelines(const Device& device, std::string_view field);

/// The box that a mesh was made in, capped at its sides, and the size of its cells, metres.
struct MeshGrid {
    glm::vec3 lo{-1.0f}, hi{1.0f};
    float cellSize = 2.0f / 128;
};

/// What is drawn.
struct RenderScene {
    const MesherBuffers& mesh;
    uint32_t vertices = 0;   ///< of the mesh; if there are none, a picture must be told what it frames
    MeshGrid grid;           ///< that it was made on
    float lipschitz = 1.0f;  ///< of the field; infinite if unknown
    const Buffer* parameters = nullptr;  ///< live ones, where the field has some
    const Buffer* images = nullptr;      ///< that the field samples, where it does
};

struct RenderOptions {
    int width = 1280, height = 720;  ///< pixels
    Scene scene = {};                ///< as it is at the time of the picture
    /// What a picture frames and stands on the ground, instead of the mesh's own points; none: those.
    std::span<const gpu::MeshVertex> framed = {};
    const std::atomic<bool>* cancel = nullptr;
    std::function<void(int percent)> progress = {};
};

/// Rows from the top, sRGB, four bytes a pixel: red, green, blue, 255.
struct Picture {
    int width = 0, height = 0;
    std::vector<uint8_t> pixels;
};

/// An Error where no picture of this size can be made.
Done checkPictureSize(int width, int height);

/// Errors: as checkPictureSize, a mesh of more vertices than the device can bind, cancelled.
Result<Picture> renderPicture(const Device& device, const RenderPipelines& pipelines,
                              const RenderScene& scene, const RenderOptions& options = {});

/// Where the camera stands, and how the picture's axes lie, so that all `points` are in it: the part of the
/// push constants up to `centre` that depends on them. `aspect` is width / height. There is at least one
/// point.
gpu::RenderPush frame(std::span<const gpu::MeshVertex> points, float aspect);

/// The same for a camera of the scene.
gpu::RenderPush look(const Camera& camera, std::span<const gpu::MeshVertex> points, float aspect);

/// The camera that frame() places, aimed at the middle of the points.
Camera framingCamera(std::span<const gpu::MeshVertex> points, float aspect);

/// Writes the picture as PNG without alpha. Errors: as OutputFile.
Done savePicture(const Picture& picture, const std::string& path, const std::atomic<bool>* cancel = nullptr);

}  // namespace fw
