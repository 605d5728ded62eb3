// Outlines of the field: the float twin of graph/assets/outline.cpp, outline.h says how their texels lie. The text
// generated for a field declares their buffer as fieldVolumes before it includes this, and calls these with an outline's
// place there.

struct OutlineGrid {
    int first;  // texel
    int cells, farCells;
    vec2 centre;
    float halfWidth, least;
};

uvec4 outlineCell(OutlineGrid grid, vec2 p) {
    vec2 at = (p - grid.centre) * (1.0 / grid.halfWidth);
    int level = 0;
    float far = max(max(abs(at.x), abs(at.y)), 1e-9);
    frexp(far, level);
    level = clamp(level, 0, OUTLINE_LEVELS - 1);
    int side = level == 0 ? grid.cells : grid.farCells;
    at = clamp((at / max(exp2(float(level)), far) + 1.0) * (0.5 * float(side)), 0.0, float(side) - 0.5);
    int before = level == 0 ? 0 : grid.cells * grid.cells + (level - 1) * side * side;
    return imageLoad(fieldVolumes, grid.first + before + int(at.y) * side + int(at.x));
}

float outlineSide(vec2 along, vec2 q) { return along.x * q.y - along.y * q.x; }
bool outlineLeft(vec2 along, vec2 q) {
    float side = outlineSide(along, q);
    return side > 0.0 || (side == 0.0 && along.x > 0.0);
}

// The distance's derivatives, 0 and the distance.
vec4 outlineSample(OutlineGrid grid, vec2 p) {
    uvec4 cell = outlineCell(grid, p);
    int list = grid.first + int(cell.x), count = int(cell.y & 65535u), met = int(cell.y >> 16 & 32767u);
    vec2 known = uintBitsToFloat(cell.zw), turn = vec2(known.x, p.y);
    bool inside = (cell.y >> 31) != 0u;
    float nearest = 1e38;
    vec2 best = vec2(0.0), from = vec2(0.0);
    for (int k = 0; k < count; ++k) {
        vec4 edge = uintBitsToFloat(imageLoad(fieldVolumes, list + k));
        vec2 along = edge.zw - edge.xy, q = p - edge.xy;
        vec2 off = q - along * clamp(dot(q, along) / max(dot(along, along), 1e-30), 0.0, 1.0);
        float squared = dot(off, off);
        bool nearer = squared < nearest, meets = k < met;
        nearest = nearer ? squared : nearest;
        best = nearer ? along : best;
        from = nearer ? q : from;
        bool atTurn = outlineLeft(along, turn - edge.xy);
        bool rises = (edge.x <= turn.x) != (edge.z <= turn.x) && outlineLeft(along, known - edge.xy) != atTurn;
        bool runs = (edge.y <= p.y) != (edge.w <= p.y) && outlineLeft(along, q) != atTurn;
        inside = inside != (meets && rises != runs);
    }
    float sign_ = inside ? -1.0 : 1.0, size2 = dot(best, best), foot = dot(from, best) / max(size2, 1e-30);
    float side = outlineSide(best, from), scale = (side >= 0.0 ? sign_ : -sign_) * inversesqrt(max(size2, 1e-30));
    vec2 off = foot <= 0.0 ? from : from - best;
    float distance_ = length(off);
    // Within the edge by its line, which is exact near it.
    return foot > 0.0 && foot < 1.0 ? scale * vec4(-best.y, best.x, 0.0, side)
                                    : sign_ * vec4(distance_ > 0.0 ? off / distance_ : vec2(0.0), 0.0, distance_);
}

// Contains every value over a box of x and y.
vec2 outlineRange(OutlineGrid grid, vec2 x, vec2 y) {
    float centre = outlineSample(grid, 0.5 * vec2(x.x + x.y, y.x + y.y)).w;
    float far = max(max(-x.x, x.y), max(-y.x, y.y)) + abs(centre) + grid.halfWidth;
    float reach = 0.5 * length(vec2(x.y - x.x, y.y - y.x)) + 1e-6 * far;
    return vec2(max(centre - reach, grid.least - 1e-6 * far), centre + reach);
}
