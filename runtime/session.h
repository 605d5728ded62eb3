// The one orchestrator: owns the device objects of a program and runs its stages.
//
// Object lifetimes: pipelines per structure (rebuilt only when a program with another structureHash comes),
// buffers per resolution (grown when a mesh needs more), parameters per edit (an upload), images per program
// that samples others, a depth image per picture.
#pragma once

#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "graph/compile.h"
#include "runtime/mesher.h"
#include "runtime/render/render.h"

namespace fw {

/// What to polygonise.
struct MeshRequest {
    std::optional<Box> region;  ///< none: the program's own, else found from the field
    int resolution = 0;         ///< cells along the region's longest side; 0: the program's
};

inline constexpr int kMostResolution = 4096;

class Session {
  public:
    explicit Session(Device device);

    const Device& device() const { return *gpu; }

    /// Makes `program` the one that is meshed. Builds pipelines only if the structure changed; returns
    /// whether it did. Stage times go to `stages`.
    bool setProgram(Program program, std::vector<StageTime>* stages = nullptr);
    const Program& program() const { return current; }

    /// The same without waiting: kernels of a new structure are compiled on a thread of their own. Until they
    /// are there, polygonise() evaluates the field on the host (runtime/mesher_host.h), and its mesh has no
    /// colours.
    void replaceProgram(Program program);
    /// Whether the next polygonise() would do without the program's kernels.
    bool compiling();

    /// Changes a live parameter's value: an upload, never a compile.
    void setParameter(std::size_t slot, double value);

    /// Runs the mesher into device memory. Errors: a region without bounds (the field is unbounded) or with
    /// none left (it is empty), a resolution out of range, and what runMesher refuses.
    Result<MesherResult> polygonise(const MeshRequest& request, bool timed = false);

    /// The last mesh, with the program's material.
    Mesh download(const MesherResult& result) const;
    const MesherBuffers& meshBuffers() const { return buffers; }

    /// A picture of the last mesh, which has a triangle unless the options say what is framed. Errors as
    /// renderPicture.
    Result<Picture> render(const MesherResult& result, const RenderOptions& options);

  private:
    void take(Program program);

    std::unique_ptr<Device> gpu;  ///< stays put when the session moves, for the thread that compiles
    Program current;
    uint64_t builtHash = 0;
    bool built = false;
    MesherPipelines pipelines;
    MesherBuffers buffers;
    MeshGrid grid;
    RenderPipelines renderPipelines;  ///< made by the first picture
    Buffer parameters, images;
    std::future<MesherPipelines> next;  ///< being compiled, for the structure nextHash
    uint64_t nextHash = 0;
};

/// The region that a program is meshed in: the request's, the program's own, or the solid's bounds with a
/// margin of 1.5 cells. Errors as in Session::polygonise.
Result<Box> meshRegion(const Program& program, const MeshRequest& request);

}  // namespace fw
