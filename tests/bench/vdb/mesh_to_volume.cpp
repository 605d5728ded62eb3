// OpenVDB's meshToVolume for the benchmark, in a module of its own: the program starts without OpenVDB.
#include "tests/bench/vdb/mesh_to_volume.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>
#include <tbb/global_control.h>

#include <chrono>

extern "C" double fieldwrightMeshToVolume(const fw::bench::VolumeTask& task) {
    using namespace openvdb;
    initialize();
    const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, task.threads);
    std::vector<Vec3s> points;
    for (const glm::vec3& p : task.positions)
        points.emplace_back(float(p.x / task.cell), float(p.y / task.cell), float(p.z / task.cell));
    std::vector<Vec3I> triangles;
    for (std::size_t i = 0; i < task.indices.size(); i += 3)
        triangles.emplace_back(task.indices[i], task.indices[i + 1], task.indices[i + 2]);
    const auto start = std::chrono::steady_clock::now();
    const tools::QuadAndTriangleDataAdapter<Vec3s, Vec3I> mesh(points, triangles);
    const auto transform = math::Transform::createLinearTransform(task.cell);
    const auto grid = tools::meshToVolume<FloatGrid>(mesh, *transform, task.band, task.band);
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
    return grid->activeVoxelCount() > 0 ? took.count() : 0.0;
}
