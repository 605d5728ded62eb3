// Pictures compared with those that were looked at and kept, tests/data/golden/NAME.png.
//
// A picture that differs is written beside the test program, with the difference. After a change that is
// meant, FIELDWRIGHT_UPDATE_GOLDEN=1 keeps the new ones: look at each of them first.
#pragma once

#include <string>

#include "runtime/render/picture.h"

namespace fw::test {

/// What may differ and still be the same picture.
struct Tolerance {
    double mean = 1.5;         ///< of 255, over all channels of all pixels
    double mostStrong = 0.01;  ///< share of the pixels that differ by more than 32 in a channel
};

/// Whether FIELDWRIGHT_UPDATE_GOLDEN is set.
bool remakesGolden();

/// Whether it looks as the kept one.
bool isGolden(const Picture& picture, const std::string& name, const Tolerance& tolerance = {});

/// Expects that it does; keeps it instead if FIELDWRIGHT_UPDATE_GOLDEN is set.
void expectGolden(const Picture& picture, const std::string& name, const Tolerance& tolerance = {});

}  // namespace fw::test
