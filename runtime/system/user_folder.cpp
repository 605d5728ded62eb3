#include "runtime/system/user_folder.h"

#include <cstdlib>

namespace fw {

std::string userFolder(const char* variable, const char* below) {
    if (const char* folder = std::getenv(variable); folder && *folder)
        return std::string(folder) + "/fieldwright";
    if (const char* home = std::getenv("HOME"); home && *home)
        return std::string(home) + below + "/fieldwright";
    return {};
}

}  // namespace fw
