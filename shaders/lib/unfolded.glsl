// A number from a uniform buffer or a push constant, for a loop to end at or a branch to ask. Some drivers take such a number for a
// constant, fold the code by it, and compile the kernel anew for each dispatch (lavapipe, lvp_inline_uniforms.c); of what a lane
// tells the others they know nothing.
#ifndef FW_UNFOLDED_GLSL
#define FW_UNFOLDED_GLSL
uint unfolded(uint number) { return subgroupBroadcastFirst(number); }
#endif
