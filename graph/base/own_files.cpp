#include "graph/base/own_files.h"

#include <system_error>

namespace fw {

namespace fs = std::filesystem;

fs::path programFolder() {
    std::error_code unknown;
    return fs::read_symlink("/proc/self/exe", unknown).parent_path();
}

fs::path ownFolder(const char* name, const char* file) {
    constexpr int kMostLevels = 4;  // from the program up to the folder that holds it
    std::error_code none;
    fs::path folder = programFolder();
    for (int level = 0; level < kMostLevels && !folder.empty(); ++level, folder = folder.parent_path())
        for (const fs::path& candidate : {folder / name, folder / "share/fieldwright" / name})
            if (fs::exists(candidate / file, none)) return candidate;
    return {};
}

}  // namespace fw
