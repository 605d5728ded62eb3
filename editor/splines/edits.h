// What a hand does to the knots of a spline: functions from knots to knots.
//
// Knots are the numbers of an input of type knots, five each. Of a bezier one every third is a point that it
// goes through, and between two of these lie two handles; handles go where their point goes.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "editor/document/edits.h"
#include "graph/curves/spline.h"

namespace fw::editor::splines {

/// What a spline is drawn by.
struct Knots {
    std::vector<double> numbers = {};
    SplineKind kind = SplineKind::smooth;
    bool closed = false;
    double bend = 0;

    std::size_t count() const { return numbers.size() / 5; }
    glm::dvec3 at(std::size_t knot) const {
        return {numbers[5 * knot], numbers[5 * knot + 1], numbers[5 * knot + 2]};
    }
    bool isHandle(std::size_t knot) const { return kind == SplineKind::bezier && knot % 3 != 0; }
    bool operator==(const Knots&) const = default;
};

/// Those of a node that has an input of type knots; none if it has none, or its numbers are wired.
std::optional<Knots> knotsOf(const Node& node);
/// The input's name; empty if the node's type has none.
std::string knotsInput(const Node& node);

/// The spline, null if it has no length or there is a mistake in its knots.
SplinePtr splineOf(const Knots& knots);

/// With one at another place; a point of a bezier one takes its handles along.
Knots moved(Knots knots, std::size_t knot, const glm::dvec3& place);
/// With a knot on the spline, where it has gone so many metres; its number comes with it. The shape of a
/// bezier one stays as it was. Nothing if it is full.
struct Inserted {
    Knots knots;
    std::size_t knot;
};
std::optional<Inserted> inserted(const Knots& knots, double along);
/// With one more behind the last, or before the first, going on as the spline ends. Nothing if it is closed
/// or full.
std::optional<Inserted> extended(const Knots& knots, bool atEnd);
/// Without this one, of a bezier one with its handles; as it was if fewer than two would be left, or it is a
/// handle.
Knots removed(const Knots& knots, std::size_t knot);

}  // namespace fw::editor::splines
