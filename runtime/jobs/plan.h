// A command as it was typed becomes a job.
//
// Frames and variants are shared out in runs of consecutive numbers (--frames); one mesh in parts of its
// tiles
// (--tile), which a second step merges. Frames of what is simulated read a cache that the first step writes.
// What is said of all of a sequence, a report, is a last step: the command as it was typed, which finds all
// files there. Anything else is one task.
#pragma once

#include <optional>

#include "runtime/jobs/job.h"

namespace fw {

/// An option, or a word by itself, and what was given to it.
struct TypedOption {
    std::string name;  ///< "--from"; empty: a word by itself
    std::vector<std::string> values = {};
    bool each = false;  ///< the option is repeated for each value
};

struct TypedCommand {
    std::string name;  ///< "export"
    std::vector<TypedOption> options;
};

/// What a command makes.
struct JobWork {
    const char* one = nullptr;  ///< what there is many of: "frame", "variant"; null: one file
    long first = 0, last = 0;   ///< their numbers, first <= n < last
    bool simulates = false;     ///< each would have to simulate what none needs to do again
    long parts = 1;             ///< that the one mesh is to be shared out in
};

/// How it is to be shared out; at most one of them is given.
struct JobSharing {
    std::optional<long> chunk = {};  ///< frames or variants a task
    std::optional<long> tasks = {};  ///< of one mesh: parts
};

/// The job of the command, whose files that only the job knows lie in `folder`. Job::program is left open.
/// Errors: a chunk of one file; more than kMostJobTasks.
Result<Job> planJob(const TypedCommand& command, const JobWork& work, const JobSharing& sharing,
                    const std::string& folder);

}  // namespace fw
