// One export to a mesh file, or of the field itself as functions, made beside the interface.
//
// A thread of its own with a device of its own does what `fieldwright export` does, with the same functions,
// so that the file has the same bytes, in tiles too where that is the way; editing and preview go on
// meanwhile. The mesh is measured before it is in its place: until its last moment a cancelled export leaves
// no file and a file that stood there is as it was.
//
// Lifetime: a job is one export. Its destructor cancels it and waits for the stage under way to end.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "graph/document/graph.h"
#include "runtime/files/mesh_wish.h"
#include "runtime/measure/mesh_report.h"
#include "runtime/play/session.h"

namespace fw::editor {

struct ExportWish {
    std::shared_ptr<const Graph> graph;
    std::string path;           ///< of the mesh file; its ending says the format
    MeshRequest mesh = {};      ///< as of `fieldwright export`: what is left out is found
    double seconds = 0.0;       ///< on the timeline
    MeshWish file = {};         ///< what the file is to be like
    int triangles = 0;          ///< at most; 0: as many as there are
    bool functions = false;     ///< the field itself goes into the file, in place of a mesh: as --implicit
    DeviceOptions device = {};  ///< that meshes
};

/// How far an export is, and what came of it.
struct ExportState {
    enum class Phase : unsigned char { running, done, failed, cancelled } phase = Phase::running;
    const char* stage = "waiting";     ///< words for what is being done
    float part = 0.0f;                 ///< of the work that lies behind, 0 to 1
    bool again = false;                ///< it began again, since the device was lost
    std::vector<Error> problems = {};  ///< why it failed
    ExportedFiles files = {};          ///< that were written
    Report report = {};                ///< measured from the mesh, the finest of its levels of detail, in the
                                       ///< document's unit; with what it took and the device
    bool measured = true;              ///< if not, the report has but counts: there was no memory for more
    bool tiled = false;                ///< it was meshed in tiles
    std::size_t functions = 0;         ///< nodes of those in the file; 0: it has a mesh
    std::vector<Error> notes = {};     ///< what of the solid the functions lack
};

class ExportJob {
  public:
    /// `changed` is called on the job's thread whenever the state is another: to wake the interface.
    ExportJob(ExportWish wish, std::function<void()> changed);
    ~ExportJob();

    /// Ends it, at the latest when the stage under way ends.
    void cancel();
    bool cancelling() const;
    ExportState state() const;

  private:
    struct Shared;
    std::unique_ptr<Shared> shared;
};

}  // namespace fw::editor
