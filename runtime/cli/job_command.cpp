// `fieldwright job`: a command as the job of an engine that has many machines.
#include <cstdio>
#include <filesystem>
#include <span>

#include "graph/base/own_files.h"
#include "runtime/cli/commands.h"
#include "runtime/jobs/openjd.h"
#include "runtime/jobs/parallel.h"
#include "runtime/jobs/slurm.h"

namespace fw::cli {

namespace fs = std::filesystem;

namespace {

struct JobEngine {
    const char* name;
    Done (*write)(const Job& job, const std::string& folder);
};
constexpr JobEngine kJobEngines[] = {
    {"slurm", writeSlurmJob}, {"openjd", writeOpenJdJob}, {"parallel", writeParallelJob}};

}  // namespace

std::vector<std::string> jobEngines() {
    std::vector<std::string> names;
    for (const JobEngine& engine : kJobEngines) names.emplace_back(engine.name);
    return names;
}

int runJob(const JobOptions& options, const TypedCommand& command, const JobWork& work) {
    Result<Job> job = planJob(command, work, options.sharing, options.folder);
    if (!job) return std::fprintf(stderr, "fieldwright job: %s\n", job.error().message.c_str()), kBadUsage;
    job->program = options.program.empty() ? (programFolder() / "fieldwright").string() : options.program;
    std::error_code failure;
    const bool fresh = !fs::exists(options.folder, failure);
    fs::create_directories(options.folder + (!work.one && work.parts > 1 ? "/parts" : ""), failure);
    if (!fs::is_directory(options.folder))
        return print({.message = "cannot make the folder: " + failure.message(), .file = options.folder}),
               kSystemFailure;
    for (const JobEngine& engine : kJobEngines)
        if (engine.name == options.engine)
            if (const Done written = engine.write(*job, options.folder); !written) {
                if (fresh) fs::remove(options.folder, failure);  // only if it is empty
                return print(written.error()), written.error().file.empty() ? kBadInput : kSystemFailure;
            }
    for (const JobStep& step : job->steps)
        std::fprintf(stderr, "%s: %zu %s\n", step.name.c_str(), step.tasks.size(),
                     step.tasks.size() == 1 ? "task" : "tasks");
    std::printf("%s\n", (fs::path(options.folder) / "submit").c_str());
    return kDone;
}

}  // namespace fw::cli
