// Paths of light from the eye to where they come from, some for each pixel, added to the sums of those before: what all quicker
// light is measured against (Kajiya, "The rendering equation", 1986).
//
// The field's own surface is traced, by steps of its value; no mesh, no G-buffer, no map of shadows. At an opaque surface one
// lamp, or the sun, is asked for by a ray of its own, and weighed against the chance that the path finds it by itself (Veach,
// "Robust Monte Carlo methods", 1997: the balance heuristic). Facets are drawn as they are seen; light that they mask meets
// the surface once more and leaves as from chalk, as does what they let through, tinted by the base colour: so nothing is lost or
// won at any roughness, without a table. That part's albedo is not known in closed form but by the facet that was drawn, which is as good in the mean.
//
// Where light passes through, the path is reflected or bent by Fresnel's share and Snell's law, and loses within by Beer and
// Lambert's (media.glsl). An interface's normal is the difference of the two fields' slopes. What lies behind an interface cannot
// be asked for lamps; it is found by paths that hit the sun's disc or a lamp's ball, for which some leave chalk towards the sun.
//
// One loop, whose turns are rays of either kind: the field's code stands once in it, as drivers inline it at each place. A lane
// whose path has ended begins the next of its pixel's, so that no lane waits for long paths of others but at the end.
#define FIELD_VALUE
#define FIELD_GRADIENT
#define FIELD_MATERIAL
#define FIELD_OPAQUE
#include "shared.h"
#include "render/render.h"
#include "render/places.glsl"
#include "lib/octahedral.glsl"
#include "render/view.glsl"
#include "render/gbuffer.glsl"

layout(local_size_x = RENDER_PATHS, local_size_y = RENDER_PATHS) in;
layout(binding = 0, scalar) uniform Frame { RenderFrame frame; };
layout(binding = 8, scalar) buffer Sums { vec4 sums[]; };
layout(push_constant, scalar) uniform Push { PathPush push; };

#include "render/solid.glsl"
#include "render/media.glsl"
#include "render/shading.glsl"
#include "render/microfacets.glsl"
#include "lib/random.glsl"

const uint kMostSteps = 768, kLongPath = 16;
const float kClose = 2e-5;        // of the radius: nearer is a hit
const float kSmooth = 0.04;       // roughness below which an interface is smooth, and no facet of a solid is rougher
const float kToSun = 0.6;         // share of the paths that leave chalk towards the sun where light passes through something,
const float kSunCone = 0.82;      // within the cone of this cosine about it,
const float kSunCore = 0.99;      // or this one about where it is for who looks up through a level surface:
const float kNarrow = 0.6;        // so many of them
const float kGoesOn = 0.9;        // how likely a path does that has had kLongPath rays

// What a ray is for.
const uint kPath = 0, kLamp = 1, kShade = 2, kOpen = 3;

float mean(vec3 v) { return (v.x + v.y + v.z) / 3.0; }

// A direction within the cone about `axis`, evenly.
vec3 inCone(vec3 axis, float cosine, vec2 u) {
    vec3 x, y;
    axesAcross(axis, x, y);
    float c = mix(cosine, 1.0, u.x), s = sqrt(max(1.0 - c * c, 0.0)), angle = 6.2831853 * u.y;
    return normalize(s * cos(angle) * x + s * sin(angle) * y + c * axis);
}

// Where the sun is for what lies within a medium below a level surface.
vec3 sunFrom(float ior) {
    vec2 level = push.sun.xz / ior;
    return push.sun.y > 0.0 ? vec3(level.x, sqrt(max(1.0 - dot(level, level), 0.0)), level.y) : push.sun;
}

// How often chalk sends paths in a direction.
float chalkDensity(float facing, vec3 d, float ior) {
    float density = max(facing, 0.0) / kPi;
#ifdef FIELD_TRANSMITS
    float wide = dot(d, push.sun) > kSunCone ? 1.0 / (6.2831853 * (1.0 - kSunCone)) : 0.0;
    float narrow = dot(d, sunFrom(ior)) > kSunCore ? 1.0 / (6.2831853 * (1.0 - kSunCore)) : 0.0;
    if (push.sunWide > 0.0) density = mix(density, mix(wide, narrow, kNarrow), kToSun);
#endif
    return density;
}

// Share of the sphere that the sun takes, steradians; 0: it is a point.
float sunSpread() { return 6.2831853 * push.sunWide; }

// Of how many lights one is asked for: lamps, the sun, an environment map.
uint lampsAsked() {
    uint lamps = frame.lightCount + (push.sunWide >= 0.0 ? 1 : 0);
#ifdef ENVIRONMENT
    ++lamps;
#endif
    return lamps;
}

// A lamp's ball from o: in w the cosine of its edge less than 1, in xyz the direction to its middle.
vec4 lampBall(Light lamp, vec3 o) {
    vec3 v = lamp.position - o;
    float far2 = dot(v, v), sine2 = min(lamp.size * lamp.size / far2, 0.999);
    return vec4(v * inversesqrt(far2), sine2 / (1.0 + sqrt(1.0 - sine2)));
}
vec3 lampRadiance(Light lamp, vec3 d) {
    return lamp.color * (smoothstep(lamp.cosOuter, lamp.cosInner, dot(-d, lamp.direction)) / (kPi * lamp.size * lamp.size));
}

void main() {
    fieldBegin();
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, frame.size))) return;
    Bounds bounds = solidBounds();
    float close = kClose * frame.radius;

    uint at = pixel.y * frame.size.x + pixel.x;
    vec4 sum = unfolded(push.path) == 0 ? vec4(0.0) : sums[at];
    float shown = 0.0, allShown = 0.0;  // whether the path met something that is shown, and how many did
    uint state, path = push.path, bounces = 0, turn = 0, purpose = kPath, after = kPath;
    vec3 total = sum.rgb, light = vec3(0.0), through = vec3(1.0), o = vec3(0.0), d = vec3(0.0);
    vec3 pending = vec3(0.0), onward = vec3(0.0);  // what the lamp's ray brings if nothing is in its way, and where the path goes on
    float far = 1e30;
    float density = -1.0;  // of the path's direction, where a lamp could have been asked for instead
    bool done = false, alive = false, straight = true, within = false;
    float ior = 1.0, startIor = 1.0;
    vec3 absorption = vec3(0.0), start = vec3(0.0), startAbsorption = vec3(0.0);  // the latter two of the path, while a lamp is asked for
    do {
        if (!alive && purpose != kLamp) {
            // The next path, from the eye or a place on the lens.
            total += any(isnan(light)) || any(isinf(light)) ? vec3(0.0) : light;
            allShown += shown;
            shown = 1.0;
            state = randomStart(at, path);
            // Not left by a break: some drivers let such a lane go on beside its neighbours. It does nothing more that counts.
            done = path++ == push.path + push.paths;
            vec2 jitter = vec2(random(state), random(state)) - 0.5, onLens = vec2(random(state), random(state));
            vec3 ray = rayOf(frame.now, placeOf(pixel, frame.size) + 2.0 * jitter / vec2(frame.size));
            float r = push.lens * sqrt(onLens.x), angle = 6.2831853 * onLens.y;
            o = frame.now.eye + r * (cos(angle) * normalize(frame.now.right) + sin(angle) * normalize(frame.now.up));
            d = normalize(frame.now.eye + ray * push.focus - o);
            light = vec3(0.0), through = vec3(1.0), absorption = vec3(0.0);
            purpose = after = kPath, bounces = 0, turn = 0;
            far = 1e30, density = -1.0, ior = 1.0;
            alive = true, straight = true, within = false;
#ifdef FIELD_TRANSMITS
            within = wholeAt(bounds, o) < 0.0 && opaqueAt(bounds, o) > 0.0;
            if (within) {
                FieldMaterial medium = fieldMaterial(o);
                ior = medium.ior;
                absorption = medium.absorption;
            }
#endif
        }
        // Paths that glass leads in circles end by chance.
        if (++turn > kLongPath && purpose == kPath) {
            alive = random(state) < kGoesOn;
            if (!alive) continue;
            through /= kGoesOn;
        }
        // Where the ray meets the ground, and the region's box.
        bool groundCounts = unfolded(frame.studio) == 0 || (purpose == kPath && straight);
        float toGround = d.y < 0.0 && groundCounts ? max(frame.ground - o.y, -1e30) / d.y : -1.0;
        float fade = groundLeft(o + d * toGround);
        bool solidGround = unfolded(frame.studio) != 0 || random(state) < fade;
        toGround = toGround > 0.0 && fade > 0.0 && solidGround ? toGround : 1e30;
        vec3 a = (frame.lo - o) / d, b = (frame.hi - o) / d, first = min(a, b), last = max(a, b);
        float t = max(max(first.x, max(first.y, first.z)), 0.0);
        float end = min(min(last.x, min(last.y, last.z)) + close, min(far, toGround));

        Way way = follow(bounds, o, d, t, end, within, ior, absorption, close, kMostSteps);
        bool hit = way.hit, hitsOpaque = way.opaque, between = way.between;
        t = way.t;
        ior = way.ior;
        absorption = way.absorption;
        bool hitsGround = !hit && toGround < 1e29 && toGround <= far;
        bool blocked = hit || hitsGround;

        vec3 left = exp(-way.optical);
        if (way.changes) {
            o += d * t;
            far -= t;
            through *= purpose == kPath ? left : vec3(1.0);
            pending *= left;
            continue;
        }
        if (purpose != kPath) {
            // A ray to a lamp has done its work, or one that says how dark the studio's ground is.
            if (purpose == kLamp && !blocked) light += pending * left;
            if (purpose == kShade) through *= wallDimmed(vec3(blocked ? 0.0 : 1.0), 1.0);
            if (purpose == kOpen) light += through * wallDimmed(vec3(1.0), blocked ? 1.0 - frame.ambientStrength : 1.0);
            alive = alive && purpose != kOpen;
            if (purpose == kLamp) o = start, ior = startIor, absorption = startAbsorption;
            purpose = after;
            d = onward;
            far = 1e30;
            if (purpose == kOpen) far = frame.ambientRadius;
            continue;
        }
        through *= left;
        if (unfolded(push.cutout) != 0 && turn == 1 && !hit) {
            shown = 0.0;
            alive = false;
            continue;
        }

        // Lamps that the path goes through, and the sun if it ends there. Not seen from the eye as such.
        if (!straight) {
            float chances = float(lampsAsked());
            float reached = hit ? t : hitsGround ? toGround : 1e30;
            uint lights = unfolded(frame.lightCount);
            for (uint k = 0; k < lights; ++k) {
                Light lamp = frame.lights[k];
                vec4 ball = lampBall(lamp, o);
                bool found = lamp.directional == 0 && dot(ball.xyz, d) > 1.0 - ball.w && distance(lamp.position, o) < reached;
                float asked = 1.0 / (6.2831853 * ball.w * chances);
                if (found) light += through * lampRadiance(lamp, d) * (density < 0.0 ? 1.0 : density / (density + asked));
            }
            if (!blocked && push.sunWide > 0.0 && dot(d, push.sun) > 1.0 - push.sunWide) {
                float asked = 1.0 / (sunSpread() * chances);
                light += through * frame.sunLight / sunSpread() * (density < 0.0 ? 1.0 : density / (density + asked));
            }
        }
        if (!blocked) {
            vec3 sky = straight ? backdrop(d) : surroundings(d, 0.0);
#ifdef ENVIRONMENT
            sky *= density < 0.0 ? 1.0 : density / (density + skyDensity(d) / float(lampsAsked()));
#endif
            light += through * sky;
            alive = false;
            continue;
        }

        // The surface.
        vec3 p = o + d * (hit ? t : toGround), n = vec3(0, 1, 0);
        Surface s = groundSurface(0.0);
        float slope = 1.0, transmission = 0.0, other = 1.0;
        vec3 otherAbsorption = vec3(0.0);
        bool otherWithin = false;
        if (hit) {
            chooseMembers(fromMiddle(p));
            vec4 g = vec4(0.0), region = regionDistance(p);
#ifdef FIELD_TRANSMITS
            hitsOpaque = hitsOpaque && !between && opaqueAt(bounds, p) < 4.0 * close;
            if (hitsOpaque) g = fieldOpaqueGradient(p);
            else
#endif
                g = fieldGradient(between ? p - d * (4.0 * close) : p);
#ifdef FIELD_MEDIA
            if (between) {
                g.xyz -= fieldGradient(p + d * (4.0 * close)).xyz;
                g.w = 0.0;
            }
#endif
            slope = max(length(g.xyz), 1e-6);
            float off = g.w / slope;
            bool cap = !between && region.w > off - 0.1 * close && region.w > -4.0 * close;
            n = cap ? region.xyz : g.xyz / slope;
            p -= n * clamp(cap ? region.w : off, -4.0 * close, 4.0 * close);
        }
        n = within && !hitsOpaque ? -n : n;  // towards where the ray comes from
        float facing = dot(n, d);
        n = facing > -1e-4 ? normalize(n - (facing + 1e-3) * d) : n;
        float bias = clamp(4.0 * close / min(slope, 1.0), 4.0 * close, 64.0 * close);
        if (hit) {
            FieldMaterial material;
#ifdef FIELD_TRANSMITS
            if (hitsOpaque) {
                material = fieldOpaqueMaterial(p);
            } else {
                vec3 beyond = p - n * bias;
                material = fieldMaterial(beyond);
                otherWithin = wholeAt(bounds, beyond) < 0.0;
                transmission = within || otherWithin ? material.transmission : 0.0;
                other = otherWithin ? material.ior : 1.0;
                otherAbsorption = otherWithin ? material.absorption : vec3(0.0);
            }
#else
            material = fieldMaterial(p);
#endif
            s.base = clamp(material.baseColor, 0.0, 1.0);
            s.metallic = clamp(material.metallic, 0.0, 1.0);
            s.roughness = clamp(material.roughness, 0.0, 1.0);
            s.emission = max(material.emission, 0.0);
            s.ground = false;
        }
        bool passes = transmission > 0.0 && random(state) < transmission;
        light += passes ? vec3(0.0) : through * s.emission;
        vec3 x, y, back = -d;
        axesAcross(n, x, y);
        vec3 from = vec3(dot(back, x), dot(back, y), max(dot(back, n), 1e-4));
        float alpha = max(s.roughness, kSmooth);
        alpha *= alpha;
        vec3 h = facet(from, alpha, vec2(random(state), random(state)));
        float choice = random(state);

        if (passes) {
            h = s.roughness > kSmooth ? h : vec3(0, 0, 1);
            float ratio = other / ior, cosine = max(dot(from, h), 1e-4);
            bool mirrors = choice < fresnel(cosine, ratio);
            vec3 l = mirrors ? 2.0 * cosine * h - from : refract(-from, h, 1.0 / ratio);
            if (mirrors != l.z > 0.0) {  // a facet's, on the wrong side
                l = mirrors ? vec3(-from.xy, from.z) : refract(-from, vec3(0, 0, 1), 1.0 / ratio);
                mirrors = l.z >= 0.0;
                if (mirrors) l = vec3(-from.xy, from.z);
            }
            d = normalize(l.x * x + l.y * y + l.z * n);
            o = p + n * (mirrors ? bias : -bias);
            if (!mirrors) {
                through *= (within ? vec3(1.0) : s.base) / (ratio * ratio);
                within = otherWithin;
                ior = other;
                absorption = otherAbsorption;
            }
            straight = straight && !mirrors;
            density = -1.0;
            continue;
        }

        if (s.ground && unfolded(frame.studio) != 0) {
            // Not drawn itself: the wall, dimmed where the sun or the sky is hidden.
            vec3 wall = backdrop(d);
            light += through * wall * (1.0 - fade);
            through *= wall * fade;
            o = p + n * bias;
            straight = false;
            purpose = after = kOpen;
            onward = d = cosineDirection(n, vec2(random(state), random(state)));
            far = frame.ambientRadius;
            if (push.sunWide >= 0.0) {
                purpose = kShade;
                d = inCone(push.sun, 1.0 - push.sunWide, vec2(random(state), random(state)));
                far = 1e30;
            }
            continue;
        }

        // Opaque: of a facet, or as from chalk.
        vec3 mirror = s.ground ? vec3(0.0) : mirrored(s), tint = mirror + (1.0 - mirror) * (s.ground ? 0.0 : fifth(1.0 - max(dot(from, h), 0.0)));
        vec3 l = 2.0 * dot(from, h) * h - from;
        float seen = l.z > 0.0 ? unmasked(from, l, alpha) : 0.0, share = mean(tint);
        vec3 base = s.base * (1.0 - s.metallic), again = tint + (1.0 - tint) * base;  // of what meets the surface once more
        vec3 chalk = tint * (1.0 - seen) * again + (1.0 - tint) * base;
        float likely = clamp(1.0 - mean(mirror) - (1.0 - mean(mirror)) * fifth(1.0 - from.z), 0.05, 1.0);  // share of chalk, about
        o = p + n * bias;

        // One lamp, or the sun.
        uint lamps = lampsAsked();
        bool asks = false;
        if (lamps > 0 && bounces < push.bounces) {
            uint k = min(uint(random(state) * float(lamps)), lamps - 1);
            vec2 u = vec2(random(state), random(state));
            vec3 toLamp, radiance;
            float asked;  // density; 0: a single direction, whose irradiance `radiance` is
            float limit = 1e30;
#ifdef ENVIRONMENT
            if (k == lamps - 1) {
                toLamp = skyDirection(u);
                asked = skyDensity(toLamp) / float(lamps);
                radiance = asked > 0.0 ? skyAt(0, toLamp) : vec3(0.0);
                asked = max(asked, 1e-30);
            } else
#endif
            if (k == unfolded(frame.lightCount)) {
                toLamp = inCone(push.sun, 1.0 - push.sunWide, u);
                asked = push.sunWide > 0.0 ? 1.0 / (sunSpread() * float(lamps)) : 0.0;
                radiance = push.sunWide > 0.0 ? frame.sunLight / sunSpread() : frame.sunLight * float(lamps);
            } else {
                Light lamp = frame.lights[k];
                if (lamp.directional != 0) {
                    toLamp = -lamp.direction;
                    asked = 0.0;
                    radiance = lamp.color * float(lamps);
                } else {
                    vec4 ball = lampBall(lamp, o);
                    toLamp = inCone(ball.xyz, 1.0 - ball.w, u);
                    asked = 1.0 / (6.2831853 * ball.w * float(lamps));
                    radiance = lampRadiance(lamp, toLamp);
                    limit = max(distance(lamp.position, o) - lamp.size, 0.0);
                }
            }
            vec3 to = vec3(dot(toLamp, x), dot(toLamp, y), dot(toLamp, n));
            if (to.z > 0.0) {
                vec3 half_ = normalize(from + to);
                vec3 shine = s.ground ? vec3(0.0) : (mirror + (1.0 - mirror) * fifth(1.0 - max(dot(from, half_), 0.0))) * lobe(from, to, alpha);
                float found = mean(shine) + likely * chalkDensity(to.z, toLamp, ior);
                pending = through * (shine + chalk * (to.z / kPi)) * radiance / (asked > 0.0 ? asked + found : 1.0);
                asks = any(greaterThan(pending, vec3(0.0)));
                onward = toLamp;
                far = asks ? limit : 1e30;
            }
        }

        // Where the path goes on.
        vec3 next;
        if (choice < share * seen) {
            through *= tint / share;
        } else {
            bool masked = choice < share;
            through *= masked ? tint / share * again : (1.0 - tint) * base / max(1.0 - share, 1e-6);
            vec2 u = vec2(random(state), random(state));
            next = cosineDirection(n, u);
#ifdef FIELD_TRANSMITS
            float choiceOfSun = random(state) / kToSun;
            if (push.sunWide > 0.0 && choiceOfSun < kNarrow) next = inCone(sunFrom(ior), kSunCore, u);
            else if (push.sunWide > 0.0 && choiceOfSun < 1.0) next = inCone(push.sun, kSunCone, u);
#endif
            l = vec3(dot(next, x), dot(next, y), dot(next, n));
            through *= l.z > 0.0 ? l.z / kPi / chalkDensity(l.z, next, ior) : 0.0;
        }
        next = normalize(l.x * x + l.y * y + l.z * n);
        vec3 middle = normalize(from + l);
        vec3 shine = s.ground ? vec3(0.0) : (mirror + (1.0 - mirror) * fifth(1.0 - max(dot(from, middle), 0.0))) * lobe(from, l, alpha);
        density = mean(shine) + likely * chalkDensity(l.z, next, ior);
        straight = false;
        float lives = ++bounces > 3 ? clamp(max(through.x, max(through.y, through.z)), 0.05, 1.0) : 1.0;
        alive = bounces <= push.bounces && max(through.x, max(through.y, through.z)) > 0.0 && random(state) < lives;
        through /= lives;
        purpose = asks ? kLamp : kPath;
        start = o, startIor = ior, startAbsorption = absorption;
        after = kPath;
        d = asks ? onward : next;
        onward = next;
    } while (!done);

    sums[at] = vec4(total, sum.w + allShown);
}
