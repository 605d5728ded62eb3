#include "runtime/mesh/materials.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <span>

#include "graph/base/parallel.h"
#include "graph/evaluate/tape.h"

namespace fw {
namespace {

/// A material as its numbers, which stand in the order of SurfaceComponent.
constexpr std::size_t kNumbers = kSurfaceComponents - roughnessComponent;
using Numbers = std::array<float, kNumbers>;
static_assert(sizeof(Material) == sizeof(Numbers));

/// NaN becomes the least.
float limited(float value, float least, float most) { return value > least ? std::min(value, most) : least; }

Material limited(Material m) {
    constexpr float kMost = std::numeric_limits<float>::max();
    for (float* share : {&m.roughness, &m.metallic, &m.transmission}) *share = limited(*share, 0.0f, 1.0f);
    for (int i = 0; i < 3; ++i) {
        m.emission[i] = limited(m.emission[i], 0.0f, kMost);
        m.absorption[i] = limited(m.absorption[i], 0.0f, kMost);
    }
    m.ior = limited(m.ior, 0.1f, 10.0f);
    if (m.transmission > 0.0f) return m;
    m.ior = Material().ior;
    m.absorption = Material().absorption;
    return m;
}

/// Each number as one of `levels` + 1 steps. Those without a greatest one count by what is seen of them: of
/// light that is given off a share of the brightest, of absorption what is lost along the chord.
using Steps = std::array<uint16_t, kNumbers>;
Steps stepsOf(const Material& m, float chord, float levels) {
    Material seen = m;
    seen.emission = m.emission / (1.0f + m.emission);
    seen.ior = m.ior / (1.0f + m.ior);
    for (int i = 0; i < 3; ++i) seen.absorption[i] = 1.0f - std::exp(-m.absorption[i] * chord);
    const auto numbers = std::bit_cast<Numbers>(seen);
    Steps steps;
    for (std::size_t i = 0; i < kNumbers; ++i) steps[i] = uint16_t(std::lround(numbers[i] * levels));
    return steps;
}

struct Groups {
    std::vector<uint32_t> of;  ///< each material
    std::size_t count = 0;
};

/// Nothing if they are more than kMostMaterials.
std::optional<Groups> groupsOf(std::span<const Material> materials, float chord, float levels) {
    std::map<Steps, uint32_t> known;
    Groups groups;
    groups.of.reserve(materials.size());
    for (std::size_t i = 0; i < materials.size(); ++i) {
        if (i > 0 && materials[i] == materials[i - 1]) {
            groups.of.push_back(groups.of.back());
            continue;
        }
        const auto next = uint32_t(known.size());
        groups.of.push_back(known.try_emplace(stepsOf(materials[i], chord, levels), next).first->second);
        if (known.size() > kMostMaterials) return std::nullopt;
    }
    groups.count = known.size();
    return groups;
}

using Machine = TapeMachine<float>;
constexpr std::size_t kBatch = Machine::kPoints;

glm::vec3 middleOf(const Mesh& mesh, std::size_t triangle) {
    const uint32_t* corner = &mesh.indices[3 * triangle];
    return (mesh.positions[corner[0]] + mesh.positions[corner[1]] + mesh.positions[corner[2]]) / 3.0f;
}

/// Of the field, for the middles of the triangles from first to before last. Neighbours mostly follow each
/// other, so that their box is small and its tape short.
Tape tapeAt(Machine& machine, const Tape& field, const Mesh& mesh, std::size_t first, std::size_t last) {
    glm::vec3 low = middleOf(mesh, first), high = low;
    for (std::size_t t = first + 1; t < last; ++t) {
        const glm::vec3 middle = middleOf(mesh, t);
        low = glm::min(low, middle);
        high = glm::max(high, middle);
    }
    machine.interval(field, {{low.x, low.y, low.z}, {high.x, high.y, high.z}});
    return machine.shortens() ? machine.shortened(field) : field;
}

/// Of a batch of triangles, from `first` on.
void evaluate(Machine& machine, const Tape& tape, const Mesh& mesh, std::size_t first,
              std::span<Material> materials) {
    for (std::size_t i = 0; i < materials.size(); ++i) {
        const glm::vec3 middle = middleOf(mesh, first + i);
        for (int axis = 0; axis < 3; ++axis) machine.position(axis)[i] = middle[axis];
    }
    machine.value(tape, materials.size());
    for (std::size_t i = 0; i < materials.size(); ++i) {
        Numbers numbers;
        for (std::size_t k = 0; k < kNumbers; ++k) numbers[k] = machine.root(tape, k)[i];
        materials[i] = std::bit_cast<Material>(numbers);
    }
}

std::vector<Material> materialsAt(const Mesh& mesh, const Program& program) {
    const Tape field =
        makeTape(program.ir, std::span(program.surface).subspan(roughnessComponent), program.parameters());
    std::vector<Material> materials(mesh.triangleCount());
    forBlocks(materials.size(), 32 * kBatch, [&](std::size_t, std::size_t first, std::size_t last) {
        Machine machine;
        for (std::size_t at = first; at < last; at += kBatch) {
            const std::size_t end = std::min(at + kBatch, last);
            evaluate(machine, tapeAt(machine, field, mesh, at, end), mesh, at,
                     std::span(materials).subspan(at, end - at));
        }
    });
    return materials;
}

}  // namespace

void SolidSize::add(glm::vec3 a, glm::vec3 b, glm::vec3 c) {
    const glm::dvec3 p(a), cross = glm::cross(glm::dvec3(b) - p, glm::dvec3(c) - p);
    volume += glm::dot(p, cross) / 6.0;
    area += glm::length(cross) / 2.0;
}

float SolidSize::meanChord() const {
    return volume > 0.0 && area > 0.0 ? static_cast<float>(4.0 * volume / area) : 0.0f;
}

SolidSize sizeOf(const Mesh& mesh) {
    SolidSize size;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const uint32_t* corner = &mesh.indices[i];
        size.add(mesh.positions[corner[0]], mesh.positions[corner[1]], mesh.positions[corner[2]]);
    }
    return size;
}

bool transmits(const Mesh& mesh) {
    if (mesh.parts.empty()) return mesh.material.transmission > 0.0f;
    return std::ranges::any_of(mesh.parts,
                               [](const MeshPart& part) { return part.material.transmission > 0.0f; });
}

bool hasManyMaterials(const Program& program) {
    const auto roots = std::span(program.surface).subspan(roughnessComponent);
    return !std::ranges::all_of(roots, [&](IrId id) { return program.ir.isConstant(id); });
}

void partByMaterial(Mesh& mesh, std::vector<Material> ofTriangles) {
    for (Material& material : ofTriangles) material = limited(material);
    const float chord = sizeOf(mesh).meanChord();
    std::optional<Groups> found;
    for (int levels = 256; !found; levels /= 2) found = groupsOf(ofTriangles, chord, float(levels));
    const auto& [groups, count] = *found;

    std::vector<std::array<double, kNumbers>> sums(count);
    std::vector<std::size_t> ends(count + 1);  // of the triangles of each group; first, of those before it
    for (std::size_t t = 0; t < ofTriangles.size(); ++t) {
        const auto numbers = std::bit_cast<Numbers>(ofTriangles[t]);
        for (std::size_t k = 0; k < kNumbers; ++k) sums[groups[t]][k] += numbers[k];
        ++ends[groups[t] + 1];
    }
    mesh.parts.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        Numbers mean;
        for (std::size_t k = 0; k < kNumbers; ++k)
            mean[k] = static_cast<float>(sums[i][k] / double(ends[i + 1]));
        mesh.parts[i] = {std::bit_cast<Material>(mean), ends[i + 1]};
    }
    if (count == 1) {
        mesh.material = mesh.parts[0].material;
        mesh.parts.clear();
        return;
    }
    std::partial_sum(ends.begin(), ends.end(), ends.begin());
    std::vector<uint32_t> indices(mesh.indices.size());
    for (std::size_t t = 0; t < ofTriangles.size(); ++t)
        std::copy_n(&mesh.indices[3 * t], 3, &indices[3 * ends[groups[t]]++]);
    mesh.indices = std::move(indices);
}

void partByMaterial(Mesh& mesh, const Program& program) { partByMaterial(mesh, materialsAt(mesh, program)); }

}  // namespace fw
