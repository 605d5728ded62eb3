#include <algorithm>
#include <cmath>

#include "editor/timeline/curves.h"

namespace fw::editor {

namespace {

constexpr float kBend = 4.0f;         // pixels between two points of a bent segment, at the finest
constexpr int kMostOfASegment = 400;  // points

bool before(const Key& key, double time) { return key.time < time; }

/// The segment from key `i` to the next, without its last point.
void addSegment(const Track& track, std::size_t i, std::size_t c, const TimeView& times,
                const ValueView& values, float grain, std::vector<ImVec2>& points) {
    const Key &from = track.keys[i], &to = track.keys[i + 1];
    const float x0 = times.x(from.time), x1 = times.x(to.time);
    points.push_back({x0, values.y(from.value[c])});
    if (from.interpolation == Interpolation::step) {
        points.push_back({x1, values.y(from.value[c])});
        return;
    }
    if (from.interpolation == Interpolation::linear && from.ease == Ease::none) return;
    // What is beyond the sides needs no points.
    const float lo = std::max(x0, times.left), hi = std::min(x1, times.right);
    const int count = std::clamp(int((hi - lo) / std::max(kBend, grain)), 1, kMostOfASegment);
    for (int k = 0; k <= count; ++k) {
        const double time = times.time(lo + (hi - lo) * float(k) / float(count));
        if (time > from.time && time < to.time)
            points.push_back({times.x(time), values.y(evaluate(track, time)[c])});
    }
}

}  // namespace

std::pair<std::size_t, std::size_t> keysSeen(const Track& track, const TimeView& times) {
    const auto begin = track.keys.begin();
    const auto first = std::lower_bound(begin, track.keys.end(), times.from, before);
    const auto last = std::lower_bound(first, track.keys.end(), times.to, before);
    return {std::size_t(first - begin), std::size_t(last - begin)};
}

void curvePoints(const Track& track, std::size_t c, const TimeView& times, const ValueView& values,
                 float grain, std::vector<ImVec2>& points) {
    points.clear();
    auto [first, last] = keysSeen(track, times);
    first = first > 0 ? first - 1 : 0;
    last = std::min(last + 1, track.keys.size());
    if (times.from < track.keys.front().time)
        points.push_back({times.left, values.y(track.keys.front().value[c])});
    for (std::size_t i = first; i + 1 < last; ++i) addSegment(track, i, c, times, values, grain, points);
    if (last > first) {
        const Key& end = track.keys[last - 1];
        points.push_back({times.x(end.time), values.y(end.value[c])});
    }
    if (times.to > track.keys.back().time)
        points.push_back({times.right, values.y(track.keys.back().value[c])});
}

}  // namespace fw::editor
