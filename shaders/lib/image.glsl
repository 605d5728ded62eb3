// Images of the field: the float twin of graph/assets/image.cpp, which says what a layer is. All images lie in one
// buffer of words, four bytes a texel; the text generated for a field declares it as fieldImages before it includes
// this, and calls these with an image's place and size.

float imageTexel(uint first, ivec2 size, ivec2 at, int channel) {
    uint word = fieldImages[first + uint(at.y * size.x + at.x)];
    float c = float(word >> uint(8 * channel) & 255u) * (1.0 / 255.0);
    if (channel == 3) return c;  // a constant: the choice is made when the shader is compiled
    return c <= 0.04045 ? c * (1.0 / 12.92) : pow((c + 0.055) * (1.0 / 1.055), 2.4);
}

// (d/du, d/dv, 0, value).
vec4 imageSample(uint first, ivec2 size, vec2 uv, int channel) {
    vec2 scale = vec2(size);
    vec2 unit = vec2(abs(uv.x) < 1e7 ? fract(uv.x) : 0.0, abs(uv.y) < 1e7 ? fract(uv.y) : 0.0);
    vec2 at = unit * scale - 0.5, base = floor(at), f = at - base;
    ivec2 lo = ivec2(base), hi = lo + 1;
    lo = ivec2(lo.x < 0 ? size.x - 1 : lo.x, lo.y < 0 ? size.y - 1 : lo.y);
    hi = ivec2(hi.x >= size.x ? 0 : hi.x, hi.y >= size.y ? 0 : hi.y);
    float a = imageTexel(first, size, lo, channel), b = imageTexel(first, size, ivec2(hi.x, lo.y), channel);
    float c = imageTexel(first, size, ivec2(lo.x, hi.y), channel), d = imageTexel(first, size, hi, channel);
    float below = mix(a, b, f.x), above = mix(c, d, f.x);
    return vec4(scale.x * mix(b - a, d - c, f.y), scale.y * (above - below), 0.0, mix(below, above, f.y));
}

// Contains every value over a box of u and v; `slope` bounds the derivatives and `range` the values.
vec2 imageRange(uint first, ivec2 size, vec2 u, vec2 v, int channel, vec2 slope, vec2 range) {
    float centre = imageSample(first, size, 0.5 * vec2(u.x + u.y, v.x + v.y), channel).w;
    float far = max(max(-u.x, u.y), max(-v.x, v.y));
    float reach = dot(slope, 0.5 * vec2(u.y - u.x, v.y - v.x) + 2.4e-7 * (1.0 + far)) + 1e-5;
    return far > 1e6 ? range + vec2(-1e-5, 1e-5) : clamp(centre + vec2(-reach, reach), range.x - 1e-5, range.y + 1e-5);
}
