// How the live view projects what it sees, and from where it looks, in words.
//
// Orthographic is a very long lens: kParallelFov degrees, moved back by as much, so that what lies at the
// target keeps its size. The rays of a picture are not quite parallel: what lies before the target by half
// of what the picture shows from its bottom to its top is seen larger by 0.9 percent. That is the price of
// one camera for meshes, traced rays, paths of light and shadows; and what is seen can be kept in a file as
// the scene's camera, for which that angle is the least that a file may have. Seen so, a solid as high as
// the picture is some 60 of its heights away: single precision places a surface there to a 40th of a pixel
// or better.
#pragma once

#include <optional>
#include <string>

#include "editor/viewport/orbit.h"
#include "graph/document/graph.h"
#include "graph/document/scene.h"

namespace fw::editor {

inline constexpr double kParallelFov = kLeastFov;  ///< degrees

/// The orbit as a lens of this angle sees it, degrees, from where the target has the same size.
Orbit throughLensOf(Orbit orbit, double fov);
/// Whether an orbit is seen as orthographic views are.
bool isParallel(const Orbit& orbit);

/// From which side it looks; none: from somewhere between.
std::optional<Side> sideOf(const Orbit& orbit);

/// "Front", or "User"; and "orthographic", or "perspective".
std::string wordsOf(const Orbit& orbit, bool orthographic);

struct Viewport;
/// What is looked at from where, for a person: "Front · orthographic", "Scene camera".
std::string wordsOf(const Viewport& viewport, const Graph& graph);

/// 1, 2 or 5 times a power of ten, at least that much, and at most.
double roundUp125(double metres);
double roundDown125(double metres);

}  // namespace fw::editor
