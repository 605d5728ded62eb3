// The title of a window of another program, asked of the X server at once: a test that waits for one asks
// often.
#pragma once

#include <string>

namespace fw::test {

/// Of the window with this X id on the display that DISPLAY names; empty if there is none.
std::string windowTitle(const std::string& window);

}  // namespace fw::test
