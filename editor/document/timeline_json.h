// How edits reach the timeline's JSON, which stays as it is in the file but for what they change.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string_view>

#include "graph/document/timeline.h"

namespace fw::editor {

inline Json& member(Json& object, const char* name, Json otherwise) {
    if (!object.contains(name)) object[name] = std::move(otherwise);
    return object[name];
}

inline Json numbersJson(std::span<const double> numbers) {
    Json json;
    setNumbers(json, {numbers.begin(), numbers.end()});
    return json;
}

inline double timeOf(const Json& key) { return key["time"].get<double>(); }

/// Calls change(json, timeline) with the timeline as it is in the file and as it was read. Not if it cannot
/// be read.
template <class Change>
Graph editedTimeline(const Graph& graph, Change change) {
    const Result<Timeline> timeline = readTimeline(graph);
    if (!timeline) return graph;
    Graph result = graph;
    if (result.timeline->is_null()) result.timeline = Json::object();
    change(*result.timeline, *timeline);
    result.timelinePlaces.list.clear();  // which are counted along the values
    return result;
}

/// Sets a key's choice among the names; one that is what the track's keys have anyway is left out.
void chooseForKey(Json& track, Json& key, const char* name, const std::vector<std::string>& names,
                  std::size_t chosen);

}  // namespace fw::editor
