// What stands at each sample, by the particles around its block: of the blocks that are listed, one for each work group, so that all its
// lanes go through the same particles. A kernel defines the functions below.
#include "particles/surface.glsl"

layout(local_size_x = SURFACE_LANES) in;
layout(binding = 2, scalar) writeonly buffer Distance { vec4 distances[]; };  // cells; rows padded to texels
layout(binding = 4, scalar) readonly buffer Blocks { uint blocks[]; };        // how many, and which

// A lane has four samples along x in two layers.
vec4 px;
float py;
vec2 pz;

void nothing();             // what is known before the first particle
void add(uint i);           // the i-th in the order of buckets
vec4 lengths(int layer);    // of this lane's samples; 0 deep inside

void main() {
    uint group = linearGroup();
    if (group >= blocks[0]) return;
    Block block = blockOf(blocks[1 + group]);
    int lane = int(gl_LocalInvocationIndex);
    px = block.lo.x + block.cell * vec4(0.0, 1.0, 2.0, 3.0);
    py = block.lo.y + block.cell * float(lane % 4);
    pz = block.lo.z + block.cell * (float(lane / 4) + vec2(0.0, 2.0));
    nothing();
    Rows rows = rowsAround(block);
    int row = 0;
    do {
        uvec2 range = particlesOf(block, rows, row);
        if (range.x < range.y) do {
            add(range.x);
        } while (++range.x < range.y);
    } while (++row < rows.count.x * rows.count.y);
    for (int layer = 0; layer < 2; ++layer) {
        ivec3 at = block.first + ivec3(0, lane % 4, lane / 4 + 2 * layer);
        if (all(lessThan(at, texels())))
            distances[(at.z * texels().y + at.y) * texels().x + at.x] = (lengths(layer) - push.drop) / block.cell;
    }
}
