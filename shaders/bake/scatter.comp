// Measures each triangle against the samples of its band, in the talk's words those of the slices that it can affect.
// The least squared distance wins and, where two are equal, the triangle of the lower number: so the result does not
// depend on the order. A row is gone through only where it comes near the triangle's plane.
#extension GL_EXT_shader_atomic_int64 : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#include "bake/bake.glsl"
#include "bake/triangle.glsl"

layout(local_size_x = BAKE_GROUP) in;
layout(binding = 1, scalar) readonly buffer Items { BakeItem items[]; };
layout(binding = 2, scalar) buffer Nearest { uint64_t nearest[]; };  // bits of the squared distance, the triangle
layout(binding = 3, scalar) buffer NearestWords { uint nearestWords[]; };  // the same

void main() {
    uint index = item();
    if (index >= push.items) return;
    BakeItem work = items[index];
    Triangle t = triangleAt(work.triangle);
    const float band = BAKE_BAND;
    ivec3 lo = max(ivec3(ceil(min(t.a, min(t.b, t.c)) - band)), ivec3(0));
    ivec3 hi = min(ivec3(floor(max(t.a, max(t.b, t.c)) + band)), push.size - 1);
    ivec2 first = ivec2(work.rows & 0xFFFFu, work.rows >> 16);
    lo.yz = max(lo.yz, first);
    hi.yz = min(hi.yz, first + BAKE_ROWS - 1);

    float size = length(t.normal);
    vec3 n = t.normal / max(size, 1e-20);
    vec3 ab = t.b - t.a, bc = t.c - t.b, ca = t.a - t.c;
    float iab = 1.0 / max(dot(ab, ab), 1e-30), ibc = 1.0 / max(dot(bc, bc), 1e-30), ica = 1.0 / max(dot(ca, ca), 1e-30);
    vec3 outAb = cross(ab, n), outBc = cross(bc, n), outCa = cross(ca, n);
    float steep = abs(n.x) > 0.01 ? 1.0 / n.x : 0.0;

    for (int z = lo.z; z <= hi.z; ++z)
        for (int y = lo.y; y <= hi.y; ++y) {
            // Along the row the plane's distance is n.x (x - cross).
            float middle = t.a.x - (n.y * (float(y) - t.a.y) + n.z * (float(z) - t.a.z)) * steep;
            float reach = (band + 0.01) * abs(steep);
            int begin = steep != 0.0 ? max(lo.x, int(ceil(max(middle - reach, -1.0)))) : lo.x;
            int end = steep != 0.0 ? min(hi.x, int(floor(min(middle + reach, 65536.0)))) : hi.x;
            int row = (z * push.size.y + y) * push.size.x;
            for (int x = begin; x <= end; ++x) {
                vec3 p = vec3(x, y, z), pa = p - t.a, pb = p - t.b, pc = p - t.c;
                bool face = size > 0.0 && max(dot(outAb, pa), max(dot(outBc, pb), dot(outCa, pc))) <= 0.0;
                vec3 u = pa - ab * clamp(dot(pa, ab) * iab, 0.0, 1.0);
                vec3 v = pb - bc * clamp(dot(pb, bc) * ibc, 0.0, 1.0);
                vec3 w = pc - ca * clamp(dot(pc, ca) * ica, 0.0, 1.0);
                float height = dot(pa, n);
                float squared = face ? height * height : min(dot(u, u), min(dot(v, v), dot(w, w)));
                uint bits = floatBitsToUint(squared);
                if (squared <= band * band && bits <= nearestWords[2 * (row + x) + 1])
                    atomicMin(nearest[row + x], uint64_t(bits) << 32 | uint64_t(work.triangle));
            }
        }
}
