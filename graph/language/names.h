// What each name in a code text stands for, for whoever shows or changes the text: of any text, also one that
// is half written.
//
// It goes by resolve.h's rules of scope, without types: functions see their parameters and the inputs, a
// block's variables end with it, assigning to an unknown name declares it, a call looks for functions, then
// variables and inputs, then the library. What cannot be read is passed over, so that the rest keeps its
// meaning.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "graph/language/lexer.h"
#include "graph/library/node_type.h"

namespace fw::language {

struct NameUse {
    enum class Kind : unsigned char {
        word,      ///< of the language: "if", "return"
        type,      ///< also where it converts: "vec3(1)"
        constant,  ///< "PI", "true", …, and what the code sees by itself: "p", "time"
        input,     ///< CodeNames::inputs[index]
        variable,  ///< CodeNames::definitions[index]; and so the next
        function,
        builtin,
        node,    ///< that is called
        member,  ///< behind a dot
        unknown,
    } kind = Kind::unknown;
    bool called = false;  ///< "(" follows
    int index = -1;
    Place place = {};
    std::size_t begin = 0, length = 0;  ///< bytes of the text
};

/// A variable, a parameter or a function of the code.
struct CodeDefinition {
    std::string name;
    std::string words;  ///< how it is declared: "float r", "float Box(vec3 pos, vec3 size)"
    bool function = false;
    std::size_t use = 0;           ///< CodeNames::uses: where it is defined
    std::size_t from = 0, to = 0;  ///< bytes of the text in which it is seen
};

struct CodeNames {
    std::vector<std::string> inputs;
    std::vector<NameUse> uses;  ///< in the order of the text
    std::vector<CodeDefinition> definitions;

    /// The use that holds this byte, or ends at it; nullptr if there is none.
    const NameUse* at(std::size_t byte) const;
};

CodeNames namesOf(std::string_view code, std::vector<std::string> inputs);

/// What a name means by itself, where the code defines nothing: word, type, constant, builtin, node, unknown.
/// Nodes and built-ins are found only where they are called.
NameUse::Kind meaningOf(std::string_view name, bool called);
/// The node that is called by this name, whatever its capitals; nullptr if there is none, or it is no
/// function.
const NodeType* calledNode(std::string_view name);

/// The code with other names in place of those uses that `renames` picks.
template <class Picks>
std::string renamed(std::string_view code, const CodeNames& names, std::string_view to, const Picks& picks) {
    std::string result;
    std::size_t at = 0;
    for (const NameUse& use : names.uses) {
        if (!picks(use)) continue;
        result += code.substr(at, use.begin - at);
        result += to;
        at = use.begin + use.length;
    }
    return result += code.substr(at);
}

/// Why nothing in this code can be called so: it is a word of the language, or the code means something else
/// by it. Empty if it can be.
std::string nameRefusal(std::string_view code, const CodeNames& names, std::string_view name);

}  // namespace fw::language
