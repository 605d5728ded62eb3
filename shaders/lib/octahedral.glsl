// Unit vectors in 32 bits: the octahedron unfolded into a square (Meyer et al. 2010), two signed 16-bit fractions.

uint packOctahedral(vec3 n) {
    n /= abs(n.x) + abs(n.y) + abs(n.z);
    vec2 folded = (1.0 - abs(n.yx)) * vec2(n.x < 0.0 ? -1.0 : 1.0, n.y < 0.0 ? -1.0 : 1.0);
    return packSnorm2x16(n.z < 0.0 ? folded : n.xy);
}

vec3 unpackOctahedral(uint word) {
    vec2 e = unpackSnorm2x16(word);
    vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
    float t = max(-n.z, 0.0);
    n.xy += vec2(n.x < 0.0 ? t : -t, n.y < 0.0 ? t : -t);
    return normalize(n);
}
