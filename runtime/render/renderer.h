// From a mesh in device memory and the field that it was made of to a lit picture.
//
// The pipeline of the talk's "Illumination": primary visibility and the sun's shadow map are rasterised from
// the generated mesh, or traced where that is cheaper; everything secondary is traced through the field. In
// order: shadow map, depth, G-buffer (gbuffer.h), ambient occlusion (ambient.h), the lamps' light with traced
// shadows, fog with the sun's rays, light (shaders/render/light.comp: GGX, sky or studio, tone map, sRGB).
// Stages that nothing in the scene asks for are neither run nor compiled.
//
// A still picture is the mean of frames that differ in where in its pixels the picture is sampled, where on
// the sun's disc its light comes from, where on the lens it is seen from and how the ambient rays are turned:
// so edges, penumbras, what is out of focus and ambient occlusion converge together. The same input gives the
// same bytes on the same device. The live view draws one frame at a time with what the last one knew
// (ambient.h), goes on to the same mean while nothing changes, and then stops.
//
// Until the kernels of a field are compiled, and of meshes that no longer are the field's, the renderer draws
// drafts (draft.h).
//
// Lifetime: a Renderer belongs to one device and has the kernels of one field at a time; images and buffers
// take the size of the picture and keep it until another is asked for.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "runtime/render/ambient.h"
#include "runtime/render/antialias.h"
#include "runtime/render/bloom.h"
#include "runtime/render/draft.h"
#include "runtime/render/environment.h"
#include "runtime/render/fog.h"
#include "runtime/render/light_picture.h"
#include "runtime/render/paths.h"
#include "runtime/render/picture.h"
#include "runtime/render/places.h"
#include "runtime/render/secondary.h"
#include "runtime/render/sprites.h"

namespace fw {

/// The box that a mesh was made in, capped at its sides, and the size of its cells, metres.
struct MeshGrid {
    glm::vec3 lo{-1.0f}, hi{1.0f};
    float cellSize = 2.0f / 128;
};

/// What is drawn.
struct RenderScene {
    const MesherBuffers& mesh;
    uint32_t vertices = 0, triangles = 0;           ///< of the mesh
    MeshGrid grid;                                  ///< that it was made on
    float lipschitz = 1.0f;                         ///< of the field; infinite if unknown
    bool lipschitzWithinGrid = false;               ///< it holds only within the grid's box
    FieldBuffers buffers = {};                      ///< of the field, without lists
    const Families* families = nullptr;             ///< of the field, where it has some
    bool transmits = false;                         ///< light passes through some of it
    SeenBounds bounds = {};                         ///< of RenderOptions::framed
    std::span<const ParticleCloud> particles = {};  ///< whose surfaces the field lacks, for their views
    /// If given, the mesh alone is drawn, in this material or its colours: the renderer need not have the
    /// field's kernels.
    std::optional<gpu::DraftMaterial> draft = {};
    uint64_t content =
        0;  ///< another number if mesh or field differ from those of the live view's last frame
};

/// How depth is found. A field without a known Lipschitz constant is traced only if that was measured to show
/// what drawing shows.
enum class Primary { drawn, traced, measured };

/// Views into the field: of those that shaders/render/render.h lists.
constexpr bool showsField(uint32_t view) { return view >= RENDER_STEPS && view <= RENDER_GAP; }
/// Those of how wide walls and gaps are.
constexpr bool showsWidths(uint32_t view) { return view == RENDER_THICKNESS || view == RENDER_GAP; }
/// Views that no light is in: what surfaces are, and how open to the sky and the sun.
constexpr bool showsNoLight(uint32_t view) { return view >= RENDER_AMBIENT && view <= RENDER_SHADOW; }
/// Views of particles in place of their surface.
constexpr bool showsParticles(uint32_t view) { return view == RENDER_POINTS || view == RENDER_SPHERES; }

/// The plane of the views that show the field on one.
struct Slice {
    int axis = -1;    ///< that it stands across, 0 to 2; -1: x or z, whichever the view is along
    float at = 0.0f;  ///< along the axis from the solid's middle, metres
    bool operator==(const Slice&) const = default;
};

struct RenderOptions {
    int width = 1280, height = 720;      ///< pixels
    Scene scene = {};                    ///< as it is at the time of the picture
    EnvironmentMapPtr environment = {};  ///< that scene.sky names, if it names one
    /// The solid's points, by which the picture is framed, stands on the ground and scales its light. There
    /// is at least one, unless the scene has a camera.
    std::span<const gpu::MeshVertex> framed = {};
    int samples = 16;  ///< frames that a still picture is the mean of, 1 to kMostSamples
    /// A picture of what moves is made moment by moment, each with its part of the samples, in order: which
    /// one this is, and of how many. The last one makes the picture.
    int moment = 0, moments = 1;
    double framesPerSecond = 0.0;  ///< by which Player counts the camera's shutter; 0: the timeline's
    Primary primary = Primary::traced;
    /// Of a live view that moves; none: unless the device is software, which has no time to spare.
    std::optional<bool> antialias = {};
    bool reference = false;    ///< trace primary rays, and 64 rays of ambient occlusion a sample, none kept
    int bounces = 0;           ///< of the reference, if above 0: whole paths of light (paths.h), one a sample
    PathSums* sums = nullptr;  ///< where paths go on from, and what they are left in, if given
    std::function<void()> keepSums = {};  ///< called now and then, with `sums` as they are
    bool cutout = false;                  ///< a still picture of the solid alone, with alpha
    LightPicture* light = nullptr;        ///< gets a still picture as light, if given
    uint32_t show = RENDER_PICTURE;       ///< or one of the views that shaders/render/render.h lists
    Slice slice = {};
    /// What walls and gaps are to be at least in their views, metres; 0: usualWidth() of the mesh's grid.
    float leastWidth = 0.0f;
    /// Looked at within a frame; that of a live view can be drawn again as if this one had not begun.
    const std::atomic<bool>* cancel = nullptr;
    std::function<void(int percent)> progress = {};
    /// Gets a still picture as it grows: of its first sample, and whenever it has about twice as many.
    std::function<void(Picture)> grows = {};
};

/// Light that spills from bright places, if the picture has some.
inline const Bloom* bloomOf(const RenderOptions& options) {
    const bool shown = options.show == RENDER_PICTURE && options.scene.bloom;
    return shown && options.scene.bloom->strength > 0.0 ? &*options.scene.bloom : nullptr;
}

/// The first sample of a moment: where that before ends.
inline int firstOf(const RenderOptions& options, int moment) {
    return int(int64_t(options.samples) * moment / options.moments);
}

/// Whether the sky is a picture's.
inline bool hasEnvironment(const RenderOptions& options) { return options.scene.sky && options.environment; }

inline constexpr int kMostSamples = 4096;
inline constexpr int kMostBounces = 64;

/// What the live view shows: while none of it changes, it rests.
struct Shown {
    gpu::View view;
    Scene scene;
    EnvironmentMapPtr environment;
    uint64_t content = 0;
    VkExtent3D extent = {};
    uint32_t show = RENDER_PICTURE;
    Slice slice = {};
    float leastWidth = 0.0f;
};

/// The kernels that evaluate the field.
struct FieldKernels {
    std::string field;
    Pipeline cones, trace, surface, ambient, ambientHoles;
    Pipeline places;         ///< only if the field has families
    Pipeline lamps;          ///< only if asked for
    Pipeline show, widths;   ///< the one that FieldKernelOptions::view asks for
    bool tracesSun = false;  ///< `lamps` does
    Pipeline secondary;      ///< ditto
    SecondaryKinds kinds;    ///< of that
};

struct FieldKernelOptions {
    bool lamps = false;              ///< the scene has some
    bool sun = false;                ///< its shadows are traced
    uint32_t view = RENDER_PICTURE;  ///< that pictures will be of
    std::optional<SecondaryKinds> secondary = {};
    Compile when = Compile::now;
    const std::atomic<bool>* cancel = nullptr;  ///< looked at between kernels if they are compiled behind
};

/// `field` is the text that answers #include "field.glsl", empty for the default field. None, if cancelled.
std::optional<FieldKernels> createFieldKernels(const Device& device, std::string field,
                                               const FieldKernelOptions& options = {});

struct Renderer {
    const Device* device = nullptr;
    std::string field;
    DepthPipelines depth;
    Draft draft;      ///< made by the first one
    Sprites sprites;  ///< ditto
    Clusters clusters;
    Places places;
    Environment environment;
    PathTracer paths;
    BloomPasses bloom;
    GBuffer gbuffer;
    Ambient ambient;
    Secondary secondary;
    FogLight fog;
    Antialias antialias;
    std::map<std::vector<std::string>, Pipeline> light;  ///< by what light.comp defines; made when needed
    Pipeline lamps, reference, show, widths, wireframe;  ///< ditto
    bool tracesSun = false;                              ///< `lamps` does

    DepthTarget seen, shadow;
    Image means, lampLight;
    Image pixels;     ///< the finished picture, R32_UINT: sRGB, red in the lowest byte
    Buffer frame;     ///< gpu::RenderFrame
    Buffer readback;  ///< the finished picture, where the host reads it

    gpu::RenderFrame described{};  ///< the last frame
    uint32_t number = 0;           ///< of frames since the start
    std::optional<Shown> shown;    ///< by the live view
    int rested = 0;                ///< frames that the live view's picture is the mean of, less one
    bool shadowStands = false;     ///< the shadow map is still that of the mesh and the sun
    std::optional<bool> tracing;   ///< what Primary::measured came to
    bool slow = true;    ///< a live frame of this field took long, or none was drawn: the next is parted
    float trust = 0.5f;  ///< part of its value by which a field without a known constant may be stepped
    bool measuredTrust = true;  ///< Primary::measured was found with `trust`, not with a known constant
};

/// `field` as for createFieldKernels.
Renderer createRenderer(const Device& device, std::string field);
/// Without a field: for drafts, until it has one.
Renderer createRenderer(const Device& device);

/// Draws this field from now on. The device is not using the kernels that the renderer had.
void setField(Renderer& renderer, FieldKernels kernels);

/// A still picture, by samples or by paths. Errors: as renderPaths() and checkPictureSize, samples out of
/// range, cancelled.
Result<Picture> renderPicture(Renderer& renderer, const RenderScene& scene, const RenderOptions& options);

/// The live view's next frame, into Renderer::pixels and, if one is given, `picture`; false if it would be
/// the same as the last, or if it was cancelled. Errors: as checkPictureSize.
Result<bool> renderLive(Renderer& renderer, const RenderScene& scene, const RenderOptions& options,
                        Picture* picture);

/// The picture in Renderer::readback, of these options.
Picture readPicture(const Renderer& renderer, const RenderOptions& options);

/// One frame of either, for the benchmarks: what its stages take. `view.pixel` is set here. False if the
/// commands were cancelled, before the picture was touched.
bool drawFrame(Commands& commands, Renderer& renderer, const RenderScene& scene, const RenderOptions& options,
               const gpu::View& view, bool resting, int mean);

}  // namespace fw
