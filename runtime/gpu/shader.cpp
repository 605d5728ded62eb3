#include "runtime/gpu/shader.h"

#include <glslang/build_info.h>
#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

#include <algorithm>
#include <mutex>
#include <set>

#include "runtime/gpu/texels.h"
#include "runtime/system/cache_file.h"

namespace fw {
namespace {

/// Every shader gets this in front: one dialect for all.
constexpr const char* kPrologue = R"(#version 460
#extension GL_GOOGLE_cpp_style_line_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : enable
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_vote : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_shuffle : enable
#extension GL_EXT_control_flow_attributes : enable
)";

const char* findSource(std::string_view name) {
    for (const EmbeddedShader& shader : embeddedShaders())
        if (name == shader.name) return shader.source;
    return nullptr;
}

/// The name in `#include "name"`, empty if the line is none.
std::string_view includedName(std::string_view line) {
    std::size_t start = line.find_first_not_of(" \t");
    if (start == line.npos || line.substr(start, 8) != "#include") return {};
    std::size_t open = line.find('"', start), close = open == line.npos ? open : line.find('"', open + 1);
    return close == line.npos ? std::string_view{} : line.substr(open + 1, close - open - 1);
}

Done expand(std::string_view name, std::string_view text, const ShaderOptions& options,
            std::set<std::string, std::less<>>& seen, std::string& out) {
    out.append("#line 1 \"").append(name).append("\"\n");
    int lineNumber = 0;
    while (!text.empty()) {
        std::size_t end = text.find('\n');
        std::string_view line = text.substr(0, end);
        text.remove_prefix(end == text.npos ? text.size() : end + 1);
        ++lineNumber;
        std::string_view include = includedName(line);
        if (include.empty()) {
            out.append(line).push_back('\n');
            continue;
        }
        if (!seen.emplace(include).second) {
            out.push_back('\n');
            continue;
        }
        const char* found = findSource(include);
        bool replaced = include == "field.glsl" && !options.field.empty();
        if (!found && !replaced)
            return Error{.message = "shader includes '" + std::string(include) + "', which does not exist",
                         .file = std::string(name),
                         .line = lineNumber};
        if (Done inner = expand(include, replaced ? options.field : found, options, seen, out); !inner)
            return inner;
        out.append("#line ").append(std::to_string(lineNumber + 1)).append(" \"").append(name).append("\"\n");
    }
    return done();
}

struct Stage {
    const char* ending;
    EShLanguage language;
    VkShaderStageFlagBits flag;
};
constexpr Stage kStages[] = {{".comp", EShLangCompute, VK_SHADER_STAGE_COMPUTE_BIT},
                             {".vert", EShLangVertex, VK_SHADER_STAGE_VERTEX_BIT},
                             {".geom", EShLangGeometry, VK_SHADER_STAGE_GEOMETRY_BIT},
                             {".frag", EShLangFragment, VK_SHADER_STAGE_FRAGMENT_BIT}};

const Stage& stageOf(std::string_view name) {
    for (const Stage& stage : kStages)
        if (name.ends_with(stage.ending)) return stage;
    throw SystemError("shader '" + std::string(name) + "' has an unknown ending");
}

Result<Spirv> compileText(const std::string& name, const std::string& text, EShLanguage language) {
    static const bool initialised = glslang::InitializeProcess();
    (void)initialised;
    glslang::TShader shader(language);
    const char* source = text.c_str();
    shader.setStrings(&source, 1);
    shader.setEnvInput(glslang::EShSourceGlsl, language, glslang::EShClientVulkan, 100);
    shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_3);
    shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_6);
    constexpr auto kMessages = EShMessages(EShMsgDefault | EShMsgSpvRules | EShMsgVulkanRules);
    if (!shader.parse(GetDefaultResources(), 460, false, kMessages))
        return Error{.message = std::string("shader does not compile: ") + shader.getInfoLog(), .file = name};
    glslang::TProgram program;
    program.addShader(&shader);
    if (!program.link(kMessages))
        return Error{.message = std::string("shader does not link: ") + program.getInfoLog(), .file = name};
    glslang::SpvOptions options;
    options.disableOptimizer = true;  // measured: spirv-opt costs more than it gains
    Spirv spirv;
    glslang::GlslangToSpv(*program.getIntermediate(language), spirv, &options);
    return spirv;
}

/// Names of the files that this process has put into the cache.
struct {
    std::mutex mutex;
    std::set<std::string> names;
} compiledHere;

}  // namespace

ShaderOptions fitted(ShaderOptions options, const DeviceLimits& limits) {
    options.texelsInStorage = limits.texelsInStorage();
    if (const DeviceLimits least = leastLimits(); limits.groups < least.groups)
        options.defines.push_back("MOST_GROUPS " + std::to_string(limits.groups));
    return options;
}

std::string_view shaderSource(std::string_view name) {
    const char* source = findSource(name);
    assert(source);
    return source ? source : std::string_view{};
}

Result<std::string> completeSource(const ShaderOptions& options) {
    std::string out = kPrologue;
    for (const std::string& define : options.defines) out.append("#define ").append(define).push_back('\n');
    const char* found = options.text.empty() ? findSource(options.name) : options.text.c_str();
    if (!found) return Error{.message = "no shader is named '" + options.name + "'", .file = options.name};
    std::set<std::string, std::less<>> seen;
    if (Done expanded = expand(options.name, found, options, seen, out); !expanded) return expanded.error();
    return options.texelsInStorage ? withTexelsInStorage(std::move(out)) : out;
}

Result<Spirv> compileShader(const ShaderOptions& options, bool* before) {
    if (before) *before = false;
    Result<std::string> text = completeSource(options);
    if (!text) return text.error();
    const Stage& stage = stageOf(options.name);
    // Two 64-bit hashes, from different seeds: one names the file, the other stands in it.
    std::string key = *text + "\nstage " + stage.ending + " glslang " +
                      std::to_string(GLSLANG_VERSION_MAJOR) + "." + std::to_string(GLSLANG_VERSION_MINOR) +
                      "." + std::to_string(GLSLANG_VERSION_PATCH);
    uint64_t hash = hashBytes(key.data(), key.size());
    uint64_t second = hashBytes(key.data(), key.size(), 0x9e3779b97f4a7c15ull);
    char name[24];
    std::snprintf(name, sizeof name, "%016llx.spv", static_cast<unsigned long long>(hash));
    std::string path = cachePath("spirv", name);
    constexpr uint32_t kSpirvMagic = 0x07230203;
    if (Spirv cached = readCacheFile(path, second); cached.size() > 5 && cached[0] == kSpirvMagic) {
        std::lock_guard lock(compiledHere.mutex);
        if (before) *before = !compiledHere.names.contains(path);
        return cached;
    }
    Result<Spirv> spirv = compileText(options.name, *text, stage.language);
    if (!spirv) return spirv;
    writeCacheFile(path, second, *spirv);
    std::lock_guard lock(compiledHere.mutex);
    compiledHere.names.insert(path);
    return spirv;
}

}  // namespace fw
