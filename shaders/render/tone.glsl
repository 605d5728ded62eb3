// From linear light to what a display shows. `frame` is the RenderFrame.
// Tone map: ACES, as fitted by Narkowicz ("ACES filmic tone mapping curve", 2015); or Khronos' PBR Neutral (its specification,
// 2024), which takes 4 % off, for a highlight's, leaves colours below 0.8 as they are, and lets brighter ones bleach as a whole:
// if NEUTRAL is defined.

vec3 toneMap(vec3 x) {
    x = min(x * frame.exposure, 1e4);  // far beyond white, and its square is finite
#ifdef NEUTRAL
    const float kHighlight = 0.04, kKept = 0.8 - kHighlight, kLeft = 1.0 - kKept, kBleaching = 0.15;
    float least = min(x.r, min(x.g, x.b));
    x -= least < 2.0 * kHighlight ? least - least * least / (4.0 * kHighlight) : kHighlight;
    float most = max(x.r, max(x.g, x.b));
    float pressed = most < kKept ? most : 1.0 - kLeft * kLeft / (most + kLeft - kKept);
    float bleached = 1.0 - 1.0 / (kBleaching * (most - pressed) + 1.0);
    return mix(x * (pressed / max(most, 1e-6)), vec3(pressed), bleached);
#endif
    return clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
}

// sRGB in four bytes, red in the lowest, and alpha in the highest.
uint displayed(vec3 linear, float alpha, uvec2 pixel) {
    // sRGB's curve, fitted to 0.16 of a step of eight bits.
    vec3 root = sqrt(linear), encoded = (root * (root * 1.66847 + 1.41553) - 0.03867) / (root * 2.04346 + 1.0);
    encoded = mix(12.92 * linear, encoded, greaterThan(linear, vec3(0.0031308)));
    // Half a step up or down by Bayer's 4 x 4 pattern keeps gradients from banding, and files small.
    uint bits = pixel.x ^ pixel.y;
    float rank = float((bits & 1u) << 3 | (pixel.y & 1u) << 2 | (bits & 2u) | (pixel.y & 2u) >> 1);
    float noise = (rank + 0.5) / 16.0 - 0.5;
    uvec3 bytes = uvec3(clamp(255.0 * encoded + noise + 0.5, 0.0, 255.0));
    return bytes.x | bytes.y << 8 | bytes.z << 16 | uint(255.0 * alpha + 0.5) << 24;
}
