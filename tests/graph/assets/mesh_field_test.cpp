// Meshes as fields, on the host: distances, what is inside, what is said of it; and the nodes.
#include "graph/assets/mesh_field.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "graph/compile/compile.h"
#include "graph/document/json.h"
#include "graph/evaluate/evaluate.h"
#include "tests/support/graph/temp_dir.h"
#include "tests/support/graph/triangle_meshes.h"

namespace fw::mesh_field_test {

using namespace test;

FieldVolumePtr bake(const MeshFieldRecipe& recipe) {
    const Result<FieldVolumePtr> volume = bakeOnHost(recipe);
    EXPECT_TRUE(volume) << (volume ? "" : volume.error().message);
    return *volume;
}
double at(const FieldVolume& volume, const glm::dvec3& p) {
    return sampleVolume(volume.layers[tricubicChannel], p).value;
}
std::string notesOf(const FieldVolume& volume) {
    std::string all;
    for (const std::string& note : volume.notes) all += note + "\n";
    return all;
}

double box(const glm::dvec3& p) {
    const glm::dvec3 q = glm::abs(p) - 1.0;
    return glm::length(glm::max(q, 0.0)) + std::min(std::max({q.x, q.y, q.z}), 0.0);
}

TEST(MeshField, DistancesToACubeAreExact) {
    const FieldVolumePtr volume = bake({.mesh = shared(cubeFile()), .resolution = 40});
    const VolumeGrid& grid = volume->grid;
    EXPECT_EQ(grid.size, glm::ivec3(40));
    for (int z = 0; z < 40; ++z)
        for (int y = 0; y < 40; ++y)
            for (int x = 0; x < 40; ++x)
                ASSERT_NEAR(std::bit_cast<float>(volume->words[2 * grid.index(x, y, z)]),
                            box(grid.place({x, y, z})), 1e-5);
    EXPECT_TRUE(volume->notes.empty()) << notesOf(*volume);
    // Beyond the grid it is exact where the box around the mesh is nearest, and never more than the distance.
    EXPECT_NEAR(at(*volume, {2.5, 0.3, -0.2}), 1.5, 1e-9);
    EXPECT_NEAR(at(*volume, {2.5, -3.0, -0.2}), std::hypot(1.5, 2.0), 1e-9);
    EXPECT_GT(sampleVolume(volume->layers[tricubicChannel], {2.5, -3.0, -0.2}).gradient.x, 0.5);
}

TEST(MeshField, TheGridHoldsTheMeshAndItsMargin) {
    const FieldVolumePtr volume = bake(
        {.mesh = shared(movedFile(torusFile(24, 12), {5.0f, 0.0f, 0.0f})), .resolution = 50, .margin = 0.7});
    const VolumeGrid& grid = volume->grid;
    EXPECT_EQ(std::max({grid.size.x, grid.size.y, grid.size.z}), 50);
    const glm::dvec3 hi = grid.place(grid.size - 1);
    const glm::dvec3 wanted(1.4 + 0.7, 0.4 + 0.7, 1.4 + 0.7);
    for (int axis = 0; axis < 3; ++axis) {
        const double middle = axis == 0 ? 5.0 : 0.0;
        EXPECT_LE(grid.origin[axis], middle - wanted[axis] - 1.5 * grid.cell);
        EXPECT_GE(hi[axis], middle + wanted[axis] + 1.5 * grid.cell);
        EXPECT_LT(hi[axis] - grid.origin[axis], 2.0 * wanted[axis] + 6.0 * grid.cell);
    }
}

TEST(MeshField, OverlappingPartsAreOneSolid) {
    const TriangleMesh both = joinedFile(cubeFile(), movedFile(cubeFile(), {0.9f, 0.8f, 0.7f}));
    const FieldVolumePtr volume = bake({.mesh = shared(both), .resolution = 48});
    EXPECT_NE(notesOf(*volume).find("overlap"), std::string::npos) << notesOf(*volume);
    const auto wanted = [](const glm::dvec3& p) {
        return std::min(box(p), box(p - glm::dvec3(0.9, 0.8, 0.7)));
    };
    const double cell = volume->grid.cell;
    double deepest = 0.0;
    for (int z = 0; z < volume->grid.size.z; ++z)
        for (int y = 0; y < volume->grid.size.y; ++y)
            for (int x = 0; x < volume->grid.size.x; ++x) {
                const glm::dvec3 p = volume->grid.place({x, y, z});
                const double value = at(*volume, p);
                const double exact = wanted(p);
                ASSERT_TRUE((value < 0.0) == (exact < 0.0) || std::abs(exact) <= 0.1 * cell)
                    << p.x << " " << p.y;
                ASSERT_TRUE(exact <= 0.0 || std::abs(value - exact) < 0.05 * cell)
                    << value << " for " << exact;
                deepest = std::min(deepest, value);
            }
    // No wall is left within: the deepest point is as deep as that of the union.
    EXPECT_LT(deepest, -0.95);
}

TEST(MeshField, AHoleIsClosedAndADoubleWallIsNone) {
    TriangleMesh open = cubeFile();
    open.indices.erase(open.indices.begin(), open.indices.begin() + 6);  // the side z = -1
    const FieldVolumePtr volume = bake({.mesh = shared(open), .resolution = 40});
    EXPECT_NE(notesOf(*volume).find("4 open edges"), std::string::npos) << notesOf(*volume);
    EXPECT_LT(at(*volume, {0.0, 0.0, 0.0}), -0.5);
    EXPECT_LT(at(*volume, {0.0, 0.0, 0.9}), -0.05);
    EXPECT_GT(at(*volume, {0.0, 0.0, -1.1}), 0.05);
    EXPECT_GT(at(*volume, {0.0, 1.1, 0.0}), 0.05);
    // The membrane is near the missing side, and the distance goes down to it without a step.
    double before = -1.0;
    for (double z = 0.0; z > -1.1; z -= 0.02) {
        const double value = at(*volume, {0.03, 0.05, z});
        EXPECT_LT(std::abs(value - before), z == 0.0 ? 1.0 : 0.06) << z;
        before = value;
    }
}

TEST(MeshField, ASheetEnclosesNothingAndHasADistance) {
    TriangleMesh sheet = cubeFile();
    sheet.indices.resize(6);
    const MeshFieldRecipe recipe{.mesh = shared(sheet, "sheet.ply"), .resolution = 24};
    const Result<FieldVolumePtr> refused = bakeOnHost(recipe);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("'sheet.ply' encloses nothing"), std::string::npos);
    MeshFieldRecipe unsigned_ = recipe;
    unsigned_.inside = MeshInside::none;
    const FieldVolumePtr volume = bake(unsigned_);
    EXPECT_NEAR(at(*volume, volume->grid.place({3, 4, 0})), -1.0 - volume->grid.origin.z, 1e-6);
}

TEST(MeshField, ThinAndFarMeshesAreTold) {
    TriangleMesh plate = cubeFile();
    for (glm::vec3& p : plate.positions) p.y *= 0.01f;
    EXPECT_NE(notesOf(*bake({.mesh = shared(plate), .resolution = 32})).find("raise the resolution, now 32"),
              std::string::npos);
    const FieldVolumePtr far =
        bake({.mesh = shared(movedFile(cubeFile(), {1e6f, 0.0f, 0.0f})), .resolution = 32});
    EXPECT_NE(notesOf(*far).find("far from the origin"), std::string::npos) << notesOf(*far);
    EXPECT_LT(at(*far, {1e6, 0.0, 0.0}), -0.9);
}

TEST(MeshField, NonsenseIsRefused) {
    TriangleMesh point = cubeFile();
    for (glm::vec3& p : point.positions) p = glm::vec3(1.0f);
    EXPECT_FALSE(bakeOnHost({.mesh = shared(point)}));
    TriangleMesh huge = movedFile(cubeFile(), {}, 1e37f);
    EXPECT_FALSE(bakeOnHost({.mesh = shared(huge)}));
    // Before anything is measured.
    for (const MeshFieldBaker& baker : {MeshFieldBaker(bakeOnHost), MeshFieldBaker(boxInPlace)}) {
        const Result<FieldVolumePtr> large = baker({.mesh = shared(cubeFile()), .resolution = 512});
        ASSERT_FALSE(large);
        EXPECT_NE(large.error().message.find("lower the resolution"), std::string::npos);
    }
    TriangleMesh collapsed = cubeFile();
    collapsed.indices = {0, 0, 1, 2, 2, 2};
    const Result<FieldVolumePtr> none = bakeOnHost({.mesh = shared(collapsed)});
    ASSERT_FALSE(none);
    EXPECT_NE(none.error().message.find("three different corners"), std::string::npos);
}

TEST(MeshField, WhatWasMadeIsMadeOnce) {
    int made = 0;
    const MeshFieldBaker baker = [&](const MeshFieldRecipe& recipe) { return ++made, bakeOnHost(recipe); };
    const MeshFieldRecipe recipe{.mesh = shared(cubeFile(), "once.obj"), .resolution = 16};
    const Result<FieldVolumePtr> first = meshField(recipe, baker);
    const Result<FieldVolumePtr> second = meshField(recipe, baker);
    ASSERT_TRUE(first && second);
    EXPECT_EQ(*first, *second);
    EXPECT_EQ(made, 1);
    MeshFieldRecipe finer = recipe;
    finer.resolution = 17;
    EXPECT_TRUE(meshField(finer, boxInPlace));
    EXPECT_TRUE(meshField(finer, baker));  // a stand-in is not remembered
    EXPECT_EQ(made, 2);
}

// ---- The nodes

struct Folder {
    TempDir dir;
    Folder() {
        std::string text;
        const TriangleMesh mesh = cubeFile();
        for (const glm::vec3& p : mesh.positions)
            text += "v " + std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z) + "\n";
        for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
            text += "f " + std::to_string(mesh.indices[i] + 1) + " " +
                    std::to_string(mesh.indices[i + 1] + 1) + " " + std::to_string(mesh.indices[i + 2] + 1) +
                    "\n";
        writeText(dir.path("cube.obj"), text);
    }
    Result<Program> compile(const std::string& nodes, const CompileOptions& options = {}) const {
        const Result<Graph> graph =
            parseGraph(R"({"fieldwright": 1, "nodes": [)" + nodes + "]}", dir.path("g.field.json"), nullptr);
        EXPECT_TRUE(graph) << format(graph.error());
        return fw::compile(*graph, options);
    }
    std::string refusal(const std::string& nodes) const {
        const Result<Program> program = compile(nodes);
        return program ? "it was compiled" : format(program.error());
    }
};
const std::string kFile = R"({"id": "file", "type": "mesh_file", "inputs": {"path": "cube.obj"}},)";
const std::string kOut = R"({"id": "out", "type": "output", "inputs": {"surface": {"from": "it"}}})";

TEST(MeshFieldNodes, AMeshIsASolidThatCanBeMovedAndCut) {
    const Folder folder;
    const Result<Program> program = folder.compile(
        kFile +
        R"({"id": "f", "type": "mesh_to_field", "inputs": {"mesh": {"from": "file"}, "resolution": 24}},
        {"id": "m", "type": "translate", "inputs": {"surface": {"from": "f"}, "offset": [3, 0, 0]}},
        {"id": "s", "type": "sphere", "inputs": {"p": [3, 0, 0], "radius": 0.5}},
        {"id": "it", "type": "subtract", "inputs": {"a": {"from": "m"}, "b": {"from": "s"}}},)" +
        kOut);
    ASSERT_TRUE(program) << format(program.error());
    ASSERT_EQ(program->ir.volumes().size(), 1u);
    const auto value = [&](const Point& p) { return evaluate(program->ir, program->distance(), {}, p); };
    EXPECT_NEAR(value({3.75, 0.1, 0.1}), box({0.75, 0.1, 0.1}), 0.02);
    EXPECT_LE(value({5.0, 0.1, 0.1}), 1.0);  // beyond the grid: a bound
    EXPECT_GT(value({5.0, 0.1, 0.1}), 0.75);
    EXPECT_GT(value({0.0, 0.0, 0.0}), 1.0);
}

std::string field(const std::string& inputs) {
    return R"({"id": "it", "type": "mesh_to_field", "inputs": {)" + inputs + "}}," + kOut;
}

TEST(MeshFieldNodes, WhatDoesNotFitIsRefusedWithARemedy) {
    const Folder folder;
    const std::string mesh = R"("mesh": {"from": "file"})";
    EXPECT_NE(folder.refusal(field("")).find("not connected"), std::string::npos);
    EXPECT_NE(
        folder.refusal(R"({"id": "file", "type": "mesh_file"},)" + field(mesh)).find("no file is named"),
        std::string::npos);
    EXPECT_NE(
        folder.refusal(R"({"id": "file", "type": "mesh_file", "inputs": {"path": "no.obj"}},)" + field(mesh))
            .find("does not exist"),
        std::string::npos);
    EXPECT_NE(
        folder
            .refusal(R"({"id": "file", "type": "mesh_file", "inputs": {"path": "../x.obj"}},)" + field(mesh))
            .find("outside the folder"),
        std::string::npos);
    EXPECT_NE(
        folder
            .refusal(
                R"({"id": "s", "type": "sphere"}, {"id": "file", "type": "polygonize", "inputs": {"surface": {"from": "s"}}},)" +
                field(mesh))
            .find("takes a mesh from a file"),
        std::string::npos);
    for (const std::string stage : {"smooth", "subdivide", "decimate"})
        EXPECT_NE(
            folder
                .refusal(
                    kFile + R"({"id": "it", "type": ")" + stage +
                    R"(", "inputs": {"mesh": {"from": "file"}}}, {"id": "out", "type": "output", "inputs": {"mesh": {"from": "it"}}})")
                .find("put mesh_to_field and polygonize"),
            std::string::npos)
            << stage;
    EXPECT_NE(
        folder.refusal(kFile + R"({"id": "out", "type": "output", "inputs": {"mesh": {"from": "file"}}})")
            .find("put mesh_to_field and polygonize"),
        std::string::npos);
    EXPECT_NE(
        folder
            .refusal(
                kFile +
                R"({"id": "s", "type": "sphere"}, {"id": "d", "type": "distance", "inputs": {"surface": {"from": "s"}}},)" +
                field(mesh + R"(, "margin": {"from": "d"})"))
            .find("one number"),
        std::string::npos);
}

TEST(MeshFieldNodes, FindingsAreNotesOfTheProgram) {
    const Folder folder;
    std::string text = readText(folder.dir.path("cube.obj"));
    writeText(folder.dir.path("cube.obj"), text.substr(0, text.rfind("f ")));
    const Result<Program> program = folder.compile(
        kFile +
        R"({"id": "it", "type": "mesh_to_field", "inputs": {"mesh": {"from": "file"}, "resolution": 24}},)" +
        kOut);
    ASSERT_TRUE(program) << format(program.error());
    ASSERT_EQ(program->notes.size(), 1u);
    EXPECT_EQ(program->notes[0].severity, Error::Severity::warning);
    EXPECT_EQ(program->notes[0].node, "it");
    EXPECT_NE(program->notes[0].message.find("3 open edges"), std::string::npos);
    EXPECT_EQ(program->notes[0].message.find("the mesh 'cube.obj' has "), 0u);
}

TEST(MeshFieldNodes, ANumberThatComesByAWireIsInRangeToo) {
    const Folder folder;
    const std::string mesh = R"("mesh": {"from": "file"})";
    for (const auto& [input, value, why] : {std::tuple("resolution", "4", "at least 8"),
                                            {"resolution", "1000", "at most 512"},
                                            {"resolution", "40.5", "whole number"},
                                            {"margin", "-1", "at least 0"}}) {
        const std::string wired =
            R"({"id": "v", "type": "expression", "code": "return )" + std::string(value) + R"(;"},)";
        const std::string refused =
            folder.refusal(kFile + wired + field(mesh + R"(, ")" + input + R"(": {"from": "v"})"));
        EXPECT_NE(refused.find(why), std::string::npos) << refused;
    }
    EXPECT_NE(folder.refusal(kFile + field(mesh + R"(, "margin": 1e30)")).find("lost in its margin"),
              std::string::npos);
}

}  // namespace fw::mesh_field_test
