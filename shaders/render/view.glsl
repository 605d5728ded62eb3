// A picture's places, rays and depths. After render.h.
#include "lib/unfolded.glsl"

// That a lane does of a listed tile.
uvec2 pixelOf(uint tile, uint lane) { return uvec2(tile & 0xffff, tile >> 16) * RENDER_TILE + uvec2(lane % RENDER_TILE, lane / RENDER_TILE); }

vec2 placeOf(uvec2 pixel, uvec2 size) {
    vec2 place = (vec2(pixel) + 0.5) / vec2(size) * 2.0 - 1.0;
    return vec2(place.x, -place.y);
}

// Not of unit length: one metre along `forward`.
vec3 rayOf(View view, vec2 place) {
    place += view.jitter;
    return view.forward + place.x * view.right + place.y * view.up;
}

vec3 pointAt(View view, vec2 place, float depth) { return view.eye + rayOf(view, place) * (view.near / depth); }

// The place where p is seen, and in z its distance along `forward`.
vec3 project(View view, vec3 p) {
    vec3 v = p - view.eye;
    float along = dot(view.forward, v);
    vec2 place = vec2(dot(view.right, v) / dot(view.right, view.right), dot(view.up, v) / dot(view.up, view.up));
    return vec3(place / along - view.jitter, along);
}

// Bits that differ between neighbouring pixels in no visible order.
uint scrambled(uvec2 pixel) {
    uint bits = (pixel.x * 0x9E3779B1u) ^ (pixel.y * 0x85EBCA77u);
    bits = (bits ^ bits >> 15) * 0x2C1B3C6Du;
    return bits ^ bits >> 13;
}

// The R2 sequence (Roberts 2018), from a start that is the pixel's own: evenly in the unit square.
vec2 evenly(uvec2 pixel, uint number) {
    uint bits = scrambled(pixel);
    uvec2 turned = uvec2(bits, bits * 0x297A2D39u) + number * uvec2(3242174889u, 2447445414u);  // 0.7549, 0.5698 of 2^32
    return vec2(turned >> 8) / 16777216.0;
}

// Two axes across n: Duff et al.'s ("Building an orthonormal basis, revisited", 2017).
void axesAcross(vec3 n, out vec3 x, out vec3 y) {
    float s = n.z < 0.0 ? -1.0 : 1.0, a = -1.0 / (s + n.z), b = n.x * n.y * a;
    x = vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x), y = vec3(b, s + n.y * n.y * a, -n.y);
}

// Cosine-distributed about n.
vec3 cosineDirection(vec3 n, vec2 u) {
    vec3 x, y;
    axesAcross(n, x, y);
    float angle = 6.2831853 * u.x, r = sqrt(u.y);
    return r * cos(angle) * x + r * sin(angle) * y + sqrt(1.0 - u.y) * n;
}
