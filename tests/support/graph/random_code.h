// Random programs of the field language, made by the rules of its types.
#pragma once

#include "tests/support/graph/code_text.h"

namespace fw::test {

/// Statements, functions, built-ins and node calls, in most programs all as their types want; one in some
/// holds a mistake. With `texts`, a text and points are among its inputs, which a file cannot give. The same
/// for the same state of `random`.
CodeText randomCode(std::mt19937& random, bool texts);

}  // namespace fw::test
