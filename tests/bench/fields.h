// The four fields of the benchmark, as C++: what the baseline is compiled with and what a test compares
// graphs to.
//
//   tower   the talk's max-norm box, cut by crossed tubes of period 0.5 and by floors of period 1
//   menger  Menger sponge of depth 3 in [-1, 1]^3
//   gyroid  walls of a gyroid inside the unit sphere; its gradient reaches sqrt(3)
//   csg     sphere and box, less three crossed cylinders
//
// The graphs of the same fields are in samples/ and tests/data/bench/ (see benchGraph). Everything is inline
// so that the baseline's translation unit compiles the field into its loop, as a program written for one
// field would.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>

namespace fw::bench {

enum class Field { tower, menger, gyroid, csg };
inline constexpr std::array kFields = {Field::tower, Field::menger, Field::gyroid, Field::csg};

/// "tower", "menger", "gyroid", "csg".
std::string_view fieldName(Field field);

/// Half the edge of the benchmark's region, a cube about the origin; metres.
constexpr float regionHalf(Field field) {
    switch (field) {
        case Field::tower: return 2.5f;
        case Field::menger: return 1.2f;
        default: return 1.1f;
    }
}

/// Path of the graph file that says the same field.
std::string benchGraph(Field field);
/// The file of a sample.
std::string benchSample(const std::string& name);

/// By value, so that loops over them become vectors, which those of references do not.
inline float larger(float a, float b) { return a < b ? b : a; }
inline float smaller(float a, float b) { return b < a ? b : a; }

/// Remainder of the division that rounds down: GLSL's mod, in [0, period).
inline float wrap(float x, float period) { return x - period * std::floor(x / period); }

/// Distance to a box in the maximum norm.
inline float boxMax(float x, float y, float z, float hx, float hy, float hz) {
    return larger(std::abs(x) - hx, larger(std::abs(y) - hy, std::abs(z) - hz));
}

/// The second greatest of three: the cross of three square tubes along the axes.
inline float crossed(float x, float y, float z) {
    return smaller(larger(x, y), smaller(larger(y, z), larger(x, z)));
}

struct Tower {
    static float at(float x, float y, float z) {
        float tubes =
            crossed(std::abs(wrap(x, 0.5f) - 0.25f) - 0.15f, std::abs(wrap(y, 0.5f) - 0.25f) - 0.15f,
                    std::abs(wrap(z, 0.5f) - 0.25f) - 0.15f);
        float d = larger(boxMax(x, y, z, 1, 2, 1), -tubes);
        float floors =
            boxMax(wrap(x, 1) - 0.5f, wrap(y + 0.25f, 1) - 0.5f, wrap(z, 1) - 0.5f, 0.45f, 0.2f, 0.45f);
        return larger(d, -floors);
    }
};

struct Menger {
    static float hole(float x, float y, float z, float period) {
        float half = period / 2, tube = period / 6;
        return crossed(std::abs(wrap(x + half, period) - half) - tube,
                       std::abs(wrap(y + half, period) - half) - tube,
                       std::abs(wrap(z + half, period) - half) - tube);
    }
    static float at(float x, float y, float z) {
        float d = boxMax(x, y, z, 1, 1, 1);
        for (float period : {2.0f, 2.0f / 3, 2.0f / 9}) d = larger(d, -hole(x, y, z, period));
        return d;
    }
};

struct Gyroid {
    static float at(float x, float y, float z) {
        const float k = 12;
        float g = std::sin(k * x) * std::cos(k * y) + std::sin(k * y) * std::cos(k * z) +
                  std::sin(k * z) * std::cos(k * x);
        return larger(std::abs(g) / k - 0.03f, std::sqrt(x * x + y * y + z * z) - 1);
    }
};

struct Csg {
    static float at(float x, float y, float z) {
        float xx = x * x, yy = y * y, zz = z * z;
        float d = larger(std::sqrt(xx + yy + zz) - 1, boxMax(x, y, z, 0.75f, 0.75f, 0.75f));
        // The nearest of three cylinders: roots are monotonic, so one root of the least sum serves all.
        return larger(d, 0.5f - std::sqrt(smaller(xx + yy, smaller(yy + zz, zz + xx))));
    }
};

/// Calls `use` with the type that holds the field's function, so that a template is compiled for it.
template <class Use>
decltype(auto) withField(Field field, Use&& use) {
    switch (field) {
        case Field::tower: return use(Tower{});
        case Field::menger: return use(Menger{});
        case Field::gyroid: return use(Gyroid{});
        default: return use(Csg{});
    }
}

/// The field's value at a point: < 0 inside.
inline float fieldAt(Field field, glm::vec3 p) {
    return withField(field, [&](auto f) { return f.at(p.x, p.y, p.z); });
}

}  // namespace fw::bench
