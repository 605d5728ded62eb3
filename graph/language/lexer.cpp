#include "graph/language/lexer.h"

#include <cctype>
#include <charconv>
#include <cmath>

namespace fw::language {

namespace {

constexpr std::string_view kSymbols = "(){}[],;.?:=<>+-*/%!";
constexpr std::string_view kBeforeEqual = "<>=!+-*/%", kTwice = "&|+-";

/// The length of the symbol at the start of `text`, 0 if there is none.
std::size_t symbolLength(std::string_view text) {
    const auto among = [&](std::string_view list) { return list.find(text[0]) != std::string_view::npos; };
    if (text.size() > 1 && ((text[1] == '=' && among(kBeforeEqual)) || (text[1] == text[0] && among(kTwice))))
        return 2;
    return among(kSymbols) ? 1 : 0;
}

bool startsName(char c) { return std::isalpha(static_cast<unsigned char>(c)) || c == '_'; }
bool continuesName(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }
bool isDigit(char c) { return std::isdigit(static_cast<unsigned char>(c)); }

/// The first character of UTF-8 text.
std::string_view wholeCharacter(std::string_view text) {
    std::size_t length = 1;
    while (length < text.size() && length < 4 && (text[length] & 0xC0) == 0x80) ++length;
    return text.substr(0, length);
}

}  // namespace

Error codeError(Place place, std::string message) {
    return {.message = std::move(message), .codeLine = place.line, .codeColumn = place.column};
}

namespace {

/// Digits, and what follows them at once.
Piece numberAt(std::string_view code, std::size_t at) {
    Piece piece;
    const auto [end, failure] = std::from_chars(code.data() + at, code.data() + code.size(), piece.value);
    piece.length = std::size_t(end - (code.data() + at));
    const std::string_view digits = code.substr(at, piece.length);
    if (failure != std::errc{} || !std::isfinite(piece.value)) {
        piece.kind = Piece::Kind::outOfRange;
        return piece;
    }
    piece.kind =
        digits.find_first_of(".eE") == std::string_view::npos ? Piece::Kind::integer : Piece::Kind::number;
    if (at + piece.length < code.size() &&
        (code[at + piece.length] == 'f' || code[at + piece.length] == 'F')) {
        piece.kind = Piece::Kind::number;
        ++piece.length;
    }
    if (at + piece.length < code.size() && continuesName(code[at + piece.length])) {
        piece.kind = Piece::Kind::neither;
        ++piece.length;
    }
    return piece;
}

/// What the piece, which is no token, keeps the code from being read.
std::string complaint(const Piece& piece, std::string_view text) {
    switch (piece.kind) {
        case Piece::Kind::openComment: return "the comment that starts here has no end: add */";
        case Piece::Kind::openString: return "the text that starts here has no closing quote";
        case Piece::Kind::outOfRange: return "the number " + inQuotes(text) + " is out of range";
        case Piece::Kind::neither: return inQuotes(text) + " is neither a number nor a name";
        default: return "the character " + inQuotes(text) + " has no meaning here";
    }
}

}  // namespace

Piece pieceAt(std::string_view code, std::size_t at) {
    using Kind = Piece::Kind;
    if (at >= code.size()) return {};
    const std::string_view rest = code.substr(at);
    const char first = rest[0];
    std::size_t length = 1;
    if (std::isspace(static_cast<unsigned char>(first))) {
        while (length < rest.size() && std::isspace(static_cast<unsigned char>(rest[length]))) ++length;
        return {Kind::space, length};
    }
    if (rest.starts_with("//")) return {Kind::comment, std::min(rest.find('\n'), rest.size())};
    if (rest.starts_with("/*")) {
        const std::size_t end = rest.find("*/", 2);
        if (end == std::string_view::npos) return {Kind::openComment, rest.size()};
        return {Kind::comment, end + 2};
    }
    if (startsName(first)) {
        while (length < rest.size() && continuesName(rest[length])) ++length;
        return {Kind::name, length};
    }
    if (isDigit(first) || (first == '.' && rest.size() > 1 && isDigit(rest[1]))) return numberAt(code, at);
    if (first == '"') {
        const std::size_t end = rest.find('"', 1);
        if (end == std::string_view::npos) return {Kind::openString, rest.size()};
        return {Kind::string, end + 1};
    }
    length = symbolLength(rest);
    if (length == 0) return {Kind::meaningless, wholeCharacter(rest).size()};
    return {Kind::symbol, length};
}

Result<std::vector<Token>> tokenize(std::string_view code) {
    std::vector<Token> tokens;
    tokens.reserve(std::min(code.size() / 2 + 1, kMaxTokens + 1));
    Place place;
    std::size_t at = 0;
    const auto advance = [&](std::size_t count) {
        for (; count > 0 && at < code.size(); --count, ++at) {
            if (code[at] == '\n')
                ++place.line, place.column = 1;
            else if ((code[at] & 0xC0) != 0x80)  // a UTF-8 continuation byte is no column of its own
                ++place.column;
        }
    };
    while (true) {
        const Piece piece = pieceAt(code, at);
        const std::string_view text = code.substr(at, piece.length);
        Token token;
        token.place = place;
        token.value = piece.value;
        switch (piece.kind) {
            case Piece::Kind::space:
            case Piece::Kind::comment: advance(piece.length); continue;
            case Piece::Kind::openComment: return codeError(place, complaint(piece, text));
            default: break;
        }
        if (tokens.size() >= kMaxTokens)
            return codeError(place, "the code is longer than " + std::to_string(kMaxTokens) +
                                        " words and symbols: split it over several nodes");
        switch (piece.kind) {
            case Piece::Kind::end: tokens.push_back(token); return tokens;
            case Piece::Kind::name: token.kind = Token::Kind::name; break;
            case Piece::Kind::integer: token.kind = Token::Kind::integer; break;
            case Piece::Kind::number: token.kind = Token::Kind::number; break;
            case Piece::Kind::string: token.kind = Token::Kind::string; break;
            case Piece::Kind::symbol: token.kind = Token::Kind::symbol; break;
            default: return codeError(place, complaint(piece, text));
        }
        token.text = token.kind == Token::Kind::string ? text.substr(1, text.size() - 2) : text;
        tokens.push_back(token);
        advance(piece.length);
    }
}

}  // namespace fw::language
