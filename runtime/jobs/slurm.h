// A job for Slurm: a batch script for each step, an array of its tasks, each behind the one before it.
//
// A step begins when all tasks of the one before it have ended well; if one fails, Slurm drops what depends
// on it (--kill-on-invalid-dep). Tasks may be requeued. Which partition, processors, memory and time they get
// is the machines' owner's to say: ./submit passes what it is given on to sbatch.
#pragma once

#include "runtime/jobs/job.h"

namespace fw {

/// Writes submit, task and a .sbatch for each step into the folder.
Done writeSlurmJob(const Job& job, const std::string& folder);

}  // namespace fw
