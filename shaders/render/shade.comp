// From the mesh's depth to the finished picture, one pixel an invocation.
//
// The surface under each depth sample is lit by a sun, whose shadow is marched through the field with the penumbra of
// Quilez ("Soft shadows in raymarched SDFs"), and by a sky seen in twelve directions, each
// closed off by comparing the field along it with what it would be over a plane (after Evans, "Fast approximations for
// global illumination on dynamic scenes", 2006). The field gives the normal and the material, so that both are sharp
// whatever the mesh's resolution. Where no surface is there is a backdrop, and on it, about the solid's foot, the
// shadow of a ground that is not drawn itself. Tone map: Narkowicz' fit of ACES.
#define FIELD_VALUE
#define FIELD_GRADIENT
#define FIELD_MATERIAL
#include "shared.h"
#include "render/render.h"
#include "field.glsl"

layout(local_size_x = RENDER_GROUP_X, local_size_y = RENDER_GROUP_Y) in;
layout(push_constant, scalar) uniform Push { RenderPush view; };
layout(binding = 0) uniform sampler2D depthImage;
layout(binding = 1, scalar) writeonly buffer Pixels { uint pixels[]; };  // sRGB, red in the lowest byte

const vec3 kSun = normalize(vec3(-0.42, 0.86, 0.66));
const vec3 kSunLight = vec3(2.9, 2.62, 2.25);
const float kSunSize = 0.035;  // tangent of the sun's angular radius: larger than the real one, for softer shadows
const vec3 kGroundColor = vec3(0.62, 0.60, 0.57);
const float kPi = 3.14159265;

// The twelve corners of an icosahedron, turned so that none looks along an axis.
const vec3 kDirections[12] = {
    vec3(0.000, 0.526, 0.851), vec3(0.000, -0.526, 0.851), vec3(0.000, 0.526, -0.851), vec3(0.000, -0.526, -0.851),
    vec3(0.526, 0.851, 0.000), vec3(-0.526, 0.851, 0.000), vec3(0.526, -0.851, 0.000), vec3(-0.526, -0.851, 0.000),
    vec3(0.851, 0.000, 0.526), vec3(-0.851, 0.000, 0.526), vec3(0.851, 0.000, -0.526), vec3(-0.851, 0.000, -0.526)};

vec3 skyColor(vec3 d) {
    vec3 sky = mix(vec3(0.95, 0.93, 0.90), vec3(0.50, 0.66, 0.95), smoothstep(0.0, 0.9, d.y));
    return mix(kGroundColor * 0.9, sky, smoothstep(-0.25, 0.15, d.y));
}

// What a mirror sees: the sky darker to the right, and a large soft lamp on the left.
vec3 surroundings(vec3 d, float roughness) {
    float lamp = dot(d, normalize(vec3(-0.75, 0.45, 0.45))), blur = 0.05 + 0.4 * roughness;
    return skyColor(d) * mix(1.1, 0.35, smoothstep(-0.6, 0.9, d.x)) +
           1.6 * smoothstep(0.80 - blur, 0.80 + 0.5 * blur, lamp);
}

vec4 regionDistance(vec3 p) {  // xyz: towards which side
    vec3 q = max(view.lo - p, p - view.hi);
    float inner = max(q.x, max(q.y, q.z));
    vec3 side = sign(p - 0.5 * (view.lo + view.hi)) * vec3(equal(q, vec3(inner)));
    return vec4(side, length(max(q, 0.0)) + min(inner, 0.0));
}

// The solid as it was meshed, cut at the region; never more than the distance outside.
float solid(vec3 p) { return max(fieldValue(p) * view.stepScale, regionDistance(p).w); }

// How much of the sun is seen from p, 0..1.
float sunlight(vec3 p, float bias) {
    vec3 leave = (mix(view.lo, view.hi, greaterThan(kSun, vec3(0.0))) - p) / kSun;
    float end = min(leave.x, min(leave.y, leave.z));
    float t = bias, seen = 1.0;
    uint i = 0;
    do {
        float d = solid(p + t * kSun);
        seen = min(seen, d / (kSunSize * t));
        t += max(0.8 * d, 0.5 * bias + 0.006 * t);
    } while (++i < 96 && seen > 0.0 && t < end);
    return end <= 0.0 ? 1.0 : smoothstep(0.0, 1.0, seen);
}

// Light of the sky and the ground on a surface at p, and in w how open p is. The directions are turned about y: a
// pixel's samples together see four times as many.
vec4 skylight(vec3 p, vec3 n, float bias, float turn) {
    mat2 turned = mat2(cos(turn), sin(turn), -sin(turn), cos(turn));
    vec4 sum = vec4(0.0);
    float weights = 0.0;
    uint i = 0;
    do {
        vec3 d = kDirections[i];
        d.xz = turned * d.xz;
        float weight = max(dot(n, d), 0.0);
        float open = 1.0, t = max(0.03 * view.radius, 2.0 * bias);
        uint k = 0;
        do {
            float clear = clamp(solid(p + t * d) / (t * max(weight, 0.05)), 0.0, 1.0);
            open -= (0.42 - 0.08 * float(k)) * (1.0 - clear);
            t *= 2.2;
        } while (++k < 4);
        // Low above the ground its light is the solid's shadow.
        float height = clamp((p.y - view.ground) / view.radius, 0.0, 1.0);
        float lit = d.y < 0.0 ? mix(0.35, 1.0, height) : 1.0;
        sum += weight * max(open, 0.0) * vec4(lit * skyColor(d), 1.0);
        weights += weight;
    } while (++i < 12);
    return sum / weights;
}

struct Surface {
    vec3 p, n;
};

// The surface that the mesh stands for near p: the field's own, which lies within a cell, with its exact normal.
Surface refine(vec3 p, vec3 toEye) {
    vec4 g = fieldGradient(p), region = regionDistance(p);
    float slope = max(length(g.xyz), 1e-6), off = g.w / slope;
    bool cap = region.w > off || !(abs(off) < 2.0 * view.cellSize);
    vec3 n = cap ? region.xyz : g.xyz / slope;
    p -= n * clamp(cap ? region.w : off, -view.cellSize, view.cellSize);
    float facing = dot(n, toEye);  // never away from the eye, as bevelled edges can have it
    return Surface(p, facing < 0.0 ? normalize(n - 1.02 * facing * toEye) : n);
}

// Microfacets: GGX with Schlick's Fresnel for the sun, Karis' approximation for the surroundings.
vec3 shadeSurface(Surface s, vec3 toEye, float sunSeen, vec4 sky) {
    FieldMaterial material = fieldMaterial(s.p);
    vec3 base = clamp(material.baseColor, 0.0, 1.0);
    float metallic = clamp(material.metallic, 0.0, 1.0), roughness = clamp(material.roughness, 0.08, 1.0);
    vec3 mirror = mix(vec3(0.04), base, metallic), diffuse = base * (1.0 - metallic);
    float facing = max(dot(s.n, kSun), 0.0), seen = max(dot(s.n, toEye), 1e-3);
    vec3 sun = kSunLight * (facing * sunSeen);

    vec3 middle = normalize(kSun + toEye);
    float a2 = pow(roughness, 4.0), nh = max(dot(s.n, middle), 0.0);
    float lobe = nh * nh * (a2 - 1.0) + 1.0, k = 0.125 * (roughness + 1.0) * (roughness + 1.0);
    float shape = a2 / (kPi * lobe * lobe) / (4.0 * mix(facing, 1.0, k) * mix(seen, 1.0, k));
    vec3 fresnel = mirror + (1.0 - mirror) * pow(1.0 - max(dot(middle, toEye), 0.0), 5.0);

    vec4 c = roughness * vec4(-1, -0.0275, -0.572, 0.022) + vec4(1, 0.0425, 1.04, -0.04);
    float edge = min(c.x * c.x, exp2(-9.28 * seen)) * c.x + c.y;
    vec3 around = mirror * (c.z - 1.04 * edge) + edge + c.w;
    vec3 away = normalize(mix(reflect(-toEye, s.n), s.n, roughness * roughness));
    return diffuse * (sun / kPi + 0.66 * sky.xyz) + sun * shape * fresnel + sky.w * around * surroundings(away, roughness) +
           material.emission;
}

// A light wall, darkened by the shadow on the ground before it as far as the ground is `there`.
vec3 shadeBackdrop(vec2 place, float there, float sunSeen, float open) {
    float height = 0.5 + 0.5 * place.y;
    vec3 wall = mix(vec3(0.76, 0.745, 0.72), vec3(0.36, 0.43, 0.53), smoothstep(0.0, 1.1, height));
    vec3 light = mix(vec3(0.46, 0.50, 0.58), vec3(1.0), sunSeen) * mix(0.35, 1.0, open);
    return wall * (1.0 - 0.10 * dot(place, place)) * mix(vec3(1.0), light, there);
}

// Linear light of one sample of a pixel, whose place in the picture runs from -1 to 1, upwards.
vec3 shade(vec2 place, float depth, float turn) {
    vec3 ray = view.forward + place.x * view.right / dot(view.right, view.right) +
               place.y * view.up / dot(view.up, view.up);
    vec3 toEye = normalize(-ray);
    bool hit = depth > 0.0;
    Surface s = refine(view.eye + ray * (hit ? view.near / depth : 1.0), toEye);
    if (!hit) {
        s.n = vec3(0, 1, 0);
        s.p = view.eye + ray * ((view.ground - view.eye.y) / min(ray.y, -1e-3));
    }
    float away = length(s.p.xz - view.centre.xz) / view.radius;
    float there = ray.y < 0.0 ? 1.0 - smoothstep(1.2, 2.8, away) : 0.0;
    float bias = min(0.5 * view.cellSize, 0.004 * view.radius);
    vec3 from = s.p + bias * s.n;
    float sunSeen = sunlight(from, bias);
    vec4 sky = skylight(from, s.n, bias, turn);
    return hit ? shadeSurface(s, toEye, sunSeen, sky) : shadeBackdrop(place, there, sunSeen, sky.w);
}

vec3 toneMap(vec3 x) {
    x *= 0.66;
    return clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
}

void main() {
    fieldBegin();
    uvec2 at = gl_GlobalInvocationID.xy + uvec2(0, view.firstRow);
    vec3 sum = vec3(0.0);
    uint i = 0;
    do {
        uvec2 texel = RENDER_SAMPLES * at + uvec2(i % RENDER_SAMPLES, i / RENDER_SAMPLES);
        uvec2 last = RENDER_SAMPLES * uvec2(view.width, view.height) - 1;
        float depth = texelFetch(depthImage, ivec2(min(texel, last)), 0).x;
        vec2 place = (vec2(texel) + 0.5) / vec2(last + 1) * 2.0 - 1.0;
        place.y = -place.y;
        sum += toneMap(shade(place, depth, 0.39 * float(i)));
    } while (++i < RENDER_SAMPLES * RENDER_SAMPLES);

    vec3 linear = sum / float(RENDER_SAMPLES * RENDER_SAMPLES);
    vec3 encoded = mix(12.92 * linear, 1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055, greaterThan(linear, vec3(0.0031308)));
    // Half a step up or down by Bayer's 4 x 4 pattern keeps gradients from banding, and files small.
    uint bits = at.x ^ at.y;
    float rank = float((bits & 1u) << 3 | (at.y & 1u) << 2 | (bits & 2u) | (at.y & 2u) >> 1);
    float noise = (rank + 0.5) / 16.0 - 0.5;
    uvec3 bytes = uvec3(clamp(255.0 * encoded + noise + 0.5, 0.0, 255.0));
    if (at.x < view.width && at.y < view.height)
        pixels[at.y * view.width + at.x] = bytes.x | bytes.y << 8 | bytes.z << 16 | 255u << 24;
}
