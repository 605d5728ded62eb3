// Meshes as fields on the device: distances and signs against the exact ones, samples against the reference,
// solids that come back out, and what is kept on the disk.
#include "graph/assets/mesh_field.h"

#include <gtest/gtest.h>

#include <bit>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <optional>
#include <random>

#include "graph/base/algorithm_version.h"
#include "graph/base/parallel.h"
#include "graph/document/json.h"
#include "runtime/bake/mesh_field_baker.h"
#include "runtime/measure/mesh_report.h"
#include "runtime/play/player.h"
#include "runtime/system/cache_file.h"
#include "tests/support/device_field.h"
#include "tests/support/gpu.h"
#include "tests/support/graph/temp_dir.h"
#include "tests/support/graph/triangle_meshes.h"
#include "tests/support/graph/volume_intervals.h"

namespace fw::mesh_field_test {

using namespace test;

const char* const kCorpus = std::getenv("FIELDWRIGHT_CORPUS");

/// Of all tests, with its kernels.
std::optional<MeshFieldBaker> keptBaker;
class MeshFieldDevice : public testing::Test {
  public:
    static void TearDownTestSuite() { keptBaker.reset(); }
};
MeshFieldBaker baker() {
    if (!keptBaker) keptBaker = meshFieldBaker([] { return &device(); }, {.cached = false});
    return *keptBaker;
}
FieldVolumePtr bake(const MeshFieldRecipe& recipe) {
    const Result<FieldVolumePtr> volume = baker()(recipe);
    EXPECT_TRUE(volume) << (volume ? "" : volume.error().message);
    return *volume;
}

TriangleMeshPtr corpusMesh(const std::string& name) {
    const std::string owner = std::string(kCorpus) + "/meshes/graph.field.json";
    const Result<TriangleMeshPtr> mesh = readTriangleMesh(owner, name);
    EXPECT_TRUE(mesh) << (mesh ? "" : mesh.error().message);
    return *mesh;
}

/// The worst of a volume against the exact distances, in cells.
struct Worst {
    double band = 0.0;      ///< within two cells of the surface
    double beyond = 0.0;    ///< in units of what is allowed: half a cell, or 2 % where that is more
    std::size_t signs = 0;  ///< that are wrong, farther than 0.1 cells from the surface
};
Worst worstOf(const FieldVolume& volume, const TriangleMesh& mesh) {
    const TriangleTree tree(mesh.positions, mesh.indices);
    const VolumeGrid& grid = volume.grid;
    std::vector<Worst> slices(static_cast<std::size_t>(grid.size.z));
    forBlocks(slices.size(), 1, [&](std::size_t z, std::size_t, std::size_t) {
        Worst& worst = slices[z];
        uint32_t guess = 0;
        while (mesh.indices[3 * std::size_t(guess)] == mesh.indices[3 * std::size_t(guess) + 1]) ++guess;
        for (int y = 0; y < grid.size.y; ++y)
            for (int x = 0; x < grid.size.x; ++x) {
                const glm::dvec3 p = grid.place({x, y, int(z)});
                NearestPoint on;
                guess = tree.nearest(p, guess, on);
                const double exact = std::sqrt(on.squared) / grid.cell;
                const double found =
                    std::bit_cast<float>(volume.words[2 * grid.index(x, y, int(z))]) / grid.cell;
                const double error = std::abs(std::abs(found) - exact);
                if (exact <= 2.0) worst.band = std::max(worst.band, error);
                worst.beyond = std::max(worst.beyond, error / std::max(0.5, 0.02 * exact));
                if (exact > 0.1) worst.signs += (found < 0.0) != (std::abs(tree.windingNumber(p)) > 0.5);
            }
    });
    Worst all;
    for (const Worst& slice : slices)
        all = {std::max(all.band, slice.band), std::max(all.beyond, slice.beyond), all.signs + slice.signs};
    return all;
}

void expectRight(const std::string& name, const FieldVolume& volume, const TriangleMesh& mesh) {
    const Worst worst = worstOf(volume, mesh);
    std::printf("%-32s %3dx%3dx%3d  band %.4f cells, beyond %.3f of what is allowed, %zu signs\n",
                name.c_str(), volume.grid.size.x, volume.grid.size.y, volume.grid.size.z, worst.band,
                worst.beyond, worst.signs);
    EXPECT_LE(worst.band, 0.02) << name;
    EXPECT_LE(worst.beyond, 1.0) << name;
    EXPECT_EQ(worst.signs, 0u) << name;
    std::mt19937 random(9);
    expectIntervalsContain(volume, 2'000, 0.2, random);
}

TEST_F(MeshFieldDevice, DistancesAreExactInTheBandAndNearlyBeyond) {
    TriangleMesh stretched = torusFile(40, 30);
    for (glm::vec3& p : stretched.positions) p *= glm::vec3(3.0f, 1.0f, 0.4f);
    TriangleMesh sliver = cubeFile();
    for (glm::vec3& p : sliver.positions) p = glm::vec3(p.x + 0.9f * p.y, 0.1f * p.y - 0.3f * p.z, p.z);
    const std::pair<const char*, TriangleMesh> meshes[] = {{"cube", cubeFile()},
                                                           {"torus", torusFile(60, 30)},
                                                           {"far", movedFile(torusFile(60, 30), {900, 0, 0})},
                                                           {"stretched", stretched},
                                                           {"sheared", sliver},
                                                           {"dense", torusFile(400, 200)}};
    for (const auto& [name, mesh] : meshes)
        for (const int resolution : {9, 33, 80})
            expectRight(name, *bake({.mesh = shared(mesh), .resolution = resolution}), mesh);
}

TEST_F(MeshFieldDevice, OutsideOfPartsThatOverlapDistancesAreExactInTheBand) {
    const TriangleMesh mesh = joinedFile(torusFile(120, 60), movedFile(torusFile(120, 60), {0.8f, 0.1f, 0}));
    const TriangleTree tree(mesh.positions, mesh.indices);
    for (const int resolution : {33, 80}) {
        const FieldVolumePtr volume = bake({.mesh = shared(mesh), .resolution = resolution});
        const VolumeGrid& grid = volume->grid;
        double worst = 0.0;
        std::size_t seen = 0;
        for (std::size_t i = 0; i < grid.samples(); ++i) {
            const int x = int(i) % grid.size.x, rest = int(i) / grid.size.x;
            const glm::dvec3 p = grid.place({x, rest % grid.size.y, rest / grid.size.y});
            NearestPoint on;
            tree.nearest(p, 0, on);
            const double exact = std::sqrt(on.squared) / grid.cell;
            if (exact > 2.0 || exact < 0.1 || tree.windingNumber(p) > 0.5) continue;
            worst = std::max(worst, std::abs(std::bit_cast<float>(volume->words[2 * i]) / grid.cell - exact));
            ++seen;
        }
        EXPECT_GT(seen, grid.samples() / 50);
        EXPECT_LE(worst, 0.02) << resolution;
    }
}

TEST_F(MeshFieldDevice, DistancesToRealMeshes) {
    if (!kCorpus) GTEST_SKIP() << "FIELDWRIGHT_CORPUS names no folder of meshes";
    for (const char* name :
         {"closed/spot_low_resolution.obj", "closed/fish.obj", "closed/scorpion_low_resolution.obj",
          "closed/koala.obj", "closed/wingnut.obj", "closed/plane.obj", "closed/hammer.obj",
          "closed/cube.obj", "closed/sphere.obj", "closed/1002_tray_bottom.STL", "closed/fixed_top.ply",
          "closed/7_8ths_cube.stl", "closed/mengerSponge3.glb", "closed/Cray_left.obj"}) {
        const TriangleMeshPtr mesh = corpusMesh(name);
        for (const int resolution : {64, 128})
            expectRight(name, *bake({.mesh = mesh, .resolution = resolution}), *mesh);
    }
}

TEST_F(MeshFieldDevice, TheHostAgrees) {
    TriangleMesh turned = torusFile(60, 30);
    for (std::size_t t = 0; t < turned.indices.size(); t += 21)
        std::swap(turned.indices[t], turned.indices[t + 1]);
    TriangleMesh open = torusFile(40, 20);
    open.indices.resize(open.indices.size() - 60);
    for (const TriangleMesh& mesh :
         {turned, open, joinedFile(cubeFile(), movedFile(torusFile(30, 20), {0.9f, 0.7f, 0.3f})),
          unsharedFile(cubeFile())}) {
        const MeshFieldRecipe recipe{.mesh = shared(mesh), .resolution = 40};
        const FieldVolumePtr here = *bakeOnHost(recipe), there = bake(recipe);
        ASSERT_EQ(here->grid.size, there->grid.size);
        EXPECT_EQ(here->notes, there->notes);
        std::size_t signs = 0;
        double worst = 0.0;
        for (std::size_t i = 0; i < here->grid.samples(); ++i) {
            const double a = std::bit_cast<float>(here->words[2 * i]) / here->grid.cell;
            const double b = std::bit_cast<float>(there->words[2 * i]) / here->grid.cell;
            signs += (a < 0.0) != (b < 0.0) && std::abs(a) > 0.01;
            worst = std::max(worst, std::abs(a - b));
        }
        EXPECT_EQ(signs, 0u);
        EXPECT_LT(worst, 0.6);
    }
}

TEST_F(MeshFieldDevice, TheSameBytesEachTime) {
    const MeshFieldRecipe recipe{.mesh = shared(torusFile(300, 100)), .resolution = 48};
    const FieldVolumePtr first = bake(recipe);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(bake(recipe)->words, first->words);
}

TEST_F(MeshFieldDevice, ColorsComeFromTheNearestTriangle) {
    TriangleMesh mesh = cubeFile();
    for (const glm::vec3& p : mesh.positions)
        mesh.colors.push_back(glm::vec3(0.5f + 0.5f * p.x, 0.25f, 0.5f - 0.4f * p.z));
    const FieldVolumePtr volume = bake({.mesh = shared(mesh), .resolution = 32}),
                         host = *bakeOnHost({.mesh = shared(mesh), .resolution = 32});
    ASSERT_TRUE(volume->colored());
    for (const glm::dvec3 p :
         {glm::dvec3(0.5, 1.0, 0.25), glm::dvec3(1.05, 0.2, -0.7), glm::dvec3(-0.3, -0.4, 1.0)})
        for (const FieldVolume* each : {volume.get(), host.get()}) {
            const glm::dvec3 wanted(0.5 + 0.5 * std::clamp(p.x, -1.0, 1.0), 0.25,
                                    0.5 - 0.4 * std::clamp(p.z, -1.0, 1.0));
            for (int k = 0; k < 3; ++k)
                EXPECT_NEAR(sampleVolume(each->layers[std::size_t(redChannel + k)], p).value, wanted[k],
                            0.03);
        }
}

/// A folder with a mesh, and a graph about it.
struct Folder {
    TempDir dir;
    explicit Folder(const TriangleMesh& mesh, const std::string& more = "") {
        write(mesh);
        writeText(
            dir.path("g.field.json"),
            R"({"fieldwright": 1, "nodes": [{"id": "file", "type": "mesh_file", "inputs": {"path": "m.ply"}},
                      {"id": "it", "type": "mesh_to_field", "inputs": {"mesh": {"from": "file"}, "resolution": 48)" +
                more +
                R"(}}, {"id": "out", "type": "output", "inputs": {"surface": {"from": "it"}, "resolution": 64}}]})");
    }
    void write(const TriangleMesh& mesh) const {
        std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(mesh.positions.size()) +
                           "\nproperty float x\nproperty float y\nproperty float z\n";
        if (!mesh.colors.empty()) text += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
        text += "element face " + std::to_string(mesh.indices.size() / 3) +
                "\nproperty list uchar int vertex_indices\nend_header\n";
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            const glm::vec3& p = mesh.positions[i];
            text += std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z);
            if (!mesh.colors.empty())
                for (int k = 0; k < 3; ++k) text += " " + std::to_string(int(255 * mesh.colors[i][k]));
            text += "\n";
        }
        for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
            text += "3 " + std::to_string(mesh.indices[i]) + " " + std::to_string(mesh.indices[i + 1]) + " " +
                    std::to_string(mesh.indices[i + 2]) + "\n";
        writeText(dir.path("m.ply"), text);
    }
    Program program() const {
        const Result<Graph> graph = readGraph(dir.path("g.field.json"), nullptr);
        EXPECT_TRUE(graph) << format(graph.error());
        CompileOptions options;
        options.bake = baker();
        const Result<Program> made = compile(*graph, options);
        EXPECT_TRUE(made) << format(made.error());
        return *made;
    }
};

TEST_F(MeshFieldDevice, SamplesEqualTheReference) {
    TriangleMesh colored = torusFile(40, 20);
    for (const glm::vec3& p : colored.positions)
        colored.colors.push_back(glm::vec3(0.5f + 0.3f * p.x, 0.4f, 0.5f));
    for (const std::string more : {"", R"(, "sampling": "trilinear")"}) {
        const Program program = Folder(colored, more).program();
        std::mt19937 random(3);
        std::uniform_real_distribution<float> unit(-1.0f, 1.0f);
        std::vector<std::array<float, 3>> points(20'000);
        for (auto& p : points)
            for (float& c : p) c = 2.5f * unit(random) * std::abs(unit(random));
        const float halfSize = 0.01f;
        const auto samples = evaluateOnDevice(program, points, halfSize);
        int oblique = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Point p{points[i][0], points[i][1], points[i][2]};
            ValueGradient wanted;
            evaluateGradient(program.ir, program.distance(), {}, std::span(&p, 1), std::span(&wanted, 1));
            ASSERT_NEAR(samples[i].value, wanted.value, 2e-5);
            ASSERT_NEAR(samples[i].rowValue, wanted.value, 2e-5);
            ASSERT_LE(samples[i].interval[0], wanted.value + 1e-6);
            ASSERT_GE(samples[i].interval[1], wanted.value - 1e-6);
            ASSERT_LT(samples[i].interval[1] - samples[i].interval[0], 0.15);
            for (std::size_t axis = 0; axis < 3; ++axis)
                oblique += std::abs(samples[i].gradient[axis] - wanted.gradient[axis]) > 1e-3;
            for (std::size_t k = 0; k < 3; ++k)
                ASSERT_NEAR(samples[i].baseColor[k], evaluate(program.ir, program.surface[1 + k], {}, p),
                            1e-4);
        }
        EXPECT_LT(oblique, more.empty() ? 1 : 100);  // a trilinear gradient jumps at the cells' faces
    }
}

Program programOf(const FieldVolumePtr& volume) {
    Program program;
    const uint32_t number = program.ir.addVolume(volume);
    program.surface.fill(program.ir.constant(0.0));
    program.surface[distanceComponent] = program.ir.sample(number, tricubicChannel, {0, 1, 2});
    for (std::size_t i = 0; i < kDefaultMaterial.size(); ++i)
        program.surface[i + 1] = program.ir.constant(kDefaultMaterial[i]);
    program.opaque = program.surface;
    program.structureHash = program.ir.hash(program.surface);
    return program;
}

struct Back {
    Mesh mesh;
    Report report;
};
/// All of the volume, meshed; solids may be larger than regions are looked for.
Back meshOf(const FieldVolumePtr& volume, int resolution) {
    const VolumeGrid& grid = volume->grid;
    const glm::dvec3 hi = grid.place(grid.size - 1);
    const Box region{{grid.origin.x, grid.origin.y, grid.origin.z}, {hi.x, hi.y, hi.z}};
    Session session(std::move(*createDevice({})));
    session.setProgram(programOf(volume));
    const Result<MesherResult> result = session.polygonise({.region = region, .resolution = resolution});
    EXPECT_TRUE(result) << (result ? "" : result.error().message);
    Back back{session.download(*result), {}};
    back.report = reportOnMesh(back.mesh.positions, back.mesh.indices);
    return back;
}
TEST_F(MeshFieldDevice, ASolidComesBackOut) {
    const TriangleMesh mesh = torusFile(120, 60);
    const SolidMesh solid = solidMesh(mesh);
    const Back back = meshOf(bake({.mesh = shared(mesh), .resolution = 64}), 64);
    EXPECT_EQ(back.report.boundaryEdges, 0u);
    EXPECT_EQ(back.report.nonManifoldEdges, 0u);
    EXPECT_EQ(back.report.shells, 1u);
    EXPECT_EQ(back.report.eulerCharacteristic, 0);
    EXPECT_NEAR(back.report.volume, solid.volume, 0.01 * solid.volume);
}

TEST_F(MeshFieldDevice, RealSolidsComeBackOut) {
    if (!kCorpus) GTEST_SKIP() << "FIELDWRIGHT_CORPUS names no folder of meshes";
    const struct {
        const char* name;
        long parts, euler;
        bool thin = false;
    } solids[] = {{"closed/spot_low_resolution.obj", 1, 2},
                  {"closed/koala.obj", 1, 2},
                  {"closed/wingnut.obj", 1, 2},
                  {"closed/hammer.obj", 1, 2, true},
                  {"closed/cube.obj", 1, 2},
                  {"closed/sphere.obj", 1, 2},
                  {"closed/7_8ths_cube.stl", 1, 2},
                  {"closed/Cray_left.obj", 2, 4, true},
                  {"closed/fish.obj", 1, 2, true},
                  {"closed/scorpion_low_resolution.obj", 1, 2, true},
                  {"closed/plane.obj", 1, 2, true},
                  {"closed/1002_tray_bottom.STL", 1, -44, true},
                  {"closed/fixed_top.ply", 1, -12, true},
                  {"closed/mengerSponge3.glb", 1, -2816, true}};
    for (const auto& [name, parts, euler, thin] : solids) {
        const TriangleMeshPtr mesh = corpusMesh(name);
        const FieldVolumePtr volume = bake({.mesh = mesh, .resolution = 64});
        const double exact = solidMesh(*mesh).volume;
        const Back back = meshOf(volume, 64);
        const double off = back.report.volume / exact - 1.0;
        std::printf("%-34s volume %+.2f %%, %llu parts of %ld, euler %lld of %ld%s\n", name, 100.0 * off,
                    static_cast<unsigned long long>(back.report.shells), parts,
                    static_cast<long long>(back.report.eulerCharacteristic), euler,
                    volume->notes.empty() ? "" : (": " + volume->notes.front()).c_str());
        EXPECT_EQ(back.report.boundaryEdges, 0u) << name;
        EXPECT_EQ(back.report.nonManifoldEdges, 0u) << name;
        if (thin) continue;  // of parts below three cells
        EXPECT_LT(std::abs(off), 0.01) << name;
        EXPECT_EQ(long(back.report.shells), parts) << name;
        EXPECT_EQ(long(back.report.eulerCharacteristic), euler) << name;
    }
}

TEST_F(MeshFieldDevice, BrokenMeshesAreMadeSolidsOrRefused) {
    if (!kCorpus) GTEST_SKIP() << "FIELDWRIGHT_CORPUS names no folder of meshes";
    std::vector<std::string> names;
    for (const char* folder : {"broken", "open", "derived"})
        for (const auto& entry :
             std::filesystem::directory_iterator(std::string(kCorpus) + "/meshes/" + folder))
            names.push_back(std::string(folder) + "/" + entry.path().filename().string());
    std::ranges::sort(names);
    for (const std::string& name : names) {
        const auto start = std::chrono::steady_clock::now();
        const std::string owner = std::string(kCorpus) + "/meshes/graph.field.json";
        const Result<TriangleMeshPtr> mesh = readTriangleMesh(owner, name);
        if (!mesh) continue;
        const Result<FieldVolumePtr> volume = baker()({.mesh = *mesh, .resolution = 64});
        const double seconds =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        std::printf("%-34s %.2f s: %s\n", name.c_str(), seconds,
                    !volume                    ? volume.error().message.c_str()
                    : (*volume)->notes.empty() ? "clean"
                                               : (*volume)->notes.front().c_str());
        if (!volume) continue;
        for (std::size_t i = 0; i < (*volume)->grid.samples(); ++i)
            ASSERT_TRUE(std::isfinite(std::bit_cast<float>((*volume)->words[2 * i]))) << name;
        const Back back = meshOf(*volume, 64);
        EXPECT_EQ(back.report.boundaryEdges, 0u) << name;
        EXPECT_EQ(back.report.nonManifoldEdges, 0u) << name;
    }
}

TEST_F(MeshFieldDevice, WhatWasMadeIsReadFromTheDisk) {
    const TemporaryCache cache;
    int asked = 0;
    const MeshFieldBaker kept = meshFieldBaker([&]() -> const Device* { return ++asked, &device(); });
    TriangleMesh colored = torusFile(30, 20);
    colored.colors.assign(colored.positions.size(), glm::vec3(0.5f));
    colored.indices.resize(colored.indices.size() - 3);
    const MeshFieldRecipe recipe{.mesh = shared(colored), .resolution = 21};
    const FieldVolumePtr first = *kept(recipe), second = *kept(recipe);
    EXPECT_EQ(asked, 1);
    EXPECT_EQ(first->words, second->words);
    EXPECT_EQ(first->hash, second->hash);
    EXPECT_EQ(first->notes, second->notes);
    ASSERT_FALSE(second->notes.empty());
    EXPECT_EQ(second->notes.front().find("has "), 0u) << "another file with this mesh may come for it";
    EXPECT_TRUE(second->colored());
    // Damaged: made again.
    const std::filesystem::path folder = std::filesystem::path(cache.folder) / "fieldwright" / "fields";
    ASSERT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
    const std::string file = std::filesystem::directory_iterator(folder)->path().string();
    std::string bytes = readText(file);
    bytes[bytes.size() / 2] ^= 1;
    writeText(file, bytes);
    EXPECT_EQ((*kept(recipe))->words, first->words);
    EXPECT_EQ(asked, 2);
    writeText(file, "short");
    EXPECT_EQ((*kept(recipe))->words, first->words);
    EXPECT_EQ(asked, 3);
    EXPECT_EQ((*kept(recipe))->words, first->words);
    EXPECT_EQ(asked, 3);
    // A mesh that another version of the algorithms baked. The key follows 8 bytes of the header.
    bytes = readText(file);
    uint64_t key = 0;
    std::memcpy(&key, &bytes[8], sizeof key);
    std::vector<uint32_t> words = readCacheFile(file, key);
    ASSERT_FALSE(words.empty());
    ASSERT_EQ(words[0], kAlgorithmVersion);
    ++words[0];
    writeCacheFile(file, key, words);
    EXPECT_EQ((*kept(recipe))->words, first->words);
    EXPECT_EQ(asked, 4);
}

TEST_F(MeshFieldDevice, APlayerWatchesTheFileAndBakesOnce) {
    const TemporaryCache cache;
    const Folder folder(torusFile(40, 20));
    Result<Player> player = Player::open(folder.dir.path("g.field.json"));
    ASSERT_TRUE(player) << format(player.error());
    const std::vector<std::string> files = player->files();
    ASSERT_EQ(files.size(), 2u);
    EXPECT_EQ(std::filesystem::path(files[1]).filename(), "m.ply");
    const Result<Mesh> before = player->mesh();
    ASSERT_TRUE(before);
    folder.write(cubeFile());
    const Result<Graph> graph = readGraph(folder.dir.path("g.field.json"), nullptr);
    ASSERT_TRUE(player->reload(*graph));
    const Result<Mesh> after = player->mesh();
    ASSERT_TRUE(after);
    EXPECT_NEAR(reportOnMesh(after->positions, after->indices).volume, 8.0, 0.1);
}

}  // namespace fw::mesh_field_test
