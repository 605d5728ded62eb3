// The disc of a particle gets a sphere's depth and normals, as sprites.comp reads them.
#include "shared.h"
#include "render/render.h"
#include "lib/octahedral.glsl"
#include "render/sprite.glsl"

layout(location = 0) in vec2 onDisc;
layout(location = 1) flat in vec4 sphere;
layout(location = 2) flat in float speed;
#ifndef SHADOW
layout(location = 0) out uvec2 packedLook;

const vec3 kAtRest = vec3(0.02, 0.2, 0.6);
const float kFast = 0.9;
#endif

void main() {
    float above = 1.0 - dot(onDisc, onDisc);
    if (above < 0.0) discard;
    vec3 n = axesAt(sphere.xyz) * vec3(onDisc, sqrt(above));
    vec4 place = clipOf(sphere.xyz + sphere.w * n);
    gl_FragDepth = place.z / place.w;
#ifndef SHADOW
    vec3 color = mix(kAtRest, vec3(kFast), min(speed, 1.0));
    vec3 seen = normalize(vec3(dot(push.normals[0], n), dot(push.normals[1], n), dot(push.normals[2], n)));
    packedLook = uvec2(packOctahedral(seen), packUnorm4x8(vec4(sqrt(color), 1.0)));
#endif
}
