#include "editor/files/recovery.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <ctime>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "graph/document/json.h"
#include "runtime/system/output_file.h"
#include "runtime/system/user_folder.h"

namespace fw::editor {

namespace {

constexpr std::string_view kLock = ".lock";
constexpr const char* kKey = "recovery";
constexpr std::time_t kStaleSeconds = 60;

std::string lockOf(const std::string& copy) {
    return copy.substr(0, copy.size() - kGraphEnding.size()) + std::string(kLock);
}

std::time_t changedAt(const std::string& path) {
    struct stat status {};
    return stat(path.c_str(), &status) == 0 ? status.st_mtime : 0;
}

std::string absoluteOrSame(const std::string& path) {
    std::error_code error;
    const std::filesystem::path full = std::filesystem::absolute(path, error);
    return path.empty() || error ? path : full.lexically_normal().string();
}

Done writeCopy(Graph graph, const std::string& file) {
    // Not saveGraph: what it refuses is worth keeping all the more, and nobody waits for the disk.
    if (!graph.extra->is_object()) graph.extra = Json::object();
    (*graph.extra)[kKey] = Json{{"of", absoluteOrSame(graph.path)}};
    Result<OutputFile> out = OutputFile::open(file, nullptr);
    if (!out) return out.error();
    out->write(writeGraph(graph));
    return out->commit();
}

/// Whether no process holds the lock beside the copy.
bool isLeft(const std::string& copy) {
    const int lock = ::open(lockOf(copy).c_str(), O_RDWR | O_CLOEXEC);
    if (lock < 0) return errno == ENOENT;
    const bool left = flock(lock, LOCK_EX | LOCK_NB) == 0;
    close(lock);
    return left;
}

std::string localTime(std::time_t time) {
    std::tm parts{};
    char text[32] = {};
    if (localtime_r(&time, &parts)) std::strftime(text, sizeof text, "%Y-%m-%d %H:%M", &parts);
    return text;
}

}  // namespace

std::string recoveryFolder() {
    const std::string folder = userFolder("XDG_STATE_HOME", "/.local/state");
    return folder.empty() ? folder : folder + "/recovery";
}

Recovery::Recovery(std::string folder) {
    std::error_code error;
    if (folder.empty() || (std::filesystem::create_directories(folder, error), error)) return;
    // A name that no other document has, of this process or of one that left its copy.
    for (int i = 0; i < 1000 && lock < 0; ++i) {
        file = folder + "/" + std::to_string(getpid()) + "-" + std::to_string(i) + std::string(kGraphEnding);
        if (access(file.c_str(), F_OK) == 0) continue;
        lock = ::open(lockOf(file).c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
        if (lock >= 0 && flock(lock, LOCK_EX | LOCK_NB) != 0) close(std::exchange(lock, -1));
    }
    if (lock < 0) file.clear();
}

Recovery::Recovery(Recovery&& other) noexcept : Recovery(std::string()) { *this = std::move(other); }

Recovery& Recovery::operator=(Recovery&& other) noexcept {
    std::swap(file, other.file), std::swap(lock, other.lock), std::swap(copied, other.copied);
    std::swap(kept, other.kept), std::swap(changed, other.changed), std::swap(seen, other.seen);
    std::swap(changedAt, other.changedAt), std::swap(seenAt, other.seenAt);
    std::swap(writing, other.writing);
    return *this;
}

Recovery::~Recovery() {
    if (writing.valid()) writing.wait();
    if (lock < 0) return;
    if (!copied) ::unlink(lockOf(file).c_str());
    close(lock);
}

Done Recovery::keep(const std::shared_ptr<const Graph>& graph, uint64_t revision, bool unsaved,
                    Clock::time_point now) {
    if (lock < 0) return done();
    Done result = done();
    if (writing.valid()) {
        if (writing.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return done();
        result = writing.get();
    }
    if (!unsaved) {
        discard();
        kept = revision;
        return result;
    }
    if (revision == kept) return result;
    if (!std::exchange(changed, true)) changedAt = now;
    if (std::exchange(seen, revision) != revision) seenAt = now;
    const auto since = [&](Clock::time_point then) {
        return std::chrono::duration<double>(now - then).count();
    };
    if (since(changedAt) < kRecoverySeconds && since(seenAt) < kRecoveryRest) return result;
    changed = false;
    kept = revision;
    copied = true;
    writing = std::async(std::launch::async, [graph, path = file] { return writeCopy(*graph, path); });
    return result;
}

Done Recovery::keepNow(const Graph& graph) {
    if (lock < 0) return Error{.message = "there is no folder for a recovery file"};
    if (writing.valid()) writing.wait();
    copied = true;
    return writeCopy(graph, file);
}

void Recovery::discard() {
    if (writing.valid()) writing.wait();
    if (std::exchange(copied, false)) ::unlink(file.c_str());
    changed = false;
}

std::vector<LeftCopy> leftCopies(const std::string& folder) {
    std::vector<std::pair<std::time_t, LeftCopy>> found;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
        const std::string path = entry.path().string();
        struct stat status {};
        if (path.ends_with(kLock) && std::time(nullptr) - changedAt(path) > kStaleSeconds) {
            // Of a process that died without a copy. A young one may be of an editor that is just starting.
            const std::string copy = path.substr(0, path.size() - kLock.size()) + std::string(kGraphEnding);
            if (access(copy.c_str(), F_OK) != 0 && isLeft(copy)) ::unlink(path.c_str());
        }
        if (!path.ends_with(kGraphEnding) || stat(path.c_str(), &status) != 0 || !isLeft(path)) continue;
        LeftCopy copy{path, {}, localTime(status.st_mtime)};
        if (const Result<Graph> graph = readCopy(copy)) copy.original = graph->path;
        found.emplace_back(status.st_mtime, std::move(copy));
    }
    std::ranges::sort(found, [](const auto& a, const auto& b) {
        return std::pair(b.first, a.second.file) < std::pair(a.first, b.second.file);
    });
    std::vector<LeftCopy> copies;
    for (auto& [time, copy] : found) copies.push_back(std::move(copy));
    return copies;
}

Result<Graph> readCopy(const LeftCopy& copy) {
    Result<Graph> graph = readGraph(copy.file, nullptr);
    if (!graph) return graph;
    graph->path.clear();
    if (!graph->extra->is_object()) return graph;
    const auto found = graph->extra->find(kKey);
    if (found == graph->extra->end()) return graph;
    if (found->is_object() && found->contains("of") && found->at("of").is_string())
        graph->path = found->at("of").get<std::string>();
    graph->extra->erase(found);
    if (graph->extra->empty()) graph->extra = nullptr;
    return graph;
}

void removeCopy(const LeftCopy& copy) {
    ::unlink(copy.file.c_str());
    ::unlink(lockOf(copy.file).c_str());
}

}  // namespace fw::editor
