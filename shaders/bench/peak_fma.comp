// Multiplies and adds as fast as the device can: eight independent chains, so that none waits for its own result.
layout(binding = 0, scalar) writeonly buffer Results { float results[]; };

layout(local_size_x = 256) in;

const uint kSteps = 256;  // a step is 8 multiply-adds

void main() {
    float x = 1.0 + float(gl_GlobalInvocationID.x) * 1e-9, y = 1e-9;
    float a = x, b = x + 1, c = x + 2, d = x + 3, e = x + 4, f = x + 5, g = x + 6, h = x + 7;
    uint step = 0;
    do {
        a = fma(a, x, y), b = fma(b, x, y), c = fma(c, x, y), d = fma(d, x, y);
        e = fma(e, x, y), f = fma(f, x, y), g = fma(g, x, y), h = fma(h, x, y);
    } while (++step < kSteps);
    results[gl_GlobalInvocationID.x] = a + b + c + d + e + f + g + h;
}
