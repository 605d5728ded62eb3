// The benchmark behind `fieldwright bench`: tables on standard output, every mesh that is timed also checked.
//
// Each figure is the median of several runs after a warm-up, with the least and the greatest beside it; both
// sides of a ratio are measured in this process, one after the other. docs/benchmarks.md is `fieldwright
// bench all --markdown`.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace fw::bench {

struct BenchOptions {
    std::string device;           ///< as DeviceOptions::pick
    bool markdown = false;        ///< tables as docs/benchmarks.md has them; else aligned text
    std::vector<int> sizes = {};  ///< cells along an edge; empty: each table's own
    int repeats = 7;              ///< runs that count, at least 1
    std::string rows = {};        ///< of the interface's table those parts alone that have these words
};

/// The tables there are, in the order of the page: "process", "mesher", "prune", "decimate", "mesh-to-field",
/// "particles", "textures", "talk", "live", "compile", "editor", "interface", "light", "serve", "peaks".
std::span<const std::string> benchNames();

/// Prints the named tables, all of them for "all" or no name. Returns an exit status: 0; 1 if a mesh was
/// wrong or a graph did not load; 2 for a name that does not exist. Throws SystemError as everything that
/// uses a device.
int runBench(std::span<const std::string> names, const BenchOptions& options = {});

}  // namespace fw::bench
