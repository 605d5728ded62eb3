// Where the charts of a texture lie: packed by their outlines onto a square.
//
// Each chart is turned so that its bounds are least. From the longest on, each is put where it fits lowest,
// between those before too, in one of the four ways to turn it by quarters: cells that it touches, with its
// margin, against cells that are taken, a word of them at a time. (Its lower outline against the upper one of
// all before, as in Lévy, Petitjean, Ray and Maillot 2002, loses what lies between curved charts, half of the
// square.) How many texels a metre has is the most for which all still fit, as far as some tries find it.
//
// What is guaranteed: all charts have the same texels a metre, and between two of them lie at least
// `gutter` texels, between each and the border half as many.
#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <vector>

namespace fw {

/// Flat triangles, three corners each, in metres; counter-clockwise with y up.
struct FlatChart {
    std::vector<glm::vec2> corners;
};

struct Packing {
    float density = 0;                            ///< texels a metre
    int gutter = 0;                               ///< texels
    std::vector<std::vector<glm::vec2>> corners;  ///< of each chart, in texels, as they were, y up
    double covered = 0;                           ///< share of the square
};

/// On `size` x `size` texels. Nothing if there are too many charts for so few texels.
std::optional<Packing> pack(std::span<const FlatChart> charts, int size);

}  // namespace fw
