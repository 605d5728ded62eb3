#include "editor/code/colouring.h"

#include <algorithm>

namespace fw::editor::code {

namespace {

using Piece = language::Piece;
using NameKind = language::NameUse::Kind;

constexpr int kFarBrackets = 2000;  // lines that a bracket's partner is looked for in
constexpr int kFarCall = 60;        // and the beginning of a call

Ink inkOf(Piece::Kind kind) {
    switch (kind) {
        case Piece::Kind::integer:
        case Piece::Kind::number: return Ink::constant;
        case Piece::Kind::string:
        case Piece::Kind::openString: return Ink::string;
        case Piece::Kind::comment:
        case Piece::Kind::openComment: return Ink::comment;
        case Piece::Kind::outOfRange:
        case Piece::Kind::neither:
        case Piece::Kind::meaningless: return Ink::wrong;
        default: return Ink::plain;
    }
}

Ink inkOf(NameKind kind) {
    switch (kind) {
        case NameKind::word: return Ink::word;
        case NameKind::type: return Ink::type;
        case NameKind::constant: return Ink::constant;
        case NameKind::input: return Ink::input;
        case NameKind::function:
        case NameKind::builtin: return Ink::function;
        case NameKind::node: return Ink::node;
        case NameKind::unknown: return Ink::unknown;
        default: return Ink::plain;
    }
}

char bracketAt(const Text& text, int line, const Stretch& piece) {
    if (piece.kind != Piece::Kind::symbol || piece.length != 1) return 0;
    const char c = text.lines[std::size_t(line)][std::size_t(piece.begin)];
    return std::string_view("(){}[]").find(c) == std::string_view::npos ? char(0) : c;
}

bool opens(char c) { return c == '(' || c == '{' || c == '['; }
char partnerOf(char c) {
    constexpr std::string_view kAll = "(){}[]";
    return kAll[kAll.find(c) ^ 1];
}

}  // namespace

NamesOfText readNames(std::string_view code, uint64_t version, std::vector<std::string> inputs) {
    NamesOfText made;
    made.version = version;
    made.names = language::namesOf(code, std::move(inputs));
    const auto lines = std::size_t(std::ranges::count(code, '\n')) + 1;
    made.firstOfLine.assign(lines + 1, made.names.uses.size());
    for (std::size_t i = made.names.uses.size(); i-- > 0;)
        made.firstOfLine[std::size_t(made.names.uses[i].place.line) - 1] = i;
    for (std::size_t i = lines; i-- > 0;)
        made.firstOfLine[i] = std::min(made.firstOfLine[i], made.firstOfLine[i + 1]);
    for (const std::string& input : made.names.inputs) made.meanings.try_emplace(input, NameKind::input);
    for (const language::CodeDefinition& each : made.names.definitions)
        made.meanings.try_emplace(each.name, each.function ? NameKind::function : NameKind::variable);
    return made;
}

void Colouring::follow(const Text& text) {
    if (version == text.version && lines.size() == text.lines.size()) return;
    const uint64_t behind = text.version - version;
    if (version == 0 || text.version < version || behind > text.splices.size()) {
        lines.assign(text.lines.size(), {});
        sure = 0;
    } else {
        for (std::size_t i = text.splices.size() - std::size_t(behind); i < text.splices.size(); ++i) {
            const Splice& splice = text.splices[i];
            const auto first = lines.begin() + splice.line;
            const int kept = std::min(splice.removed, splice.added);
            for (int k = 0; k < kept; ++k) first[k].read = false;
            if (splice.added > kept)
                lines.insert(first + kept, std::size_t(splice.added - kept), {});
            else
                lines.erase(first + kept, first + splice.removed);
            sure = std::min(sure, splice.line);
        }
    }
    version = text.version;
}

void Colouring::read(const std::string& text, State begins, Line& line) {
    line.read = true;
    line.begins = begins;
    line.ends = State::code;
    line.pieces.clear();
    std::size_t at = 0;
    if (begins != State::code) {
        const bool comment = begins == State::comment;
        const std::size_t end = comment ? text.find("*/") : text.find('"');
        at = end == std::string::npos ? text.size() : end + (comment ? 2 : 1);
        if (end == std::string::npos) line.ends = begins;
        const Piece::Kind kind = comment ? Piece::Kind::comment : Piece::Kind::string;
        if (at > 0) line.pieces.push_back({0, int(at), kind, inkOf(kind)});
        if (end == std::string::npos) return;
    }
    while (at < text.size()) {
        const Piece piece = language::pieceAt(text, at);
        if (piece.kind != Piece::Kind::space)
            line.pieces.push_back({int(at), int(piece.length), piece.kind, inkOf(piece.kind)});
        if (piece.kind == Piece::Kind::openComment) line.ends = State::comment;
        if (piece.kind == Piece::Kind::openString) line.ends = State::string;
        at += piece.length;
    }
}

const std::vector<Stretch>& Colouring::line(const Text& text, int wanted) {
    follow(text);
    for (; sure <= wanted; ++sure) {
        const State begins = sure == 0 ? State::code : lines[std::size_t(sure) - 1].ends;
        Line& line = lines[std::size_t(sure)];
        if (!line.read || line.begins != begins) read(text.lines[std::size_t(sure)], begins, line);
    }
    return lines[std::size_t(wanted)].pieces;
}

Ink Colouring::ink(const Text& text, int at, std::size_t k, const NamesOfText* names) {
    const Stretch piece = line(text, at)[k];
    if (piece.kind != Piece::Kind::name) return piece.ink;
    const std::string_view name = std::string_view(text.lines[std::size_t(at)])
                                      .substr(std::size_t(piece.begin), std::size_t(piece.length));
    if (names && names->version == text.version && std::size_t(at) + 1 < names->firstOfLine.size()) {
        const std::vector<language::NameUse>& uses = names->names.uses;
        // The n-th name of a line is the n-th.
        const std::vector<Stretch>& pieces = lines[std::size_t(at)].pieces;
        std::size_t index = names->firstOfLine[std::size_t(at)];
        for (std::size_t j = 0; j < k; ++j) index += pieces[j].kind == Piece::Kind::name;
        return index < names->firstOfLine[std::size_t(at) + 1] ? inkOf(uses[index].kind) : Ink::plain;
    }
    if (names)
        if (const auto found = names->meanings.find(std::string(name)); found != names->meanings.end())
            return inkOf(found->second);
    const std::vector<Stretch>& pieces = lines[std::size_t(at)].pieces;
    const bool called = k + 1 < pieces.size() && bracketAt(text, at, pieces[k + 1]) == '(';
    const NameKind meaning = language::meaningOf(name, called);
    return meaning == NameKind::unknown ? Ink::plain : inkOf(meaning);
}

bool Colouring::quiet(const Text& text, Spot spot) {
    for (const Stretch& piece : line(text, spot.line)) {
        const bool open = piece.kind == Piece::Kind::openComment || piece.kind == Piece::Kind::openString;
        const bool whole = piece.kind == Piece::Kind::comment || piece.kind == Piece::Kind::string;
        const int end = piece.begin + piece.length;
        if (!(open || whole) || spot.byte <= piece.begin) continue;
        const bool toEnd =
            end == int(text.lines[std::size_t(spot.line)].size()) && (piece.ink == Ink::comment || open);
        if (spot.byte < end || (toEnd && spot.byte == end)) return true;
    }
    return false;
}

std::optional<std::pair<Spot, Spot>> brackets(const Text& text, Colouring& colouring) {
    const int row = text.cursor.line;
    const auto at = [&](int byte) -> std::optional<std::size_t> {
        const std::vector<Stretch>& pieces = colouring.line(text, row);
        for (std::size_t k = 0; k < pieces.size(); ++k)
            if (pieces[k].begin == byte && bracketAt(text, row, pieces[k]) != 0) return k;
        return std::nullopt;
    };
    std::optional<std::size_t> here = at(text.cursor.byte);
    if (!here && text.cursor.byte > 0) here = at(text.cursor.byte - 1);
    if (!here) return std::nullopt;
    const Stretch own = colouring.line(text, row)[*here];
    const char c = bracketAt(text, row, own), partner = partnerOf(c);
    const int by = opens(c) ? 1 : -1;
    const Spot start{row, own.begin};
    int depth = 0;
    for (int line = row, far = 0; line >= 0 && line < int(text.lines.size()) && far < kFarBrackets;
         line += by, ++far) {
        const std::vector<Stretch>& pieces = colouring.line(text, line);
        int k = line == row ? int(*here) : by > 0 ? 0 : int(pieces.size()) - 1;
        for (; k >= 0 && k < int(pieces.size()); k += by) {
            const char each = bracketAt(text, line, pieces[std::size_t(k)]);
            depth += int(each == c) - int(each == partner);
            if (depth > 0 || each != partner) continue;
            const Spot end{line, pieces[std::size_t(k)].begin};
            return by > 0 ? std::pair(start, end) : std::pair(end, start);
        }
    }
    return std::pair(start, start);
}

std::optional<CallAt> callAt(const Text& text, Colouring& colouring, Spot spot) {
    CallAt call;
    int depth = 0;
    for (int line = spot.line; line >= std::max(0, spot.line - kFarCall); --line) {
        const std::vector<Stretch>& pieces = colouring.line(text, line);
        for (int k = int(pieces.size()) - 1; k >= 0; --k) {
            const Stretch& piece = pieces[std::size_t(k)];
            if (line == spot.line && piece.begin + piece.length > spot.byte) continue;
            const char c = piece.kind == Piece::Kind::symbol
                               ? text.lines[std::size_t(line)][std::size_t(piece.begin)]
                               : char(0);
            if (c == ';' || c == '{' || c == '}') return std::nullopt;
            if (c == ')' || c == ']') ++depth;
            if (c == ',' && depth == 0) ++call.argument;
            if (c != '(' && c != '[') continue;
            if (depth-- > 0) continue;
            depth = 0;
            const bool named = k > 0 && pieces[std::size_t(k) - 1].kind == Piece::Kind::name && c == '(';
            const Stretch before = named ? pieces[std::size_t(k) - 1] : Stretch{};
            const std::string name =
                text.lines[std::size_t(line)].substr(std::size_t(before.begin), std::size_t(before.length));
            if (named && language::meaningOf(name, true) != NameKind::word) {
                call.name = name;
                call.begin = {line, before.begin};
                return call;
            }
            call.argument = 0;  // a bracket of its own: the call is around it
        }
    }
    return std::nullopt;
}

}  // namespace fw::editor::code
