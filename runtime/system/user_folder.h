// Where a user's files of this program lie that are no documents (XDG Base Directory Specification).
#pragma once

#include <string>

namespace fw {

/// The folder `fieldwright` in the one that the environment's `variable` ("XDG_CACHE_HOME") names or, where
/// it is not set, in `below` ("/.cache") the home folder; empty where neither is known. It need not exist.
std::string userFolder(const char* variable, const char* below);

}  // namespace fw
