// Light on a surface: microfacets (GGX), the sky, the studio. After gbuffer.glsl; `frame` is the RenderFrame.
// If ENVIRONMENT is defined, the sky is that of environment.glsl.

const float kPi = 3.14159265;

#ifdef ENVIRONMENT
#include "render/environment.glsl"
#endif

vec3 skyColor(vec3 d) {
    vec3 sky = mix(frame.horizon, frame.zenith, smoothstep(0.0, 0.9, d.y));
    return mix(frame.groundColor, sky, smoothstep(-0.25, 0.15, d.y));
}

// The sky as it is looked at: with a glow about the sun, which has its disc.
vec3 skySeen(vec3 d) {
#ifdef ENVIRONMENT
    return skyAt(0, d);
#endif
    float toSun = max(dot(d, frame.sun), 0.0);
    vec3 up = mix(frame.horizon, frame.zenith, smoothstep(0.0, 0.6, d.y));
    vec3 sky = mix(frame.groundColor, up, smoothstep(-0.12, 0.02, d.y));
    return sky + frame.sunLight * (0.04 * pow(toSun, 12.0) + 0.12 * pow(toSun, 160.0) + 2.0 * smoothstep(0.9993, 0.9997, toSun));
}

// What a mirror sees. In the studio the light falls off to the right, and a large soft lamp stands on the left.
vec3 surroundings(vec3 d, float roughness) {
#ifdef ENVIRONMENT
    return environment(d, roughness);
#endif
    float lamp = dot(d, normalize(vec3(-0.75, 0.45, 0.45))), blur = 0.05 + 0.4 * roughness;
    vec3 studio = skyColor(d) * mix(1.1, 0.35, smoothstep(-0.6, 0.9, d.x)) +
                  1.6 * smoothstep(0.80 - blur, 0.80 + 0.5 * blur, lamp);
    return frame.studio != 0 ? studio : skyColor(d);
}

// The studio's wall at a place in the picture.
vec3 wallAt(vec2 place) {
    return mix(vec3(0.76, 0.745, 0.72), vec3(0.36, 0.43, 0.53), smoothstep(-1.0, 1.2, place.y)) * (1.0 - 0.10 * dot(place, place));
}

// What a shadow on the ground leaves of the wall's light: that of the sky, and of that what is not hidden.
vec3 wallDimmed(vec3 sunlit, float open) { return mix(vec3(0.46, 0.50, 0.58), vec3(1.0), sunlit) * mix(0.35, 1.0, open); }

// What a ray that goes straight from the eye ends at, though it may have been bent: the wall as it is where it would be seen.
vec3 backdrop(vec3 d) {
    if (unfolded(frame.studio) == 0) return skySeen(d);
    vec3 at = project(frame.now, frame.now.eye + d);
    return wallAt(at.z > 0.05 ? clamp(at.xy, -1.5, 1.5) : vec2(0.0));
}

// Light of the sky on a surface that sees `open` of it, as an average over its hemisphere.
vec3 skylight(vec3 n) {
#ifdef ENVIRONMENT
    return skyAt(frame.skyLevels, n);
#endif
    // The cosine-weighted mean of skyColor, which changes with the height alone: fitted by its value a little flatter.
    float up = n.y;
    vec3 above = mix(frame.horizon, frame.zenith, 0.35 + 0.25 * up);
    return mix(frame.groundColor, above, 0.5 + 0.5 * up);
}

// Openness as several bounces of light between surfaces of this colour would leave it (Jimenez et al., "Practical realtime
// strategies for accurate indirect occlusion", 2016).
vec3 bounced(float open, vec3 base) {
    vec3 a = 2.0404 * base - 0.3324, b = -4.7951 * base + 0.6417, c = 2.7552 * base + 0.6903;
    return max(vec3(open), ((open * a + b) * open + c) * open);
}

vec3 mirrored(Surface s) { return mix(vec3(0.04), s.base, s.metallic); }

// Radiance towards the eye for irradiance `light` on a surface that faces the light.
vec3 reflected(Surface s, vec3 toEye, vec3 toLight, vec3 light) {
    float facing = max(dot(s.n, toLight), 0.0), seen = max(dot(s.n, toEye), 1e-3);
    vec3 middle = normalize(toLight + toEye);
    float a2 = s.roughness * s.roughness, nh = max(dot(s.n, middle), 0.0);
    a2 *= a2;
    float lobe = nh * nh * (a2 - 1.0) + 1.0, k = 0.125 * (s.roughness + 1.0) * (s.roughness + 1.0);
    float shape = a2 / (kPi * lobe * lobe) / (4.0 * mix(facing, 1.0, k) * mix(seen, 1.0, k));
    float grazing = 1.0 - max(dot(middle, toEye), 0.0), grazing2 = grazing * grazing;
    vec3 mirror = mirrored(s), fresnel = mirror + (1.0 - mirror) * (grazing2 * grazing2 * grazing);
    return light * facing * (s.base * (1.0 - s.metallic) / kPi + shape * fresnel);
}

// Share of the light all around that the surface mirrors towards the eye: after Karis, "Physically based shading on mobile"
// (2014).
vec3 mirroredShare(Surface s, vec3 toEye) {
    float seen = max(dot(s.n, toEye), 1e-3);
    vec4 c = s.roughness * vec4(-1, -0.0275, -0.572, 0.022) + vec4(1, 0.0425, 1.04, -0.04);
    float edge = min(c.x * c.x, exp2(-9.28 * seen)) * c.x + c.y;
    return mirrored(s) * (c.z - 1.04 * edge) + edge + c.w;
}

// The middle of what a surface mirrors: the rougher, the nearer to its normal.
vec3 mirrorAxis(Surface s, vec3 toEye) { return normalize(mix(reflect(-toEye, s.n), s.n, s.roughness * s.roughness)); }

// Irradiance of a surface at p that faces the lamp, if nothing is between; and where the lamp is.
vec3 lampSends(Light lamp, vec3 p, out vec3 toLamp, out float far) {
    bool parallel = lamp.directional != 0;
    vec3 v = parallel ? -lamp.direction * (4.0 * frame.radius) : lamp.position - p;
    far = length(v);
    toLamp = v / far;
    float cone = smoothstep(lamp.cosOuter, lamp.cosInner, dot(-toLamp, lamp.direction));
    return lamp.color * (parallel ? 1.0 : cone / max(far * far, lamp.size * lamp.size));
}
