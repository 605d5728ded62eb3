#include "editor/timeline/time_view.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "graph/document/timeline.h"

namespace fw::editor {

namespace {

constexpr double kNotch = 1.2;                             // zoom of a notch of the wheel
constexpr double kShortest = 0.01;                         // seconds that are seen
constexpr double kLongest = 4.0 * kMostTimelineLength;     // the same
constexpr double kLeastValues = 1e-9, kMostValues = 1e12;  // units that are seen
constexpr double kFrameGrain = 1e-3;                       // frames that rounding may be off

/// The smallest of 1, 2, 5 times a power of ten that is not below.
double roundStep(double least) {
    const double decade = std::pow(10.0, std::floor(std::log10(least)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (factor * decade >= least * (1.0 - 1e-9)) return factor * decade;
    return 10.0 * decade;
}

/// So many whole frames between two labels that seconds fall on labels too.
long frameStep(double least, long second) {
    for (long step = 1; step < second; ++step)
        if (second % step == 0 && double(step) >= least) return step;
    return second;
}

bool isWhole(double number) { return std::abs(number - std::round(number)) < kFrameGrain; }

}  // namespace

double TimeView::perPixel() const { return length() / double(std::max(right - left, 1.0f)); }
float TimeView::x(double time) const {
    return left + float((time - from) / std::max(length(), 1e-12) * double(std::max(right - left, 1.0f)));
}
double TimeView::time(float at) const { return from + double(at - left) * perPixel(); }

void TimeView::keepWithin() {
    const double long_ = std::clamp(length(), kShortest, kLongest), least = -0.5 * long_;
    from = std::clamp(from, least, kMostTimelineLength);
    to = from + long_;
}

void TimeView::pan(double pixels) {
    const double by = pixels * perPixel();
    from -= by, to -= by;
    keepWithin();
}

void TimeView::zoom(double notches, float cursor) {
    const double at = time(cursor), share = (at - from) / std::max(length(), 1e-12);
    const double wanted = std::clamp(length() * std::pow(kNotch, -notches), kShortest, kLongest);
    from = at - share * wanted, to = from + wanted;
    keepWithin();
}

void TimeView::show(double first, double last) {
    const double room = std::max(0.04 * (last - first), 0.5 * kShortest);
    from = first - room, to = last + room;
    keepWithin();
}

double ValueView::perPixel() const { return (hi - lo) / double(std::max(bottom - top, 1.0f)); }
float ValueView::y(double value) const {
    const double share = (value - lo) / std::max(hi - lo, 1e-300);
    return bottom - float(std::clamp(share, -1e4, 1e4) * double(std::max(bottom - top, 1.0f)));
}
double ValueView::value(float at) const { return lo + double(bottom - at) * perPixel(); }

void ValueView::pan(double pixels) {
    const double by = pixels * perPixel();
    lo += by, hi += by;
}

void ValueView::zoom(double notches, float cursor) {
    const double at = value(cursor), share = (at - lo) / std::max(hi - lo, 1e-300);
    const double wanted = std::clamp((hi - lo) * std::pow(kNotch, -notches), kLeastValues, kMostValues);
    lo = at - share * wanted, hi = lo + wanted;
}

void ValueView::show(double least, double most) {
    const double room = std::max(0.1 * (most - least), most > least ? kLeastValues : 0.5);
    lo = least - room, hi = most + room;
}

std::optional<long> frameAt(double time, double framesPerSecond) {
    const double frame = time * framesPerSecond;
    if (!isWhole(frame)) return std::nullopt;
    return std::lround(frame);
}

double nearestFrame(double time, double framesPerSecond) {
    return std::round(time * framesPerSecond) / framesPerSecond;
}

std::string timeText(double time, double framesPerSecond, bool frames) {
    char text[64];
    const std::optional<long> frame = frameAt(time, framesPerSecond);
    if (frames && frame) return std::to_string(*frame);
    if (frames) {
        std::snprintf(text, sizeof text, "%.2f", time * framesPerSecond);
        return text;
    }
    if (frame && isWhole(framesPerSecond)) {
        const long second = std::lround(framesPerSecond), seconds = *frame / second, rest = *frame % second;
        std::string words = seconds != 0 || rest == 0 ? std::to_string(seconds) + " s" : "";
        if (rest != 0) words += (words.empty() ? "" : " ") + std::to_string(rest) + " f";
        return words;
    }
    std::snprintf(text, sizeof text, "%.5g s", time);
    return text;
}

std::vector<RulerMark> rulerMarks(const TimeView& view, double framesPerSecond, bool frames, float apart) {
    std::vector<RulerMark> marks;
    if (!(view.length() > 0.0)) return marks;
    const double least = view.perPixel() * double(apart);
    const bool whole = isWhole(framesPerSecond);
    // Steps are counted in frames; of a rate that is not whole there are no frames of a second.
    double step = 0.0, lesser = 0.0;
    if (frames || !whole) {
        step = std::max(roundStep(std::max(least * framesPerSecond, 1.0)), 1.0);
        lesser = step >= 10.0 ? step / 10.0 : 1.0;
        while (!isWhole(lesser)) lesser = std::ceil(lesser);
    } else {
        const long second = std::lround(framesPerSecond);
        if (least <= 1.0) {
            step = double(frameStep(least * framesPerSecond, second));
            lesser = 1.0;
        } else {
            double seconds = roundStep(least);
            if (least > 5.0)
                for (const double round :
                     {10.0, 15.0, 30.0, 60.0, 120.0, 300.0, 600.0, 1800.0, 3600.0, 7200.0, 21600.0, 86400.0})
                    if (seconds = round; round >= least) break;
            step = seconds * double(second);
            lesser = seconds <= 2.0 ? 0.5 * step : step / 5.0;
        }
    }
    if (lesser / framesPerSecond < 4.0 * view.perPixel()) lesser = step;
    const double one = lesser / framesPerSecond;
    const double first = std::max(std::ceil(view.from / one), 0.0);
    for (double i = first; i * one <= view.to; ++i) {
        const double frame = i * lesser;
        RulerMark mark{frame / framesPerSecond, {}};
        if (isWhole(frame / step)) {
            const bool second = whole && isWhole(mark.time);
            mark.label = frames || !whole ? std::to_string(std::lround(frame))
                         : second         ? std::to_string(std::lround(mark.time)) + " s"
                                  : std::to_string(std::lround(frame) % std::lround(framesPerSecond)) + " f";
        }
        marks.push_back(std::move(mark));
    }
    return marks;
}

std::vector<double> gridValues(const ValueView& view, float apart) {
    std::vector<double> values;
    if (!(view.hi > view.lo)) return values;
    const double step = roundStep(view.perPixel() * double(apart));
    for (double i = std::ceil(view.lo / step); i * step <= view.hi && values.size() < 200; ++i)
        values.push_back(i * step == 0.0 ? 0.0 : i * step);
    return values;
}

double snappedTime(double time, double framesPerSecond, const std::vector<double>& markers, double reach,
                   bool freely) {
    if (freely) return time;
    double nearest = nearestFrame(time, framesPerSecond), best = reach;
    for (double marker : markers)
        if (std::abs(marker - time) <= best) best = std::abs(marker - time), nearest = marker;
    return nearest;
}

}  // namespace fw::editor
