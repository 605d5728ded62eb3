// What the kernels over a mesh share: the push constants and how items are numbered.
#include "shared.h"
#include "mesh/stages.h"

layout(push_constant, scalar) uniform Push { MeshPush push; };

uint linearGroup() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }
/// The vertex or triangle of this invocation, perhaps beyond the last one.
uint item() { return linearGroup() * MESH_GROUP + gl_LocalInvocationIndex; }
