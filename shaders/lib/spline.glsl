// Splines of the field: the float twin of graph/curves/spline_table.cpp, whose header says how their texels lie and
// space_arc.h what an arc is. The text generated for a field declares their buffer as fieldVolumes before it includes this, and calls these
// with a spline's place there.

struct SplineGrid {
    int first, runs, arcs;  // texels: of the cells, of the runs, of the arcs
    ivec3 cells;
    vec3 centre, half_;
    float radius;  // of the ball where its share is 1; 0: none
    bool tapered, closed;
    float least, length_;
    vec3 share;  // the least and the most, and the greatest slope
};

struct SplineFoot {
    int arc;        // its first texel
    bool beyond;    // an end is the nearest
    float side;     // of the arc's middle
    vec3 q;         // from the arc's middle: along, towards, across
    float s;        // metres from the middle, if the ball changes
    float distance_;
};

struct SplineCell {
    uvec4 words;
    vec3 lo, hi;
};

SplineCell splineCell(SplineGrid grid, vec3 p) {
    vec3 away = p - grid.centre, half_ = grid.half_, shrunk = half_;
    ivec3 cells = grid.cells;
    int before = 0;
    if (any(greaterThanEqual(abs(away), half_))) {
        float most = max(max(half_.x, half_.y), half_.z);
        float far = max(max(max(abs(away.x), abs(away.y)), abs(away.z)) / most, 1e-9);
        int level = 0;
        frexp(far, level);
        level = clamp(level, 1, SPLINE_LEVELS - 1);
        half_ = vec3(most * exp2(float(level)));
        shrunk = max(half_, vec3(most * far));
        const int near = SPLINE_NEAR_CELLS * SPLINE_NEAR_CELLS * SPLINE_NEAR_CELLS, far_ = SPLINE_FAR_CELLS * SPLINE_FAR_CELLS * SPLINE_FAR_CELLS;
        cells = ivec3(level <= SPLINE_NEAR_LEVELS ? SPLINE_NEAR_CELLS : SPLINE_FAR_CELLS);
        before = grid.cells.x * grid.cells.y * grid.cells.z + min(level - 1, SPLINE_NEAR_LEVELS) * near +
                 max(level - 1 - SPLINE_NEAR_LEVELS, 0) * far_;
    }
    ivec3 at = ivec3(clamp((away / shrunk + 1.0) * 0.5 * vec3(cells), vec3(0.0), vec3(cells) - 0.5));
    vec3 size = 2.0 * half_ / vec3(cells), lo = grid.centre - half_ + vec3(at) * size;
    return SplineCell(imageLoad(fieldVolumes, grid.first + before + (at.z * cells.y + at.y) * cells.x + at.x), lo, lo + size);
}

// By how far the ball that changes along an arc is from a place, and where it is then.
vec2 splineTapered(vec3 q, float k, vec2 end, vec4 ball, float c, float h, float off2) {
    float slope = ball.w, half_ = ball.x;
    float aside = q.y - end.y, flat2 = aside * aside + q.z * q.z;
    vec2 ahead = vec2(half_, sqrt((q.x - end.x) * (q.x - end.x) + flat2) - ball.z - slope * half_),
         behind = vec2(-half_, sqrt((q.x + end.x) * (q.x + end.x) + flat2) - ball.z + slope * half_);
    vec2 best = behind.y < ahead.y ? behind : ahead;
    float b = h * (h - slope * slope), root = b * b - k * k * h * h * slope * slope * off2;
    if (b > 0.0 && root >= 0.0) {
        float at = k * half_ < 1e-4 ? q.x / h : atan(k * q.x, c) / k;
        float t = 2.0 * slope * slope * off2 / (b + sqrt(root)), chord = sqrt(t), turned = min(0.5 * k * chord, 1.0);
        float u = turned < 1e-4 ? chord : 2.0 / k * asin(turned), s = at + (slope < 0.0 ? -u : u);
        float far = sqrt(off2 + h * t) - ball.z - slope * s;
        best = abs(s) <= half_ && far < best.y ? vec2(s, far) : best;
    }
    return best;
}

// One arc, if it is nearer than what was found, of what does not change by the distance's square; and on which side of its
// middle its nearest place is.
float splineTake(SplineGrid grid, int number, vec3 p, inout SplineFoot best) {
    int arc = grid.arcs + SPLINE_ARC_TEXELS * number;
    vec4 middle = uintBitsToFloat(imageLoad(fieldVolumes, arc)), along = uintBitsToFloat(imageLoad(fieldVolumes, arc + 1)),
         towards = uintBitsToFloat(imageLoad(fieldVolumes, arc + 2));
    vec3 off = p - middle.xyz, q = vec3(dot(off, along.xyz), dot(off, towards.xyz), dot(off, cross(along.xyz, towards.xyz)));
    float bend = middle.w, c = 1.0 - bend * q.y, h = length(vec2(c, bend * q.x));
    float beside = (bend * dot(q.xy, q.xy) - 2.0 * q.y) / (1.0 + h), off2 = beside * beside + q.z * q.z;
    float side = q.x < 0.0 ? -1.0 : 1.0, s = 0.0, far;
    bool beyond;
    if (grid.tapered) {
        vec4 ball = uintBitsToFloat(imageLoad(fieldVolumes, arc + 3));
        ball.zw *= grid.radius;
        vec2 found = splineTapered(q, bend, vec2(along.w, towards.w), ball, c, h, off2);
        s = found.x;
        far = found.y;
        beyond = abs(s) >= ball.x;
    } else {
        beyond = abs(q.x) * (1.0 - bend * towards.w) > c * along.w;
        vec3 toEnd = vec3(q.x - side * along.w, q.y - towards.w, q.z);
        far = beyond ? dot(toEnd, toEnd) : off2;
    }
    if (far < best.distance_) best = SplineFoot(arc, beyond, side, q, s, far);
    return s;
}

SplineFoot splineNearest(SplineGrid grid, uvec4 cell, vec3 p) {
    SplineFoot best = SplineFoot(grid.arcs, false, 1.0, vec3(0.0), 0.0, 1e38);
    int number = int(cell.x), end = number + int(cell.y & 0x7FFFFFFFu);
    do {  // each cell has a run; software devices go once more through the body of a `for` than it counts
        uvec4 four = imageLoad(fieldVolumes, grid.runs + number / 4);
        uvec2 two = (number & 2) != 0 ? four.zw : four.xy;
        uint run = (number & 1) != 0 ? two.y : two.x;
        int first = int(run & 0xFFFFu), last = first + int(run >> 16) - 1, lo = first, hi = last;
        do {  // by halves
            int mid = (lo + hi + 1) / 2, arc = grid.arcs + SPLINE_ARC_TEXELS * mid;
            vec4 begin = uintBitsToFloat(imageLoad(fieldVolumes, arc + 5));
            vec3 leads = uintBitsToFloat(imageLoad(fieldVolumes, arc + 6)).xyz, off = p - begin.xyz;
            bool beyond = dot(off, leads) + (grid.tapered ? grid.radius * begin.w * length(off) : 0.0) >= 0.0;
            lo = beyond ? mid : lo;
            hi = beyond ? hi : max(mid - 1, lo);
        } while (lo < hi);
        float s = splineTake(grid, lo, p, best);
        if (grid.tapered) splineTake(grid, clamp(lo + (s < 0.0 ? -1 : 1), first, last), p, best);
        ++number;
    } while (number < end);
    if (!grid.tapered) best.distance_ = sqrt(best.distance_) - grid.radius * grid.share.x;
    return best;
}

// The distance's derivatives and the distance.
vec4 splineDistance(SplineGrid grid, vec3 p) {
    SplineFoot foot = splineNearest(grid, splineCell(grid, p).words, p);
    vec4 middle = uintBitsToFloat(imageLoad(fieldVolumes, foot.arc)), along = uintBitsToFloat(imageLoad(fieldVolumes, foot.arc + 1)),
         towards = uintBitsToFloat(imageLoad(fieldVolumes, foot.arc + 2));
    vec3 q = foot.q, off;
    float k = middle.w;
    if (grid.tapered) {
        float angle = k * foot.s, halved = 0.5 * angle, share_ = abs(halved) < 1e-4 ? 1.0 : sin(halved) / halved;
        off = q - vec3(foot.s * share_ * cos(halved), foot.s * share_ * sin(halved), 0.0);
    } else if (foot.beyond) {
        off = vec3(q.x - foot.side * along.w, q.y - towards.w, q.z);
    } else {
        vec2 c = vec2(k * q.x, 1.0 - k * q.y);
        float h = length(c), beside = (k * dot(q.xy, q.xy) - 2.0 * q.y) / (1.0 + h);
        off = vec3(vec2(c.x, -c.y) * (beside / max(h, 1e-30)), q.z);
    }
    vec3 world = off.x * along.xyz + off.y * towards.xyz + off.z * cross(along.xyz, towards.xyz);
    float size = length(world);
    return vec4(size > 0.0 ? world / size : vec3(0.0), foot.distance_);
}

// Across, up, along and share, with the directions in which they grow.
struct SplineBeside {
    vec4 across, up, along, share;
    float distance_;
};
SplineBeside splineBeside(SplineGrid grid, uvec4 cell, vec3 p) {
    SplineFoot foot = splineNearest(grid, cell, p);
    vec4 middle = uintBitsToFloat(imageLoad(fieldVolumes, foot.arc)), ahead = uintBitsToFloat(imageLoad(fieldVolumes, foot.arc + 1)),
         aside = uintBitsToFloat(imageLoad(fieldVolumes, foot.arc + 2)), run = uintBitsToFloat(imageLoad(fieldVolumes, foot.arc + 3));
    uvec4 last = imageLoad(fieldVolumes, foot.arc + 4);
    vec2 turn = uintBitsToFloat(last.xy);
    vec3 binormal = cross(ahead.xyz, aside.xyz), q = foot.q;
    float k = middle.w, s, t, z = q.z, over = 0.0;
    vec3 leads, towards, grows = vec3(0.0);
    if (foot.beyond) {
        float sine = k * ahead.w * foot.side, cosine = 1.0 - k * aside.w;
        vec2 off = vec2(q.x - foot.side * ahead.w, q.y - aside.w);
        leads = cosine * ahead.xyz + sine * aside.xyz;
        towards = cosine * aside.xyz - sine * ahead.xyz;
        s = foot.side * run.x;
        t = off.y * cosine - off.x * sine;
        over = off.x * cosine + off.y * sine;
        bool open = (last.z & (foot.side < 0.0 ? 1u : 2u)) != 0u;
        if (open) {
            grows = leads;
        } else {
            float flat_ = length(vec2(t, z)), size = length(vec3(t, z, over));
            if (flat_ > 0.0) {
                t *= size / flat_;
                z *= size / flat_;
            } else {
                t = size;
            }
            over = 0.0;
        }
    } else {
        vec2 c = vec2(k * q.x, 1.0 - k * q.y);
        float h = length(c);
        c /= max(h, 1e-30);
        leads = c.y * ahead.xyz + c.x * aside.xyz;
        towards = c.y * aside.xyz - c.x * ahead.xyz;
        s = k * run.x < 1e-4 ? q.x / max(h, 1e-30) : atan(c.x, c.y) / k;
        t = -(k * dot(q.xy, q.xy) - 2.0 * q.y) / (1.0 + h);
        grows = leads / max(h, 1e-9);
    }
    float angle = turn.x + turn.y * s, cosine = cos(angle), sine = sin(angle);
    float across = cosine * t + sine * z, up = cosine * z - sine * t;
    vec3 turns = foot.beyond ? vec3(0.0) : turn.y * grows;
    return SplineBeside(vec4(cosine * towards + sine * binormal + up * turns, across),
                        vec4(cosine * binormal - sine * towards - across * turns, up), vec4(grows, run.y + run.x + s + over),
                        vec4(foot.beyond ? vec3(0.0) : run.w * grows, run.z + run.w * s), foot.distance_);
}

float splineFar(SplineGrid grid, vec2 x, vec2 y, vec2 z) {
    return max(-x.x, x.y) + max(-y.x, y.y) + max(-z.x, z.y) + length(grid.centre) + max(max(grid.half_.x, grid.half_.y), grid.half_.z);
}

// Contains every distance over a box.
vec2 splineDistanceRange(SplineGrid grid, vec2 x, vec2 y, vec2 z) {
    vec3 middle = 0.5 * vec3(x.x + x.y, y.x + y.y, z.x + z.y);
    float centre = splineNearest(grid, splineCell(grid, middle).words, middle).distance_;
    float rounding = 1e-6 * splineFar(grid, x, y, z), reach = 0.5 * length(vec3(x.y - x.x, y.y - y.x, z.y - z.x)) + rounding;
    return vec2(max(centre - reach, grid.least - rounding), centre + reach);
}

vec2 splineAround(bool plain, float value, float by, vec2 all_) {
    return plain ? vec2(max(value - by, all_.x), min(value + by, all_.y)) : all_;
}

// Contains every value of a coordinate over a box; which: 1 across, 2 up, 3 along, 4 share.
vec2 splineRange(SplineGrid grid, int which, vec2 x, vec2 y, vec2 z) {
    vec3 middle = 0.5 * vec3(x.x + x.y, y.x + y.y, z.x + z.y);
    SplineCell cell = splineCell(grid, middle);
    SplineBeside at = splineBeside(grid, cell.words, middle);
    float rounding = 4e-6 * splineFar(grid, x, y, z), reach = 0.5 * length(vec3(x.y - x.x, y.y - y.x, z.y - z.x)) + rounding;
    float most = at.distance_ + reach, bend = uintBitsToFloat(cell.words.z), turn = uintBitsToFloat(cell.words.w);
    bool plain = (cell.words.y >> 31) != 0u && bend * most < 0.9 && all(greaterThanEqual(vec3(x.x, y.x, z.x), cell.lo)) &&
                 all(lessThanEqual(vec3(x.y, y.y, z.y), cell.hi));
    float stretch = plain ? reach / (1.0 - bend * most) : 0.0;
    if (which <= 2) return splineAround(plain, which == 1 ? at.across.w : at.up.w, reach + most * turn * stretch, vec2(-most, most));
    float over = grid.closed ? rounding : most;
    if (which == 3) return splineAround(plain, at.along.w, stretch + rounding, vec2(-over, grid.length_ + over));
    return splineAround(plain, at.share.w, grid.share.z * stretch + 1e-5 * grid.share.y, vec2(0.99999 * grid.share.x, 1.00001 * grid.share.y));
}
