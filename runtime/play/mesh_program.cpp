#include "runtime/play/mesh_program.h"

#include <algorithm>
#include <cstdio>

#include "graph/document/timeline.h"

namespace fw {

namespace {

double cellSizeOf(const Box& region, int resolution) {
    double longest = 0.0;
    for (int axis = 0; axis < 3; ++axis) longest = std::max(longest, region.hi[axis] - region.lo[axis]);
    return longest / resolution;
}

}  // namespace

Result<Program> compileAtTime(const Graph& graph, double seconds, CompileOptions options,
                              const std::function<const Device*()>& simulator,
                              const std::function<bool(int, int)>& progress) {
    const Result<Timeline> timeline = readTimeline(graph);
    if (!timeline) return timeline.error();
    options.time = timelineTime(*timeline, seconds);
    Result<Program> program = compile(atTime(graph, *timeline, options.time), options);
    if (program && simulator && lacksParticles(*program)) {
        const Device* device = simulator();
        if (!device) return Error{.message = "particles need a device, and none could be opened"};
        if (const Done made = makeParticles(*program, graph, seconds, options, *device, progress); !made)
            return made.error();
    }
    if (program || program.error().code != Error::Code::divisionByZero) return program;
    Error error = program.error();  // not always, or check() would have found it
    error.message += " at " + std::to_string(options.time) + " s with these parameters";
    return error;
}

Result<MeshedProgram> meshProgram(Device device, Program program, const MeshRequest& request,
                                  const Box& region, const StageStarts& starts, bool timed) {
    const auto stopped = [] { return Error{.message = "cancelled; nothing was written"}; };
    const int resolution = request.resolution > 0 ? request.resolution : program.resolution;
    const bool given = request.region || program.region;
    MeshedProgram meshed{Session(std::move(device)), {}, region, cellSizeOf(region, resolution)};
    if (!starts("pipelines")) return stopped();
    meshed.session.setProgram(std::move(program));
    if (!starts("mesh")) return stopped();
    Result<MesherResult> mesh = meshed.session.polygonise({region, resolution, request.method}, timed);
    if (!mesh) return mesh.error();
    if (mesh->triangles == 0) return nothingToSee(given, region, resolution);
    meshed.mesh = std::move(*mesh);
    return meshed;
}

Error nothingToSee(bool given, const Box& region, int resolution) {
    if (given)
        return {.message =
                    "the surface does not pass through the region: move or enlarge the region, or "
                    "raise the resolution"};
    char cell[32];
    std::snprintf(cell, sizeof cell, "%.3g", cellSizeOf(region, resolution));
    return {.message = "the solid is empty or thinner than a cell of " + std::string(cell) +
                       " m: raise the resolution, or give a smaller region"};
}

}  // namespace fw
