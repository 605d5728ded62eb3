// From signs to triangles on the host: what classify.comp, top_groups.comp and triangles.comp do, or
// patches.comp and the look-ups of contour.comp.
//
// A software device runs on the same processors, but loads and stores a word at a time for each lane, looks
// into tables lane by lane, and runs a loop as often as the longest lane needs: most of the time to make a
// mesh. Here a brick's edges are numbered into an array that stays in the cache, and its cells read from it.
// The results are the kernels', to the bit (a test compares): the same order, the same numbers.
//
// Needs buffers that the host sees, with what sample.comp and compact.comp wrote.
#pragma once

#include "runtime/mesher/mesher.h"

namespace fw::mesher {

/// Writes the list of edges and the triangles, or of dual contouring the patches with their edges and the
/// corners of quads, and the counts with the arguments of the kernels that follow; of too much surface the
/// counts alone.
void connect(const Device& device, const MesherBuffers& buffers, const gpu::MesherPush& push, bool dual);

}  // namespace fw::mesher
