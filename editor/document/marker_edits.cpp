// The part of key_edits.h about markers and the range.
#include <algorithm>
#include <cmath>

#include "editor/document/key_edits.h"
#include "editor/document/timeline_json.h"

namespace fw::editor {

namespace {

Json* markerOf(Json& json, const Timeline& timeline, std::size_t marker) {
    return marker < timeline.markers.size() ? &json["markers"][marker] : nullptr;
}

}  // namespace

Graph addMarker(const Graph& graph, double time, const std::string& name) {
    if (!(time >= 0.0)) return graph;
    return editedTimeline(graph, [&](Json& json, const Timeline& timeline) {
        for (const Marker& marker : timeline.markers)
            if (std::abs(marker.time - time) <= kSameTime) return;
        member(json, "length", timeline.length);
        member(json, "markers", Json::array()).push_back({{"time", time}, {"name", name}});
    });
}

Graph moveMarker(const Graph& graph, std::size_t marker, double time) {
    return editedTimeline(graph, [&](Json& json, const Timeline& timeline) {
        if (Json* found = markerOf(json, timeline, marker))
            (*found)["time"] = std::clamp(time, 0.0, kMostTimelineLength);
    });
}

Graph renameMarker(const Graph& graph, std::size_t marker, const std::string& name) {
    return editedTimeline(graph, [&](Json& json, const Timeline& timeline) {
        if (Json* found = markerOf(json, timeline, marker)) (*found)["name"] = name;
    });
}

Graph removeMarker(const Graph& graph, std::size_t marker) {
    return editedTimeline(graph, [&](Json& json, const Timeline& timeline) {
        if (!markerOf(json, timeline, marker)) return;
        Json& markers = json["markers"];
        markers.erase(markers.begin() + std::ptrdiff_t(marker));
        if (markers.empty()) json.erase("markers");
    });
}

std::string freshMarkerName(const Timeline& timeline) {
    for (std::size_t i = 1;; ++i) {
        std::string name = "Marker " + std::to_string(i);
        if (std::ranges::find(timeline.markers, name, &Marker::name) == timeline.markers.end()) return name;
    }
}

Graph setRange(const Graph& graph, std::optional<TimeRange> range) {
    return editedTimeline(graph, [&](Json& json, const Timeline& timeline) {
        if (!range) {
            json.erase("range");
            return;
        }
        if (!(range->from >= 0.0 && range->from < range->to)) return;
        member(json, "length", timeline.length);
        json["range"] = {range->from, range->to};
    });
}

}  // namespace fw::editor
