// Small parts of a mesh that hang together with nothing.
#pragma once

#include "runtime/mesh/mesh.h"

namespace fw {

/// Leaves out the parts of a closed mesh whose volume is less than `least` times that of the largest, 0..1,
/// with the voids in them; voids in what stays stay. The rest keeps its order. Whether there were any.
bool leaveOutCrumbs(Mesh& mesh, double least);

}  // namespace fw
