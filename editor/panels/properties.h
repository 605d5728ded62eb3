// The panels' two columns of properties: a name on the left, its value on the right. What is dragged is one
// gesture of the document; what is typed reaches it when the field is left.
//
// All in ImGui's current window. Lifetime: nothing here outlives the frame; what must is in PanelState.
#pragma once

#include <span>
#include <string>

#include "editor/document/timeline_edits.h"
#include "editor/editor.h"

namespace fw::editor {

/// What a hand did to a value that was shown.
struct Touched {
    bool changed = false;  ///< in this frame
    bool active = false;   ///< still under the hand
};

/// The graph with these numbers in place of those that it has.
using NumbersEdit = std::function<Graph(const Graph&, std::span<const double>)>;

/// Begins the two columns; false if they are not seen. Only then endProperties() is called.
bool beginProperties(const char* id);
void endProperties();
/// The next row: its name, cut where it does not fit, with `tip` on hover. The value is to follow, as wide as
/// the column less `room` pixels.
void propertyRow(const std::string& name, const std::string& tip = {}, float room = 0.0f);

/// Text as wide as the window, in a colour.
void wrapped(ImU32 color, const std::string& text);

/// Numbers side by side in a panel, `whole` pixels wide, to be reached by mouse and keyboard.
class NumberRow {
  public:
    NumberRow(int count, float whole);

    struct Place {
        Area area;
        bool hovered = false;
        bool byKey = false;  ///< it was chosen to be typed
    };
    /// Of one of them; `typed`: its text field is to stand there.
    Place place(int part, bool typed) const;
    /// The cursor goes on below.
    void end() const;

  private:
    ImVec2 at;
    float whole;
    int count;
};

/// Numbers side by side, as everywhere (controls/number.h). `edit` is kept from frame to frame: it refers to
/// nothing that the frame ends. `input` is "node.input" where it can be live.
void editNumbers(Editor& editor, const char* id, std::span<const double> numbers, const NumberRange& range,
                 const std::string& name, const NumbersEdit& edit, const std::string& input = {},
                 bool animated = false);
/// Numbers that are not the document's. `set` is kept from frame to frame too.
void dragNumbers(Editor& editor, const char* id, std::span<const double> numbers, const NumberRange& range,
                 const std::function<void(std::span<const double>)>& set);
/// A colour in linear sRGB: a button that opens ImGui's picker. What is brighter than white keeps its
/// strength.
Touched pickColor(const char* id, std::span<double> linear);
/// A choice among names; whether another was taken.
bool chooseName(const char* id, std::span<const std::string> names, std::size_t& chosen);

/// Hands on to the document what a hand did to the colour or the key of `id`: a drag is one step of undo.
/// `next` gives the document with the value; `input` is "node.input" where it can be live.
void follow(Editor& editor, const char* id, const Touched& touched, const std::string& name,
            const std::function<Graph()>& next, const std::string& input = {});

/// A line of text. `commit` is called with what was typed when the field is left, if it was changed; Escape
/// takes it back.
void editText(Editor& editor, const char* id, const std::string& text, const char* hint,
              std::function<void(Editor&, const std::string&)> commit);
/// The same for a text of several lines, which ends with Ctrl+Enter.
void editLines(Editor& editor, const char* id, const std::string& text,
               std::function<void(Editor&, const std::string&)> commit);

/// The path of a file: a line of text, and a button that chooses one (pickFile). `room` as in propertyRow().
void editFile(Editor& editor, const char* id, const std::string& path, const FileKind& kind, float room,
              const std::function<void(Editor&, const std::string&)>& commit);

/// A small button with a diamond: filled where there is a key. Whether it was pressed.
bool keyButton(const char* id, bool filled, bool animated, const char* tip);

/// The numbers that a track gives at the time shown, in a frame of their own; a change is a key there.
void editAnimated(Editor& editor, const char* id, const Track& track, const NumberRange& range,
                  const std::string& name, const std::string& input = {});
/// A key of what the track moves at the time shown, of the value that it has there, or of `value` if nothing
/// moves it yet; without the one that is there.
void toggleKey(Editor& editor, const Timeline& timeline, const Moved& moved, std::span<const double> value);

/// Forgets what the document has ended of what was begun in the panels. Once a frame.
void followHands(Editor& editor);

/// The document's timeline, read anew when the document changed; nullptr if it cannot be read.
const Timeline* timelineOf(Editor& editor);

/// "group/node" of a node in the scope shown.
std::string pathOf(const Editor& editor, std::string_view node);

}  // namespace fw::editor
