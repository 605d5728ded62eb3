// Files that another file refers to: pictures and meshes of a graph, buffers of a glTF file.
//
// They must lie in the folder of the file that names them, or in one below it: a graph that was got from
// somewhere reads nothing else of its user's. But for kinds that lie apart (FileKind::apart).
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "graph/base/file_kind.h"
#include "graph/base/result.h"

namespace fw {

/// An open file. Moves, and is closed at its end.
class Asset {
  public:
    Asset(int descriptor, std::string file, std::array<int64_t, 4> stamp);
    Asset(Asset&& other) noexcept;
    Asset& operator=(Asset&& other) = delete;
    ~Asset();

    std::string file;              ///< absolute path, symbolic links followed
    std::array<int64_t, 4> stamp;  ///< another one if the file was changed
    /// All of it. Errors: it cannot be read.
    Result<std::string> read() const;

  private:
    int descriptor;
};

/// Opens the file that `path` leads to from the folder of the file `owner` (from the current folder if that
/// is empty). The Error has a message only: there is no such ordinary file in that folder's tree, it may not
/// be read or is too large.
Result<Asset> openAsset(const std::string& owner, const std::string& path, const FileKind& kind);

/// Errors: that path leads to no place in that folder's tree, be there a file or not.
Done checkAssetPlace(const std::string& owner, const std::string& path, const FileKind& kind);

/// What make(bytes, absolute path) gives for the file, a Result of a shared pointer. While somebody holds
/// what was made of a file, and the file was not changed, it is given again. Errors: as openAsset(),
/// Asset::read() and `make`.
template <class Made, class Make>
Result<std::shared_ptr<const Made>> readAsset(const std::string& owner, const std::string& path,
                                              const FileKind& kind, const Make& make) {
    struct Known {
        std::array<int64_t, 4> stamp;
        std::weak_ptr<const Made> made;
    };
    static std::mutex mutex;
    static std::map<std::string, Known> known;  // by absolute path
    const Result<Asset> asset = openAsset(owner, path, kind);
    if (!asset) return asset.error();
    {
        const std::lock_guard lock(mutex);
        const auto found = known.find(asset->file);
        if (found != known.end() && found->second.stamp == asset->stamp)
            if (std::shared_ptr<const Made> held = found->second.made.lock()) return held;
        std::erase_if(known, [](const auto& entry) { return entry.second.made.expired(); });
    }
    const Result<std::string> bytes = asset->read();
    if (!bytes) return fileProblem(path, kind, bytes.error().message);
    Result<std::shared_ptr<const Made>> made = make(*bytes, asset->file);
    if (made) {
        const std::lock_guard lock(mutex);
        known[asset->file] = {asset->stamp, *made};
    }
    return made;
}

}  // namespace fw
