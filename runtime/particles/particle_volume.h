// From a density on a grid to the samples of a volume (graph/assets/volume.h), which the field of a program
// reads.
//
// Theory. Of blobs: a particle alone has the density (1 - r^2 / R^2)^3, so that s, the density's cube root,
// tells how far away it is: r = R sqrt(1 - s). Where the threshold's cube root is t, the distance to the
// surface is R (sqrt(1 - s) - sqrt(1 - t)). That is what a sample gets, whatever the particles: right for
// one, and smooth where many meet. Within the solid, s may be above 1: from t on the value goes on as a
// straight line in s. Where t is above 0.9 the ones become t + 0.1, for there a particle alone shows nothing.
// Then values are divided by the length of their gradient where that is above 1, which makes them distances
// to first order at the surface. Other surfaces (particle_surface.h) give distances of some slope: those are
// divided by it too where it is less, but for 0.4 and below.
//
// All of it wants samples near enough: where cells are at most half the radius of a particle's ball, what
// stands between them is within 2 % of it.
//
// No density is left farther than R away. There the value is the distance to the nearest block of 8 x 8 x 8
// samples that has a part of the solid, found between the middles of blocks and lessened by what that may be
// too much: steps along a ray need it, and ambient occlusion.
//
// True distances, for who asks for them, come from the same values: those beside the surface tell its nearest
// points, which sweeps hand on (graph/assets/mesh_field.h). They take several times as long.
//
// Samples at the grid's border are outside, so that what reaches beyond the grid is
// closed there. Of particles beyond the grid only the exact way knows.
//
// Lifetime: kernels serve all volumes; buffers grow.
#pragma once

#include "graph/assets/volume.h"
#include "runtime/particles/particle_surface.h"

namespace fw {

struct ParticleVolumeKernels {
    DensityKernels density;
    SurfaceKernels surface;
    Pipeline level, border, reach, samples, pyramid;
    Pipeline seed, sweep, sweptSamples;  ///< of true distances
};
ParticleVolumeKernels createParticleVolumeKernels(const Device& device);

struct ParticleVolumeBuffers {
    DensityBuffers density;
    Buffer shapes, least, reach[2], nearest;
};

struct ParticleVolumeConfig {
    VolumeGrid grid;
    SurfaceNumbers numbers{.radius = 0.1, .threshold = 0.3, .drop = 0.06};  ///< above 0
    ParticleSurface surface = ParticleSurface::blobs;
    DensityMethod method = DensityMethod::blur;
    bool trueDistance = false;
};

/// Records the samples and blocks of a volume of so many particles (four floats each), into `volumes`: the
/// texels of all volumes of a program, of which `first` is its own first. Errors as recordDensity() and
/// recordSurface(), and that all texels are more than the device can bind.
Done recordParticleVolume(Commands& commands, ParticleVolumeKernels& kernels, ParticleVolumeBuffers& buffers,
                          const ParticleVolumeConfig& config, const Buffer& particles, uint32_t count,
                          const Buffer& volumes, uint32_t first);

/// The volume with its samples, read back from there.
FieldVolumePtr downloadVolume(const Device& device, const FieldVolume& unmade, const Buffer& volumes,
                              uint32_t first);

}  // namespace fw
