// Evaluates a program's field on the device, for comparison with the CPU reference.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "graph/compile/compile.h"
#include "runtime/gpu/field_buffers.h"

namespace fw::test {

/// The numbers, images and volumes of a program on the device.
struct FieldResources {
    explicit FieldResources(const Program& program);
    FieldBuffers buffers() const {
        return {.parameters = &parameters, .images = &images, .volumes = &volumes};
    }
    Buffer parameters, images, volumes;
};

/// As shaders/field/evaluate.comp writes it.
struct FieldSample {
    float value, rowValue;
    std::array<float, 2> interval;
    std::array<float, 4> gradient;
    std::array<float, 3> baseColor;
    float roughness;
};

/// Samples at float positions; intervals are over the cube of `halfSize` around each.
std::vector<FieldSample> evaluateOnDevice(const Program& program,
                                          std::span<const std::array<float, 3>> points, float halfSize);

}  // namespace fw::test
