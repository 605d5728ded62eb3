// The mesher's kernels by name, and how they are built (see mesher.h).
#pragma once

#include <initializer_list>

#include "runtime/mesher/mesher.h"

namespace fw::mesher {

enum Kernel {
    prune64,
    prune32,
    prune16,
    blocks,
    cull,
    prune8,
    topBricks,
    compact,
    link,
    sample,
    classify,
    classifyDual,
    topGroups,
    topGroupsChunked,
    topGroupsDual,
    triangles,
    patches,
    vertices,
    contour,
    contourListed,
    quads,
    colors,
    kernelCount
};

/// Whether connect() takes the place of the kernels from `link` to `triangles`.
inline bool connectsOnHost(const Device& device, const MesherConfig& config) {
    return config.connectOnHost && device.software && device.unifiedMemory;
}

/// Builds those of `kernels` that are not built yet.
void build(const Device& device, MesherPipelines& pipelines, std::initializer_list<Kernel> kernels,
           CompileTimes* times = nullptr, Compile when = Compile::now);

}  // namespace fw::mesher
