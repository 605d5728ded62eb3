// The mesher's stages in order, recorded (see mesher.h).
#pragma once

#include "runtime/mesher/mesher.h"

namespace fw::mesher {

bool hasColors(const MesherConfig& config);

/// Records a run of the kernels; with a host for the field it is submitted in parts, in between its work.
void record(Commands& commands, const MesherPipelines& pipelines, const MesherBuffers& buffers,
            const MesherConfig& config, const gpu::MesherPush& push);

}  // namespace fw::mesher
