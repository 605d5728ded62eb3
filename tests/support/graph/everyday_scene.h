// Random everyday scenes for the brute-force oracle: JSON text of graphs, the same for the same seed.
//
// A scene has two to six solids within 10 m of the origin, in half of the scenes one at the origin. The
// solids are small scenes themselves: shapes that are turned, deformed, repeated, hollowed, blended with
// others, changed by code, or made by groups with inputs. They can overlap. Half of the scenes have
// only plain solids, whose fields mostly stay bounds of the distance. Documents are in metres, centimetres,
// millimetres or inches.
//
// In contrast to randomScene(), every number with a length in it is scaled by the unit with 12 significant
// digits, so that the same seed gives the same solid in each unit, except for rounding.
#pragma once

#include <string>
#include <vector>

#include "tests/support/graph/random_scene.h"

namespace fw::test {

struct EverydayScene {
    uint32_t seed = 0;
    std::string unit = "m";  ///< the document's: "m", "cm", "mm" or "in"
    double perMetre = 1.0;   ///< document units per metre
    std::string json;
    std::vector<SceneAnchor> anchors;  ///< estimates, in document units
};

/// The scene in a random unit: metres in two of five scenes, each other unit in one of five.
EverydayScene everydayScene(uint32_t seed);
/// The same scene in the unit with this name.
EverydayScene everydayScene(uint32_t seed, const std::string& unit);

/// The cube around the anchors, which should contain the whole solid.
Box boxAround(const EverydayScene& scene);

}  // namespace fw::test
