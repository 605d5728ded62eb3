// Work that is shared out among machines: what an engine that runs jobs is handed (slurm.h, openjd.h,
// parallel.h), whatever it is called there.
//
// Every task is one command of `fieldwright`, which another machine can begin at any time, and again after it
// was stopped: what it makes is the same bytes, wherever and in whatever order, and of many files those that
// are there are passed over. So a task that an engine kills and hands out again harms nothing. All paths are
// absolute: machines see the same folders by the same names.
#pragma once

#include <string>
#include <vector>

#include "graph/base/result.h"

namespace fw {

struct JobTask {
    std::string name;  ///< what it makes, "frames 0 to 9"
    std::vector<std::string>
        words;  ///< behind the program's name; as many as those of the step's other tasks
};

/// Tasks that may run at once.
struct JobStep {
    std::string name;  ///< small letters
    std::vector<JobTask> tasks = {};
};

struct Job {
    std::string name = {};                ///< letters, digits, - _ and .
    std::string program = {};             ///< `fieldwright` as the machines call it
    std::string graph = {}, output = {};  ///< words of the tasks: the files that they read and make
    bool makesFolder = false;             ///< the output is one
    std::vector<JobStep> steps = {};      ///< each begins when all tasks of the one before it are done
};

/// More tasks of a step are refused: Slurm has arrays of up to 1,001 unless it is told otherwise, lists of an
/// OpenJD template up to 1,024.
inline constexpr long kMostJobTasks = 1000;

}  // namespace fw
