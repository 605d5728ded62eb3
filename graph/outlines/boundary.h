// What is painted in the plane, as the one boundary of it all.
//
// Fills may overlap each other and themselves, be wound many times, and be cut by clips. All their arcs are
// parted where they meet; a chain of parts between two such places has the same windings along all of it, so
// that one place beside it tells whether it parts inside from outside. What does is the boundary, with the
// inside to its left; of arcs that lie upon each other one stays. Distances to it are distances to the union,
// never to an edge that another fill covers.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "graph/outlines/arc.h"
#include "graph/outlines/outline.h"
#include "graph/outlines/path.h"

namespace fw {

/// Closed contours that are filled together; of open ones the ends are joined by a line.
struct Fill {
    std::vector<Contour> contours;
    bool evenOdd = false;              ///< else what is wound a number of times other than 0
    std::vector<uint32_t> clips = {};  ///< of the painting: it is inside all of these only
};

struct Painting {
    std::vector<Fill> fills;               ///< their union
    std::vector<std::vector<Fill>> clips;  ///< each the union of its fills
};

/// A painting taken apart. It must outlive this.
class Painted {
  public:
    explicit Painted(const Painting& painting);
    Painted(Painted&&) noexcept;
    ~Painted();

    /// Whether a place is in the painting, counted along a ray.
    bool has(glm::dvec2 p) const;
    /// Plain arcs that together make closed contours; empty if nothing is painted. None if so much crosses or
    /// lies upon each other that to find them would take longer than a second or two.
    std::optional<std::vector<Arc>> boundary() const;

  private:
    struct Inner;
    std::unique_ptr<Inner> inner;
};

/// What is painted as an outline; null if there is nothing. The Error, with a message only, says that it has
/// too many arcs or crossings, after `what` ("the text") and before `remedy`.
Result<OutlinePtr> outlineOf(const Painting& painting, const std::string& what, const std::string& remedy);

}  // namespace fw
