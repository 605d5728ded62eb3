#include "graph/document/sweep.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <optional>
#include <set>

#include "graph/base/words.h"
#include "graph/library/units.h"

namespace fw {

namespace {

constexpr std::size_t kLongestStem = 120;

/// Values that go together: those of one range, or the lines of a table.
struct SweepAxis {
    std::vector<std::string> names;
    std::vector<std::vector<std::string>> rows;
};

struct Swept {
    double number = 0.0;
    std::string_view unit = {};  ///< behind it; what it means, only the graph can tell
};
std::optional<Swept> swept(std::string_view text) {
    Swept value;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value.number);
    if (problem != std::errc() || !std::isfinite(value.number)) return std::nullopt;
    value.unit = text.substr(std::size_t(end - text.data()));
    const bool fine =
        value.unit.empty() || value.unit == "deg" || value.unit == "rad" ||
        std::ranges::any_of(lengthUnits(), [&](const LengthUnit& each) { return value.unit == each.name; });
    return fine ? std::optional(value) : std::nullopt;
}

std::string twelveDigits(double number) {
    char digits[32];
    std::snprintf(digits, sizeof digits, "%.12g", number == 0.0 ? 0.0 : number);
    return digits;
}

Result<SweepAxis> readRange(const std::string& text) {
    const auto refused = [&](const std::string& why) {
        return Error{.message = "sweep " + inQuotes(text) + ": " + why +
                                ": write name=from:to:count, as hole=0.1:0.9:9, or name a .csv file"};
    };
    const std::size_t equals = text.find('=');
    if (equals == text.npos || equals == 0) return refused("names no parameter");
    std::vector<std::string_view> parts;
    for (std::string_view left = std::string_view(text).substr(equals + 1);;) {
        const std::size_t colon = left.find(':');
        parts.push_back(left.substr(0, colon));
        if (colon == left.npos) break;
        left.remove_prefix(colon + 1);
    }
    if (parts.size() != 3) return refused("is no range");
    const std::optional<Swept> first = swept(parts[0]), last = swept(parts[1]), many = swept(parts[2]);
    for (std::size_t i = 0; i < 3; ++i)
        if (!swept(parts[i]))
            return refused(inQuotes(parts[i]) + " is not a number, nor one in mm, cm, in or m");
    const double from = first->number, to = last->number, count = many->number;
    if (first->unit != last->unit) return refused("begins and ends in different units");
    if (!many->unit.empty() || count != std::floor(count) || count < 1.0)
        return refused("the count is a whole number from 1");
    if (count > double(kMostVariants))
        return refused("has more than " + std::to_string(kMostVariants) + " values");
    if (count == 1.0 && from != to) return refused("one value has no way to go");
    if (count > 1.0 && from == to) return refused("all of its values are the same");
    SweepAxis axis{{text.substr(0, equals)}, {}};
    const auto steps = static_cast<std::size_t>(count) - 1;
    for (std::size_t i = 0; i <= steps; ++i) {
        const double part = steps ? double(i) / double(steps) : 0.0;
        axis.rows.push_back(
            {twelveDigits(i == steps ? to : from + (to - from) * part) + std::string(last->unit)});
    }
    return axis;
}

/// The cells of a table, line by line. A cell in quotes may hold commas, line ends and, twice each, quotes.
class Table {
  public:
    Table(const std::string& text_, const std::string& file_) : text(text_), file(file_) {}

    bool atEnd() const { return at >= text.size(); }
    int line() const { return lineOfRow; }

    /// The next line that is not empty; nothing behind the last one.
    Result<std::vector<std::string>> next() {
        while (!atEnd() && (text[at] == '\n' || text[at] == '\r')) number += text[at++] == '\n';
        lineOfRow = number;
        std::vector<std::string> cells;
        for (bool more = !atEnd(); more;) {
            Result<std::string> cell = nextCell();
            if (!cell) return cell.error();
            cells.push_back(std::move(*cell));
            more = !atEnd() && text[at] == ',';
            at += more;
        }
        return cells;
    }

    Error refused(const std::string& why) const {
        return {.message = why, .file = file, .line = lineOfRow, .column = 1};
    }

  private:
    Result<std::string> nextCell() {
        const std::size_t first = std::min(text.find_first_not_of(" \t", at), text.size());
        if (first == text.size() || text[first] != '"') {
            const std::size_t end = std::min(text.find_first_of(",\r\n", at), text.size());
            std::string cell = text.substr(at, end - at);
            at = end;
            cell.erase(0, cell.find_first_not_of(" \t"));
            cell.erase(cell.find_last_not_of(" \t") + 1);
            return cell;
        }
        std::string cell;
        for (at = first + 1;; ++at) {
            if (atEnd()) return refused("a quote is not closed");
            if (text[at] == '"' && (at + 1 >= text.size() || text[at + 1] != '"')) break;
            at += text[at] == '"';
            number += text[at] == '\n';
            cell += text[at];
        }
        at = std::min(text.find_first_not_of(" \t", at + 1), text.size());
        if (!atEnd() && text[at] != ',' && text[at] != '\n' && text[at] != '\r')
            return refused("there is more in a cell behind its closing quote");
        return cell;
    }

    const std::string& text;
    const std::string& file;
    std::size_t at = 0;
    int number = 1, lineOfRow = 1;
};

Result<std::string> textOfTable(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    std::string text;
    char piece[1 << 16];
    while (in.read(piece, sizeof piece), in.gcount() > 0) {
        text.append(piece, static_cast<std::size_t>(in.gcount()));
        if (text.size() > (std::size_t(256) << 20))
            return Error{.message = "a table of values has at most 256 MiB", .file = path};
    }
    if (!in.eof()) return Error{.message = "cannot read the table of values", .file = path};
    if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
    return text;
}

Result<SweepAxis> readTable(const std::string& path) {
    const Result<std::string> text = textOfTable(path);
    if (!text) return text.error();
    Table table(*text, path);
    Result<std::vector<std::string>> names = table.next();
    if (!names) return names.error();
    SweepAxis axis{std::move(*names), {}};
    for (const std::string& name : axis.names)
        if (name.empty() || name.find('=') != name.npos)
            return table.refused(inQuotes(name) +
                                 " names no parameter: the first line has a name for each column");
    while (!table.atEnd()) {
        Result<std::vector<std::string>> cells = table.next();
        if (!cells) return cells.error();
        if (cells->empty()) break;
        if (cells->size() != axis.names.size())
            return table.refused("has " + std::to_string(cells->size()) + " values for " +
                                 std::to_string(axis.names.size()) + " names");
        if (const auto none = std::ranges::find(*cells, ""); none != cells->end())
            return table.refused("no value for " + inQuotes(axis.names[std::size_t(none - cells->begin())]));
        if (axis.rows.size() == kMostVariants)
            return table.refused("has more than " + std::to_string(kMostVariants) + " variants");
        axis.rows.push_back(std::move(*cells));
    }
    if (axis.rows.empty()) return table.refused("has no values: below the names is a line for each variant");
    return axis;
}

/// The values as a file's name.
std::string stemOf(const std::vector<NamedValue>& values) {
    std::string stem;
    for (const NamedValue& each : values) stem += (stem.empty() ? "" : ",") + each.name + "=" + each.value;
    for (char& letter : stem)
        if (static_cast<unsigned char>(letter) < 0x20 || letter == 0x7f ||
            std::string_view("/\\:*?\"<>|").find(letter) != std::string_view::npos)
            letter = '_';
    if (stem.starts_with('.') || stem.starts_with('-')) stem[0] = '_';
    return stem;
}

void nameFiles(std::vector<Variant>& variants) {
    std::set<std::string> stems;  // systems that know no capitals are not minded
    bool fine = true;
    for (Variant& variant : variants) {
        variant.stem = stemOf(variant.values);
        fine = fine && variant.stem.size() <= kLongestStem && stems.insert(variant.stem).second;
    }
    if (fine) return;
    for (std::size_t i = 0; i < variants.size(); ++i) {
        char number[32];
        std::snprintf(number, sizeof number, "%06zu", i);
        variants[i].stem = number;
    }
}

}  // namespace

Result<std::vector<Variant>> readSweep(std::span<const std::string> texts) {
    std::vector<SweepAxis> axes;
    std::set<std::string> seen;
    std::size_t count = 1;
    for (const std::string& text : texts) {
        const bool table =
            text.size() >= 4 && lowered(std::string_view(text).substr(text.size() - 4)) == ".csv";
        Result<SweepAxis> axis = table ? readTable(text) : readRange(text);
        if (!axis) return axis.error();
        for (const std::string& name : axis->names)
            if (!seen.insert(name).second)
                return Error{.message = "the parameter " + inQuotes(name) + " is swept twice",
                             .file = table ? text : ""};
        if (axis->rows.size() > kMostVariants / count)
            return Error{.message = "a sweep has at most " + std::to_string(kMostVariants) + " variants"};
        count *= axis->rows.size();
        axes.push_back(std::move(*axis));
    }
    std::vector<Variant> variants(axes.empty() ? 0 : count);
    for (std::size_t i = 0; i < variants.size(); ++i) {
        std::size_t after = count, left = i;
        for (const SweepAxis& axis : axes) {
            after /= axis.rows.size();
            const std::vector<std::string>& row = axis.rows[left / after];
            left %= after;
            for (std::size_t k = 0; k < row.size(); ++k)
                variants[i].values.push_back({axis.names[k], row[k]});
        }
    }
    nameFiles(variants);
    return variants;
}

}  // namespace fw
