// Codes of the field language with the inputs that they name: those that exist, and mutations of them.
//
// The inputs are values for language::lowerText(), or a document whose expression node has them.
#pragma once

#include <random>
#include <string>
#include <vector>

#include "graph/document/graph.h"
#include "graph/language/value.h"

namespace fw::test {

struct CodeInput {
    std::string name;
    Type type;
    std::string text = {};  ///< of a string
    bool linked = false;    ///< a field: another node's result
    double number = 0.75;   ///< of a float
};

struct CodeText {
    std::string text;
    std::vector<CodeInput> inputs;
};

/// The codes of all expression nodes under samples/, and the bodies of all node types that see no mesh and no
/// particles.
const std::vector<CodeText>& knownCodes();

/// The text with one to three of its tokens swapped, dropped, doubled, or replaced by others of the same
/// kind. The same for the same state of `random`.
CodeText mutated(const CodeText& code, std::mt19937& random);

/// What the inputs hold where the code is lowered by itself.
std::vector<std::pair<std::string, language::Value>> inputValues(language::Lowering& state,
                                                                 const std::vector<CodeInput>& inputs);

/// A document that shows the code's result, which is of this type, as a surface.
Graph codeDocument(const CodeText& code, Type result);

}  // namespace fw::test
