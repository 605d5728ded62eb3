// The curves of a track as lines on the screen: only what is seen. Where there are many keys columns.h has
// what costs less.
#pragma once

#include <imgui.h>

#include <vector>

#include "editor/timeline/time_view.h"
#include "graph/document/timeline.h"

namespace fw::editor {

/// The curve of one component, from the view's left side to its right; beyond its keys it rests. It bends at
/// most every `grain` pixels between two keys.
void curvePoints(const Track& track, std::size_t component, const TimeView& times, const ValueView& values,
                 float grain, std::vector<ImVec2>& points);

/// The keys from the first to the last that a view shows, as indices: first <= i < last.
std::pair<std::size_t, std::size_t> keysSeen(const Track& track, const TimeView& times);

}  // namespace fw::editor
