// The sums before each group of counts.
#include "mesh/mesh.glsl"
#include "mesher/top.glsl"

void main() { sumUp((push.vertices + MESH_SUM_LANES * MESH_SUM_EACH - 1) / (MESH_SUM_LANES * MESH_SUM_EACH)); }
