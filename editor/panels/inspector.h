// The parts of the inspector: not for use outside panels/inspector*.cpp.
//
// Each shows its part of a node in ImGui's current window. `box` is of the document as it is drawn; where the
// user wants to go is left in `goTo` ("group/node"), for going there ends what `box` refers to.
#pragma once

#include "editor/editor.h"

namespace fw::editor {

/// Every input, its value, and what can be done with it.
void showInputs(Editor& editor, const NodeBox& box, std::string& goTo);
/// Of an expression: its code with what is wrong with it, and a row to add inputs.
void showExpression(Editor& editor, const NodeBox& box);
/// Of a group node, or of an end of the group: what the group has as inputs and outputs.
void showGroupSockets(Editor& editor, const std::string& group);

}  // namespace fw::editor
