// Mesa's cache of translated shaders on disk, whose full disk must not end the process.
//
// The driver maps its index into memory, a sparse file: where the disk is full, the first write to a page of
// it is a SIGBUS. So the index's room is taken before the driver looks at it, and where there is none the
// driver is told to do without its cache.
#pragma once

#include <string>

namespace fw {

/// Call it once, before other threads and before the first device: it may set a variable of the environment.
void makeRoomForDriverCache();

/// Why the driver works without its cache; empty if it has one.
const std::string& whyNoDriverCache();

}  // namespace fw
