// Intervals in float, vec2(least, greatest): the GPU twin of graph/base/interval.h. "Everything" is ±1e30 so that no
// infinity or NaN arises, and what transcendental functions err by on this device is added as slack.
//
// Sums, products and roots are not rounded outwards one by one, which would triple the code and its compile time:
// values round alike, and whoever culls by an interval adds a margin (see iMargin) and can tell a hole from none.

#include "lib/smooth_minimum.glsl"

// What the device errs by beyond a few units in the last place: runtime/gpu/precision.h.
layout(constant_id = 100) const float kSineError = 0.0;
layout(constant_id = 101) const float kCurveError = 0.0;

// What fields call by the thousand are no functions: a driver that puts each call's body in its place one by one takes a
// time that grows with their number squared. What is written twice is computed once.
#define iOut(a) ((a) + abs(a) * vec2(-1.2e-7, 1.2e-7))
#define iAbs(a) vec2(max(0.0, max((a).x, -(a).y)), max(-(a).x, (a).y))
#define iSquare(a) (min(iAbs(a), 1e15) * min(iAbs(a), 1e15))
// As the ends of an interval err, so do the values between them.
vec2 iSlack(vec2 a) { return a + (abs(a) + 1.0) * (1e-5 + 2.0 * kCurveError) * vec2(-1.0, 1.0); }
vec2 iCut(vec2 a) { return clamp(a, -1e30, 1e30); }
// The result widened by the rounding that its operations may have gathered, relative to the coordinates `reach` too.
vec2 iMargin(vec2 a, float reach) { return a + (abs(a) + reach) * vec2(-2e-6, 2e-6); }
vec2 iMultiply(vec2 a, vec2 b) {
    vec4 p = a.xxyy * b.xyxy;
    return iCut(vec2(min(min(p.x, p.y), min(p.z, p.w)), max(max(p.x, p.y), max(p.z, p.w))));
}
vec2 iDivide(vec2 a, vec2 b) {
    return b.x <= 0.0 && b.y >= 0.0 ? vec2(-1e30, 1e30) : iMultiply(a, iCut(1.0 / b.yx));
}
vec2 iExp(vec2 a) { return clamp(iSlack(exp(min(a, 69.0))), 0.0, 1e30); }
// 0 to the power of 0 is 1.
float iPowerOf(float a, float b) { return a > 0.0 ? pow(a, b) : b > 0.0 ? 0.0 : b < 0.0 ? 1e30 : 1.0; }
vec2 iPower(vec2 a, vec2 b) {
    vec2 base = max(a, 0.0);
    vec4 p = vec4(iPowerOf(base.x, b.x), iPowerOf(base.x, b.y), iPowerOf(base.y, b.x), iPowerOf(base.y, b.y));
    return clamp(iSlack(vec2(min(min(p.x, p.y), min(p.z, p.w)), max(max(p.x, p.y), max(p.z, p.w)))), 0.0, 1e30);
}
// The quotient keeps one integer value over the interval: a shift; else the whole period. Everything if b may be 0.
// Quotients err by up to 2.5 units in the last place: what is left of a multiple may be a little below 0, or above b.
vec2 iRemainder(vec2 a, vec2 b, float k, bool shifts, vec2 range) {
    vec2 slack = (iAbs(a).y + iAbs(b).y) * vec2(-5e-7, 5e-7);
    vec2 result = (shifts && b.x == b.y ? a - k * b.x : range) + slack;
    return b.x <= 0.0 && b.y >= 0.0 ? vec2(-1e30, 1e30) : iCut(result);
}
vec2 iModulo(vec2 a, vec2 b) {
    float k = floor(a.x / b.x);
    return iRemainder(a, b, k, floor(a.y / b.x) == k, vec2(min(0.0, b.x), max(0.0, b.y)));
}
vec2 iTruncatedModulo(vec2 a, vec2 b) {
    float most = iAbs(b).y, k = trunc(a.x / b.x);
    return iRemainder(a, b, k, trunc(a.y / b.x) == k,
                      vec2(a.x < 0.0 ? max(-most, a.x) : 0.0, a.y > 0.0 ? min(most, a.y) : 0.0));
}
vec2 iSin(vec2 a) {
    const float tau = 6.28318531, quarter = 1.57079633;
    vec2 ends = sin(a);
    bool low = -quarter + ceil((a.x + quarter) / tau - 1e-5) * tau <= a.y + 1e-4;
    bool high = quarter + ceil((a.x - quarter) / tau - 1e-5) * tau <= a.y + 1e-4;
    float slack = 1e-5 + 2.0 * kSineError + max(abs(a.x), abs(a.y)) * 5e-7, most = 1.0 + kSineError;
    vec2 range = vec2(low ? -most : min(ends.x, ends.y) - slack, high ? most : max(ends.x, ends.y) + slack);
    return a.y - a.x >= tau || max(abs(a.x), abs(a.y)) > 1e5 ? vec2(-most, most) : range;
}
vec2 iArcTangent2(vec2 y, vec2 x) {
    if (x.x <= 0.0 && y.x <= 0.0 && y.y >= 0.0) return vec2(-3.141594, 3.141594);
    vec4 t = vec4(atan(y.x, x.x), atan(y.x, x.y), atan(y.y, x.x), atan(y.y, x.y));
    return iSlack(vec2(min(min(t.x, t.y), min(t.z, t.w)), max(max(t.x, t.y), max(t.z, t.w))));
}
vec2 iEqual(vec2 a, vec2 b) {
    return vec2(a.x == a.y && b.x == b.y && a.x == b.x, a.y >= b.x && b.y >= a.x);
}
vec2 iSelect(vec2 c, vec2 a, vec2 b) {
    return c.x > 0.5 ? a : c.y < 0.5 ? b : vec2(min(a.x, b.x), max(a.y, b.y));
}
// It grows with a and b, and falls with k.
vec2 iSmoothMin(vec2 a, vec2 b, vec2 k) {
    vec2 slack = (min(abs(a) + abs(b), 1e30) + iAbs(k).y) * vec2(-2.4e-7, 2.4e-7);
    return iCut(vec2(fieldSmoothMin(a.x, b.x, k.y), fieldSmoothMin(a.y, b.y, k.x)) + slack);
}
vec3 iCentre(vec2 x, vec2 y, vec2 z) { return 0.5 * vec3(x.x + x.y, y.x + y.y, z.x + z.y); }
vec2 iNoise(float centre, vec2 x, vec2 y, vec2 z, float slope, float least, float most) {
    // What is lost of a place within its cell where coordinates are large.
    float rounding = 5e-7 * (iAbs(x).y + iAbs(y).y + iAbs(z).y);
    float radius = 0.5 * length(vec3(x.y - x.x, y.y - y.x, z.y - z.x)) + rounding;
    return clamp(centre + (slope * radius + 1e-4) * vec2(-1.0, 1.0), least, most);
}
