// The slide's naive way: every sample against every triangle, a chunk of triangles at a time.
#include "bake/bake.glsl"
#include "bake/triangle.glsl"

layout(local_size_x = BAKE_GROUP) in;
layout(binding = 1, scalar) buffer Least { uvec2 least[]; };  // bits of the squared distance, the triangle

void main() {
    uint index = item();
    if (index >= push.items) return;
    vec3 p = vec3(placeOf(index));
    float best = uintBitsToFloat(least[index].x);
    uint triangle = least[index].y;
    for (int i = push.axis; i < push.slice; ++i) {  // the chunk
        Triangle t = triangleAt(uint(i));
        vec3 ab = t.b - t.a, bc = t.c - t.b, ca = t.a - t.c, pa = p - t.a, pb = p - t.b, pc = p - t.c, n = t.normal;
        float size = dot(n, n), height = dot(pa, n);
        bool face = size > 0.0 && min(dot(cross(ab, pa), n), min(dot(cross(bc, pb), n), dot(cross(ca, pc), n))) >= 0.0;
        vec3 u = pa - ab * clamp(dot(pa, ab) / max(dot(ab, ab), 1e-30), 0.0, 1.0);
        vec3 v = pb - bc * clamp(dot(pb, bc) / max(dot(bc, bc), 1e-30), 0.0, 1.0);
        vec3 w = pc - ca * clamp(dot(pc, ca) / max(dot(ca, ca), 1e-30), 0.0, 1.0);
        float squared = face ? height * height / size : min(dot(u, u), min(dot(v, v), dot(w, w)));
        triangle = squared < best ? uint(i) : triangle;
        best = min(squared, best);
    }
    least[index] = uvec2(floatBitsToUint(best), triangle);
}
