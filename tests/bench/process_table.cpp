// The whole command, as a user starts it: wall clock, where it went, and memory.
#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/bench/tables.h"

extern char** environ;

namespace fw::bench {
namespace {

struct Outcome {
    int status = 0;           ///< exit status, -1 if it did not exit
    double milliseconds = 0;  ///< wall clock
    uint64_t peakBytes = 0;   ///< greatest resident set, or this process's at the spawn if that was more
};

/// Runs this program with arguments; caches lie in `cache`, standard output is dropped. Watching its memory
/// costs it some time.
Outcome runSelf(std::vector<std::string> arguments, const std::string& cache) {
    arguments.insert(arguments.begin(), "/proc/self/exe");
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);

    std::vector<std::string> variables = {"XDG_CACHE_HOME=" + cache, "MESA_SHADER_CACHE_DIR=" + cache};
    std::vector<char*> environment;
    for (std::string& variable : variables) environment.push_back(variable.data());
    for (char** inherited = environ; *inherited; inherited++) {
        const std::string_view name(*inherited);
        if (!name.starts_with("XDG_CACHE_HOME=") && !name.starts_with("MESA_SHADER_CACHE_DIR="))
            environment.push_back(*inherited);
    }
    environment.push_back(nullptr);

    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    pid_t child = 0;
    const auto start = Clock::now();
    const int error = posix_spawn(&child, argv[0], &files, nullptr, argv.data(), environment.data());
    posix_spawn_file_actions_destroy(&files);
    if (error) throw SystemError("starting " + arguments[0] + " failed");
    int status = 0;
    struct rusage usage;
    if (wait4(child, &status, 0, &usage) != child) throw SystemError("waiting for a process failed");
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, millisecondsSince(start),
            uint64_t(usage.ru_maxrss) * 1024};
}

/// A folder of its own under the system's for temporary files, removed with its content at the end.
struct TemporaryFolder {
    TemporaryFolder() {
        std::string name = std::filesystem::temp_directory_path() / "fieldwright-bench-XXXXXX";
        if (!mkdtemp(name.data())) throw SystemError("making a temporary folder failed");
        path = name;
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path, ignored);
    }
    std::string path;
};

std::string megabytes(double bytes) { return number(bytes / (1 << 20)); }

}  // namespace

void processTable(Bench& bench) {
    TemporaryFolder folder;
    const std::string mesh = folder.path + "/tower.glb", report = folder.path + "/report.json";
    const std::string warm = folder.path + "/warm";
    std::vector<std::string> command = {"export",       benchGraph(Field::tower),
                                        "-o",           mesh,
                                        "--resolution", "256",
                                        "--region",     "-2.5",
                                        "-2.5",         "-2.5",
                                        "2.5",          "2.5",
                                        "2.5"};
    std::vector<std::string> driver = {"bench", "driver"};
    if (!bench.options.device.empty())
        for (auto* arguments : {&command, &driver})
            arguments->insert(arguments->end(), {"--device", bench.options.device});

    int coldRuns = 0;
    const auto run = [&](const std::string& cache) {
        std::filesystem::create_directory(cache);
        const Outcome outcome = runSelf(command, cache);
        if (outcome.status != 0) bench.fail("export ended with status " + std::to_string(outcome.status));
        return outcome.milliseconds;
    };
    const Figure warmRuns = measure(bench.options.repeats, [&] { return run(warm); });
    const Figure emptyRuns = measure(bench.options.repeats,
                                     [&] { return run(folder.path + "/cold" + std::to_string(coldRuns++)); });
    const uint64_t peak = runSelf(command, warm).peakBytes;
    const uint64_t own = runSelf(driver, warm).peakBytes;

    // The report costs time of its own (it reads the file back), so it comes from a run that is not timed.
    command.insert(command.end(), {"--report", report});
    runSelf(command, warm);
    const nlohmann::ordered_json written =
        nlohmann::ordered_json::parse(std::ifstream(report), nullptr, false);
    if (!written.is_object()) return bench.fail("export wrote no report");
    for (const char* fault :
         {"boundaryEdges", "nonManifoldEdges", "nonManifoldVertices", "flippedEdges", "degenerateTriangles"})
        if (written.value(fault, -1) != 0) bench.fail(std::string("the exported tower has ") + fault);

    Table table{
        .title = "The whole command: export of the tower at 256 to GLB, wall clock",
        .header = {"what", "ms"},
        .rows = {{"process, warm caches", text(warmRuns)}, {"process, empty caches", text(emptyRuns)}},
        .notes = {}};
    if (written.contains("stages"))
        for (const auto& [name, ms] : written["stages"].items())
            table.rows.push_back({"· " + name, number(ms.get<double>())});
    table.notes = {
        "Stages are those of one run with warm caches that also wrote a report. The mesh has " +
            count(written.value("vertices", 0)) + " vertices, " + count(written.value("triangles", 0)) +
            " triangles, and is closed.",
        "Peak memory: " + megabytes(double(peak)) +
            " MiB, of which a process that only opens the device takes " + megabytes(double(own)) + ": " +
            megabytes(double(peak) - double(own)) + " MiB beyond the driver's own (at most 250 MB wanted).",
        std::string("Wanted: at most 250 ms warm (") + (warmRuns.median() <= 250 ? "met" : "missed") +
            "), 600 ms empty (" + (emptyRuns.median() <= 600 ? "met" : "missed") + ")."};
    print(table, bench.options.markdown);
}

}  // namespace fw::bench
