// Depth and normals of a view by sphere tracing the field itself (Hart 1996), with no mesh: what a picture is compared with,
// and on software devices the faster way to see a field.
#define FIELD_GRADIENT
#include "shared.h"
#include "render/ambient.h"
#include "field.glsl"
#include "lib/octahedral.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, r32f) writeonly uniform image2D depth;
layout(binding = 1, r32ui) writeonly uniform uimage2D normals;
layout(push_constant, scalar) uniform Push { PrimaryPush push; };

void main() {
    fieldBegin();
    uvec2 pixel = gl_GlobalInvocationID.xy, size = uvec2(push.width, push.height);
    vec2 place = (vec2(pixel) + 0.5) / vec2(size) * 2.0 - 1.0;
    vec3 corner = push.forward + place.x * push.right + place.y * push.down;
    float scale = length(corner);
    vec3 ray = corner / scale;
    float t = push.near;
    vec4 f;
    uint i = 0;
    bool hit;
    do {  // the gradient is needed at the hit only, but the field is compiled once
        f = fieldGradient(push.eye + ray * t);
        hit = f.w < push.pixel * t;
        t += hit ? 0.0 : f.w * push.stepScale;
    } while (!hit && ++i < push.steps && t < push.far);
    bool inPicture = all(lessThan(pixel, size));
    float along = t / scale;  // distance along `forward`
    float z = push.far / (push.far - push.near) * (1.0 - push.near / along);
    float steepness = length(f.xyz);
    if (inPicture) {
        imageStore(depth, ivec2(pixel), vec4(hit ? z : 1.0));
        imageStore(normals, ivec2(pixel), uvec4(packOctahedral(steepness > 0.0 ? f.xyz / steepness : -ray)));
    }
}
