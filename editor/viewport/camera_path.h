// The way of the scene's camera over the timeline, as seen by the viewport's own camera: a line with its keys
// as dots, and the camera at the time shown as a small frustum.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "graph/document/graph.h"
#include "graph/document/scene.h"
#include "graph/document/timeline.h"

namespace fw::editor {

struct CameraPath {
    std::vector<glm::dvec3> line;  ///< places over the timeline; empty if only the target moves
    std::vector<glm::dvec3> keys;  ///< where the keys of its place are
    Camera now;                    ///< at the time shown
};

/// None if no track moves the camera's place or target, or the scene cannot be read.
std::optional<CameraPath> cameraPathOf(const Graph& graph, const Timeline& timeline, double seconds);

/// The eye and the four corners of what it sees at a distance, from the lower left on, in turn.
std::vector<glm::dvec3> frustumOf(const Camera& camera, double aspect, double distance);

struct Editor;
/// Draws the path over the picture where there is one, and says that it is not followed, with a button back.
void showCameraPath(Editor& editor);

}  // namespace fw::editor
