// One implicit function as a group: see functions.h.
#pragma once

#include "graph/implicit3mf/functions.h"

namespace fw::threemf {

/// The group, without an id. `depth` functions call each other to come here. The Error has a message only.
Result<Group> groupOf(FunctionGroups& functions, const Function& function,
                      const FunctionGroups::Resources& resources, int depth);

}  // namespace fw::threemf
