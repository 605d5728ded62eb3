#include "tests/bench/table.h"

#include <cmath>
#include <cstdio>

namespace fw::bench {
namespace {

/// Characters on a terminal of a UTF-8 text.
std::size_t widthOf(const std::string& text) {
    return std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; });
}

void printRow(const std::vector<std::string>& row, const std::vector<std::size_t>& widths, bool markdown) {
    std::string line = markdown ? "|" : "";
    for (std::size_t i = 0; i < widths.size(); i++) {
        const std::string cell = i < row.size() ? row[i] : "";
        const std::string pad(widths[i] - widthOf(cell), ' ');
        line += markdown ? " " + cell + " |" : i == 0 ? cell + pad : "  " + pad + cell;
    }
    std::puts(line.c_str());
}

}  // namespace

std::string number(double value) {
    char buffer[32];
    const double size = std::abs(value);
    const int digits = size == 0 || size >= 100 ? 0 : std::clamp(2 - int(std::floor(std::log10(size))), 0, 6);
    std::snprintf(buffer, sizeof buffer, "%.*f", digits, value);
    return buffer;
}

std::string text(const Figure& figure) {
    return number(figure.median()) + " (" + number(figure.least()) + " – " + number(figure.greatest()) + ")";
}

std::string count(uint64_t value) {
    const std::string digits = std::to_string(value);
    std::string grouped;
    for (std::size_t i = 0; i < digits.size(); i++) {
        if (i > 0 && (digits.size() - i) % 3 == 0) grouped += ' ';
        grouped += digits[i];
    }
    return grouped;
}

void print(const Table& table, bool markdown) {
    std::printf(markdown ? "### %s\n\n" : "%s\n", table.title.c_str());
    std::vector<std::size_t> widths(table.header.size());
    for (std::size_t i = 0; i < widths.size(); i++) {
        widths[i] = widthOf(table.header[i]);
        for (const auto& row : table.rows)
            if (i < row.size()) widths[i] = std::max(widths[i], widthOf(row[i]));
    }
    printRow(table.header, widths, markdown);
    if (markdown) {
        std::string line = "|";
        for (std::size_t i = 0; i < widths.size(); i++) line += i == 0 ? " --- |" : " ---: |";
        std::puts(line.c_str());
    }
    for (const auto& row : table.rows) printRow(row, widths, markdown);
    if (markdown && !table.notes.empty()) std::puts("");
    for (const std::string& note : table.notes) std::printf(markdown ? "* %s\n" : "  %s\n", note.c_str());
    std::puts("");
    std::fflush(stdout);
}

}  // namespace fw::bench
