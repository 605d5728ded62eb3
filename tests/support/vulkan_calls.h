// Vulkan's functions as a test program sees and bends them: those defined here stand before the loader's.
#pragma once

#include <vulkan/vulkan.h>

namespace fw::test {

/// Whether the command buffer that was ended last ends with a barrier that makes what was written before
/// visible to the host.
bool endedForTheHost();

/// What every heap's budget is said to be from now on, in bytes, of which nothing is used; 0: what the driver
/// says.
void setBudget(uint64_t bytes);

}  // namespace fw::test
