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
    const auto rest = [&] { return code.substr(at); };

    while (true) {
        while (at < code.size() && std::isspace(static_cast<unsigned char>(code[at]))) advance(1);
        if (rest().starts_with("//")) {
            advance(std::min(rest().find('\n'), rest().size()));
            continue;
        }
        if (rest().starts_with("/*")) {
            const std::size_t end = rest().find("*/", 2);
            if (end == std::string_view::npos)
                return codeError(place, "the comment that starts here has no end: add */");
            advance(end + 2);
            continue;
        }
        if (tokens.size() >= kMaxTokens)
            return codeError(place, "the code is longer than " + std::to_string(kMaxTokens) +
                                        " words and symbols: split it over several nodes");

        Token token;
        token.place = place;
        if (at == code.size()) {
            tokens.push_back(token);
            return tokens;
        }
        std::size_t length = 0;
        const char first = code[at];
        if (startsName(first)) {
            token.kind = Token::Kind::name;
            while (at + length < code.size() && continuesName(code[at + length])) ++length;
        } else if (isDigit(first) || (first == '.' && at + 1 < code.size() && isDigit(code[at + 1]))) {
            const auto [end, failure] =
                std::from_chars(code.data() + at, code.data() + code.size(), token.value);
            length = end - (code.data() + at);
            const std::string_view digits = code.substr(at, length);
            if (failure != std::errc{} || !std::isfinite(token.value))
                return codeError(place, "the number " + inQuotes(digits) + " is out of range");
            token.kind = digits.find_first_of(".eE") == std::string_view::npos ? Token::Kind::integer
                                                                               : Token::Kind::number;
            if (at + length < code.size() && (code[at + length] == 'f' || code[at + length] == 'F')) {
                token.kind = Token::Kind::number;
                ++length;
            }
            if (at + length < code.size() && continuesName(code[at + length]))
                return codeError(place,
                                 inQuotes(code.substr(at, length + 1)) + " is neither a number nor a name");
        } else if (first == '"') {
            const std::size_t end = code.find('"', at + 1);
            if (end == std::string_view::npos)
                return codeError(place, "the text that starts here has no closing quote");
            token.kind = Token::Kind::string;
            token.text = code.substr(at + 1, end - at - 1);
            length = end + 1 - at;
        } else {
            length = symbolLength(rest());
            if (length == 0)
                return codeError(
                    place, "the character " + inQuotes(wholeCharacter(rest())) + " has no meaning here");
            token.kind = Token::Kind::symbol;
        }
        if (token.kind != Token::Kind::string) token.text = code.substr(at, length);
        tokens.push_back(token);
        advance(length);
    }
}

}  // namespace fw::language
