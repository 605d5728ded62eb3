// Where times and values are on the screen, and how times are written. Pure: nothing here draws.
//
// Times are seconds, places are pixels of the window. A time that is a frame's is said in whole seconds and
// frames ("5 s 25 f"), or as the frame's number, never as a fraction.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace fw::editor {

/// The times between two pixels.
struct TimeView {
    double from = 0.0, to = 0.0;  ///< seconds at `left` and at `right`; nothing yet if they are equal
    float left = 0.0f, right = 1.0f;

    double length() const { return to - from; }
    double perPixel() const;
    float x(double time) const;
    double time(float at) const;
    void pan(double pixels);
    /// What is under `cursor` stays there; nearer for notches above 0.
    void zoom(double notches, float cursor);
    /// All from the first to the last time, with some room.
    void show(double first, double last);

  private:
    void keepWithin();
};

/// The values between two pixels, the higher ones above.
struct ValueView {
    double lo = 0.0, hi = 0.0;  ///< at `bottom` and at `top`; nothing yet if they are equal
    float top = 0.0f, bottom = 1.0f;

    double perPixel() const;
    float y(double value) const;
    double value(float at) const;
    void pan(double pixels);
    void zoom(double notches, float cursor);
    void show(double least, double most);
};

/// Which frame the time is; none if it lies between two.
std::optional<long> frameAt(double time, double framesPerSecond);
/// The nearest frame's time.
double nearestFrame(double time, double framesPerSecond);
/// "175", "5 s 25 f", "5 s"; between frames "5.8412 s".
std::string timeText(double time, double framesPerSecond, bool frames);

/// A line of the ruler.
struct RulerMark {
    double time = 0.0;
    std::string label;  ///< empty for a lesser one
};
/// Those of the view's times from 0 on, labels at least so many pixels apart.
std::vector<RulerMark> rulerMarks(const TimeView& view, double framesPerSecond, bool frames, float apart);
/// Round values for the lines of a grid at least so many pixels apart.
std::vector<double> gridValues(const ValueView& view, float apart);

/// Where a hand wants the time: on a marker within `reach` seconds, else on a frame; where it is if `freely`.
double snappedTime(double time, double framesPerSecond, const std::vector<double>& markers, double reach,
                   bool freely);

}  // namespace fw::editor
