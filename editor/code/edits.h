// What keys do to a text (text.h): moves, and edits that are a step of undo each. Functions of the value
// alone.
#pragma once

#include <optional>

#include "editor/code/text.h"

namespace fw::editor::code {

enum class Move : unsigned char {
    left,
    right,
    up,
    down,
    wordLeft,
    wordRight,
    lineStart,  ///< the first character that is no blank; from there the line's very start
    lineEnd,
    pageUp,
    pageDown,
    textStart,
    textEnd,
};
/// Moves the cursor; `page` is how many lines are seen. Without `selecting` what was selected is let go of,
/// and left and right go to its ends.
void move(Text& text, Move by, bool selecting, int page = 1);

/// The word or the signs about a spot; the whole line with its end.
Range wordAt(const Text& text, Spot spot);
Range lineAt(const Text& text, int line);
void select(Text& text, Range range);
void selectAll(Text& text);
/// Letters, digits, '_', and whatever is beyond ASCII.
bool inWord(char c);

/// Typed in place of the selection. A word without a rest of a second is one step. A '}' that is the first
/// of its line goes back by one indentation.
void type(Text& text, std::string_view characters, double seconds);
/// A line's end, and as much indentation as the line has; more behind '{', and between "{" and "}" a line of
/// its own for each.
void breakLine(Text& text);
/// In place of the selection, as one step; tabs become blanks.
void paste(Text& text, std::string_view pasted);
/// The selection is taken out; without one the whole line. What was taken out.
std::string cut(Text& text);
/// The selection, or the line with its end.
std::string copied(const Text& text);

/// The selection, else a character; of indentation up to a multiple of kTabWidth; with `word` a word.
void eraseBack(Text& text, bool word, double seconds);
void eraseForward(Text& text, bool word, double seconds);

/// Tab: blanks to the next multiple of kTabWidth; several selected lines are indented.
void indent(Text& text);
void outdent(Text& text);
/// "// " before the selected lines, or away from before them where all have it.
void toggleComment(Text& text);
/// The selected lines change places with the one above (-1) or below (1).
void moveLines(Text& text, int by);
/// The selection again behind itself; without one the line again below.
void duplicate(Text& text);

/// With a ring around the text's end: the next place of `words` behind the selection, or before it; none if
/// there is none. Capitals matter only where `words` has some.
std::optional<Range> find(const Text& text, std::string_view words, bool backward);
/// All places in these lines.
std::vector<Range> findAll(const Text& text, std::string_view words, int first, int last);

}  // namespace fw::editor::code
