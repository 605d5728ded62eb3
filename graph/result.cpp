#include "graph/result.h"

#include <algorithm>

namespace fw {

std::string format(const Error& error) {
    std::string text;
    if (!error.file.empty()) {
        text += error.file + ":";
        if (error.line > 0) text += std::to_string(error.line) + ":" + std::to_string(error.column) + ":";
        text += " ";
    }
    text += error.severity == Error::Severity::warning ? "warning: " : "error: ";
    if (!error.node.empty()) text += "node '" + error.node + "', ";
    if (!error.input.empty()) text += "input '" + error.input + "', ";
    if (error.codeLine > 0)
        text += "code " + std::to_string(error.codeLine) + ":" + std::to_string(error.codeColumn) + ", ";
    if (text.ends_with(", ")) text.replace(text.size() - 2, 2, ": ");
    return text + error.message;
}

std::string inQuotes(std::string_view name) {
    constexpr std::size_t kLongest = 60;
    std::size_t length = std::min(name.size(), kLongest);
    while (length < name.size() && length > 0 && (name[length] & 0xC0) == 0x80) --length;  // whole characters
    std::string text = "'";
    for (const char c : name.substr(0, length))
        text += static_cast<unsigned char>(c) < 32 || c == 127 ? '?' : c;
    return text + (length < name.size() ? "…'" : "'");
}

}  // namespace fw
