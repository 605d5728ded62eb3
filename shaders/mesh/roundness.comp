// How round a mesh is at each vertex: its mean curvature in units of that of the ball that is spared, as far as four of them. Of a ball of
// the radius r, n . e = -e^2 / (2 r) for every edge e. With SPREAD the means of those of a vertex and its neighbours.
#include "mesh/around.glsl"

layout(binding = 4, scalar) readonly buffer Previous { uint previous[]; };
layout(binding = 6, scalar) readonly buffer Round { float roundness[]; };
layout(binding = 7, scalar) writeonly buffer Rounder { float rounder[]; };

const float kMost = 4.0;

void main() {
    uint v = min(item(), push.vertices - 1), count = counts[v], first = starts[v], i = 0;
    vec3 own = positionOf(v);
    ExactSum edges = ExactSum(ivec3(0), ivec3(0)), areas = edges, more = edges;
    do {  // as long as any lane: one that is done adds nothing
        uint at = cornerOf(first, count, i);
#ifdef SPREAD
        add(more, vec3(roundness[next[at]] / kMost, 0.0, 0.0), i < count);
#else
        vec3 edge = (positionOf(next[at]) - own) / push.unit, other = (positionOf(previous[at]) - own) / push.unit;
        add(edges, edge, i < count);
        add(areas, cross(edge, other), i < count);
        add(more, vec3(dot(edge, edge), 0.0, 0.0), i < count);
#endif
    } while (subgroupAny(++i < count));
#ifdef SPREAD
    float found = 0.5 * (roundness[v] + kMost * valueOf(more).x / float(max(count, 1)));
#else
    vec3 normal = valueOf(areas);
    float found = -2.0 * dot(normal, valueOf(edges)) / max(length(normal) * valueOf(more).x, 1e-30) * push.spare / push.unit;
#endif
    if (item() < push.vertices) rounder[v] = clamp(found, -kMost, kMost);
}
