// Slurm on this machine alone, in a folder of its own: munged, slurmctld and slurmd, which need root and end
// with it. Nothing of the system's own Slurm is touched.
#pragma once

#include <sys/types.h>

#include <functional>
#include <string>
#include <vector>

#include "tests/support/graph/temp_dir.h"

namespace fw::test {

class SlurmMachine {
  public:
    /// Starts it, and waits until the machine takes jobs.
    SlurmMachine();
    SlurmMachine(const SlurmMachine&) = delete;
    ~SlurmMachine();

    /// Why there can be none here; empty if there can.
    static std::string whyNot();

    /// A command line that talks to it.
    ProgramResult run(const std::string& commandLine) const;
    /// "SLURM_CONF=…", for what hands jobs in.
    std::string environment() const { return "SLURM_CONF=" + folder.path("slurm.conf"); }
    /// Waits until nothing waits or runs any more.
    void waitForAll() const;

  private:
    void start(const std::vector<std::string>& words);

    TempDir folder;
    std::vector<pid_t> daemons;
};

/// Looks again and again, for up to two minutes; whether it came true.
bool comesTrue(const std::function<bool()>& condition);

}  // namespace fw::test
