// Volumes of the field: the float twin of graph/assets/volume.cpp, which says what a volume is and how its texels lie. The text generated for a field declares it as fieldVolumes before it includes this,
// and calls these with a volume's place and grid.

struct VolumeGrid {
    int first;  // texel
    ivec3 size;
    vec3 origin, inset;
    float cell, perCell;  // metres, and its inverse
};

struct VolumePlace {
    int texel;  // of the cell's first corner
    vec3 t;
    vec3 beyond;  // metres
};

VolumePlace volumePlace(VolumeGrid grid, vec3 p) {
    vec3 most = vec3(grid.size - 1);
    vec3 at = (p - grid.origin) * grid.perCell, within = clamp(at, vec3(0.0), most);
    ivec3 cell = min(ivec3(within), grid.size - 2);
    int texel = grid.first + (cell.z * grid.size.y + cell.y) * grid.size.x + cell.x;
    return VolumePlace(texel, within - vec3(cell), mix((at - within) * grid.cell, vec3(0.0), equal(at, within)));
}

// A sample's gradient, in units of 1 / 511.
vec3 volumeGradient(uint word) {
    int bits = int(word);
    return vec3(bits << 22 >> 22, bits << 12 >> 22, bits << 2 >> 22);
}

// What the value is beyond the grid, from the sample at its border: the gradient, and the value.
vec4 volumeBeyond(VolumeGrid grid, vec3 p, vec4 inside, vec3 beyond) {
    float distance = max(inside.w, 0.0), value = sqrt(dot(beyond, beyond) + distance * distance);
    vec3 slope = mix(distance * inside.xyz, beyond, notEqual(beyond, vec3(0.0)));
    vec3 half_ = 0.5 * grid.cell * vec3(grid.size - 1), off = p - (grid.origin + half_);
    vec3 fromBox = sign(off) * max(abs(off) - (half_ - grid.inset), 0.0);
    float toBox = length(fromBox);
    vec4 outside = toBox > value ? vec4(fromBox / toBox, toBox) : vec4(slope / max(value, 1e-30), value);
    return any(notEqual(beyond, vec3(0.0))) ? outside : inside;
}

// The gradient, and the value.
vec4 volumeTricubic(VolumeGrid grid, vec3 p) {
    VolumePlace place = volumePlace(grid, p);
    vec3 t = place.t, s = 1.0 - t;
    vec3 h1 = t * t * (3.0 - 2.0 * t), h0 = 1.0 - h1, dh = 6.0 * t * s;  // of the values; dh is h1's derivative
    const float unit = grid.cell * (1.0 / 511.0);
    vec3 ts = t * s * unit, m0 = ts * s, m1 = -ts * t;                  // of the slopes
    vec3 d0 = s * (1.0 - 3.0 * t) * unit, d1 = t * (3.0 * t - 2.0) * unit;
    float value = 0.0;
    vec3 gradient = vec3(0.0);
    for (int k = 0; k < 2; ++k)
        for (int j = 0; j < 2; ++j) {
            int texel = place.texel + (k * grid.size.y + j) * grid.size.x;
            uvec4 words = imageLoad(fieldVolumes, texel);
            float fa = uintBitsToFloat(words.x), fb = uintBitsToFloat(words.z);
            vec3 ga = volumeGradient(words.y), gb = volumeGradient(words.w);
            float hy = j == 0 ? h0.y : h1.y, hz = k == 0 ? h0.z : h1.z;
            float my = j == 0 ? m0.y : m1.y, mz = k == 0 ? m0.z : m1.z;
            float dy = j == 0 ? -dh.y : dh.y, dz = k == 0 ? -dh.z : dh.z;
            float ey = j == 0 ? d0.y : d1.y, ez = k == 0 ? d0.z : d1.z;
            // Along x: the value, what y and z have of slopes, and the derivatives of all three.
            float f = fa * h0.x + fb * h1.x + ga.x * m0.x + gb.x * m1.x;
            vec2 g = ga.yz * h0.x + gb.yz * h1.x;
            float df = (fb - fa) * dh.x + ga.x * d0.x + gb.x * d1.x;
            vec2 dg = (gb.yz - ga.yz) * dh.x;
            value += f * hy * hz + g.x * my * hz + g.y * hy * mz;
            gradient.x += df * hy * hz + dg.x * my * hz + dg.y * hy * mz;
            gradient.y += f * dy * hz + g.x * ey * hz + g.y * dy * mz;
            gradient.z += f * hy * dz + g.x * my * dz + g.y * hy * ez;
        }
    return volumeBeyond(grid, p, vec4(gradient * grid.perCell, value), place.beyond);
}

vec4 volumeLinear(float f[8], vec3 t, float cell) {
    vec4 x = mix(vec4(f[0], f[2], f[4], f[6]), vec4(f[1], f[3], f[5], f[7]), t.x);
    vec4 dx = vec4(f[1], f[3], f[5], f[7]) - vec4(f[0], f[2], f[4], f[6]);
    vec2 y = mix(x.xz, x.yw, t.y), dxy = mix(dx.xz, dx.yw, t.y), dy = x.yw - x.xz;
    return vec4(vec3(mix(dxy.x, dxy.y, t.z), mix(dy.x, dy.y, t.z), y.y - y.x) / cell, mix(y.x, y.y, t.z));
}

vec4 volumeTrilinear(VolumeGrid grid, vec3 p) {
    VolumePlace place = volumePlace(grid, p);
    float f[8];
    for (int i = 0; i < 8; i += 2) {
        uvec4 words = imageLoad(fieldVolumes, place.texel + ((i >> 2) * grid.size.y + (i >> 1 & 1)) * grid.size.x);
        f[i] = uintBitsToFloat(words.x), f[i + 1] = uintBitsToFloat(words.z);
    }
    return volumeBeyond(grid, p, volumeLinear(f, place.t, grid.cell), place.beyond);
}

vec4 volumeColor(VolumeGrid grid, vec3 p, int channel) {
    VolumePlace place = volumePlace(grid, p);
    int samples = grid.size.x * grid.size.y * grid.size.z;
    float f[8];
    for (int i = 0; i < 8; ++i) {
        int at = place.texel - grid.first + ((i >> 2) * grid.size.y + (i >> 1 & 1)) * grid.size.x + (i & 1);
        uint word = imageLoad(fieldVolumes, grid.first + samples + at / 4)[at & 3];
        float c = float(word >> uint(8 * channel) & 255u) * (1.0 / 255.0);
        f[i] = c <= 0.04045 ? c * (1.0 / 12.92) : pow((c + 0.055) * (1.0 / 1.055), 2.4);
    }
    vec4 result = volumeLinear(f, place.t, grid.cell);
    return vec4(mix(result.xyz, vec3(0.0), notEqual(place.beyond, vec3(0.0))), result.w);
}

// What the distance at a place of the grid can be by the samples around it.
vec2 volumeDistance(VolumeGrid grid, VolumePlace place) {
    vec2 distance = vec2(-1e30, 1e30);
    for (int i = 0; i < 8; i += 2) {
        ivec3 corner = ivec3(0, i >> 1 & 1, i >> 2);
        uvec4 words = imageLoad(fieldVolumes, place.texel + (corner.z * grid.size.y + corner.y) * grid.size.x);
        vec2 f = uintBitsToFloat(words.xz);
        vec3 off = place.t - vec3(corner);
        vec2 far = grid.cell * vec2(length(off), length(off - vec3(1.0, 0.0, 0.0)));
        distance = vec2(max(distance.x, max(f.x - far.x, f.y - far.y)), min(distance.y, min(f.x + far.x, f.y + far.y)));
    }
    return distance;
}

// Contains every value of a distance over a box, whose value at the centre is given; `spread` has VolumeLayer's slope, shift,
// scatter and rise, and `range` the values within the grid.
vec2 volumeRange(VolumeGrid grid, float centre, vec2 x, vec2 y, vec2 z, vec4 spread, vec2 range) {
    vec3 lo = vec3(x.x, y.x, z.x), hi = vec3(x.y, y.y, z.y);
    vec3 least = grid.origin, most = grid.origin + grid.cell * vec3(grid.size - 1);
    bool within = all(greaterThanEqual(lo, least)) && all(lessThanEqual(hi, most));
    vec3 far = max(abs(lo), abs(hi));
    float margin = 4e-7 * (max(far.x, max(far.y, far.z)) + grid.cell * float(grid.size.x + grid.size.y + grid.size.z));
    float radius = 0.5 * length(hi - lo) + margin;
    float off = length(vec2(spread.y, spread.z)) + spread.w, reach = length(vec2(radius + spread.y, spread.z)) + spread.w;
    VolumePlace place = volumePlace(grid, 0.5 * (lo + hi));
    bool beyond = any(notEqual(place.beyond, vec3(0.0)));
    vec2 distance = beyond ? centre + vec2(-off, off) : volumeDistance(grid, place);
    distance.y = within ? distance.y : max(distance.y, 0.0);
    vec2 all_ = vec2(max(distance.x - reach, centre - spread.x * radius), min(distance.y + reach, centre + spread.x * radius));
    return clamp(all_ + vec2(-margin, margin), vec2(range.x - margin), vec2(within ? range.y + margin : 1e30));
}

// The least and the greatest distance among the samples from `lo` to `hi`, or some more: by the samples themselves, or by the blocks
// that follow those of particles (graph/assets/volume.h), the smallest of which at most three along each axis are needed.
vec2 volumeBlocks(VolumeGrid grid, ivec3 lo, ivec3 hi) {
    ivec3 many = grid.size, extent = hi - lo;
    int longest = max(extent.x, max(extent.y, extent.z)), shift = 0, first = 0;
    while (longest > 2 << shift && (shift == 0 || any(greaterThan(many, ivec3(2))))) {
        first += many.x * many.y * many.z * (shift == 0 ? 2 : 1);
        many = shift == 0 ? (many + 3) / 4 : (many + 1) / 2;
        shift += shift == 0 ? 2 : 1;
    }
    ivec3 least = lo >> shift, count = clamp((hi >> shift) - least + 1, 1, 4);
    vec2 range = vec2(1e30, -1e30);
    int all_ = count.x * count.y * count.z;
    for (int i = 0; i < 64; ++i) {
        if (i >= all_) break;
        ivec3 block = min(least + ivec3(i % count.x, i / count.x % count.y, i / (count.x * count.y)), many - 1);
        int index = first + ((block.z * many.y + block.y) * many.x + block.x) * (shift == 0 ? 2 : 1);
        uvec4 words = imageLoad(fieldVolumes, grid.first + index / 2);
        vec2 own = uintBitsToFloat(shift == 0 ? words.xx : (index & 1) == 0 ? words.xy : words.zw);
        range = vec2(min(range.x, own.x), max(range.y, own.y));
    }
    return range;
}

// Contains every value of the volume of particles over a box, whose value at the centre is given; `rise` is what values are beyond
// their samples. As particleRange() of graph/assets/volume.cpp.
vec2 volumeBlockRange(VolumeGrid grid, float centre, vec2 x, vec2 y, vec2 z, float rise) {
    vec3 lo = vec3(x.x, y.x, z.x), hi = vec3(x.y, y.y, z.y);
    vec3 least = grid.origin, most = grid.origin + grid.cell * vec3(grid.size - 1);
    bool within = all(greaterThanEqual(lo, least)) && all(lessThanEqual(hi, most));
    vec3 far = max(abs(lo), abs(hi));
    float margin = 4e-7 * (max(far.x, max(far.y, far.z)) + grid.cell * float(grid.size.x + grid.size.y + grid.size.z));
    vec3 last = vec3(grid.size - 2);
    ivec3 first = ivec3(clamp((lo - margin - least) * grid.perCell, vec3(0.0), last));
    ivec3 end = ivec3(clamp((hi + margin - least) * grid.perCell, vec3(0.0), last)) + 1;
    vec2 range = volumeBlocks(grid, first, end);
    float off = sqrt(3.0) * (1.5 * (range.y - range.x) * grid.perCell + 2.5) * (0.5 * length(hi - lo) + margin);
    range += vec2(-rise - margin, rise + margin);
    if (within) range = vec2(max(range.x, centre - off), min(range.y, centre + off));
    float apart = length(max(max(least - hi, lo - most), 0.0)) - 3.0 * margin;
    return vec2(apart > 0.0 ? max(range.x, apart) : range.x, within ? range.y : 1e30);
}
