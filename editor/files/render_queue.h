// Pictures and sequences that are made beside the interface, one after the other.
//
// A thread of its own with a device of its own does what `fieldwright render` does, with the same functions
// (runtime/pictures): the files have the same bytes. Each wish has the document as it was when it was asked
// for; editing and preview go on meanwhile. A sequence that was cancelled or failed goes on at the frames
// that are not there, and paths of light at those that are kept.
//
// Lifetime: the destructor ends what is under way and waits for its stage; what waits is not begun.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "graph/document/graph.h"
#include "runtime/pictures/sequence.h"

namespace fw::editor {

struct RenderWish {
    std::shared_ptr<const Graph> graph;
    std::string path;  ///< of a still the file, of a sequence the folder
    PictureWish picture = {};
    double seconds = 0.0;                   ///< on the timeline, of a still and of a turntable
    std::optional<FrameRange> frames = {};  ///< of a sequence
    bool turntable = false;                 ///< the frames are of a camera that goes around
    bool overwrite = false;                 ///< frames that are there
    std::optional<Camera> camera = {};      ///< in place of the scene's
    DeviceOptions device = {};              ///< that makes them
};

/// The frames of a wish that has some.
SequenceWish sequenceOf(const RenderWish& wish);

/// How far a wish is, and what came of it.
struct RenderState {
    enum class Phase : unsigned char { waiting, running, done, failed, cancelled } phase = Phase::waiting;
    const char* stage = "waiting";  ///< words for what is being done
    float part = 0.0f;              ///< of the work that lies behind, 0 to 1
    long ready = 0, passed = 0;     ///< frames that there are; those that were there before
    double seconds = 0.0;           ///< that the frames made took, and
    long made = 0;                  ///< how many they are
    bool cancelling = false;        ///< it is to end, and has not yet
    bool again = false;             ///< the device was lost, and opened anew
    /// As it grows, of a sequence that of the last frame; smaller when it has ended.
    std::shared_ptr<const Picture> picture = {};
    std::vector<Error> problems = {};     ///< why it failed
    std::vector<std::string> notes = {};  ///< what to know of what was made
};

struct RenderItem {
    uint64_t id = 0;
    RenderWish wish = {};
    RenderState state = {};
};

class RenderQueue {
  public:
    /// `changed` is called on the queue's thread whenever a state is another: to wake the interface.
    explicit RenderQueue(std::function<void()> changed);
    ~RenderQueue();

    /// It waits until those before it have ended. The item's id: above 0, and no other has it.
    uint64_t add(RenderWish wish);
    /// Ends it, at the latest when its stage ends; nothing if it has ended.
    void cancel(uint64_t id);
    /// It waits anew, if it was cancelled or failed: behind those that wait.
    void goOn(uint64_t id);
    /// Takes it off the list, unless it runs.
    void remove(uint64_t id);
    /// In the order in which they are done.
    std::vector<RenderItem> items() const;
    /// Whether any waits or runs.
    bool busy() const;

  private:
    struct Shared;
    std::unique_ptr<Shared> shared;
};

}  // namespace fw::editor
