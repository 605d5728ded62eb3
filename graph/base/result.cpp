#include "graph/base/result.h"

#include <algorithm>

namespace fw {

namespace {

constexpr std::size_t kLongestName = 60, kLongestNode = 240, kLongestPath = 4096, kLongestMessage = 2000;

}  // namespace

std::string format(const Error& error) {
    std::string text;
    if (!error.file.empty()) {
        text += inOneLine(error.file, kLongestPath) + ":";
        if (error.line > 0) text += std::to_string(error.line) + ":" + std::to_string(error.column) + ":";
        text += " ";
    }
    text += error.severity == Error::Severity::warning ? "warning: " : "error: ";
    if (!error.node.empty()) text += "node '" + inOneLine(error.node, kLongestNode) + "', ";
    if (!error.input.empty()) text += "input " + inQuotes(error.input) + ", ";
    if (error.codeLine > 0)
        text += "code " + std::to_string(error.codeLine) + ":" + std::to_string(error.codeColumn) + ", ";
    if (text.ends_with(", ")) text.replace(text.size() - 2, 2, ": ");
    return text + inOneLine(error.message, kLongestMessage);
}

std::string inOneLine(std::string_view whole, std::size_t longest) {
    std::size_t length = std::min(whole.size(), longest);
    while (length < whole.size() && length > 0 && (whole[length] & 0xC0) == 0x80) --length;
    std::string text;
    for (std::size_t i = 0; i < length; ++i) {
        const auto byte = static_cast<unsigned char>(whole[i]);
        // U+0080 to U+009F are control characters too, two bytes each.
        const bool pair = byte == 0xC2 && i + 1 < length && (whole[i + 1] & 0xE0) == 0x80;
        text += byte < 32 || byte == 127 || pair ? '?' : whole[i];
        i += pair;
    }
    return length < whole.size() ? text + "…" : text;
}

std::string inQuotes(std::string_view name) { return "'" + inOneLine(name, kLongestName) + "'"; }

}  // namespace fw
