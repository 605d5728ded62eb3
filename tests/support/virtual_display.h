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
    /// Columns x0 to x1 and rows y0 to y1 of it, the last not included, into this picture; as far as there
    /// are any.
    void look(Picture& into, int x0, int y0, int x1, int y1) const;
    int width() const { return wide; }
    int height() const { return high; }
    /// The colour of a pixel of the screen now.
    glm::ivec3 pixel(int x, int y) const;

  private:
    TempDir folder;
    int wide, high;
    pid_t process = -1;
    int number = -1;
    const unsigned char* memory = nullptr;  ///< the server's own, of the file that the screen is
    std::size_t bytes = 0, first = 0, stride = 0;
};

/// Fails the test where there is no X server: windows are looked at on every machine.
#define NEEDS_DISPLAY(display) ASSERT_TRUE((display).works()) << "Xvfb is not installed: run ./.install test"

}  // namespace fw::test
