// The whole command, as a user starts it: wall clock, where it went, and memory.
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/bench/command.h"
#include "tests/bench/tables.h"

namespace fw::bench {
namespace {

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
        const Outcome outcome = runCommand(command, cache);
        if (outcome.status != 0) bench.fail("export ended with status " + std::to_string(outcome.status));
        return outcome.milliseconds;
    };
    const Figure warmRuns = measure(bench.options.repeats, [&] { return run(warm); });
    const Figure emptyRuns = measure(bench.options.repeats,
                                     [&] { return run(folder.path + "/cold" + std::to_string(coldRuns++)); });
    const uint64_t peak = runCommand(command, warm).peakBytes;
    const uint64_t own = runCommand(driver, warm).peakBytes;

    // The report costs time of its own (it reads the file back), so it comes from a run that is not timed.
    command.insert(command.end(), {"--report", report});
    runCommand(command, warm);
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
