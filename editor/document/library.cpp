#include "editor/document/library.h"

#include <algorithm>
#include <cctype>
#include <string>

namespace fw::editor {

namespace {

std::string spoken(std::string_view text) {
    std::string low(text);
    for (char& c : low) c = c == '_' ? ' ' : char(std::tolower(static_cast<unsigned char>(c)));
    return low;
}

bool wordBegins(const std::string& text, const std::string& with) {
    for (std::size_t at = text.find(with); at != std::string::npos; at = text.find(with, at + 1))
        if (at == 0 || text[at - 1] == ' ') return true;
    return false;
}

bool lettersInOrder(const std::string& text, const std::string& letters) {
    std::size_t at = 0;
    for (char c : text)
        if (at < letters.size() && c == letters[at]) ++at;
    return at == letters.size();
}

constexpr int kNoMatch = 100;

/// Less is better.
int rank(const NodeType& type, const std::string& words) {
    const std::string label = spoken(type.label), id = spoken(type.id);
    if (label == words || id == words) return 0;
    if (label.starts_with(words) || id.starts_with(words)) return 1;
    if (wordBegins(label, words) || wordBegins(id, words)) return 2;
    for (const std::string& alias : type.aliases)
        if (spoken(alias).starts_with(words)) return 3;
    if (label.find(words) != std::string::npos || id.find(words) != std::string::npos) return 4;
    if (spoken(categoryName(type.category)).starts_with(words)) return 5;
    if (wordBegins(spoken(type.doc), words)) return 6;
    return lettersInOrder(label, words) ? 7 : kNoMatch;
}

}  // namespace

std::vector<const NodeType*> findTypes(std::string_view words, std::span<const NodeType* const> among) {
    std::string wanted = spoken(words);
    wanted.erase(0, wanted.find_first_not_of(' '));
    wanted.erase(wanted.find_last_not_of(' ') + 1);
    std::vector<std::pair<int, const NodeType*>> ranked;
    for (const NodeType* type : among)
        if (const int place = wanted.empty() ? 0 : rank(*type, wanted); place < kNoMatch)
            ranked.emplace_back(place, type);
    std::stable_sort(ranked.begin(), ranked.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<const NodeType*> found;
    for (const auto& [place, type] : ranked) found.push_back(type);
    return found;
}

}  // namespace fw::editor
