// What the sun's shadow map says of a point. `frame` is the RenderFrame, and, if SHADOW_MAP is defined, shadowMap the image of its depths: 1 is near the sun,
// 0 where nothing is.

// The point's texel, and in z its depth.
vec3 inShadowMap(vec3 p) {
    vec3 v = p - frame.shadowCentre;
    vec2 place = vec2(dot(frame.shadowRight, v), -dot(frame.shadowUp, v));
    return vec3((0.5 * place + 0.5) * float(frame.shadowSize), 0.5 - 0.5 * dot(frame.shadowForward, v));
}

// The same of a place on a surface, as far off it as keeps it out of its own shadow.
vec3 surfaceInShadowMap(vec3 p, vec3 n) { return inShadowMap(p + n * (1.5 * frame.shadowTexel) + frame.sun * (0.75 * frame.shadowTexel)); }

// A place in a disc of three texels, of a pair of numbers from 0 to 1.
vec2 spotInMap(vec2 u) { return vec2(cos(6.2831853 * u.x), sin(6.2831853 * u.x)) * (1.5 * sqrt(u.y)); }

#ifdef SHADOW_MAP
// 1 if the sun reaches the point, 0 if not.
float sunReaches(vec3 at, vec2 offset) {
    vec2 texel = at.xy + offset;
    bool inMap = all(greaterThanEqual(texel, vec2(0.0))) && all(lessThan(texel, vec2(frame.shadowSize)));
    float blocker = imageLoad(shadowMap, ivec2(inMap ? texel : vec2(0.0))).x;
    return inMap && blocker > max(at.z, 0.0) ? 0.0 : 1.0;
}
#endif
