// `fieldwright-bench`, which `fieldwright bench` starts: reads the command line and prints tables.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "graph/base/result.h"
#include "tests/bench/bench.h"

int main(int count, char** arguments) {
    using namespace fw::bench;
    CLI::App app{"Measure this machine: the tables of docs/benchmarks.md", "fieldwright bench"};
    std::vector<std::string> names;
    BenchOptions options;
    std::string tables;
    for (const std::string& name : benchNames()) tables += " " + name;
    app.add_option("TABLE", names, "all (default), or some of:" + tables);
    app.add_flag("--markdown", options.markdown, "Print the tables as the page has them");
    app.add_option("--size", options.sizes, "Cells along an edge (default: each table's own)")
        ->check(CLI::Range(8, 2048));
    app.add_option("--repeats", options.repeats, "Runs that count")
        ->check(CLI::Range(1, 1000))
        ->default_val(options.repeats);
    app.add_option("--rows", options.rows,
                   "Of the table interface these parts alone: start, few nodes, keys, library, one added, "
                   "code, many nodes");
    app.add_option("--device", options.device,
                   "Index or part of the name of the device (see fieldwright info)");
    try {
        app.parse(count, arguments);
    } catch (const CLI::ParseError& error) { return app.exit(error) == 0 ? 0 : 2; }
    try {
        return runBench(names, options);
    } catch (const fw::SystemError& error) {
        std::fprintf(stderr, "fieldwright bench: %s\n", error.what());
        return 3;
    }
}
