#include "tests/bench/path_baseline.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "runtime/system/clock.h"
#include "tests/bench/fields.h"
#include "tests/bench/two_threads.h"

namespace fw::bench {
namespace {

using glm::vec2, glm::vec3;

constexpr float kPi = 3.14159265f, kClosest = 2e-5f, kSmooth = 0.04f;
constexpr int kMostSteps = 768;

struct Random {
    uint32_t state;
    Random(uint32_t pixel, uint32_t path) : state((pixel * 0x9E3779B1u) ^ (path * 0x85EBCA77u)) { next(); }
    uint32_t next() {
        state = state * 747796405u + 2891336453u;
        const uint32_t word = ((state >> ((state >> 28) + 4u)) ^ state) * 277803737u;
        return word >> 22 ^ word;
    }
    float one() { return float(next() >> 8) / 16777216.0f; }
    vec2 two() {
        const float x = one();
        return {x, one()};
    }
};

struct Axes {
    vec3 x, y, z;
    explicit Axes(vec3 n) : z(n) {
        const float s = n.z < 0 ? -1.0f : 1.0f, a = -1 / (s + n.z), b = n.x * n.y * a;
        x = {1 + s * n.x * n.x * a, s * b, -s * n.x};
        y = {b, s + n.y * n.y * a, -n.y};
    }
    vec3 in(vec3 v) const { return {dot(v, x), dot(v, y), dot(v, z)}; }
    vec3 out(vec3 v) const { return v.x * x + v.y * y + v.z * z; }
};

float step(float low, float high, float x) {
    const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
    return t * t * (3 - 2 * t);
}
float fifth(float x) { return x * x * x * x * x; }

float lambda(float cosine, float alpha) {
    const float c2 = std::max(cosine * cosine, 1e-8f);
    return 0.5f * (std::sqrt(1 + alpha * alpha * (1 - c2) / c2) - 1);
}
float lobe(vec3 from, vec3 to, float alpha) {
    const vec3 h = normalize(from + to);
    const float a2 = alpha * alpha, spread = (h.x * h.x + h.y * h.y) / a2 + h.z * h.z;
    return 1 / (kPi * a2 * spread * spread) / (1 + lambda(from.z, alpha) + lambda(to.z, alpha)) /
           (4 * std::max(from.z, 1e-4f));
}
vec3 facet(vec3 from, float alpha, vec2 u) {
    const vec3 v = normalize(vec3(alpha * from.x, alpha * from.y, from.z));
    const float across = v.x * v.x + v.y * v.y;
    const vec3 x = across > 1e-12f ? vec3(-v.y, v.x, 0) / std::sqrt(across) : vec3(1, 0, 0), y = cross(v, x);
    const float r = std::sqrt(u.x), angle = 2 * kPi * u.y, s = 0.5f * (1 + v.z), a = r * std::cos(angle);
    const float b = glm::mix(std::sqrt(std::max(1 - a * a, 0.0f)), r * std::sin(angle), s);
    const vec3 h = a * x + b * y + std::sqrt(std::max(1 - a * a - b * b, 0.0f)) * v;
    return normalize(vec3(alpha * h.x, alpha * h.y, std::max(h.z, 1e-6f)));
}

struct Tracer {
    const PathBaseline& scene;
    float close = kClosest * scene.radius, half = regionHalf(Field::tower);

    static float at(vec3 p) { return Tower::at(p.x, p.y, p.z); }
    vec3 normal(vec3 p) const {
        const float e = 4 * close;
        constexpr vec3 kCorners[] = {{1, -1, -1}, {-1, -1, 1}, {-1, 1, -1}, {1, 1, 1}};
        vec3 sum(0);
        for (const vec3 corner : kCorners) sum += corner * at(p + e * corner);
        return normalize(sum);
    }
    /// How far the surface is; negative: there is none.
    float hit(vec3 o, vec3 d) const {
        const vec3 a = (-half - o) / d, b = (half - o) / d, first = min(a, b), last = max(a, b);
        float t = std::max({first.x, first.y, first.z, 0.0f});
        const float end = std::min({last.x, last.y, last.z});
        for (int i = 0; i < kMostSteps && t < end; ++i) {
            const float f = at(o + d * t);
            if (f < close && (t > 4 * close || f < 0.25f * t)) return t;
            t += std::max(f, 0.02f * close);
        }
        return -1;
    }
    vec3 sky(vec3 d) const {
        return glm::mix(scene.below, glm::mix(scene.horizon, scene.zenith, step(0, 0.9f, d.y)),
                        step(-0.25f, 0.15f, d.y));
    }
    /// As it is looked at, with a glow about the sun and its disc.
    vec3 skySeen(vec3 d) const {
        const float toSun = std::max(dot(d, scene.sun), 0.0f);
        const vec3 above = glm::mix(scene.horizon, scene.zenith, step(0, 0.6f, d.y));
        return glm::mix(scene.below, above, step(-0.12f, 0.02f, d.y)) +
               scene.sunLight * (0.04f * std::pow(toSun, 12.0f) + 0.12f * std::pow(toSun, 160.0f) +
                                 2.0f * step(0.9993f, 0.9997f, toSun));
    }
    vec3 towardsSun(vec2 u) const {
        const float c = 1 - scene.sunWide * u.x, s = std::sqrt(std::max(1 - c * c, 0.0f)),
                    angle = 2 * kPi * u.y;
        return normalize(Axes(scene.sun).out({s * std::cos(angle), s * std::sin(angle), c}));
    }

    vec3 path(vec3 o, vec3 d, Random& random) const {
        const float alpha = std::max(scene.roughness, kSmooth) * std::max(scene.roughness, kSmooth),
                    sunDensity = 1 / (2 * kPi * scene.sunWide), mirror = 0.04f;
        vec3 light(0), through(1);
        float density = -1;
        for (int bounce = 0;; ++bounce) {
            const float t = hit(o, d);
            if (t < 0) {
                light += bounce > 0 ? through * sky(d) : skySeen(d);
                if (bounce > 0 && dot(d, scene.sun) > 1 - scene.sunWide)
                    light += through * scene.sunLight * sunDensity * (density / (density + sunDensity));
                return light;
            }
            if (bounce > scene.bounces) return light;
            const vec3 p = o + d * t, n = normal(p);
            const Axes axes(n);
            vec3 from = axes.in(-d);
            from.z = std::max(from.z, 1e-4f);
            o = p + n * (4 * close);
            const vec3 h = facet(from, alpha, random.two());
            const float choice = random.one(),
                        tint = mirror + (1 - mirror) * fifth(1 - std::max(dot(from, h), 0.0f));
            vec3 to = 2 * dot(from, h) * h - from;
            const float seen =
                to.z > 0 ? (1 + lambda(from.z, alpha)) / (1 + lambda(from.z, alpha) + lambda(to.z, alpha))
                         : 0;
            const vec3 again = tint + (1 - tint) * scene.base,
                       chalk = tint * (1 - seen) * again + (1 - tint) * scene.base;
            const float likely = std::clamp(1 - mirror - (1 - mirror) * fifth(1 - from.z), 0.05f, 1.0f);
            const auto shineOf = [&](vec3 l) {
                const vec3 middle = normalize(from + l);
                return (mirror + (1 - mirror) * fifth(1 - std::max(dot(from, middle), 0.0f))) *
                       lobe(from, l, alpha);
            };
            if (bounce < scene.bounces) {
                const vec3 toSun = towardsSun(random.two()), l = axes.in(toSun);
                if (l.z > 0 && hit(o, toSun) < 0) {
                    const float shine = shineOf(l), found = shine + likely * l.z / kPi;
                    light += through * (shine + chalk * (l.z / kPi)) * scene.sunLight * sunDensity /
                             (sunDensity + found);
                }
            }
            if (choice >= tint * seen) {
                through *= choice < tint ? again : scene.base;
                const vec2 u = random.two();
                const float r = std::sqrt(u.y), angle = 2 * kPi * u.x;
                to = {r * std::cos(angle), r * std::sin(angle), std::sqrt(1 - u.y)};
            }
            density = shineOf(to) + likely * std::max(to.z, 0.0f) / kPi;
            d = normalize(axes.out(to));
            if (bounce >= 3) {
                const float lives = std::clamp(std::max({through.x, through.y, through.z}), 0.05f, 1.0f);
                if (random.one() >= lives) return light;
                through /= lives;
            }
        }
    }
};

}  // namespace

PathBaselineResult tracePaths(const PathBaseline& scene, int paths) {
    const Tracer tracer{scene};
    const Clock::time_point start = Clock::now();
    glm::dvec3 sums[2] = {};
    onTwoThreads([&](int thread) {
        glm::dvec3 sum(0);
        for (int y = thread; y < scene.size.y; y += 2)
            for (int x = 0; x < scene.size.x; ++x)
                for (int i = 0; i < paths; ++i) {
                    Random random(uint32_t(y * scene.size.x + x), uint32_t(i));
                    const vec2 place = (vec2(x, y) + random.two()) / vec2(scene.size) * 2.0f - 1.0f;
                    const vec3 d = normalize(scene.forward + place.x * scene.right - place.y * scene.up);
                    sum += tracer.path(scene.eye, d, random);
                }
        sums[thread] = sum;
    });
    return {millisecondsSince(start), (sums[0] + sums[1]) / (double(scene.size.x) * scene.size.y * paths)};
}

}  // namespace fw::bench
