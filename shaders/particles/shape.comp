// The kernel of each particle: its centre drawn towards its neighbours, and its ellipsoid that of how they lie
// (runtime/particles/particle_surface.h). Lengths are sides of a bucket, unless told.
#include "particles/surface.glsl"

layout(local_size_x = DENSITY_GROUP) in;
layout(binding = 0, rgba32ui) restrict readonly uniform uimageBuffer sorted;
layout(binding = 2, scalar) writeonly buffer Shapes { vec4 shapes[]; };
layout(binding = 3, scalar) writeonly buffer Keys { uint keys[]; };  // buckets of the centres

const float kDrop = kReach / ANISOTROPIC_REACH, kLone = ANISOTROPIC_LONE * kDrop;
const float kVariance = kReach * kReach / 11.0;  // of a full neighbourhood, along each axis
const float kVolume = 4.18879 * kDrop * kDrop * kDrop;
const float kIntegral = 0.638291;  // of (1 - r^2)^3
const float kSmoothing = 0.9;      // Yu and Turk's lambda,
const float kFlattest = 0.25;      // and the inverse of their k_r
const float kFew = 1.5, kMany = 3.0;

// What is known of the neighbours: the sum of weights, of weighted offsets, and of the products of these.
float weights = 0.0;
vec3 offs = vec3(0.0), squares = vec3(0.0), products = vec3(0.0);  // xx yy zz; xy xz yz

void lookAround(vec3 p, ivec3 own) {
    int row = 0;
    do {
        ivec2 b = own.yz + ivec2(row % 5, row / 5) - 2;
        vec2 away = max(max(vec2(b) - p.yz, p.yz - vec2(b + 1)), 0.0);
        float left = kReach * kReach - dot(away, away), far = sqrt(max(left, 0.0));
        uint i = starts[bucketAt(ivec3(floor(p.x - far), b))], end = starts[bucketAt(ivec3(floor(p.x + far), b)) + 1];
        end = left > 0.0 ? end : i;
        while (i < end) {
            vec3 off = uintBitsToFloat(imageLoad(sorted, int(i++)).xyz) - p;
            float s = max(1.0 - dot(off, off) * (1.0 / (kReach * kReach)), 0.0), w = s * s * s;
            weights += w;
            offs += w * off;
            squares += w * off * off;
            products += w * off.xxy * off.yzz;
        }
    } while (++row < 25);
}

// One rotation of Jacobi's: makes the first of `across` 0, of a symmetric matrix whose axes are in an order that has it there.
void rotate(inout vec3 along, inout vec3 across, inout vec3 a, inout vec3 b) {
    float off = across.x;
    float theta = (along.y - along.x) / (2.0 * (abs(off) > 1e-12 ? off : 1e-12));
    float t = abs(off) > 1e-12 ? (theta < 0.0 ? -1.0 : 1.0) / (abs(theta) + sqrt(theta * theta + 1.0)) : 0.0;
    float c = inversesqrt(t * t + 1.0), s = t * c;
    along += vec3(-t * off, t * off, 0.0);
    across = vec3(0.0, c * across.y - s * across.z, s * across.y + c * across.z);
    vec3 old = a;
    a = c * old - s * b;
    b = s * old + c * b;
}

void main() {
    uint index = item();
    if (index >= push.particles) return;
    uint nowhere = uint(push.buckets.x * push.buckets.y * push.buckets.z);
    bool there = index < starts[nowhere];
    vec3 p = there ? uintBitsToFloat(imageLoad(sorted, int(index)).xyz) : vec3(push.buckets / 2);
    ivec3 own = clamp(ivec3(p), ivec3(3), push.buckets - 4);
    vec3 along = vec3(1.0 / (kReach * kReach)), across = vec3(0.0), centre = p;
    float height = kVolume / (kIntegral * kReach * kReach * kReach);
    if (there && !full(own - ivec3(3, 2, 2), ivec3(7, 5, 5))) {  // or it is far from the surface
        lookAround(p, own);
        vec3 mean = offs / weights, variance = max(squares / weights - mean * mean, 0.0);
        vec3 covariance = products / weights - mean.xxy * mean.yzz;
        float many = smoothstep(kFew, kMany, weights);
        centre = p + kSmoothing * many * mean;
        vec3 x = vec3(1.0, 0.0, 0.0), y = x.yxz, z = x.yzx;
        for (int sweep = 0; sweep < 4; ++sweep) {
            rotate(variance, covariance, x, y);
            vec3 swapped = variance.xzy, other = covariance.yxz;  // x z y
            rotate(swapped, other, x, z);
            variance = swapped.xzy, covariance = other.yxz;
            swapped = variance.yzx, other = covariance.zxy;  // y z x
            rotate(swapped, other, y, z);
            variance = swapped.zxy, covariance = other.yzx;
        }
        float longest = max(variance.x, max(variance.y, variance.z));
        vec3 share = min(max(variance, kFlattest * longest) / kVariance, 1.0);
        vec3 reach = mix(vec3(kLone), max(kReach * sqrt(share), kLone), many), narrow = 1.0 / (reach * reach);
        along = narrow.x * x * x + narrow.y * y * y + narrow.z * z * z;
        across = 2.0 * (narrow.x * x.xxy * x.yzz + narrow.y * y.xxy * y.yzz + narrow.z * z.xxy * z.yzz);
        height = mix(1.0, kVolume / (kIntegral * reach.x * reach.y * reach.z), many);
    }
    shapes[3 * index] = vec4(centre, height);
    shapes[3 * index + 1] = vec4(along, 0.0);
    shapes[3 * index + 2] = vec4(across, 0.0);
    keys[index] = there ? uint(bucketAt(clamp(ivec3(centre), ivec3(0), push.buckets - 1))) : nowhere;
}
