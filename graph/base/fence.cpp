#include "graph/base/fence.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>

namespace fw {

namespace fs = std::filesystem;

namespace {

std::vector<std::string> fencedRoots;  // canonical; none: there is no fence
std::string fencedCaches;

Error outside(const std::string& path) {
    std::string list;
    for (const std::string& root : fencedRoots) list += (list.empty() ? "" : ", ") + inQuotes(root);
    return {.message = "lies outside the folders that are served (" + list +
                       "): move it there, or serve its folder too (--root)",
            .file = path};
}

bool isBelow(const std::string& path, const std::string& root) {
    return root == "/" || path == root ||
           (path.size() > root.size() && path.starts_with(root) && path[root.size()] == '/');
}

bool isInside(const std::string& path) {
    return std::ranges::any_of(fencedRoots, [&](const std::string& root) { return isBelow(path, root); });
}

/// The place that a path leads to, without links as far as there is something.
fs::path resolved(const std::string& path, std::error_code& failure) {
    const fs::path whole = fs::absolute(path, failure);
    return failure ? fs::path() : fs::weakly_canonical(whole, failure);
}

}  // namespace

Done fenceFiles(const std::vector<std::string>& roots, const std::string& own) {
    std::vector<std::string> canonical;
    for (const std::string& root : roots) {
        std::error_code failure;
        const fs::path folder = fs::canonical(root, failure);
        if (failure || !fs::is_directory(folder, failure))
            return Error{.message = "is no folder: name one that is there", .file = root};
        canonical.push_back(folder.string());
    }
    fencedRoots = std::move(canonical);
    std::error_code failure;
    fencedCaches = own.empty() ? own : fs::weakly_canonical(own, failure).string();
    return done();
}

Done checkMayRead(const std::string& path) {
    if (fencedRoots.empty()) return done();
    std::error_code failure;
    const fs::path full = resolved(path, failure);
    if (failure || !isInside(full.string())) return outside(path);
    return done();
}

Done checkFenced(int descriptor, const std::string& path) {
    if (fencedRoots.empty()) return done();
    std::array<char, 4097> place{};
    const ssize_t length =
        ::readlink(("/proc/self/fd/" + std::to_string(descriptor)).c_str(), place.data(), place.size());
    if (length <= 0 || std::size_t(length) == place.size() ||
        !isInside(std::string(place.data(), std::size_t(length))))
        return outside(path);
    return done();
}

Done checkMayWrite(const std::string& path) {
    if (fencedRoots.empty()) return done();
    std::error_code failure;
    const fs::path full = resolved(path, failure);
    const std::string folder = full.parent_path().string();
    if (failure) return Error{.message = "cannot be looked up: " + failure.message(), .file = path};
    if (!isInside(folder) && !(fencedCaches.size() > 1 && isBelow(folder, fencedCaches)))
        return outside(path);
    return done();
}

}  // namespace fw
