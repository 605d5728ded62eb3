// The unit of a document's lengths: what 1 is, outside. And what its solid is made of, for its mass.
//
//     "unit": "mm", "density": 1.24
//
// A graph reckons with plain numbers. Formats that fix a unit (glTF: metres, 3MF: millimetres here) have them
// scaled to it, the size of a printed part is judged by it, and lengths are typed and shown in it; nothing
// else in a document depends on it.
#pragma once

#include <optional>

#include "graph/document/graph.h"
#include "graph/library/units.h"

namespace fw {

/// The document's, which is the metre where it says nothing.
const LengthUnit& unitOf(const Graph& graph);
void setUnit(Graph& graph, const LengthUnit& unit);

/// Grams for each cubic centimetre, above 0; none where the document says nothing.
std::optional<double> densityOf(const Graph& graph);
void setDensity(Graph& graph, std::optional<double> density);

}  // namespace fw
