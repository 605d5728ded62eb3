// The document's file: new, open, save, and the questions that come with them.
//
// What is opened comes before what is there, which stays open behind it (tabs.h). What would lose changes
// waits for an answer. A file of which a part cannot be read opens with the rest, and is not replaced without
// being asked for, nor without what it held being kept beside it. What another program does to the file is
// noticed. A copy of unsaved changes is kept meanwhile (recovery.h); copies that a crash left are offered at
// the start. Lifetime: part of the Editor.
#pragma once

#include <functional>
#include <optional>

#include "editor/files/assets.h"
#include "editor/files/browser.h"
#include "editor/files/drop.h"
#include "editor/files/group_links.h"
#include "editor/files/missing_files.h"
#include "editor/files/preferences.h"
#include "editor/files/recovery.h"
#include "editor/files/samples.h"
#include "editor/files/versions.h"
#include "editor/files/watch.h"

namespace fw::editor {

struct Editor;

/// Words in a window of their own, until they are read.
struct Message {
    std::string title;  ///< empty: none
    std::string text;
    std::vector<Error> problems = {};
    bool opening = true;
};

/// A file that is being chosen for something in the document.
struct FilePick {
    FileBrowser browser = {};
    const FileKind* kind = nullptr;  ///< null: none is
    std::function<void(Editor&, const std::string& path)> take = {};
};

/// How a document and its file stand, while it is open.
struct DocumentFile {
    /// What saving does to the file that the document was read from.
    enum class Origin : unsigned char {
        own,     ///< replaces it
        sample,  ///< nothing: the document is a copy, whose pictures lie beside the original
        partly,  ///< asks: it holds what could not be read
    } origin = Origin::own;
    std::vector<Error> found;  ///< when the file was read
    FileWatch watch;
    std::optional<std::string>
        outside;  ///< what another program wrote, while it is asked what to do about it
    /// The same, once the answer was none: saving asks about it again.
    std::optional<std::string> undecided = {};
    std::string waits;  ///< where to save once that is answered; empty: nowhere
    /// The file holds what undo cannot give back: saving keeps it as a version, however old the last one is.
    bool keepsNext = false;
    bool givenUp = false;  ///< its changes, if the editor ends now
    Recovery recovery;
};

/// All about files: of the document in front, and of the editor.
struct Files : DocumentFile {
    /// What is to happen once the changes are saved or given up.
    enum class Next : unsigned char { none, drop, close, quit } next = Next::none;
    DroppedFiles dropped;     ///< of Next::drop
    bool asks = false;        ///< the question about changes is to be opened
    bool asksExport = false;  ///< the question about an export that goes on is to be opened
    bool asksPartly = false;  ///< that question is to be opened
    AssetWatch assets;
    GroupLinks groups;
    std::string linking = {};  ///< the group for which `linkBrowser` asks where it is to be written
    FileBrowser linkBrowser;
    MissingFilesDialog missing;
    std::string copied, copiedFrom;  ///< the last text that was copied here, and the file of its graph
    Message message;
    FileBrowser browser;
    FilePick pick;
    Samples samples;
    Preferences preferences;
    std::vector<LeftCopy> left;          ///< of crashes, not yet decided on
    bool offers = false;                 ///< these are shown
    std::vector<Version> versions = {};  ///< of the document's file, while they are shown
    bool asksVersions = false;           ///< these are to be opened
    std::string title;                   ///< that the window has
    std::string failureTold;             ///< of the preview, last
};

/// Reads preferences, looks for copies that were left, and opens the file, if there is a path. One that does
/// not exist yet is made by saving.
void startFiles(Editor& editor, const std::string& path = {});
/// One frame: browser, gallery, questions, offer; the window's title.
void showFiles(Editor& editor);
/// Looks for what happened to the file outside. Whether there is something to show.
bool watchFile(Editor& editor, FileWatch::Clock::time_point now = FileWatch::Clock::now());
/// Takes the text to the clipboard, or from there, with the files that its nodes name brought to the
/// document.
void copyText(Editor& editor, std::string text);
std::string pastedText(Editor& editor);
/// The recent files as entries of ImGui's current menu.
void showRecent(Editor& editor);

/// Asks for a file of this kind, in place of `now`, if that is one; `take` gets its path from the document's
/// folder on, to which it is brought if need be. A document without a file has to be saved first.
void pickFile(Editor& editor, const FileKind& kind, const std::string& now,
              std::function<void(Editor&, const std::string& path)> take);

/// Does it, after a question if changes would be lost.
void proceed(Editor& editor, Files::Next next);
void newDocument(Editor& editor);
void askForFile(Editor& editor);
/// Shows the file before the document, or where it is open; a message where that cannot be, which leaves the
/// document.
void openFile(Editor& editor, const std::string& path);
/// Saves the preferences, or says why that cannot be.
void keepPreferences(Editor& editor);
/// Opens the list of what the document's file held before it was saved over.
void offerVersions(Editor& editor);
/// To the document's file; asks for one if it has none. Whether the file was written.
bool save(Editor& editor);
void saveAs(Editor& editor);

/// Keeps what is unsaved for the next start, as nothing may be done any more. What to tell the user of that;
/// empty if nothing was unsaved.
std::string keepForNextTime(Editor& editor);

// For files.cpp and file_dialogs.cpp alone:
/// The document before what there was, with nothing selected.
void take(Editor& editor, Graph graph);
/// What the document is called: its file's name, or "untitled".
std::string nameOf(const Editor& editor);
std::string nameOf(const Graph& graph, DocumentFile::Origin origin);
/// What files of it are called, but for their endings.
std::string stemOf(const Editor& editor);
/// Whether an export or a picture is under way, which ends with the program.
bool makesFiles(const Editor& editor);
/// Where new files go: the folder of the document's own file, else the one last looked into, or worked in.
std::string workFolder(const Editor& editor);
bool writeFile(Editor& editor, const std::string& path);
/// The same, but for what another program has written there since: then it is asked about, and the answer
/// may save. Whether the file was written.
bool saveTo(Editor& editor, const std::string& path);
/// The step that waited; nothing is lost any more.
void doNext(Editor& editor);
/// The text in place of the document, as one step of undo.
void reload(Editor& editor, const std::string& text);
/// The version in place of the document, as one step of undo.
void restore(Editor& editor, const Version& version);
void restore(Editor& editor, const LeftCopy& copy);
void showFileDialogs(Editor& editor);

}  // namespace fw::editor
