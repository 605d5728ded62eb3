// The tools that an assistant is shown, in words for it.
#pragma once

#include <span>
#include <string>

#include "runtime/serve/message.h"

namespace fw::serve {

/// What an assistant is told before all else: how a graph file looks, and how to go about it.
std::string assistantInstructions();

/// `tools/list`: name, description and the schema of the arguments of each.
Json toolsJson();

}  // namespace fw::serve
