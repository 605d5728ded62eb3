// A display for tests of real windows, and what is seen on it.
#pragma once

#include <gtest/gtest.h>
#include <sys/types.h>

#include <glm/vec3.hpp>
#include <string>

#include "runtime/render/picture.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::test {

void rest(double seconds);

/// An X server without a screen; DISPLAY leads to it as long as it lives.
class VirtualDisplay {
  public:
    explicit VirtualDisplay(int width = 640, int height = 480);
    VirtualDisplay(const VirtualDisplay&) = delete;
    VirtualDisplay& operator=(const VirtualDisplay&) = delete;
    ~VirtualDisplay();
    bool works() const { return number >= 0; }

    /// All of the screen now.
    Picture screen() const;
    /// The colour of a pixel of the screen now.
    glm::ivec3 pixel(int x, int y) const;

  private:
    TempDir folder;
    pid_t process = -1;
    int number = -1;
};

/// Fails the test where there is no X server: windows are looked at on every machine.
#define NEEDS_DISPLAY(display) ASSERT_TRUE((display).works()) << "Xvfb is not installed: run ./.install test"

}  // namespace fw::test
