// A file that is dragged from another program and dropped on a window, by the protocol that X programs have
// for that (XDND 5).
#pragma once

#include <string>

namespace fw::test {

/// Drops the file at this place of the screen on the window with this X id, and waits until the window has
/// taken it. Whether it did; not if it takes no files, or nothing happens for half a minute.
bool dropFile(const std::string& window, const std::string& path, int x, int y);

}  // namespace fw::test
