// The unit of a document's lengths: what 1 is, outside.
//
//     "unit": "mm"
//
// A graph reckons with plain numbers. Formats that fix a unit (glTF: metres, 3MF: millimetres here) have them
// scaled to it, and the size of a printed part is judged by it; nothing else in a document depends on it.
#pragma once

#include <span>
#include <string_view>

#include "graph/base/result.h"
#include "graph/document/graph.h"

namespace fw {

struct LengthUnit {
    const char* name;   ///< "mm"
    const char* words;  ///< "millimetres"
    double metres;      ///< in one of it
};

/// All there are, the smallest first.
std::span<const LengthUnit> lengthUnits();
/// That of the name; nullptr if there is none.
const LengthUnit* lengthUnit(std::string_view name);

/// The document's, which is the metre where it says nothing.
const LengthUnit& unitOf(const Graph& graph);
void setUnit(Graph& graph, const LengthUnit& unit);

}  // namespace fw
