#include "editor/code/edits.h"

#include <algorithm>
#include <cctype>

namespace fw::editor::code {

namespace {

constexpr double kRest = 1.0;  // seconds that end a step of typing

const std::string& lineOf(const Text& text, int line) { return text.lines[std::size_t(line)]; }
bool blank(char c) { return c == ' ' || c == '\t'; }

int blanksOf(const std::string& line) {
    return int(std::find_if_not(line.begin(), line.end(), blank) - line.begin());
}

/// The lines that the selection touches; one that it only ends at the start of is not among them.
std::pair<int, int> selectedLines(const Text& text) {
    const Range range = text.selection();
    const bool untouched = range.to.byte == 0 && range.to.line > range.from.line;
    return {range.from.line, range.to.line - int(untouched)};
}

std::string withoutTabs(std::string_view text) {
    std::string result;
    int column = 0;
    for (const char c : text) {
        if (c == '\t') {
            const int blanks = kTabWidth - column % kTabWidth;
            result.append(std::size_t(blanks), ' ');
            column += blanks;
        } else {
            result += c;
            column = c == '\n' ? 0 : column + ((c & 0xC0) != 0x80);
        }
    }
    return result;
}

/// A key's edit begins: another step, unless it goes on with what was typed.
void beginTyping(Text& text, Text::Typing kind, double seconds) {
    const bool goesOn =
        text.typing == kind && !text.selects() && seconds - text.typed < kRest && text.cursor == text.typedTo;
    if (!goesOn) newStep(text);
    text.typing = kind;
    text.typed = seconds;
}

void endTyping(Text& text) { text.typedTo = text.cursor; }

int charClass(char c) { return blank(c) ? 0 : inWord(c) ? 1 : 2; }

Spot wordLeft(const Text& text, Spot spot) {
    if (spot.byte == 0) return before(text, spot);
    const std::string& line = lineOf(text, spot.line);
    int at = spot.byte;
    while (at > 0 && blank(line[std::size_t(at) - 1])) --at;
    if (at > 0) {
        const int kind = charClass(line[std::size_t(at) - 1]);
        while (at > 0 && charClass(line[std::size_t(at) - 1]) == kind) --at;
    }
    return {spot.line, at};
}

Spot wordRight(const Text& text, Spot spot) {
    const std::string& line = lineOf(text, spot.line);
    int at = spot.byte;
    const int size = int(line.size());
    if (at == size) return after(text, spot);
    const int kind = charClass(line[std::size_t(at)]);
    while (at < size && charClass(line[std::size_t(at)]) == kind) ++at;
    while (at < size && kind != 0 && blank(line[std::size_t(at)])) ++at;
    return {spot.line, at};
}

Spot vertical(Text& text, int lines) {
    const int wanted = text.wanted >= 0 ? text.wanted : columnOf(text, text.cursor);
    const int line = text.cursor.line + lines;
    Spot to = line < 0                         ? Spot{}
              : line >= int(text.lines.size()) ? endOf(text)
                                               : spotAt(text, line, float(wanted));
    text.wanted = wanted;
    return to;
}

Spot lineStart(const Text& text, Spot spot) {
    const int first = blanksOf(lineOf(text, spot.line));
    return {spot.line, spot.byte == first ? 0 : first};
}

/// One change for all of these lines, so that it is one entry of the history and the ends of the selection
/// stay on their characters: `shift` gives each line anew.
template <class Anew>
void changeLines(Text& text, int first, int last, const Anew& anew) {
    newStep(text);
    const Spot cursor = text.cursor, anchor = text.anchor;
    const auto follow = [&](Spot spot, const std::vector<int>& grown) {
        if (spot.line < first || spot.line > last) return spot;
        const int by = grown[std::size_t(spot.line - first)];
        return spot.byte == 0 && text.selects() ? spot : Spot{spot.line, std::max(spot.byte + by, 0)};
    };
    std::string all;
    std::vector<int> grown;
    for (int i = first; i <= last; ++i) {
        const std::string line = anew(lineOf(text, i));
        grown.push_back(int(line.size()) - int(lineOf(text, i).size()));
        all += (i > first ? "\n" : "") + line;
    }
    const Spot newCursor = follow(cursor, grown), newAnchor = follow(anchor, grown);
    replace(text, {{first, 0}, {last, int(lineOf(text, last).size())}}, all);
    text.cursor = clamped(text, newCursor), text.anchor = clamped(text, newAnchor);
}

}  // namespace

bool inWord(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || static_cast<unsigned char>(c) >= 0x80;
}

void move(Text& text, Move by, bool selecting, int page) {
    text.typing = Text::Typing::none;
    const Range selected = text.selection();
    Spot to = text.cursor;
    const bool lets = text.selects() && !selecting;
    switch (by) {
        case Move::left: to = lets ? selected.from : before(text, to); break;
        case Move::right: to = lets ? selected.to : after(text, to); break;
        case Move::wordLeft: to = wordLeft(text, to); break;
        case Move::wordRight: to = wordRight(text, to); break;
        case Move::lineStart: to = lineStart(text, to); break;
        case Move::lineEnd: to.byte = int(lineOf(text, to.line).size()); break;
        case Move::textStart: to = {}; break;
        case Move::textEnd: to = endOf(text); break;
        case Move::up:
        case Move::down:
        case Move::pageUp:
        case Move::pageDown: {
            const int lines = by == Move::up ? -1 : by == Move::down ? 1 : by == Move::pageUp ? -page : page;
            to = vertical(text, lines);
            const int wanted = text.wanted;
            place(text, to, selecting);
            text.wanted = wanted;
            return;
        }
    }
    place(text, to, selecting);
}

Range wordAt(const Text& text, Spot spot) {
    const std::string& line = lineOf(text, spot.line);
    if (line.empty()) return {spot, spot};
    // Between two kinds of characters the word counts.
    int at = std::min(spot.byte, int(line.size()) - 1);
    if (spot.byte > 0 && charClass(line[std::size_t(at)]) != 1 &&
        charClass(line[std::size_t(spot.byte) - 1]) == 1)
        at = spot.byte - 1;
    const int kind = charClass(line[std::size_t(at)]);
    int from = at, to = at + 1;
    while (from > 0 && charClass(line[std::size_t(from) - 1]) == kind) --from;
    while (to < int(line.size()) && charClass(line[std::size_t(to)]) == kind) ++to;
    return {{spot.line, from}, {spot.line, to}};
}

Range lineAt(const Text& text, int line) {
    line = std::clamp(line, 0, int(text.lines.size()) - 1);
    const Spot end =
        line + 1 < int(text.lines.size()) ? Spot{line + 1, 0} : Spot{line, int(lineOf(text, line).size())};
    return {{line, 0}, end};
}

void select(Text& text, Range range) {
    place(text, range.from);
    place(text, range.to, true);
}

void selectAll(Text& text) { select(text, {{}, endOf(text)}); }

void type(Text& text, std::string_view characters, double seconds) {
    if (characters.empty()) return;
    const bool letters = std::ranges::all_of(characters, inWord);
    beginTyping(text, letters ? Text::Typing::letters : Text::Typing::others, seconds);
    // What ends a word belongs to it; what begins one does not.
    replace(text, text.selection(), withoutTabs(characters));
    const std::string& line = lineOf(text, text.cursor.line);
    const int blanks = blanksOf(line);
    if (characters == "}" && blanks > 0 && text.cursor.byte == blanks + 1) {
        const int fewer =
            std::max(0, (columnOf(text, {text.cursor.line, blanks}) - 1) / kTabWidth * kTabWidth);
        replace(text, {{text.cursor.line, 0}, {text.cursor.line, blanks}},
                std::string(std::size_t(fewer), ' '));
        place(text, {text.cursor.line, fewer + 1});
    }
    endTyping(text);
}

void breakLine(Text& text) {
    newStep(text);
    const Range range = text.selection();
    const std::string& line = lineOf(text, range.from.line);
    const std::string head = line.substr(0, std::size_t(range.from.byte));
    const std::string& last = lineOf(text, range.to.line);
    const std::string tail = last.substr(std::size_t(range.to.byte));
    std::string indentation = head.substr(0, std::size_t(blanksOf(head)));
    const std::size_t end = head.find_last_not_of(" \t");
    const bool opens = end != std::string::npos && head[end] == '{';
    const std::size_t next = tail.find_first_not_of(" \t");
    const bool closes = next != std::string::npos && tail[next] == '}';
    const Spot behind{range.to.line, range.to.byte + int(next == std::string::npos ? 0 : next)};
    if (opens && closes) {
        const std::string inner = "\n" + indentation + std::string(kTabWidth, ' ');
        const Spot to = replace(text, {range.from, behind}, inner + "\n" + indentation);
        place(text, {to.line - 1, int(inner.size()) - 1});
        return;
    }
    if (opens) indentation.append(kTabWidth, ' ');
    replace(text, {range.from, behind}, "\n" + indentation);
}

void paste(Text& text, std::string_view pasted) {
    newStep(text);
    replace(text, text.selection(), withoutTabs(pasted));
    newStep(text);
}

std::string copied(const Text& text) {
    if (text.selects()) return stringOf(text, text.selection());
    return lineOf(text, text.cursor.line) + "\n";
}

std::string cut(Text& text) {
    std::string taken = copied(text);
    newStep(text);
    Range range = text.selects() ? text.selection() : lineAt(text, text.cursor.line);
    // The last line goes with the line end before it.
    if (!text.selects() && range.to.line == range.from.line) range.from = before(text, range.from);
    replace(text, range, "");
    newStep(text);
    return taken;
}

void eraseBack(Text& text, bool word, double seconds) {
    Range range = text.selection();
    if (range.empty() && range.from == Spot{}) return;
    beginTyping(text, Text::Typing::erasing, seconds);
    if (range.empty() && word) {
        range.from = wordLeft(text, range.to);
    } else if (range.empty()) {
        range.from = before(text, range.to);
        const std::string& line = lineOf(text, range.to.line);
        const int blanks = blanksOf(line);
        if (range.to.byte > 0 && range.to.byte <= blanks && line.find('\t') == std::string::npos)
            range.from = {range.to.line, (range.to.byte - 1) / kTabWidth * kTabWidth};
    }
    replace(text, range, "");
    endTyping(text);
}

void eraseForward(Text& text, bool word, double seconds) {
    Range range = text.selection();
    if (range.empty()) range.to = word ? wordRight(text, range.from) : after(text, range.from);
    if (range.empty()) return;
    beginTyping(text, Text::Typing::erasing, seconds);
    replace(text, range, "");
    endTyping(text);
}

void indent(Text& text) {
    const auto [first, last] = selectedLines(text);
    if (first < last || (text.selects() && text.selection().from.line != text.selection().to.line))
        return changeLines(text, first, last, [](const std::string& line) {
            return line.empty() ? line : std::string(kTabWidth, ' ') + line;
        });
    newStep(text);
    const int column = columnOf(text, text.selection().from);
    replace(text, text.selection(), std::string(std::size_t(kTabWidth - column % kTabWidth), ' '));
    newStep(text);
}

void outdent(Text& text) {
    const auto [first, last] = selectedLines(text);
    changeLines(text, first, last, [](const std::string& line) {
        if (!line.empty() && line[0] == '\t') return line.substr(1);
        return line.substr(std::size_t(std::min(blanksOf(line), kTabWidth)));
    });
}

void toggleComment(Text& text) {
    const auto [first, last] = selectedLines(text);
    bool all = true, any = false;
    int least = 1 << 20;
    for (int i = first; i <= last; ++i) {
        const std::string& line = lineOf(text, i);
        const int blanks = blanksOf(line);
        if (blanks == int(line.size()) && first < last) continue;
        any = true;
        all &= line.compare(std::size_t(blanks), 2, "//") == 0;
        least = std::min(least, blanks);
    }
    if (!any) return;
    changeLines(text, first, last, [&](std::string line) {
        const auto blanks = std::size_t(blanksOf(line));
        if (blanks == line.size() && first < last) return line;
        if (!all) return line.insert(std::size_t(least), "// ");
        return line.erase(blanks, line.compare(blanks, 3, "// ") == 0 ? 3 : 2);
    });
}

void moveLines(Text& text, int by) {
    const auto [first, last] = selectedLines(text);
    if (by < 0 ? first == 0 : last + 1 == int(text.lines.size())) return;
    newStep(text);
    const Spot cursor = text.cursor, anchor = text.anchor;
    const Range moved{{first, 0}, {last, int(lineOf(text, last).size())}};
    const std::string lines = stringOf(text, moved);
    if (by < 0)
        replace(text, {{first - 1, 0}, moved.to}, lines + "\n" + lineOf(text, first - 1));
    else
        replace(text, {moved.from, {last + 1, int(lineOf(text, last + 1).size())}},
                lineOf(text, last + 1) + "\n" + lines);
    text.cursor = clamped(text, {cursor.line + by, cursor.byte});
    text.anchor = clamped(text, {anchor.line + by, anchor.byte});
    newStep(text);
}

void duplicate(Text& text) {
    newStep(text);
    const Range range = text.selection();
    if (text.selects()) {
        const std::string again = stringOf(text, range);
        const Spot end = replace(text, {range.to, range.to}, again);
        select(text, {range.to, end});
    } else {
        const Spot cursor = text.cursor;
        const std::string line = lineOf(text, cursor.line);
        const Spot end{cursor.line, int(line.size())};
        replace(text, {end, end}, "\n" + line);
        place(text, {cursor.line + 1, cursor.byte});
    }
    newStep(text);
}

namespace {

/// The first place of the words in the line from a byte on; npos if there is none.
std::size_t findIn(const std::string& line, std::string_view words, std::size_t from, bool capitals) {
    if (from > line.size()) return std::string::npos;
    const auto same = [&](char a, char b) {
        return capitals ? a == b
                        : std::tolower(static_cast<unsigned char>(a)) ==
                              std::tolower(static_cast<unsigned char>(b));
    };
    const auto found =
        std::search(line.begin() + std::ptrdiff_t(from), line.end(), words.begin(), words.end(), same);
    return found == line.end() ? std::string::npos : std::size_t(found - line.begin());
}

bool hasCapitals(std::string_view words) {
    return std::ranges::any_of(words, [](unsigned char c) { return std::isupper(c); });
}

}  // namespace

std::vector<Range> findAll(const Text& text, std::string_view words, int first, int last) {
    std::vector<Range> found;
    if (words.empty()) return found;
    const bool capitals = hasCapitals(words);
    for (int i = std::max(first, 0); i <= std::min(last, int(text.lines.size()) - 1); ++i)
        for (std::size_t at = 0; (at = findIn(lineOf(text, i), words, at, capitals)) != std::string::npos;
             at += words.size())
            found.push_back({{i, int(at)}, {i, int(at + words.size())}});
    return found;
}

std::optional<Range> find(const Text& text, std::string_view words, bool backward) {
    const int count = int(text.lines.size());
    const Range selected = text.selection();
    for (int step = 0; step <= count; ++step) {
        const int start = backward ? selected.from.line : selected.to.line;
        const int line = ((backward ? start - step : start + step) % count + count) % count;
        const std::vector<Range> all = findAll(text, words, line, line);
        // In the cursor's own line first what lies in the way, and at the end what does not.
        const auto ahead = [&](const Range& range) {
            if (step == 0) return backward ? range.to <= selected.from : range.from >= selected.to;
            return true;
        };
        if (backward) {
            for (auto range = all.rbegin(); range != all.rend(); ++range)
                if (ahead(*range)) return *range;
        } else {
            for (const Range& range : all)
                if (ahead(range)) return range;
        }
    }
    return std::nullopt;
}

}  // namespace fw::editor::code
