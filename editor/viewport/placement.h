// Where a node's own space lies in the picture: what the nodes behind it do to what it makes.
//
// No type of node has code here. A node is a placement if its one surface is accompanied by places, angles
// and factors alone: it scales, turns and moves, in this order (tests compare that with what its field does).
// A node whose body never looks its surface up elsewhere leaves it where it is. Any other (a repeat, a twist)
// ends the way: what stands before it has no one place.
#pragma once

#include <glm/mat3x3.hpp>
#include <optional>
#include <span>
#include <string>

#include "editor/document/edits.h"

namespace fw::editor {

// What an input means, by its descriptor.
bool isPlace(const InputSpec& input);   ///< a point or a displacement
bool isAngles(const InputSpec& input);  ///< turns about x, then y, then z, degrees
bool isFactor(const InputSpec& input);  ///< times larger: one, or along each axis
bool isExtent(const InputSpec& input);  ///< lengths along x, y and z

/// Turns by angles about x, then y, then z, degrees.
glm::dmat3 turned(const glm::dvec3& degrees);
/// The numbers as a vector; one stands for three.
glm::dvec3 vectorOf(const std::vector<double>& numbers);

/// From a node's own space to that of the picture.
struct Placement {
    glm::dmat3 linear{1.0};
    glm::dvec3 shift{0.0};
    std::string why = {};  ///< it is not all that happens on the way: why, for a person

    glm::dvec3 of(const glm::dvec3& point) const { return linear * point + shift; }
    /// This one, and then another.
    Placement then(const Placement& next) const { return {next.linear * linear, next.of(shift), next.why}; }
};

/// What one node does to its surface; nothing if that cannot be told.
std::optional<Placement> placementBy(const Node& node);

/// The ids of the nodes that what this node makes passes through, from the next one to what is shown: `last`,
/// or the output of the scope if the scope has no such node. None if it does not get there.
std::optional<NodeIds> wayToShown(const Graph& graph, std::string_view scope, const std::string& node,
                                  const std::string& last);

/// What the nodes of a part of that way do together.
Placement placementAlong(const Graph& graph, std::string_view scope, std::span<const std::string> way);

/// Of a scope in the picture: that of a group is known if it has one instance.
Placement placementOf(const Graph& graph, std::string_view scope, const std::string& pinned);

}  // namespace fw::editor
