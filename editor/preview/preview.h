// What the graph makes, computed beside the interface.
//
// A thread of its own with a device of its own checks, compiles, meshes and draws. The interface hands over
// the newest wish at any time and takes the newest result when there is one; wishes that were overtaken are
// never drawn to their end. A graph with errors leaves the last good picture, marked as such. While a hand
// holds an input, that input is a live parameter: its changes upload and never compile. Several eyes may look
// at the same mesh (sights.h).
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "editor/preview/sights.h"
#include "graph/compile/compile.h"
#include "graph/compile/effort.h"
#include "runtime/measure/mesh_size.h"
#include "runtime/play/session.h"

namespace fw::editor {

struct PreviewWish {
    std::shared_ptr<const Graph> graph;
    uint64_t revision = 0;              ///< of the graph
    uint64_t document = 0;              ///< another number for another document: nothing of the last is shown
    std::string pinned = {};            ///< the node that is shown; empty: the output
    std::set<std::string> held = {};    ///< "node.input" under the user's hand
    double seconds = 0.0;               ///< on the timeline
    std::optional<Camera> camera = {};  ///< none: the scene's, or the whole solid framed
    int width = 800, height = 600;      ///< pixels
    uint32_t view = RENDER_PICTURE;     ///< or another of shaders/render/render.h
    Slice slice = {};                   ///< of the views on a plane
    float leastWidth = 0.0f;            ///< of the views of widths, metres; 0: the usual one
    int resolution = 0;                 ///< cells along the longest side; 0: the graph's
    bool measures = false;              ///< how large the solid is, is wanted
    std::vector<PreviewEye> others = {};  ///< further pictures of the same
    std::size_t first =
        0;  ///< the one that is drawn before the rest: 0: this one, else of the others, from 1
};

/// What one of the others sees.
struct PreviewSight {
    std::shared_ptr<const Picture> picture;  ///< the same one as long as it is not drawn anew; null: none yet
    Camera seen;
};

struct PreviewStatistics {
    uint32_t vertices = 0, triangles = 0;
    std::vector<StageTime> stages;  ///< of the last mesh and picture
    double milliseconds = 0.0;      ///< from taking the wish to the picture
    uint64_t deviceBytes = 0;
    uint64_t pipelines = 0;               ///< that the device has built so far
    uint64_t submissions = 0, waits = 0;  ///< of a mesh and its first picture
    int resolution = 0;  ///< of this picture's mesh; coarser than asked for while a hand moves
};

struct PreviewResult {
    uint64_t revision = 0;  ///< of the graph that findings are about
    uint64_t document = 0;  ///< as it was asked for
    std::vector<Error> findings = {};
    bool current = false;  ///< the picture shows that graph; otherwise the last that was valid
    Picture picture = {};  ///< empty: none yet; smaller than asked for while a hand moves (detail.h)
    bool draft = false;    ///< of the mesh alone: better ones come when kernels are compiled
    Camera seen = {};      ///< what it was seen by
    std::vector<PreviewSight> others = {};       ///< as those of the wish
    Box region = {};                             ///< that the solid lies in, metres
    std::vector<FieldVolumePtr> particles = {};  ///< their samples, once the picture rests; else none
    std::string spoiledBy = {};                  ///< the node since which the field is no exact distance
    std::map<std::string, NodeExactness, std::less<>> exactness = {};  ///< as Program::nodeExactness
    std::vector<NodeEffort> efforts = {};  ///< effortByNode() of the program, the heaviest sample first
    PreviewStatistics statistics = {};
    std::optional<MeshSize> size = {};  ///< of the whole mesh, once the picture rests, if that is wanted
    std::string failure = {};           ///< the device or the system failed; the next wish begins anew
};

class Preview {
  public:
    /// `changed` is called on the preview's thread whenever there is a new result: to wake the interface.
    explicit Preview(DeviceOptions device, std::function<void()> changed);
    ~Preview();

    void ask(PreviewWish wish);
    /// The newest result, once.
    std::optional<PreviewResult> take();
    /// Whether something is under way that will give a result.
    bool busy() const;
    /// How much is done, from 0 to 1, of the field that is being made of a mesh; nothing if none is.
    std::optional<double> baking() const;
    /// The same of particles' steps up to the time that is asked for.
    std::optional<double> simulating() const;

  private:
    struct Shared;
    std::shared_ptr<Shared> shared;
};

}  // namespace fw::editor
