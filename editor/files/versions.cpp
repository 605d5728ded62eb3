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

Done keepVersion(const std::string& file, bool always, Wall::time_point now) {
    std::error_code error;
    if (!fs::is_regular_file(file, error)) return done();
    std::vector<Version> versions = versionsOf(file);
    // Those of a time to come are of before the clock was set back: they come last.
    std::ranges::stable_partition(versions, [&](const Version& each) { return each.until <= now; });
    const bool justNow =
        !versions.empty() && versions[0].until <= now && now < versions[0].until + kBetweenVersions;
    if (justNow && !always) return done();
    std::ifstream from(file, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(from), {}};
    if (!from) return Error{.message = "cannot be read, so no version of it was kept", .file = file};
    const fs::path folder = versionsFolder(file);
    fs::create_directories(folder, error);
    const auto named = [&](Wall::time_point time) {
        return folder / (stamp(time) + std::string(kGraphEnding));
    };
    while (fs::exists(named(now), error)) now += std::chrono::seconds(1);
    Result<OutputFile> copy = OutputFile::open(named(now).string(), nullptr);
    if (!copy) return copy.error();
    copy->write(text);
    if (Done written = copy->commit(); !written) return written;
    for (std::size_t i = kMostVersions - 1; i < versions.size(); ++i) fs::remove(versions[i].path, error);
    return done();
}

std::string words(Wall::time_point time, Wall::time_point now) {
    const auto parts = [](Wall::time_point of) {
        const std::time_t seconds = Wall::to_time_t(of);
        std::tm local{};
        localtime_r(&seconds, &local);
        return local;
    };
    const std::tm local = parts(time);
    const char* format = local.tm_year == parts(now).tm_year ? "%-d %B, %H:%M" : "%-d %B %Y, %H:%M";
    std::array<char, 64> text{};
    return {text.data(), std::strftime(text.data(), text.size(), format, &local)};
}

}  // namespace fw::editor
