// A pixel of the G-buffer, in tiles with anything near the solid, in four words: depth (0: nothing is there), octahedral normal, base colour with metallic, emission
// with roughness. Colours are stored as square roots, 8 bits a channel; emission up to kMostEmission. After field.glsl and
// lib/octahedral.glsl.

const float kMostEmission = 64.0;
const float kLeastRoughness = 0.08;

struct Surface {
    float depth;
    vec3 n;
    vec3 base;
    float metallic;
    vec3 emission;
    float roughness;
    bool ground;  // rather than the solid
};

#ifdef FIELD_MATERIAL
uvec4 packSurface(float depth, vec3 n, FieldMaterial material) {
    vec4 a = vec4(sqrt(clamp(material.baseColor, 0.0, 1.0)), clamp(material.metallic, 0.0, 1.0));
    vec4 b = vec4(sqrt(clamp(material.emission / kMostEmission, 0.0, 1.0)), clamp(material.roughness, kLeastRoughness, 1.0));
    return uvec4(floatBitsToUint(depth), packOctahedral(n), packUnorm4x8(a), packUnorm4x8(b));
}
#endif

// The ground is rough and white. A roughness of zero, which no solid has, marks the ground.
uvec4 packGround(float depth) { return uvec4(floatBitsToUint(depth), packOctahedral(vec3(0, 1, 0)), 0xffffff, 0); }

Surface groundSurface(float depth) {
    return Surface(depth, vec3(0, 1, 0), vec3(1.0), 0.0, vec3(0.0), 1.0, true);
}

Surface unpackSurface(uvec4 words) {
    vec4 a = unpackUnorm4x8(words.z), b = unpackUnorm4x8(words.w);
    return Surface(uintBitsToFloat(words.x), unpackOctahedral(words.y), a.rgb * a.rgb, a.w, b.rgb * b.rgb * kMostEmission, b.w,
                   words.w >> 24 == 0);
}
