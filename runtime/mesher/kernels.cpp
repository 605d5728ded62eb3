#include "runtime/mesher/kernels.h"

#include <algorithm>

#include "graph/ir/families.h"

namespace fw {
namespace mesher {
namespace {

constexpr const char* kNames[kernelCount] = {
    "mesher/prune.comp",      "mesher/prune.comp",      "mesher/prune.comp",      "mesher/blocks.comp",
    "mesher/cull.comp",       "mesher/prune.comp",      "mesher/top_bricks.comp", "mesher/compact.comp",
    "mesher/link.comp",       "mesher/sample.comp",     "mesher/classify.comp",   "mesher/classify.comp",
    "mesher/top_groups.comp", "mesher/top_groups.comp", "mesher/top_groups.comp", "mesher/triangles.comp",
    "mesher/patches.comp",    "mesher/vertices.comp",   "mesher/contour.comp",    "mesher/contour.comp",
    "mesher/quads.comp",      "mesher/colors.comp"};

}  // namespace

void build(const Device& device, MesherPipelines& pipelines, std::initializer_list<Kernel> kernels,
           CompileTimes* times, Compile when) {
    pipelines.all.resize(kernelCount);
    std::vector<ShaderOptions> shaders;
    std::vector<Kernel> missing;
    for (Kernel kernel : kernels) {
        if (pipelines.all[kernel] || std::find(missing.begin(), missing.end(), kernel) != missing.end())
            continue;
        ShaderOptions options{.name = kNames[kernel], .field = pipelines.field};
        if (kernel == prune64) options.constants = {64};
        if (kernel == prune32) options.constants = {32};
        if (kernel == prune16) options.constants = {16};
        if (kernel == contourListed) options.defines = {"MESHER_LISTED"};
        if (kernel == classifyDual) options.constants = {true};
        if (kernel == topGroupsChunked) options.constants = {true};
        if (kernel == topGroupsDual) options.constants = {false, true};
        if (kernel == triangles || kernel == patches)
            options.constants = {std::clamp(device.limits.subgroupSize, 16u, 64u)};
        shaders.push_back(std::move(options));
        missing.push_back(kernel);
    }
    if (missing.empty()) return;
    std::vector<Pipeline> built = createComputePipelines(device, shaders, times, when);
    for (std::size_t i = 0; i < missing.size(); ++i)
        pipelines.all[missing[i]] = std::make_shared<Pipeline>(std::move(built[i]));
}

}  // namespace mesher

using namespace mesher;

void prepareMesher(const std::string& field, const std::function<bool()>& goOn) {
    for (const Kernel kernel : {cull, sample, vertices})  // the longest
        if (goOn()) (void)compileShader({.name = kNames[kernel], .field = field});
}

MesherPipelines createMesherPipelines(const Device& device, std::string field, bool wantColors,
                                      const MesherPipelines& previous, CompileTimes* times, Compile when) {
    MesherPipelines pipelines{previous.all, std::move(field)};
    pipelines.all.resize(kernelCount);
    const bool pruned = hasFamilies(pipelines.field);
    for (Kernel kernel : {prune64, prune32, prune16, blocks, cull, prune8, sample, vertices, colors})
        pipelines.all[kernel] = nullptr;
    build(device, pipelines,
          {cull, sample, vertices, topBricks, compact, wantColors ? colors : vertices,
           pruned ? prune64 : cull, pruned ? prune32 : cull, pruned ? prune16 : cull, pruned ? prune8 : cull},
          times, when);
    if (!connectsOnHost(device, {}))
        build(device, pipelines, {link, classify, topGroups, triangles}, times, when);
    return pipelines;
}

}  // namespace fw
