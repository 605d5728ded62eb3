// Lattice noises: the float twins of graph/ir/noise.cpp, which says where they come from. Each *Gradient function
// returns (d/dx, d/dy, d/dz, value).

uvec3 latticeHash(ivec3 lattice, float seed) {
    uvec3 v = uvec3(lattice);
    v.x += uint(int(floor(seed))) * 0x9E3779B9u;
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.z, v.y += v.z * v.x, v.z += v.x * v.y;
    v ^= v >> 16u;
    v.x += v.y * v.z, v.y += v.z * v.x, v.z += v.x * v.y;
    return v;
}

vec3 unitHash(uvec3 bits) { return vec3(bits >> 8u) * (1.0 / 16777216.0); }

vec3 edgeDirection(uint bits) {
    uint axis = (bits >> 16u) % 3u;
    float u = (bits & 1u) != 0u ? 1.0 : -1.0, v = (bits & 2u) != 0u ? 1.0 : -1.0;
    return axis == 0u ? vec3(0.0, u, v) : axis == 1u ? vec3(u, 0.0, v) : vec3(u, v, 0.0);
}

vec4 gradientNoiseGradient(vec3 p, float seed) {
    vec3 cell = floor(p), f = p - cell;
    vec3 fade = f * f * f * (f * (f * 6.0 - 15.0) + 10.0), slope = 30.0 * f * f * (f * (f - 2.0) + 1.0);
    vec4 sum = vec4(0.0);
    int corner = 0;
    do {
        vec3 o = vec3(corner & 1, (corner >> 1) & 1, corner >> 2);
        vec3 g = edgeDirection(latticeHash(ivec3(cell + o), seed).x);
        float ramp = dot(g, f - o);
        vec3 w = mix(1.0 - fade, fade, o), dw = mix(-slope, slope, o);
        float weight = w.x * w.y * w.z;
        sum += vec4(weight * g + vec3(dw.x * w.y * w.z, w.x * dw.y * w.z, w.x * w.y * dw.z) * ramp, weight * ramp);
    } while (++corner < 8);
    return sum;
}

float gradientNoise(vec3 p, float seed) {
    vec3 cell = floor(p), f = p - cell;
    vec3 fade = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    float sum = 0.0;
    int corner = 0;
    do {
        vec3 o = vec3(corner & 1, (corner >> 1) & 1, corner >> 2);
        vec3 w = mix(1.0 - fade, fade, o);
        sum += w.x * w.y * w.z * dot(edgeDirection(latticeHash(ivec3(cell + o), seed).x), f - o);
    } while (++corner < 8);
    return sum;
}

vec4 simplexNoiseGradient(vec3 p, float seed) {
    vec3 base = floor(p + dot(p, vec3(1.0 / 3.0)));
    vec3 d0 = p - base + dot(base, vec3(1.0 / 6.0));
    // x >= y, y >= z, x >= z: an order even where all three are equal.
    vec3 g = vec3(greaterThanEqual(d0.xyx, d0.yzz)), l = 1.0 - g;
    vec3 first = vec3(g.x * g.z, l.x * g.y, l.y * l.z), second = vec3(max(g.x, g.z), max(l.x, g.y), max(l.y, l.z));
    vec4 sum = vec4(0.0);
    int corner = 0;
    do {
        vec3 o = corner == 0 ? vec3(0.0) : corner == 1 ? first : corner == 2 ? second : vec3(1.0);
        vec3 d = d0 - o + float(corner) / 6.0;
        float t = max(0.5 - dot(d, d), 0.0);
        vec3 direction = edgeDirection(latticeHash(ivec3(base + o), seed).x);
        float ramp = dot(direction, d), cube = t * t * t;
        sum += 72.0 * vec4(cube * t * direction - 8.0 * cube * ramp * d, cube * t * ramp);
    } while (++corner < 4);
    sum.w = clamp(sum.w, -1.1, 1.1);  // where coordinates are too large for a place within their cell
    return sum;
}
float simplexNoise(vec3 p, float seed) { return simplexNoiseGradient(p, seed).w; }

// The nearer of `nearest` (its offset and squared distance) and the point of the cell with this least corner.
vec4 worleyNearer(vec4 nearest, vec3 p, vec3 corner, float seed) {
    vec3 d = p - corner - unitHash(latticeHash(ivec3(corner), seed));
    float squared = dot(d, d);
    return squared < nearest.w ? vec4(d, squared) : nearest;
}

// The 27 cells around, then, where the nearest point found lies farther than their border, the 125: the point of the
// own cell is at most sqrt(3) away, and cells three off are 2 away.
vec4 worleyNoiseGradient(vec3 p, float seed) {
    vec3 cell = floor(p);
    vec4 nearest = vec4(0.0, 0.0, 0.0, 1e30);
    int c = 0;
    do nearest = worleyNearer(nearest, p, cell + vec3(c % 3, (c / 3) % 3, c / 9) - 1.0, seed);
    while (++c < 27);
    vec3 side = min(p - cell, 1.0 - (p - cell));
    float clear = 1.0 + min(side.x, min(side.y, side.z));
    c = nearest.w > clear * clear ? 0 : 125;
    while (c < 125) {
        nearest = worleyNearer(nearest, p, cell + vec3(c % 5, (c / 5) % 5, c / 25) - 2.0, seed);
        ++c;
    }
    float value = sqrt(nearest.w);
    return vec4(value > 0.0 ? nearest.xyz / value : vec3(0.0), value);
}
float worleyNoise(vec3 p, float seed) { return worleyNoiseGradient(p, seed).w; }

// From p to the point of the cell `step` cells off.
vec3 wallPoint(vec3 p, vec3 cell, vec3 step, float seed) {
    return (cell - p) + step + 0.1 + 0.8 * unitHash(latticeHash(ivec3(cell + step), seed));
}
// The 27 cells around; then, where what lies beyond may matter, the 125.
vec4 cellWallGradient(vec3 p, float seed) {
    vec3 cell = floor(p), side = min(p - cell, 1.0 - (p - cell));
    float clear = 1.1 + min(side.x, min(side.y, side.z));
    vec4 found;
    int width = 3;
    do {
        vec4 nearest = vec4(0.0, 0.0, 0.0, 1e30);
        int cells = width * width * width, c = 0;
        float reach = float(width / 2);
        do {
            vec3 off = wallPoint(p, cell, vec3(c % width, (c / width) % width, c / (width * width)) - reach, seed);
            float squared = dot(off, off);
            nearest = squared < nearest.w ? vec4(off, squared) : nearest;
        } while (++c < cells);
        found = vec4(0.0, 0.0, 0.0, 0.15);
        c = 0;
        do {
            vec3 off = wallPoint(p, cell, vec3(c % width, (c / width) % width, c / (width * width)) - reach, seed);
            vec3 way = off - nearest.xyz;
            float size = length(way), wall = (dot(off, off) - nearest.w) / (2.0 * size);
            if (size > 0.0 && wall < found.w) found = vec4(-way / size, wall);
        } while (++c < cells);
        float distance = sqrt(nearest.w);
        width = width == 5 || (distance <= clear && (clear - distance) * 0.5 >= found.w) ? 7 : 5;
    } while (width == 5);
    return found;
}

float cellHash(vec3 p, float seed) { return unitHash(latticeHash(ivec3(floor(p)), seed)).x; }

// Interval of cellHash: one value if the box stays within a cell.
vec2 iCellHash(vec2 x, vec2 y, vec2 z, vec2 seed) {
    bool single = floor(x.x) == floor(x.y) && floor(y.x) == floor(y.y) && floor(z.x) == floor(z.y) && seed.x == seed.y;
    return single ? vec2(cellHash(vec3(x.x, y.x, z.x), seed.x)) : vec2(0.0, 1.0);
}
