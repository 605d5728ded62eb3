// What can be written in code, with its documentation: for lists of completions, signatures and pages on
// hover.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "graph/language/names.h"

namespace fw::editor::code {

struct Entry {
    language::NameUse::Kind kind = language::NameUse::Kind::unknown;
    std::string name;
    std::string signature;                       ///< "clamp(x, lo, hi)", "float radius"
    std::string doc = {};                        ///< sentences; empty for what the code defines
    std::vector<std::string> arguments = {};     ///< of a function, as they stand in the signature
    std::vector<std::string> argumentDocs = {};  ///< as many, or none
};

/// Words, types, constants, built-in functions and nodes, by name.
const std::vector<Entry>& libraryEntries();
/// The entry that a call (or a name that is none) of the library means; nullptr if there is none.
const Entry* libraryEntry(std::string_view name, language::NameUse::Kind kind);

/// An input of the node, as the code sees it.
struct CodeInput {
    std::string name;
    std::string type;    ///< "float", "surface"; empty where it is not known
    std::string source;  ///< "from Box", or its value
};
Entry entryOf(const CodeInput& input);
Entry entryOf(const language::CodeDefinition& definition);

/// Inputs, and what the code defines and can be seen at this byte; what hides another stands alone.
std::vector<Entry> entriesAt(const language::CodeNames& names, std::span<const CodeInput> inputs,
                             std::size_t byte);

/// How well letters fit a name: less is better, none if they do not. Its beginning, the beginning of one of
/// its words, letters in that order.
std::optional<int> fit(std::string_view name, std::string_view letters);
/// Those that fit, the best first; of equal ones what stands first in `own`, then what the library has.
std::vector<const Entry*> ranked(std::span<const Entry> own, std::string_view letters);

/// Arguments of a signature: what stands between its commas.
std::vector<std::string> argumentsOf(std::string_view signature);

}  // namespace fw::editor::code
