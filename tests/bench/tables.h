// The benchmark's tables, one function each, and what they share. Each prints its table and reports what was
// wrong.
#pragma once

#include <optional>

#include "graph/compile/compile.h"
#include "runtime/gpu/device.h"
#include "tests/bench/bench.h"
#include "tests/bench/fields.h"
#include "tests/bench/table.h"

namespace fw::bench {

/// One run of the benchmark.
struct Bench {
    const BenchOptions& options;
    bool failed = false;                ///< a mesh was wrong or an input did not load
    std::optional<Device> opened = {};  ///< by the first table that needs it

    const Device& device();
    /// Prints the problem to standard error and marks the run as failed.
    void fail(const std::string& problem);
    std::vector<int> sizes(std::vector<int> usual) const {
        return options.sizes.empty() ? usual : options.sizes;
    }
};

void mesherTable(Bench& bench);       ///< ours against the baseline, four fields
void pruneTable(Bench& bench);        ///< a thousand shapes
void decimateTable(Bench& bench);     ///< a million triangles to a tenth, beside meshoptimizer
void meshFieldTable(Bench& bench);    ///< triangle meshes to fields
void particlesTable(Bench& bench);    ///< particles to fields, and then the next
void fluidTable(Bench& bench);        ///< steps of a fluid
void texturesTable(Bench& bench);     ///< meshes unwrapped, and baked
void talkTable(Bench& bench);         ///< the slide's table
void exportTable(Bench& bench);       ///< sequences, sweeps, compressed files
void processTable(Bench& bench);      ///< the command itself, from graph file to mesh file
void tapesTable(Bench& bench);        ///< fields on the host
void implicit3mfTable(Bench& bench);  ///< 3MF files of functions: import, compile, mesh
void latticesTable(Bench& bench);     ///< struts in a part beside a gyroid of the same surface
void splinesTable(Bench& bench);      ///< tubes along splines beside a torus
void outlinesTable(Bench& bench);     ///< drawings and letters beside a rectangle
void largeTable(Bench& bench);        ///< fields that a driver compiles for long
void liveTable(Bench& bench);         ///< a live parameter changes
void compileTable(Bench& bench);      ///< a graph's structure changes
void editorTable(Bench& bench);       ///< the editor's preview: a hand moves, a structure changes
void interfaceTable(Bench& bench);    ///< the editor in a window: frames, opening, undo, rest
void lightTable(Bench& bench);        ///< ambient occlusion, beside the slide
void serveTable(Bench& bench);        ///< a parameter through `fieldwright serve`
void peaksTable(Bench& bench);        ///< what the device can do at most

/// A graph of about `nodes` nodes: boxes, each moved to its place, joined and cut from one another in turn.
/// `difference` enters a size, so that no cache knows the code.
Graph chainOfBoxes(int nodes, double difference);
/// The chain with a ball joined to it, by two nodes.
Graph withBall(Graph chain);

/// The graph of a benchmark field, read and compiled; reports a failure and returns nothing if that does not
/// work.
std::optional<Program> benchProgram(Bench& bench, Field field, const CompileOptions& options = {});

}  // namespace fw::bench
