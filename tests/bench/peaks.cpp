#include "tests/bench/peaks.h"

namespace fw::bench {
namespace {

/// Records with `record`, runs once and returns the device's ms for it.
template <class Record>
double timedRun(const Device& device, Record&& record) {
    Commands commands(device, true);
    beginStage(commands, "run");
    record(commands);
    submit(commands);
    return commands.stages[0].milliseconds;
}

}  // namespace

Peaks measurePeaks(const Device& device, int repeats) {
    Peaks peaks;
    // Some 10 ms of work on two cores; a GPU gets more of it.
    const uint32_t scale = device.software ? 1 : 64;

    const Pipeline multiply = createComputePipeline(device, {.name = "bench/peak_fma.comp"});
    const uint32_t groups = 512 * std::min(scale, 64u);
    const Buffer results = createBuffer(device, VkDeviceSize(groups) * 256 * 4);
    const Descriptor resultsBound[] = {Descriptor(0, results)};
    peaks.gigaflops = measure(repeats, [&] {
        const double ms = timedRun(device, [&](Commands& commands) {
            dispatch(commands, multiply, {groups, 1, 1}, nullptr, 0, resultsBound);
        });
        return double(groups) * 256 * 256 * 8 * 2 / ms * 1e-6;
    });

    const Pipeline copy = createComputePipeline(device, {.name = "bench/peak_copy.comp"});
    const VkDeviceSize bytes = 64 << 20;
    const Buffer source = createBuffer(device, bytes), target = createBuffer(device, bytes);
    const Descriptor copied[] = {Descriptor(0, source), Descriptor(1, target)};
    const int copies = device.software ? 1 : 16;
    const auto rate = [&](auto&& recordCopy) {
        return measure(repeats, [&] {
            const double ms = timedRun(device, [&](Commands& commands) {
                for (int i = 0; i < copies; i++) {
                    recordCopy(commands);
                    barrier(commands);
                }
            });
            return 2.0 * double(bytes) * copies / ms * 1e-6;
        });
    };
    peaks.gigabytes = rate([&](Commands& commands) {
        const VkBufferCopy region = {0, 0, bytes};
        vkCmdCopyBuffer(commands.handle, source.handle, target.handle, 1, &region);
    });
    peaks.shaderGigabytes = rate([&](Commands& commands) {
        dispatch(commands, copy, {uint32_t(bytes / 16 / 256 / 16), 16, 1}, nullptr, 0, copied);
    });

    const Pipeline nothing = createComputePipeline(device, {.name = "bench/peak_nothing.comp"});
    const int dispatches = 1000;
    peaks.dispatchMicroseconds = measure(repeats, [&] {
        return timedRun(device,
                        [&](Commands& commands) {
                            for (int i = 0; i < dispatches; i++) {
                                dispatch(commands, nothing, {1, 1, 1}, nullptr, 0, {});
                                barrier(commands);
                            }
                        }) *
               1000 / dispatches;
    });
    peaks.submitMicroseconds = measure(repeats, [&] {
        Commands commands(device);
        barrier(commands);
        const auto start = Clock::now();
        submit(commands);
        return millisecondsSince(start) * 1000;
    });
    return peaks;
}

}  // namespace fw::bench
