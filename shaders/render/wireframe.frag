// Darkens the finished picture along the edges of the triangles that are seen.
#include "shared.h"

layout(early_fragment_tests) in;
layout(location = 0) in vec3 corner;
layout(binding = 10, r32ui) uniform uimage2D pixels;

void main() {
    vec3 fromEdge = corner / max(fwidth(corner), vec3(1e-6));
    float line = 1.0 - smoothstep(0.4, 1.1, min(fromEdge.x, min(fromEdge.y, fromEdge.z)));
    vec4 color = unpackUnorm4x8(imageLoad(pixels, ivec2(gl_FragCoord.xy)).x);
    color.rgb *= 1.0 - 0.75 * line;
    imageStore(pixels, ivec2(gl_FragCoord.xy), uvec4(packUnorm4x8(color)));
}
