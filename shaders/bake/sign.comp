// The nearest point of each sample of the band, and whether it is inside: by the normal of the feature that the point is
// on (Baerentzen and Aanaes 2005).
#include "bake/bake.glsl"
#include "bake/triangle.glsl"

layout(local_size_x = BAKE_GROUP) in;
layout(binding = 3, scalar) readonly buffer NearestWords { uint nearestWords[]; };
layout(binding = 4, rgba32ui) restrict writeonly uniform uimageBuffer state;
layout(binding = 5, scalar) readonly buffer Band { uint band[]; };
layout(binding = 6, scalar) readonly buffer Counts { BakeCounts counts; };
layout(binding = 7, scalar) readonly buffer Normals { vec3 normals[]; };  // seven a triangle

void main() {
    uint place = item();
    if (place >= counts.listed) return;
    uint index = band[place], triangle = nearestWords[2 * index], feature;
    Triangle t = triangleAt(triangle);
    vec3 p = vec3(placeOf(index));
    vec3 w = nearestWeights(t, p, feature);
    vec3 nearest = w.x * t.a + w.y * t.b + w.z * t.c, off = p - nearest;
    vec3 normal = normals[7 * triangle + feature];
    bool inside = push.signs != 0 && dot(off, normal) < 0.0;
    float distance = length(off);
    // On a face the gradient is its normal; on an edge there is none.
    bool smooth_ = dot(normal, normals[7 * triangle]) > 0.99;
    if (distance < BAKE_LEAST) nearest = smooth_ ? p - normal * (inside ? -BAKE_LEAST : BAKE_LEAST) : p;
    imageStore(state, int(index), uvec4(floatBitsToUint(nearest), triangle | (inside ? BAKE_INSIDE : 0)));
}
