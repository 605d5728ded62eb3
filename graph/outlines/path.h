// Paths of lines and curves, as arcs.
//
// A curve becomes pairs of arcs that share its tangents at their ends (biarcs, Bolton 1975): a pair whose
// worst distance from the curve is too great is halved, and the error of a half is an eighth. Where two pairs
// meet the direction is the same, so that an outline is as smooth as its curves are.
//
// Paths are made in the space in which they are drawn, and brought elsewhere as a whole: a stroke is as wide
// as that space says.
#pragma once

#include <array>
#include <functional>
#include <glm/vec2.hpp>
#include <vector>

#include "graph/outlines/arc.h"

namespace fw {

/// Arcs, each of which begins where the one before ends; a closed one ends where it begins.
struct Contour {
    std::vector<Arc> arcs;
    bool closed = false;
};

/// x' = x.x * x + y.x * y + origin.x, and so on.
struct PlaneTransform {
    glm::dvec2 x = {1, 0}, y = {0, 1}, origin = {0, 0};
    glm::dvec2 operator()(glm::dvec2 p) const { return p.x * x + p.y * y + origin; }
    glm::dvec2 direction(glm::dvec2 d) const { return d.x * x + d.y * y; }
    double determinant() const { return cross(x, y); }
};
/// First `inner`, then `outer`.
PlaneTransform operator*(const PlaneTransform& outer, const PlaneTransform& inner);
/// By how much a length grows at most.
double greatestScale(const PlaneTransform& affine);
/// Whether circles stay circles.
bool isSimilarity(const PlaneTransform& affine);

/// Draws paths. Nothing that is no finite number may be given.
class Pen {
  public:
    /// `tolerance`: how far an arc may be from its curve, metres.
    explicit Pen(double tolerance_) : tolerance(tolerance_) {}

    void moveTo(glm::dvec2 p);
    void lineTo(glm::dvec2 p);
    void curveTo(glm::dvec2 control, glm::dvec2 p);                     ///< a quadratic Bézier curve
    void curveTo(glm::dvec2 control, glm::dvec2 second, glm::dvec2 p);  ///< a cubic one
    /// The part of an ellipse, centre + cos(w) u + sin(w) v, between two angles in radians; a line leads
    /// there.
    void ellipse(glm::dvec2 centre, glm::dvec2 u, glm::dvec2 v, double from, double to);
    /// A curve, smooth between two parameters; a line leads to its beginning.
    void along(const std::function<glm::dvec2(double)>& curve, double from, double to);
    void close();  ///< the next begins where this one began, unless the pen is moved

    glm::dvec2 place() const { return at; }
    std::size_t arcs() const { return drawn; }  ///< so far
    /// What was drawn. The pen is as new then.
    std::vector<Contour> taken();

  private:
    friend std::vector<Contour> moved(const std::vector<Contour>&, const PlaneTransform&, double);
    void begin();
    template <class Curve>
    void follow(const Curve& curve, double from, double to, int depth);
    void add(const Arc& arc);

    double tolerance;
    std::size_t drawn = 0;
    glm::dvec2 start{0, 0}, at{0, 0};
    bool down = false;  ///< the last contour goes on
    std::vector<Contour> contours;
};

/// The contours elsewhere. `tolerance` is for arcs that become parts of ellipses.
std::vector<Contour> moved(const std::vector<Contour>& contours, const PlaneTransform& affine,
                           double tolerance);

}  // namespace fw
