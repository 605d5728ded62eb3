// What the shortcuts of the table of commands do, each pressed in the real window: cases by the command's id,
// in a file for each part of the editor. end_to_end_shortcuts_test.cpp goes through all.
#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "graph/document/timeline.h"
#include "tests/support/editor/program.h"

namespace fw::editor::test::shortcut_cases {

/// What to do, with these keys, in a window with the document and nothing selected, and what to see.
using Case = std::function<void(Program&, const std::string& keys)>;
using Cases = std::map<std::string, Case>;

const Cases& graphCases();   ///< of what is done to nodes: edit, node, canvas
const Cases& windowCases();  ///< of documents, of what is shown and where the keyboard is: file, view, help
const Cases& pictureCases();
const Cases& timelineCases();

using Ids = std::set<std::string>;

/// Selects these nodes by clicks.
void pick(Program& program, const std::vector<std::string>& nodes);
/// The nodes of the document as it is now.
Ids nodesAfter(Program& program);
/// This one, which has to be there.
const Node& nodeAfter(Program& program, const std::string& id);
/// The node that feeds the input; empty if none does.
std::string source(const Node& node, const std::string& input);
/// What is left when all that is selected is deleted.
void expectSelected(Program& program, const Ids& selected);

Area picturePart(const Program& program);
Area pictureCorner(const Program& program);
/// The words in the picture's corner.
void waitForLook(Program& program, const std::string& words);
/// Presses the keys until the picture is looked at so, as soon as there is one.
void lookUntil(Program& program, const std::string& keys, const std::string& words);
/// A view without light, which a processor draws soon: what is looked at is not how it is lit.
void showNormals(Program& program);

}  // namespace fw::editor::test::shortcut_cases
