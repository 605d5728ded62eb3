// A dialog that stays open beside the work.
#pragma once

#include <functional>

namespace fw::editor {

struct StayingDialog {
    bool open = false;
    bool toFront = false;  ///< it was just asked for
    bool busy = false;     ///< a field or a menu of it had the keyboard in the last frame
};

/// One frame of its window, if it is open: `width` pixels wide, at first with its top at this part of the
/// screen's height. `content` says whether it has had the keys of this frame; else Escape closes it, if
/// nothing in it has the keyboard.
void showStaying(StayingDialog& dialog, const char* title, float width, float top,
                 const std::function<bool()>& content);

}  // namespace fw::editor
