#include "runtime/bake/sweep.h"

#include <utility>

#include "shaders/shared.h"

#include "shaders/bake/bake.h"

namespace fw {

Pipeline createSweep(const Device& device) {
    return createComputePipeline(device, {.name = "bake/sweep.comp"});
}

void recordSweeps(Commands& commands, const Pipeline& sweep, const Buffer& state, const glm::ivec3& size) {
    gpu::BakePush push{};
    push.size = size;
    const Descriptor bound[] = {{4, state}};
    uint32_t slices = 0, together = 16;  // in a part
    for (push.axis = 0; push.axis < 3; ++push.axis) {
        const auto slice = uint64_t(size[(push.axis + 1) % 3]) * uint64_t(size[(push.axis + 2) % 3]);
        for (push.step = 1; push.step >= -1; push.step -= 2)
            for (int i = 1; i < size[push.axis]; ++i) {
                push.slice = push.step > 0 ? i : size[push.axis] - 1 - i;
                dispatch(commands, sweep, spread(commands.device, groupsFor(slice, BAKE_GROUP)), push, bound);
                barrier(commands);
                if (commands.parted && ++slices >= together)
                    together = flushPart(commands, std::exchange(slices, 0));
            }
    }
}

}  // namespace fw
