// Outlines of the field: the float twin of graph/outlines/outline.cpp, outline.h says how their texels lie and arc.h what
// an arc is. The text generated for a field declares their buffer as fieldVolumes before it includes this, and calls
// these with an outline's place there.

struct OutlineGrid {
    int first;  // texel
    int cells, rows, farCells;
    vec2 centre, half_;
    float least;
    bool straight;
};

struct OutlineArc {
    vec2 a, b, normal;
    float bend;
};

uvec4 outlineCell(OutlineGrid grid, vec2 p) {
    vec2 away = p - grid.centre, half_ = grid.half_;
    ivec2 cells = ivec2(grid.cells, grid.rows);
    int before = 0;
    if (abs(away.x) >= half_.x || abs(away.y) >= half_.y) {
        float most = max(half_.x, half_.y), far = max(max(abs(away.x), abs(away.y)) / most, 1e-9);
        int level = 0;
        frexp(far, level);
        level = clamp(level, 1, OUTLINE_LEVELS - 1);
        half_ = vec2(most * max(exp2(float(level)), far));
        cells = ivec2(grid.farCells);
        before = grid.cells * grid.rows + (level - 1) * grid.farCells * grid.farCells;
    }
    ivec2 at = ivec2(clamp((away / half_ + 1.0) * 0.5 * vec2(cells), vec2(0.0), vec2(cells) - 0.5));
    return imageLoad(fieldVolumes, grid.first + before + at.y * cells.x + at.x);
}

OutlineArc outlineArc(OutlineGrid grid, int list, int k) {
    vec4 ends = uintBitsToFloat(imageLoad(fieldVolumes, grid.straight ? list + k : list + 2 * k));
    OutlineArc arc = OutlineArc(ends.xy, ends.zw, vec2(0.0), 0.0);
    if (grid.straight) {
        vec2 along = ends.zw - ends.xy;
        arc.normal = vec2(-along.y, along.x) * inversesqrt(max(dot(along, along), 1e-30));
    } else {
        vec4 rest = uintBitsToFloat(imageLoad(fieldVolumes, list + 2 * k + 1));
        arc.normal = rest.xy;
        arc.bend = rest.z;
    }
    return arc;
}

float outlineSide(OutlineArc arc, vec2 q) {
    return arc.bend == 0.0 ? dot(q, arc.normal)
                           : (2.0 * dot(q, arc.normal) - arc.bend * dot(q, q)) / (1.0 + length(arc.bend * q - arc.normal));
}
bool outlineLeft(OutlineArc arc, vec2 p) {
    vec2 along = arc.b - arc.a, q = p - arc.a;
    float beside = along.x * q.y - along.y * q.x;
    bool left = beside > 0.0 || (beside == 0.0 && along.x > 0.0);
    if (arc.bend == 0.0 || left == (arc.bend > 0.0)) return left;
    float side = 2.0 * dot(q, arc.normal) - arc.bend * dot(q, q);
    return side > 0.0 || (side == 0.0 && arc.normal.y > arc.bend * q.y);
}
bool outlineFaces(OutlineArc arc, vec2 q) {
    vec2 chord = arc.b - arc.a, last = arc.normal - arc.bend * chord, r = q - chord;
    return q.x * arc.normal.y - q.y * arc.normal.x > 0.0 && r.x * last.y - r.y * last.x < 0.0;
}

// The distance's derivatives, 0 and the distance.
vec4 outlineSample(OutlineGrid grid, vec2 p) {
    uvec4 cell = outlineCell(grid, p);
    int list = grid.first + int(cell.x), count = int(cell.y & 65535u), met = int(cell.y >> 16 & 32767u);
    vec2 known = uintBitsToFloat(cell.zw), turn = vec2(known.x, p.y);
    bool inside = (cell.y >> 31) != 0u;
    float nearest = 1e38;
    OutlineArc best = OutlineArc(vec2(0.0), vec2(0.0), vec2(0.0), 0.0);
    // The condition stands at the head: where it stands at the end, SwiftShader goes on to write in invocations that are
    // through, from loads that yield nothing.
    for (int k = 0; k < count; ++k) {
        OutlineArc arc = outlineArc(grid, list, k);
        vec2 q = p - arc.a, r = p - arc.b;
        float side = outlineSide(arc, q), squared = outlineFaces(arc, q) ? side * side : min(dot(q, q), dot(r, r));
        bool nearer = squared < nearest, meets = k < met;
        nearest = nearer ? squared : nearest;
        best.a = nearer ? arc.a : best.a;
        best.b = nearer ? arc.b : best.b;
        best.normal = nearer ? arc.normal : best.normal;
        best.bend = nearer ? arc.bend : best.bend;
        bool atTurn = outlineLeft(arc, turn);
        bool rises = (arc.a.x <= turn.x) != (arc.b.x <= turn.x) && outlineLeft(arc, known) != atTurn;
        bool runs = (arc.a.y <= p.y) != (arc.b.y <= p.y) && outlineLeft(arc, p) != atTurn;
        inside = inside != (meets && rises != runs);
    }
    float sign_ = inside ? -1.0 : 1.0;
    vec2 q = p - best.a, r = p - best.b;
    if (outlineFaces(best, q)) {  // by its circle or line, which is exact near it
        float side = outlineSide(best, q), out_ = side >= 0.0 ? sign_ : -sign_;
        vec2 towards = best.normal - best.bend * q;
        return out_ * vec4(towards * inversesqrt(max(dot(towards, towards), 1e-30)), 0.0, side);
    }
    vec2 off = dot(q, q) <= dot(r, r) ? q : r;
    float distance_ = length(off);
    return sign_ * vec4(distance_ > 0.0 ? off / distance_ : vec2(0.0), 0.0, distance_);
}

// Contains every value over a box of x and y.
vec2 outlineRange(OutlineGrid grid, vec2 x, vec2 y) {
    float centre = outlineSample(grid, 0.5 * vec2(x.x + x.y, y.x + y.y)).w;
    float far = max(max(-x.x, x.y), max(-y.x, y.y)) + abs(centre) + max(grid.half_.x, grid.half_.y);
    float reach = 0.5 * length(vec2(x.y - x.x, y.y - y.x)) + 1e-6 * far;
    return vec2(max(centre - reach, grid.least - 1e-6 * far), centre + reach);
}
