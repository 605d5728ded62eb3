// The number of this work group among those that spread() in runtime/gpu/commands.h puts on two axes.
uint linearGroup() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }
