// A job for GNU parallel: a list of tasks for each step, one after the other, on this machine or by ssh on
// others.
#pragma once

#include "runtime/jobs/job.h"

namespace fw {

/// Writes submit, task and a .jobs for each step into the folder.
Done writeParallelJob(const Job& job, const std::string& folder);

}  // namespace fw
