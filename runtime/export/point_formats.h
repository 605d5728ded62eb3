// The formats of points that take a file of their own to write. Internal to runtime/export.
#pragma once

#include "runtime/export/points.h"
#include "runtime/system/output_file.h"

namespace fw {

/// Legacy VTK, version 3.0 ("VTK File Formats for VTK Version 4.2", Kitware): an unstructured grid of
/// vertices with the vectors `velocity` and the scalars `id`.
void writeVtkPoints(const ParticlePoints& points, OutputFile& file);

/// Houdini's geometry as it was before version 12, "Bgeo" version 5, as partio reads and writes it: points
/// with the attributes `v`, a vector, and `id`, an integer.
void writeBgeoPoints(const ParticlePoints& points, OutputFile& file);

}  // namespace fw
