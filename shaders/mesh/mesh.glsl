// What the kernels over a mesh share: the push constants and how items are numbered.
#include "shared.h"
#include "mesh/stages.h"
#include "lib/groups.glsl"

layout(push_constant, scalar) uniform Push { MeshPush push; };

/// The vertex or triangle of this invocation, perhaps beyond the last one.
uint item() { return linearGroup() * MESH_GROUP + gl_LocalInvocationIndex; }
