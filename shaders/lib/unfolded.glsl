#ifndef FW_UNFOLDED_GLSL
#define FW_UNFOLDED_GLSL
// A number from a uniform buffer or a push constant, for a loop to end at. Some drivers take such a number for a constant, unroll
// the loop by it, and compile the kernel anew for each dispatch (lavapipe, lvp_inline_uniforms.c); of what a lane tells the
// others they know nothing.
uint unfolded(uint number) { return subgroupBroadcastFirst(number); }
#endif
