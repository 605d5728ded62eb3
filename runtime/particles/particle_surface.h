// From particles to distances, by two surfaces that are smoother than where a density is some threshold
// (density.h). Both are told by one length, the radius r of the drop that a particle alone makes; particles
// at rest are taken to be on a cubic lattice of the spacing a whose cells are as large as a drop.
//
// Average. After Zhu and Bridson, "Animating Sand as a Fluid" (2005): the distance from the mean place of the
// particles around, weighted by (1 - d^2 / R^2)^3, less r. R = 3.73 r is where a lattice's faces are flat and
// half a spacing before its particles. Between particles that are apart the mean passes through the void.
// Solenthaler, Schläfli and Pajarola, "A Unified Particle Model for Fluid-Solid Interactions" (2007), shrink
// r where the mean moves fast; then two drops have a third in their midst. Here it is seen by the space that
// the particles fill: W particles, the sum of the weights, of the mean square distance V from their mean.
// At the face of a lattice W a^3 / V^(3/2) is 3.4, in a layer of particles 3.5, midway between two that are
// 2 a apart 1.1: from 2 down to 1 the distance becomes that from the nearest particle. A line of particles,
// and a layer, are thinner than a drop: 0.56 a from the axis and 0.5 a from the middle, not 0.62 a, hold
// their volume. W / (1 - m^2 / R^2)^4, m being the distance from the mean, is the same all along a layer's
// normal: 4.2. A drop has 1.1, a line 2.2, a body's face 5.3. r is less by up to 0.16 of itself between 1.2
// and 4.8.
//
// Anisotropic. After Yu and Turk, "Reconstructing Surfaces of Particle-Based Fluids Using Anisotropic
// Kernels" (2010): each particle's centre is drawn by 0.9 of the way to the mean of those around it; its
// kernel is an ellipsoid along the axes of their covariance. Deviations: half axes are as the roots of the
// variances, R where the neighbourhood is full, R = 4.2 r, and at least half of the longest, so that a layer
// of particles is about as thick as they are wide, and at least a lone particle's; weights as above; and from
// few neighbours to many (a sum of weights from 1.5 to 3) there is no jump. The density's threshold is what
// it is half a spacing before a lattice's particles. A particle alone has a height of 1 and a reach of which
// that threshold leaves r; a density counts as the distance at which such a particle has it.
//
// Both are told in blocks of samples that have particles around, but not everywhere: deep inside the value is
// -r, and kernels are those of a full neighbourhood. They are distances of some slope, which
// particle_volume.h divides them by.
//
// Lifetime: kernels serve all; buffers grow.
#pragma once

#include "runtime/particles/density.h"

namespace fw {

struct SurfaceKernels {
    Pipeline blocks, average, shape, anisotropic;
};
SurfaceKernels createSurfaceKernels(const Device& device);

struct SurfaceConfig {
    DensityGrid grid;
    float drop = 1.0f;  ///< r, metres
    ParticleSurface surface = ParticleSurface::average;
};

/// Records each sample's distance, in cells, into buffers.density; `shapes` is scratch memory. `particles` as
/// of recordDensity(). Errors: a radius of 0 or without end; a grid, or more particles, than the device can
/// bind.
Done recordSurface(Commands& commands, const DensityKernels& sorting, const SurfaceKernels& kernels,
                   DensityBuffers& buffers, Buffer& shapes, const SurfaceConfig& config,
                   const Buffer& particles, uint32_t count);

}  // namespace fw
