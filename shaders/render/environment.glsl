// An environment map (graph/assets/environment.h): the sky as a picture has it, in levels from sharp to what rough mirrors show of
// it, and behind them what a matt surface gets; and how often to look where. After render.h; `frame` is the RenderFrame.
layout(binding = 25, scalar) readonly buffer SkyWords { uint skyWords[]; };

// Where a direction lies on the map, to the right and down, 0 to 1; and back.
vec2 onMap(vec3 d) { return vec2(fract(1.0 + frame.skyTurn - atan(d.x, d.z) / 6.2831853), acos(clamp(d.y, -1.0, 1.0)) / 3.14159265); }
vec3 fromMap(vec2 at) {
    float around = 6.2831853 * (1.0 + frame.skyTurn - at.x), down = 3.14159265 * at.y;
    return vec3(sin(down) * sin(around), cos(down), sin(down) * cos(around));
}

vec3 skyTexel(SkyLevel level, ivec2 at) {
    ivec2 size = ivec2(level.width, level.height);
    at.x += at.x < 0 ? size.x : at.x >= size.x ? -size.x : 0;
    at = clamp(at, ivec2(0), size - 1);
    uint word = skyWords[level.start + uint(at.y * size.x + at.x)];  // three numbers of 9 bits with one exponent
    return vec3(word & 511, word >> 9 & 511, word >> 18 & 511) * exp2(float(word >> 27) - 24.0);
}

vec3 skyAt(uint i, vec3 d) {
    SkyLevel level = frame.sky[i];
    vec2 at = onMap(d) * vec2(level.width, level.height) - 0.5, whole = floor(at), part = at - whole;
    ivec2 first = ivec2(whole);
    vec3 above = mix(skyTexel(level, first), skyTexel(level, first + ivec2(1, 0)), part.x);
    vec3 below = mix(skyTexel(level, first + ivec2(0, 1)), skyTexel(level, first + ivec2(1, 1)), part.x);
    return frame.skyScale * mix(above, below, part.y);
}

// What a mirror of this roughness sees in this direction.
vec3 environment(vec3 d, float roughness) {
    uint i = 0, levels = unfolded(frame.skyLevels);
    do {
    } while (frame.sky[i + 1].roughness < roughness && ++i + 2 < levels);
    float low = frame.sky[i].roughness, high = frame.sky[i + 1].roughness;
    return mix(skyAt(i, d), skyAt(i + 1, d), clamp((roughness - low) / (high - low), 0.0, 1.0));
}

// The first of ascending numbers between 0 and 1 that is above u.
uint firstAbove(uint start, uint count, float u) {
    uint low = 0, high = count - 1;
    do {
        uint middle = (low + high) / 2;
        bool above = uintBitsToFloat(skyWords[start + middle]) > u;
        high = above ? middle : high;
        low = above ? low : min(middle + 1, high);
    } while (low < high);
    return low;
}

// From where to where one of them goes.
vec2 spanOf(uint start, uint i) {
    return vec2(i > 0 ? uintBitsToFloat(skyWords[start + i - 1]) : 0.0, uintBitsToFloat(skyWords[start + i]));
}

// How often skyDirection() gives a direction, 1 / steradian.
float skyDensity(vec3 d) {
    vec2 cells = vec2(frame.skyColumns, frame.skyRows);
    uvec2 cell = min(uvec2(onMap(d) * cells), uvec2(cells) - 1);
    vec2 row = spanOf(frame.skyChances, cell.y), column = spanOf(frame.skyChances + frame.skyRows + cell.y * frame.skyColumns, cell.x);
    float across = sqrt(max(1.0 - d.y * d.y, 1e-12));
    return (row.y - row.x) * (column.y - column.x) * cells.x * cells.y / (2.0 * 3.14159265 * 3.14159265 * across);
}

// A direction, the more often the brighter the map is there.
vec3 skyDirection(vec2 u) {
    uint y = firstAbove(frame.skyChances, frame.skyRows, u.y), columns = frame.skyChances + frame.skyRows + y * frame.skyColumns;
    uint x = firstAbove(columns, frame.skyColumns, u.x);
    vec2 row = spanOf(frame.skyChances, y), column = spanOf(columns, x);
    vec2 part = clamp((u - vec2(column.x, row.x)) / max(vec2(column.y - column.x, row.y - row.x), 1e-30), 0.0, 1.0);
    return fromMap((vec2(x, y) + part) / vec2(frame.skyColumns, frame.skyRows));
}
