#include "editor/document/key_selection.h"

#include <algorithm>
#include <cmath>

namespace fw::editor {

namespace {

/// The first of the ascending times that may be this one.
template <class Times>
auto firstNear(Times& times, double time) {
    return std::lower_bound(times.begin(), times.end(), time - kSameTime);
}

}  // namespace

bool isAmong(const std::vector<double>& times, double time) {
    const auto at = firstNear(times, time);
    return at != times.end() && *at <= time + kSameTime;
}

std::size_t KeySelection::size() const {
    std::size_t count = 0;
    for (const SelectedKeys& track : tracks) count += track.times.size();
    return count;
}

const std::vector<double>* KeySelection::of(const Moved& moved) const {
    const auto found = std::ranges::find(tracks, moved, &SelectedKeys::moved);
    return found == tracks.end() ? nullptr : &found->times;
}

bool KeySelection::contains(const Moved& moved, double time) const {
    const std::vector<double>* times = of(moved);
    return times && isAmong(*times, time);
}

void KeySelection::add(const Moved& moved, double time) {
    auto found = std::ranges::find(tracks, moved, &SelectedKeys::moved);
    if (found == tracks.end()) {
        tracks.push_back({moved, {time}});
        return;
    }
    if (found->times.back() < time - kSameTime) {
        found->times.push_back(time);
        return;
    }
    if (!isAmong(found->times, time)) found->times.insert(firstNear(found->times, time), time);
}

void KeySelection::remove(const Moved& moved, double time) {
    const auto found = std::ranges::find(tracks, moved, &SelectedKeys::moved);
    if (found == tracks.end()) return;
    std::erase_if(found->times, [&](double each) { return std::abs(each - time) <= kSameTime; });
    if (found->times.empty()) tracks.erase(found);
}

void KeySelection::toggle(const Moved& moved, double time) {
    if (contains(moved, time))
        remove(moved, time);
    else
        add(moved, time);
}

std::pair<double, double> KeySelection::span() const {
    std::pair<double, double> span{tracks[0].times.front(), tracks[0].times.back()};
    for (const SelectedKeys& track : tracks) {
        span.first = std::min(span.first, track.times.front());
        span.second = std::max(span.second, track.times.back());
    }
    return span;
}

KeySelection stillThere(const KeySelection& selection, const Timeline& timeline) {
    KeySelection left;
    for (const Track& track : timeline.tracks) {
        const std::vector<double>* times = selection.of(movedBy(track));
        if (!times) continue;
        std::vector<double> there;
        for (const Key& key : track.keys)
            if (isAmong(*times, key.time)) there.push_back(key.time);
        if (!there.empty()) left.tracks.push_back({movedBy(track), std::move(there)});
    }
    return left;
}

KeySelection allKeys(const Timeline& timeline) {
    KeySelection all;
    for (const Track& track : timeline.tracks)
        for (const Key& key : track.keys) all.add(movedBy(track), key.time);
    return all;
}

KeySelection inverted(const KeySelection& selection, const Timeline& timeline) {
    KeySelection others;
    for (const Track& track : timeline.tracks) {
        const std::vector<double>* times = selection.of(movedBy(track));
        for (const Key& key : track.keys)
            if (!times || !isAmong(*times, key.time)) others.add(movedBy(track), key.time);
    }
    return others;
}

KeySelection joined(KeySelection a, const KeySelection& b) {
    for (const SelectedKeys& track : b.tracks)
        for (double time : track.times) a.add(track.moved, time);
    return a;
}

}  // namespace fw::editor
