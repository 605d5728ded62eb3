// Triangle meshes to fields on the device, and what was made before from the disk.
//
// The steps are those of graph/assets/mesh_field.h; which triangles go through which rows is listed by the
// host. Where normals do not decide what is inside, the band is read back and the host's winding numbers do.
//
// Lifetime: a baker keeps its kernels, which are compiled at its first use, and its buffers while it works;
// it must not outlive its device.
#pragma once

#include <functional>

#include "graph/assets/mesh_field.h"
#include "runtime/gpu/commands.h"

namespace fw {

struct BakeOptions {
    /// Looks in the user's cache folder first (cache_file.h), and keeps there what was made; the least
    /// recently used go when all take more than kMostCachedBytes.
    bool cached = true;
    std::vector<StageTime>* stages = nullptr;         ///< gets the time of each stage
    bool timed = false;                               ///< of each kernel, as in commands.h
    std::function<void(double share)> progress = {};  ///< called with what is done, from 0 to 1
};
inline constexpr std::size_t kMostCachedBytes = std::size_t(2) << 30;

/// Makes fields on what `device` gives when it is called; on the host if that is null, and where the device
/// lacks 64-bit atomics or cannot bind so large a grid. Throws SystemError.
MeshFieldBaker meshFieldBaker(std::function<const Device*()> device, const BakeOptions& options = {});

}  // namespace fw
