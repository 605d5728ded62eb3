// A ray of ambient occlusion. After view.glsl and solid.glsl, with FIELD_VALUE.

// In units of the field's slope at the ray's start, found as its value one bias above the surface: fields that are steep
// somewhere are scaled to be flat elsewhere.
const float kHit = 0.4;        // of the bias: nearer is a hit,
const float kLeave = 0.25;     // or of the way gone, so that rays may leave a wall beside their start
const float kFlattest = 0.02;  // slope
const float kHaste = 0.25;     // steps are lengthened in flat fields by up to the inverse of this
const float kLift = 16.0;      // biases that a start below the surface is lifted by, at most

// 1 if a ray from the surface at p is open. `number` is that of the ray among all of the pixel's.
float openRay(vec3 p, vec3 n, uvec2 pixel, uint number) {
    vec3 d = cosineDirection(n, evenly(pixel, number));
    Bounds bounds = solidBounds();
    uint samples = unfolded(frame.ambientSamples);
    float radius = frame.ambientRadius, bias = frame.bias;
    // Above the ground also where a bevelled edge looks down on it.
    float foot = bounds.ground + bias;
    vec3 start = p + n * bias;
    start.y = max(start.y, foot);
    float least = radius / float((samples - 1) * (samples - 1)), t = 0.0;
    float slope = 1.0, haste = 1.0;
    uint i = 0;
    bool open = true;  // kept, as in trace.comp
    do {
        float h = clearance(bounds, start + d * t);
        if (i == 0) {
            start += n * (h > 0.0 ? 0.0 : min(bias - h, kLift * bias));
            start.y = max(start.y, foot);
            h = h > 0.0 ? h : bias;
            slope = clamp(h / bias, kFlattest, 1.0);
            haste = 1.0 / max(slope, kHaste);
        }
        open = open && h > min(kHit * bias, kLeave * t) * slope;
        ++i;
        t = max(t + h * haste, least * float(i * i));  // so that the last sample is at the ray's end
    } while (i < samples && open && t < 1.001 * radius);
    return open ? 1.0 : 0.0;
}
