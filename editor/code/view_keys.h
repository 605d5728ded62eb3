// The keys of the widget: not for use outside of view*.cpp.
#pragma once

#include "editor/code/view.h"

namespace fw::editor::code {

/// What was pressed and typed in this frame, done to the text; the rest is left in `heard`. `page`: lines
/// that are seen.
void hearKeys(View& view, const Shown& shown, int page, Heard& heard);

}  // namespace fw::editor::code
