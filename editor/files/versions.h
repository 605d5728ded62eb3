// What a document's file held before it was saved over: kept beside it, so that a day's work can be looked
// back at.
//
// They lie in a hidden folder beside the file, ".tower.field.json.versions", a file each, named after the
// time until which it stood. One of a quarter of an hour is kept, and besides what a save would have lost for
// good; of all these the last ten.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "graph/base/result.h"

namespace fw::editor {

using Wall = std::chrono::system_clock;

inline constexpr std::size_t kMostVersions = 10;
inline constexpr std::chrono::minutes kBetweenVersions{15};

struct Version {
    std::string path;
    Wall::time_point until;  ///< to the second
    uint64_t bytes = 0;
};

/// Of the file, the last first. None where there is no such folder.
std::vector<Version> versionsOf(const std::string& file);

/// Called before the file is replaced: keeps what it holds, unless it is not there or, where it need not be
/// kept `always`, a version was less than kBetweenVersions ago. Errors: the folder cannot be made, the copy
/// not be written.
Done keepVersion(const std::string& file, bool always = false, Wall::time_point now = Wall::now());

/// "26 November 2026, 14:05", in local time; without the year if it is this one.
std::string words(Wall::time_point time, Wall::time_point now = Wall::now());

}  // namespace fw::editor
