#include "runtime/jobs/parallel.h"

#include "runtime/jobs/task_script.h"
#include "runtime/system/output_file.h"

namespace fw {

namespace {

// One task at a time on each machine: it has all of its processors or its device busy.
constexpr char kRunStep[] = R"(step() {
    list=$1
    shift
    parallel --jobs 1 --workdir . --arg-file "$list" "$@" && return
    echo "$0: the job has failed:" >&2
    [ ! -e failed ] || cat failed >&2
    exit 1
}
)";

}  // namespace

Done writeParallelJob(const Job& job, const std::string& folder) {
    std::string submit =
        "#!/bin/sh\n"
        "# Runs this job by GNU parallel: ./submit [OPTION OF parallel]...\n" +
        std::string(kSubmitBegin) + kRunStep;
    for (const JobStep& step : job.steps) {
        std::string list;
        for (std::size_t i = 0; i < step.tasks.size(); ++i)
            list += "./task " + step.name + " " + std::to_string(i) + "\n";
        Result<OutputFile> file = OutputFile::open(folder + "/" + step.name + ".jobs", nullptr);
        if (!file) return file.error();
        file->write(list);
        if (Done written = file->commit(); !written) return written;
        submit += "step " + step.name + ".jobs \"$@\"\n";
    }
    if (Done written = writeTaskScript(job, folder); !written) return written;
    return writeScript(folder + "/submit", submit);
}

}  // namespace fw
