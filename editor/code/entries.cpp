#include "editor/code/entries.h"

#include <algorithm>
#include <cctype>
#include <set>

#include "editor/code/builtin_pages.h"
#include "graph/language/builtins.h"
#include "graph/language/parser.h"
#include "graph/library/reference.h"

namespace fw::editor::code {

namespace {

using Kind = language::NameUse::Kind;

Kind kindOfWord(std::string_view name) {
    return language::isReserved(name)     ? Kind::word
           : language::declaredType(name) ? Kind::type
                                          : Kind::constant;
}

Entry entryOf(const BuiltinPage& page, Kind kind) {
    Entry entry{kind, std::string(page.name), std::string(page.signature), std::string(page.doc)};
    if (kind == Kind::builtin) entry.arguments = argumentsOf(page.signature);
    return entry;
}

std::string withoutTicks(std::string text) {
    std::erase(text, '`');
    return text;
}

Entry entryOf(const NodeType& type) {
    Entry entry{Kind::node, type.id, type.id + "(", type.doc};
    for (const InputSpec& input : type.inputs) {
        std::string argument = std::string(typeName(input.type)) + " " + input.name;
        entry.signature += (entry.arguments.empty() ? "" : ", ") + argument;
        entry.arguments.push_back(std::move(argument));
        std::string doc = input.doc + withoutTicks(rangeText(input));
        if (const std::string by = withoutTicks(defaultText(input)); !by.empty())
            doc += " Default: " + by + ".";
        entry.argumentDocs.push_back(std::move(doc));
    }
    entry.signature += ")";
    return entry;
}

char small(char c) { return char(std::tolower(static_cast<unsigned char>(c))); }

bool begins(std::string_view text, std::string_view with) {
    return text.size() >= with.size() && std::equal(with.begin(), with.end(), text.begin(),
                                                    [](char a, char b) { return small(a) == small(b); });
}

}  // namespace

std::vector<std::string> argumentsOf(std::string_view signature) {
    const std::size_t from = signature.find('('), to = signature.rfind(')');
    std::vector<std::string> all;
    if (from == std::string_view::npos || to == std::string_view::npos || to <= from + 1) return all;
    for (std::string_view rest = signature.substr(from + 1, to - from - 1);;) {
        const std::size_t comma = rest.find(',');
        std::string_view one = rest.substr(0, comma);
        while (!one.empty() && one.front() == ' ') one.remove_prefix(1);
        all.emplace_back(one);
        if (comma == std::string_view::npos) return all;
        rest.remove_prefix(comma + 1);
    }
}

const std::vector<Entry>& libraryEntries() {
    static const std::vector<Entry> entries = [] {
        std::vector<Entry> all;
        for (const BuiltinPage& page : wordPages()) all.push_back(entryOf(page, kindOfWord(page.name)));
        for (const BuiltinPage& page : builtinPages())
            if (!language::declaredType(page.name)) all.push_back(entryOf(page, Kind::builtin));
        for (const NodeType& type : nodeTypes())
            if (!type.body.empty() && !language::findBuiltin(type.id)) all.push_back(entryOf(type));
        std::ranges::stable_sort(all, {}, &Entry::name);
        return all;
    }();
    return entries;
}

const Entry* libraryEntry(std::string_view name, Kind kind) {
    if (kind == Kind::node) {
        const NodeType* type = language::calledNode(name);
        if (!type) return nullptr;
        name = type->id;
    }
    for (const Entry& each : libraryEntries())
        if (each.kind == kind && each.name == name) return &each;
    return nullptr;
}

Entry entryOf(const CodeInput& input) {
    Entry entry{Kind::input, input.name, (input.type.empty() ? "" : input.type + " ") + input.name, {}};
    entry.doc = "An input of this node" + (input.source.empty() ? "." : ": " + input.source + ".");
    if (input.type == "surface" || input.type == "float" || input.type == "vec3" || input.type == "vec2")
        entry.doc += " Called with a position, as in " + input.name + "(p), it is its field there.";
    return entry;
}

Entry entryOf(const language::CodeDefinition& definition) {
    Entry entry{definition.function ? Kind::function : Kind::variable, definition.name, definition.words};
    entry.doc = definition.function ? "A function of this code." : "A variable of this code.";
    if (definition.function) entry.arguments = argumentsOf(definition.words);
    return entry;
}

std::vector<Entry> entriesAt(const language::CodeNames& names, std::span<const CodeInput> inputs,
                             std::size_t byte) {
    std::vector<Entry> all;
    std::set<std::string> taken;
    // What was defined last hides what was before.
    for (auto each = names.definitions.rbegin(); each != names.definitions.rend(); ++each)
        if (each->from <= byte && byte <= each->to && taken.insert(each->name).second)
            all.push_back(entryOf(*each));
    for (const CodeInput& input : inputs)
        if (taken.insert(input.name).second) all.push_back(entryOf(input));
    return all;
}

std::optional<int> fit(std::string_view name, std::string_view letters) {
    constexpr int kBegins = 0, kWord = 1000, kScattered = 2000;
    const int length = int(name.size());
    if (begins(name, letters)) return kBegins + length;
    for (std::size_t at = name.find('_'); at != std::string_view::npos; at = name.find('_', at + 1))
        if (begins(name.substr(at + 1), letters)) return kWord + length;
    // The first letter begins the name, or one of its words; the others follow somewhere.
    std::size_t at = 0;
    int gaps = 0;
    for (std::size_t i = 0; i < letters.size(); ++i, ++at) {
        const std::size_t from = at;
        while (at < name.size() && small(name[at]) != small(letters[i])) ++at;
        if (at == name.size()) return std::nullopt;
        if (i == 0 && at > 0 && name[at - 1] != '_') return std::nullopt;
        gaps += int(at - from);
    }
    return kScattered + 50 * gaps + length;
}

std::vector<const Entry*> ranked(std::span<const Entry> own, std::string_view letters) {
    struct Place {
        int fit;
        const Entry* entry;
    };
    std::vector<Place> places;
    std::set<std::string_view> hidden;
    for (const Entry& each : own) {
        hidden.insert(each.name);
        // What the code has itself is meant more often.
        if (const auto how = fit(each.name, letters)) places.push_back({*how - 100, &each});
    }
    for (const Entry& each : libraryEntries())
        if (const auto how = fit(each.name, letters); how && !hidden.contains(each.name))
            places.push_back({*how, &each});
    std::ranges::stable_sort(places, {}, &Place::fit);
    std::vector<const Entry*> found;
    for (const Place& place : places) found.push_back(place.entry);
    return found;
}

}  // namespace fw::editor::code
