// Secondary rays of one listed tile of the G-buffer, frame.secondaryRays of each kind a pixel and frame, traced through the field (Swoboda,
// "Advanced Procedural Rendering in DirectX 11", lists reflections and global illumination among them):
//   BOUNCE       what reaches the surface from all around, by the cosine: the sky, or the light of what is in its way
//   REFLECTIONS  what a facet of the surface mirrors (microfacets.glsl)
//   TRANSMITS    where light passes through, what is seen through it, bent by Snell's law and dimmed by Beer and Lambert's; and
//                how much of the sun's light reaches each place through what transmits, straight on
// each defined as needed. What is hit is lit by the sun as its map says, the sky, one lamp (LAMPS) with a ray for its shadow, and
// by itself. Of the first two the means of frames are kept, as ambient occlusion's are; mirrors forget sooner.
// path.comp is what these are measured against; they differ by the sun's map, by chalk and facets that share light by a fit, and
// by what reaches a place that is hit: known where it was seen in the frame before; elsewhere taken for what reaches the
// pixel itself, or, before that is known, the sky's light as far as the field's value near it says that it is seen.
#define FIELD_VALUE
#define FIELD_GRADIENT
#define FIELD_MATERIAL
#define FIELD_OPAQUE
#define FIELD_BEFORE
#define SHADOW_MAP
#include "shared.h"
#include "render/render.h"
#include "render/places.glsl"
#include "lib/octahedral.glsl"
#include "render/view.glsl"
#include "render/gbuffer.glsl"

layout(local_size_x = RENDER_TILE * RENDER_TILE) in;
layout(binding = 0, scalar) uniform Frame { RenderFrame frame; };
layout(binding = 2, rgba32ui) readonly uniform uimage2D surfaces;
layout(binding = 3, scalar) readonly buffer Tiles { uint tiles[]; };
layout(binding = 5, rgba32ui) readonly uniform uimage2D surfacesBefore;
layout(binding = 8, r32f) readonly uniform image2D shadowMap;
// Linear radiance; in w the rays that it is the mean of.
#ifdef BOUNCE
layout(binding = 18, rgba16f) readonly uniform image2D bounceBefore;
layout(binding = 19, rgba16f) writeonly uniform image2D bounceNow;
#endif
#ifdef REFLECTIONS
layout(binding = 20, rgba16f) readonly uniform image2D reflectionBefore;
layout(binding = 21, rgba16f) writeonly uniform image2D reflectionNow;
#endif
#ifdef FIELD_TRANSMITS
layout(binding = 22, rgba16f) writeonly uniform image2D passed;    // radiance; in w the share of light that passes
layout(binding = 23, rgba16f) writeonly uniform image2D sunlight;  // share of the sun's light that arrives
#endif

#include "render/solid.glsl"
#include "render/media.glsl"
#include "render/shading.glsl"
#include "render/shadow.glsl"
#include "render/microfacets.glsl"
#include "render/reproject.glsl"

const uint kBounce = 0, kReflection = 1, kPassed = 2, kSun = 3;
const uint kSteps = 40, kMostInterfaces = 8;
const float kHit = 0.2;                 // of the bias: nearer is a hit
const float kMirrorKept = 4.0;          // frames that a moving mirror remembers; chalk remembers as ambient occlusion does

// How much of the sky p sees, about: by how far the field's value falls behind the way.
float openness(Bounds bounds, vec3 p, vec3 n) {
    float way = 0.5 * frame.ambientRadius;
#ifdef FIELD_TRANSMITS
    float clear = opaqueAt(bounds, p + n * way);
#else
    float clear = clearance(bounds, p + n * way);
#endif
    return mix(0.3, 1.0, clamp(clear / way, 0.0, 1.0));
}

#ifdef FIELD_TRANSMITS
// What of the sun reaches p, on straight ways: what transmits dims it, what is opaque hides it.
vec3 sunThrough(Bounds bounds, vec3 p) {
    float t = 2.0 * frame.bias, opaque = 1.0, step = 0.0, share = 1.0;
    bool inside = false;
    vec3 optical = vec3(0.0);
    uint i = 0;
    do {
        vec3 q = p + frame.sun * t;
        opaque = opaqueAt(bounds, q);
        step = max(opaque, 0.01 * frame.radius);
        float whole = wholeAt(bounds, q);
        // Within a medium not farther than it reaches.
        step = whole < 0.0 ? min(step, max(-whole, frame.bias)) : step;
        FieldMaterial medium = fieldMaterial(q);
        if (whole < 0.0) optical += medium.absorption * step;
        if (whole < 0.0 && !inside && i > 0) share *= medium.transmission;
        inside = whole < 0.0;
        t += step;
    } while (opaque > 0.0 && t < 3.0 * frame.radius && ++i < 32);
    return opaque > 0.0 ? share * exp(-optical) : vec3(0.0);
}
#endif

#ifdef LAMPS
// Whether nothing is between p and what is `far` away.
bool reaches(Bounds bounds, vec3 p, vec3 d, float far) {
    float t = 2.0 * frame.bias, h = 1.0;
    uint i = 0;
    do {
        h = clearance(bounds, p + d * t);
        t += max(h, 0.02 * far);
    } while (h > 0.0 && t < far && ++i < 24);
    return h > 0.0;
}

// One of the lamps, for all of them.
vec3 lamplight(Bounds bounds, Surface s, vec3 p, vec3 toEye, float choice) {
    vec3 toLamp;
    float far;
    vec3 sent = lampSends(frame.lights[min(uint(choice * float(frame.lightCount)), frame.lightCount - 1)], p, toLamp, far);
    bool arrives = any(greaterThan(sent, vec3(0.0))) && dot(s.n, toLamp) > 0.0 && reaches(bounds, p + s.n * frame.bias, toLamp, far);
    return arrives ? reflected(s, toEye, toLamp, sent * float(frame.lightCount)) : vec3(0.0);
}
#endif

// What a ray of this kind in direction d hits, m being its normal.
Surface surfaceHit(FieldMaterial material, vec3 m, vec3 d, uint kind) {
    Surface s = groundSurface(0.0);
    s.base = clamp(material.baseColor, 0.0, 1.0);
    s.metallic = clamp(material.metallic, 0.0, 1.0);
    // What chalk sees in a mirror is rare and bright: it is spread.
    s.roughness = clamp(material.roughness, kind == kBounce ? 0.6 : 0.25, 1.0);
    s.emission = clamp(material.emission, 0.0, kMostEmission);
    s.n = dot(m, d) > 0.0 ? -m : m;
    return s;
}

// What the surface at p sends towards the eye of the sun, of what is `around`, mirrored and by itself, and of lamps.
vec3 sentBy(Bounds bounds, Surface s, vec3 p, vec3 toEye, vec3 sunlit, float open, vec3 around, float choice) {
    vec3 sent = reflected(s, toEye, frame.sun, frame.sunLight * sunlit) + s.base * (1.0 - s.metallic) * around +
                open * mirrored(s) * surroundings(reflect(-toEye, s.n), s.roughness) + s.emission;
#ifdef LAMPS
    sent += lamplight(bounds, s, p, toEye, choice);
#endif
    return sent;
}

void main() {
    fieldBegin();
    uint lane = gl_LocalInvocationIndex, tile = tiles[RENDER_NEAR * frame.tiles + gl_WorkGroupID.x];
    uvec2 pixel = pixelOf(tile, lane), here = min(pixel, frame.size - 1);
    Surface s = unpackSurface(imageLoad(surfaces, ivec2(here)));
    bool surface = all(equal(pixel, here)) && s.depth > 0.0;
    vec3 p = pointAt(frame.now, placeOf(here, frame.size), surface ? s.depth : 1.0), n = s.n;
    surface = surface && nearSolid(p, 0.0);
    vec3 view = normalize(p - frame.now.eye), x, y;
    axesAcross(n, x, y);
    vec3 from = vec3(dot(-view, x), dot(-view, y), max(dot(-view, n), 1e-3));
    uvec2 was;
    bool kept = surface && pixelSeenBefore(s.ground ? p : placeBefore(p, n), n, here, was);
    Bounds bounds = solidBounds();
    float bias = frame.bias;
    vec2 u, v;

    float transmission = 0.0, ior = 1.0;
    vec3 absorption = vec3(0.0);
#ifdef FIELD_TRANSMITS
    vec3 under = p - n * bias;
    chooseMembers(fromMiddle(under));
    FieldMaterial medium = fieldMaterial(under);
    bool clear = !s.ground && opaqueAt(bounds, under) > 0.5 * bias;
    transmission = clear ? medium.transmission : 0.0;
#endif

    vec4 bounced = vec4(0.0), mirrorSum = vec4(0.0);  // sums; in w of how many rays
    // Of the kinds that nobody asks for none, from the first on and to the last: what is left out within goes through the loop.
    uint rays = unfolded(frame.secondaryRays), ray = 0, all = rays;
#ifndef BOUNCE
    ray = rays;
#endif
#ifdef REFLECTIONS
    all = 2 * rays;
#endif
#ifdef FIELD_TRANSMITS
    all = 2 * rays + 2;
#endif
#ifdef BOUNCE
    vec4 ownBounce = kept ? imageLoad(bounceBefore, ivec2(was)) : vec4(0.0);
#endif
    do {
        uint kind = ray < rays ? kBounce : ray < 2 * rays ? kReflection : kPassed + ray - 2 * rays;
        u = evenly(here, frame.number * rays + ray % rays);
        v = evenly(here + 57, frame.number * rays + ray % rays);
#ifndef REFLECTIONS
        if (kind == kReflection) continue;
#endif
        vec3 d = cosineDirection(n, u), o = p + n * bias, through = vec3(1.0), radiance = vec3(0.0);
        if (kind == kReflection) {
            float alpha = s.roughness * s.roughness;
            vec3 h = facet(from, alpha, v), l = 2.0 * dot(from, h) * h - from;
            l.z = abs(l.z) + 1e-3;
            d = normalize(l.x * x + l.y * y + l.z * n);
        }
        bool within = false, going = surface;
        ior = 1.0;
        absorption = vec3(0.0);
#ifdef FIELD_TRANSMITS
        if (kind == kPassed) {
            // Into the solid, smooth or by a facet.
            float alpha = s.roughness > 0.1 ? s.roughness * s.roughness : 0.0;
            vec3 h = alpha > 0.0 ? facet(from, alpha, v) : vec3(0, 0, 1);
            float share = fresnel(max(dot(from, h), 1e-3), medium.ior);
            vec3 l = refract(-from, h, 1.0 / medium.ior);
            d = normalize(l.x * x + l.y * y + min(l.z, -1e-3) * n);
            o = under;
            through = s.base * (1.0 - share);
            within = wholeAt(bounds, o) < 0.0;
            ior = medium.ior;
            absorption = medium.absorption;
            going = surface && transmission > 0.0;
        }
        if (kind == kSun) {
            d = frame.sun;
            going = surface && unfolded(frame.shadowSize) != 0 && dot(n, d) > 0.0;
        }
        bool straight = kind == kPassed;
        uint interfaces = 0;
        vec3 mirrored = vec3(0.0);  // on the way
        do {
#endif
            // Along the ray to where it ends.
            float toGround = d.y < 0.0 && frame.groundEnd > 0.0 && (unfolded(frame.studio) == 0 || kind == kPassed) ? (frame.ground - o.y) / d.y : 1e30;
            float fade = groundLeft(o + d * min(toGround, 1e6));
            toGround = fade > 0.0 ? toGround : 1e30;
            vec3 a = (frame.lo - o) / d, b = (frame.hi - o) / d, last = max(a, b), first = min(a, b);
            float t = max(max(first.x, max(first.y, first.z)), 0.0), end = min(min(last.x, min(last.y, last.z)) + bias, toGround);
            Way way = follow(bounds, o, d, t, end, within, ior, absorption, kHit * bias, kSteps);
            bool hit = way.hit, hitsOpaque = way.opaque;
            t = way.t;
            ior = way.ior;
            absorption = way.absorption;
            through *= exp(-way.optical);
            bool hitsGround = !hit && !way.changes && toGround < 1e29;
            going = going && (hit || hitsGround || way.changes || kind != kSun);

            // What is there.
            vec3 q = o + d * (hit ? t : hitsGround ? toGround : 0.0);
            chooseMembers(fromMiddle(q));
            vec4 g;
            FieldMaterial material;
#ifdef FIELD_TRANSMITS
            if (hitsOpaque) g = fieldOpaqueGradient(q);
            else
#endif
                g = fieldGradient(way.between ? q - d * bias : q);
#ifdef FIELD_MEDIA
            if (way.between) {
                g.xyz -= fieldGradient(q + d * bias).xyz;
                g.w = 0.0;
            }
#endif
            vec4 region = regionDistance(q);
            float slope = max(length(g.xyz), 1e-6), off = g.w / slope;
            bool cap = !way.between && region.w > off;
            vec3 m = cap ? region.xyz : g.xyz / slope;
            q -= hit ? m * clamp(cap ? region.w : off, -2.0 * bias, 2.0 * bias) : vec3(0.0);
#ifdef FIELD_TRANSMITS
            vec3 beyond = q - (within ? -m : m) * bias;
            if (hitsOpaque) material = fieldOpaqueMaterial(q);
            else material = fieldMaterial(beyond);
            // Where only a part passes, that part of the rays does; of the sun's all, with as much less light.
            bool passes = going && hit && !hitsOpaque && (within || kind == kSun || fract(v.y + 0.618 * float(interfaces)) < material.transmission);
#else
            material = fieldMaterial(q);
            bool passes = false;
#endif
            if (going && !passes && !way.changes) {
                Surface seen = groundSurface(0.0);
                if (hit) seen = surfaceHit(material, m, d, kind);
                bool sees = hit || hitsGround;
                float open = openness(bounds, q, seen.n);
                vec3 sunlit = vec3(unfolded(frame.shadowSize) != 0 ? sunReaches(surfaceInShadowMap(q, seen.n), spotInMap(u.yx)) : 1.0);
#ifdef FIELD_TRANSMITS
                if (unfolded(frame.shadowSize) != 0) sunlit = sunThrough(bounds, q + seen.n * bias);
#endif
                vec3 around = open * skylight(seen.n);
#ifdef BOUNCE
                // What the last frame knew: so light is thrown on again with each frame.
                uvec2 there;
                vec4 cached = sees && seenBefore(q, seen.n, false, here, there) ? imageLoad(bounceBefore, ivec2(there)) : vec4(0.0);
                cached = cached.w > 0.0 || kind != kBounce ? cached : ownBounce;
                around = cached.w > 0.0 ? min(cached.rgb, vec3(8.0)) : around;
#endif
                vec3 lit = sentBy(bounds, seen, q, -d, sunlit, open, around, v.x);
                bool wall = kind == kPassed && hitsGround && unfolded(frame.studio) != 0;
                vec3 behind = surroundings(d, 0.0);
#ifdef ENVIRONMENT
                // Rays that are spread see it blurred a little: less noise, and no wider lobe to speak of (Krivanek and Colbert,
                // "Real-time shading with filtered importance sampling", 2008).
                if (kind != kPassed) behind = environment(d, kind == kBounce ? 0.4 : 0.5 * s.roughness);
#endif
#ifdef FIELD_TRANSMITS
                behind = straight ? backdrop(d) : behind;
                if (wall) lit = behind * wallDimmed(sunlit, open);
#endif
                radiance = through * (sees ? mix(behind, lit, hitsGround ? fade : 1.0) : behind);
            }
#ifdef FIELD_TRANSMITS
            // Through the interface, or back from it.
            if (kind == kSun) through = going && !passes && !way.changes ? vec3(0.0) : through;
            if (passes) {
                vec3 facing = within ? -m : m;
                bool otherWithin = wholeAt(bounds, beyond) < 0.0;
                float other = otherWithin ? material.ior : 1.0;
                vec3 bent = kind == kSun ? d : refract(d, facing, ior / other);
                bool mirrors = dot(bent, bent) < 0.5;
                bent = mirrors ? reflect(d, facing) : bent;
                straight = straight && !mirrors;
                // One way is followed. What comes along the other is taken for what is around, as far as it is open.
                float back = mirrors ? 0.0 : fresnel(max(-dot(d, facing), 1e-3), other / ior);
                vec3 away = reflect(d, facing);
                if (kind == kPassed) mirrored += through * back * openness(bounds, q + facing * bias, facing) * surroundings(away, 0.0);
                through *= 1.0 - back;
                if (kind == kSun && !within) through *= material.transmission;
                through *= within || mirrors ? vec3(1.0) : clamp(material.baseColor, 0.0, 1.0);
                o = q + (mirrors ? facing : -facing) * bias;
                d = bent;
                within = mirrors ? within : otherWithin;
                ior = mirrors ? ior : other;
                absorption = mirrors ? absorption : otherWithin ? material.absorption : vec3(0.0);
            }
            if (way.changes) o += d * t;
            going = passes || way.changes;
        } while (going && ++interfaces < kMostInterfaces);
        radiance += mirrored;
#endif

        radiance = any(isnan(radiance)) ? vec3(0.0) : min(radiance, vec3(6e4));  // the filter would spread it
        if (kind == kBounce) bounced += vec4(min(radiance, vec3(unfolded(frame.resting) != 0 ? 6e4 : 8.0)), 1.0);
        if (kind == kReflection) mirrorSum += vec4(radiance, 1.0);
#ifdef FIELD_TRANSMITS
        if (kind == kPassed && surface) imageStore(passed, ivec2(here), vec4(transmission * radiance, transmission));
        if (kind == kSun && surface) imageStore(sunlight, ivec2(here), vec4(through, 1.0));
#endif
    } while (++ray < all);

    float most = float(frame.mostKept);
#ifdef BOUNCE
    float known = min(ownBounce.w, most);
    if (surface) imageStore(bounceNow, ivec2(here), vec4((bounced.rgb + ownBounce.rgb * known) / (bounced.w + known), bounced.w + known));
#endif
#ifdef REFLECTIONS
    vec4 oldMirror = imageLoad(reflectionBefore, ivec2(was));
    float remembered = unfolded(frame.resting) != 0 ? most : min(mix(kMirrorKept, most, smoothstep(0.15, 0.6, s.roughness)), most);
    remembered = kept ? min(oldMirror.w, remembered) : 0.0;
    if (surface)
        imageStore(reflectionNow, ivec2(here), vec4((mirrorSum.rgb + oldMirror.rgb * remembered) / (mirrorSum.w + remembered), mirrorSum.w + remembered));
#endif
}
