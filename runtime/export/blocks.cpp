#include "runtime/export/blocks.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <future>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace fw {

void writeBlocks(std::size_t count, std::size_t itemBytes, const FormatBlock& format, OutputFile& file) {
    constexpr std::size_t kBlockBytes = 512u
                                        << 10;  // fits the second-level cache beside what it is made from
    constexpr std::size_t kThreads = 4;         // more would wait for the one that writes
    const std::size_t items = std::max<std::size_t>(1, kBlockBytes / itemBytes);
    const std::size_t blocks = (count + items - 1) / items;

    std::atomic<std::size_t> next{0};
    std::mutex mutex;
    std::condition_variable turned;
    std::size_t turn = 0;  // the block that may be written now
    const auto worker = [&] {
        const auto text = std::make_unique_for_overwrite<char[]>(std::min(items, count) * itemBytes);
        for (std::size_t block = next++; block < blocks; block = next++) {
            const char* end = format(text.get(), block * items, std::min(count, (block + 1) * items));
            std::unique_lock lock(mutex);
            turned.wait(lock, [&] { return turn == block; });
            file.write(text.get(), static_cast<std::size_t>(end - text.get()));
            // A failed file takes no more; skipping ahead lets every thread end after the block it is at.
            if (!file.good()) next = blocks;
            ++turn;
            turned.notify_all();
        }
    };
    const std::size_t threads =
        blocks < 2
            ? blocks
            : std::min({blocks, kThreads, std::size_t{std::max(1u, std::thread::hardware_concurrency())}});
    std::vector<std::future<void>> others;
    for (std::size_t i = 1; i < threads; ++i) others.push_back(std::async(std::launch::async, worker));
    if (blocks > 0) worker();
    for (auto& other : others) other.get();
}

}  // namespace fw
