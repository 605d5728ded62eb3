// Hashes of words, for tables and caches: quick, and no guard against whoever wants two to agree.
#pragma once

#include <bit>
#include <cstdint>

namespace fw {

/// The hash of what `hash` stands for and then the word. Its high bits are the better ones.
constexpr uint64_t mixed(uint64_t hash, uint64_t word) {
    return std::rotl((hash ^ word) * 0x9e3779b97f4a7c15u, 29);
}

}  // namespace fw
