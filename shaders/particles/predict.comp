// Where each particle would be without the others: its step under gravity, ended at the tank's walls and at the obstacle. And
// the cell that it is then in, and the obstacle's plane that is nearest there.
#include "particles/fluid.glsl"
#include "field.glsl"

layout(local_size_x = FLUID_GROUP) in;
layout(binding = 0, rgba32ui) restrict readonly uniform uimageBuffer places;      // floats: metres
layout(binding = 1, rgba32ui) restrict readonly uniform uimageBuffer velocities;  // floats: m/s
layout(binding = 2, scalar) writeonly buffer Guesses { vec4 guesses[]; };  // and the energy
layout(binding = 3, scalar) writeonly buffer Planes { vec4 planes[]; };  // floats: the normal, and the distance from the origin
layout(binding = 4, scalar) writeonly buffer Keys { uint keys[]; };

void main() {
    fieldBegin();
    uint index = item();
    if (index >= push.particles) return;
    vec3 place = uintBitsToFloat(imageLoad(places, int(index)).xyz);
    vec3 velocity = uintBitsToFloat(imageLoad(velocities, int(index)).xyz) + push.step * push.gravity;
    vec3 p = inTank(place + push.step * velocity);
    vec4 plane = vec4(0.0, 0.0, 0.0, -1e9);
#ifdef OBSTACLE
    vec4 f = fieldGradient(p);
    float slope = max(length(f.xyz), 1e-6);
    vec3 normal = f.xyz / slope;
    float distance = f.w / max(slope, 1.0);
    plane = vec4(normal, dot(normal, p) - distance);
    p = inTank(p + max(-distance, 0.0) * normal);
#endif
    vec3 pushed = (p - place) / push.step;  // by walls and the obstacle too
    guesses[index] = vec4(p, energyAt(p, max(dot(velocity, velocity), dot(pushed, pushed))));
    planes[index] = plane;
    keys[index] = cellIndex(cellOf(p));
}
