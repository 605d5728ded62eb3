// The number of this work group among those that spread() in runtime/gpu/commands.h puts on two axes.
uint linearGroup() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }

// Work groups along one axis that a kernel may ask for; a device that allows fewer tells so (runtime/gpu/shader.h).
#ifndef MOST_GROUPS
#define MOST_GROUPS 65535
#endif
