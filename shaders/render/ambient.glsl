// A ray of ambient occlusion. After view.glsl and solid.glsl, with FIELD_VALUE.

const float kHit = 0.4;     // of the bias: nearer is a hit,
const float kLeave = 0.25;  // or of the way gone, so that rays may leave a wall beside their start

// 1 if a ray from the surface at p is open. `number` is that of the ray among all of the pixel's.
float openRay(vec3 p, vec3 n, uvec2 pixel, uint number) {
    vec3 d = cosineDirection(n, evenly(pixel, number)), start = p + n * frame.bias;
    Bounds bounds = solidBounds();
    uint samples = frame.ambientSamples;
    float radius = frame.ambientRadius, hit = kHit * frame.bias, least = radius / float(samples * samples), t = 0.0;
    uint i = 0;
    bool open;
    do {
        float h = clearance(bounds, start + d * t);
        open = h > min(hit, kLeave * t) || i == 0;
        ++i;
        t = max(t + h, least * float(i * i));  // so that the last sample is at the ray's end
    } while (i < samples && open && t < radius);
    return open ? 1.0 : 0.0;
}

uint packHistory(float openness, uint rays) { return uint(openness * 65535.0 + 0.5) | min(rays, 0xffff) << 16; }
float opennessOf(uint history) { return float(history & 0xffff) / 65535.0; }
