#include "runtime/jobs/slurm.h"

#include "runtime/jobs/task_script.h"

namespace fw {

namespace {

// What was handed in already is taken back if a later step is refused.
constexpr char kHandIn[] = R"(handed=
hand_in() {
    id=$(sbatch --parsable --chdir="$PWD" "$@") || { [ -z "$handed" ] || scancel $handed; exit 1; }
    id=${id%%;*}
    handed="$handed $id"
}
)";

std::string batchScript(const Job& job, const JobStep& step) {
    const bool many = step.tasks.size() > 1;
    std::string text = "#!/bin/sh\n#SBATCH --job-name=" + job.name + "." + step.name + "\n";
    if (many) text += "#SBATCH --array=0-" + std::to_string(step.tasks.size() - 1) + "\n";
    text += "#SBATCH --output=log/slurm." + step.name + (many ? ".%a" : "") + "\n";
    text += "#SBATCH --open-mode=append\n#SBATCH --requeue\n";
    return text + "exec ./task " + step.name + (many ? " \"$SLURM_ARRAY_TASK_ID\"\n" : " 0\n");
}

}  // namespace

Done writeSlurmJob(const Job& job, const std::string& folder) {
    std::string submit =
        "#!/bin/sh\n"
        "# Hands this job in to Slurm: ./submit [OPTION OF sbatch]...\n" +
        std::string(kSubmitBegin) + kHandIn;
    const char* behind = "";
    for (const JobStep& step : job.steps) {
        const std::string file = step.name + ".sbatch";
        if (const Done written = writeScript(folder + "/" + file, batchScript(job, step)); !written)
            return written;
        submit += "hand_in " + std::string(behind) + "\"$@\" " + file + "\n";
        behind = "--dependency=\"afterok:$id\" --kill-on-invalid-dep=yes ";
    }
    submit +=
        "echo \"handed in:$handed; see squeue. What fails is told in $PWD/failed, what is said in "
        "$PWD/log\"\n";
    if (Done written = writeTaskScript(job, folder); !written) return written;
    return writeScript(folder + "/submit", submit);
}

}  // namespace fw
