// What a texture has between its charts: a lookup near a chart's border, and every smaller copy of the
// texture, takes a part of it.
#pragma once

#include <cstdint>
#include <vector>

namespace fw {

/// Square images of `size` x `size` texels, 8 bits a channel, of which `known` says which are set. The others
/// get the mean of the nearest set ones: ring by ring to `reach` texels away, and beyond that the mean of
/// all.
void dilate(std::vector<std::vector<uint8_t>*> images, std::vector<uint8_t> known, int size, int reach);

}  // namespace fw
