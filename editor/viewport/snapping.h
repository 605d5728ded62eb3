// Places that a drag may snap to: those that are points, to be found near the mouse.
//
// Pure but for the files of meshes, which are read once and remembered (asset.h).
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "editor/viewport/gizmo.h"
#include "graph/document/graph.h"

namespace fw::editor {

/// Some places, which are projected once for as long as they are looked at in the same way: there may be a
/// million.
class SnapPlaces {
  public:
    explicit SnapPlaces(std::vector<glm::dvec3> places_) : places(std::move(places_)) {}

    /// The one that is seen nearest to the pixel, within `reach` pixels; of some that are seen in nearly the
    /// same place the one before the others.
    std::optional<glm::dvec3> near(const Lens& lens, ImVec2 pixel, float reach);
    std::size_t size() const { return places.size(); }

  private:
    struct Seen {
        float x, y;  ///< pixels
        uint32_t place;
    };
    void project(const Lens& lens);

    std::vector<glm::dvec3> places;
    std::vector<Seen> seen;         ///< by columns, as wide as Column
    std::vector<uint32_t> columns;  ///< where each begins in `seen`
    std::optional<Lens> lens;       ///< that they were projected by
};

/// The vertices of the triangle meshes from files that are in the picture, where they stand there; without
/// those that any of `except` makes or moves. Files that cannot be read are left out: the problems say so.
std::vector<glm::dvec3> meshVertices(const Graph& graph, const std::string& scope,
                                     const std::set<std::string>& except, const std::string& pinned,
                                     double seconds);

}  // namespace fw::editor
