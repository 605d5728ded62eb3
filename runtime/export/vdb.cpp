// OpenVDB level set: a grid of floats named "surface" that holds the distance from the mesh within three
// voxels of it, negative inside, in metres, +Y up.
//
// OpenVDB finds the voxels, and which are inside; their distances are those to the nearest of the merged
// mesh's triangles. It lives in a module (vdb/level_set.h), found beside the program, where it is installed,
// or where the system's package has it. The file's tag, random in other programs' files, is made from its
// content.
#include <dlfcn.h>

#include <cassert>
#include <filesystem>

#include "graph/assets/triangle_tree.h"
#include "graph/base/own_files.h"
#include "runtime/export/fingerprint.h"
#include "runtime/export/formats.h"
#include "runtime/export/vdb/level_set.h"

namespace fw {
namespace {

constexpr char kModule[] = "libfieldwright-vdb.so";

MakeLevelSet* levelSetMaker() {
    const std::filesystem::path program = programFolder(), installed = FIELDWRIGHT_MODULES;
    for (const std::filesystem::path& place :
         {program / kModule, program / ".." / installed / kModule, "/usr" / installed / kModule})
        if (void* module = ::dlopen(place.c_str(), RTLD_NOW | RTLD_LOCAL))
            return reinterpret_cast<MakeLevelSet*>(::dlsym(module, "fieldwrightLevelSet"));
    return nullptr;
}

}  // namespace

std::string writeVdb(const WeldedMesh& solid, float voxel, const std::string& name,
                     const std::atomic<bool>* cancel, OutputFile& file) {
    static MakeLevelSet* const make = levelSetMaker();
    if (!make) return inQuotes(kModule) + " is not there, or OpenVDB is not installed";
    std::string bytes;
    const TriangleTree tree(solid.positions, solid.indices, TriangleTree::Purpose::distances);
    const auto distance = [&](const glm::dvec3& point) { return tree.distance(point); };
    if (!make({solid.positions, solid.indices, distance, voxel, name, generatorName(), cancel}, bytes))
        return bytes;
    if (bytes.empty()) return {};                     // cancelled
    constexpr std::size_t kTag = 21, kTagBytes = 36;  // behind magic number, versions, and a flag
    assert(bytes.size() > kTag + kTagBytes && bytes[kTag + 8] == '-' && bytes[kTag + 23] == '-');
    Fingerprint content;
    content.add(bytes.data() + kTag + kTagBytes, bytes.size() - kTag - kTagBytes);
    bytes.replace(kTag, kTagBytes, content.uuid());
    file.write(bytes);
    return {};
}

}  // namespace fw
