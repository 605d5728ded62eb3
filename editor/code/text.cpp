#include "editor/code/text.h"

#include <algorithm>
#include <cmath>

namespace fw::editor::code {

namespace {

constexpr std::size_t kMostSplices = 64;

bool continues(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

std::vector<std::string> linesOf(std::string_view string) {
    std::vector<std::string> lines{""};
    for (const char c : string) {
        if (c == '\n')
            lines.emplace_back();
        else if (c != '\r')
            lines.back() += c;
    }
    return lines;
}

/// replace() without a word in the history.
Spot exchange(Text& text, Range range, std::string_view with) {
    std::vector<std::string> added = linesOf(with);
    std::vector<std::string>& lines = text.lines;
    const auto first = std::size_t(range.from.line), last = std::size_t(range.to.line);
    const std::string tail = lines[last].substr(std::size_t(range.to.byte));
    added.front().insert(0, lines[first], 0, std::size_t(range.from.byte));
    const Spot end{range.from.line + int(added.size()) - 1, int(added.back().size())};
    added.back() += tail;
    const std::size_t common = std::min(added.size(), last - first + 1);
    std::move(added.begin(), added.begin() + std::ptrdiff_t(common), lines.begin() + std::ptrdiff_t(first));
    const auto behind = lines.begin() + std::ptrdiff_t(first + common);
    if (added.size() > common)
        lines.insert(behind, std::make_move_iterator(added.begin() + std::ptrdiff_t(common)),
                     std::make_move_iterator(added.end()));
    else
        lines.erase(behind, lines.begin() + std::ptrdiff_t(last) + 1);
    text.splices.push_back({range.from.line, int(last - first) + 1, int(added.size())});
    if (text.splices.size() > kMostSplices) text.splices.pop_front();
    ++text.version;
    text.wanted = -1;
    return end;
}

/// The end of `added` that was put at `at`.
Spot endOfAdded(Spot at, std::string_view added) {
    for (const char c : added) {
        if (c == '\n')
            ++at.line, at.byte = 0;
        else
            ++at.byte;
    }
    return at;
}

}  // namespace

Text textOf(std::string_view string) {
    Text text;
    text.lines = linesOf(string);
    return text;
}

std::string stringOf(const Text& text, Range range) {
    std::string result;
    for (int i = range.from.line; i <= range.to.line; ++i) {
        const std::string& line = text.lines[std::size_t(i)];
        const std::size_t begin = i == range.from.line ? std::size_t(range.from.byte) : 0;
        const std::size_t end = i == range.to.line ? std::size_t(range.to.byte) : line.size();
        result.append(line, begin, end - begin);
        if (i < range.to.line) result += '\n';
    }
    return result;
}

std::string stringOf(const Text& text) { return stringOf(text, {{}, endOf(text)}); }

bool is(const Text& text, std::string_view string) {
    for (std::size_t i = 0; i < text.lines.size(); ++i) {
        if (i > 0) {
            if (!string.starts_with('\n')) return false;
            string.remove_prefix(1);
        }
        if (!string.starts_with(text.lines[i])) return false;
        string.remove_prefix(text.lines[i].size());
    }
    return string.empty();
}

Spot endOf(const Text& text) { return {int(text.lines.size()) - 1, int(text.lines.back().size())}; }

Spot clamped(const Text& text, Spot spot) {
    if (spot.line < 0) return {};
    if (spot.line >= int(text.lines.size())) return endOf(text);
    const std::string& line = text.lines[std::size_t(spot.line)];
    spot.byte = std::clamp(spot.byte, 0, int(line.size()));
    while (spot.byte > 0 && spot.byte < int(line.size()) && continues(line[std::size_t(spot.byte)]))
        --spot.byte;
    return spot;
}

Spot before(const Text& text, Spot spot) {
    if (spot.byte == 0)
        return spot.line == 0 ? spot
                              : Spot{spot.line - 1, int(text.lines[std::size_t(spot.line) - 1].size())};
    const std::string& line = text.lines[std::size_t(spot.line)];
    do --spot.byte;
    while (spot.byte > 0 && continues(line[std::size_t(spot.byte)]));
    return spot;
}

Spot after(const Text& text, Spot spot) {
    const std::string& line = text.lines[std::size_t(spot.line)];
    if (spot.byte >= int(line.size()))
        return spot.line + 1 < int(text.lines.size()) ? Spot{spot.line + 1, 0} : spot;
    do ++spot.byte;
    while (spot.byte < int(line.size()) && continues(line[std::size_t(spot.byte)]));
    return spot;
}

int columnOf(const Text& text, Spot spot) {
    int column = 0;
    const std::string& line = text.lines[std::size_t(spot.line)];
    for (int i = 0; i < spot.byte; ++i) {
        const char c = line[std::size_t(i)];
        if (c == '\t')
            column += kTabWidth - column % kTabWidth;
        else
            column += !continues(c);
    }
    return column;
}

Spot spotAt(const Text& text, int line, float column) {
    if (line < 0) return {};
    if (line >= int(text.lines.size())) return endOf(text);
    Spot best{line, 0};
    float at = 0, distance = std::abs(column);
    const int size = int(text.lines[std::size_t(line)].size());
    for (Spot spot = best; spot.byte < size;) {
        const bool tab = text.lines[std::size_t(line)][std::size_t(spot.byte)] == '\t';
        at += tab ? float(kTabWidth - int(at) % kTabWidth) : 1.0f;
        spot = after(text, spot);
        if (std::abs(column - at) > distance) break;
        best = spot, distance = std::abs(column - at);
    }
    return best;
}

std::size_t offsetOf(const Text& text, Spot spot) {
    std::size_t offset = std::size_t(spot.byte);
    for (int i = 0; i < spot.line; ++i) offset += text.lines[std::size_t(i)].size() + 1;
    return offset;
}

Spot spotOf(const Text& text, std::size_t offset) {
    for (std::size_t i = 0; i < text.lines.size(); ++i) {
        if (offset <= text.lines[i].size()) return clamped(text, {int(i), int(offset)});
        offset -= text.lines[i].size() + 1;
    }
    return endOf(text);
}

Spot spotOfPlace(const Text& text, int line, int column) {
    if (line > int(text.lines.size())) return endOf(text);
    Spot spot{std::max(line - 1, 0), 0};
    const int size = int(text.lines[std::size_t(spot.line)].size());
    for (int i = 1; i < column && spot.byte < size; ++i) spot = after(text, spot);
    return spot;
}

void newStep(Text& text) {
    ++text.step;
    text.typing = Text::Typing::none;
}

Spot replace(Text& text, Range range, std::string_view with) {
    std::string removed = stringOf(text, range), added(with);
    std::erase(added, '\r');
    if (removed == added) {
        place(text, range.to);
        return range.to;
    }
    if (text.done < text.changes.size()) text.changes.resize(text.done);
    if (text.changes.size() >= kMostChanges)
        text.changes.erase(text.changes.begin(), text.changes.begin() + kMostChanges / 4);
    const Spot cursor = text.cursor, anchor = text.anchor;
    const Spot end = exchange(text, range, added);
    text.changes.push_back({range.from, std::move(removed), std::move(added), cursor, anchor, text.step});
    text.done = text.changes.size();
    text.cursor = text.anchor = end;
    return end;
}

void place(Text& text, Spot spot, bool selecting) {
    text.cursor = clamped(text, spot);
    if (!selecting) text.anchor = text.cursor;
    text.wanted = -1;
}

bool undo(Text& text) {
    if (text.done == 0) return false;
    const int step = text.changes[text.done - 1].step;
    while (text.done > 0 && text.changes[text.done - 1].step == step) {
        const Text::Change& change = text.changes[--text.done];
        exchange(text, {change.at, endOfAdded(change.at, change.added)}, change.removed);
        text.cursor = change.cursor, text.anchor = change.anchor;
    }
    newStep(text);
    return true;
}

bool redo(Text& text) {
    if (text.done == text.changes.size()) return false;
    const int step = text.changes[text.done].step;
    while (text.done < text.changes.size() && text.changes[text.done].step == step) {
        const Text::Change& change = text.changes[text.done++];
        text.cursor = exchange(text, {change.at, endOfAdded(change.at, change.removed)}, change.added);
        text.anchor = text.cursor;
    }
    newStep(text);
    return true;
}

}  // namespace fw::editor::code
