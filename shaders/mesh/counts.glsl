// Prefix sums over a count of each vertex, in three dispatches: sum.comp, top.comp, place.comp.
#include "mesh/mesh.glsl"
#define HISTOPYRAMID_LANES MESH_SUM_LANES
#define HISTOPYRAMID_TYPE uint
#include "lib/histopyramid.glsl"

layout(local_size_x = MESH_SUM_LANES) in;
layout(binding = 0, scalar) readonly buffer Counts { uint counts[]; };

uint groupsOfCounts() { return (push.vertices + MESH_SUM_LANES * MESH_SUM_EACH - 1) / (MESH_SUM_LANES * MESH_SUM_EACH); }
/// The first of the vertices that this lane sums.
uint firstOfLane() { return (linearGroup() * MESH_SUM_LANES + gl_LocalInvocationIndex) * MESH_SUM_EACH; }
uint countAt(uint vertex) { return vertex < push.vertices ? counts[vertex] : 0; }
uint sumFrom(uint first) {
    uint vertex = first, sum = 0;
    do {
        sum += countAt(vertex);
    } while (++vertex < first + MESH_SUM_EACH);
    return sum;
}
