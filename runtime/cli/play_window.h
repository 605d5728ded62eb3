// The window of `fieldwright play`.
#pragma once

#include <utility>

#include "runtime/cli/commands.h"

namespace fw::cli {

/// Plays until the window is closed, Ctrl-C is pressed or `options.frames` pictures were shown. The graph's
/// file is watched: a change is played at once; one that cannot be played leaves the last good picture, and
/// the error is printed and shown over it.
int playInWindow(const PlayOptions& options, std::pair<int, int> size);

}  // namespace fw::cli
