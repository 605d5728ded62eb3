// Time in the editor: it plays, rests or is scrubbed. And what the timeline does of what keys do.
#pragma once

#include "editor/editor.h"

namespace fw::editor {

/// Lets the time of this frame pass if it plays: called once a frame.
void playOn(Editor& editor);
void togglePlay(Editor& editor);
/// Shows the time on the timeline, seconds; from there it plays on.
void showTime(Editor& editor, double seconds);
/// Whether the timeline has the keyboard and a key selected, so that Delete is for that one.
bool deletesKey(const Editor& editor);
void removeSelectedKey(Editor& editor);

}  // namespace fw::editor
