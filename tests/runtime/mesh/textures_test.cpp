// Textures: how a mesh is laid flat, held against counts of our own; and what is baked, against the field.
#include "runtime/textures/textured.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <stb/stb_image.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <random>

#include "graph/assets/image.h"
#include "graph/document/json.h"
#include "graph/evaluate/evaluate.h"
#include "runtime/export/export.h"
#include "runtime/mesh/field_values.h"
#include "runtime/play/session.h"
#include "runtime/textures/dilate.h"
#include "runtime/textures/pack.h"
#include "runtime/textures/tangents.h"
#include "runtime/textures/unwrap.h"
#include "tests/support/command.h"
#include "tests/support/gltf_validator.h"
#include "tests/support/gpu.h"
#include "tests/support/graph/temp_dir.h"
#include "tests/support/meshes.h"

namespace fw::textures_test {

using test::TempDir;

bool isLong() { return std::getenv("FIELDWRIGHT_LONG") != nullptr; }

Program programOf(const std::string& nodes) {
    const Result<Graph> graph =
        parseGraph(R"({"fieldwright": 1, "nodes": [)" + nodes + "]}", "t.field.json", nullptr);
    if (!graph) throw SystemError(format(graph.error()));
    Result<Program> program = compile(*graph);
    if (!program) throw SystemError(format(program.error()));
    return std::move(*program);
}

struct Solid {
    Program program;
    Mesh mesh;
};

Solid solidOf(const std::string& nodes, int resolution) {
    Result<Device> device = createDevice({});
    if (!device) throw SystemError(format(device.error()));
    Session session(std::move(*device));
    session.setProgram(programOf(nodes));
    const Result<MesherResult> result = session.polygonise({std::nullopt, resolution});
    if (!result) throw SystemError(format(result.error()));
    return {session.program(), session.download(*result, MaterialParts::besideTextures)};
}

/// Round bodies that melt together, with colours, finish and light that vary smoothly over them.
const std::string kSmooth = R"nodes(
    {"id": "a", "type": "sphere", "inputs": {"radius": 0.8}},
    {"id": "ring", "type": "torus", "inputs": {"major_radius": 1.1, "minor_radius": 0.3}},
    {"id": "both", "type": "union", "inputs": {"a": {"from": "a"}, "b": {"from": "ring"}, "radius": 0.2}},
    {"id": "color", "type": "expression", "code": "return vec3(0.5) + 0.4 * vec3(sin(2.0 * p.x), cos(3.0 * p.y), sin(p.x + 2.0 * p.z));"},
    {"id": "shine", "type": "expression", "code": "return 0.5 + 0.4 * sin(3.0 * p.z);"},
    {"id": "glow", "type": "expression", "code": "return vec3(3.0, 1.0, 0.0) * max(p.y, 0.0);"},
    {"id": "paint", "type": "material", "inputs": {"surface": {"from": "both"}, "base_color": {"from": "color"},
     "roughness": {"from": "shine"}, "metallic": 0.25, "emission": {"from": "glow"}}},
    {"id": "out", "type": "output", "inputs": {"surface": {"from": "paint"}}})nodes";

const std::string kEdged = R"nodes(
    {"id": "box", "type": "box", "inputs": {"half_extents": [0.7, 0.5, 0.6]}},
    {"id": "hole", "type": "cylinder", "inputs": {"radius": 0.3, "half_height": 2}},
    {"id": "cut", "type": "subtract", "inputs": {"a": {"from": "box"}, "b": {"from": "hole"}}},
    {"id": "turned", "type": "rotate", "inputs": {"surface": {"from": "cut"}, "angles": [0, 45, 0]}},
    {"id": "out", "type": "output", "inputs": {"surface": {"from": "turned"}}})nodes";

/// A ramp that winds twice around an axis, over itself.
Mesh ramp() {
    Mesh mesh;
    constexpr int kSteps = 160;
    for (int i = 0; i <= kSteps; ++i)
        for (const float radius : {0.5f, 1.5f}) {
            const float turn = float(i) / kSteps * 4.0f * 3.14159265f;
            mesh.positions.push_back({radius * std::sin(turn), 0.1f * turn, radius * std::cos(turn)});
            mesh.normals.push_back({0, 1, 0});
        }
    for (uint32_t i = 0; i < kSteps; ++i) {
        const uint32_t a = 2 * i;
        mesh.indices.insert(mesh.indices.end(), {a, a + 1, a + 2, a + 2, a + 1, a + 3});
    }
    return mesh;
}

/// Seen with v running up.
double areaOnTexture(const Mesh& mesh, std::size_t triangle) {
    const uint32_t* corner = &mesh.indices[3 * triangle];
    const glm::dvec2 a = mesh.uvs[corner[0]], b = glm::dvec2(mesh.uvs[corner[1]]) - a,
                     c = glm::dvec2(mesh.uvs[corner[2]]) - a;
    return -0.5 * (b.x * c.y - b.y * c.x);
}

double areaInSpace(const Mesh& mesh, std::size_t triangle) {
    const uint32_t* corner = &mesh.indices[3 * triangle];
    const glm::dvec3 a = mesh.positions[corner[0]];
    return 0.5 * glm::length(glm::cross(glm::dvec3(mesh.positions[corner[1]]) - a,
                                        glm::dvec3(mesh.positions[corner[2]]) - a));
}

/// Middles of a raster's texels that lie in more than one triangle.
std::size_t overlaps(const Mesh& mesh, int size) {
    std::vector<uint8_t> count(std::size_t(size) * std::size_t(size), 0);
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
        glm::dvec2 p[3];
        for (std::size_t k = 0; k < 3; ++k)
            p[k] = glm::dvec2(mesh.uvs[mesh.indices[3 * t + k]]) * double(size);
        const glm::dvec2 low = glm::min(glm::min(p[0], p[1]), p[2]),
                         high = glm::max(glm::max(p[0], p[1]), p[2]);
        for (int y = std::max(0, int(low.y)); y <= std::min(size - 1, int(high.y)); ++y)
            for (int x = std::max(0, int(low.x)); x <= std::min(size - 1, int(high.x)); ++x) {
                const glm::dvec2 m(x + 0.5, y + 0.5);
                int left = 0, right = 0;
                for (int k = 0; k < 3; ++k) {
                    const glm::dvec2 edge = p[(k + 1) % 3] - p[k], to = m - p[k];
                    const double side = edge.x * to.y - edge.y * to.x;
                    left += side > 1e-3, right += side < -1e-3;
                }
                if (left == 3 || right == 3) ++count[std::size_t(y) * std::size_t(size) + std::size_t(x)];
            }
    }
    return std::size_t(std::ranges::count_if(count, [](uint8_t n) { return n > 1; }));
}

void expectFlat(const Mesh& mesh, int size, const char* name) {
    const Result<Unwrapping> made = unwrap(mesh, size);
    ASSERT_TRUE(made) << format(made.error());
    ASSERT_EQ(made->mesh.triangleCount(), mesh.triangleCount());
    for (const glm::vec2 uv : made->mesh.uvs) ASSERT_TRUE(uv.x >= 0 && uv.y >= 0 && uv.x <= 1 && uv.y <= 1);
    for (std::size_t i = 0; i < mesh.indices.size(); ++i)
        ASSERT_EQ(made->mesh.positions[made->mesh.indices[i]], mesh.positions[mesh.indices[i]]);
    EXPECT_EQ(overlaps(made->mesh, 4096), 0u) << name;
    double whole = 0, flat = 0, far = 0;
    std::vector<glm::dvec2> charts(made->charts.count());
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
        const double area = areaInSpace(mesh, t), there = areaOnTexture(made->mesh, t);
        whole += area, flat += there;
        charts[made->charts.ofTriangle[t]] += glm::dvec2(area, there);
    }
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
        const double area = areaInSpace(mesh, t), there = areaOnTexture(made->mesh, t);
        if (area < 1e-5 * whole / double(mesh.triangleCount())) continue;
        ASSERT_GT(there, 0) << name << ": triangle " << t << " of " << area << " m2 is turned over";
        const double density = std::sqrt(there / area * whole / flat);
        far += density < 0.5 || density > 2 ? area : 0;
    }
    // Texels a metre: of charts all the same, of what is oblique in them within a factor of two.
    for (const glm::dvec2 chart : charts) {
        if (chart.x > 1e-6 * whole) { EXPECT_NEAR(std::sqrt(chart.y / chart.x * whole / flat), 1.0, 0.02); }
    }
    EXPECT_LT(far, 1e-3 * whole);
    std::printf("%s: %zu triangles in %zu charts, %.0f %% of %d x %d texels covered, gutter %d\n", name,
                mesh.triangleCount(), made->charts.count(), 100 * made->covered, size, size, made->gutter);
    EXPECT_GT(made->covered, 0.35);
}

TEST(Textures, MeshesAreLaidFlatWithoutOverlap) {
    expectFlat(test::cube(), 256, "cube");
    expectFlat(test::tetrahedron(), 64, "tetrahedron");
    expectFlat(test::torus(120, 60), 1024, "torus");
    expectFlat(test::unshared(test::torus(20, 12)), 512, "loose triangles");
    expectFlat(ramp(), 512, "ramp");
    expectFlat(solidOf(kSmooth, 64).mesh, 2048, "smooth");
    expectFlat(solidOf(kEdged, 48).mesh, 1024, "edged");
}

TEST(Textures, TheRampGoesOverItselfInSeveralCharts) {
    const Result<Unwrapping> made = unwrap(ramp(), 512);
    ASSERT_TRUE(made);
    EXPECT_GE(made->charts.count(), 2u);
    EXPECT_LE(made->charts.count(), 12u);
}

TEST(Textures, TooManyChartsForTheTexelsAreRefused) {
    const Result<Unwrapping> made = unwrap(test::unshared(test::torus(60, 40)), 64);
    ASSERT_FALSE(made);
    EXPECT_NE(made.error().message.find("too many for 64 x 64 texels: ask for larger textures"),
              std::string::npos);
}

TEST(Textures, ChartsKeepTheirDistance) {
    // Squares and discs of many sizes.
    std::vector<FlatChart> charts;
    for (int i = 1; i < 40; ++i) {
        const float side = 0.1f * float(i % 7 + 1), high = 0.05f * float(i);
        charts.push_back({{{0, 0}, {side, 0}, {side, high}, {0, 0}, {side, high}, {0, high}}});
    }
    const std::optional<Packing> packing = pack(charts, 512);
    ASSERT_TRUE(packing);
    EXPECT_GT(packing->covered, 0.75);
    for (std::size_t i = 0; i < charts.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
            const auto bounds = [&](std::size_t k) {
                glm::vec2 low(1e9f), high(-1e9f);
                for (const glm::vec2 p : packing->corners[k])
                    low = glm::min(low, p), high = glm::max(high, p);
                return std::pair(low, high);
            };
            const auto [lowI, highI] = bounds(i);
            const auto [lowJ, highJ] = bounds(j);
            const glm::vec2 gap = glm::max(lowI - highJ, lowJ - highI);
            ASSERT_GE(std::max(gap.x, gap.y), float(packing->gutter) - 1e-3f);
        }
}

/// Bilinear, of three channels.
glm::dvec3 lookUp(const std::vector<uint8_t>& image, int size, glm::dvec2 uv) {
    const glm::dvec2 at = uv * double(size) - 0.5, base = glm::floor(at), part = at - base;
    glm::dvec3 sum(0);
    for (int corner = 0; corner < 4; ++corner) {
        const int x = std::clamp(int(base.x) + corner % 2, 0, size - 1),
                  y = std::clamp(int(base.y) + corner / 2, 0, size - 1);
        const double weight = (corner % 2 ? part.x : 1 - part.x) * (corner / 2 ? part.y : 1 - part.y);
        const std::size_t texel = 3 * (std::size_t(y) * std::size_t(size) + std::size_t(x));
        for (std::size_t k = 0; k < 3; ++k) sum[int(k)] += weight * image[texel + k];
    }
    return sum;
}

/// A place of the mesh, as a shader sees it.
struct Seen {
    glm::dvec3 position, normal;  ///< the second from the normal map
    glm::dvec2 uv;
};

Seen seenAt(const Mesh& mesh, std::size_t triangle, glm::dvec3 shares) {
    const uint32_t* corner = &mesh.indices[3 * triangle];
    glm::dvec3 p(0), n(0), t(0);
    glm::dvec2 uv(0);
    for (int k = 0; k < 3; ++k) {
        p += shares[k] * glm::dvec3(mesh.positions[corner[k]]);
        n += shares[k] * glm::dvec3(mesh.normals[corner[k]]);
        t += shares[k] * glm::dvec3(mesh.tangents[corner[k]]);
        uv += shares[k] * glm::dvec2(mesh.uvs[corner[k]]);
    }
    const glm::dvec3 b = glm::cross(n, t) * double(mesh.tangents[corner[0]].w);
    const glm::dvec3 told = lookUp(mesh.textures->normal, mesh.textures->size, uv) / 127.5 - 1.0;
    return {p, glm::normalize(told.x * t + told.y * b + told.z * n), uv};
}

struct OnSurface {
    glm::dvec3 position, normal;
};

/// By Newton's steps in double.
OnSurface surfaceAt(const Program& program, glm::dvec3 p) {
    const Tape tape = makeTape(program.ir, program.distance(), program.parameters());
    TapeMachine<double> machine;
    glm::dvec3 gradient(0);
    for (int step = 0; step < 8; ++step) {
        for (int axis = 0; axis < 3; ++axis) machine.position(axis)[0] = p[axis];
        const auto [values, gradients] = machine.gradient(tape, 1);
        gradient = {gradients[0][0], gradients[1][0], gradients[2][0]};
        if (step < 7) p -= values[0] * gradient / glm::dot(gradient, gradient);
    }
    return {p, glm::normalize(gradient)};
}

double valueAt(const Program& program, int component, glm::dvec3 p) {
    return evaluate(program.ir, program.surface[std::size_t(component)], program.parameters(),
                    {p.x, p.y, p.z});
}

struct Differences {
    double color = 0, surface = 0, light = 0;  ///< means, of 255
    double degrees = 0;                        ///< 99 of 100 normals are nearer
};

Differences differencesOf(const Program& program, const Mesh& mesh, int samples) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit;
    std::vector<double> areas(mesh.triangleCount());
    for (std::size_t t = 0; t < areas.size(); ++t) areas[t] = areaInSpace(mesh, t);
    std::discrete_distribution<std::size_t> pick(areas.begin(), areas.end());
    Differences sum;
    std::vector<double> degrees;
    const MeshTextures& textures = *mesh.textures;
    for (int i = 0; i < samples; ++i) {
        const double a = std::sqrt(unit(random)), b = unit(random);
        const Seen seen = seenAt(mesh, pick(random), {1 - a, a * (1 - b), a * b});
        const OnSurface there = surfaceAt(program, seen.position);
        const glm::dvec3 color = lookUp(textures.baseColor, textures.size, seen.uv),
                         surface = lookUp(textures.surface, textures.size, seen.uv);
        for (int k = 0; k < 3; ++k)
            sum.color += std::abs(color[k] - 255 * encodeSrgb(valueAt(program, baseColorComponent + k,
                                                                      there.position))) /
                         3 / samples;
        sum.surface += (std::abs(surface.y - 255 * valueAt(program, roughnessComponent, there.position)) +
                        std::abs(surface.z - 255 * valueAt(program, metallicComponent, there.position))) /
                       2 / samples;
        if (!textures.emission.empty()) {
            const glm::dvec3 light = lookUp(textures.emission, textures.size, seen.uv);
            for (int k = 0; k < 3; ++k)
                sum.light += std::abs(light[k] - 255 * encodeSrgb(valueAt(program, emissionComponent + k,
                                                                          there.position) /
                                                                  textures.emissionStrength)) /
                             3 / samples;
        }
        degrees.push_back(glm::degrees(std::acos(std::min(1.0, glm::dot(there.normal, seen.normal)))));
    }
    std::ranges::sort(degrees);
    sum.degrees = degrees[degrees.size() * 99 / 100];
    return sum;
}

// A coarse mesh, with textures, is what the field is.
TEST(Textures, BakedIsWhatTheFieldSays) {
    Solid solid = solidOf(kSmooth, 24);
    const int size = isLong() ? 2048 : 512;
    const Result<Mesh> mesh = textured(solid.mesh, solid.program, size);
    ASSERT_TRUE(mesh) << format(mesh.error());
    EXPECT_TRUE(mesh->colors.empty());
    EXPECT_EQ(mesh->textures->size, size);
    const Differences found = differencesOf(solid.program, *mesh, isLong() ? 20000 : 4000);
    std::printf(
        "%d: colours differ by %.2f, roughness and metallic %.2f, light %.2f of 255, normals %.2f degrees\n",
        size, found.color, found.surface, found.light, found.degrees);
    EXPECT_LT(found.color, 2);
    EXPECT_LT(found.surface, 2);
    EXPECT_LT(found.light, 2);
    EXPECT_LT(found.degrees, 1);
    EXPECT_NEAR(mesh->textures->emissionStrength, 3 * 0.8, 0.05);
}

/// Pairs of edges that lie in one place of space and in two of the texture: ends of both.
std::vector<std::array<uint32_t, 4>> seamsOf(const Mesh& mesh) {
    const auto less = [](const glm::vec3& a, const glm::vec3& b) {
        return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
    };
    const auto order = [&](const auto& a, const auto& b) {
        return less(a.first, b.first) || (!less(b.first, a.first) && less(a.second, b.second));
    };
    std::map<std::pair<glm::vec3, glm::vec3>, std::pair<uint32_t, uint32_t>, decltype(order)> known(order);
    std::vector<std::array<uint32_t, 4>> seams;
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        const uint32_t a = mesh.indices[i], b = mesh.indices[i % 3 == 2 ? i - 2 : i + 1];
        known[{mesh.positions[a], mesh.positions[b]}] = {a, b};
    }
    for (const auto& [place, ends] : known) {
        const auto other = known.find({place.second, place.first});
        if (other == known.end() || !less(place.first, place.second)) continue;
        const auto [b, a] = other->second;
        if (mesh.uvs[a] != mesh.uvs[ends.first] || mesh.uvs[b] != mesh.uvs[ends.second])
            seams.push_back({ends.first, ends.second, a, b});
    }
    return seams;
}

TEST(Textures, SeamsAreNotSeen) {
    Solid solid = solidOf(kSmooth, 48);
    const Result<Mesh> mesh = textured(solid.mesh, solid.program, isLong() ? 2048 : 512);
    ASSERT_TRUE(mesh) << format(mesh.error());
    const auto seams = seamsOf(*mesh);
    ASSERT_GT(seams.size(), 100u);
    const MeshTextures& textures = *mesh->textures;
    std::vector<double> color, open;
    double brighter = 0;
    for (const auto& [a, b, c, d] : seams) {
        const auto middle = [&](uint32_t from, uint32_t to) {
            return 0.5 * (glm::dvec2(mesh->uvs[from]) + glm::dvec2(mesh->uvs[to]));
        };
        const auto at = [&](const std::vector<uint8_t>& image, uint32_t from, uint32_t to) {
            return lookUp(image, textures.size, middle(from, to));
        };
        const glm::dvec3 off = at(textures.baseColor, a, b) - at(textures.baseColor, c, d);
        const OnSurface there =
            surfaceAt(solid.program, 0.5 * (glm::dvec3(mesh->positions[a]) + glm::dvec3(mesh->positions[b])));
        for (int k = 0; k < 3; ++k)
            brighter += (at(textures.baseColor, a, b)[k] -
                         255 * encodeSrgb(valueAt(solid.program, baseColorComponent + k, there.position))) /
                        3 / double(seams.size());
        color.push_back(std::max({std::abs(off.x), std::abs(off.y), std::abs(off.z)}));
        open.push_back(std::abs(at(textures.surface, a, b).x - at(textures.surface, c, d).x));
    }
    std::ranges::sort(color);
    std::ranges::sort(open);
    std::printf(
        "%zu seams: brighter by %.2f, sides differ by %.2f at most, 95 of 100 by %.2f, in occlusion by %.2f "
        "of 255\n",
        seams.size(), brighter, color.back(), color[color.size() * 95 / 100], open[open.size() * 95 / 100]);
    EXPECT_LT(std::abs(brighter), 1);
    EXPECT_LT(color.back(), isLong() ? 2 : 4);
    EXPECT_LT(color[color.size() * 95 / 100], 2);
    EXPECT_LT(open[open.size() * 95 / 100], 4);
}

TEST(Textures, OcclusionIsHowMuchOfTheSkyIsSeen) {
    // A ball alone is open all around; the floor of a deep shaft is not.
    Solid ball = solidOf(
        R"({"id": "s", "type": "sphere"}, {"id": "out", "type": "output", "inputs": {"surface": {"from": "s"}}})",
        32);
    const Result<Mesh> round = textured(ball.mesh, ball.program, 256);
    ASSERT_TRUE(round);
    for (std::size_t i = 0; i < round->textures->surface.size(); i += 3)
        ASSERT_EQ(round->textures->surface[i], 255);
    Solid box = solidOf(R"({"id": "b", "type": "box", "inputs": {"half_extents": [1, 1, 1]}},
        {"id": "h", "type": "box", "inputs": {"half_extents": [0.15, 1, 0.15]}},
        {"id": "up", "type": "translate", "inputs": {"surface": {"from": "h"}, "offset": [0, 0.5, 0]}},
        {"id": "cut", "type": "subtract", "inputs": {"a": {"from": "b"}, "b": {"from": "up"}}},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "cut"}}})",
                        64);
    const Result<Mesh> shaft = textured(box.mesh, box.program, 512);
    ASSERT_TRUE(shaft);
    double floor = 0, top = 0, floors = 0, tops = 0;
    for (std::size_t t = 0; t < shaft->triangleCount(); ++t) {
        const Seen seen = seenAt(*shaft, t, glm::dvec3(1.0 / 3));
        const double open = lookUp(shaft->textures->surface, 512, seen.uv).x / 255;
        const double aside = std::max(std::abs(seen.position.x), std::abs(seen.position.z));
        if (std::abs(seen.position.y + 0.5) < 0.01 && aside < 0.1) floor += open, ++floors;
        if (std::abs(seen.position.y - 1) < 0.01 && aside > 0.4 && aside < 0.9) top += open, ++tops;
    }
    ASSERT_GT(floors * tops, 0);
    EXPECT_LT(floor / floors, 0.25);
    EXPECT_GT(top / tops, 0.98);
}

TEST(Textures, WhatLiesBetweenChartsGoesOnWithThem) {
    constexpr int kSize = 16;
    std::vector<uint8_t> image(3 * kSize * kSize, 9), known(kSize * kSize, 0);
    for (const auto& [texel, value] : {std::pair(5 * kSize + 3, 100), {5 * kSize + 12, 200}}) {
        known[std::size_t(texel)] = 1;
        for (int k = 0; k < 3; ++k) image[std::size_t(3 * texel + k)] = uint8_t(value);
    }
    dilate({&image}, known, kSize, 3);
    const auto at = [&](int x, int y) { return int(image[std::size_t(3 * (y * kSize + x))]); };
    EXPECT_EQ(at(3, 5), 100);
    EXPECT_EQ(at(0, 2), 100);
    EXPECT_EQ(at(6, 8), 100);
    EXPECT_EQ(at(9, 5), 200);
    EXPECT_EQ(at(15, 5), 200);
    EXPECT_EQ(at(0, 15), 150);
}

/// Mikkelsen's own code, from npm.
std::vector<glm::vec4> tangentsByMikktspace(const Mesh& mesh) {
    const std::filesystem::path home = std::filesystem::path(FIELDWRIGHT_BINARY_DIR) / "mikktspace";
    if (!std::filesystem::exists(home / "node_modules" / "mikktspace")) {
        const auto installed = test::runProgram("npm install --silent --no-audit --no-fund --prefix '" +
                                                home.string() + "' mikktspace@1.1.1");
        EXPECT_EQ(installed.status, 0) << "npm could not install mikktspace:\n" << installed.output;
    }
    const TempDir folder;
    std::vector<float> soup;
    const auto add = [&](auto get) {
        for (const uint32_t v : mesh.indices) {
            const auto value = get(v);
            for (int k = 0; k < value.length(); ++k) soup.push_back(value[k]);
        }
    };
    add([&](uint32_t v) { return mesh.positions[v]; });
    add([&](uint32_t v) { return mesh.normals[v]; });
    add([&](uint32_t v) { return glm::vec2(mesh.uvs[v].x, 1 - mesh.uvs[v].y); });
    test::writeText(folder.path("in"),
                    std::string(reinterpret_cast<const char*>(soup.data()), 4 * soup.size()));
    const auto run = test::runProgram("node '" FIELDWRIGHT_SOURCE_DIR "/tests/support/mikktspace.js' '" +
                                      (home / "node_modules").string() + "' '" + folder.path("in") + "' '" +
                                      folder.path("out") + "'");
    EXPECT_EQ(run.status, 0) << run.output;
    const std::string bytes = test::readText(folder.path("out"));
    std::vector<glm::vec4> tangents(bytes.size() / sizeof(glm::vec4));
    std::memcpy(tangents.data(), bytes.data(), tangents.size() * sizeof(glm::vec4));
    return tangents;
}

TEST(Textures, TangentsAreThoseOfMikktspace) {
    for (const std::string* nodes : {&kSmooth, &kEdged}) {
        const Result<Unwrapping> made = unwrap(solidOf(*nodes, 32).mesh, 512);
        ASSERT_TRUE(made);
        const Mesh& mesh = made->mesh;
        const std::vector<glm::vec4> ours = tangentsOf(mesh), theirs = tangentsByMikktspace(mesh);
        ASSERT_EQ(theirs.size(), mesh.indices.size());
        std::size_t off = 0;
        for (std::size_t i = 0; i < theirs.size(); ++i) {
            const glm::vec4 mine = ours[mesh.indices[i]];
            ASSERT_NEAR(glm::length(glm::vec3(mine)), 1, 1e-5);
            off += glm::dot(glm::vec3(mine), glm::vec3(theirs[i])) < 0.9999f || mine.w != theirs[i].w;
        }
        // Of slivers without an area it has its own opinion.
        EXPECT_LT(off, theirs.size() / 500);
        std::printf("%zu of %zu corners have another tangent\n", off, theirs.size());
    }
}

/// A PNG's size, and its bytes.
std::vector<uint8_t> pictureOf(const std::string& path, int channels, int& size) {
    int width = 0, height = 0, has = 0;
    unsigned char* pixels = stbi_load(path.c_str(), &width, &height, &has, channels);
    EXPECT_TRUE(pixels) << path;
    if (!pixels) return {};
    EXPECT_EQ(width, height);
    EXPECT_EQ(has, channels);
    size = width;
    std::vector<uint8_t> bytes(pixels,
                               pixels + std::size_t(width) * std::size_t(height) * std::size_t(channels));
    stbi_image_free(pixels);
    return bytes;
}

TEST(Textures, FilesHoldThemAndTheValidatorHasNothingToSay) {
    const TempDir folder;
    Solid solid = solidOf(kSmooth, 24);
    const Result<Mesh> mesh = textured(solid.mesh, solid.program, 128);
    ASSERT_TRUE(mesh);
    Solid plain = solidOf(kEdged, 24);
    const Result<Mesh> dull = textured(plain.mesh, plain.program, 64);
    ASSERT_TRUE(dull);
    EXPECT_TRUE(dull->textures->emission.empty());
    for (const char* name : {"a.glb", "a.gltf", "a.obj"}) {
        const Result<ExportedFiles> files = exportMesh(*mesh, folder.path(name));
        ASSERT_TRUE(files) << format(files.error());
        uint64_t bytes = 0;
        for (const std::string& file : files->paths) bytes += std::filesystem::file_size(file);
        EXPECT_EQ(bytes, files->bytes);
    }
    ASSERT_TRUE(exportMesh(*dull, folder.path("dull.glb"), {.manifold = true}));
    ASSERT_TRUE(exportMesh(*dull, folder.path("dull.gltf")));
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.bin",
                                                        "a.glb",
                                                        "a.gltf",
                                                        "a.mtl",
                                                        "a.obj",
                                                        "a_gltf_base_color.png",
                                                        "a_gltf_emission.png",
                                                        "a_gltf_normal.png",
                                                        "a_gltf_occlusion_roughness_metallic.png",
                                                        "a_obj_base_color.png",
                                                        "a_obj_emission.png",
                                                        "a_obj_metallic.png",
                                                        "a_obj_normal.png",
                                                        "a_obj_roughness.png",
                                                        "dull.bin",
                                                        "dull.glb",
                                                        "dull.gltf",
                                                        "dull_gltf_base_color.png",
                                                        "dull_gltf_normal.png",
                                                        "dull_gltf_occlusion_roughness_metallic.png"}));
    test::expectValidGltf({folder.path("a.glb"), folder.path("a.gltf"), folder.path("dull.gltf")});
    test::expectValidGltf({folder.path("dull.glb")}, false);
    const MeshTextures& textures = *mesh->textures;
    int size = 0;
    EXPECT_EQ(pictureOf(folder.path("a_gltf_base_color.png"), 3, size), textures.baseColor);
    EXPECT_EQ(size, 128);
    EXPECT_EQ(pictureOf(folder.path("a_obj_normal.png"), 3, size), textures.normal);
    EXPECT_EQ(pictureOf(folder.path("a_gltf_occlusion_roughness_metallic.png"), 3, size), textures.surface);
    const std::vector<uint8_t> rough = pictureOf(folder.path("a_obj_roughness.png"), 1, size);
    for (std::size_t i = 0; i < rough.size(); ++i) ASSERT_EQ(rough[i], textures.surface[3 * i + 1]);
    const std::string library = test::readText(folder.path("a.mtl")),
                      object = test::readText(folder.path("a.obj"));
    for (const char* line :
         {"newmtl paint\n", "map_Kd a_obj_base_color.png\n", "map_Pr a_obj_roughness.png\n",
          "map_Pm a_obj_metallic.png\n", "map_Ke a_obj_emission.png\n", "norm a_obj_normal.png\n"})
        EXPECT_NE(library.find(line), std::string::npos) << line;
    EXPECT_NE(object.find("\nvt "), std::string::npos);
    EXPECT_NE(object.find("\nf 1/1/1 "), std::string::npos);
    const auto gltf = nlohmann::json::parse(test::readText(folder.path("a.gltf")));
    EXPECT_EQ(gltf["materials"][0]["name"], "paint");
    EXPECT_EQ(gltf["images"].size(), 4u);
}

// What a full disk does in the middle of the second picture.
TEST(Textures, AllFilesAppearOrNone) {
    const TempDir folder;
    auto noise = std::make_shared<MeshTextures>();
    noise->size = 1024;
    std::mt19937 random(3);
    for (std::vector<uint8_t>* image : {&noise->baseColor, &noise->surface, &noise->normal})
        for (int i = 0; i < 3 * 1024 * 1024; ++i) image->push_back(uint8_t(random()));
    for (uint8_t& flat : noise->baseColor) flat = 7;
    Result<Unwrapping> made = unwrap(test::torus(20, 12), 64);
    ASSERT_TRUE(made);
    Mesh mesh = made->mesh;
    mesh.tangents = tangentsOf(mesh);
    mesh.textures = noise;
    const std::vector<std::string> old{
        "a.bin", "a.glb", "a.gltf", "a.mtl", "a.obj", "a_gltf_base_color.png", "a_obj_base_color.png"};
    for (const std::string& name : old) test::writeText(folder.path(name), "old " + name);
    rlimit before{};
    ASSERT_EQ(0, ::getrlimit(RLIMIT_FSIZE, &before));
    const auto handler = ::signal(SIGXFSZ, SIG_IGN);
    const rlimit small{2u << 20, before.rlim_max};
    ASSERT_EQ(0, ::setrlimit(RLIMIT_FSIZE, &small));
    for (const char* name : {"a.glb", "a.gltf"}) {
        const Result<ExportedFiles> written = exportMesh(mesh, folder.path(name));
        ASSERT_FALSE(written);
        EXPECT_NE(written.error().message.find("File too large"), std::string::npos)
            << written.error().message;
    }
    ASSERT_EQ(0, ::setrlimit(RLIMIT_FSIZE, &before));
    ::signal(SIGXFSZ, handler);
    std::filesystem::create_directory(folder.path("a_obj_normal.png"));
    ASSERT_FALSE(exportMesh(mesh, folder.path("a.obj")));
    std::filesystem::remove(folder.path("a_obj_normal.png"));
    EXPECT_EQ(folder.names(), old);
    for (const std::string& name : old) EXPECT_EQ(test::readText(folder.path(name)), "old " + name);
}

TEST(Textures, TheCommandRefusesWhatCannotBe) {
    const TempDir folder;
    const std::string graph = FIELDWRIGHT_SOURCE_DIR "/samples/csg_part.field.json";
    const auto refused = [&](const std::string& name, std::vector<std::string> more, int status,
                             const std::vector<std::string>& parts) {
        std::vector<std::string> words{"export", graph, "-o", folder.path(name)};
        words.insert(words.end(), more.begin(), more.end());
        test::expectRefusal(test::runCommand(words), status, parts);
    };
    for (const char* name : {"a.stl", "a.ply", "a.3mf", "a.vdb"})
        refused(name, {"--textures", "256"}, 2, {"textures are in .glb, .gltf and .obj alone"});
    for (const char* size : {"0", "-64", "32", "100", "100000"})
        refused("a.glb", {"--textures", size}, 2,
                {"a texture's side is a power of two from 64 to 8192 texels"});
    refused("a.glb", {"--textures", "many"}, 2, {"--textures"});
    refused("a.glb", {"--textures", "256", "--tiles", "2"}, 2,
            {"--textures is for a mesh that is made as a whole"});
    refused("a", {"--textures", "256", "--from", "0", "--to", "1", "--format", "stl"}, 2,
            {"textures are in .glb, .gltf and .obj alone"});
    test::writeText(folder.path("none.field.json"),
                    R"({"fieldwright": 1, "nodes": [{"id": "s", "type": "sphere", "inputs": {"radius": -1}},
                    {"id": "out", "type": "output", "inputs": {"surface": {"from": "s"}}}]})");
    test::expectRefusal(
        test::runCommand({"export", folder.path("none.field.json"), "-o", folder.path("a.glb"), "--textures",
                          "256", "--region", "-1", "-1", "-1", "1", "1", "1"}),
        1, {"none.field.json"});
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"none.field.json"}));
}

}  // namespace fw::textures_test
