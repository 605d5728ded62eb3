// What stands in the attributes of SVG files: numbers, lengths, transforms and paths.
#pragma once

#include <optional>
#include <string_view>

#include "graph/outlines/path.h"

namespace fw {

/// Takes a text apart from its front; between any two things may be space and one comma.
struct SvgWords {
    std::string_view rest;

    void skip();  ///< to what comes next
    std::optional<double>
    number();  ///< finite, at most 1e12; none, and nothing is taken, where there is no number
    std::optional<bool> flag();  ///< one digit, 0 or 1
    std::string_view name();     ///< of letters; empty where there is none
    bool take(char c);
};

/// Without the space at both ends.
std::string_view trimmed(std::string_view text);
/// A length in user units; of a share of `whole` where it is in percent.
std::optional<double> lengthIn(std::string_view text, double whole);
/// "translate(…) rotate(…)"; none if it is damaged.
std::optional<PlaneTransform> transformOf(std::string_view text);
/// Draws what a path's `d` says, until there are so many arcs. Whether all of it was understood.
bool drawPath(std::string_view data, Pen& pen, std::size_t mostArcs);

}  // namespace fw
