// What a solid costs whose graph a table writes: to compile, a point on the host, a mesh, and, if asked, a
// sample of its picture. Every call of its text is to be another one, so that no cache knows it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "graph/evaluate/evaluate.h"
#include "tests/bench/tables.h"

namespace fw::bench {

struct SolidToMeasure {
    std::function<std::string(double difference)> text;  ///< the graph
    std::string file = {};                               ///< the file that it would be, where it names others
    std::function<Point(int)> point;                     ///< of the host's
    int cells = 256;
    bool picture = false;
};
struct SolidFigures {
    Program program;
    Figure compiling, sampling;  ///< ms; ns a point
    Figure meshing,
        picturing;  ///< ms; ms a sample of 400 x 300, occlusion and shadows traced through the field
    uint64_t triangles = 0;
};
/// Throws where the graph is none, as a bench has to.
SolidFigures measureSolid(const Bench& bench, const SolidToMeasure& solid);

}  // namespace fw::bench
