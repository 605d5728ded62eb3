#include "graph/rules/findings.h"

#include "graph/base/words.h"
#include "graph/library/node_type.h"

namespace fw {

namespace {

constexpr std::size_t kMaxCompared =
    50'000'000;  // pairs of letters, in all hints together: tenths of a second
constexpr std::size_t kLongestHinted = 64;

}  // namespace

void Findings::add(const Place& place, std::string message, Error::Severity severity, Error::Code code) {
    if (full()) {
        ++beyond;
        errorBeyond = errorBeyond || severity == Error::Severity::error;
        return;
    }
    list.push_back({.message = std::move(message),
                    .file = file,
                    .node = place.node,
                    .input = place.input,
                    .line = place.at.line,
                    .column = place.at.column,
                    .severity = severity,
                    .code = code});
}

bool Findings::mayCompare(std::string_view name, std::size_t count) {
    const std::size_t cost = count * (name.size() + 1) * (name.size() + 1);  // near names are about as long
    if (full() || name.size() > kLongestHinted || compared + cost > kMaxCompared) return false;
    compared += cost;
    return true;
}

std::string Findings::hint(std::string_view name, std::span<const std::string> names, std::string otherwise) {
    if (!mayCompare(name, names.size())) return otherwise;
    const std::string near = nearestName(name, names);
    return near.empty() ? otherwise : "; did you mean " + inQuotes(near) + "?";
}

std::string Findings::hintType(std::string_view name) {
    const std::string near = mayCompare(name, nodeTypes().size()) ? nearestNodeType(name) : std::string();
    return near.empty() ? "; 'fieldwright nodes' lists all" : "; did you mean '" + near + "'?";
}

std::vector<Error> Findings::take() {
    if (beyond > 0) {
        const bool error = errorBeyond || list.back().severity == Error::Severity::error;
        list.back() = {.message = "there are " + std::to_string(beyond + 1) +
                                  " more findings: correct those above first",
                       .file = file,
                       .severity = error ? Error::Severity::error : Error::Severity::warning};
    }
    return std::move(list);
}

std::string firstInLine(const TextPosition& at) {
    return at.line > 0 ? ", the first in line " + std::to_string(at.line) : std::string();
}

}  // namespace fw
