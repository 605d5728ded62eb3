#include "graph/outlines/svg_style.h"

#include <algorithm>
#include <optional>

#include "graph/outlines/svg_words.h"

namespace fw {

void addDeclarations(std::string_view text, SvgProperties& to) {
    while (!text.empty()) {
        const std::size_t end = std::min(text.find(';'), text.size()), colon = text.substr(0, end).find(':');
        if (colon != std::string_view::npos) {
            std::string_view value = trimmed(text.substr(colon + 1, end - colon - 1));
            if (const std::size_t mark = value.find('!'); mark != value.npos)
                value = trimmed(value.substr(0, mark));
            to.insert_or_assign(std::string(trimmed(text.substr(0, colon))), std::string(value));
        }
        text.remove_prefix(std::min(end + 1, text.size()));
    }
}

bool addRules(std::string_view sheet, std::vector<SvgRule>& rules) {
    bool understood = true;
    std::string bare;  // without comments
    for (std::size_t at = 0; at < sheet.size();) {
        const std::size_t open = std::min(sheet.find("/*", at), sheet.size());
        bare += sheet.substr(at, open - at);
        const std::size_t close = sheet.find("*/", open);
        at = close == sheet.npos ? sheet.size() : close + 2;
    }
    std::string_view rest = bare;
    while (true) {
        const std::size_t open = rest.find('{');
        if (open == rest.npos) return understood;
        const std::size_t close = std::min(rest.find('}', open), rest.size());
        std::string_view selectors = rest.substr(0, open);
        SvgProperties properties;
        addDeclarations(rest.substr(open + 1, close - open - 1), properties);
        while (!selectors.empty()) {
            const std::size_t comma = std::min(selectors.find(','), selectors.size());
            std::string_view selector = trimmed(selectors.substr(0, comma));
            selectors.remove_prefix(std::min(comma + 1, selectors.size()));
            SvgRule rule;
            rule.properties = properties;
            bool simple = !selector.empty() && selector.find_first_of(" >+~[:@") == selector.npos;
            while (simple && !selector.empty()) {
                const std::size_t next = std::min(selector.find_first_of(".#", 1), selector.size());
                const std::string_view word = selector.substr(0, next);
                if (word[0] == '.')
                    rule.classes.emplace(word.substr(1));
                else if (word[0] == '#')
                    rule.id = word.substr(1);
                else if (word != "*")
                    rule.element = word;
                selector.remove_prefix(next);
            }
            if (simple)
                rules.push_back(std::move(rule));
            else
                understood = false;
        }
        rest.remove_prefix(std::min(close + 1, rest.size()));
    }
}

double shareIn(std::string_view text, double otherwise) {
    const std::optional<double> value = lengthIn(text, 1);
    return value ? std::clamp(*value, 0.0, 1.0) : otherwise;
}

std::string_view idOfUrl(std::string_view text) {
    const std::size_t from = text.find("url("), end = text.find(')');
    if (from == text.npos || end == text.npos) return {};
    std::string_view inside = trimmed(text.substr(from + 4, end - from - 4));
    while (!inside.empty() && (inside.front() == '"' || inside.front() == '\'')) inside.remove_prefix(1);
    while (!inside.empty() && (inside.back() == '"' || inside.back() == '\'')) inside.remove_suffix(1);
    return inside.starts_with('#') ? inside.substr(1) : std::string_view();
}

}  // namespace fw
