// The quadratic smooth minimum, whose corner where a = b is filled k / 4 deep: graph/ir/ops.cpp on the GPU. Operands that
// are k apart are not changed by one bit.
#ifndef FW_SMOOTH_MINIMUM_GLSL
#define FW_SMOOTH_MINIMUM_GLSL

float fieldSmoothMin(float a, float b, float k) {
    float h = max(k - abs(a - b), 0.0);
    return min(a, b) - h * h * (0.25 / max(k, 1e-9));
}
/// Its derivative along a direction, from those of its operands.
float fieldSmoothMinSlope(float a, float b, float k, float da, float db, float dk) {
    float share = max(k - abs(a - b), 0.0) / max(k, 1e-9), nearer = a <= b ? da : db, other = a <= b ? db : da;
    return share > 0.0 ? nearer + 0.5 * share * (other - nearer) - share * (0.5 - 0.25 * share) * dk : nearer;
}
/// With gradients in xyz, of operands whose values are w.
vec4 fieldSmoothMin(vec4 a, vec4 b, float k) {
    float share = max(k - abs(a.w - b.w), 0.0) / max(k, 1e-9);
    vec3 nearer = a.w <= b.w ? a.xyz : b.xyz, other = a.w <= b.w ? b.xyz : a.xyz;
    return vec4(share > 0.0 ? nearer + 0.5 * share * (other - nearer) : nearer, fieldSmoothMin(a.w, b.w, k));
}
#endif
