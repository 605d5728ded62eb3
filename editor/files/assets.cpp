#include "editor/files/assets.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <utility>

#include "editor/files/watch.h"
#include "graph/assets/triangle_mesh.h"

namespace fw::editor {

namespace {

namespace fs = std::filesystem;
using How = BroughtFile::How;

bool sameContent(const fs::path& a, const fs::path& b) {
    std::error_code error;
    const auto size = fs::file_size(a, error);
    if (error || size != fs::file_size(b, error) || error) return false;
    std::ifstream one(a, std::ios::binary), other(b, std::ios::binary);
    std::vector<char> left(1u << 20), right(left.size());
    while (one && other) {
        one.read(left.data(), std::streamsize(left.size()));
        other.read(right.data(), std::streamsize(right.size()));
        if (one.gcount() != other.gcount() ||
            !std::equal(left.begin(), left.begin() + one.gcount(), right.begin()))
            return false;
    }
    return one.eof() && other.eof();
}

/// From the folder to the file, symbolic links followed; empty if that is not in the folder's tree.
std::string pathWithin(const fs::path& folder, const fs::path& file) {
    std::error_code error;
    const fs::path root = fs::weakly_canonical(folder, error), real = fs::weakly_canonical(file, error);
    const fs::path inside = real.lexically_relative(root);
    return inside.empty() || *inside.begin() == ".." ? std::string() : inside.generic_string();
}

bool isThere(const fs::path& path) {
    std::error_code error;
    return fs::exists(fs::symlink_status(path, error));
}

Done copyFile(const fs::path& from, const fs::path& to) {
    std::error_code error;
    fs::create_directories(to.parent_path(), error);
    if (!error && fs::copy_file(from, to, error)) return done();
    const std::string why = error.message();
    if (error != std::errc::file_exists) fs::remove(to, error);  // what there was room for
    return Error{.message = from.filename().string() + " cannot be copied to " + to.parent_path().string() +
                            ": " + why};
}

/// The other files that the file names, as paths from its folder, of those that are there.
std::vector<std::string> piecesOf(const fs::path& file, const FileKind& kind) {
    std::vector<std::string> pieces;
    if (&kind != &kMeshFile) return pieces;
    for (const std::string& piece : piecesOfMesh(file.string())) {
        const std::string path = pathWithin(file.parent_path(), file.parent_path() / piece);
        std::error_code error;
        if (!path.empty() && fs::is_regular_file(file.parent_path() / path, error)) pieces.push_back(path);
    }
    return pieces;
}

}  // namespace

Result<BroughtFile> bringFile(const std::string& folder, const std::string& file, const std::string& wanted,
                              const FileKind& kind) {
    if (const std::string path = pathWithin(folder, file); !path.empty()) return BroughtFile{path, How::lay};
    const fs::path from(file), base = (fs::path(folder) / wanted).parent_path();
    const std::string name = from.filename().string();
    // Else it would be copied to where a link leads.
    if (pathWithin(folder, base).empty())
        return Error{.message = name + " cannot be copied to " + base.string() + ": that is elsewhere"};
    const std::vector<std::string> pieces = piecesOf(from, kind);
    for (const std::string& piece : pieces)
        if (isThere(base / piece) && !sameContent(from.parent_path() / piece, base / piece))
            return Error{.message = name + " reads " + piece + ", and there is another " + piece + " in " +
                                    base.string() + ": rename one of them"};

    fs::path target = fs::path(folder) / wanted;
    bool there = false;
    for (int i = 2; isThere(target) && !there; ++i) {
        // A link would lead to what the graph may not read.
        there = pathWithin(folder, target) == target.lexically_relative(folder).generic_string() &&
                sameContent(target, from);
        if (!there)
            target = base / (fs::path(wanted).stem().string() + "-" + std::to_string(i) +
                             fs::path(wanted).extension().string());
    }
    if (!there)
        if (const Done copied = copyFile(from, target); !copied) return copied.error();
    for (const std::string& piece : pieces)
        if (!isThere(base / piece))
            if (const Done copied = copyFile(from.parent_path() / piece, base / piece); !copied)
                return copied.error();
    return BroughtFile{target.lexically_relative(folder).generic_string(), there ? How::same : How::copied};
}

Graph bringFiles(Graph graph, const std::string& from, const std::string& to,
                 std::vector<std::string>& told) {
    std::map<std::string, std::string> others;  // paths that change
    for (const auto& [path, kind] : namedFiles(graph)) {
        if (kind->apart) continue;
        const fs::path file = fs::path(from) / path;
        const std::string wanted = fs::path(path).lexically_normal().generic_string();
        std::error_code error;
        if (fs::path(path).is_absolute() || pathWithin(from, file).empty() || wanted.starts_with("..") ||
            !fs::is_regular_file(file, error) || fs::file_size(file, error) > kind->mostBytes)
            continue;  // the graph does not read it where it is either
        const Result<BroughtFile> brought = bringFile(to, file.string(), wanted, *kind);
        if (!brought) {
            told.push_back(brought.error().message);
        } else if (brought->path != wanted) {
            others.emplace(path, brought->path);
            if (brought->how == How::copied)
                told.push_back("copied " + wanted + " as " + brought->path +
                               " since there is another of its name");
        }
    }
    if (!others.empty())
        renameFiles(graph, [&](const NamedFile& file) {
            const auto found = others.find(file.path);
            return found == others.end() ? file.path : found->second;
        });
    return graph;
}

std::string joined(const std::vector<std::string>& words) {
    std::string all;
    for (const std::string& each : words) all += (all.empty() ? "" : "; ") + each;
    return all;
}

bool AssetWatch::look(const std::shared_ptr<const Graph>& graph, Clock::time_point now) {
    if (std::chrono::duration<double>(now - looked).count() < kWatchSeconds) return false;
    looked = now;
    if (std::exchange(seen, graph) != graph) {
        std::map<std::string, fw::FileWatch> named;
        for (const NamedFile& file : namedFiles(*graph)) {
            const std::string path = (fs::path(graph->path).parent_path() / file.path).string();
            const auto known = files.find(path);
            named.emplace(path, known == files.end() ? fw::FileWatch(path) : known->second);
        }
        files = std::move(named);
    }
    bool changed = false;
    for (auto& [path, watch] : files) changed |= watch.changed();
    return changed;
}

}  // namespace fw::editor
