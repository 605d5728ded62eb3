// Edits of the document's scene (graph/document/scene.h). It stays the JSON that it is in the file: keys that
// the program does not know are kept where they are.
#pragma once

#include <string_view>

#include "editor/document/edits.h"
#include "graph/document/scene.h"

namespace fw::editor {

/// The value at a dotted path ("sun.strength", "lights.0.color"). What is missing on the way is made, and a
/// part that is switched on or off by true or false becomes an object. The graph itself if the path leads
/// beyond a list.
Graph setSceneValue(const Graph& graph, std::string_view path, Json value);
/// Without the value at the path: it has its default again.
Graph clearSceneValue(const Graph& graph, std::string_view path);
/// "sun", "sky", "ao", "ground", "fog" or "bloom", on or off. Off is `false`; on is an object that keeps
/// defaults.
Graph switchScene(const Graph& graph, std::string_view part, bool on);

/// The camera; none: the whole solid is framed.
Graph setSceneCamera(const Graph& graph, const std::optional<Camera>& camera);

/// As files have them, in the order of Lamp::Type.
const std::vector<std::string>& lampTypes();
/// A lamp behind the others; the graph itself if there are kMostLights.
Graph addLamp(const Graph& graph, const Lamp& lamp);
/// Without the lamp. Tracks of its values go with it, those of later lamps follow.
Graph removeLamp(const Graph& graph, std::size_t index);

}  // namespace fw::editor
