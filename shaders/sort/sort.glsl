// What the kernels of a counting sort share: the push constants and how items are numbered.
#include "shared.h"
#include "sort/sort.h"

layout(push_constant, scalar) uniform Push { SortPush push; };

uint linearGroup() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }
