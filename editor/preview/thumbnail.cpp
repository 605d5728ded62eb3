#include "editor/preview/thumbnail.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec3.hpp>

#include "editor/document/edits.h"
#include "editor/document/paths.h"
#include "editor/preview/pinned.h"
#include "graph/assets/image.h"
#include "graph/bounds/region.h"
#include "graph/compile/compile.h"
#include "graph/evaluate/tape.h"
#include "runtime/particles/particle_fields.h"
#include "runtime/play/step_constant.h"
#include "runtime/render/view.h"

namespace fw::editor {

namespace {

constexpr std::size_t kSide = kThumbnailSide;
static_assert(kSide <= TapeMachine<float>::kPoints, "a row is one batch");
constexpr int kMostSteps = 160;
constexpr glm::dvec3 kBackdrop(0.035, 0.037, 0.042);
/// Of fields whose Lipschitz constant is unknown: steps of the solid's size that do not jump over much.
constexpr double kBlindStep = 1.0 / 64, kLeastStep = 1.0 / 1024;

/// Rays from the camera, and how far each has come.
struct Rays {
    glm::dvec3 eye;
    std::array<glm::dvec3, kSide> direction;
    std::array<double, kSide> along, end;
    std::array<bool, kSide> hit;
};

struct Field {
    Tape tape, colors;  ///< the distance, within the solid's box; and the base colour
    double size;        ///< of the solid's box, metres
    double lipschitz;   ///< within the solid's box; infinite: unknown
    TapeMachine<float> machine = {};

    /// Puts the ends of some of the rays where the machine reads them.
    void place(const Rays& rays, std::size_t first, std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) {
            const glm::dvec3 p = rays.eye + rays.along[first + i] * rays.direction[first + i];
            for (int axis = 0; axis < 3; ++axis) machine.position(axis)[i] = float(p[axis]);
        }
    }
    const float* at(const Rays& rays) {
        place(rays, 0, kSide);
        return machine.value(tape, kSide);
    }
    double step(double distance) const {
        const bool known = std::isfinite(lipschitz);
        const double step =
            known ? distance / std::max(lipschitz, 1.0) : std::min(distance, kBlindStep * size);
        return std::max(step, kLeastStep * size);
    }
};

/// Where each ray meets the box; those that miss it end before they begin.
void enter(Rays& rays, const Box& box) {
    for (std::size_t i = 0; i < kSide; ++i) {
        double near = 0, far = 1e30;
        for (int axis = 0; axis < 3; ++axis) {
            const double a = (box.lo[std::size_t(axis)] - rays.eye[axis]) / rays.direction[i][axis];
            const double b = (box.hi[std::size_t(axis)] - rays.eye[axis]) / rays.direction[i][axis];
            near = std::max(near, std::min(a, b)), far = std::min(far, std::max(a, b));
        }
        rays.along[i] = near, rays.end[i] = far, rays.hit[i] = false;
    }
}

void trace(Rays& rays, Field& field) {
    for (int step = 0; step < kMostSteps; ++step) {
        const float* value = field.at(rays);
        bool more = false;
        for (std::size_t i = 0; i < kSide; ++i) {
            if (rays.hit[i] || rays.along[i] > rays.end[i]) continue;
            if (value[i] <= 0.5 * kLeastStep * field.size)
                rays.hit[i] = true;
            else
                rays.along[i] += field.step(value[i]), more = true;
        }
        if (!more) return;
    }
}

/// The light that comes back from where the rays ended: a lamp at the left above, and a sky.
std::array<glm::dvec3, kSide> shade(const Rays& rays, Field& field) {
    static const glm::dvec3 lamp = glm::normalize(glm::dvec3(-0.45, 0.75, 0.5));
    std::array<glm::dvec3, kSide> normal, color;
    constexpr std::size_t kBatch = TapeMachine<float>::kGradientPoints;
    for (std::size_t first = 0; first < kSide; first += kBatch) {
        const std::size_t count = std::min(kBatch, kSide - first);
        field.place(rays, first, count);
        const auto [values, slopes] = field.machine.gradient(field.tape, count);
        for (std::size_t i = 0; i < count; ++i)
            normal[first + i] = {slopes[0][i], slopes[1][i], slopes[2][i]};
    }
    field.place(rays, 0, kSide);
    field.machine.value(field.colors, kSide);
    for (std::size_t c = 0; c < 3; ++c) {
        const float* base = field.machine.root(field.colors, c);
        for (std::size_t i = 0; i < kSide; ++i) color[i][int(c)] = std::max(double(base[i]), 0.0);
    }
    for (std::size_t i = 0; i < kSide; ++i) {
        const double length = glm::length(normal[i]);
        const glm::dvec3 n = length > 0 ? normal[i] / length : -rays.direction[i];
        color[i] *= 0.75 * std::max(glm::dot(n, lamp), 0.0) + 0.18 + 0.12 * n.y;
        if (!rays.hit[i]) color[i] = kBackdrop;
    }
    return color;
}

uint8_t display(double linear) {
    return uint8_t(std::lround(255.0 * encodeSrgb(std::clamp(linear, 0.0, 1.0))));
}

/// Rays of the row of pixels at height y, traced to the solid.
Rays row(const gpu::View& view, std::size_t y, Field& field, const Box& box) {
    Rays rays{};
    rays.eye = view.eye;
    for (std::size_t x = 0; x < kSide; ++x) {
        const double u = (2.0 * double(x) + 1.0) / kSide - 1.0, v = 1.0 - (2.0 * double(y) + 1.0) / kSide;
        rays.direction[x] =
            glm::normalize(glm::dvec3(view.forward) + u * glm::dvec3(view.right) + v * glm::dvec3(view.up));
    }
    enter(rays, box);
    trace(rays, field);
    return rays;
}

Picture draw(Field& field, const Box& box) {
    std::vector<gpu::MeshVertex> corners(8), seen;
    for (std::size_t i = 0; i < 8; ++i)
        for (std::size_t axis = 0; axis < 3; ++axis)
            corners[i].position[int(axis)] = float((i >> axis & 1) ? box.hi[axis] : box.lo[axis]);
    // The box fits the view, the solid fits it better: what a first look sees is framed.
    gpu::View view = framingView(corners, 1.0f);
    for (std::size_t y = 0; y < kSide; ++y) {
        const Rays rays = row(view, y, field, box);
        for (std::size_t x = 0; x < kSide; ++x)
            if (rays.hit[x])
                seen.emplace_back().position = glm::vec3(rays.eye + rays.along[x] * rays.direction[x]);
    }
    if (!seen.empty()) view = framingView(seen, 1.0f);
    Picture picture{int(kSide), int(kSide), {}};
    for (std::size_t y = 0; y < kSide; ++y)
        for (const glm::dvec3& color : shade(row(view, y, field, box), field))
            for (const double c : {color.x, color.y, color.z, 1.0}) picture.pixels.push_back(display(c));
    return picture;
}

}  // namespace

Result<Thumbnail> thumbnail(const Graph& graph, std::string_view path,
                            std::span<const FieldVolumePtr> particles, uint64_t made) {
    const auto [scope, id] = placeOf(graph, path);
    if (!findNode(nodesOf(graph, scope), id)) return Error{.message = "there is no such node"};
    Result<Program> program =
        compile(showingNode(graph, path), {.bake = draftInPlace, .finest = kDraftFieldResolution});
    if (!program) return program.error();
    const bool ofParticles = lacksParticles(*program);
    if (!ofParticles && program->structureHash == made) return Thumbnail{made};
    if (ofParticles && particles.empty()) return Thumbnail{.made = made, .particles = true};
    useParticles(*program, particles);
    if (lacksParticles(*program)) return Error{.message = "its particles are not in the picture: connect it"};
    const std::vector<double> parameters = program->parameters();
    const Region region = findRegion(*program);
    if (region.extent == Extent::empty)
        return Error{.message = "there is nothing to see: the solid is empty"};
    // What has no end is looked at where things mostly are.
    const Box box = padded(region.extent == Extent::bounded ? region.box : kUnbounded, kThumbnailSide, 1.0);
    double size = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) size = std::max(size, box.hi[axis] - box.lo[axis]);
    const std::span<const IrId> color = std::span(program->surface).subspan(baseColorComponent, 3);
    Field field{makeTape(program->ir, program->distance(), parameters),
                makeTape(program->ir, color, parameters), size,
                stepConstantWithin(*program, box, kMaxLiveConstant)};
    field.machine.interval(field.tape, box);
    field.tape = field.machine.shortened(field.tape);
    return Thumbnail{program->structureHash, draw(field, box), ofParticles};
}

}  // namespace fw::editor
