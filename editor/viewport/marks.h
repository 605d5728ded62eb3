// Lamps, the sun and the scene's camera in the picture: where they are, and what of them can be dragged.
//
// They are shown while the scene's panel is in front, or as wished. One that is clicked has handles as a node
// has them, which edit the scene (document/scene_edits.h): its place, its target, its size, a spot's cone,
// the direction of the sun.
#pragma once

#include <set>

#include "editor/viewport/gizmo.h"
#include "graph/base/box.h"

namespace fw::editor {

struct Mark {
    enum class Look : unsigned char { lamp, sun, camera } look = Look::lamp;
    std::string part;                ///< "sun", "camera", "lights.0": its path in the scene
    std::string name;                ///< for a person
    glm::dvec3 at{0.0};              ///< in the picture
    std::optional<glm::dvec3> to{};  ///< what it shines on or looks at
    glm::dvec3 color{1.0};           ///< linear
};

/// `region` is of the solid: the sun, which is far away, is shown about it.
std::vector<Mark> marksOf(const Scene& scene, const Box& region);
/// What can be dragged of a part of the scene; nothing if there is no such part. `animated` are the paths of
/// the scene that tracks move.
std::vector<Handle> handlesOf(const Scene& scene, const std::string& part, const Box& region,
                              const std::set<std::string>& animated);
/// The document with those numbers of the handle; as it is if its scene would be none.
Graph withSceneNumbers(const Graph& graph, const Handle& handle, const std::vector<double>& numbers);

struct Editor;
bool marksAreShown(const Editor& editor);
/// The scene with its defaults; an empty one if it cannot be read.
Scene sceneNow(const Editor& editor);
/// Whether the mouse is on a mark; a click chooses it.
bool followMarks(Editor& editor);
void showMarks(Editor& editor);

}  // namespace fw::editor
