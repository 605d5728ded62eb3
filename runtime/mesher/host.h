// The stages of the mesher that evaluate the field, on the host's threads instead of in compiled kernels.
//
// A new structure takes the driver tenths of a second to compile, a large one minutes; until then, or
// instead, this gives its mesh, from shortened tapes (graph/evaluate/tape.h) at a few times the cost of the
// kernels. The other stages stay on the device, as they are. The mesh is closed and oriented like the
// kernels' own, from the same table; vertices may differ from theirs by rounding, although both compute in
// single precision.
//
// Lifetime: one run of the mesher at a time; what a stage leaves for the next is kept in between.
#pragma once

#include <atomic>
#include <functional>
#include <memory>

#include "graph/evaluate/tape.h"
#include "shaders/shared.h"
// after shared.h
#include "shaders/mesher/mesher.h"

namespace fw {

class MesherHost {
  public:
    /// `root` of `ir` is the distance; `parameters` are the live values in their slots; `color`, if not
    /// empty, the three values of the base colour. The Ir must outlive this.
    MesherHost(const Ir& ir, IrId root, const std::vector<double>& parameters,
               std::span<const IrId> color = {});

    struct Culled {
        std::vector<gpu::uvec2> rows;         ///< as cull.comp writes them
        std::vector<gpu::uvec4> blockCounts;  ///< one a block
    };
    Culled cull(const gpu::MesherPush& push);

    /// Planes of the bricks, nine each, as sample.comp writes them.
    std::vector<gpu::uvec3> sample(const gpu::MesherPush& push, std::span<const uint32_t> brickList);

    /// Vertices in the order of the list, as vertices.comp writes them.
    std::vector<gpu::MeshVertex> vertices(const gpu::MesherPush& push, std::span<const uint32_t> brickList,
                                          std::span<const uint32_t> vertexList);

    bool hasColors() const { return !color.roots.empty(); }
    /// Base colour at each vertex, as colors.comp writes it.
    std::vector<glm::vec3> colors(std::span<const gpu::MeshVertex> at);

  private:
    using Machine = TapeMachine<float>;
    using SharedTape = std::shared_ptr<const Tape>;
    struct Block {
        gpu::uvec3 first;  // sample
        std::vector<SharedTape> bricks =
            std::vector<SharedTape>(512);  // null where culled; x | y << 3 | z << 6
    };

    void parallel(std::size_t count, const std::function<void(Machine&, std::size_t)>& work);
    void descend(Machine& machine, const gpu::MesherPush& push, gpu::uvec3 first, uint32_t size,
                 const SharedTape& tape, Block& block);
    const Tape& tapeOf(const gpu::MesherPush& push, gpu::uvec3 brick) const;
    void samplePlanes(Machine& machine, const gpu::MesherPush& push, gpu::uvec3 brick,
                      gpu::uvec3* planes) const;
    void placeVertices(Machine& machine, const gpu::MesherPush& push, gpu::uvec3 brick,
                       std::span<const uint32_t> vertexList, std::span<const uint32_t> indices,
                       std::span<gpu::MeshVertex> result) const;

    SharedTape field;
    Tape color;
    std::vector<Machine> machines;  // one a thread
    std::vector<Block> blocks;
    std::atomic<int64_t> stepsLeft =
        0;  // that shortened tapes may still take; without room, the box above's serves
};

}  // namespace fw
