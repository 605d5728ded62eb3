// What `export` and `render` begin with: from a graph file to its mesh in device memory, and progress on the
// terminal.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "runtime/cli/commands.h"
#include "runtime/session.h"

namespace fw::cli {

/// Times the stages of a command and shows them on a terminal as they start.
class Progress {
  public:
    Progress();
    ~Progress();

    /// Ends the stage before and starts the next.
    void start(const char* name, int percent);
    /// Shows how far the command is within the stage.
    void show(int percent) const;
    void finish();

    std::vector<std::pair<std::string, double>> stages;  ///< name and ms of those that have ended

  private:
    bool shown;
    std::string current;
    std::chrono::steady_clock::time_point since;
};

struct MeshedGraph {
    Session session;
    MesherResult mesh;  ///< has triangles
    Box region;         ///< what it was meshed in
};

/// Reads, compiles and meshes; the stages take the first 60 % of the progress. If that cannot be done, says
/// why on standard error and sets `status` to the exit status.
std::optional<MeshedGraph> meshGraph(const MeshOptions& options, Progress& progress, bool timed, int& status);

/// Prints the error with the graph's file; returns the exit status of bad input.
int badInput(const MeshOptions& options, Error error);

/// Says that Ctrl-C was heard; returns the exit status of that.
int stopped();

}  // namespace fw::cli
