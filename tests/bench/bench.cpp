#include "tests/bench/bench.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <thread>

#include "graph/document/json.h"
#include "tests/bench/tables.h"

namespace fw::bench {
namespace {

struct NamedTable {
    std::string name;
    void (*print)(Bench&);
};
// Tables of processes come first: the system counts this process's memory at a spawn towards that of the new
// one.
const NamedTable kTables[] = {{"process", processTable},
                              {"export", exportTable},
                              {"large", largeTable},
                              {"mesher", mesherTable},
                              {"prune", pruneTable},
                              {"outlines", outlinesTable},
                              {"implicit3mf", implicit3mfTable},
                              {"lattices", latticesTable},
                              {"splines", splinesTable},
                              {"decimate", decimateTable},
                              {"textures", texturesTable},
                              {"mesh-to-field", meshFieldTable},
                              {"particles", particlesTable},
                              {"talk", talkTable},
                              {"tapes", tapesTable},
                              {"live", liveTable},
                              {"compile", compileTable},
                              {"editor", editorTable},
                              {"interface", interfaceTable},
                              {"light", lightTable},
                              {"serve", serveTable},
                              {"peaks", peaksTable}};

/// The value behind the first "key : value" of a file of such lines; empty if there is none.
std::string lineValue(const char* path, const std::string& key) {
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);)
        if (line.starts_with(key)) return line.substr(std::min(line.size(), line.find(": ") + 2));
    return {};
}

/// The commit of the source tree that this was built in, with a "+" if that has changes; "unknown" without
/// one.
std::string commit() {
    const std::string git = std::string("git -C '") + FIELDWRIGHT_BENCH_GRAPHS + "' ";
    FILE* pipe = popen((git + "describe --always --dirty=+ --exclude='*' 2>/dev/null").c_str(), "r");
    char buffer[64] = "";
    const char* line = pipe ? std::fgets(buffer, sizeof buffer, pipe) : nullptr;
    std::string name = line ? line : "";
    if (pipe) pclose(pipe);
    while (!name.empty() && name.back() == '\n') name.pop_back();
    return name.empty() ? "unknown" : name;
}

/// Device, driver, processor and how busy the machine is: what the figures depend on.
void printConditions(Bench& bench) {
    std::string driver;
    for (const DeviceInfo& info : listDevices())
        if (info.name == bench.device().name()) driver = info.driver;
    std::string load;
    std::ifstream("/proc/loadavg") >> load;
    std::printf(
        "Device: %s (%s). Processor: %s, %u threads. Fieldwright %s, commit %s. Load at the start: %s. "
        "Times are medians (least – greatest) of %d runs after two to warm up, in ms.\n\n",
        bench.device().name().c_str(), driver.c_str(), lineValue("/proc/cpuinfo", "model name").c_str(),
        std::thread::hardware_concurrency(), FIELDWRIGHT_VERSION, commit().c_str(), load.c_str(),
        bench.options.repeats);
}

}  // namespace

const Device& Bench::device() {
    if (!opened) {
        Result<Device> found = createDevice({.pick = options.device});
        if (!found) throw SystemError(found.error().message);
        opened.emplace(std::move(*found));
    }
    return *opened;
}

void Bench::fail(const std::string& problem) {
    failed = true;
    std::fprintf(stderr, "bench: %s\n", problem.c_str());
}

std::optional<Program> benchProgram(Bench& bench, Field field, const CompileOptions& options) {
    const Result<Graph> graph = readGraph(benchGraph(field), nullptr);
    if (!graph) return bench.fail(format(graph.error())), std::nullopt;
    Result<Program> program = compile(*graph, options);
    if (!program) return bench.fail(format(program.error())), std::nullopt;
    return std::move(*program);
}

std::span<const std::string> benchNames() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all;
        for (const NamedTable& table : kTables) all.push_back(table.name);
        return all;
    }();
    return names;
}

int runBench(std::span<const std::string> names, const BenchOptions& options) {
    Bench bench{options};
    // What processTable starts to learn how much memory the driver takes by itself.
    if (names.size() == 1 && names[0] == "driver") return bench.device(), 0;

    const bool all = names.empty() || (names.size() == 1 && names[0] == "all");
    for (const std::string& name : names) {
        if (all || std::ranges::find(benchNames(), name) != benchNames().end()) continue;
        std::string known;
        for (const std::string& other : benchNames()) known += ", " + other;
        std::fprintf(stderr, "bench: no table is named '%s'; there are all%s\n", name.c_str(), known.c_str());
        return 2;
    }
    printConditions(bench);
    for (const NamedTable& table : kTables)
        if (all || std::ranges::find(names, table.name) != names.end()) table.print(bench);
    return bench.failed ? 1 : 0;
}

}  // namespace fw::bench
