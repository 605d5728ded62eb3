#include "graph/base/asset_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "graph/base/fence.h"

namespace fw {

namespace fs = std::filesystem;

namespace {

/// The file that the path leads to, symbolic links followed. It may not exist. Errors: it lies elsewhere.
Result<std::string> locate(const std::string& owner, const std::string& path, const FileKind& kind) {
    const auto problem = [&](const std::string& what) { return fileProblem(path, kind, what); };
    if (path.find('\0') != std::string::npos) return problem("has a NUL byte in its path: remove it");
    std::error_code failure;
    const fs::path folder = fs::path(owner).parent_path();
    const fs::path root = fs::weakly_canonical(folder.empty() ? fs::path(".") : folder, failure);
    if (failure) return problem("cannot be looked up: " + failure.message());
    const fs::path target = fs::weakly_canonical(root / path, failure);
    if (failure) return problem("cannot be looked up: " + failure.message());
    const fs::path inside = target.lexically_relative(root);
    if (!kind.apart && (fs::path(path).is_absolute() || inside.empty() || *inside.begin() == ".."))
        return problem(
            "lies outside the folder of the file that names it: move it there and write its path from "
            "that file");
    if (const Done open = checkMayRead(target.string()); !open) return problem(open.error().message);
    return target.string();
}

}  // namespace

Asset::Asset(int descriptor_, std::string file_, std::array<int64_t, 4> stamp_)
    : file(std::move(file_)), stamp(stamp_), descriptor(descriptor_) {}

Asset::Asset(Asset&& other) noexcept
    : file(std::move(other.file)), stamp(other.stamp), descriptor(std::exchange(other.descriptor, -1)) {}

Asset::~Asset() {
    if (descriptor >= 0) close(descriptor);
}

Result<std::string> Asset::read() const {
    std::string bytes(static_cast<std::size_t>(stamp[1]), '\0');
    std::size_t have = 0;
    while (have < bytes.size()) {
        const ssize_t got = ::read(descriptor, bytes.data() + have, bytes.size() - have);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) return Error{.message = "cannot be read: " + std::string(std::strerror(errno))};
        if (got == 0) break;  // it has just become shorter
        have += static_cast<std::size_t>(got);
    }
    bytes.resize(have);
    return bytes;
}

Done checkAssetPlace(const std::string& owner, const std::string& path, const FileKind& kind) {
    const Result<std::string> place = locate(owner, path, kind);
    if (!place) return place.error();
    return done();
}

Result<Asset> openAsset(const std::string& owner, const std::string& path, const FileKind& kind) {
    const auto problem = [&](const std::string& what) { return fileProblem(path, kind, what); };
    Result<std::string> file = locate(owner, path, kind);
    if (!file) return file.error();
    // Not waiting for whoever writes to a pipe.
    const int descriptor = ::open(file->c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    const int failure = errno;
    Asset asset(descriptor, std::move(*file), {});
    struct stat status = {};
    if (descriptor < 0 || fstat(descriptor, &status) != 0)
        return problem(failure == ENOENT || failure == ENOTDIR ? "does not exist: check the path"
                       : failure == EACCES                     ? "may not be read: change its permissions"
                                           : "cannot be opened: " + std::string(std::strerror(failure)));
    if (const Done inside = checkFenced(descriptor, path); !inside) return problem(inside.error().message);
    const std::string noun(kind.noun);
    if (S_ISDIR(status.st_mode)) return problem("is a folder: name a " + noun + " in it");
    if (!S_ISREG(status.st_mode)) return problem("is no ordinary file: name a " + noun);
    if (status.st_size > static_cast<off_t>(kind.mostBytes))
        return problem("is a file of more than " + std::to_string(kind.mostBytes >> 20) +
                       " MiB: use a smaller one");
    asset.stamp = {int64_t(status.st_ino), int64_t(status.st_size), int64_t(status.st_mtim.tv_sec),
                   int64_t(status.st_mtim.tv_nsec)};
    return asset;
}

}  // namespace fw
