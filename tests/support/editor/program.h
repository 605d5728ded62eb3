// The real editor in a real window, for tests from end to end: keys and mouse by xdotool, places by what can
// be known from outside.
//
// Words are found where they are seen (reader.h). Nodes, sockets and fields are where canvas/boxes.h puts
// those of the saved file, once frameAll() has made known where the canvas looks. Input is sent without
// rests, for the editor has to keep up by itself; what it did is waited for, as long as it takes: a title, a
// file written anew, words on the screen. save() is also the way to wait for all input before it.
//
// Lifetime: one Program on one VirtualDisplay at a time; kill() and start() again go on with the same
// folders.
#pragma once

#include <sys/types.h>

#include <functional>
#include <string>
#include <vector>

#include "editor/canvas/boxes.h"
#include "tests/support/editor/reader.h"
#include "tests/support/golden.h"
#include "tests/support/graph/temp_dir.h"
#include "tests/support/virtual_display.h"

namespace fw::editor::test {

/// What a person has done with hands: a double click is two clicks, a drag one whatever its way, a key one
/// with all that is held with it. The wheel and mere ways of the mouse count nothing.
struct Effort {
    int clicks = 0, drags = 0, keys = 0;
    int all() const { return clicks + drags + keys; }
    bool operator==(const Effort&) const = default;
};

class Program {
  public:
    /// With a document of this text, or with the empty document if there is none; the picture has this share
    /// of the window's height, and with the panels this share of its width: a software device is the quicker
    /// the less it is. Check works() first.
    explicit Program(const std::string& text = R"({"fieldwright": 1, "nodes": []})", float picture = kUsual,
                     float side = kUsualSide);
    static constexpr float kUsual = 0.55f, kLittle = 0.2f, kUsualSide = 0.36f;
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;
    /// Ends the editor. If the test has failed, a picture of the screen lies beside the test program.
    ~Program();
    /// Whether there are an X server and xdotool.
    bool works() const { return usable; }

    void start(const std::vector<std::string>& arguments);
    void kill();
    /// The exit status, once it has ended by itself; -1 if it did not.
    int waitForEnd();
    /// Of the document it was started with.
    const std::string& file() const { return document; }
    std::string path(const std::string& name) const { return folder.path(name); }

    // Input; several at once reach the window as one stream of events.
    void keys(const std::string& shortcut, int times = 1);  ///< as in the table of commands: "Ctrl+Shift+Z"
    void type(const std::string& text);                     ///< with "\n" as Enter
    void moveTo(ImVec2 to);
    void click(ImVec2 at, int button = 1, const std::string& held = {});  ///< held: "ctrl", "shift", "alt"
    void doubleClick(ImVec2 at);
    /// Through all the places; with `watched`, at each of them until something is seen there; with `held`
    /// keys
    /// ("ctrl") down. It is let go of at the last place if `ends`.
    void drag(const std::vector<ImVec2>& through, int button = 1, const std::string& held = {},
              bool watched = false, bool ends = true);
    void release(int button = 1);
    /// A file from another program, dropped at this place.
    void drop(const std::string& path, ImVec2 at);
    void wheel(ImVec2 at, int notches);  ///< up if positive
    void send(const std::string& xdotoolWords);
    /// All of it so far, but for what save() and frameAll() press for the test's own eyes.
    Effort effort;

    // What is seen.
    Picture screen() const { return display.screen(); }
    Picture screen(const Area& part) const;
    /// Where the picture ends, in pixels from the top.
    float pictureEnd() const { return 800.0f * share; }
    bool sees(const std::string& words, const std::optional<Area>& within = std::nullopt);
    /// Waits for the words; a failure if they do not come.
    Area waitFor(const std::string& words, const std::optional<Area>& within = std::nullopt);
    /// The same of a word of code.
    Area waitForCode(const std::string& word, const std::optional<Area>& within = std::nullopt);
    void waitUntilGone(const std::string& words);
    void clickOn(const std::string& words, const std::optional<Area>& within = std::nullopt);
    std::string title() const;
    void waitForTitle(const std::string& title);
    /// Waits until this part of the screen looks as the kept picture does.
    void expectGolden(const std::string& name, const Area& part);
    /// Waits until it is another picture than this one; a failure if it stays.
    void waitForChange(const Picture& before, const Area& part);

    // The document.
    std::string save();    ///< Ctrl+S, and the file's bytes
    const Graph& saved();  ///< the same, read
    /// Opens this file in place of the document, which has no unsaved changes; by what is typed, if that is
    /// not its path.
    void open(const std::string& path, const std::string& typed = {});
    const Graph& graph() const { return known; }
    void clipboard(const std::string& text);
    std::string clipboard() const;

    // Places on the canvas, of the document as it was last saved.
    CanvasView view;          ///< as it is known to be
    std::string scope;        ///< the group shown
    void frameAll();          ///< Home
    void zoom(int notches);   ///< by the wheel, in the middle
    void pan(ImVec2 pixels);  ///< by the middle button
    ImVec2 title(const std::string& node) const;
    ImVec2 input(const std::string& node, const std::string& name) const;
    ImVec2 output(const std::string& node) const;
    ImVec2 field(const std::string& node, const std::string& name, int component = 0) const;
    ImVec2 nowhere() const;  ///< a place of the canvas without anything
    /// Adds a node by the menu at this place of the canvas, saves, and returns its id.
    std::string add(const std::string& search, ImVec2 at);
    /// Clicks the number, types the text and Enter.
    void set(const std::string& node, const std::string& name, int component, const std::string& text);

    Reader reader;

  private:
    /// eventually(), with a picture of the screen beside the test program if it is not to be.
    bool waitUntil(const std::function<bool()>& condition);
    void keepScreen();  ///< once a test: as it was when it first failed
    void read();
    void findPanel();
    Area waitForWords(const std::string& words, const std::optional<Area>& within, Reader::Face face);
    /// This part of the screen, or all of it, as it is now.
    void look(Picture& into, const std::optional<Area>& part) const;

    fw::test::VirtualDisplay display{1280, 800};
    fw::test::TempDir folder;
    std::string document;
    float share;  ///< of the window's height that the picture has
    bool usable = false, kept = false;
    pid_t process = -1;
    std::string window;  ///< its X id
    Graph known;
};

/// Waits until it is true, for a long time; whether it became true.
bool eventually(const std::function<bool()>& condition);

}  // namespace fw::editor::test
