// Which keys of the timeline are selected: by what their track moves and by their time, so that a selection
// outlives edits that give tracks and keys other indices.
#pragma once

#include <utility>
#include <vector>

#include "editor/document/timeline_edits.h"

namespace fw::editor {

struct SelectedKeys {
    Moved moved;
    std::vector<double> times;  ///< seconds, ascending, one at least
    bool operator==(const SelectedKeys&) const = default;
};

/// A plain value. Times within kSameTime are the same key.
struct KeySelection {
    std::vector<SelectedKeys> tracks;

    bool empty() const { return tracks.empty(); }
    std::size_t size() const;
    /// Of one track; nullptr if none of its keys is selected.
    const std::vector<double>* of(const Moved& moved) const;
    bool contains(const Moved& moved, double time) const;
    void add(const Moved& moved, double time);
    void remove(const Moved& moved, double time);
    void toggle(const Moved& moved, double time);
    void clear() { tracks.clear(); }
    /// The first and the last time. It is not empty.
    std::pair<double, double> span() const;
    /// The one key, if it is one.
    const Moved* single() const { return size() == 1 ? &tracks[0].moved : nullptr; }
    bool operator==(const KeySelection&) const = default;
};

/// Whether the time is among these, which ascend.
bool isAmong(const std::vector<double>& times, double time);
/// Without the keys that the timeline does not have.
KeySelection stillThere(const KeySelection& selection, const Timeline& timeline);
KeySelection allKeys(const Timeline& timeline);
/// The others in place of these.
KeySelection inverted(const KeySelection& selection, const Timeline& timeline);
/// Both.
KeySelection joined(KeySelection a, const KeySelection& b);

}  // namespace fw::editor
