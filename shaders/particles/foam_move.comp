// A step of foam. How much fluid is where a particle would come of itself says what it is, and so what moves it.
#include "particles/foam.glsl"
#ifdef OBSTACLE
#include "field.glsl"
#endif

layout(local_size_x = FLUID_GROUP) in;
layout(binding = 1, rgba32ui) restrict readonly uniform uimageBuffer fluidPlaces;
layout(binding = 2, rgba32ui) restrict readonly uniform uimageBuffer fluidVelocities;
layout(binding = 3, scalar) readonly buffer Starts { uint starts[]; };  // of cells
layout(binding = 4, scalar) buffer Places { vec4 places[]; };
layout(binding = 5, scalar) buffer Velocities { vec4 velocities[]; };

const float kSprayBelow = 0.2, kBubbleAbove = 0.8;  // of the density at rest
const float kRise = 0.025;                          // s: times gravity, how fast bubbles rise
const float kDrag = 80.0;                           // 1/s: how fast they come to that

void main() {
#ifdef OBSTACLE
    fieldBegin();
#endif
    uint slot = item();
    if (slot >= foam.slots) return;
    vec4 place = places[slot], velocity = velocities[slot];
    bool there = velocity.w >= 0.0;
    if (!there) place.xyz = push.lo;
    int kind = int(velocity.w);
    float luck = fract(velocity.w);
    bool flies = kind == FOAM_SPRAY;
    vec3 flown = place.xyz + push.step * velocity.xyz + (flies ? 0.5 * push.step * push.step : 0.0) * push.gravity;
    vec3 p = inTank(flown);

    float density = 0.0, far = 1.05 * push.support;  // particles have left the cells that they were sorted by, a little
    vec3 sum = vec3(0.0);
    ivec2 own = cellOf(p).yz;
    int row = 0;
    do {
        ivec2 at = own + ivec2(row % 3, row / 3) - 1;
        vec2 low = push.first.yz + vec2(at) / push.perCell.yz - p.yz, away = max(max(low, -low - push.support), vec2(0.0));
        float squared = far * far - dot(away, away), reach = sqrt(max(squared, 0.0));
        uint i = starts[cellIndex(ivec3(cellOf(p - vec3(reach, 0.0, 0.0)).x, at))];
        uint end = starts[cellIndex(ivec3(cellOf(p + vec3(reach, 0.0, 0.0)).x + 1, at))];
        end = there && squared > 0.0 ? end : i;
        for (; i < end; ++i) {
            vec3 off = p - uintBitsToFloat(imageLoad(fluidPlaces, int(i)).xyz);
            float weight = weightShape(leftOf(dot(off, off)));
            density += weight;
            sum += weight * uintBitsToFloat(imageLoad(fluidVelocities, int(i)).xyz);
        }
    } while (++row < 9);
    vec3 carried = sum / max(density, 1e-9);
    float walls = wallsAt(p, vec4(0.0, 0.0, 0.0, -1e9)).w, full = push.weight * density / max(1.0 - walls, 0.2);

    bool inside = full > kBubbleAbove;
    kind = full < kSprayBelow ? FOAM_SPRAY : inside ? FOAM_BUBBLE : FOAM_FOAM;
    float kept = exp(-kDrag * push.step);
    vec3 next = kind == FOAM_SPRAY    ? velocity.xyz + push.step * push.gravity
                : kind == FOAM_BUBBLE ? mix(carried - kRise * push.gravity, velocity.xyz, kept)
                                      : carried;
    p = flies || kind == FOAM_SPRAY ? flown : inTank(place.xyz + push.step * next);
    bool lost = kind == FOAM_SPRAY && p != inTank(p);
    p = inTank(p);
#ifdef OBSTACLE
    vec4 f = fieldGradient(p);
    float slope = length(f.xyz), deep = max(-f.w, 0.0) / max(slope, 1.0);
    lost = lost || kind == FOAM_SPRAY && deep > 0.0;
    p = inTank(p + deep * f.xyz / max(slope, 1e-6));
#endif
    float age = place.w + (kind == FOAM_FOAM ? push.step : 0.0);
    there = there && !lost && age <= (0.5 + luck) * foam.lifetime;
    places[slot] = there ? vec4(p, age) : vec4(uintBitsToFloat(uvec4(0x7fc00000u)));
    velocities[slot] = there ? vec4(next, float(kind) + luck) : vec4(0.0, 0.0, 0.0, kNoFoam);
}
