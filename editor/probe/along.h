// A field along a straight line: its values, and where its sign changes.
//
// Crossings are found by intervals: the line is cut in halves as long as the field over a piece may be 0, at
// most kPieces times in all; where the signs at a piece's ends differ, the crossing is nested to the last
// bit. What is thinner than a piece may be missed, nothing else is. What lies between two crossings and is
// negative is a wall, or a part that is solid.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "graph/evaluate/evaluate.h"

namespace fw::editor {

struct Segment {
    Point from{}, to{};  ///< metres, in the picture's space
    double length() const;
    /// So many metres on from its beginning.
    Point at(double metres) const;
    bool operator==(const Segment&) const = default;
};

/// A part of a line on which the field is negative, metres from the line's beginning.
struct Stretch {
    double from = 0.0, to = 0.0;
    double thickness() const { return to - from; }
    bool operator==(const Stretch&) const = default;
};

inline constexpr int kPieces = 4096;  ///< of a line
inline constexpr int kSamples = 513;  ///< of a plot

/// Where the field's sign changes along the line, in order, metres from its beginning.
std::vector<double> crossingsAlong(const Tape& tape, const Segment& line);
/// The parts between crossings on which the field is negative; those that end at the line's own ends are
/// none.
std::vector<Stretch> wallsAlong(const Tape& tape, const Segment& line, std::span<const double> crossings);

/// The solid's wall at a point of its surface: from there inward, against the gradient, until the field is
/// positive again.
struct WallAt {
    Segment line;  ///< through the wall, from the surface to where it ends
    double thickness() const { return line.length(); }
};
/// None if there is no gradient, or the solid does not end within `reach` metres.
std::optional<WallAt> wallAt(const Tape& tape, const Point& surface, double reach);

struct Plot {
    Segment line;
    std::vector<double> places;  ///< metres from the line's beginning
    std::vector<double> values;
    std::vector<double> slopes;  ///< length of the gradient
    std::vector<double> crossings;
    std::vector<Stretch> walls;
};
Plot plotOf(const Tape& tape, const Segment& line);
/// "along,x,y,z,value,gradient", a line each sample.
std::string csvOf(const Plot& plot);

}  // namespace fw::editor
