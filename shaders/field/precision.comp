// The functions of the device at a list of places, for runtime/gpu/precision.cpp.
layout(local_size_x = 64) in;
layout(push_constant) uniform Push { uint count; };
layout(binding = 0, scalar) readonly buffer Places { float places[]; };

struct FunctionValues {
    float sine, cosine;
    float exponential, logarithm, power;
    float arcTangent, arcTangent2, arcSine, arcCosine;
};
layout(binding = 1, scalar) writeonly buffer Values { FunctionValues values[]; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    float x = places[i], part = fract(x);
    values[i] = FunctionValues(sin(x), cos(x), exp(clamp(x, -69.0, 69.0)), log(max(abs(x), 1e-30)), pow(abs(x), 1.75), atan(x),
                               atan(x, part - 0.5), asin(part), acos(part));
}
