// Moving, turning and scaling in the picture: several nodes at once, along other axes than those that their
// numbers count along, about another point than their own. Pure functions on graphs; nothing here draws.
//
// Each selected node is moved by the first node on its way to the picture that has what the tool needs and
// moves it alone; where there is none, a transform is put in the wire ahead of it. A node that another
// selected one moves goes along and is not moved twice.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "editor/viewport/grips.h"

namespace fw::editor {

/// Along which axes handles lie: those that the node's numbers count along, the picture's, or those of the
/// node as it is turned.
enum class AxesOf : unsigned char { numbers, world, own };
/// What turns and scales go about: each node's own place, the middle of all, the origin, or a point.
enum class PivotAt : unsigned char { own, selection, world, point };

/// What moves one of the selected nodes.
struct Placing {
    std::string selected;
    std::string node;                   ///< empty: it is to be added
    std::string place, angles, factor;  ///< its inputs; empty where the tool needs none
    std::optional<Plug> ahead;          ///< of one that is added: the wire that it is put in
    Placement outside;                  ///< from where its numbers count to the picture
    glm::dvec3 at{0.0};                 ///< where it stands in the picture
    glm::dmat3 axes{1.0};               ///< its own in the picture, of unit length
};

std::vector<Placing> placingsOf(const Graph& graph, const std::string& scope,
                                const std::set<std::string>& selection, const std::string& pinned,
                                double seconds, Tool tool);

/// The graph with the nodes that are to be added, which are then named; nothing if there is no room.
std::optional<Graph> withPlacings(const Graph& graph, const std::string& scope,
                                  std::vector<Placing>& placings);

/// In the picture: scaled, then turned, both about a point, or each about its own place, then shifted.
struct Motion {
    glm::dvec3 shift{0.0};
    glm::dmat3 turn{1.0};  ///< a rotation
    double factor = 1.0;
    std::optional<glm::dvec3> about = {};
};
Graph moved(const Graph& graph, const std::string& scope, const std::vector<Placing>& placings,
            const Motion& motion);

/// The one handle of the tool for all of them; there is one at least. `active` is the node whose axes and
/// place count.
Handle handleTogether(const std::vector<Placing>& placings, const std::string& active, Tool tool, AxesOf axes,
                      PivotAt pivot, const glm::dvec3& point);
/// What that handle's numbers mean when an axis of it was dragged.
Motion motionOf(const Handle& handle, int axis, const std::vector<double>& numbers, PivotAt pivot);

/// Places of what else is in the picture: centres, and ends of lengths and boxes; of the first few hundred
/// nodes.
std::vector<glm::dvec3> featuresOf(const Graph& graph, const std::string& scope,
                                   const std::set<std::string>& except, const std::string& pinned,
                                   double seconds);

/// Angles about x, then y, then z, degrees, that turn as the rotation does, nearest to others.
glm::dvec3 anglesOf(const glm::dmat3& rotation, const glm::dvec3& near);

}  // namespace fw::editor
