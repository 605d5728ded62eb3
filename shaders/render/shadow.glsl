// What the sun's shadow map says of a point. `frame` is the RenderFrame, shadowMap a sampler2D of its depths: 1 is near the sun,
// 0 where nothing is.

// 1 if the sun reaches p, 0 if not.
float sunReaches(vec3 p, vec2 offset) {
    vec3 v = p - frame.shadowCentre;
    vec2 place = vec2(dot(frame.shadowRight, v), dot(frame.shadowUp, v));
    vec2 texel = (place * vec2(0.5, -0.5) + 0.5) * float(frame.shadowSize) + offset;
    float depth = 1.0 - (dot(frame.shadowForward, v) * 0.5 + 0.5);
    bool inMap = all(greaterThanEqual(texel, vec2(0.0))) && all(lessThan(texel, vec2(frame.shadowSize)));
    float blocker = texelFetch(shadowMap, ivec2(inMap ? texel : vec2(0.0)), 0).x;
    return inMap && blocker > max(depth, 0.0) ? 0.0 : 1.0;
}
