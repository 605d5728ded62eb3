// Every finding about a document: what its structure lacks (rules/structure.h), and code that does not
// compile.
#pragma once

#include "graph/rules/structure.h"

namespace fw {

/// All findings, errors and warnings; empty if there are none. At most 1,000 of the structure, the last of
/// which then says that there are more. Where the structure is not sound, code is checked by itself.
/// `pictures`: also a warning if a software device would be busy for long with pictures of the solid, for
/// which it must be found; of a union of thousands of nodes that takes most of a second.
std::vector<Error> check(const Graph& graph, bool pictures = false);

}  // namespace fw
