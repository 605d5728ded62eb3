// A graph that a client has opened: its values and its time, and what is asked of it.
//
// Each method takes the parameters of a request as docs/server.md has them, and gives the answer. Until a
// mesh or a picture is asked for there is no device. From then on a Player with live parameters has the
// graph, so that another value or another time is an upload. `eval` and `export` compile the graph with all
// numbers folded, as the commands do: they give the same numbers and the same bytes.
//
// Lifetime: it owns its device. One thread at a time, but for parameters().
#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <stop_token>
#include <utility>
#include <variant>

#include "graph/evaluate/tape.h"
#include "runtime/play/player.h"
#include "runtime/serve/params.h"
#include "runtime/serve/task.h"

namespace fw::serve {

/// Cells along the longest side, at most: a mesh of more is one for `fieldwright export`, which has tiles.
inline constexpr int kMostServedResolution = 1024;

/// Opens the device of a document. Errors: there is none of that name.
using OpenDevice = std::function<Result<Device>()>;

class Document {
  public:
    explicit Document(OpenDevice openDevice_) : openDevice(std::move(openDevice_)) {}

    /// Reads a file, or the text in the request; may be called again. Faults: what makes it no graph that can
    /// be made.
    Answer open(Params& params, Task& task);
    Answer set(Params& params, Task& task);
    Answer time(Params& params, Task& task);
    Answer check(Params& params, Task& task);
    Answer mesh(Params& params, Task& task);
    Answer picture(Params& params, Task& task);
    Answer eval(Params& params, Task& task);
    Answer measure(Params& params, Task& task);
    Answer exportMesh(Params& params, Task& task);

    using Method = Answer (Document::*)(Params&, Task&);
    /// These but open(), by the names that requests have for them.
    static const std::vector<std::pair<std::string, Method>>& methods();

    /// The field as it is now, for evaluateAll(); until the next call of anything.
    std::variant<const Tape*, Fault> field(Task& task);

    /// Of a device that failed: the next request opens another.
    void dropDevice();

    /// What of it can be set, as it was when the last method ended. From any thread.
    Json parameters() const;

  private:
    bool isOpen() const { return document || player; }
    const Graph& graph() const { return player ? player->graph() : *document; }
    /// The graph that the request names or has in it; the findings of reading it are added.
    std::variant<Graph, Fault> read(Params& params, std::vector<Error>& findings) const;
    /// Has a player of these cells, or of the graph's; 0 and none: as the last time.
    std::optional<Fault> play(int resolution, std::optional<MeshMethod> method, Task& task);
    /// Cells along the longest side, and how they become triangles, as a request asks for it; 0 and none: as
    /// the last time.
    static std::pair<int, std::optional<MeshMethod>> cellsOf(Params& params);
    /// The faults of the parameters, of which these are the last; then play().
    std::optional<Fault> playAs(Params& params, Task& task);
    /// The program with all numbers folded, now.
    Result<Program> folded(Task& task, CompileOptions options = {});
    void changed();
    Json parametersJson() const;

    OpenDevice openDevice;
    std::optional<Graph> document;  ///< until there is a player
    std::map<std::string, std::vector<double>, std::less<>>
        defaults;  ///< what the file says of each parameter
    double seconds = 0.0;
    std::optional<Player> player;
    PlayerOptions playing;
    Picture sketched, lived;   ///< the last ones of a draft and of the live view
    Task* now = nullptr;       ///< whom the player's work is for
    std::stop_token stop;      ///< of that; of work that cannot be cancelled, none
    std::optional<Tape> tape;  ///< of eval: of these values and this time
    mutable std::mutex showing;
    Json shown = Json::array();
};

/// Distances at points of three coordinates each, and, unless these are null, gradients, on all processors;
/// nothing more once it is cancelled.
void evaluateAll(const Tape& tape, const double* points, std::size_t count, double* distances,
                 double* gradients, const std::atomic<bool>& cancelled);

/// Does work on the document; what the device or the system fails by becomes a Fault. A device that was lost
/// is replaced by another, once.
Answer guarded(Document& document, const std::function<Answer()>& work);

}  // namespace fw::serve
