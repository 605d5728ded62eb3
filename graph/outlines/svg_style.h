// The styles of SVG files: properties, as attributes, declarations and style sheets have them.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace fw {

using SvgProperties = std::map<std::string, std::string, std::less<>>;

/// "fill: none; stroke: red" into `to`.
void addDeclarations(std::string_view text, SvgProperties& to);

/// A rule of a style sheet whose selector is one element's: its name, its id and its classes.
struct SvgRule {
    std::string element, id;
    std::set<std::string, std::less<>> classes;
    SvgProperties properties;
    int weight() const {
        return (id.empty() ? 0 : 100) + 10 * int(classes.size()) + (element.empty() ? 0 : 1);
    }
};

/// The rules of a style sheet into `rules`; whether all selectors were understood. Those that name elements
/// about an element are not.
bool addRules(std::string_view sheet, std::vector<SvgRule>& rules);

/// An opacity, 0 to 1, or what is to be without one.
double shareIn(std::string_view text, double otherwise);
/// The id of "url(#id) none"; empty if it leads out of the file, or is none.
std::string_view idOfUrl(std::string_view text);

}  // namespace fw
