// The code of one expression node under a hand: its text until it is applied, what is known of it, and what
// helps to write it.
//
// The document is not touched before the text is applied: by Ctrl+Enter, or as the keyboard leaves it. While
// it is typed, names are read and the document is checked with it on threads of their own; answers for a text
// that is another by then are dropped, but for the marks, which stay until there are others.
//
// Lifetime: a part of Editor. It knows its node by scope and id, and the document by Viewport::document, and
// holds nothing of either: what is typed is a hand of the document.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "editor/code/check.h"
#include "editor/code/entries.h"
#include "editor/code/view.h"
#include "editor/document/document.h"
#include "editor/viewport/aside.h"

namespace fw::editor {
struct NodeBox;
}

namespace fw::editor::code {

inline constexpr double kHoverDelay = 0.4;  ///< seconds until a name under the mouse says what it is

/// The list of what may be meant.
struct CompletionList {
    bool open = false;
    Range letters;  ///< what is typed of the name, up to the cursor
    std::vector<Entry> own;
    std::vector<const Entry*> found;  ///< into `own` and the library
    int chosen = 0, first = 0;        ///< of found: marked, and uppermost
    ImVec2 lo, hi;                    ///< where it is on the screen
    std::optional<Spot> call;         ///< whose signature is shown
    std::optional<Spot> closedCall;   ///< whose signature Escape has closed
};

/// Another name for what the cursor was on.
struct Renaming {
    bool opened = false, open = false;
    language::NameUse::Kind kind = language::NameUse::Kind::unknown;
    std::string from, to, problem;
    int index = -1;  ///< of the definition
    uint64_t version = 0;
};

struct CodeEditor {
    // Of what
    uint64_t document = 0;    ///< Viewport::document
    std::string scope, node;  ///< empty: of nothing
    uint64_t revision = 0;    ///< of the document, when `base` was its code
    std::string base;         ///< the node's code
    Hand hand = Hand::none;   ///< while what is typed is another

    // The text
    Text text;
    Colouring colouring;
    View view;
    int frame = 0;  ///< ImGui's, in which it was last shown

    // What is known of it
    std::vector<CodeInput> inputs;
    std::shared_ptr<const NamesOfText> names;
    std::vector<Error> findings;
    std::vector<Mark> marks;
    uint64_t marked = 0;              ///< the version that they were moved to
    uint64_t checked = 0;             ///< the version that was checked last
    uint64_t named = 0, namedOf = 0;  ///< the version, and revision, that names were asked for
    uint64_t asked = 0, askedOf = 0;  ///< and findings
    uint64_t session = 0;             ///< another for another node
    std::unique_ptr<Aside> reader, checker;

    // What helps
    CompletionList list;
    Renaming renaming;
    std::optional<Spot> hovered;  ///< under the mouse,
    double hoveredFrom = 0.0;     ///< since then: seconds of now()

    std::optional<std::pair<int, int>> wantedPlace;  ///< line and column, 1-based, that the cursor goes to

    // Where it is shown
    float height = 0.0f;       ///< of the field in the inspector, as it was dragged to; 0: by its lines
    int toggled = 0;           ///< ImGui's frame in which `large` changed
    bool large = false;        ///< in a window over the canvas
    std::string wantedInput;   ///< whose row the inspector shows and marks,
    double wantedUntil = 0.0;  ///< until then
    bool wantedScroll = false;

    bool edits(std::string_view scope_, std::string_view node_) const {
        return scope == scope_ && node == node_;
    }
};

/// Whether what is typed is another code than the node's.
bool pending(const CodeEditor& editor);
/// What is typed becomes the node's code, as one step of undo. Whether there was anything to be applied; a
/// node that is gone takes its text along.
bool commit(Editor& editor);
/// What is typed is the node's code again. It can be undone in the text.
void discard(Editor& editor);

/// Takes up the code of the node, after commit() of another.
void takeUp(Editor& editor, const NodeBox& box);
/// After each change of the text or the document: asks for what is not known.
void keepUp(Editor& editor, const NodeBox& box);
/// Called once a frame: what is not shown any more is applied.
void finish(Editor& editor);
/// Seconds until the next frame is wanted though nothing happens; infinite if none is.
double nextFrame(const Editor& editor);

/// The widget with all that helps, so large, in ImGui's current window.
void showField(Editor& editor, const NodeBox& box, ImVec2 size);

// Parts of showField(), in code_assist.cpp and code_names.cpp.

/// Keys of the list, before the text hears them. Whether the list takes them from the text.
bool steerList(CodeEditor& editor);
/// Opens, follows or closes the list.
void followList(CodeEditor& editor, const Heard& heard);
void showList(Editor& editor, const Heard& heard);
void showSignature(Editor& editor, const Heard& heard);
void showHover(Editor& editor, const Heard& heard);
/// To where the name at the cursor is defined.
void goToDefinition(Editor& editor);
/// Another name for what is at the cursor.
void beginRename(Editor& editor);
void showRename(Editor& editor, const Heard& heard);

// Shown by others.

/// Shows the node of a finding, and in its code the place of the finding.
void goToFinding(Editor& editor, const Error& finding);

/// The field with its heading in the inspector.
void showInInspector(Editor& editor, const NodeBox& box);
/// What is wrong with the code, each with its place; a click goes there.
void showMessages(Editor& editor);
/// The large window, while it is open.
void showWindow(Editor& editor);
/// Opens or closes it, for the active node.
void toggleWindow(Editor& editor);
/// Marks the row of an input that was asked for, with this area.
void markRow(Editor& editor, std::string_view input, ImVec2 lo, ImVec2 hi);

}  // namespace fw::editor::code
