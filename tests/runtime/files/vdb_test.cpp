// OpenVDB files: a level set of the mesh, as OpenVDB and its tools read it.
#include <gtest/gtest.h>
#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "runtime/export/export.h"
#include "runtime/measure/mesh_report.h"
#include "tests/support/command.h"
#include "tests/support/graph/temp_dir.h"
#include "tests/support/meshes.h"

namespace fw::vdb_test {

using test::TempDir;

openvdb::FloatGrid::Ptr surfaceIn(const std::string& path) {
    openvdb::initialize();
    openvdb::io::File file(path);
    file.open();
    EXPECT_TRUE(file.hasGrid("surface"));
    EXPECT_EQ(file.getGrids()->size(), 1u);
    return openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid("surface"));
}

/// The volume within the level set, polygonised by OpenVDB.
double volumeOf(const openvdb::FloatGrid& grid) {
    std::vector<openvdb::Vec3s> points;
    std::vector<openvdb::Vec4I> quads;
    openvdb::tools::volumeToMesh(grid, points, quads);
    double volume = 0.0;
    for (const openvdb::Vec4I& q : quads)
        for (const auto& [i, j, k] : {std::array{0, 1, 2}, {0, 2, 3}}) {
            const openvdb::Vec3d a(points[q[i]]), b(points[q[j]]), c(points[q[k]]);
            volume -= a.dot(b.cross(c)) / 6.0;  // its quads wind clockwise seen from outside
        }
    return volume;
}

TEST(Vdb, HoldsTrueDistancesFromATorus) {
    const TempDir folder;
    const double ring = 1.0, tube = 0.25, voxel = 0.02;
    ASSERT_TRUE(exportMesh(test::unshared(test::torus(400, 120, ring, tube)), folder.path("torus.vdb"),
                           {.name = "Größe", .cellSize = float(voxel)}));
    const openvdb::FloatGrid::Ptr grid = surfaceIn(folder.path("torus.vdb"));
    ASSERT_TRUE(grid);
    EXPECT_EQ(grid->getGridClass(), openvdb::GRID_LEVEL_SET);
    EXPECT_EQ(grid->getCreator(), "Fieldwright " FIELDWRIGHT_VERSION);
    EXPECT_NEAR(grid->voxelSize().x(), voxel, 1e-8);
    EXPECT_TRUE(grid->hasUniformVoxels());
    EXPECT_NEAR(grid->background(), 3.0 * voxel, 1e-6);
    std::size_t count = 0, inside = 0;
    double greatest = 0.0;
    for (auto value = grid->cbeginValueOn(); value; ++value, ++count) {
        const openvdb::Vec3d p = grid->indexToWorld(value.getCoord());
        const double exact = std::hypot(std::hypot(p.x(), p.z()) - ring, p.y()) - tube;
        greatest = std::max(greatest, std::abs(*value - exact));
        ASSERT_LT(std::abs(*value), 3.01 * voxel);
        inside += *value < 0.0f;
    }
    EXPECT_LT(greatest, 3e-4);  // what the facets of this torus are away from it
    EXPECT_GT(inside, count / 3);
    EXPECT_LT(inside, count / 3 * 2);
    const double volume = 2.0 * std::numbers::pi * std::numbers::pi * ring * tube * tube;
    EXPECT_NEAR(volumeOf(*grid), volume, 0.01 * volume);
}

TEST(Vdb, WithoutACellSizeTheLongestSideHas128Voxels) {
    const TempDir folder;
    ASSERT_TRUE(exportMesh(test::cube(), folder.path("a.vdb")));
    EXPECT_NEAR(surfaceIn(folder.path("a.vdb"))->voxelSize().y(), 2.0 / 128, 1e-8);
}

TEST(Vdb, TheSameMeshGivesTheSameBytes) {
    const TempDir folder;
    const Mesh mesh = test::torus(200, 100);
    for (const char* name : {"a.vdb", "b.vdb"})
        ASSERT_TRUE(exportMesh(mesh, folder.path(name), {.name = "part"}));
    EXPECT_TRUE(test::readText(folder.path("a.vdb")) == test::readText(folder.path("b.vdb")));
}

TEST(Vdb, TheCommandGivesVoxelsOfTheMeshsCells) {
    const TempDir folder;
    const std::string graph = folder.path("ball.field.json"), path = folder.path("Kugel mit Maß.vdb");
    test::writeText(graph, R"({"fieldwright": 1, "nodes": [
        {"id": "a", "type": "sphere", "inputs": {"radius": 0.8}},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "a"}}}]})");
    const test::CommandResult made = test::runCommand(
        {"export", graph, "-o", path, "--resolution", "100", "--region", "-1", "-1", "-1", "1", "1", "1"});
    ASSERT_EQ(made.status, 0) << made.errors;
    const openvdb::FloatGrid::Ptr grid = surfaceIn(path);
    EXPECT_NEAR(grid->voxelSize().x(), 0.02, 1e-8);
    const double volume = 4.0 / 3.0 * std::numbers::pi * 0.8 * 0.8 * 0.8;
    EXPECT_NEAR(volumeOf(*grid), volume, 0.005 * volume);

    if (test::runProgram("command -v vdb_print").status != 0) GTEST_SKIP() << "no vdb_print here";
    const auto printed = test::runProgram("vdb_print -l '" + path + "'");
    EXPECT_EQ(printed.status, 0);
    for (const char* line : {"generator: Fieldwright " FIELDWRIGHT_VERSION "\n", "name: Kugel_mit_Maß\n",
                             "Name: surface\n", "class: level set\n", "voxel size: 0.02\n"})
        EXPECT_NE(printed.output.find(line), std::string::npos) << line << printed.output;
}

}  // namespace fw::vdb_test
