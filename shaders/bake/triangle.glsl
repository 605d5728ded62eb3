// The nearest point of a triangle.

layout(binding = 0, rgba32ui) restrict readonly uniform uimageBuffer corners;  // three texels of floats a triangle

struct Triangle {
    vec3 a, b, c, normal;  // the normal as long as twice the area; 0 if there is none
};

Triangle triangleAt(uint t) {
    int first = 3 * int(t);
    vec3 a = uintBitsToFloat(imageLoad(corners, first).xyz), b = uintBitsToFloat(imageLoad(corners, first + 1).xyz);
    vec3 c = uintBitsToFloat(imageLoad(corners, first + 2).xyz);
    return Triangle(a, b, c, cross(b - a, c - a));
}

float along(vec3 p, vec3 a, vec3 b) {
    vec3 ab = b - a;
    return clamp(dot(p - a, ab) / max(dot(ab, ab), 1e-30), 0.0, 1.0);
}

// The barycentric coordinates, and what the point is on: 0, the face; 1 to 3, the side ab, bc, ca; 4 to 6, a corner.
vec3 nearestWeights(Triangle t, vec3 p, out uint feature) {
    vec3 n = t.normal;
    vec3 w = vec3(dot(cross(t.c - t.b, p - t.b), n), dot(cross(t.a - t.c, p - t.c), n), dot(cross(t.b - t.a, p - t.a), n));
    bool face = dot(n, n) > 0.0 && all(greaterThanEqual(w, vec3(0.0)));
    float u = along(p, t.a, t.b), v = along(p, t.b, t.c), s = along(p, t.c, t.a);
    vec3 ab = p - mix(t.a, t.b, u), bc = p - mix(t.b, t.c, v), ca = p - mix(t.c, t.a, s);
    float dab = dot(ab, ab), dbc = dot(bc, bc), dca = dot(ca, ca);
    bool first = dab <= dbc && dab <= dca, second = !first && dbc <= dca;
    float at = first ? u : second ? v : s;
    uint side = first ? 0 : second ? 1 : 2;
    feature = face ? 0 : at <= 0.0 ? 4 + side : at >= 1.0 ? 4 + (side + 1) % 3 : 1 + side;
    vec3 onSide = first ? vec3(1.0 - at, at, 0.0) : second ? vec3(0.0, 1.0 - at, at) : vec3(at, 0.0, 1.0 - at);
    return face ? w / dot(n, n) : onSide;
}
