// Places a vertex on each active edge: the root of the field along the edge, and the field's gradient there.
//
// Bracketing by the Illinois variant of the secant method until the value is small beside those at the edge's ends,
// then one Newton step with the gradient that the normal needs anyway. The field is evaluated in one loop, so that it is
// compiled once. A vertex keeps a small distance from the ends of its edge: no two vertices then coincide, no
// triangle collapses, and the topology is the table's even where a sample is exactly zero.
#define FIELD_VALUE
#define FIELD_GRADIENT
#include "mesher/mesher.glsl"
#include "field.glsl"
#include "lib/octahedral.glsl"

layout(local_size_x = MESHER_GROUP_VERTICES) in;
layout(binding = 5, scalar) readonly buffer BrickList { uint brickList[]; };
layout(binding = 10, scalar) readonly buffer VertexList { uint vertexList[]; };
layout(binding = 13, scalar) writeonly buffer Vertices { uvec4 vertices[]; };  // MeshVertex in one store

const uint kMostSteps = 6;
const float kTolerance = 0.02;  // of the value's range over the edge; the Newton step at the end squares what is left

void main() {
    fieldBegin();
    uint chunkStart = push.chunk * MESHER_VERTEX_CHUNK;
    uint index = linearGroup() * MESHER_GROUP_VERTICES + gl_LocalInvocationIndex;
    bool valid = chunkStart + index < counts.vertices && index < MESHER_VERTEX_CHUNK;
    uint word = vertexList[chunkStart + (valid ? index : 0)];
    uint bit = word & 31, axis = word >> 5 & 3, side = word >> 7 & 1, z = word >> 8 & 7;
    uvec3 begin = unpackBrick(brickList[word >> 11]) * 8 + uvec3(side * 4 + (bit >> 3), bit & 7, z);
    uvec3 along = uvec3(equal(uvec3(axis), uvec3(0, 1, 2)));
    vec3 p = samplePosition(begin);
    vec3 edge = samplePosition(begin + along) - p;

    float fa = fieldValue(p), fb = fieldValue(p + edge);
    float a = 0.0, b = 1.0, scale = abs(fa) + abs(fb);
    float t = fa / (fa - fb), next = clamp(t, 0.0, 1.0);
    next = t == t ? next : 0.5;
    vec4 gradient;
    bool done;
    uint i = 0;
    do {
        t = next;
        gradient = fieldGradient(p + t * edge);
        float f = gradient.w;
        bool atA = (f < 0.0) == (fa < 0.0);  // the new point replaces the end whose sign it has
        a = atA ? t : a;
        fa = atA ? f : fa;
        b = atA ? b : t;
        fb = atA ? fb : f;
        float newton = t - f / dot(gradient.xyz, edge), secant = (a * fb - b * fa) / (fb - fa);
        next = i < 3 && secant >= a && secant <= b ? secant : 0.5 * (a + b);
        next = newton >= a && newton <= b ? newton : next;
        done = abs(f) <= kTolerance * scale;
    } while (++i < kMostSteps && !done);
    t = next;
    t = clamp(t, push.nudge, 1.0 - push.nudge);

    // An edge to the outside layer has its vertex on the region's boundary, a nudge away from the region's edges: the
    // vertices of two boundary faces must not meet there.
    uint rim = begin[axis] == 0 ? 1 : begin[axis] == push.cells[axis] + 1 ? 2 : 0;
    vec3 low = samplePosition(uvec3(1)), high = samplePosition(push.cells + 1);
    vec3 inset = vec3(push.nudge * push.cellSize);
    vec3 onRim = clamp(rim == 1 ? p + edge : p, low + inset, high - inset);
    vec3 position = rim == 0 ? p + t * edge : mix(onRim, rim == 1 ? low : high, vec3(along));
    float size = length(gradient.xyz);
    vec3 outwards = vec3(along) * (rim == 1 ? -1.0 : 1.0);
    vec3 normal = rim == 0 && size > 0.0 && size < 1e30 ? gradient.xyz / size : outwards;
    if (valid) vertices[index] = uvec4(floatBitsToUint(position), packOctahedral(normal));
}
