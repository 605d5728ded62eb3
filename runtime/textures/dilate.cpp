#include "runtime/textures/dilate.h"

#include <array>

namespace fw {
namespace {

constexpr std::size_t kChannels = 3;

/// Calls use(texel) for the up to eight about one.
template <class Use>
void around(std::size_t texel, int size, const Use& use) {
    const int x = int(texel % std::size_t(size)), y = int(texel / std::size_t(size));
    for (int j = y - 1; j <= y + 1; ++j)
        for (int i = x - 1; i <= x + 1; ++i)
            if (i >= 0 && j >= 0 && i < size && j < size && (i != x || j != y))
                use(std::size_t(j) * std::size_t(size) + std::size_t(i));
}

}  // namespace

void dilate(std::vector<std::vector<uint8_t>*> images, std::vector<uint8_t> known, int size, int reach) {
    const std::size_t texels = std::size_t(size) * std::size_t(size);
    std::vector<std::array<uint8_t, kChannels>> means;
    for (const std::vector<uint8_t>* image : images) {
        std::array<uint64_t, kChannels> sums{};
        uint64_t count = 0;
        for (std::size_t i = 0; i < texels; ++i) {
            if (!known[i]) continue;
            ++count;
            for (std::size_t k = 0; k < kChannels; ++k) sums[k] += (*image)[kChannels * i + k];
        }
        std::array<uint8_t, kChannels>& mean = means.emplace_back();
        for (std::size_t k = 0; k < kChannels; ++k)
            mean[k] = count > 0 ? uint8_t((sums[k] + count / 2) / count) : uint8_t(0);
    }
    std::vector<std::size_t> ring, next;
    std::vector<uint8_t> waits(texels, 0);
    const auto call = [&](std::size_t texel, std::vector<std::size_t>& into) {
        around(texel, size, [&](std::size_t other) {
            if (known[other] || waits[other]) return;
            waits[other] = 1;
            into.push_back(other);
        });
    };
    for (std::size_t i = 0; i < texels; ++i)
        if (known[i]) call(i, ring);
    for (int step = 0; step < reach && !ring.empty(); ++step) {
        for (const std::size_t texel : ring)
            for (std::vector<uint8_t>* image : images) {
                std::array<unsigned, kChannels> sums{};
                unsigned count = 0;
                around(texel, size, [&](std::size_t other) {
                    if (!known[other]) return;
                    ++count;
                    for (std::size_t k = 0; k < kChannels; ++k) sums[k] += (*image)[kChannels * other + k];
                });
                for (std::size_t k = 0; k < kChannels; ++k)
                    (*image)[kChannels * texel + k] = uint8_t((sums[k] + count / 2) / count);
            }
        next.clear();
        for (const std::size_t texel : ring) known[texel] = 1;
        for (const std::size_t texel : ring) call(texel, next);
        ring.swap(next);
    }
    for (std::size_t i = 0; i < texels; ++i)
        if (!known[i])
            for (std::size_t m = 0; m < images.size(); ++m)
                for (std::size_t k = 0; k < kChannels; ++k) (*images[m])[kChannels * i + k] = means[m][k];
}

}  // namespace fw
