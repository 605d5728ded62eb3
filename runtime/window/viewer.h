// What a person does at the window of `fieldwright play`, without the window: time that runs, rests or is
// scrubbed, and a camera that orbits. Plain state and functions on it, so that a test can play every key.
#pragma once

#include <string>
#include <vector>

#include "graph/document/scene.h"
#include "graph/document/timeline.h"

namespace fw {

enum class ViewerKey {
    pause,
    back,
    forward,
    start,
    end,
    fullScreen,
    help,
    resetCamera,
    leave,  ///< full screen, or the window
    quit,
};
enum class MouseButton { left, right, middle };

/// One line of the help: the key as people call it, and what it does.
struct KeyHelp {
    const char* key;
    const char* does;
};
const std::vector<KeyHelp>& viewerKeys();

/// A camera on a sphere around a point.
struct Orbit {
    std::array<double, 3> target{};
    double azimuth = 0.0;    ///< radians from +z towards +x
    double elevation = 0.0;  ///< radians from the ground upwards, never quite up or down
    double distance = 1.0;   ///< metres
    double fov = 30.0;       ///< degrees

    static Orbit from(const Camera& camera);
    Camera camera() const;
};

struct Viewer {
    double length = kDefaultTimelineLength;  ///< seconds, of the scrub bar
    Loop loop = Loop::repeat;
    double framesPerSecond = 30.0;
    bool moves = true;  ///< whether there is anything to play

    double seconds = 0.0;
    bool paused = false, fullScreen = false, help = false, closed = false;
    bool ownCamera = false;  ///< rather than the scene's
    Orbit orbit;
    Camera seen;  ///< what the last picture was seen by: where an orbit starts

    int width = 0, height = 0;  ///< of the window, pixels
    bool dirty = true;          ///< something changed that a picture shows

    void resize(int newWidth, int newHeight);
    void key(ViewerKey key);
    /// The mouse is at this pixel, from the top left.
    void move(double x, double y);
    /// A button goes down or up where the mouse was last.
    void press(MouseButton button);
    void release(MouseButton button);
    /// The wheel turned by so many notches, away from the user if positive.
    void scroll(double notches);

    /// Time passes, in seconds, unless it is paused or scrubbed.
    void pass(double elapsed);
    /// The time on the scrub bar, 0 to length.
    double shownTime() const;
    /// Pixels at the window's bottom that the scrub bar takes; 0 if nothing moves.
    int barHeight() const;

  private:
    enum class Drag { none, orbit, pan, scrub };
    void scrubTo(double x);
    void takeCamera();

    Drag drag = Drag::none;
    double lastX = 0.0, lastY = 0.0;
};

}  // namespace fw
