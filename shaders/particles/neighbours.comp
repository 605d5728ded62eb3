// Lists the near neighbours of each particle, and adds up the density of those that are farther, but not beyond the support, in
// the nine rows of cells around it. What the ball of the kernel can reach of a row lies in one piece. Without FAR_ONCE all are
// near.
#include "particles/fluid.glsl"

layout(local_size_x = FLUID_GROUP) in;
layout(binding = 0, rgba32ui) restrict readonly uniform uimageBuffer guesses;
layout(binding = 1, scalar) readonly buffer Starts { uint starts[]; };
layout(binding = 2, scalar) writeonly buffer Lists { uvec4 lists[]; };  // from that of push.from on
layout(binding = 3, scalar) writeonly buffer Counts { uint counts[]; };
layout(binding = 4, scalar) writeonly buffer Far { float far[]; };

// To store a neighbour takes software devices as long as to find it, so they are stored four at a time: up to seven wait, the
// newest first.
uvec4 newest;
uvec3 older;

uvec4 oldestOf(uint waiting) {
    return waiting == 4 ? newest
         : waiting == 5 ? uvec4(newest.yzw, older.x)
         : waiting == 6 ? uvec4(newest.zw, older.xy)
                        : uvec4(newest.w, older);
}

void main() {
    uint index = push.from + item();
    if (index >= push.particles) return;
    vec3 p = uintBitsToFloat(imageLoad(guesses, int(index)).xyz);
    ivec2 own = cellOf(p).yz;
    float most = push.support * push.support, nearest = push.near * push.near, farther = 0.0;
    newest = uvec4(index), older = uvec3(index);
    uint found = 0, waiting = 0;
    int row = 0, texel = firstTexel(item());
    do {
        ivec2 at = own + ivec2(row % 3, row / 3) - 1;
        vec2 low = push.first.yz + vec2(at) / push.perCell.yz - p.yz, away = max(max(low, -low - push.support), vec2(0.0));
        float squared = 1.001 * most - dot(away, away);  // a little more, for what rounding does to cells
        float reach = sqrt(max(squared, 0.0));
        uint i = starts[cellIndex(ivec3(cellOf(p - vec3(reach, 0.0, 0.0)).x, at))];
        uint end = starts[cellIndex(ivec3(cellOf(p + vec3(reach, 0.0, 0.0)).x + 1, at))];
        end = squared > 0.0 ? end : i;
        do {
            for (int k = 0; k < 4; ++k, ++i) {
                vec3 off = p - uintBitsToFloat(imageLoad(guesses, int(min(i, push.particles - 1))).xyz);
                float apart = dot(off, off);
                bool other = i < end && i != index, near = other && apart < nearest && found < FLUID_MOST_NEIGHBOURS;
#ifdef FAR_ONCE
                farther += other && apart >= nearest ? weightShape(leftOf(apart)) : 0.0;
#endif
                older = near ? uvec3(newest.w, older.xy) : older;
                newest = near ? uvec4(i, newest.xyz) : newest;
                found += near ? 1 : 0;
                waiting += near ? 1 : 0;
            }
            uvec4 oldest = oldestOf(waiting);
            if (waiting >= 4) {
                lists[texel] = oldest;
                texel += kNextTexel;
                waiting -= 4;
            }
        } while (i < end);
    } while (++row < 9);
    uvec3 rest = mix(uvec3(index), newest.xyz, greaterThan(uvec3(waiting), uvec3(0, 1, 2)));
    if (waiting > 0 || found == 0) lists[texel] = uvec4(rest, index);
    far[index] = push.weight * farther;
    counts[index] = found;
}
