// Time in the editor: it plays, rests or is scrubbed.
#pragma once

#include "editor/editor.h"

namespace fw::editor {

/// Lets the time of this frame pass if it plays: called once a frame.
void playOn(Editor& editor);
void togglePlay(Editor& editor);
/// Shows the time on the timeline, seconds; from there it plays on.
void showTime(Editor& editor, double seconds);
/// The time shown after so many seconds of play from 0 on: within the range again once that has come to its
/// end, else as the timeline loops, even where nothing but the `time` node moves.
double playedTime(const Timeline& timeline, double seconds);

}  // namespace fw::editor
