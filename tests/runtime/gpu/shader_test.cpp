// Compiling shaders: includes, errors, the disk cache, reflection, and that every shader of the tree
// compiles.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <thread>

#include "runtime/gpu/shader.h"
#include "tests/support/gpu.h"

namespace fw::shader_test {

namespace fs = std::filesystem;

ShaderOptions withText(std::string text) { return {.name = "test.comp", .text = std::move(text)}; }

TEST(Shader, EveryShaderOfTheTreeCompilesAlone) {
    test::TemporaryCache cache;
    int count = 0;
    for (const EmbeddedShader& shader : embeddedShaders()) {
        std::string ending = fs::path(shader.name).extension();
        if (ending == ".glsl" || ending == ".h") continue;
        Result<Spirv> spirv = compileShader({.name = shader.name});
        EXPECT_TRUE(spirv) << format(spirv.error());
        ++count;
    }
    RecordProperty("shaders", count);
}

TEST(Shader, TheDefaultFieldHasAllItsParts) {
    test::TemporaryCache cache;
    Result<Spirv> spirv = compileShader(withText(R"(
#define FIELD_VALUE
#define FIELD_GRADIENT
#define FIELD_INTERVAL
#define FIELD_ROWS
#define FIELD_MATERIAL
#include "field.glsl"
layout(local_size_x = 8) in;
layout(binding = 0, scalar) buffer Out { float o[]; };
void main() {
    fieldBegin();
    vec3 p = vec3(gl_GlobalInvocationID);
    o[0] = fieldValue(p) + fieldGradient(p).x + fieldInterval(p, p).x + fieldAt(fieldRow(fieldPlane(p.z), p.x), p.y) +
           fieldMaterial(p).roughness;
}
)"));
    EXPECT_TRUE(spirv) << format(spirv.error());
}

TEST(Shader, WhatIsDrawnOverTheFacesIsAsNearAsTheyAre) {
    // Two shaders need not round alike, unless both say that their places do not vary.
    constexpr uint32_t kDecorate = 71, kMemberDecorate = 72, kInvariant = 18;
    for (const char* name : {"render/depth.vert", "render/draft.vert", "render/wireframe.vert"}) {
        const Result<Spirv> spirv = compileShader({.name = name});
        ASSERT_TRUE(spirv) << format(spirv.error());
        bool invariant = false;
        for (std::size_t at = 5; at < spirv->size(); at += (*spirv)[at] >> 16) {
            const uint32_t operation = (*spirv)[at] & 0xffff;
            invariant |= (operation == kDecorate && (*spirv)[at + 2] == kInvariant) ||
                         (operation == kMemberDecorate && (*spirv)[at + 3] == kInvariant);
        }
        EXPECT_TRUE(invariant) << name;
    }
}

TEST(Shader, ErrorsNameFileAndLineOfTheInclude) {
    test::TemporaryCache cache;
    ShaderOptions options = withText("#include \"field.glsl\"\nvoid main() {}\n");
    options.field = "void fieldBegin() {}\nfloat broken = ;\n";
    Result<Spirv> spirv = compileShader(options);
    ASSERT_FALSE(spirv);
    EXPECT_NE(spirv.error().message.find("field.glsl:2"), std::string::npos) << spirv.error().message;
    Result<Spirv> missing = compileShader(withText("\n#include \"no/such.glsl\"\nvoid main() {}\n"));
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().line, 2);
    EXPECT_NE(missing.error().message.find("no/such.glsl"), std::string::npos);
}

TEST(Shader, FieldAndDefinesChangeTheSource) {
    ShaderOptions options = withText("#include \"field.glsl\"\nvoid main() {}\n");
    std::string plain = *completeSource(options);
    options.field = "void fieldBegin() {}\n";
    std::string replaced = *completeSource(options);
    EXPECT_NE(plain, replaced);
    options.defines = {"HELLO 3"};
    EXPECT_NE(completeSource(options)->find("#define HELLO 3\n"), std::string::npos);
}

std::vector<fs::path> cacheFiles(const std::string& folder) {
    std::vector<fs::path> files;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file()) files.push_back(entry.path());
    return files;
}

TEST(Shader, CacheReturnsTheSameWordsAndSurvivesDamage) {
    test::TemporaryCache cache;
    ShaderOptions options = withText("layout(local_size_x = 8) in;\nvoid main() {}\n");
    Spirv first = *compileShader(options);
    std::vector<fs::path> files = cacheFiles(cache.folder);
    ASSERT_EQ(files.size(), 1u);
    EXPECT_EQ(*compileShader(options), first);
    uintmax_t size = fs::file_size(files[0]);
    auto damage = [&](auto how) {
        {
            std::fstream file(files[0], std::ios::in | std::ios::out | std::ios::binary);
            how(file);
        }
        EXPECT_EQ(*compileShader(options), first);
        EXPECT_EQ(fs::file_size(files[0]), size) << "the damaged entry was not replaced";
        EXPECT_EQ(*compileShader(options), first);
    };
    damage([&](std::fstream& file) { file.seekp(std::streamoff(size / 2)).put('\xff').put('\x01'); });
    damage([&](std::fstream& file) { file.seekp(4).write("\xff\xff\xff\x0f", 4); });  // the length
    damage([&](std::fstream& file) { file << "garbage"; });
    fs::resize_file(files[0], 10);
    EXPECT_EQ(*compileShader(options), first);
    fs::resize_file(files[0], 0);
    EXPECT_EQ(*compileShader(options), first);
    EXPECT_EQ(cacheFiles(cache.folder).size(), 1u) << "temporary files were left";
}

TEST(Shader, WhatAnEarlierProcessCompiledIsNotTranslatedTwice) {
    const std::vector<ShaderOptions> shaders = {withText("layout(local_size_x = 8) in;\nvoid main() {}\n"),
                                                withText("layout(local_size_x = 16) in;\nvoid main() {}\n")};
    const auto hasSibling = [&] {
        Result<Device> device = createDevice({.pick = test::device().name()});
        createComputePipelines(*device, shaders);
        return bool(device->record->sibling);
    };
    test::TemporaryCache cache;
    if (!test::device().software) GTEST_SKIP() << "of software devices";
    EXPECT_TRUE(hasSibling()) << "what is new takes two queues";
    EXPECT_TRUE(hasSibling()) << "this process compiled it";
    // A cache at another place is as one that another process filled.
    const fs::path filled = cache.folder + "/fieldwright", before = cache.folder + "/before/fieldwright";
    fs::create_directories(before.parent_path());
    fs::rename(filled, before);
    ASSERT_EQ(setenv("XDG_CACHE_HOME", before.parent_path().c_str(), 1), 0);
    EXPECT_FALSE(hasSibling());
}

TEST(Shader, AnUnwritableCacheIsNoError) {
    test::TemporaryCache cache;
    std::ofstream(cache.folder + "/fieldwright") << "a file where the folder should be";
    EXPECT_TRUE(compileShader(withText("void main() {}\n")));
}

TEST(Shader, ReflectionSeesBindingsPushConstantsAndLocalSize) {
    test::TemporaryCache cache;
    Result<Spirv> spirv = compileShader(withText(R"(
struct Inner { vec3 a; uint b; };
layout(local_size_x = 16, local_size_y = 4, local_size_z = 2) in;
layout(push_constant, scalar) uniform Push { Inner inner; vec2 c[3]; float d; };
layout(binding = 9, scalar) buffer A { uint a[]; };
layout(binding = 9, scalar) buffer B { vec2 b[]; };
layout(binding = 2) uniform U { vec4 u; };
layout(binding = 4) uniform sampler3D s;
layout(binding = 5, r32f) uniform image3D i;
void main() { a[0] = inner.b + uint(c[1].x + d + u.x + texture(s, vec3(0)).x + imageLoad(i, ivec3(0)).x + b[1].x); }
)"));
    ASSERT_TRUE(spirv) << format(spirv.error());
    ShaderInterface found = reflect(*spirv);
    EXPECT_EQ(found.stages, VkShaderStageFlags(VK_SHADER_STAGE_COMPUTE_BIT));
    EXPECT_EQ(found.pushConstantSize, 16u + 24 + 4);
    EXPECT_EQ(found.localSize, (std::array<uint32_t, 3>{16, 4, 2}));
    std::vector<ShaderBinding> expected = {{2, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},
                                           {4, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER},
                                           {5, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_FORMAT_R32_SFLOAT},
                                           {9, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}};
    EXPECT_EQ(found.bindings, expected);
}

TEST(Shader, ManyPipelinesAtOnceAndAFailureAmongThemThrows) {
    test::TemporaryCache cache;
    std::vector<ShaderOptions> shaders;
    for (int i = 0; i < 16; ++i)
        shaders.push_back(
            withText("layout(local_size_x = 8) in;\nlayout(binding = 0, scalar) buffer O { uint o[]; };\n"
                     "void main() { o[gl_GlobalInvocationID.x] = " +
                     std::to_string(i) + "; }\n"));
    std::vector<Pipeline> pipelines = createComputePipelines(test::device(), shaders);
    Buffer out = createBuffer(test::device(), 8 * 4);
    for (uint32_t i = 0; i < 16; ++i) {
        Commands commands(test::device());
        Descriptor descriptors[] = {{0, out}};
        dispatch(commands, pipelines[i], {1, 1, 1}, nullptr, 0, descriptors);
        barrier(commands);
        submit(commands);
        EXPECT_EQ(download<uint32_t>(test::device(), out, 1, 28)[0], i);
    }
    shaders[7].text = "void main() { nonsense }\n";
    EXPECT_THROW(createComputePipelines(test::device(), shaders), SystemError);
}

}  // namespace fw::shader_test
