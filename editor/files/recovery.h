// What a crash would take is kept: while a document has unsaved changes, a copy of it lies in the user's
// state folder, and it goes when the document is saved or the editor ends in order.
//
// A copy is a graph file that any Fieldwright opens; its key `recovery` names the file that it is of. Beside
// it lies a lock, which the system gives up when its process dies, however it dies: so what another running
// editor keeps is told from what a dead one left. Copies are written beside the interface's thread.
//
// Lifetime: one Recovery an open document. Its destructor leaves the copy where it is: an exception that ends
// the program passes through it. Who ends in order calls discard().
#pragma once

#include <chrono>
#include <cstdint>
#include <future>
#include <memory>
#include <string>
#include <vector>

#include "graph/base/result.h"
#include "graph/document/graph.h"

namespace fw::editor {

/// Of change until a copy is made at the latest, and of rest after a change until it is made.
inline constexpr double kRecoverySeconds = 15.0, kRecoveryRest = 2.0;

/// $XDG_STATE_HOME/fieldwright/recovery, or under ~/.local/state; empty where neither variable is set.
std::string recoveryFolder();

class Recovery {
  public:
    using Clock = std::chrono::steady_clock;

    /// Keeps copies in this folder, which is made if need be; none if it is empty or cannot be made.
    explicit Recovery(std::string folder = recoveryFolder());
    /// The two change places: of a temporary, what there was before stays where it is, as the destructor has
    /// it.
    Recovery(Recovery&& other) noexcept;
    Recovery& operator=(Recovery&& other) noexcept;
    ~Recovery();

    /// To be called now and then, at least every few seconds while the document changes. Starts to write a
    /// copy if there was none of this revision and the first change that it lacks is kRecoverySeconds old, or
    /// the last one kRecoveryRest;
    /// takes the copy away if nothing is unsaved. Never waits. An Error says why the last copy could not be
    /// written; each is returned once.
    Done keep(const std::shared_ptr<const Graph>& graph, uint64_t revision, bool unsaved,
              Clock::time_point now = Clock::now());
    /// Writes a copy at once: before the program ends because of a failure.
    Done keepNow(const Graph& graph);
    /// Takes the copy away: it is saved, or not wanted.
    void discard();

    /// Where the copy is or will be; empty if none can be.
    const std::string& path() const { return file; }

  private:
    void finish();

    std::string file;  ///< of the copy
    int lock = -1;     ///< of the lock's file
    bool copied = false;
    uint64_t kept = 0;  ///< the revision of the copy
    bool changed = false;
    uint64_t seen = 0;  ///< the last revision
    Clock::time_point changedAt = {}, seenAt = {};
    std::future<Done> writing;
};

/// A copy that a process left which is no more.
struct LeftCopy {
    std::string file;      ///< the copy
    std::string original;  ///< absolute path of the document's file; empty if it had none
    std::string when;      ///< local time at which it was made, "2026-02-28 14:05"
};

/// All that lie in the folder, the newest first.
std::vector<LeftCopy> leftCopies(const std::string& folder = recoveryFolder());
/// The document, as if it had been read from its original file.
Result<Graph> readCopy(const LeftCopy& copy);
/// Removes the copy: it was opened and saved, or is not wanted.
void removeCopy(const LeftCopy& copy);

}  // namespace fw::editor
