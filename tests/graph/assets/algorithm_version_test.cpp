// The version of the algorithms in particle caches. The other stored results that carry it need the runtime:
// see shutter_test, mesh_field_test and tiles_test in tests/runtime.
#include "graph/base/algorithm_version.h"

#include <gtest/gtest.h>

#include "graph/assets/particle_cache.h"
#include "graph/compile/cached_particles.h"
#include "graph/compile/compile.h"
#include "graph/document/json.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::algorithm_version_test {

constexpr const char* kFountain = R"({"fieldwright": 1, "nodes": [
    {"id": "jet", "type": "emitter", "inputs": {"cache": "cache/particles.cache"}},
    {"id": "drops", "type": "particles_to_field", "inputs": {"particles": {"from": "jet"}}},
    {"id": "out", "type": "output", "inputs": {"surface": {"from": "drops"}}}]})";

/// The simulations of the only particles in the program.
std::vector<CachedSimulation> simulationsOf(const Graph& graph, const Program& program) {
    return fw::simulationsOf(graph, program.ir.volumes().at(0)->particles->particles);
}

/// Whether the program reads a cache instead of simulating.
bool readsCache(const Program& program) {
    return program.ir.volumes().at(0)->particles->particles.stages.back().cached.has_value();
}

TEST(AlgorithmVersion, OfAnotherProgramMakesAParticleCacheUseless) {
    const test::TempDir folder;
    const Result<Graph> graph = parseGraph(kFountain, folder.path("a.field.json"), nullptr);
    ASSERT_TRUE(graph) << format(graph.error());
    const Result<Program> before = compile(*graph);
    ASSERT_TRUE(before) << format(before.error());
    EXPECT_FALSE(readsCache(*before)) << "there is no cache yet";

    const ParticleCache cache{folder.path("cache"), simulationsOf(*graph, *before)};
    ASSERT_EQ(cache.simulations.size(), 1u);
    std::filesystem::create_directory(cache.folder);
    const std::string path = cache.folder + "/" + kParticleCacheName,
                      text = writeParticleCache(cache, 1.0 / 60);
    const std::string present = "\"algorithms\": " + std::to_string(kAlgorithmVersion);
    ASSERT_NE(text.find(present), std::string::npos) << text;
    const auto written = [&](const std::string& version) {
        std::string changed = text;
        changed.replace(changed.find(present), present.size(), version);
        test::writeText(path, changed);
        return *readParticleCache("", path);
    };

    EXPECT_TRUE(checkCache(*graph, *written(present)));
    EXPECT_TRUE(readsCache(*compile(*graph)));
    // Another version, and a cache from before versions were recorded.
    const std::string next = "\"algorithms\": " + std::to_string(kAlgorithmVersion + 1);
    for (const std::string& version : {next, std::string("\"unknown\": 1")}) {
        const ParticleCachePtr other = written(version);
        const Done checked = checkCache(*graph, *other);
        ASSERT_FALSE(checked) << version;
        EXPECT_NE(checked.error().message.find("other algorithms"), std::string::npos)
            << checked.error().message;
        EXPECT_NE(other->simulations[0].key(), cache.simulations[0].key());
        EXPECT_FALSE(readsCache(*compile(*graph))) << version;
    }
}

}  // namespace fw::algorithm_version_test
