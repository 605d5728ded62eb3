// How far the device's functions are off.
//
// Vulkan lets a sine err by 2^-11 and an arc tangent by 4,096 units in the last place, and a box is dropped
// where an interval says that there is no surface in it: so the intervals of shaders
// (shaders/lib/interval.glsl) take what the device's functions really err by, beyond what they allow for
// anyway. It is measured once, when the device is opened; that of Mesa's software device is known to be
// nothing but for arc sines (1.8e-4, not allowed for), and a test holds it to that.
#pragma once

#include "runtime/gpu/device.h"

namespace fw {

/// Evaluates each function at some ten thousand places and compares with double precision; the result has
/// some room, for places in between.
Precision measurePrecision(const Device& device);

}  // namespace fw
