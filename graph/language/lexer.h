// Text of the field language into tokens.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "graph/base/result.h"

namespace fw::language {

/// 1-based place in a code text.
struct Place {
    int line = 1, column = 1;
};

struct Token {
    enum class Kind : unsigned char { end, name, integer, number, string, symbol } kind = Kind::end;
    std::string_view text;  ///< of a string: without its quotes
    double value = 0.0;     ///< of integer and number
    Place place;

    /// `symbol` has one or two characters, as all have.
    bool is(std::string_view symbol) const {
        return kind == Kind::symbol && text[0] == symbol[0] && text.size() == symbol.size() &&
               text.back() == symbol.back();
    }
    bool isName(std::string_view name) const { return kind == Kind::name && text == name; }
};

/// A stretch of code: a token, what stands between tokens, or what is none.
struct Piece {
    enum class Kind : unsigned char {
        end,
        space,
        comment,
        name,
        integer,
        number,
        string,
        symbol,
        openComment,  ///< without its end; and so the next
        openString,
        outOfRange,   ///< a number that is too large
        neither,      ///< digits that go on as a name
        meaningless,  ///< a character that has no meaning
    } kind = Kind::end;
    std::size_t length = 0;  ///< bytes; what has no end goes to the end of the code
    double value = 0.0;      ///< of integer and number
};

/// The piece of `code` that begins at byte `at`. Of any text: its pieces, one behind the other, are all of
/// it.
Piece pieceAt(std::string_view code, std::size_t at);

inline constexpr std::size_t kMaxTokens = 200'000;

/// The tokens of `code`, the last of kind `end`; they refer into `code`. Comments are // and /* */. The Error
/// names the place inside the code.
Result<std::vector<Token>> tokenize(std::string_view code);

/// An Error at a place inside code.
Error codeError(Place place, std::string message);

}  // namespace fw::language
