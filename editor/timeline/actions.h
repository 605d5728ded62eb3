// What the commands of the timeline do with the keys that are selected on it, at the time shown.
#pragma once

#include "editor/editor.h"

namespace fw::editor {

/// Whether the timeline is open and has keys selected.
bool anyKeys(const Editor& editor);
bool timelineOpen(const Editor& editor);

void copySelectedKeys(Editor& editor);
void cutSelectedKeys(Editor& editor);
/// At the time shown; into the row that was chosen last, if the keys were of one row.
void pasteKeysHere(Editor& editor);
/// Right behind themselves.
void duplicateSelectedKeys(Editor& editor);
void deleteSelectedKeys(Editor& editor);
void selectAllKeys(Editor& editor);
void invertKeys(Editor& editor);
void nudgeKeys(Editor& editor, int frames);
/// The selected keys onto the nearest frames.
void putKeysOnFrames(Editor& editor);
/// Shows the time of the next key, of those that are seen, or of the next marker; of the one before for -1.
void goToKey(Editor& editor, int direction);
void goToMarker(Editor& editor, int direction);
/// A marker at the time shown; asks for the name of the one that is there.
void addMarkerHere(Editor& editor);
void showAllTimes(Editor& editor);
void showSelectedTimes(Editor& editor);
void toggleCurves(Editor& editor);

}  // namespace fw::editor
