#include "graph/base/words.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdio>
#include <numeric>

#include "graph/base/result.h"

namespace fw {

namespace {

/// Number of insertions, deletions, replacements and swaps of neighbours that turn `a` into `b` (the
/// restricted Damerau-Levenshtein distance).
std::size_t editDistance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> beforeLast, last(b.size() + 1), row(b.size() + 1);
    std::iota(last.begin(), last.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); i++) {
        row[0] = i + 1;
        for (std::size_t j = 0; j < b.size(); j++) {
            row[j + 1] = std::min({last[j] + (a[i] != b[j]), last[j + 1] + 1, row[j] + 1});
            if (i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j]) {
                row[j + 1] = std::min(row[j + 1], beforeLast[j - 1] + 1);
            }
        }
        beforeLast = std::move(last);
        last = row;
    }
    return last[b.size()];
}

/// Keeps the nearest of the names offered, if it is near enough to be what was meant.
struct Nearest {
    std::string_view wanted;
    std::string_view best = {};
    std::size_t distance = std::string_view::npos;

    void offer(std::string_view name) {
        // A third of the longer word may be wrong: "sphre" finds sphere, "abc" does not find box.
        const std::size_t limit = (std::max(wanted.size(), name.size()) + 1) / 3;
        const std::size_t shortest =
            wanted.size() > name.size() ? wanted.size() - name.size() : name.size() - wanted.size();
        if (shortest > limit) return;
        const std::size_t d = editDistance(wanted, name);
        if (d <= limit && d < distance) best = name, distance = d;
    }
};

}  // namespace

std::string nearestName(std::string_view name, std::span<const std::string> names) {
    Nearest nearest{name};
    for (const std::string& candidate : names) nearest.offer(candidate);
    return std::string(nearest.best);
}

std::string lowered(std::string_view text) {
    std::string low(text);
    for (char& c : low) c = char(std::tolower(static_cast<unsigned char>(c)));
    return low;
}

std::string shortNumber(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value);
    return text;
}

std::string exactNumber(double value) {
    char text[32];
    return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string unitHint(std::string_view text) {
    double number = 0.0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
    std::string_view unit = text.substr(std::size_t(end - text.data()));
    while (unit.starts_with(' ')) unit.remove_prefix(1);
    if (problem != std::errc()) return {};
    for (const auto& [name, metres] :
         {std::pair("mm", 1e-3), std::pair("cm", 1e-2), std::pair("m", 1.0), std::pair("km", 1e3),
          std::pair("um", 1e-6), std::pair("in", 0.0254), std::pair("\"", 0.0254), std::pair("ft", 0.3048)})
        if (unit == name)
            return ": lengths are metres, without a unit: write " + shortNumber(number * metres);
    if (unit == "deg" || unit == "°")
        return ": angles are degrees, without a unit: write " + shortNumber(number);
    return {};
}

std::string listed(const std::vector<std::string>& names) {
    std::string text;
    for (std::size_t i = 0; i < names.size() && i < 40; ++i) {
        const std::string name = inQuotes(names[i]);
        text.append(i == 0 ? "" : ", ").append(name, 1, name.size() - 2);
    }
    return names.size() > 40 ? text + ", …" : text;
}

std::string arrows(const std::vector<std::string_view>& names) {
    constexpr std::size_t kLongestPath = 12;
    std::string text;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (i > 0) text += " -> ";
        if (names.size() > kLongestPath && i == kLongestPath / 2) {
            const std::size_t skipped = names.size() - kLongestPath + 1;
            text += "(" + std::to_string(skipped) + " more) -> ";
            i += skipped;
        }
        const std::string name = inQuotes(names[i]);
        text.append(name, 1, name.size() - 2);
    }
    return text;
}

}  // namespace fw
