#include "graph/result.h"

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

}  // namespace fw
