// fieldwright export --implicit: the field itself into a 3MF file, as functions.
#include <filesystem>

#include "graph/document/unit.h"
#include "graph/implicit3mf/export.h"
#include "runtime/cli/commands.h"
#include "runtime/cli/mesh_graph.h"
#include "runtime/cli/sequence.h"
#include "runtime/play/session.h"
#include "runtime/system/output_file.h"

namespace fw::cli {

int exportImplicit(const ExportOptions& options) {
    if (lowerExtension(options.output) != ".3mf")
        return print({.message = "functions go into a .3mf file: name one, or leave out --implicit",
                      .file = options.output}),
               kBadUsage;
    MeshOptions wanted = options.mesh;
    wanted.outputs = {options.output};
    std::optional<Box> region;
    if (!readRegion(wanted, region)) return kBadUsage;
    int status = kDone;
    const std::optional<Graph> graph = openKept(wanted, status);
    if (!graph) return status;
    if (wanted.planned) return kDone;
    const std::optional<Program> program = openProgram(*graph, options.mesh.graph.time, {});
    if (!program) return kBadInput;
    const Result<Box> bounds = meshRegion(*program, {region, program->resolution, program->method},
                                          regionContext(*graph, options.mesh.graph.time));
    if (!bounds) return badInput(wanted, bounds.error());
    const std::string file = std::filesystem::path(options.output).filename().string();
    Result<Exported3mf> made = export3mf(*program, *bounds, unitOf(*graph), file.substr(0, file.find('.')));
    if (!made) return badInput(wanted, made.error());
    for (Error& warning : made->warnings) {
        warning.file = options.mesh.graph.path;
        print(warning);
    }
    Result<OutputFile> out = OutputFile::open(options.output, nullptr);
    if (!out) return print(out.error()), kSystemFailure;
    out->write(made->bytes);
    if (const Done written = out->commit(); !written) return print(written.error()), kSystemFailure;
    return kDone;
}

}  // namespace fw::cli
