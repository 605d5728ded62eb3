// What the device can do at most, measured: the yardstick for every stage.
#pragma once

#include "runtime/gpu/commands.h"
#include "tests/bench/table.h"

namespace fw::bench {

struct Peaks {
    Figure gigaflops;             ///< multiply-adds in a compute shader, each counted as two operations
    Figure gigabytes;             ///< a second, read plus written, by a copy command between buffers
    Figure shaderGigabytes;       ///< the same by a compute shader, 16 bytes an invocation
    Figure dispatchMicroseconds;  ///< of an empty dispatch and its barrier, among many in one submission
    Figure submitMicroseconds;    ///< of an empty submission that is awaited
};

Peaks measurePeaks(const Device& device, int repeats);

}  // namespace fw::bench
