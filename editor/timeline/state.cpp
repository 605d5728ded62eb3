#include "editor/timeline/state.h"

#include <algorithm>
#include <cmath>

namespace fw::editor {

bool TimelineState::shows(const Moved& moved) const {
    return std::ranges::find(hidden, moved) == hidden.end();
}

KeySelection keysInRows(const Timeline& timeline, std::size_t first, std::size_t last, double from,
                        double to) {
    KeySelection found;
    for (std::size_t row = first; row <= last && row < timeline.tracks.size(); ++row)
        for (const Key& key : timeline.tracks[row].keys)
            if (key.time >= from && key.time <= to) found.add(movedBy(timeline.tracks[row]), key.time);
    return found;
}

KeySelection keysInCurves(const Timeline& timeline, const TimelineState& state, double from, double to,
                          double lo, double hi) {
    KeySelection found;
    for (const Track& track : timeline.tracks) {
        const Moved moved = movedBy(track);
        if (!state.shows(moved)) continue;
        for (const Key& key : track.keys)
            if (key.time >= from && key.time <= to &&
                std::ranges::any_of(key.value, [&](double value) { return value >= lo && value <= hi; }))
                found.add(moved, key.time);
    }
    return found;
}

std::optional<std::size_t> keyNear(const Track& track, double time, double reach) {
    std::optional<std::size_t> nearest;
    auto key = std::lower_bound(track.keys.begin(), track.keys.end(), time - reach,
                                [](const Key& each, double t) { return each.time < t; });
    for (; key != track.keys.end() && key->time <= time + reach; ++key) {
        const double off = std::abs(key->time - time);
        if (off <= reach && (!nearest || off <= std::abs(track.keys[*nearest].time - time)))
            nearest = std::size_t(key - track.keys.begin());
    }
    return nearest;
}

std::optional<std::pair<double, double>> valuesShown(const Timeline& timeline, const TimelineState& state) {
    std::optional<std::pair<double, double>> range;
    const bool some = state.onlySelected && !state.selection.empty();
    for (const Track& track : timeline.tracks) {
        const Moved moved = movedBy(track);
        const std::vector<double>* times = state.selection.of(moved);
        if (!state.shows(moved) || (some && !times)) continue;
        for (const Key& key : track.keys) {
            if (some && !isAmong(*times, key.time)) continue;
            for (double value : key.value) {
                if (!range) range = std::pair(value, value);
                range->first = std::min(range->first, value), range->second = std::max(range->second, value);
            }
        }
    }
    return range;
}

std::optional<double> nextTime(std::vector<double> times, double time, int direction) {
    std::ranges::sort(times);
    if (direction < 0) std::ranges::reverse(times);
    for (double each : times)
        if ((each - time) * direction > kSameTime) return each;
    return std::nullopt;
}

}  // namespace fw::editor
