// The editor: all that a person has before them, as one plain struct, and one frame of the interface.
//
// The document is the truth. What is drawn of it (boxes), found in it (findings) and made of it (the picture)
// is made anew from its snapshots: boxes at once, the rest by the preview's thread. Panels are functions on
// the Editor, one file each under panels/; every command is one row of commands.h.
//
// Lifetime: one Editor on one Shell, which outlives it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "editor/canvas/canvas.h"
#include "editor/canvas/thumbnails.h"
#include "editor/code/code_editor.h"
#include "editor/document/document.h"
#include "editor/files/files.h"
#include "editor/files/tabs.h"
#include "editor/keymap.h"
#include "editor/outline/window.h"
#include "editor/panels/export_dialog.h"
#include "editor/panels/library.h"
#include "editor/panels/panel_state.h"
#include "editor/panels/render_dialog.h"
#include "editor/panels/windows.h"
#include "editor/preview/preview.h"
#include "editor/probe/probe.h"
#include "editor/viewport/viewport.h"

namespace fw::editor {

/// The menu to add nodes from, where it is open.
struct AddMenu {
    CanvasWishes::Add wish;
    char search[64] = {};
    int chosen = 0;
    bool opened = false;  ///< to be opened in this frame
};

/// The menu of a comment frame, where it is open.
struct FrameMenu {
    std::size_t index = 0;  ///< in framesOf()
    bool opened = false;    ///< to be opened in this frame
};

inline constexpr float kLeastPart = 0.15f, kMostPart = 0.8f;  ///< of a whole that a splitter divides

/// Where the keyboard can be.
enum class Part : unsigned char { canvas, viewport, side, timeline };

struct Panels {
    bool inspector = true, outliner = true, problems = true, parameters = true, scene = true,
         timeline = false, statistics = false, history = false, library = false, probe = false;
    float side = 0.36f;             ///< of the window's width, for viewport and inspector
    float top = 0.55f;              ///< of its height, for the viewport
    float low = 0.25f;              ///< of the window's height, for the timeline
    std::string front = {};         ///< id of the side panel in front
    std::string wanted = {};        ///< id of the one to come to the front
    Part keyboard = Part::canvas;   ///< what has the keyboard
    std::optional<Part> next = {};  ///< what gets it in this frame
    bool mouseOnCanvas = false;
};

struct Editor {
    Editor(Shell& shell, Graph graph, DeviceOptions device);

    Shell& shell;
    DeviceOptions device;  ///< that makes meshes
    Document document;
    Canvas canvas;
    Viewport viewport;
    Probe probe;
    AddMenu add;
    FrameMenu frameMenu;
    Panels panels;
    PanelState panelState;
    Windows windows;
    code::CodeEditor code;
    Keymap keymap;             ///< of files.preferences
    std::string notice;        ///< the last thing that could not be done, in the status line
    double noticeUntil = 0.0;  ///< seconds of ImGui's clock
    bool quit = false;
    Files files;
    Tabs tabs;
    ExportDialog exporting;
    RenderDialog rendering;
    LibraryPanel library;
    outline::Window outline;

    /// The document as it is drawn: of revision `drawn`.
    std::shared_ptr<const Graph> graph;
    uint64_t drawn = 0;
    std::optional<Boxes> boxes;
    Preview preview;
    Thumbnails thumbnails;
};

/// Takes what the preview made, and hands it the newest wish. Whether there is anything new to show.
bool exchange(Editor& editor);
/// One frame of the whole interface.
void showEditor(Editor& editor);
/// Whether frames should follow each other without waiting for input: something moves.
bool moves(const Editor& editor);

/// One step of undo with the result selected.
void apply(Editor& editor, std::string name, Edited edited);
/// Says something in the status line for some seconds.
void say(Editor& editor, std::string words);
/// What there is to say about the nodes of the scope shown.
CanvasMarks marksOf(Editor& editor);
/// How far the distance of the surface that a node of the scope gives can be trusted, in the first of its
/// instances; nullptr if that is not known.
const NodeExactness* exactnessOf(const Editor& editor, const std::string& id);
/// Shows the nodes of a group, or those of the document for an empty id.
void enter(Editor& editor, std::string scope);
/// The viewport shows the node's own field, or the output again if it did already.
void pin(Editor& editor, const std::string& id);
/// The same of all that are selected, together; those that make no surface are left out. Of one, that one.
void pinSelected(Editor& editor);
/// Shows the node: enters its scope, selects and frames it. `path` as in Error::node: "group/node".
void reveal(Editor& editor, std::string_view path);

// panels/, viewport/ and probe/, each in the rest of ImGui's current window
void showAddMenu(Editor& editor);
void showFrameMenu(Editor& editor);
void showInspector(Editor& editor);
void showOutliner(Editor& editor);
void showProblems(Editor& editor);
void showParameters(Editor& editor);
void showScene(Editor& editor);
void showTimeline(Editor& editor);
void showViewport(Editor& editor);
void showStatistics(Editor& editor);
void showHistory(Editor& editor);
void showLibrary(Editor& editor);
void showProbe(Editor& editor);

}  // namespace fw::editor
