// A particle, as a triangle about the disc that it fills of the picture.
#include "shared.h"
#include "render/render.h"
#include "render/sprite.glsl"

layout(binding = 0, scalar) readonly buffer Places { vec4 places[]; };
layout(binding = 1, scalar) readonly buffer Velocities { vec4 velocities[]; };
layout(location = 0) out vec2 onDisc;  // in radii
layout(location = 1) flat out vec4 sphere;
layout(location = 2) flat out float speed;

void main() {
    vec3 centre = places[gl_VertexIndex / 3].xyz;
    uint corner = gl_VertexIndex % 3;
    onDisc = corner == 0 ? vec2(0.0, 2.0) : vec2(corner == 1 ? -1.7320509 : 1.7320509, -1.0);
    sphere = vec4(centre, max(push.radius, push.least * distance(centre, push.eye.xyz)));
    speed = push.perFast > 0.0 ? push.perFast * length(velocities[gl_VertexIndex / 3].xyz) : 0.0;
    mat3 axes = axesAt(centre);
    vec4 place = clipOf(centre + sphere.w * (axes[0] * onDisc.x + axes[1] * onDisc.y));
    gl_Position = any(isnan(centre)) ? vec4(0.0, 0.0, 0.0, 1.0) : place;  // all three there: no triangle
}
