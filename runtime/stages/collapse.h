// Fewer triangles over the same vertices: vertices go one by one, each onto a neighbour.
//
// After Garland and Heckbert, "Surface Simplification Using Quadric Error Metrics" (1997): a vertex has the
// quadric of its triangles' planes, and what it costs to let it go is that quadric at the neighbour which
// takes its place and its quadric. Deviations:
//  * A vertex goes onto a neighbour as it is; none is put elsewhere. So what is left has its own place,
//    normal and colour, and only triangles around the one that goes change.
//  * Not one by one from a queue but in rounds: of the cheapest, as many as have no neighbour among them go
//  at
//    once. Each of them leaves the triangles of the others as they are, so a round is checked by all
//    processors, and what it does depends on the mesh alone.
//  * Each collapse is checked by itself, and one that is refused is only left out: the mesh stays closed and
//    manifold (Dey, Edelsbrunner, Guha and Nekhayev, "Topology preserving edge contraction", 1999), no
//    triangle turns over, no part inside out, none cuts another that did not before, whichever else of the
//    round is done.
//    Where all that is near faces one way, that is known without looking at pairs of triangles
//    (near_triangles.h), if the mesh is of a solid: none of its parts is inside twice.
//  * Points of the mesh as it was stay near, and keep their colours (carried_points.h): a border between two
//    colours, or two materials, is not moved farther than they may be away. A vertex on a crease or on a
//    border goes only along it.
//  * If only a number of triangles is wanted, that distance is small at first, and grows as nothing more can
//    go, up to half the mesh's size. Where it has grown to eight edges, or the triangles are hardly
//    fewer for it, creases and borders are in the way: they are given up, and it begins small again.
//  * Where the field is known it is asked at points of each new triangle, more in larger ones.
//
// The same mesh gives the same triangles in every run, for any number of threads. Vertices on borders, on
// edges of more than two triangles, where fans meet at a point, and of triangles with places that are no
// numbers, all stay.
#pragma once

#include <functional>
#include <limits>

#include "runtime/mesh/mesh.h"

namespace fw {

struct CollapseLimits {
    std::size_t triangles = 0;  ///< at which it ends; 0: never for their number
    /// Metres that points of the mesh may be away from it, and that borders of colours may move; of each
    /// vertex what `allowances` has for it, if that is less.
    double distance = std::numeric_limits<double>::infinity();
    std::span<const float> allowances = {};  ///< one a vertex, or none
    /// More points, and how far away each may be.
    struct Further {
        glm::vec3 place;
        float allowance;
        uint32_t triangle;  ///< that is nearest
    };
    std::span<const Further> further = {};
    /// Fills `distances` with the metres from the true surface, if that is known: the most that points of a
    /// new triangle may have is `distance`, or what triangles there had before.
    std::function<void(std::span<const glm::dvec3> points, std::span<double> distances)> fromSurface = {};
    /// Of each vertex: where two differ, there is a border between. Empty: none.
    std::span<const uint32_t> labels = {};
};

/// The triangles that are left, in the order in which they were, over the mesh's vertices.
std::vector<uint32_t> collapse(const Mesh& mesh, const CollapseLimits& limits);

}  // namespace fw
