#include "runtime/textures/bake.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/packing.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <numbers>

#include "graph/assets/image.h"
#include "graph/base/parallel.h"
#include "runtime/mesh/field_values.h"
#include "runtime/textures/dilate.h"
#include "runtime/textures/surface_places.h"

namespace fw {
namespace {

constexpr int kTile = 32;    ///< texels along a side that are baked together
constexpr int kCells = 512;  ///< of the grid for occlusion, along a side at most

/// 0..1 linear to 0..255 sRGB.
uint8_t srgb8(float linear) {
    constexpr int kShades = 1 << 14;  // in the dark a code is five of them wide
    static const std::vector<uint8_t> codes = [] {
        std::vector<uint8_t> table;
        for (int i = 0; i <= kShades; ++i)
            table.push_back(uint8_t(std::lround(255 * encodeSrgb(double(i) / kShades))));
        return table;
    }();
    return linear > 0.0f ? codes[std::size_t(std::lround(std::min(linear, 1.0f) * kShades))] : uint8_t(0);
}

uint8_t unit8(float value) {
    return value > 0.0f ? uint8_t(std::lround(255 * std::min(value, 1.0f))) : uint8_t(0);
}

void put(std::vector<uint8_t>& image, std::size_t texel, uint8_t r, uint8_t g, uint8_t b) {
    image[3 * texel] = r, image[3 * texel + 1] = g, image[3 * texel + 2] = b;
}

/// One place of a cell for each chart that is seen in it, and how open the sky is there.
struct CellPlace {
    uint32_t chart;
    std::size_t texel;
    float open = 1;
};

class Baker {
  public:
    Baker(const Unwrapping& unwrapping_, const Texels& texels_, const Program& program,
          const BakeOptions& options_)
        : unwrapping(unwrapping_),
          mesh(unwrapping_.mesh),
          texels(texels_),
          options(options_),
          size(std::size_t(texels_.size)),
          distance(makeTape(program.ir, program.distance(), program.parameters())),
          surface(makeTape(program.ir, std::span(program.surface).subspan(1, kBaked), program.parameters())),
          seeker(mesh, texels, distance, options.reach, 1e-5f * options.radius),
          cell(std::max<std::size_t>(1, size / kCells)),
          cells((size + cell - 1) / cell) {
        for (std::size_t i = emissionComponent; i < emissionComponent + 3u; ++i)
            glows = glows || !program.ir.isConstant(program.surface[i], 0.0);
    }

    MeshTextures bake() {
        const std::size_t count = size * size;
        MeshTextures made{.size = int(size)};
        for (std::vector<uint8_t>* image : {&made.baseColor, &made.surface, &made.normal})
            image->assign(3 * count, 0);
        if (glows) emission.assign(count, 0);
        lookAtSky();
        const std::size_t tiles = (size + kTile - 1) / kTile;
        forBlocks(tiles * tiles, 4, [&](std::size_t, std::size_t first, std::size_t last) {
            TapeMachine<float> machine;
            for (std::size_t tile = first; tile < last; ++tile)
                bakeTile(machine, tile % tiles * kTile, tile / tiles * kTile, made);
        });
        if (glows) writeEmission(made);
        fillGutter(made);
        return made;
    }

  private:
    static constexpr std::size_t kBaked = transmissionComponent - baseColorComponent;

    uint32_t chartAt(std::size_t texel) const { return unwrapping.charts.ofTriangle[texels.triangle[texel]]; }

    /// Texels of the square that have a triangle, those of one chart behind each other.
    std::vector<std::size_t> textured(std::size_t left, std::size_t top, std::size_t side) const {
        std::vector<std::size_t> found;
        for (std::size_t y = top; y < std::min(top + side, size); ++y)
            for (std::size_t x = left; x < std::min(left + side, size); ++x)
                if (texels.triangle[y * size + x] != kNoTriangle) found.push_back(y * size + x);
        std::ranges::stable_sort(found, {}, [&](std::size_t texel) { return chartAt(texel); });
        return found;
    }

    void bakeTile(TapeMachine<float>& machine, std::size_t left, std::size_t top, MeshTextures& made) {
        const std::vector<std::size_t> all = textured(left, top, kTile);
        for (std::size_t first = 0, last = 0; first < all.size(); first = last) {
            while (last < all.size() && chartAt(all[last]) == chartAt(all[first])) ++last;
            const std::span<const std::size_t> some = std::span(all).subspan(first, last - first);
            const std::vector<SurfacePlace> places = seeker.find(machine, some);
            for (std::size_t i = 0; i < some.size(); ++i) bakeNormal(places[i], some[i], made);
            bakeSurface(machine, places, some, made);
        }
    }

    /// In the frame that a shader makes of what vertices have, none of it of unit length between them.
    void bakeNormal(const SurfacePlace& place, std::size_t texel, MeshTextures& made) const {
        const uint32_t* corner = &mesh.indices[3 * std::size_t(place.triangle)];
        glm::vec3 normal(0.0f), tangent(0.0f);
        for (int k = 0; k < 3; ++k) {
            normal += place.shares[k] * mesh.normals[corner[k]];
            tangent += place.shares[k] * glm::vec3(mesh.tangents[corner[k]]);
        }
        const glm::vec3 bitangent = glm::cross(normal, tangent) * mesh.tangents[corner[0]].w;
        glm::vec3 told = glm::inverse(glm::mat3(tangent, bitangent, normal)) * place.normal;
        const float length = glm::length(told);
        told = length > 0.0f && std::isfinite(length) ? told / length : glm::vec3(0, 0, 1);
        const glm::vec3 code = 0.5f * told + 0.5f;
        put(made.normal, texel, unit8(code.x), unit8(code.y), unit8(code.z));
    }

    void bakeSurface(TapeMachine<float>& machine, std::span<const SurfacePlace> places,
                     std::span<const std::size_t> of, MeshTextures& made) {
        constexpr std::size_t kBatch = TapeMachine<float>::kPoints;
        std::vector<glm::vec3> points;
        for (const SurfacePlace& place : places) points.push_back(place.position);
        const Tape tape = tapeFor(machine, surface, boxOf(points));
        for (std::size_t first = 0; first < points.size(); first += kBatch) {
            const std::size_t count = std::min(kBatch, points.size() - first);
            for (int axis = 0; axis < 3; ++axis)
                for (std::size_t i = 0; i < count; ++i) machine.position(axis)[i] = points[first + i][axis];
            machine.value(tape, count);
            for (std::size_t i = 0; i < count; ++i) {
                const auto number = [&](std::size_t component) {
                    return machine.root(tape, component - baseColorComponent)[i];
                };
                const std::size_t texel = of[first + i];
                put(made.baseColor, texel, srgb8(number(baseColorComponent)),
                    srgb8(number(baseColorComponent + 1)), srgb8(number(baseColorComponent + 2)));
                put(made.surface, texel, unit8(openAt(texel)), unit8(number(roughnessComponent)),
                    unit8(number(metallicComponent)));
                if (!glows) continue;
                glm::vec3 light;
                for (int k = 0; k < 3; ++k) {
                    const float some = number(std::size_t(emissionComponent + k));
                    light[k] = some > 0.0f ? some : 0.0f;
                }
                emission[texel] = glm::packF3x9_E1x5(light);
            }
        }
    }

    // ---- occlusion

    void lookAtSky() {
        firstOf.assign(cells * cells + 1, 0);
        for (std::size_t i = 0; i < cells * cells; ++i) {
            const std::size_t left = i % cells * cell, top = i / cells * cell;
            const auto middle = [&](std::size_t texel) {
                const float x = float(texel % size) - float(left) - 0.5f * float(cell - 1),
                            y = float(texel / size) - float(top) - 0.5f * float(cell - 1);
                return x * x + y * y + (texels.inside[texel] ? 0.0f : float(cell * cell));
            };
            for (const std::size_t texel : textured(left, top, cell)) {
                const bool same = cellPlaces.size() > firstOf[i] && cellPlaces.back().chart == chartAt(texel);
                if (!same)
                    cellPlaces.push_back({chartAt(texel), texel});
                else if (middle(texel) < middle(cellPlaces.back().texel))
                    cellPlaces.back().texel = texel;
            }
            firstOf[i + 1] = uint32_t(cellPlaces.size());
        }
        forBlocks(cellPlaces.size(), 64, [&](std::size_t, std::size_t first, std::size_t last) {
            TapeMachine<float> machine;
            std::vector<std::size_t> of;
            for (std::size_t i = first; i < last; ++i) of.push_back(cellPlaces[i].texel);
            const std::vector<SurfacePlace> places = seeker.find(machine, of);
            for (std::size_t i = 0; i < places.size(); ++i)
                cellPlaces[first + i].open = skySeen(machine, places[i]);
        });
    }

    /// The part of the hemisphere that is open, by its cosine.
    float skySeen(TapeMachine<float>& machine, const SurfacePlace& place) const {
        constexpr std::size_t kPoints = kRays * kAlong.size();
        static_assert(kPoints <= TapeMachine<float>::kPoints);
        if (place.slope == 0.0f) return 1.0f;
        const ChartPlane plane = planeOf(place.normal);
        std::array<float, kRays> cosines;
        for (std::size_t ray = 0; ray < kRays; ++ray) {
            // Even over the disc below the hemisphere, and so by the cosine on it.
            const float radius = std::sqrt((float(ray) + 0.5f) / kRays),
                        angle = float(ray) * std::numbers::pi_v<float> * (3.0f - std::sqrt(5.0f));
            cosines[ray] = std::sqrt(1.0f - radius * radius);
            const glm::vec3 way = radius * std::cos(angle) * plane.right +
                                  radius * std::sin(angle) * plane.up + cosines[ray] * place.normal;
            for (std::size_t i = 0; i < kAlong.size(); ++i) {
                const glm::vec3 p = place.position + kAlong[i] * options.radius * way;
                for (int axis = 0; axis < 3; ++axis)
                    machine.position(axis)[ray * kAlong.size() + i] = p[axis];
            }
        }
        const float* values = machine.value(distance, kPoints);
        float open = 0.0f;
        for (std::size_t ray = 0; ray < kRays; ++ray) {
            float least = 1.0f;
            for (std::size_t i = 0; i < kAlong.size(); ++i) {
                const float rise =
                    values[ray * kAlong.size() + i] / (place.slope * kAlong[i] * options.radius);
                const float plain = std::min(cosines[ray], kCone);  // of an endless plane
                least = std::min(least, std::clamp((rise + kCone) / (plain + kCone), 0.0f, 1.0f));
            }
            open += least / kRays;
        }
        return open;
    }

    /// By the plane that is nearest to what the places of the cells about a texel have, of those of its
    /// chart: on the chart's border, where there are some on one side alone, it goes on as they do.
    float openAt(std::size_t texel) const {
        if (cell == 1) return cellPlaces[firstOf[texel]].open;
        const uint32_t chart = chartAt(texel);
        const auto x = int(texel % size), y = int(texel / size), side = int(cell), along = int(cells);
        double w = 0, wx = 0, wy = 0, wxx = 0, wxy = 0, wyy = 0, wv = 0, wvx = 0, wvy = 0;
        for (int cy = std::max(0, y / side - 1); cy <= std::min(along - 1, y / side + 1); ++cy)
            for (int cx = std::max(0, x / side - 1); cx <= std::min(along - 1, x / side + 1); ++cx) {
                const std::size_t at = std::size_t(cy) * cells + std::size_t(cx);
                for (std::size_t i = firstOf[at]; i < firstOf[at + 1]; ++i) {
                    if (cellPlaces[i].chart != chart) continue;
                    const double dx = double(int(cellPlaces[i].texel % size) - x) / side,
                                 dy = double(int(cellPlaces[i].texel / size) - y) / side;
                    const double near = std::max(0.02, 1 - (dx * dx + dy * dy) / 2.25), weight = near * near,
                                 value = cellPlaces[i].open;
                    w += weight, wx += weight * dx, wy += weight * dy;
                    wxx += weight * dx * dx, wxy += weight * dx * dy, wyy += weight * dy * dy;
                    wv += weight * value, wvx += weight * value * dx, wvy += weight * value * dy;
                }
            }
        if (w == 0) return 1.0f;
        const glm::dmat3 sums(w, wx, wy, wx, wxx, wxy, wy, wxy, wyy);
        const double size2 = glm::determinant(sums);
        if (size2 < 1e-3 * w * w * w) return float(wv / w);  // they lie on a line
        return float((glm::inverse(sums) * glm::dvec3(wv, wvx, wvy)).x);
    }

    // ---- what becomes of it

    void writeEmission(MeshTextures& made) const {
        float most = 0.0f;
        for (const uint32_t packed : emission) {
            const glm::vec3 light = glm::unpackF3x9_E1x5(packed);
            most = std::max({most, light.x, light.y, light.z});
        }
        if (most == 0.0f) return;
        made.emissionStrength = most;
        made.emission.assign(3 * emission.size(), 0);
        for (std::size_t i = 0; i < emission.size(); ++i) {
            const glm::vec3 share = glm::unpackF3x9_E1x5(emission[i]) / most;
            put(made.emission, i, srgb8(share.x), srgb8(share.y), srgb8(share.z));
        }
    }

    void fillGutter(MeshTextures& made) const {
        std::vector<uint8_t> known(size * size);
        for (std::size_t i = 0; i < known.size(); ++i) known[i] = texels.triangle[i] != kNoTriangle;
        std::vector<std::vector<uint8_t>*> images{&made.baseColor, &made.surface, &made.normal};
        if (!made.emission.empty()) images.push_back(&made.emission);
        dilate(images, std::move(known), int(size), std::max(4, 2 * unwrapping.gutter));
    }

    /// Of the radius, where a ray looks at the field; and the sine of half the width of its cone.
    static constexpr std::array<float, 6> kAlong{0.03f, 0.07f, 0.15f, 0.3f, 0.55f, 1.0f};
    static constexpr float kCone = 0.2f;

    const Unwrapping& unwrapping;
    const Mesh& mesh;
    const Texels& texels;
    const BakeOptions options;
    const std::size_t size;
    const Tape distance, surface;
    const SurfaceSeeker seeker;
    const std::size_t cell, cells;  ///< texels along a cell's side, cells along the texture's
    std::vector<CellPlace> cellPlaces;
    std::vector<uint32_t> firstOf;  ///< of each cell
    bool glows = false;
    std::vector<uint32_t> emission;  ///< with a common exponent
};

}  // namespace

MeshTextures bakeTextures(const Unwrapping& unwrapping, const Texels& texels, const Program& program,
                          const BakeOptions& options) {
    return Baker(unwrapping, texels, program, options).bake();
}

}  // namespace fw
