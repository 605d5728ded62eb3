// The picture at the window's size, interpolated linearly, under what is drawn over it.
#include "shared.h"
#include "window/window.h"

layout(local_size_x = WINDOW_GROUP, local_size_y = WINDOW_GROUP) in;
layout(push_constant, scalar) uniform PushConstants { WindowPush push; };
layout(binding = 0, r32ui) readonly uniform uimage2D picture;
layout(binding = 1, scalar) readonly buffer Overlay { uint overlay[]; };  // colours times their alpha
layout(binding = 2, scalar) writeonly buffer Shown { uint shown[]; };

vec3 pictureAt(ivec2 p) { return unpackUnorm4x8(imageLoad(picture, clamp(p, ivec2(0), ivec2(push.picture) - 1)).x).xyz; }

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    vec2 at = (vec2(pixel) + 0.5) * vec2(push.picture) / vec2(push.window) - 0.5;
    ivec2 first = ivec2(floor(at));
    vec2 part = at - vec2(first);
    vec3 upper = mix(pictureAt(first), pictureAt(first + ivec2(1, 0)), part.x);
    vec3 lower = mix(pictureAt(first + ivec2(0, 1)), pictureAt(first + 1), part.x);
    bool within = pixel.x < push.window.x && pixel.y < push.window.y;
    uint place = within ? pixel.y * push.window.x + pixel.x : 0;
    vec4 over = unpackUnorm4x8(overlay[place]);
    vec3 color = over.xyz + (1.0 - over.w) * mix(upper, lower, part.y);
    if (within) shown[place] = packUnorm4x8(vec4(color, 1.0));
}
