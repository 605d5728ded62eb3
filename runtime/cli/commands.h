// The commands of `fieldwright`: one struct of options and one function each. options/ has their words.
//
// Exit status: 0 done, 1 the input is at fault, 2 usage, 3 the device or system failed, 130 ended by
// Ctrl-C and 143 by SIGTERM (runtime/system/interruption.h). Standard output carries results only; messages
// go to standard error.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "graph/base/result.h"
#include "graph/compile/compile.h"
#include "graph/document/graph.h"
#include "runtime/files/mesh_wish.h"
#include "runtime/gpu/device.h"
#include "runtime/jobs/plan.h"
#include "runtime/measure/mesh_requirements.h"
#include "runtime/pictures/wish.h"
#include "runtime/play/frames.h"
#include "runtime/play/session.h"

namespace fw::cli {

inline constexpr int kDone = 0, kBadInput = 1, kBadUsage = 2, kSystemFailure = 3;

/// What is said of the outputs when a signal ends a command that has made none.
inline constexpr char kNothingWritten[] = "; nothing was written";

/// What every command that reads a graph takes.
struct GraphOptions {
    std::string path;
    std::vector<std::string> assignments;  ///< "name=value", each with its '='
    double time = 0.0;
    std::string cache = {};  ///< of particles: its folder or header; empty: as the graph names them
};

/// The graph as its options have it. Errors: of the assignments; a cache that is none, or not of this graph.
Done applyOptions(Graph& graph, const GraphOptions& options);

/// Reads and checks the graph, applies the assignments; warnings and errors go to standard error.
std::optional<Graph> openGraph(const GraphOptions& options);
/// Compiles what the graph is that many seconds after its start; errors go to standard error.
std::optional<Program> openProgram(const Graph& graph, double seconds, CompileOptions options,
                                   const std::function<const Device*()>& simulator = {},
                                   const std::function<bool(int done, int all)>& progress = {});
void print(const Error& error);
/// Says that the device was lost, and what is done now.
void noteLost(const std::string& now);

/// What every command that meshes a graph takes.
struct MeshOptions {
    GraphOptions graph;
    std::string device;
    std::optional<int> resolution;
    std::vector<double> region;  ///< empty, or x0 y0 z0 x1 y1 z1
    std::optional<MeshMethod> method;
    int triangles = 0;                      ///< at most; 0: as many as there are
    bool byShape = false;                   ///< then: as CompileOptions has it
    std::vector<std::string> outputs = {};  ///< files that the command will write
    JobWork* planned =
        nullptr;  ///< if not null: all is checked, what there is to make told here, and nothing made
};

/// A mesh file that is written, and what is asked of it.
struct MeshOutput {
    std::string output, report = {};         ///< the report's file; empty: none
    std::vector<Requirement> required = {};  ///< what the mesh must be
    bool measured() const { return !report.empty() || !required.empty(); }
};

/// Which frames of a timeline a sequence has, if one is asked for.
struct SequenceOptions {
    FrameTimes frames;
    bool overwrite = false;  ///< frames that are there already; else they are passed over
};

struct ExportOptions : MeshOutput, MeshWish {
    MeshOptions mesh;
    SequenceOptions sequence;        ///< a numbered mesh for every frame
    bool animated = false;           ///< the same as one file that moves
    std::vector<std::string> sweep;  ///< a mesh for every variant (graph/document/sweep.h)
    std::string format;              ///< of the meshes of a sequence or sweep: "glb"; empty: that
    int tiles = 0;                   ///< along the longest side; 0: as many as it takes
    std::string share;               ///< "i/n": only this part of the tiles; empty: all
    std::string particles;           ///< the node whose particles are written in place of a mesh; empty: none
    bool implicit = false;           ///< functions in place of a mesh
    std::string instances;           ///< how copies share a mesh: "nodes", "gpu"; empty: they do not
};
int runExport(const ExportOptions& options);

struct MergeOptions : MeshOutput {
    std::vector<std::string> parts;
};
int runMerge(const MergeOptions& options);

struct RenderCommandOptions {
    MeshOptions mesh;
    std::string output, size = "1280x720", view = "picture";
    PictureWish picture;                  ///< but for its size, view and format
    std::optional<PictureFormat> format;  ///< if not given, the output's ending says it; of a sequence PNG
    SequenceOptions sequence;             ///< a numbered picture for every frame
    std::optional<double> turntable;      ///< the same, of a camera that goes around in so many seconds
};
int runRender(const RenderCommandOptions& options);

struct JobOptions {
    std::string engine;  ///< one of jobEngines()
    std::string folder;
    std::string program;  ///< `fieldwright` as the machines call it; empty: this one
    JobSharing sharing;
};
std::vector<std::string> jobEngines();
/// Writes what the engine takes of the command, which makes this.
int runJob(const JobOptions& options, const TypedCommand& command, const JobWork& work);

struct PlayOptions {
    MeshOptions mesh;
    std::string size = "1280x720";
    FieldBy quality = FieldBy::sooner;
    bool headless = false;
    std::optional<int> frames;  ///< after which it ends
};
int runPlay(const PlayOptions& options);

struct SimulateOptions {
    GraphOptions graph;
    std::string output, device;
    std::string node;  ///< whose particles are kept; empty: all that the graph shows
    SequenceOptions sequence;
    bool planned = false;  ///< all is checked, and nothing made
};
int runSimulate(const SimulateOptions& options);

struct ImportOptions {
    std::string path;    ///< of the file of another program
    std::string output;  ///< of the graph; empty: beside it, under its name
    bool overwrite = false;
};
int runImport(const ImportOptions& options);

struct ParametersOptions {
    std::string path;
    bool json = false;  ///< a list of objects, in place of a line each
};
int runParameters(const ParametersOptions& options);

int runCheck(const std::vector<std::string>& paths);

struct EvalOptions {
    GraphOptions graph;
    std::vector<double> at, interval;
    std::string points, boxes;  ///< files, or "-" for standard input
    bool gradient = false;
};
int runEval(const EvalOptions& options);

struct CompileCommandOptions {
    GraphOptions graph;
    std::string emit = "glsl";
    bool cost = false;  ///< by node, instead
    std::vector<std::string> live;
};
int runCompile(const CompileCommandOptions& options);

enum class NodesFormat { list, json, markdown };
int runNodes(NodesFormat format);
/// `devicesOnly`: what each device can do, in place of all else.
int runInfo(bool devicesOnly);

}  // namespace fw::cli
