// What leaves a graph many times over, or small: sequences and sweeps beside single exports, compressed
// files.
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/bench/command.h"
#include "tests/bench/tables.h"

namespace fw::bench {
namespace {

constexpr int kSequenceFrames = 24, kVariants = 24;

std::string sample(const std::string& name) {
    return FIELDWRIGHT_BENCH_GRAPHS "/../../../samples/" + name + ".field.json";
}

/// The command's wall clock, ms.
double timed(Bench& bench, std::vector<std::string> words, const std::string& cache) {
    if (!bench.options.device.empty()) words.insert(words.end(), {"--device", bench.options.device});
    const Outcome outcome = runCommand(words, cache);
    if (outcome.status != 0) bench.fail(words[0] + " ended with status " + std::to_string(outcome.status));
    return outcome.milliseconds;
}

/// Of an export with a report: what field, mesh and writing took, ms.
double workOf(Bench& bench, std::vector<std::string> words, const std::string& folder) {
    const std::string report = folder + "/report.json";
    words.insert(words.end(), {"--report", report});
    timed(bench, words, folder + "/warm");
    const nlohmann::json written = nlohmann::json::parse(std::ifstream(report), nullptr, false);
    double work = 0.0;
    if (written.is_object())
        for (const char* stage : {"mesh", "download", "write"}) work += written["stages"].value(stage, 0.0);
    return work;
}

void sequenceTable(Bench& bench, const TemporaryFolder& folder) {
    const std::string graph = sample("moving_booleans"), warm = folder.path + "/warm";
    const std::vector<std::string> all = {"export",       graph, "-o",         folder.path + "/frames",
                                          "--resolution", "128", "--fps",      "24",
                                          "--to",         "1",   "--overwrite"};
    const auto single = [&](int frame) {
        return std::vector<std::string>{"export",       graph, "-o",     folder.path + "/one.glb",
                                        "--resolution", "128", "--time", std::to_string(frame / 24.0)};
    };
    const Figure sequence = measure(bench.options.repeats, [&] { return timed(bench, all, warm); });
    const Figure singles = measure(1, [&] {
        double sum = 0.0;
        for (int frame = 0; frame < kSequenceFrames; ++frame) sum += timed(bench, single(frame), warm);
        return sum;
    });
    std::vector<std::string> first = all;
    first[9] = std::to_string(1.0 / 24.0);
    const Figure start = measure(bench.options.repeats, [&] { return timed(bench, first, warm); });
    double work = 0.0;
    for (int frame = 0; frame < kSequenceFrames; ++frame) work += workOf(bench, single(frame), folder.path);
    const double one = work / kSequenceFrames;
    const double ratio = (sequence.median() - (start.median() - one)) / work;
    print(
        {.title = "A mesh for each of 24 frames of moving_booleans at 128, wall clock",
         .header = {"what", "ms"},
         .rows = {{"the sequence, one process", text(sequence)},
                  {"24 exports of a frame, a process each", text(singles)},
                  {"field, mesh and writing of those 24, as their reports have it", number(work)},
                  {"a sequence of one frame", text(start)}},
         .notes = {"The sequence without its start takes " + number(ratio) +
                   " times what its frames' fields, meshes and files took one by one (at most 1.15 wanted: " +
                   (ratio <= 1.15 ? "met" : "missed") + "); its meshes are written while the next is made."}},
        bench.options.markdown);
}

void sweepTable(Bench& bench, const TemporaryFolder& folder) {
    const std::string warm = folder.path + "/warm";
    const auto sweep = [&](int variants) {
        return std::vector<std::string>{"export",
                                        sample("tower"),
                                        "-o",
                                        folder.path + "/sweep",
                                        "--resolution",
                                        "128",
                                        "--overwrite",
                                        "--sweep",
                                        "tube width=0.05:0.2:" + std::to_string(variants)};
    };
    const Figure all = measure(bench.options.repeats, [&] { return timed(bench, sweep(kVariants), warm); });
    const Figure few = measure(bench.options.repeats, [&] { return timed(bench, sweep(2), warm); });
    const double each = (all.median() - few.median()) / (kVariants - 2);
    print(
        {.title = "A sweep of the width of the tower's tubes at 128, wall clock",
         .header = {"what", "ms"},
         .rows = {{"24 variants", text(all)}, {"2 variants", text(few)}, {"a further variant", number(each)}},
         .notes = {std::string("At most 60 ms for a further variant wanted: ") +
                   (each <= 60 ? "met" : "missed") + "."}},
        bench.options.markdown);
}

void compressTable(Bench& bench, const TemporaryFolder& folder) {
    const std::string plain = folder.path + "/tower.glb", small = folder.path + "/small.glb",
                      warm = folder.path + "/warm";
    const auto words = [&](const std::string& file) {
        return std::vector<std::string>{"export", sample("tower"), "-o", file, "--resolution", "256"};
    };
    std::vector<std::string> compressed = words(small);
    compressed.push_back("--compress");
    const Figure before = measure(bench.options.repeats, [&] { return timed(bench, words(plain), warm); });
    const Figure after = measure(bench.options.repeats, [&] { return timed(bench, compressed, warm); });
    std::error_code missing;
    const double from = double(std::filesystem::file_size(plain, missing)) / 1e6,
                 to = double(std::filesystem::file_size(small, missing)) / 1e6;
    print({.title = "The tower at 256 cells as a GLB, plain and compressed",
           .header = {"file", "MB", "ms"},
           .rows = {{"plain", number(from), text(before)}, {"--compress", number(to), text(after)}},
           .notes = {std::string("At most 4 MB wanted: ") + (to <= 4.0 ? "met" : "missed") + "."}},
          bench.options.markdown);
}

}  // namespace

void exportTable(Bench& bench) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder.path + "/warm");
    sequenceTable(bench, folder);
    sweepTable(bench, folder);
    compressTable(bench, folder);
}

}  // namespace fw::bench
