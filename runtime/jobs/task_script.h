// The script that runs one task of a job, for engines that call shells, and words as a shell reads them.
#pragma once

#include <string_view>

#include "runtime/jobs/job.h"

namespace fw {

/// The word for a shell, whatever is in it.
std::string shellWord(std::string_view word);

/// Writes `folder`/task: called as `./task STEP NUMBER`, tasks being numbered from 0, it runs that one there.
/// What a task says goes to log/STEP.NUMBER, and in the end to standard error; of one that fails the file
/// `failed` tells which and why.
Done writeTaskScript(const Job& job, const std::string& folder);

/// Writes a file that can be run.
Done writeScript(const std::string& path, std::string_view text);

/// How each `submit` begins: in the job's folder, whatever was said of an earlier run gone.
extern const char kSubmitBegin[];

}  // namespace fw
