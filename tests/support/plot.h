// Plots of what tests measure, for the documentation: SVG files.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace fw::test {

struct Curve {
    std::string name, color;                        ///< as SVG has it
    std::vector<std::pair<double, double>> points;  ///< x, y
    bool dots = false;                              ///< and no line
};

/// Writes NAME.svg into the folder that FIELDWRIGHT_PLOTS names; does nothing if it names none.
void plot(const std::string& name, const std::string& x, const std::string& y,
          const std::vector<Curve>& curves);

}  // namespace fw::test
