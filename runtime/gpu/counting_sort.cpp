#include "runtime/gpu/counting_sort.h"

#include <algorithm>
#include <array>

#include "shaders/shared.h"

#include "shaders/sort/sort.h"

namespace fw {

KeyCounting createKeyCounting(const Device& device) {
    const std::array shaders = {
        ShaderOptions{.name = "sort/count.comp"}, ShaderOptions{.name = "sort/sum.comp"},
        ShaderOptions{.name = "sort/top.comp"}, ShaderOptions{.name = "sort/place.comp"}};
    std::vector<Pipeline> made = createComputePipelines(device, shaders);
    return {std::move(made[0]), std::move(made[1]), std::move(made[2]), std::move(made[3])};
}

CountingSort createCountingSort(const Device& device) {
    const std::array shaders = {ShaderOptions{.name = "sort/scatter.comp"},
                                ShaderOptions{.name = "sort/settle.comp"}};
    std::vector<Pipeline> made = createComputePipelines(device, shaders);
    return {createKeyCounting(device), std::move(made[0]), std::move(made[1])};
}

void sumCounts(Commands& commands, const KeyCounting& counting, Buffer& sums, const Buffer& counts,
               Buffer& starts, uint32_t keys) {
    const gpu::SortPush push{.items = 0, .keys = keys};
    const uint32_t groups = groupsFor(keys, SORT_SUM_LANES * SORT_SUM_EACH);
    reserve(commands.device, sums, 16ull * groups);
    reserve(commands.device, starts, 4ull * keys);
    const Descriptor bound[] = {{0, counts}, {4, sums}, {5, starts}};
    dispatch(commands, counting.sum, spread(commands.device, groups), push, bound);
    barrier(commands);
    dispatch(commands, counting.top, {1, 1, 1}, push, bound);
    barrier(commands);
    dispatch(commands, counting.place, spread(commands.device, groups), push, bound);
    barrier(commands);
}

void countKeys(Commands& commands, const KeyCounting& counting, CountingSortBuffers& buffers,
               const Descriptor& keysOfItems, uint32_t items, uint32_t keys) {
    const gpu::SortPush push{.items = items, .keys = keys};
    reserve(commands.device, buffers.counts, 4ull * keys);
    reserve(commands.device, buffers.ranks, 4ull * items);
    fill(commands, buffers.counts, 0);
    barrier(commands);
    const Descriptor bound[] = {keysOfItems, {1, buffers.counts}, {2, buffers.ranks}};
    dispatch(commands, counting.count, spread(commands.device, groupsFor(items, SORT_GROUP)), push, bound);
    barrier(commands);
    sumCounts(commands, counting, buffers.sums, buffers.counts, buffers.starts, keys);
}

void sortByKey(Commands& commands, const CountingSort& sort, CountingSortBuffers& buffers,
               const Buffer& keysOfItems, Buffer& order, uint32_t items, uint32_t keys) {
    countKeys(commands, sort.counting, buffers, {0, keysOfItems}, items, keys);
    const gpu::SortPush push{.items = items, .keys = keys};
    reserve(commands.device, buffers.unsettled, 4ull * items);
    reserve(commands.device, order, 4ull * items);
    const Descriptor scattered[] = {
        {0, keysOfItems}, {1, buffers.starts}, {2, buffers.ranks}, {3, buffers.unsettled}};
    dispatch(commands, sort.scatter, spread(commands.device, groupsFor(items, SORT_GROUP)), push, scattered);
    barrier(commands);
    const Descriptor settled[] = {
        {0, keysOfItems}, {1, buffers.starts}, {2, buffers.counts}, {3, buffers.unsettled}, {4, order}};
    dispatch(commands, sort.settle, spread(commands.device, groupsFor(items, SORT_GROUP)), push, settled);
    barrier(commands);
}

}  // namespace fw
