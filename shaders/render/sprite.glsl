// Of particles that are drawn. After render.h.
layout(push_constant, scalar) uniform Push { SpritePush push; };

vec4 clipOf(vec3 p) {
    vec4 q = vec4(p, 1.0);
    return vec4(dot(push.toClip[0], q), dot(push.toClip[1], q), dot(push.toClip[2], q), dot(push.toClip[3], q));
}

// Two axes across the way from the eye to p, and that towards the eye.
mat3 axesAt(vec3 p) {
    vec3 toEye = normalize(push.eye.w > 0.0 ? push.eye.xyz - p : -push.eye.xyz);
    vec3 side = normalize(abs(toEye.y) < 0.9 ? vec3(-toEye.z, 0.0, toEye.x) : vec3(0.0, toEye.z, -toEye.y));
    return mat3(side, cross(toEye, side), toEye);
}
