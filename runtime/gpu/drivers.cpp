#include "runtime/gpu/drivers.h"

#include <unistd.h>

#include <cstdlib>

namespace fw {

void passOverDriversWithoutCards() {
    // Each of these finds its cards by libdrm, which looks for them there and nowhere else.
    if (::access("/dev/dri", F_OK) == 0) return;
    for (const char* chosen : {"VK_DRIVER_FILES", "VK_ICD_FILENAMES", "VK_LOADER_DRIVERS_SELECT"})
        if (std::getenv(chosen)) return;
    constexpr int kKeep = 0;
    ::setenv("VK_LOADER_DRIVERS_DISABLE", "intel_icd*,intel_hasvk_icd*,radeon_icd*,nouveau_icd*", kKeep);
}

}  // namespace fw
