// Field-language functions that several bodies of this folder begin with. Not for use outside graph/nodes/.
#pragma once

namespace fw {

/// ext2, ext3: distance to the set where every q_i <= 0, for the q_i of orthogonal slabs; exact on both
/// sides. On the surface itself the case of the inside holds, whose gradient is not that of a root at 0.
inline constexpr const char* kExtent = R"(
float ext2(vec2 q) {
    float inside = max(q.x, q.y);
    return inside <= 0.0 ? inside : length(max(q, 0.0));
}
float ext3(vec3 q) {
    float inside = max(q.x, q.y, q.z);
    return inside <= 0.0 ? inside : length(max(q, 0.0));
}
)";

/// segment: distance to the segment from a to b, which may be one point.
inline constexpr const char* kSegment = R"(
float segment(vec2 q, vec2 a, vec2 b) {
    vec2 along = b - a;
    return length(q - a - along * clamp(dot(q - a, along) / max(dot(along, along), 1e-12), 0.0, 1.0));
}
)";

/// sector: folds the plane into the half sector from +y to PI/n to its right, by log2(n) reflections, each of
/// which keeps distances to a figure with n-fold mirror symmetry. A reflection is chosen by a comparison
/// rather than written as q - 2 min(dot, 0) n, so that intervals stay narrow away from the mirrors.
inline constexpr const char* kSector = R"(
vec2 sector(vec2 q, int n) {
    q.x = abs(q.x);
    for (int i = 0; i < 7; i++) {
        float mirror = PI / n * exp2(6.0 - i);
        if (mirror < PI) {
            float s = sin(2.0 * mirror);
            float c = cos(2.0 * mirror);
            if (q.y * sin(mirror) < q.x * cos(mirror)) q = vec2(q.y * s - q.x * c, q.y * c + q.x * s);
        }
    }
    return q;
}
float regularPolygon(vec2 p, int n, float apothem) {
    vec2 q = sector(vec2(p.x, -p.y), n);
    float rim = q.y - apothem;
    float d = rim <= 0.0 ? rim : length(vec2(max(q.x - apothem * tan(PI / n), 0.0), rim));
    return max(d, length(p) * cos(PI / n) - apothem);
}
)";

/// chamferMin, stairsMin: the minimum of a and b with the corner between them filled over a width k >= 0, as
/// smooth_min does it for the round profile; stairs have n steps. rolledMin: filled by a ball of radius k
/// that touches both; m and n are slopes of a and b, of any length.
inline constexpr const char* kBlend = R"(
float chamferMin(float a, float b, float k) { return min(a, b, (a + b - k) * sqrt(0.5)); }
float stairsMin(float a, float b, float k, float n) {
    float s = max(k, 1e-9) / (n + 1.0);
    return min(a, b, 0.5 * (a + b - k + abs(mod(b - k - a + s, 2.0 * s) - s)));
}
float rolledMin(float a, float b, float k, vec3 m, vec3 n) {
    float c = clamp(dot(m, n) / max(length(m) * length(n), 1e-30), -0.9999, 0.9999);
    float toA = k - a;
    float toB = k - b;
    float s = toA - c * toB;
    float t = toB - c * toA;
    bool inWedge = max(a, b) < 2.0 * k && s > 0.0 && t > 0.0;
    return min(a, b, inWedge ? k - sqrt((s * toA + t * toB) / (1.0 - c * c)) : 1e9);
}
)";

}  // namespace fw
