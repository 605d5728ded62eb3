// Text and the scrub bar, drawn over a picture by the processor: legible on any background, and the same
// without a window. Over one of no colour and no alpha they make colours times their alpha, to be put over
// another.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "runtime/render/picture.h"
#include "runtime/window/viewer.h"

namespace fw {

/// Draws columns of lines of ASCII text side by side on a dark panel whose top left corner is at (x, y)
/// pixels; returns the y of its lower edge.
int drawPanel(Picture& picture, int x, int y, const std::vector<std::string>& columns);

/// Draws what the viewer shows over the picture: the scrub bar, the keys if asked for, and the message, if
/// there is one. Where the picture is too small for something, that is left out.
void drawOverlay(Picture& picture, const Viewer& viewer, std::string_view message);

}  // namespace fw
