#include "runtime/export/vdb/level_set.h"

#include <openvdb/io/Archive.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>
#include <openvdb/tools/ValueTransformer.h>

#include <cmath>
#include <sstream>

namespace {

constexpr float kBandVoxels = 3.0f;  // on either side of the surface

struct Cancel final : openvdb::util::NullInterrupter {
    const std::atomic<bool>* flag;
    explicit Cancel(const std::atomic<bool>* cancel) : flag(cancel) {}
    bool wasInterrupted(int) override { return flag && flag->load(std::memory_order_relaxed); }
};

/// Writes to any stream what io::File writes to a file of a given name: with offsets, so that readers load
/// what they need.
struct Archive final : openvdb::io::Archive {
    using openvdb::io::Archive::write;
    std::string text(const openvdb::GridCPtrVec& grids, const openvdb::MetaMap& about) const {
        std::ostringstream out(std::ios::binary);
        write(out, grids, true, about);
        return std::move(out).str();
    }
};

}  // namespace

bool fieldwrightLevelSet(const fw::LevelSetWish& wish, std::string& out) try {
    openvdb::initialize();
    std::vector<openvdb::Vec3s> points;  // in voxels
    points.reserve(wish.positions.size());
    for (const glm::vec3& p : wish.positions)
        points.emplace_back(p.x / wish.voxel, p.y / wish.voxel, p.z / wish.voxel);
    std::vector<openvdb::Vec3I> triangles;
    triangles.reserve(wish.indices.size() / 3);
    for (std::size_t i = 0; i < wish.indices.size(); i += 3)
        triangles.emplace_back(wish.indices[i], wish.indices[i + 1], wish.indices[i + 2]);
    const openvdb::tools::QuadAndTriangleDataAdapter<openvdb::Vec3s, openvdb::Vec3I> mesh(points, triangles);

    Cancel cancel(wish.cancel);
    const auto transform = openvdb::math::Transform::createLinearTransform(double{wish.voxel});
    const openvdb::FloatGrid::Ptr grid = openvdb::tools::meshToVolume<openvdb::FloatGrid>(
        static_cast<openvdb::util::NullInterrupter&>(cancel), mesh, *transform, kBandVoxels, kBandVoxels,
        openvdb::tools::DISABLE_RENORMALIZATION);
    // OpenVDB looks for the nearest triangle among those of a voxel's neighbours: voxels, inside and outside
    // are as it says, but its distances are wrong by up to half a voxel at the band's rims.
    const auto measure = [&](const openvdb::FloatGrid::ValueOnIter& value) {
        if (cancel.wasInterrupted(0)) return;
        const openvdb::Vec3d p = grid->indexToWorld(value.getCoord());
        value.setValue(float(std::copysign(wish.distance({p.x(), p.y(), p.z()}), *value)));
    };
    openvdb::tools::foreach (grid->beginValueOn(), measure);
    if (cancel.wasInterrupted(0)) return true;
    grid->setName("surface");
    grid->setCreator(wish.generator);
    openvdb::MetaMap about;
    about.insertMeta("generator", openvdb::StringMetadata(wish.generator));
    about.insertMeta("name", openvdb::StringMetadata(wish.name));
    out = Archive().text({grid}, about);
    return true;
} catch (const openvdb::Exception& failure) {
    out = failure.what();
    return false;
}
