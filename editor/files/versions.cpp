#include "editor/files/versions.h"

#include <algorithm>
#include <array>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>

#include "graph/document/json.h"
#include "runtime/system/output_file.h"

namespace fw::editor {

namespace {

namespace fs = std::filesystem;

constexpr const char* kStamp = "%Y%m%dT%H%M%SZ";  // of UTC: in order by name, and no hour twice in autumn

fs::path versionsFolder(const std::string& file) {
    std::error_code none;
    const fs::path full = fs::absolute(file, none);
    return full.parent_path() / ("." + full.filename().string() + ".versions");
}

std::string stamp(Wall::time_point time) {
    const std::time_t seconds = Wall::to_time_t(time);
    std::tm parts{};
    gmtime_r(&seconds, &parts);
    std::array<char, 32> text{};
    return {text.data(), std::strftime(text.data(), text.size(), kStamp, &parts)};
}

std::optional<Wall::time_point> timeOf(const std::string& name) {
    const std::string ending(kGraphEnding);
    if (!name.ends_with(ending)) return std::nullopt;
    const std::string text = name.substr(0, name.size() - ending.size());
    std::tm parts{};
    const char* end = strptime(text.c_str(), kStamp, &parts);
    if (!end || *end != 0) return std::nullopt;
    return Wall::from_time_t(timegm(&parts));
}

}  // namespace

std::vector<Version> versionsOf(const std::string& file) {
    std::vector<Version> versions;
    std::error_code error;
    fs::directory_iterator each(versionsFolder(file), error);
    for (; !error && each != fs::directory_iterator(); each.increment(error)) {
        std::error_code none;
        const auto until = timeOf(each->path().filename().string());
        if (until && each->is_regular_file(none))
            versions.push_back({each->path().string(), *until, each->file_size(none)});
    }
    std::ranges::sort(versions, std::greater(), &Version::until);
    return versions;
}

Done keepVersion(const std::string& file, Wall::time_point now) {
    std::error_code error;
    if (!fs::is_regular_file(file, error)) return done();
    std::vector<Version> versions = versionsOf(file);
    // A clock that was set back keeps one too many rather than none.
    if (!versions.empty() && now >= versions[0].until && now < versions[0].until + kBetweenVersions)
        return done();
    std::ifstream from(file, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(from), {}};
    if (!from) return Error{.message = "cannot be read, so no version of it was kept", .file = file};
    const fs::path folder = versionsFolder(file);
    fs::create_directories(folder, error);
    Result<OutputFile> copy =
        OutputFile::open((folder / (stamp(now) + std::string(kGraphEnding))).string(), nullptr);
    if (!copy) return copy.error();
    copy->write(text);
    if (Done written = copy->commit(); !written) return written;
    for (std::size_t i = kMostVersions - 1; i < versions.size(); ++i) fs::remove(versions[i].path, error);
    return done();
}

std::string words(Wall::time_point time) {
    const std::time_t seconds = Wall::to_time_t(time);
    std::tm parts{};
    localtime_r(&seconds, &parts);
    std::array<char, 64> text{};
    return {text.data(), std::strftime(text.data(), text.size(), "%-d %B, %H:%M", &parts)};
}

}  // namespace fw::editor
