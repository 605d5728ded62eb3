#include "tests/bench/peaks.h"
#include "tests/bench/tables.h"

namespace fw::bench {

void peaksTable(Bench& bench) {
    const Peaks peaks = measurePeaks(bench.device(), bench.options.repeats);
    print({.title = "Peaks of the device, measured",
           .header = {"what", "figure"},
           .rows = {{"multiply-adds in a compute shader, 10⁹ operations/s (two each)", text(peaks.gigaflops)},
                    {"copy command between buffers, 10⁹ bytes/s (read and written)", text(peaks.gigabytes)},
                    {"the same by a compute shader", text(peaks.shaderGigabytes)},
                    {"an empty dispatch and its barrier, µs", text(peaks.dispatchMicroseconds)},
                    {"an empty submission, awaited, µs", text(peaks.submitMicroseconds)}}},
          bench.options.markdown);
}

}  // namespace fw::bench
