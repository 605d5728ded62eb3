// The `scene` of a document: how what the graph makes is looked at.
//
//     "scene": {"camera": {"position": [4, 3, 5], "target": [0, 0, 0], "fov": 30}}
//
// Every key may be absent. Without a camera the whole solid is framed from three quarters. Keys that are not
// known here are kept in the document (graph.h) and have no effect. A Scene is a value, read anew for every
// time that tracks of the timeline give the document's scene (timeline.h, sceneAt).
#pragma once

#include <array>
#include <optional>

#include "graph/graph.h"
#include "graph/result.h"

namespace fw {

inline constexpr double kLeastFov = 1.0, kMostFov = 170.0;

struct Camera {
    std::array<double, 3> position{4.0, 3.0, 5.0};  ///< metres
    std::array<double, 3> target{0.0, 0.0, 0.0};    ///< what is in the middle of the picture
    double fov = 30.0;                              ///< degrees, from the bottom of the picture to its top
    bool operator==(const Camera&) const = default;
};

struct Scene {
    std::optional<Camera> camera;
    bool operator==(const Scene&) const = default;
};

/// The scene in this JSON, which is null or an object; `places` are those of its values, for the places of
/// errors (empty if unknown). Errors name the key: what has the wrong form, is not finite or out of range, a
/// camera that stands on its target.
Result<Scene> readScene(const Json& json, const TextPlaces& places = {});

}  // namespace fw
