// Values that are affine in the position, written out: a x + b y + c z + d.
//
// Fields that are moved, turned and scaled one in the other have coordinates of coordinates. Written out,
// each takes six operations at most, however many moves it went through, and no intermediate one is needed.
// Its interval is as tight as can be, since each axis stands in it once (Moore, "Interval Analysis", 1966);
// that of a turn's three steps can be twice as wide.
#pragma once

#include <span>

#include "graph/ir/ir.h"

namespace fw {

/// Writes out what `roots` need of such values, where that takes fewer operations and all numbers in it are
/// known. `roots` are renumbered; what is no longer needed stays until the Ir is compacted.
void writeOutAffine(Ir& ir, std::span<IrId> roots);

}  // namespace fw
