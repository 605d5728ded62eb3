// The slide's fast sweeping: a row's distances grow by a cell from one sample to the next, forwards and backwards.
#include "bake/bake.glsl"

layout(local_size_x = BAKE_GROUP) in;
layout(binding = 1, scalar) buffer Cells { float cells[]; };

void main() {
    int u = push.axis == 0 ? 1 : 0, v = push.axis == 2 ? 1 : 2, row = int(item());
    if (row >= push.size[u] * push.size[v]) return;
    ivec3 first = ivec3(0);
    first[u] = row % push.size[u];
    first[v] = row / push.size[u];
    int start = indexOf(first), stride = indexOf(ivec3(equal(ivec3(0, 1, 2), ivec3(push.axis))));
    for (int way = 0; way < 2; ++way) {
        float d = 1e9;
        for (int n = 0; n < push.size[push.axis]; ++n) {
            int at = start + (way == 0 ? n : push.size[push.axis] - 1 - n) * stride;
            float own = cells[at];
            d += d < 0.0 ? -1.0 : 1.0;
            bool farther = abs(own) > abs(d);
            if (farther) cells[at] = d;
            d = farther ? d : own;
        }
    }
}
