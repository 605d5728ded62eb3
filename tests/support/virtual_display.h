// VirtualDisplay: an X server without a screen, for tests of real windows, and the pixels on it.
//
// One server per process and size: it starts with the first display and stays for the later ones, since a
// start takes about as long as a short test. Every display starts clean: no window, no clipboard, no pressed
// key or button, the pointer in the centre. A server that is not clean, or was used by a failed test, is
// ended, and the next display starts a new one.
//
// Displays of one size that live at the same time have servers of their own. Not thread-safe.
#pragma once

#include <gtest/gtest.h>

#include <glm/vec3.hpp>

#include "runtime/render/picture.h"

namespace fw::test {

/// Sleeps.
void rest(double seconds);

struct XServer;

class VirtualDisplay {
  public:
    /// Sets DISPLAY to the server. `width` and `height` in pixels.
    explicit VirtualDisplay(int width = 640, int height = 480);
    VirtualDisplay(const VirtualDisplay&) = delete;
    VirtualDisplay& operator=(const VirtualDisplay&) = delete;
    /// Unsets DISPLAY.
    ~VirtualDisplay();
    /// False if the server could not be started.
    bool works() const { return server != nullptr; }

    /// The whole screen.
    Picture screen() const;
    /// Copies the screen from (x0, y0) up to, but not including, (x1, y1), clamped to the screen.
    void look(Picture& into, int x0, int y0, int x1, int y1) const;
    int width() const { return wide; }
    int height() const { return high; }
    /// The colour of a pixel, 0 to 255.
    glm::ivec3 pixel(int x, int y) const;

    /// Ends the server under its programs, as if it had crashed.
    void endServer();

  private:
    XServer* server = nullptr;  ///< owned by the process
    int wide, high;
};

/// Fails the test if there is no X server.
#define NEEDS_DISPLAY(display) ASSERT_TRUE((display).works()) << "Xvfb is not installed: run ./.install test"

}  // namespace fw::test
