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
#include <set>
#include <span>

#include "runtime/mesh/field_values.h"

namespace fw {
namespace {

/// A material as its numbers, which stand in the order of SurfaceComponent.
constexpr std::size_t kNumbers = painterComponent - roughnessComponent;
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
    std::vector<uint32_t> of;  ///< each triangle
    std::size_t count = 0;
};

/// Nothing if materials of one painter are more than kMostMaterials.
std::optional<Groups> groupsOf(std::span<const PaintedBy> triangles, float chord, float levels) {
    std::map<std::pair<uint32_t, Steps>, uint32_t> known;
    std::map<uint32_t, std::size_t> ofPainter;
    Groups groups;
    groups.of.reserve(triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        if (i > 0 && triangles[i] == triangles[i - 1]) {
            groups.of.push_back(groups.of.back());
            continue;
        }
        const auto [painter, material] = triangles[i];
        const auto [group, isNew] =
            known.try_emplace({painter, stepsOf(material, chord, levels)}, uint32_t(known.size()));
        if (isNew && ++ofPainter[painter] > kMostMaterials) return std::nullopt;
        groups.of.push_back(group->second);
    }
    groups.count = known.size();
    return groups;
}

/// The name, or with a number behind it, so that it differs from all in `taken`, where it is put; also for
/// who takes blanks for underscores, as OBJ has to.
std::string uniqueName(const std::string& name, std::set<std::string>& taken) {
    const auto isNew = [&](std::string candidate) {
        std::ranges::replace_if(
            candidate, [](char c) { return c > 0 && c <= ' '; }, '_');
        return taken.insert(candidate).second;
    };
    std::string unique = name;
    for (int number = 2; !name.empty() && !isNew(unique); ++number)
        unique = name + "_" + std::to_string(number);
    return unique;
}

std::vector<PaintedBy> paintedAt(std::span<const glm::vec3> places, const Program& program) {
    const Tape field =
        makeTape(program.ir, std::span(program.surface).subspan(roughnessComponent), program.parameters());
    const std::vector<float> values = fieldValues(field, places);
    std::vector<PaintedBy> painted(places.size());
    for (std::size_t i = 0; i < painted.size(); ++i) {
        const float* of = &values[i * (kNumbers + 1)];
        Numbers numbers;
        std::copy_n(of, kNumbers, numbers.begin());
        painted[i] = {uint32_t(of[kNumbers]), std::bit_cast<Material>(numbers)};
    }
    return painted;
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

std::vector<glm::vec3> middlesOf(const Mesh& mesh) {
    std::vector<glm::vec3> middles(mesh.triangleCount());
    for (std::size_t t = 0; t < middles.size(); ++t) {
        const uint32_t* corner = &mesh.indices[3 * t];
        middles[t] =
            (mesh.positions[corner[0]] + mesh.positions[corner[1]] + mesh.positions[corner[2]]) / 3.0f;
    }
    return middles;
}

void partByMaterial(Mesh& mesh, std::vector<PaintedBy> triangles, std::span<const std::string> painters) {
    for (PaintedBy& triangle : triangles) triangle.material = limited(triangle.material);
    const float chord = sizeOf(mesh).meanChord();
    std::optional<Groups> found;
    for (int levels = 256; !found; levels /= 2) found = groupsOf(triangles, chord, float(levels));
    const auto& [groups, count] = *found;

    std::vector<std::array<double, kNumbers>> sums(count);
    std::vector<uint32_t> painterOf(count);
    std::vector<std::size_t> ends(count + 1);  // of the triangles of each group; first, of those before it
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        const auto numbers = std::bit_cast<Numbers>(triangles[t].material);
        for (std::size_t k = 0; k < kNumbers; ++k) sums[groups[t]][k] += numbers[k];
        painterOf[groups[t]] = triangles[t].painter;
        ++ends[groups[t] + 1];
    }
    mesh.parts.resize(count);
    std::set<std::string> taken;
    for (std::size_t i = 0; i < count; ++i) {
        Numbers mean;
        for (std::size_t k = 0; k < kNumbers; ++k)
            mean[k] = static_cast<float>(sums[i][k] / double(ends[i + 1]));
        const std::string name = painterOf[i] < painters.size() ? painters[painterOf[i]] : "";
        mesh.parts[i] = {std::bit_cast<Material>(mean), ends[i + 1], uniqueName(name, taken)};
    }
    if (count == 1) {
        mesh.material = mesh.parts[0].material;
        mesh.materialName = mesh.parts[0].name;
        mesh.parts.clear();
        return;
    }
    std::partial_sum(ends.begin(), ends.end(), ends.begin());
    std::vector<uint32_t> indices(mesh.indices.size());
    for (std::size_t t = 0; t < triangles.size(); ++t)
        std::copy_n(&mesh.indices[3 * t], 3, &indices[3 * ends[groups[t]]++]);
    mesh.indices = std::move(indices);
}

void partByMaterial(Mesh& mesh, const Program& program, std::span<const glm::vec3> places,
                    bool besideTextures) {
    std::vector<PaintedBy> triangles = paintedAt(places, program);
    if (besideTextures)
        for (auto& [painter, material] : triangles)
            material.roughness = Material().roughness, material.metallic = 0, material.emission = {};
    partByMaterial(mesh, std::move(triangles), program.painters);
}

std::vector<uint32_t> materialsOfVertices(const Mesh& mesh, const Program& program) {
    if (!hasManyMaterials(program)) return {};
    std::vector<PaintedBy> vertices = paintedAt(mesh.positions, program);
    for (PaintedBy& vertex : vertices) vertex.material = limited(vertex.material);
    std::optional<Groups> groups = groupsOf(vertices, sizeOf(mesh).meanChord(), 256);
    return groups ? std::move(groups->of) : std::vector<uint32_t>();
}

}  // namespace fw
