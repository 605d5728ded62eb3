// Leads the new vertices of a subdivision onto the field, by Newton's steps along its gradient, and gives them its normal.
//
// A vertex stays within MESH_MOST_MOVED of its edge's length about the edge's middle: so no triangle turns over. On a side
// of the region, where the solid is closed, it stays on that side; within the cap, far from the field, it stays put.
#define FIELD_GRADIENT
#include "mesh/mesh.glsl"
#include "field.glsl"
#include "lib/octahedral.glsl"

layout(local_size_x = MESH_GROUP) in;
layout(binding = 5, scalar) buffer Split { uvec4 split[]; };  // MeshVertex; the fourth word a length (split.comp)

const uint kSteps = 4;

void main() {
    fieldBegin();
    uint v = min(item(), push.vertices - 1);
    vec4 own = uintBitsToFloat(split[push.first + v]);
    vec3 middle = own.xyz, p = middle;
    // A side is where the vertices of both ends lie; where two sides meet, those of one are off the other by the rim.
    bvec3 atLow = lessThanEqual(middle, push.lo + push.rim), atHigh = greaterThanEqual(middle, push.hi - push.rim);
    vec3 side = vec3(atHigh) - vec3(atLow), free = 1.0 - abs(side);
    float most = (side == vec3(0) ? MESH_MOST_MOVED : MESH_MOST_MOVED_ON_SIDE) * own.w;
    vec4 f;
    float far;
    uint step = 0;
    do {  // one field, called in a loop: it is compiled once
        f = fieldGradient(p);
        vec3 along = f.xyz * free;
        float slope = dot(along, along);
        vec3 moved = p - along * (slope > 0.0 ? f.w / slope : 0.0) - middle;
        far = slope > 0.0 ? length(moved) : 1e30;
        moved = far > most ? moved * (most / far) : moved;
        // Not a number: where it was. A solid that leaves the region is closed there.
        p = step < kSteps && far < 1e30 ? clamp(middle + moved, push.lo, push.hi) : p;
    } while (++step <= kSteps);
    bool capped = side != vec3(0) && f.w < 0.0 && far > most;  // it would go on
    p = capped ? middle : p;
    float size = length(f.xyz);
    bool known = size > 0.0 && size < 1e30 && !capped;
    vec3 normal = known ? f.xyz / size : side == vec3(0) ? vec3(0, 1, 0) : normalize(side);
    if (item() < push.vertices) split[push.first + v] = uvec4(floatBitsToUint(p), packOctahedral(normal));
}
