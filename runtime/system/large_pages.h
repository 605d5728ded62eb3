// Large pages for memory that is about to be written: the system hands out memory a page at a time, as it is
// first written to, and 512 small ones take many times as long as a large one.
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace fw {

/// Asks for large pages where a range is large enough for some. The range is memory that nothing was written
/// to yet, or not much; what it holds stays. A system that has none passes over it.
inline void wantLargePages(void* data, std::size_t bytes) {
    constexpr std::size_t kWorthwhile = 4u << 20, kPage = 4096;
    if (bytes < kWorthwhile) return;
    const auto first = (reinterpret_cast<std::uintptr_t>(data) + kPage - 1) / kPage * kPage,
               end = (reinterpret_cast<std::uintptr_t>(data) + bytes) / kPage * kPage;
    (void)::madvise(reinterpret_cast<void*>(first), end - first, MADV_HUGEPAGE);
}

/// An empty vector's first `count` elements, in large pages where they are many.
template <class T>
void resizeInLargePages(std::vector<T>& empty, std::size_t count) {
    empty.reserve(count);
    wantLargePages(static_cast<void*>(empty.data()), count * sizeof(T));
    empty.resize(count);
}

}  // namespace fw
