#include "runtime/gpu/precision.h"

#include <algorithm>
#include <cmath>

#include "runtime/gpu/commands.h"
#include "runtime/gpu/shader.h"

namespace fw {
namespace {

constexpr uint32_t kPlaces = 12'288;
constexpr double kRoom = 1.5;  // of what was found: the worst place is seldom among those that are tried

/// As in shaders/field/precision.comp.
struct FunctionValues {
    float sine, cosine;
    float exponential, logarithm, power;
    float arcTangent, arcTangent2, arcSine, arcCosine;
};

/// Evenly within a turn about 0, and from there ever farther apart up to 100,000, where sines are given up.
std::vector<float> places() {
    std::vector<float> all;
    constexpr uint32_t kNear = kPlaces / 3;
    for (uint32_t i = 0; i < kNear; ++i) all.push_back(6.3f * (2.0f * float(i) / kNear - 1.0f));
    for (uint32_t i = 0; all.size() < kPlaces; ++i) {
        const double t = double(i / 2) / ((kPlaces - kNear) / 2);
        all.push_back(float((i % 2 ? -1.0 : 1.0) * 6.3 * std::pow(1e5 / 6.3, t)));
    }
    return all;
}

/// What of an error the intervals do not allow for anyway (iSin, iSlack).
double beyond(double found, double exact, double absolute, double relative) {
    const double error = std::isfinite(found) ? std::abs(found - exact) : 1.0;
    return std::max(0.0, kRoom * error - absolute - relative);
}

}  // namespace

Precision measurePrecision(const Device& device) {
    const Pipeline pipeline = createComputePipeline(device, {.name = "field/precision.comp"});
    const std::vector<float> at = places();
    const Buffer in = createBuffer(device, at.size() * sizeof(float));
    const Buffer out = createBuffer(device, at.size() * sizeof(FunctionValues));
    upload(device, in, at);
    Commands commands(device);
    const Descriptor bound[] = {{0, in}, {1, out}};
    dispatch(commands, pipeline, {groupsFor(at.size(), 64), 1, 1}, kPlaces, bound);
    submit(commands);
    const auto values = download<FunctionValues>(device, out, at.size());

    double sine = 0.0, curves = 0.0;
    const auto curve = [&](double found, double exact) {
        const double size = 1.0 + std::abs(exact);
        curves = std::max(curves, beyond(found / size, exact / size, 1e-5, 0.0));
    };
    for (std::size_t i = 0; i < at.size(); ++i) {
        const double x = double(at[i]), size = std::abs(x), part = x - std::floor(x);
        const FunctionValues& found = values[i];
        sine = std::max(sine, beyond(double(found.sine), std::sin(x), 1e-5, 5e-7 * size));
        sine = std::max(sine, beyond(double(found.cosine), std::cos(x), 1e-5, 5e-7 * size));
        curve(double(found.exponential), std::exp(std::clamp(x, -69.0, 69.0)));
        curve(double(found.logarithm), std::log(std::max(size, 1e-30)));
        curve(double(found.power), std::pow(size, 1.75));
        curve(double(found.arcTangent), std::atan(x));
        curve(double(found.arcTangent2), std::atan2(x, double(float(part) - 0.5f)));
        curve(double(found.arcSine), std::asin(part));
        curve(double(found.arcCosine), std::acos(part));
    }
    return {float(sine), float(curves)};
}

}  // namespace fw
