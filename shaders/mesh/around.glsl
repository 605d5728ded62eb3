// What lies around a vertex: the places of its corners in the sorted lists, and the mesh's vertices.
#include "mesh/mesh.glsl"
#include "mesh/exact_sum.glsl"

layout(local_size_x = MESH_GROUP) in;
layout(binding = 0, rgba32ui) readonly uniform uimageBuffer vertices;  // MeshVertex
layout(binding = 1, scalar) readonly buffer Counts { uint counts[]; };
layout(binding = 2, scalar) readonly buffer Starts { uint starts[]; };
layout(binding = 3, scalar) readonly buffer Next { uint next[]; };

/// Place in the lists of a vertex's corner i, or of its last; of some corner where it has none.
uint cornerOf(uint first, uint count, uint i) { return count > 0 ? first + min(i, count - 1) : 0; }
vec3 positionOf(uint vertex) { return uintBitsToFloat(imageLoad(vertices, int(vertex)).xyz); }
