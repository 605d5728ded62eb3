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
layout(binding = 11, scalar) readonly buffer VertexList { uint vertexList[]; };
layout(binding = 13, scalar) writeonly buffer Vertices { uvec4 vertices[]; };  // MeshVertex in one store

const uint kMostEvaluations = 9;
const float kTolerance = 0.01;  // of the value's range over the edge; the Newton step squares what is left

void main() {
    fieldBegin();
    uint chunkStart = push.chunk * MESHER_VERTEX_CHUNK;
    uint index = linearGroup() * MESHER_GROUP_VERTICES + gl_LocalInvocationIndex;
    bool valid = chunkStart + index < counts.vertices && index < MESHER_VERTEX_CHUNK;
    uint word = vertexList[chunkStart + (valid ? index : 0)];
    uint bit = word & 31, z = word >> 5 & 7, strip = word >> 8 & 7;
    uint axis = strip >> 1;
    uvec3 begin = unpackBrick(brickList[word >> 11]) * 8 + uvec3((strip & 1) * 4 + (bit >> 3), bit & 7, z);
    uvec3 along = uvec3(equal(uvec3(axis), uvec3(0, 1, 2)));
    vec3 p = samplePosition(begin);
    vec3 edge = samplePosition(begin + along) - p;

    float a = 0.0, b = 1.0, fa = 0.0, fb = 0.0;  // the bracket, and the (possibly halved) values at its ends
    float t = 0.0, scale = 0.0, f;
    bool wasAtA = false;
    uint i = 0;
    do {
        f = fieldValue(p + t * edge);
        bool first = i == 0, second = i == 1;
        bool atA = (f < 0.0) == (fa < 0.0);  // the new point replaces the end whose sign it has
        float halve = i > 2 && atA == wasAtA ? 0.5 : 1.0;  // an end that stays twice is pulled in
        wasAtA = atA;
        fb = first ? fb : second || !atA ? f : fb * halve;
        b = first || second || atA ? b : t;
        fa = first || (!second && atA) ? f : second ? fa : fa * halve;
        a = !first && !second && atA ? t : a;
        scale += first || second ? abs(f) : 0.0;
        float secant = (a * fb - b * fa) / (fb - fa);
        bool usable = secant >= a && secant <= b;  // false for NaN
        t = first ? 1.0 : usable ? secant : 0.5 * (a + b);
    } while (++i < 3 || (i < kMostEvaluations && abs(f) > kTolerance * scale));

    vec4 gradient = fieldGradient(p + t * edge);
    float newton = t - gradient.w / dot(gradient.xyz, edge);
    t = newton >= a && newton <= b ? newton : t;
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
