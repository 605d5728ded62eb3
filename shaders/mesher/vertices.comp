// Places a vertex on each active edge: the root of the field along the edge, and the field's gradient there.
//
// Newton's method from the middle of the edge, kept within a bracket that starts as the edge (its ends differ in sign)
// and falls back to halving it. The derivative along the edge is one component of the gradient that the normal needs; the
// two others follow at the root. All of it calls the field, with one derivative, from one place in one loop, so that
// the field is compiled once. A vertex keeps a small distance from the ends of its edge: no two vertices then coincide, no
// triangle collapses, and the topology is the table's even where a sample is exactly zero.
#define FIELD_TANGENT
#include "mesher/mesher.glsl"
#include "field.glsl"
#include "lib/octahedral.glsl"

layout(local_size_x = MESHER_GROUP_VERTICES) in;
layout(binding = 5, scalar) readonly buffer BrickList { uint brickList[]; };
layout(binding = 10, scalar) readonly buffer VertexList { uint vertexList[]; };
layout(binding = 13, scalar) writeonly buffer Vertices { uvec4 vertices[]; };  // MeshVertex in one store

const uint kMostSteps = 10;       // halving alone then reaches a thousandth of the edge
const float kTolerance = 0.02;   // of the edge; the Newton step at the end squares what is left

void main() {
    fieldBegin();
    uint chunkStart = push.chunk * MESHER_VERTEX_CHUNK;
    uint index = linearGroup() * MESHER_GROUP_VERTICES + gl_LocalInvocationIndex;
    bool valid = chunkStart + index < counts.vertices && index < MESHER_VERTEX_CHUNK;
    uint word = vertexList[chunkStart + (valid ? index : 0)];
    uint bit = word & 31, axis = word >> 5 & 3, side = word >> 7 & 1, z = word >> 8 & 7;
    bool insideAtA = (word >> 31) != 0;
    uvec3 begin = unpackBrick(brickList[word >> 11 & 0xfffff]) * 8 + uvec3(side * 4 + (bit >> 3), bit & 7, z);
    uvec3 along = uvec3(equal(uvec3(axis), uvec3(0, 1, 2)));
    vec3 p = samplePosition(begin);
    vec3 edge = samplePosition(begin + along) - p;

    float a = 0.0, b = 1.0, t = 0.5, root;
    uint component = axis;  // of the gradient; the first one, along the edge, until the root is found
    vec3 gradient;
    bool searching = true, last;
    uint steps = 0;
    do {
        vec3 direction = vec3(component == 0, component == 1, component == 2);
        vec2 f = fieldTangent(p + t * edge, direction);
        gradient[component] = f.y;
        bool insideAtT = f.x < 0.0;
        a = searching && insideAtT == insideAtA ? t : a;
        b = searching && insideAtT != insideAtA ? t : b;
        float slope = f.y * push.cellSize[axis];  // by t
        float newton = f.x == 0.0 ? t : t - f.x / slope;
        float next = newton >= a && newton <= b ? newton : 0.5 * (a + b);
        root = searching ? next : root;
        bool found = abs(f.x) <= kTolerance * abs(slope) || ++steps >= kMostSteps;
        t = searching && !found ? next : t;
        last = !searching && component == (axis + 2) % 3;
        component = searching && !found ? component : (component + 1) % 3;
        searching = searching && !found;
    } while (!last);
    t = clamp(root, push.nudge, 1.0 - push.nudge);

    // An edge to the outside layer has its vertex on the region's boundary, a nudge away from the region's edges: the
    // vertices of two boundary faces must not meet there.
    uint rim = begin[axis] == 0 ? 1 : begin[axis] == push.cells[axis] + 1 ? 2 : 0;
    vec3 low = samplePosition(uvec3(1)), high = samplePosition(push.cells + 1);
    vec3 inset = push.nudge * push.cellSize;
    vec3 onRim = clamp(rim == 1 ? p + edge : p, low + inset, high - inset);
    vec3 position = rim == 0 ? p + t * edge : mix(onRim, rim == 1 ? low : high, vec3(along));
    float size = length(gradient.xyz);
    vec3 outwards = vec3(along) * (rim == 1 ? -1.0 : 1.0);
    vec3 normal = rim == 0 && size > 0.0 && size < 1e30 ? gradient.xyz / size : outwards;
    if (valid) vertices[index] = uvec4(floatBitsToUint(position), packOctahedral(normal));
}
