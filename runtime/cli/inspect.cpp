// The commands that look at a graph or at the program without meshing: check, compile, nodes, info.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "graph/base/words.h"
#include "graph/check/check.h"
#include "graph/check/typed_parameter.h"
#include "graph/compile/cached_particles.h"
#include "graph/compile/effort.h"
#include "graph/document/json.h"
#include "graph/document/named_parameters.h"
#include "graph/document/timeline.h"
#include "graph/emit/glsl.h"
#include "graph/language/lower.h"
#include "graph/library/reference.h"
#include "runtime/bake/mesh_field_baker.h"
#include "runtime/cli/commands.h"
#include "runtime/gpu/driver_cache.h"
#include "runtime/gpu/shader.h"
#include "runtime/play/mesh_program.h"
#include "runtime/system/version.h"

namespace fw::cli {

void print(const Error& error) { std::fprintf(stderr, "%s\n", format(error).c_str()); }

Done applyOptions(Graph& graph, const GraphOptions& options) {
    for (const std::string& assignment : options.assignments) {
        const std::size_t equals = assignment.find('=');
        if (Done set = setParameter(graph, assignment.substr(0, equals), assignment.substr(equals + 1)); !set)
            return set;
    }
    if (options.cache.empty()) return done();
    std::filesystem::path header = std::filesystem::absolute(options.cache);
    if (header.extension() != std::filesystem::path(kParticleCacheName).extension() ||
        std::filesystem::is_directory(header))
        header /= kParticleCacheName;
    const Result<ParticleCachePtr> cache = readParticleCache(graph.path, header.string());
    const Done fits = cache ? checkCache(graph, **cache) : cache.error();
    if (!fits) {
        Error error = fits.error();
        error.message += " (--cache)", error.file = graph.path;
        return error;
    }
    useCache(graph, header.string());
    return done();
}

std::optional<Graph> openGraph(const GraphOptions& options) {
    std::vector<Error> warnings;
    Result<Graph> graph = readGraph(options.path, &warnings);
    for (const Error& warning : warnings) print(warning);
    if (!graph) {
        print(graph.error());
        return std::nullopt;
    }
    if (const Done applied = applyOptions(*graph, options); !applied)
        return print(applied.error()), std::nullopt;
    bool sound = true;
    for (const Error& finding : check(*graph)) {
        print(finding);
        sound &= finding.severity != Error::Severity::error;
    }
    if (!sound) return std::nullopt;
    return std::move(*graph);
}

std::optional<Program> openProgram(const Graph& graph, double seconds, CompileOptions compileOptions,
                                   const std::function<const Device*()>& simulator,
                                   const std::function<bool(int, int)>& progress) {
    Result<Program> program = compileAtTime(graph, seconds, std::move(compileOptions), simulator, progress);
    if (program) {
        for (const Error& note : program->notes) print(note);
        return std::move(*program);
    }
    print(program.error());
    return std::nullopt;
}

namespace {

nlohmann::ordered_json parametersJson(const Graph& graph) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const NamedParameter& parameter : namedParameters(graph)) {
        nlohmann::ordered_json entry = {{"name", parameter.name}};
        std::vector<double> numbers;
        if (const Node* node = graph.node(parameter.node)) numbers = inputNumbers(*node, parameter.input);
        if (numbers.size() == 1)
            entry["value"] = numbers[0];
        else
            entry["value"] = numbers;
        if (std::isfinite(parameter.min)) entry["min"] = parameter.min;
        if (std::isfinite(parameter.max)) entry["max"] = parameter.max;
        entry["node"] = parameter.node, entry["input"] = parameter.input;
        list.push_back(std::move(entry));
    }
    return list;
}

}  // namespace

int runParameters(const ParametersOptions& options) {
    const std::optional<Graph> graph = openGraph({options.path, {}, 0.0});
    if (!graph) return kBadInput;
    if (options.json) return std::puts(parametersJson(*graph).dump(2).c_str()), kDone;
    for (const NamedParameter& parameter : namedParameters(*graph)) {
        std::string value, range;
        if (const Node* node = graph->node(parameter.node))
            for (const double number : inputNumbers(*node, parameter.input))
                value += (value.empty() ? "" : ",") + shortNumber(number);
        if (std::isfinite(parameter.min) || std::isfinite(parameter.max))
            range = ", " + (std::isfinite(parameter.min) ? shortNumber(parameter.min) : "any") + " to " +
                    (std::isfinite(parameter.max) ? shortNumber(parameter.max) : "any");
        std::printf("%s=%s%s (%s.%s)\n", parameter.name.c_str(), value.c_str(), range.c_str(),
                    parameter.node.c_str(), parameter.input.c_str());
    }
    return kDone;
}

int runCheck(const std::vector<std::string>& paths) {
    bool sound = true;
    for (const std::string& path : paths) {
        std::vector<Error> findings;
        const Result<Graph> graph = readGraph(path, &findings);
        if (!graph) {
            findings.push_back(graph.error());
        } else {
            for (Error& finding : check(*graph, true)) findings.push_back(std::move(finding));
        }
        for (const Error& finding : findings) {
            std::printf("%s\n", format(finding).c_str());
            sound &= finding.severity != Error::Severity::error;
        }
    }
    return sound ? kDone : kBadInput;
}

namespace {

void printCost(const Program& program) {
    const std::vector<NodeEffort> efforts = effortByNode(program);
    NodeEffort all{.node = "all"};
    for (const NodeEffort& effort : efforts) {
        all.operations += effort.operations;
        all.sample += effort.sample;
        all.code += effort.code;
    }
    const auto share = [](double part, double whole) { return whole > 0 ? 100 * part / whole : 0.0; };
    const auto line = [&](const NodeEffort& effort) {
        std::printf("%10.0f %10.0f %4.0f %% %10.0f %4.0f %%  %s\n", effort.operations, effort.sample,
                    share(effort.sample, all.sample), effort.code, share(effort.code, all.code),
                    effort.node.c_str());
    };
    std::printf("%10s %17s %17s  %s\n", "operations", "a sample", "code", "node");
    for (const NodeEffort& effort : efforts) line(effort);
    line(all);
    const double compiling = secondsToCompile(program);
    std::printf(
        "about %.2g s for a software driver to compile the mesher's kernels, %.2g s for a mesh of %d "
        "cells by tapes\n",
        compiling, secondsByTapes(program, program.resolution), program.resolution);
    if (const Result<Box> region = meshRegion(program, {}))
        std::printf(
            "about %.2g s for it to trace light through the field, for each sample of 640 x 360 pixels\n",
            secondsToTrace(weightAtSurface(program, *region)));
}

/// How far the field is a distance; where no Lipschitz constant is declared, with the proven one.
std::string exactnessClause(const Program& program) {
    if (program.exactness.exact()) return "exact distance";
    std::string clause = "not an exact distance since node " + inQuotes(program.spoiledBy);
    if (std::isfinite(program.exactness.lipschitz)) return clause;
    const Result<Box> region = meshRegion(program, {});
    const double constant = region ? lipschitzWithin(program, *region) : kUnknownLipschitz;
    return clause + (std::isfinite(constant) ? ", " + lipschitzText(constant) + " within its region" : "");
}

}  // namespace

int runCompile(const CompileCommandOptions& options) {
    OpeningDevice device(std::launch::deferred, {});
    CompileOptions compileOptions;
    compileOptions.bake = meshFieldBaker([&] { return device.orNone(); });
    compileOptions.costByNode = options.cost;
    compileOptions.live.insert(options.live.begin(), options.live.end());
    const std::optional<Graph> graph = openGraph(options.graph);
    if (!graph) return kBadInput;
    if (const Done known = checkLive(*graph, compileOptions); !known) return print(known.error()), kBadInput;
    const std::optional<Program> program = openProgram(*graph, options.graph.time, std::move(compileOptions));
    if (!program) return kBadInput;
    std::fprintf(stderr, "%zu operations, structure %016llx, %s\n", program->ir.size(),
                 static_cast<unsigned long long>(program->structureHash), exactnessClause(*program).c_str());
    if (options.cost) {
        printCost(*program);
    } else if (options.emit == "ir") {
        std::fputs(program->ir.text(program->surface).c_str(), stdout);
    } else if (options.emit == "glsl") {
        std::fputs(emitField(*program).c_str(), stdout);
    } else {
        const std::string field = emitField(*program);
        const Result<Spirv> words = compileShader({.name = "field/evaluate.comp", .field = field});
        if (!words) throw SystemError(words.error().message);
        std::fwrite(words->data(), sizeof((*words)[0]), words->size(), stdout);
    }
    return kDone;
}

int runNodes(NodesFormat nodesFormat) {
    if (nodesFormat == NodesFormat::json) {
        std::fputs(nodesJson().c_str(), stdout);
    } else if (nodesFormat == NodesFormat::markdown) {
        std::fputs(nodesMarkdown().c_str(), stdout);
    } else {
        for (const NodeType& type : nodeTypes()) {
            std::string inputs;
            for (const InputSpec& input : type.inputs) inputs += (inputs.empty() ? "" : ", ") + input.name;
            std::printf("%-18s %s (%s)\n", type.id.c_str(),
                        type.doc.substr(0, type.doc.find('.') + 1).c_str(), inputs.c_str());
        }
    }
    return kDone;
}

namespace {

void printDevice(std::size_t index, const DeviceInfo& device) {
    std::printf("device %zu: %s (%s, %s, %.1f GiB)%s\n", index, device.name.c_str(), device.kind.c_str(),
                device.driver.c_str(), static_cast<double>(device.memory) / (1u << 30),
                device.usable ? "" : ": lacks features that Fieldwright needs");
}

/// What a device can do, what it lacks, and what follows.
void printAbilities(const DeviceInfo& device) {
    const auto list = [](const char* title, const std::string& text) {
        if (!text.empty()) std::printf("  %-6s %s\n", title, text.c_str());
    };
    std::string has, lacks;
    for (const Capability& capability : capabilities()) {
        const bool there = device.has.*capability.has;
        std::string& text = there ? has : lacks;
        text += (text.empty() ? "" : there ? ", " : "; ") + std::string(capability.name);
        if (!there)
            text += ": " +
                    std::string(capability.without ? capability.without : "Fieldwright cannot run without");
    }
    list("has", has);
    list("lacks", lacks);
    if (!device.has.vulkan13) return;
    const DeviceLimits& limits = device.limits;
    std::printf(
        "  limits subgroups of %u, work groups of %u, %u KiB shared, %llu MiB of a buffer at once (%llu as "
        "texels), %llu MiB in one piece\n",
        limits.subgroupSize, limits.invocations, limits.sharedMemory >> 10,
        static_cast<unsigned long long>(limits.storageRange >> 20),
        static_cast<unsigned long long>(limits.texelElements * DeviceLimits::kTexelBytes >> 20),
        static_cast<unsigned long long>(limits.allocation >> 20));
}

}  // namespace

int runInfo(bool devicesOnly) {
    if (!devicesOnly) std::printf("fieldwright %s, file format %d\n", kVersionAndBuild, kFormatVersion);
    const std::vector<DeviceInfo> devices = listDevices();
    if (devices.empty()) std::printf("no Vulkan device: install mesa-vulkan-drivers for a software one\n");
    for (std::size_t i = 0; i < devices.size(); ++i) {
        printDevice(i, devices[i]);
        if (devicesOnly) printAbilities(devices[i]);
    }
    if (devicesOnly) return kDone;
    std::printf("shader cache: %s\n",
                cacheFolder().empty() ? "none (set XDG_CACHE_HOME or HOME)" : cacheFolder().c_str());
    if (!whyNoDriverCache().empty()) std::printf("driver's cache: none: %s\n", whyNoDriverCache().c_str());
    std::printf("limits: file %zu MiB, %zu nodes, %zu operations, nesting %d\n", kMaxFileBytes >> 20,
                kMaxNodes, kMaxIrOperations, kMaxNesting);
    return kDone;
}

}  // namespace fw::cli
