// A second Vulkan driver, by other people: SwiftShader, as Debian's chromium-common has it.
//
// It has subgroups of four, small texel buffers, neither push descriptors nor 64-bit integers nor geometry
// shaders: what one driver forgives, two seldom do.
#pragma once

#include <string>

namespace fw::test {

/// As long as it lives, SwiftShader is the only driver that devices are found in.
class SecondDriver {
  public:
    SecondDriver();
    ~SecondDriver();
    SecondDriver(const SecondDriver&) = delete;
    /// Whether it is installed; if not, drivers are as they were, and why() says what to install.
    bool works() const { return there; }
    static const char* why();

  private:
    bool there = false, had = false;
    std::string previous;
};

}  // namespace fw::test
