// Single precision: warnings of fields whose numbers are too large or too small for it.
//
// Devices and the mesher compute with floats, of 1.2e-38 to 3.4e38. Numbers beyond these become infinite or
// 0, and the surface is wrong or missing where the field needs them.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "graph/base/box.h"
#include "graph/base/result.h"
#include "graph/compile/program.h"
#include "graph/document/graph.h"

namespace fw {

/// A warning if numbers are too large near the origin, in fields with large factors. `roots`: values of the
/// field; `origins`: nodes, by Ir::origin().
std::optional<Error> largeNumbers(const Graph& graph, const Ir& ir, std::span<const IrId> roots,
                                  std::span<const double> parameters, std::span<const std::string> origins);

/// A warning if the solid within the box is another one in single precision, because numbers are too large or
/// too small. Of fields whose operations may leave its range there, samples are compared in both precisions.
std::optional<Error> precisionLoss(const Graph& graph, const Program& program, const Box& box);

}  // namespace fw
