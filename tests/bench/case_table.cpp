#include "tests/bench/case_table.h"

#include "runtime/mesher/marching_cubes_table.h"

namespace fw::bench {

const std::array<Case, 256>& caseTable() {
    static const std::array<Case, 256> table = [] {
        std::array<Case, 256> cases;
        for (int pattern = 0; pattern < 256; pattern++) {
            Case& row = cases[pattern];
            const auto add = [&](uint8_t number) {
                const CellEdge edge = cellEdge(number);
                row.edges.at(row.count++) = {uint8_t(edge.corner.x), uint8_t(edge.corner.y),
                                             uint8_t(edge.corner.z), uint8_t(edge.axis)};
            };
            for (const CellPolygon& polygon : cellPolygons(pattern))
                for (std::size_t i = 2; i < polygon.size(); i++)
                    for (uint8_t edge : {polygon[0], polygon[i - 1], polygon[i]}) add(edge);
        }
        return cases;
    }();
    return table;
}

}  // namespace fw::bench
