#include "graph/document/json_tokens.h"

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>

namespace fw {

namespace {

using Kind = JsonToken::Kind;

constexpr const char* kNotANumber =
    "this is not a number as JSON writes it: no '+', no leading zeros, digits on both sides of the point";

bool isSpace(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

/// Receives nlohmann's SAX events (their names are his) and follows them through the text.
class Follower {
  public:
    Follower(std::string_view fileText, const std::string& filePath, const JsonText& read)
        : text(fileText), path(filePath), what(read.what) {
        if (text.starts_with("\xEF\xBB\xBF")) offset = 3;
        tokens.list.reserve(std::min(text.size() / 8, kMaxJsonValues));
    }

    bool null() { return scalar(Kind::null, 4); }
    bool boolean(bool value) { return scalar(Kind::boolean, value ? 4 : 5); }
    bool number_integer(int64_t) { return number(); }
    bool number_unsigned(uint64_t) { return number(); }
    bool number_float(double, const std::string&) { return number(); }
    bool binary(Json::binary_t&) { return false; }

    bool string(std::string& value) { return quotedToken(Kind::string, value); }
    bool key(std::string& value) { return quotedToken(Kind::key, value); }

    bool start_object(std::size_t) { return start(Kind::object); }
    bool start_array(std::size_t) { return start(Kind::array); }
    bool end_array() { return end(); }
    bool end_object() {
        const uint32_t object = open.back().token;
        return end() && keysAreUnique(object);
    }

    bool parse_error(std::size_t position, const std::string&, const nlohmann::detail::exception& exception) {
        return syntaxError(position, exception);
    }

    /// Counts lines and columns up to this offset. A column is a character, not a byte.
    void advanceTo(std::size_t target) {
        for (; offset < std::min(target, text.size()); ++offset) {
            if (text[offset] == '\n')
                ++at.line, at.column = 1;
            else if ((text[offset] & 0xC0) != 0x80)
                ++at.column;
        }
    }

    bool fail(TextPosition where, std::string message) {
        error.message = std::move(message);
        error.file = path;
        error.line = where.line;
        error.column = where.column;
        return false;
    }

    JsonTokens tokens;
    Error error;
    TextPosition at{1, 1};

  private:
    struct Open {
        uint32_t token;    ///< the array or object
        uint32_t key = 0;  ///< the key whose value is being read; 0 if none
    };

    bool inObject() const { return !open.empty() && tokens.list[open.back().token].kind == Kind::object; }

    bool add(Kind kind, std::size_t length, std::string_view content) {
        if (tokens.list.size() >= kMaxJsonValues)
            return fail(at, "the " + what + " holds more than " + std::to_string(kMaxJsonValues) +
                                " keys and values: split the graph or move data out of it");
        tokens.list.push_back({kind, static_cast<uint32_t>(tokens.list.size() + 1), content, at});
        advanceTo(offset + length);
        return true;
    }

    void skipToToken() {
        std::size_t i = offset;
        while (i < text.size() && (isSpace(text[i]) || text[i] == ':' || text[i] == ',')) ++i;
        advanceTo(i);
    }

    /// A value is complete: the key before it, if any, ends with it too.
    bool valueDone() {
        if (inObject()) {
            tokens.list[open.back().key].next = static_cast<uint32_t>(tokens.list.size());
            open.back().key = 0;
        }
        return true;
    }

    bool scalar(Kind kind, std::size_t length) {
        skipToToken();
        return add(kind, length, text.substr(offset, length)) && valueDone();
    }

    bool number() {
        skipToToken();
        std::size_t last = text.find_first_not_of("+-.0123456789eE", offset);
        if (last == std::string_view::npos) last = text.size();
        // nlohmann ends 01 after the 0 and 1.2.3 after the 2, and only then stumbles over the rest.
        const std::string_view digits = text.substr(offset, last - offset);
        const std::string_view whole = digits.substr(digits.front() == '-' ? 1 : 0);
        double value = 0;
        const bool zeros = whole.size() > 1 && whole[0] == '0' && whole[1] >= '0' && whole[1] <= '9';
        if (zeros || std::from_chars(digits.begin(), digits.end(), value).ptr != digits.end())
            return fail(at, kNotANumber);
        return scalar(Kind::number, last - offset);
    }

    bool quotedToken(Kind kind, std::string& value) {
        skipToToken();
        std::size_t last = offset + 1;
        bool escaped = false;
        for (; text[last] != '"'; ++last)
            if (text[last] == '\\') escaped = true, ++last;
        const std::string_view content = escaped ? tokens.unescaped.emplace_back(std::move(value))
                                                 : text.substr(offset + 1, last - offset - 1);
        if (kind == Kind::key) open.back().key = static_cast<uint32_t>(tokens.list.size());
        return add(kind, last + 1 - offset, content) && (kind == Kind::key || valueDone());
    }

    bool start(Kind kind) {
        skipToToken();
        if (open.size() >= static_cast<std::size_t>(kMaxNesting))
            return fail(at, "arrays and objects are nested deeper than " + std::to_string(kMaxNesting) +
                                " levels: flatten the value");
        open.push_back({static_cast<uint32_t>(tokens.list.size())});
        return add(kind, 1, {});
    }

    bool end() {
        skipToToken();
        advanceTo(offset + 1);
        tokens.list[open.back().token].next = static_cast<uint32_t>(tokens.list.size());
        open.pop_back();
        return valueDone();
    }

    bool keysAreUnique(uint32_t object) {
        const auto& list = tokens.list;
        std::vector<uint32_t> keys;
        for (uint32_t i = object + 1; i < list[object].next; i = list[i].next) keys.push_back(i);
        std::stable_sort(keys.begin(), keys.end(),
                         [&](uint32_t a, uint32_t b) { return list[a].text < list[b].text; });
        uint32_t first = 0, second = 0;
        for (std::size_t i = 1; i < keys.size(); ++i)
            if (list[keys[i - 1]].text == list[keys[i]].text && (second == 0 || keys[i] < second))
                first = keys[i - 1], second = keys[i];
        if (second == 0) return true;
        return fail(list[second].at, "the key " + inQuotes(list[second].text) +
                                         " stands twice in this object, first in line " +
                                         std::to_string(list[first].at.line) + ": remove one of them");
    }

    void skipSpace() {
        std::size_t i = offset;
        while (i < text.size() && isSpace(text[i])) ++i;
        advanceTo(i);
    }

    /// Names what is wrong by the grammar: nlohmann tells where he stopped, but in terms of his token
    /// classes.
    bool syntaxError(std::size_t position, const nlohmann::detail::exception& exception) {
        skipSpace();
        bool comma = false, valueNext = true;
        if (tokens.list.empty()) {
            if (offset == text.size()) return fail(at, "the " + what + " is empty: a graph is a JSON object");
        } else if (open.empty()) {
            return fail(at, "text after the end of the " + what + "'s object: remove it");
        } else {
            const JsonToken& parent = tokens.list[open.back().token];
            const bool object = parent.kind == Kind::object;
            const bool first = open.back().token + 1 == tokens.list.size();
            const char closing = object ? '}' : ']';
            if (open.back().key != 0) {
                if (offset < text.size() && text[offset] != ':')
                    return fail(at, "expected ':' between a key and its value");
                advanceTo(offset + 1);
            } else {
                if (!first && offset < text.size()) {
                    comma = text[offset] == ',';
                    if (!comma) return fail(at, std::string("expected ',' or '") + closing + "'");
                    advanceTo(offset + 1);
                }
                valueNext = !object;
            }
            skipSpace();
            if (offset == text.size())
                return fail(at, "the " + what + " ends before the " +
                                    std::string(object ? "object" : "array") + " that begins at " +
                                    std::to_string(parent.at.line) + ":" + std::to_string(parent.at.column) +
                                    " is closed: it is cut off, or a '" + closing + "' is missing");
            if (comma && (text[offset] == closing))
                return fail(
                    at, std::string("a comma stands before the closing '") + closing + "': remove the comma");
        }
        return fail(at, badToken(position, exception, valueNext));
    }

    /// What is wrong with the token at the cursor, where a value or a key was expected. Moves to the exact
    /// place.
    std::string badToken(std::size_t position, const nlohmann::detail::exception& exception, bool valueNext) {
        const std::string_view rest = text.substr(offset, 12);
        if (rest.starts_with('"') && position > 0) {
            const std::string_view said = exception.what();
            const std::size_t begin = said.find("invalid string: ");
            const std::size_t end = said.find("; last read", begin == std::string_view::npos ? 0 : begin);
            if (begin != std::string_view::npos) {
                if (position > text.size() || said.find("missing closing quote", begin) < end)
                    return "the " + what +
                           " ends inside the string that begins here: it is cut off, or a '\"' is missing";
                advanceTo(position - 1);
                return "in a string: " + std::string(said.substr(begin + 16, end - begin - 16));
            }
        }
        if (exception.id == 406)
            return "the number is beyond the range of double (about 1.8e308): write a smaller one";
        if (rest.starts_with("//") || rest.starts_with("/*") || rest.starts_with('#'))
            return "JSON has no comments: use a node of type 'frame', or remove it";
        if (rest.starts_with('\'')) return "JSON quotes with \", not with '";
        if (!valueNext) return "expected a key in double quotes";
        std::string word;
        for (const char c : rest.substr(rest.find_first_not_of("+-") == 1 ? 1 : 0)) {
            const char lower = static_cast<char>(c | 0x20);
            if (lower < 'a' || lower > 'z') break;
            word += lower;
        }
        if (word == "nan" || word == "inf" || word == "infinity")
            return "JSON has no NaN and no infinity: write a finite number";
        if (!word.empty() &&
            (std::string_view("true").starts_with(word) || std::string_view("false").starts_with(word) ||
             std::string_view("null").starts_with(word)))
            return "expected true, false or null, in small letters";
        if (std::string_view("+-.0123456789").find(rest.front()) != std::string_view::npos)
            return "this is not a number as JSON writes it: no '+', no leading zeros, a digit on both sides "
                   "of '.'";
        return "expected a value: a number, a string in double quotes, true, false, null, [ or {";
    }

    std::string_view text;
    const std::string& path;
    const std::string& what;
    std::size_t offset = 0;
    std::vector<Open> open;
};

}  // namespace

std::size_t firstBadByte(std::string_view text) {
    const auto byte = [&](std::size_t i) {
        return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u;
    };
    for (std::size_t i = 0; i < text.size();) {
        const unsigned lead = byte(i);
        if (lead == 0) return i;
        const int length = lead < 0x80 ? 1 : lead >= 0xC2 && lead < 0xE0 ? 2 : (lead & 0xF0) == 0xE0 ? 3 : 4;
        if (length == 4 && (lead < 0xF0 || lead > 0xF4)) return i;
        for (int k = 1; k < length; ++k)
            if ((byte(i + k) & 0xC0) != 0x80) return i;
        // Overlong forms, surrogates and what lies beyond U+10FFFF, told by the second byte.
        const unsigned second = byte(i + 1);
        if ((lead == 0xE0 && second < 0xA0) || (lead == 0xED && second >= 0xA0) ||
            (lead == 0xF0 && second < 0x90) || (lead == 0xF4 && second >= 0x90))
            return i;
        i += length;
    }
    return std::string_view::npos;
}

Result<JsonTokens> tokenize(std::string_view text, const std::string& path, const JsonText& as) {
    Follower follower(text, path, as);
    if (text.size() > as.most) {
        follower.fail({}, "the " + as.what + " is larger than " + std::to_string(as.most >> 20) +
                              " MiB: split the graph or move data out of it");
        return follower.error;
    }
    if (const std::size_t bad = firstBadByte(text); bad != std::string_view::npos) {
        follower.advanceTo(bad);
        follower.fail(follower.at, text[bad] == 0
                                       ? "a NUL byte: this is not a text"
                                       : "the " + as.what + " is not UTF-8: write it in that encoding");
        return follower.error;
    }
    if (!Json::sax_parse(text.data(), text.data() + text.size(), &follower)) return follower.error;
    return std::move(follower.tokens);
}

double numberOf(const JsonToken& token) {
    double value = 0;
    std::from_chars(token.text.data(), token.text.data() + token.text.size(), value);
    return value;
}

Json toJson(const JsonTokens& tokens, uint32_t index) {
    const auto& list = tokens.list;
    const JsonToken& token = list[index];
    switch (token.kind) {
        case Kind::null:
        case Kind::key: return nullptr;
        case Kind::boolean: return token.text == "true";
        case Kind::string: return std::string(token.text);
        case Kind::number: {
            const char *begin = token.text.data(), *end = begin + token.text.size();
            if (token.text == "-0") return -0.0;
            const auto whole = [end](std::from_chars_result result) {
                return result.ptr == end && result.ec == std::errc();
            };
            if (int64_t value = 0; whole(std::from_chars(begin, end, value))) return value;
            if (uint64_t value = 0; whole(std::from_chars(begin, end, value))) return value;
            return numberOf(token);
        }
        case Kind::array: {
            Json array = Json::array();
            for (uint32_t i = index + 1; i < token.next; i = list[i].next) array.push_back(toJson(tokens, i));
            return array;
        }
        case Kind::object: {
            // Filled as the vector that it is: the map's own insertion searches linearly, and keys are unique
            // already.
            Json object = Json::object();
            auto& members = object.get_ref<Json::object_t&>();
            std::size_t count = 0;
            for (uint32_t i = index + 1; i < token.next; i = list[i].next) ++count;
            members.reserve(count);
            for (uint32_t i = index + 1; i < token.next; i = list[i].next)
                members.emplace_back(std::string(list[i].text), toJson(tokens, i + 1));
            return object;
        }
    }
    return nullptr;
}

}  // namespace fw
