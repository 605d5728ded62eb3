// What each stretch of a text is, by lines: for colours, brackets, and what is called where.
//
// Lines are cut into pieces by the language's own lexer, once: a change makes anew what it changed, and
// further lines only as far as they begin otherwise (inside a comment, a text) than before. What names mean
// follows from NameUses of a text that may be a few changes old; until they are those of the text itself, a
// name means what it meant elsewhere.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "editor/code/text.h"
#include "graph/language/names.h"

namespace fw::editor::code {

/// What is coloured alike.
enum class Ink : unsigned char {
    plain,  ///< variables, members, signs
    word,
    type,
    constant,  ///< numbers too
    input,
    function,  ///< built in, or of the code
    node,
    string,
    comment,
    unknown,  ///< a name that means nothing
    wrong,    ///< no piece of the language
};

struct Stretch {
    int begin = 0, length = 0;  ///< bytes of the line
    language::Piece::Kind kind = language::Piece::Kind::end;
    Ink ink = Ink::plain;  ///< of what is no name
};

/// Names of one version of a text.
struct NamesOfText {
    uint64_t version = 0;
    language::CodeNames names;
    std::vector<std::size_t> firstOfLine;  ///< index into names.uses, by line from 0; one more at the end
    std::unordered_map<std::string, language::NameUse::Kind> meanings;  ///< of names that the code defines
};
/// Reads the names of a text of this version.
NamesOfText readNames(std::string_view code, uint64_t version, std::vector<std::string> inputs);

class Colouring {
  public:
    /// Catches up with the text. To be called after it was changed, before the rest.
    void follow(const Text& text);
    /// Pieces of a line, spaces left out. Reads what was not read yet of the lines before.
    const std::vector<Stretch>& line(const Text& text, int line);
    /// The ink of the k-th piece of the line.
    Ink ink(const Text& text, int line, std::size_t k, const NamesOfText* names);
    /// Whether the spot is inside of a comment or a text, where nothing means anything.
    bool quiet(const Text& text, Spot spot);

  private:
    enum class State : unsigned char { code, comment, string };
    struct Line {
        bool read = false;
        State begins = State::code, ends = State::code;
        std::vector<Stretch> pieces;
    };
    void read(const std::string& text, State begins, Line& line);

    uint64_t version = 0;
    std::vector<Line> lines;
    int sure = 0;  ///< lines before this one are read, and begin as they should
};

/// The bracket before or behind the cursor and the one that belongs to it, the earlier first; the second is
/// as the first if it has none.
std::optional<std::pair<Spot, Spot>> brackets(const Text& text, Colouring& colouring);

/// The call that a spot stands in the arguments of: the function's name, where that begins, and which
/// argument.
struct CallAt {
    std::string name;
    Spot begin;
    int argument = 0;
};
std::optional<CallAt> callAt(const Text& text, Colouring& colouring, Spot spot);

}  // namespace fw::editor::code
