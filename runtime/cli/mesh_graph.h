// What `export`, `render` and `play` begin with: from a graph file to its mesh in device memory or to a
// player, and progress on the terminal.
#pragma once

#include <functional>
#include <future>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "graph/document/unit.h"
#include "runtime/cli/commands.h"
#include "runtime/play/mesh_program.h"
#include "runtime/play/player.h"
#include "runtime/system/clock.h"

namespace fw::cli {

/// Times the stages of a command and shows them on a terminal as they start.
class Progress {
  public:
    Progress();
    ~Progress();

    /// Ends the stage before and starts the next, which is shown as `words`, or as its name.
    void start(const char* name, int percent, const char* words = nullptr);
    /// Shows how far the command is within the stage.
    void show(int percent) const;
    void finish();

    const Clock::time_point begun = Clock::now();
    std::vector<std::pair<std::string, double>> stages;  ///< name and ms of those that have ended

  private:
    bool shown;
    std::string current, words;
    Clock::time_point since;
};

/// A graph's program, and what to mesh of it where.
struct OpenedGraph {
    Device device;
    Program program;
    MeshRequest request;  ///< with its resolution and method
    Box region;
    LengthUnit unit;  ///< the document's
    Graph graph;      ///< with its options' values
};

/// When the device is opened: a plan needs none.
std::launch startOf(const MeshOptions& options);

/// The box of --region; false, and said why, if it has no extent.
bool readRegion(const MeshOptions& options, std::optional<Box>& region);
/// Reads the graph and sees that none of the outputs is among what it reads.
std::optional<Graph> openKept(const MeshOptions& options, int& status);

/// Reads and compiles the graph and opens the device; the stages take the first 20 % of the progress. Failure
/// is told as by meshGraph; so is the end of a plan, with the status kDone.
std::optional<OpenedGraph> openForMesh(const MeshOptions& options, Progress& progress, int& status);

/// Meshes what openForMesh gave.
Result<MeshedProgram> meshOpened(OpenedGraph opened, Progress& progress, bool timed);

/// Shown while pipelines are made.
inline constexpr char kCompiling[] = "compiling for the device";

/// Reads, compiles and meshes; the stages take the first 60 % of the progress. If that cannot be done, says
/// why on standard error and sets `status` to the exit status.
std::optional<MeshedProgram> meshGraph(const MeshOptions& options, Progress& progress, bool timed,
                                       int& status);

/// Reads the graph and makes a player of it, at the options' time; the same of progress and failure. `accept`
/// looks at the graph before anything takes long, and may give an exit status other than kDone. A plan ends
/// there.
std::optional<Player> openPlayer(const MeshOptions& options, Progress& progress, const PlayerOptions& player,
                                 int& status, const std::function<int(const Graph&)>& accept = {});

/// After the device was lost: opens another for the player, and says that it `goesOn`.
void renewDevice(Player& player, const std::string& goesOn);

/// "1280x720" to {1280, 720}. If it is not that, or no picture can have that size, says so for the command.
std::optional<std::pair<int, int>> pictureSize(const char* command, const std::string& text);

/// The error, which came up where it says.
Error in(Error error, const std::string& where);

/// Prints the error with the graph's file; returns the exit status of bad input.
int badInput(const MeshOptions& options, Error error);

}  // namespace fw::cli
