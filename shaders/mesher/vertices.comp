// Places a vertex on each active edge: the root of the field along the edge, and the field's gradient there.
//
// Newton's method from the middle of the edge, kept within a bracket that starts as the edge (its ends differ in sign)
// and falls back to halving it. The derivative along the edge is a component of the gradient that the normal needs, and
// most of a field's operations depend on one axis or two, so that a gradient costs little more than one derivative.
// The field is called from one place, in a loop: it is compiled once. A vertex keeps a small distance from the ends
// of its edge: no two vertices then coincide, no triangle collapses, and the topology is the table's even where a
// sample is exactly zero.
#define FIELD_PRUNED
#define FIELD_GRADIENT
#include "mesher/mesher.glsl"
#include "field.glsl"
#include "lib/octahedral.glsl"

layout(local_size_x = MESHER_GROUP_VERTICES) in;
layout(binding = MESHER_AT_BRICK_LIST, scalar) readonly buffer BrickList { uint brickList[]; };
layout(binding = MESHER_AT_VERTEX_LIST, scalar) readonly buffer VertexList { uint vertexList[]; };
layout(binding = MESHER_AT_MESH, scalar) writeonly buffer Vertices { uvec4 vertices[]; };  // MeshVertex in one store

const uint kMostSteps = 10;       // halving alone then reaches a thousandth of the edge
const float kTolerance = 0.02;   // of the edge; the Newton step at the end squares what is left

void main() {
    fieldBegin();
    uint chunkStart = push.chunk * MESHER_VERTEX_CHUNK;
    uint index = linearGroup() * MESHER_GROUP_VERTICES + gl_LocalInvocationIndex;
    bool valid = chunkStart + index < counts.edges && index < MESHER_VERTEX_CHUNK;
    uint word = vertexList[chunkStart + (valid ? index : 0)];
    uint bit = word & 31, axis = word >> 5 & 3, side = word >> 7 & 1, z = word >> 8 & 7;
    bool insideAtA = (word >> 31) != 0;
    uint slot = word >> 11 & 0xfffff;
    fieldChoose(placeOfBrick(slot));
    uvec3 begin = unpackBrick(brickList[slot]) * 8 + uvec3(side * 4 + (bit >> 3), bit & 7, z);
    uvec3 along = uvec3(equal(uvec3(axis), uvec3(0, 1, 2)));
    vec3 p = samplePosition(begin);
    vec3 edge = samplePosition(begin + along) - p;

    float a = 0.0, b = 1.0, t = 0.5, root;
    vec4 f;  // gradient and value at t
    bool found = false;
    uint steps = 0;
    do {  // as long as any lane: in one that left the loop Mesa 22.3 goes on to write f, from loads that yield nothing
        f = fieldGradient(p + t * edge);
        bool insideAtT = f.w < 0.0;
        a = !found && insideAtT == insideAtA ? t : a;
        b = !found && insideAtT != insideAtA ? t : b;
        float slope = dot(f.xyz, edge);  // by t
        float newton = f.w == 0.0 ? t : t - f.w / slope;
        float next = newton >= a && newton <= b ? newton : 0.5 * (a + b);
        root = found ? root : next;
        found = found || abs(f.w) <= kTolerance * abs(slope) || ++steps >= kMostSteps;
        t = found ? t : next;
    } while (subgroupAny(!found));
    t = clamp(root, push.nudge, 1.0 - push.nudge);

    // An edge to the outside layer has its vertex on the region's boundary, a nudge away from the region's edges: the
    // vertices of two boundary faces must not meet there.
    uint rim = begin[axis] == 0 ? 1 : begin[axis] == push.cells[axis] + 1 ? 2 : 0;
    vec3 low = samplePosition(uvec3(1)), high = samplePosition(push.cells + 1);
    vec3 inset = push.nudge * push.cellSize;
    vec3 onRim = clamp(rim == 1 ? p + edge : p, low + inset, high - inset);
    vec3 position = rim == 0 ? p + t * edge : mix(onRim, rim == 1 ? low : high, vec3(along));
    float size = length(f.xyz);
    vec3 outwards = vec3(along) * (rim == 1 ? -1.0 : 1.0);
    vec3 normal = rim == 0 && size > 0.0 && size < 1e30 ? f.xyz / size : outwards;
    if (valid) vertices[index] = uvec4(floatBitsToUint(position), packOctahedral(normal));
}
