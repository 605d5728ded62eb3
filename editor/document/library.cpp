#include "editor/document/library.h"

#include <algorithm>
#include <cctype>
#include <sstream>
#include <tuple>

namespace fw::editor {

namespace {

// As often as the samples have them.
constexpr std::string_view kUsual[] = {
    "union",  "material",    "translate", "subtract", "box",       "sphere",  "intersect", "expression",
    "repeat", "vector_math", "position",  "cylinder", "transform", "rotate",  "capsule",   "offset",
    "math",   "extrude",     "revolve",   "mirror",   "noise",     "displace"};

// Steps between the ranks of match().
constexpr int kBegins = 1, kWordBegins = 2, kOtherName = 3, kWithin = 4, kCategory = 5, kDoc = 6,
              kLetters = 7;
constexpr int kByWords = 10;

std::string spoken(std::string_view text) {
    std::string low(text);
    for (char& c : low) c = c == '_' ? ' ' : char(std::tolower(static_cast<unsigned char>(c)));
    low.erase(0, low.find_first_not_of(' '));
    low.erase(low.find_last_not_of(' ') + 1);
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

/// Of words that stand together.
int matchTogether(const std::string& words, const SearchedNames& names) {
    if (names.label == words || names.id == words) return 0;
    if (names.label.starts_with(words) || names.id.starts_with(words)) return kBegins;
    if (wordBegins(names.label, words) || wordBegins(names.id, words)) return kWordBegins;
    if (wordBegins(names.others, words)) return kOtherName;
    if (names.label.find(words) != std::string::npos || names.id.find(words) != std::string::npos)
        return kWithin;
    if (names.category.starts_with(words)) return kCategory;
    return wordBegins(names.doc, words) ? kDoc : kNoMatch;
}

SearchedNames namesOf(const NodeType& type) {
    std::string others(otherNames(type.id));
    for (const std::string& alias : type.aliases) others += " " + alias;
    return {type.label, type.id, std::move(others), std::string(categoryName(type.category)), type.doc};
}

std::size_t placeIn(std::span<const std::string> recent, const std::string& id) {
    return std::size_t(std::ranges::find(recent, id) - recent.begin());
}

}  // namespace

int match(std::string_view typed, const SearchedNames& shown) {
    const std::string wanted = spoken(typed);
    if (wanted.empty()) return 0;
    const SearchedNames names{spoken(shown.label), spoken(shown.id), spoken(shown.others),
                              spoken(shown.category), spoken(shown.doc)};
    const int together = matchTogether(wanted, names);
    if (together < kNoMatch) return together;
    if (wanted.find(' ') == std::string::npos)
        return lettersInOrder(names.label, wanted) ? kLetters : kNoMatch;
    int worst = 0;
    std::istringstream words(wanted);
    for (std::string word; words >> word;) worst = std::max(worst, matchTogether(word, names));
    return worst < kNoMatch ? kByWords + worst : kNoMatch;
}

std::vector<const NodeType*> findTypes(std::string_view typed, std::span<const NodeType* const> among,
                                       std::span<const std::string> recent) {
    if (spoken(typed).empty()) return {among.begin(), among.end()};
    struct Found {
        int rank;
        std::size_t last;
        const NodeType* type;
    };
    std::vector<Found> all;
    for (const NodeType* type : among)
        if (const int rank = match(typed, namesOf(*type)); rank < kNoMatch)
            all.push_back({rank, placeIn(recent, type->id), type});
    std::ranges::stable_sort(all, [](const Found& a, const Found& b) {
        return std::tie(a.rank, a.last) < std::tie(b.rank, b.last);
    });
    std::vector<const NodeType*> found;
    for (const Found& each : all) found.push_back(each.type);
    return found;
}

std::vector<const NodeType*> usualTypes(std::span<const NodeType* const> among,
                                        std::span<const std::string> recent, std::size_t count) {
    std::vector<const NodeType*> usual;
    const auto add = [&](std::string_view id) {
        const auto found = std::ranges::find_if(among, [&](const NodeType* type) { return type->id == id; });
        if (usual.size() < count && found != among.end() && std::ranges::find(usual, *found) == usual.end())
            usual.push_back(*found);
    };
    for (const std::string& id : recent) add(id);
    for (const std::string_view id : kUsual) add(id);
    return usual;
}

}  // namespace fw::editor
