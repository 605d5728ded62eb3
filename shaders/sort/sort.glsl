// What the kernels of a counting sort share: the push constants and how items are numbered.
#include "shared.h"
#include "sort/sort.h"
#include "lib/groups.glsl"

layout(push_constant, scalar) uniform Push { SortPush push; };
