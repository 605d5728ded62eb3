// The one orchestrator: owns the device objects of a program and runs its stages.
//
// Object lifetimes: pipelines per structure (rebuilt only when a program with another structureHash comes),
// buffers per resolution (grown when a mesh needs more), parameters per edit (an upload), images and volumes
// of the field per program that samples others, the renderer's images per size of a picture.
#pragma once

#include <future>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "graph/compile/compile.h"
#include "runtime/mesh/materials.h"
#include "runtime/mesher/mesher.h"
#include "runtime/particles/particle_fields.h"
#include "runtime/play/step_constant.h"
#include "runtime/render/renderer.h"
#include "runtime/stages/mesh_stages.h"

namespace fw {

/// What to polygonise.
struct MeshRequest {
    std::optional<Box> region;              ///< none: the program's own, else found from the field
    int resolution = 0;                     ///< cells along the region's longest side; 0: the program's
    std::optional<MeshMethod> method = {};  ///< none: the program's
    bool stages = true;                     ///< also what the program does to the mesh then
    MesherTile tile = {};                   ///< of the region's grid; the whole by default
};

/// The cells of a region.
struct CellGrid {
    glm::vec3 origin, cellSize;  ///< metres
    glm::ivec3 cells;
};

/// So many cells along the region's longest side, as near to cubes as whole numbers of them along each side
/// allow. Errors: a resolution out of range, a region too small or too large for single precision.
Result<CellGrid> cellGrid(const Box& region, int resolution);

inline constexpr int kMostResolution = 4096;

/// Translates kernels of the program, if it will have some, while the device is not yet open:
/// prepareMesher().
void prepareKernels(const Program& program, const std::function<bool()>& goOn);

/// Kernels that are compiled behind take at most so long: the device is busy with them, and the next
/// structure waits.
inline constexpr double kMostSecondsBehind = 20;

/// Who evaluates a program's field: kernels that the driver compiles, with light that they trace through the
/// field; or tapes on the host, with pictures that are drafts (runtime/render/draft.h).
enum class FieldBy {
    sooner,   ///< kernels, but of a field whose code keeps the driver longer than tapes take for a mesh:
              ///< tapes; and pictures are drafts too of a field that a software device would trace for long
    kernels,  ///< however long the driver takes
    tapes,
};

class Session {
  public:
    explicit Session(Device device, FieldBy by = FieldBy::sooner);

    const Device& device() const { return *gpu; }
    /// The device again, of a session that has had no program. It is at its end.
    Device release() { return std::move(*gpu); }

    /// Makes `program` the one that is meshed. Builds pipelines only if the structure changed and tapes are
    /// not sooner done; returns whether it did. Stage times go to `stages`.
    bool setProgram(Program program, std::vector<StageTime>* stages = nullptr);
    const Program& program() const { return current; }

    /// The same without waiting: kernels of a new structure are compiled on a thread of their own. Until they
    /// are there, polygonise() evaluates the field on the host (runtime/mesher/host.h); then the renderer's
    /// are compiled, and until those are there pictures are drafts. `kernels` says which of them are wanted.
    /// Those that would keep a thread busy for more than kMostSecondsBehind are not compiled at all.
    void replaceProgram(Program program, const FieldKernelOptions& kernels = {});
    /// Whether the next polygonise() would do without the program's kernels until they are there.
    bool compiling();
    /// Whether the next polygonise() of a program that came by replaceProgram() does without kernels, for now
    /// or for good.
    bool meshesOnHost();
    /// Whether the next picture would be a draft until the program's kernels are there.
    bool drafting();
    /// Whether the last mesh came from tapes.
    bool byTapes() const { return tapes; }
    /// Why pictures of the last mesh stay drafts, as a clause; "" if they do not.
    std::string whyDraft();

    /// Changes a live parameter's value: an upload, never a compile.
    void setParameter(std::size_t slot, double value);

    /// Brings the program's particles to a time, if it has some; `values` are the live parameters' then.
    /// Without `surfaces` the field has none of theirs, for the pictures that showsParticles(). Returns
    /// whether the field changed with that. Errors as ParticleFields::make().
    Result<bool> simulate(double seconds, const ValuesAt& values, bool surfaces = true,
                          const std::function<bool(int done, int all)>& progress = {});
    /// Of live values that were changed otherwise than by the time: Simulation::valuesChanged().
    void valuesChanged();
    /// The samples of its particles as they were made last, for the host: of each of the program's volumes
    /// that has some.
    std::vector<FieldVolumePtr> particleVolumes() const;
    /// The program with those, for the host to evaluate.
    Program onHost() const;
    uint64_t particleSlots() const { return particles ? particles->slots() : 0; }

    /// Runs the mesher into device memory, and then the program's stages. Errors: a region without bounds
    /// (the field is unbounded) or with none left (it is empty), a resolution out of range, and what
    /// runMesher and runMeshStages refuse.
    Result<MesherResult> polygonise(const MeshRequest& request, bool timed = false);

    /// The program's base colour and material. What is not the same everywhere is the default.
    glm::vec3 baseColor() const;
    Material material() const;

    /// The last mesh, with the program's material. Where it has sharp edges, vertices on them are doubled.
    /// With `parts`, where the material varies, each part of the mesh has its own (partByMaterial).
    Mesh download(const MesherResult& result, MaterialParts parts = MaterialParts::none) const;
    /// The last mesh and coarser levels of it, up to so many in all (stages/levels_of_detail.h); as
    /// download().
    std::vector<Mesh> downloadLevels(const MesherResult& result, std::size_t levels,
                                     MaterialParts parts = MaterialParts::none) const;
    const MesherBuffers& meshBuffers() const { return buffers; }
    /// Another number if mesh or field differ from what they were at another.
    uint64_t contentNumber() const { return content; }
    /// Gives the last mesh's memory back.
    void dropMesh();

    /// A still picture of the last mesh, whose points are framed unless the options say otherwise. Errors as
    /// renderPicture.
    Result<Picture> render(const MesherResult& result, const RenderOptions& options);
    /// The live view's next frame, into picture() and, if one is given, the host's. False if it would be the
    /// same as the last. Errors as renderLive.
    Result<bool> renderLive(const MesherResult& result, const RenderOptions& options, Picture* onHost);
    /// A frame of the mesh alone, drawn by a renderer of its own: the live view goes on as if it had not been
    /// asked for. Not of views that showsField() or of ambient occlusion. False and errors as renderLive().
    Result<bool> sketch(const MesherResult& result, const RenderOptions& options, Picture& onHost);
    /// The last picture on the device, R32_UINT; none before the first.
    const Image* picture() const;

    ~Session();
    Session(Session&&) = default;
    /// What it had goes first, and its device last.
    Session& operator=(Session&& other) noexcept;

  private:
    void take(Program program);
    /// What download() does to a mesh as it lies on the device.
    Mesh finished(Mesh mesh, bool creases, MaterialParts parts) const;
    void dropRenderer();
    /// Of the surface, if it is the same everywhere, else of the default material.
    float constant(int component) const;
    glm::vec3 constantVector(int component) const;
    FieldBuffers fieldBuffers() const {
        return {
            .parameters = &parameters, .images = &images, .volumes = &volumes, .before = &parametersBefore};
    }
    /// Of the node that gave the whole surface its material; empty if that is not one.
    std::string materialName() const;
    /// As those of the frame before the next one.
    void rememberParameters();
    bool hasMesherKernels() const { return built && builtHash == current.structureHash; }
    bool tapesAreSooner(int resolution) const;
    /// Of its field at a point, in additions.
    double weightOfCode();
    /// Whether a software device would trace light through the field, of which there is a mesh, for long.
    bool isTracedForLong();
    /// Whether kernels that are wanted behind are not worth their wait.
    bool beyondDriver() const;
    void buildKernels(std::vector<StageTime>* stages);
    /// What the program does to the mesh that was made in `region`; `program` is what the host evaluates, if
    /// it has the kernels' part.
    Done runStages(MesherResult& result, const Box& region, const Program* onHost, bool timed);
    enum class Quality { sketch, live, still };
    /// The Lipschitz constant by which rays step in a picture of this quality; infinite if none is known.
    double stepConstant(Quality quality);
    /// Calls draw(renderer, scene, options) with the mesh's points for what the options leave open.
    template <class Draw>
    auto draw(const MesherResult& result, RenderOptions options, Draw draw, Quality quality)
        -> decltype(draw(std::declval<Renderer&>(), std::declval<RenderScene&>(), options));

    std::unique_ptr<Device> gpu;  ///< stays put when the session moves, for the thread that compiles
    FieldBy by;
    bool tapes = false;                   // the last mesh came from them
    double secondsTraced = 0;             // as secondsToTrace(),
    std::optional<uint64_t> weighedHash;  // of this structure
    double codeAdditions = 0;             // as codeWeight(),
    std::optional<uint64_t> codedHash;    // of this structure
    StepConstant stepConstants;
    std::optional<uint64_t> liveContent;  // content number of the last live frame
    int liveFrames = 0;                   // with that number, less one
    bool steppedByConstant = false;       // that frame had a known step constant
    Program current;
    uint64_t builtHash = 0;
    bool built = false;
    MesherPipelines pipelines;
    MesherBuffers buffers;
    std::optional<MeshStagePipelines> stagePipelines;  ///< made by the first program that has stages
    uint64_t projectionHash = 0;                       ///< structure that its `project` belongs to
    MeshStageBuffers stageBuffers;
    MeshGrid grid;
    std::optional<Renderer> renderer;  ///< made by the first picture
    std::optional<Renderer> sketcher;  ///< made by the first sketch; it has no field
    Image lastPicture;                 ///< of the renderer before, which had another field
    uint64_t content = 0;              ///< counts changes of mesh and parameters
    Buffer parameters, images, volumes;
    Buffer parametersBefore;                  ///< of the live view's last frame, or of a still
    std::optional<ParticleFields> particles;  ///< of a program that has some
    std::future<MesherPipelines> next;        ///< being compiled, for the structure nextHash
    uint64_t nextHash = 0;
    /// Of the renderer: compiled behind, those there are, and those being compiled.
    bool kernelsBehind = false;
    FieldKernelOptions kernelOptions;
    uint64_t kernelsHash = 0, nextKernelsHash = 0;
    bool hasKernels = false;
    std::future<std::optional<FieldKernels>> nextKernels;
    std::shared_ptr<std::atomic<bool>> overtaken;  ///< ends what nextKernels does
};

struct RegionContext {
    /// That the program was compiled from; null: errors do not name the node that is unbounded.
    const Graph* graph = nullptr;
    double time = 0.0;          ///< on the graph's timeline, seconds
    std::stop_token stop = {};  ///< ends the search; the error is then cancelledError()
};

/// The context of a graph at `seconds` after its start.
RegionContext regionContext(const Graph& graph, double seconds, std::stop_token stop = {});

/// The region that a program is meshed in: the request's, the program's own, or the solid's bounds with a
/// margin of 1.5 cells. Errors as in Session::polygonise, and cancelledError().
Result<Box> meshRegion(const Program& program, const MeshRequest& request, const RegionContext& context = {});

/// Why a solid has no region: it is empty, unbounded, or cannot be proven bounded. `found` is the result of
/// findRegion() and not bounded.
Error regionError(const Program& program, const Region& found, const RegionContext& context);

}  // namespace fw
