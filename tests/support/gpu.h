// One device for all tests of a program, with the validation layer on where it is installed.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "runtime/gpu/commands.h"

namespace fw::test {

/// The device that all tests share. A message of the validation layer, of this device or another, fails the
/// test during which it came.
Device& device();

/// What the validation layer said so far in this test was meant.
void forgetValidationMessages();

/// As long as it lives, buffers that are made on the device are ones that the host does not see, as on a
/// graphics card.
struct HiddenMemory {
    HiddenMemory() : was(std::exchange(device().unifiedMemory, false)) {}
    ~HiddenMemory() { device().unifiedMemory = was; }
    HiddenMemory(const HiddenMemory&) = delete;

  private:
    bool was;
};

/// A compute pipeline from GLSL text (without #version); `name` only labels it.
Pipeline computePipeline(const std::string& text, const std::vector<uint32_t>& constants = {},
                         const std::string& field = {});

/// A fresh folder that holds the caches as long as the object lives.
struct TemporaryCache {
    TemporaryCache();
    ~TemporaryCache();
    std::string folder;

  private:
    std::string previous;
    bool had = false;
};

}  // namespace fw::test
