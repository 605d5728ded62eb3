// Work that is split among all processors.
#pragma once

#include <algorithm>
#include <atomic>
#include <future>
#include <thread>
#include <vector>

namespace fw {

/// Calls work(block, first, last) for blocks of at most `size` of `count` items, on all processors, in any
/// order. An exception reaches the caller, once all have ended.
template <class Work>
void forBlocks(std::size_t count, std::size_t size, const Work& work) {
    const std::size_t blocks = (count + size - 1) / size;
    std::atomic<std::size_t> next{0};
    const auto worker = [&] {
        for (std::size_t block = next++; block < blocks; block = next++)
            work(block, block * size, std::min(count, (block + 1) * size));
    };
    std::vector<std::future<void>> others;
    const std::size_t threads =
        std::min<std::size_t>(std::max(1u, std::thread::hardware_concurrency()), blocks);
    for (std::size_t i = 1; i < threads; ++i) others.push_back(std::async(std::launch::async, worker));
    worker();
    for (auto& other : others) other.get();
}

}  // namespace fw
