// What the built-in functions and the words of the language do, a line each: what is shown beside completions
// and on hover. docs/language.md says more.
#pragma once

#include <span>
#include <string_view>

namespace fw::editor::code {

struct BuiltinPage {
    std::string_view name, signature, doc;
};

/// One for each of language::builtinNames() (a test says so).
std::span<const BuiltinPage> builtinPages();
/// Of the words of the language, its types and its constants.
std::span<const BuiltinPage> wordPages();

}  // namespace fw::editor::code
