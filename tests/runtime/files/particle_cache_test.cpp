// Particle caches as a user makes and reads them: the same bytes as simulating, whatever is read, and however
// often the run that wrote them was ended; and what cannot be a cache.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <set>
#include <span>

#include "graph/base/algorithm_version.h"
#include "tests/support/command.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::particle_cache_test {

namespace fs = std::filesystem;

using test::CommandResult;
using test::expectRefusal;
using test::readText;
using test::runCommand;
using test::TempDir;

std::string graphOf(const std::string& nodes, const std::string& particles, const std::string& more = "") {
    return R"({"fieldwright": 1, "nodes": [)" + nodes +
           R"({"id": "field", "type": "particles_to_field", "inputs": {"particles": {"from": ")" + particles +
           R"("}}}, {"id": "out", "type": "output", "inputs": {"surface": {"from": "field"},
               "resolution": 24}}], "timeline": {"length": 2, "fps": 30)" +
           more + "}}";
}

/// A column that falls, with a paddle that turns in it.
std::string waterWith(const std::string& spacing) {
    return graphOf(
        R"({"id": "column", "type": "expression", "code": "p.x + 0.2"},
           {"id": "paddle", "type": "box", "inputs": {"half_extents": [0.05, 0.3, 0.4]}},
           {"id": "turned", "type": "rotate", "inputs": {"surface": {"from": "paddle"}}},
           {"id": "water", "type": "sph_fluid", "inputs": {"source": {"from": "column"}, "spacing": )" +
            spacing +
            R"(, "collide": {"from": "turned"}, "tank_min": [-0.6, 0, -0.3], "tank_max": [0.6, 0.9, 0.3]}},)",
        "water",
        R"(, "tracks": [{"node": "turned", "input": "angles", "keys": [{"time": 0, "value": [0, 0, 0]},
            {"time": 2, "value": [0, 0, 200]}]}])");
}

/// A tap above a drain, torn to foam.
const std::string kTap = graphOf(
    R"({"id": "block", "type": "box", "inputs": {"half_extents": [0.1, 0.06, 0.1]}},
       {"id": "tap", "type": "translate", "inputs": {"surface": {"from": "block"}, "offset": [-0.3, 0.7, 0]}},
       {"id": "drain", "type": "translate", "inputs": {"surface": {"from": "block"}, "offset": [0.4, 0.03, 0]}},
       {"id": "pool", "type": "expression", "code": "p.y - 0.1"},
       {"id": "water", "type": "sph_fluid", "inputs": {"source": {"from": "pool"}, "inflow": {"from": "tap"},
         "inflow_velocity": [2, -3, 0], "outflow": {"from": "drain"}, "spacing": 0.06,
         "tank_min": [-0.6, 0, -0.3], "tank_max": [0.6, 0.9, 0.3]}},
       {"id": "white", "type": "foam", "inputs": {"particles": {"from": "water"}, "speed": 0.4, "most": 3000,
         "lifetime": 0.3}},)",
    "white");

const std::string kRain = graphOf(
    R"({"id": "cloud", "type": "emitter", "inputs": {"rate": 700, "burst": 30, "lifetime": 0.6}},
       {"id": "rain", "type": "particle_dynamics", "inputs": {"particles": {"from": "cloud"}, "turbulence": 4}},)",
    "rain",
    R"(, "tracks": [{"node": "cloud", "input": "rate", "keys": [{"time": 0, "value": 700},
        {"time": 2, "value": 2000}]}])");

struct ParticleCaches : testing::Test {
    TempDir folder;
    std::string graph = folder.path("a.field.json"), cache = folder.path("cache");

    void write(const std::string& text) const { test::writeText(graph, text); }
    CommandResult simulated(const std::vector<std::string>& more = {},
                            const test::CommandOptions& options = {}) const {
        std::vector<std::string> words = {"simulate", graph, "-o", cache};
        words.insert(words.end(), more.begin(), more.end());
        return runCommand(words, options);
    }
    CommandResult exported(const std::string& node, const std::string& time, const std::string& file,
                           const std::vector<std::string>& more = {}) const {
        std::vector<std::string> words = {"export", graph, "--particles", node,
                                          "--time", time,  "-o",          folder.path(file)};
        words.insert(words.end(), more.begin(), more.end());
        return runCommand(words);
    }
    /// What a node's particles are at a time, as a file.
    std::string bytesAt(const std::string& node, const std::string& time,
                        const std::vector<std::string>& more = {}) const {
        const CommandResult result = exported(node, time, "p.ply", more);
        EXPECT_EQ(result.status, 0) << result.errors;
        EXPECT_EQ(result.errors, "");
        std::string bytes = readText(folder.path("p.ply"));
        fs::remove(folder.path("p.ply"));
        return bytes;
    }
    /// All files of the cache, by their paths in it.
    std::map<std::string, std::string> content() const {
        std::map<std::string, std::string> files;
        for (const auto& each : fs::recursive_directory_iterator(cache))
            if (each.is_regular_file())
                files[fs::relative(each.path(), cache).string()] = readText(each.path().string());
        return files;
    }
    std::vector<std::string> fromCache() const { return {"--cache", cache}; }
};

TEST_F(ParticleCaches, AreTheSameBytesAsSimulating) {
    const struct {
        std::string text;
        std::vector<std::string> nodes;
    } cases[] = {{waterWith("0.08"), {"water"}}, {kTap, {"white", "water"}}, {kRain, {"rain"}}};
    const bool all = std::getenv("FIELDWRIGHT_LONG") != nullptr;
    // Of a frame, between two of them, before the first and behind the last.
    const std::vector<const char*> times =
        all ? std::vector{"0.5", "0.45", "0.1", "0.7"} : std::vector{"0.45", "0.7"};
    for (const auto& [text, nodes] : std::span(cases).first(all ? std::size(cases) : 1)) {
        write(text);
        const CommandResult made = simulated({"--from", "0.2", "--to", "0.6"});
        ASSERT_EQ(made.status, 0) << made.errors;
        EXPECT_EQ(made.output + made.errors, "");
        for (const std::string& node : nodes) {
            EXPECT_TRUE(fs::exists(cache + "/" + node + "/000014.state")) << node;
            for (const char* time : times)
                EXPECT_EQ(bytesAt(node, time), bytesAt(node, time, fromCache())) << node << " at " << time;
        }
        fs::remove_all(cache);
    }
}

TEST_F(ParticleCaches, AreReadWhereTheyAreNamedAndTold) {
    write(waterWith("0.08"));
    ASSERT_EQ(simulated({"--to", "0.4"}).status, 0);
    // A byte that is another: whoever reads it says so.
    const std::string state = cache + "/water/000020.state";
    std::string bytes = readText(state);
    bytes[bytes.size() / 2] ^= 4;
    test::writeText(state, bytes);
    const std::string when = "0.34";  // step 20
    const std::string named = folder.path("named.field.json");
    std::string text = readText(graph);
    text.insert(text.find("\"tank_min\""), R"("cache": "cache/particles.cache", )");
    test::writeText(named, text);
    const std::vector<std::string> small = {"--time", when};
    for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
             {"export", graph, "-o", folder.path("a.ply"), "--cache", cache},
             {"export", named, "-o", folder.path("a.ply")},
             {"export", graph, "--particles", "water", "-o", folder.path("a.ply"), "--cache", cache},
             {"render", graph, "-o", folder.path("a.png"), "--size", "32x18", "--cache",
              cache + "/particles.cache"},
             {"render", named, "-o", folder.path("a.png"), "--size", "32x18"},
             {"eval", named, "--at", "0", "0", "0"}}) {
        std::vector<std::string> all = words;
        all.insert(all.end(), small.begin(), small.end());
        expectRefusal(runCommand(all), 1, {"000020.state", "was damaged", "simulate again"});
    }
}

TEST_F(ParticleCaches, GiveTheSamePicture) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "some ten seconds: with FIELDWRIGHT_LONG";
    write(waterWith("0.08"));
    ASSERT_EQ(simulated({"--to", "0.4"}).status, 0);
    const auto picture = [&](const std::string& file, const std::vector<std::string>& more) {
        std::vector<std::string> words = {"render", graph,       "-o", folder.path(file), "--size",
                                          "96x54",  "--samples", "2",  "--time",          "0.3"};
        words.insert(words.end(), more.begin(), more.end());
        const CommandResult result = runCommand(words);
        EXPECT_EQ(result.status, 0) << result.errors;
        return readText(folder.path(file));
    };
    EXPECT_EQ(picture("a.png", {}), picture("b.png", fromCache()));
}

TEST_F(ParticleCaches, KilledAtAnyTimeGoOnToTheSameBytes) {
    const bool all = std::getenv("FIELDWRIGHT_LONG");
    if (all)
        fs::copy_file(std::string(FIELDWRIGHT_SOURCE_DIR) + "/samples/dam_break.field.json", graph);
    else
        write(kTap);
    const std::vector<std::string> frames = {"--to", all ? "2" : "0.5"};
    ASSERT_EQ(simulated(frames).status, 0);
    const auto wanted = content();
    EXPECT_EQ(wanted.size(), all ? 61u : 31u);
    fs::remove_all(cache);
    std::mt19937 random(7);
    int killed = 0;
    for (int attempt = 0; attempt < 400; ++attempt) {
        test::CommandOptions options;
        options.signal = attempt % 2 ? SIGKILL : SIGINT;
        // Later each time, so that there is some progress on a machine that is busy.
        options.interruptAfterMs =
            int(std::uniform_int_distribution(200, (all ? 2000 : 600) + 300 * attempt)(random));
        const CommandResult result = simulated(frames, options);
        if (result.status == 0) break;
        ++killed;
        if (!result.killed) { EXPECT_EQ(result.status, 130) << result.errors; }
    }
    EXPECT_GT(killed, 0);
    EXPECT_EQ(simulated(frames).status, 0);
    auto made = content();
    EXPECT_TRUE(made == wanted);
    EXPECT_EQ(made.size(), wanted.size());
}

TEST_F(ParticleCaches, MeshesOfKilledRunsAreThoseOfOneWithoutACache) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "some ten seconds: with FIELDWRIGHT_LONG";
    const bool all = std::getenv("FIELDWRIGHT_LONG");
    if (all)
        fs::copy_file(std::string(FIELDWRIGHT_SOURCE_DIR) + "/samples/dam_break.field.json", graph);
    else
        write(waterWith("0.08"));
    const std::vector<std::string> until = {"--to", all ? "2" : "0.1"};
    const auto meshes = [&](const std::string& output, const std::vector<std::string>& more) {
        std::vector<std::string> words = {"export", graph, "-o", folder.path(output), "--resolution", "32"};
        words.insert(words.end(), until.begin(), until.end());
        words.insert(words.end(), more.begin(), more.end());
        return words;
    };
    ASSERT_EQ(runCommand(meshes("wanted", {})).status, 0);
    const std::vector<std::string> names = test::namesIn(folder.path("wanted"));
    EXPECT_EQ(names.size(), all ? 60u : 3u);
    std::mt19937 random(11);
    int killed = 0;
    const auto untilDone = [&](const std::vector<std::string>& words) {
        for (int attempt = 0; attempt < 400; ++attempt) {
            test::CommandOptions options;
            options.signal = SIGKILL;
            options.interruptAfterMs =
                int(std::uniform_int_distribution(20, 60 + (all ? 100 : 800) * attempt)(random));
            const CommandResult result = runCommand(words, options);
            killed += result.killed;
            if (result.killed) continue;
            EXPECT_EQ(result.status, 0) << result.errors;
            return;
        }
        FAIL() << "it never came to its end";
    };
    std::vector<std::string> simulate = {"simulate", graph, "-o", cache};
    simulate.insert(simulate.end(), until.begin(), until.end());
    untilDone(simulate);
    untilDone(meshes("made", fromCache()));
    EXPECT_GT(killed, 0);
    EXPECT_EQ(test::namesIn(folder.path("made")), names);
    for (const std::string& name : names)
        EXPECT_TRUE(readText(folder.path("made/" + name)) == readText(folder.path("wanted/" + name))) << name;
}

TEST_F(ParticleCaches, AreExtendedAndMadeAnew) {
    write(kRain);
    ASSERT_EQ(simulated({"--to", "0.2"}).status, 0);
    const auto before = content();
    const CommandResult more = simulated({"--to", "0.4"});
    EXPECT_EQ(more.status, 0);
    EXPECT_NE(more.errors.find("6 of 12 frames were there already"), std::string::npos) << more.errors;
    const auto after = content();
    EXPECT_EQ(after.size(), 13u);
    for (const auto& [name, bytes] : before)
        if (name != "particles.cache") { EXPECT_TRUE(after.at(name) == bytes) << name; }
    EXPECT_EQ(simulated({"--to", "0.1", "--overwrite"}).status, 0);
    EXPECT_EQ(content().size(), 4u);
}

TEST_F(ParticleCaches, OfAnotherSimulationSayWhatDiffers) {
    write(waterWith("0.09"));
    ASSERT_EQ(simulated({"--to", "0.1"}).status, 0);
    write(waterWith("0.1"));
    const std::string what = "node 'water' has spacing 0.1, and had 0.09";
    expectRefusal(exported("water", "0", "a.ply", fromCache()), 1, {"another simulation", what, "--cache"});
    expectRefusal(simulated({"--to", "0.1"}), 2, {"another simulation", what, "--overwrite"});
    // Named by a node it is passed over, and that is said.
    std::string text = readText(graph);
    text.insert(text.find("\"tank_min\""), R"("cache": "cache/particles.cache", )");
    write(text);
    const CommandResult passed = exported("water", "0", "a.ply");
    EXPECT_EQ(passed.status, 0);
    EXPECT_NE(passed.errors.find(what), std::string::npos) << passed.errors;
    EXPECT_NE(passed.errors.find("warning"), std::string::npos) << passed.errors;
    // What bears on nothing makes no difference, nor does how a value is given.
    text = waterWith("0.09");
    text.insert(text.find("\"tank_min\""), R"("viscosity": 2, )");
    text.insert(text.find("\"id\": \"water\""), R"("label": "Sea", "at": [3, 4], )");
    write(text);
    EXPECT_EQ(exported("water", "0", "a.ply", fromCache()).status, 0);
    // A track that is another does.
    text.replace(text.find("[0, 0, 200]"), 11, "[0, 0, 300]");
    write(text);
    expectRefusal(exported("water", "0", "a.ply", fromCache()), 1, {"the timeline moves it in another way"});
}

TEST_F(ParticleCaches, ThatAreNoneAreRefused) {
    write(kRain);
    expectRefusal(exported("rain", "0", "a.ply", fromCache()), 1, {"particles.cache", "does not exist"});
    fs::create_directory(cache);
    for (
        const auto& [text, what] : std::vector<std::pair<std::string, std::string>>{
            {"no JSON", "is no header"},
            {"{}", "is no header"},
            {R"({"fieldwright_particle_cache": 1})", "is no header"},
            {R"({"fieldwright_particle_cache": 1, "simulations": [7]})", "is no header"},
            {R"({"fieldwright_particle_cache": "1", "simulations": []})", "is no header"},
            {R"({"fieldwright_particle_cache": 2, "simulations": []})", "is of a newer Fieldwright"},
            {R"({"fieldwright_particle_cache": 1, "simulations": []})", "it has none"},
            {R"({"fieldwright_particle_cache": 1, "simulations": [{"node": "rain", "part": "x", "data": "z"}]})",
             "a version of Fieldwright with other algorithms"},
            {R"({"fieldwright_particle_cache": 1, "simulations": [{"node": "rain", "part": "x", "algorithms": )" +
                 std::to_string(kAlgorithmVersion) + "}]}",
             "its nodes are others"}}) {
        test::writeText(cache + "/particles.cache", text);
        expectRefusal(exported("rain", "0", "a.ply", fromCache()), 1, {what});
    }
    test::writeText(cache + "/particles.cache", "no JSON");
    expectRefusal(simulated({"--to", "0.1"}), 2, {"is no header", "remove it"});
    fs::remove_all(cache);
    test::writeText(cache, "");
    expectRefusal(simulated({"--to", "0.1"}), 2, {"this is a file"});
    fs::remove(cache);
    expectRefusal(simulated({"--from", "1", "--to", "1"}), 2, {"there is no frame", "--from"});
    expectRefusal(simulated({"--node", "rian"}), 1, {"there is no node 'rian'", "did you mean 'rain'"});
    write(R"({"fieldwright": 1, "nodes": [{"id": "ball", "type": "sphere"},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "ball"}}}]})");
    expectRefusal(simulated({"--to", "0.1"}), 1, {"nothing that this graph shows is simulated"});
    EXPECT_FALSE(fs::exists(cache));
}

TEST_F(ParticleCaches, WhatIsCutOffCountsAsNotThere) {
    write(kRain);
    ASSERT_EQ(simulated({"--to", "0.3"}).status, 0);
    const auto wanted = content();
    for (const std::string file : {"/rain/000016.state", "/rain/000014.state"})
        fs::resize_file(cache + file, fs::file_size(cache + file) / 2);
    test::writeText(cache + "/rain/000012.state", "");
    test::writeText(cache + "/rain/others.state", "");
    EXPECT_EQ(bytesAt("rain", "0.25"), bytesAt("rain", "0.25", fromCache()));
    EXPECT_EQ(simulated({"--to", "0.3"}).status, 0);
    fs::remove(cache + "/rain/others.state");
    EXPECT_TRUE(content() == wanted);
}

TEST_F(ParticleCaches, AFullDiskLeavesWholeFilesAndIsGoneOnWith) {
    write(kRain);
    ASSERT_EQ(simulated({"--to", "0.3"}).status, 0);
    const auto wanted = content();
    std::size_t most = 0;
    for (const auto& [name, bytes] : wanted) most = std::max(most, bytes.size());
    fs::remove_all(cache);
    test::CommandOptions full;
    full.maxFileBytes = long(most) - 16;
    const CommandResult result = simulated({"--to", "0.3"}, full);
    EXPECT_EQ(result.status, 3) << result.errors;
    EXPECT_NE(result.errors.find(".state"), std::string::npos) << result.errors;
    for (const auto& [name, bytes] : content())
        if (name != "particles.cache") { EXPECT_TRUE(wanted.at(name) == bytes) << name; }
    EXPECT_EQ(simulated({"--to", "0.3"}).status, 0);
    EXPECT_TRUE(content() == wanted);
    fs::remove_all(cache);
    fs::create_directory(cache);
    fs::permissions(cache, fs::perms::owner_read);
    if (::geteuid() != 0) { EXPECT_EQ(simulated({"--to", "0.1"}).status, 3); }
    fs::permissions(cache, fs::perms::owner_all);
}

TEST_F(ParticleCaches, OfOneNodeHoldNoOther) {
    write(kTap);
    ASSERT_EQ(simulated({"--to", "0.2", "--node", "water"}).status, 0);
    EXPECT_TRUE(fs::exists(cache + "/water"));
    EXPECT_FALSE(fs::exists(cache + "/white"));
    // The fluid alone is read, foam is not there, and with another run it is.
    ASSERT_EQ(exported("water", "0.1", "water.ply", fromCache()).status, 0);
    EXPECT_EQ(bytesAt("water", "0.1"), readText(folder.path("water.ply")));
    const CommandResult lacks = exported("white", "0.1", "a.ply", fromCache());
    EXPECT_EQ(lacks.status, 0);
    EXPECT_NE(lacks.errors.find("has no particles of node 'white'"), std::string::npos) << lacks.errors;
    ASSERT_EQ(simulated({"--to", "0.2"}).status, 0);
    EXPECT_EQ(bytesAt("white", "0.1"), bytesAt("white", "0.1", fromCache()));
}

struct Point {
    float place[3], velocity[3];
    uint32_t id;
};

/// By their numbers, of which each may be there once.
std::map<uint32_t, Point> pointsOf(const std::string& ply) {
    const std::size_t at = ply.find("end_header\n") + 11;
    std::map<uint32_t, Point> points;
    for (std::size_t i = at; i + sizeof(Point) <= ply.size(); i += sizeof(Point)) {
        Point point;
        std::memcpy(&point, &ply[i], sizeof point);
        EXPECT_TRUE(points.emplace(point.id, point).second) << point.id;
    }
    return points;
}

TEST_F(ParticleCaches, NumbersStayWithTheirParticles) {
    for (const auto& [text, node, kept] :
         std::vector<std::tuple<std::string, std::string, double>>{{waterWith("0.08"), "water", 1.0},
                                                                   {kTap, "water", 0.8},
                                                                   {kTap, "white", 0.3},
                                                                   {kRain, "rain", 0.8}}) {
        write(text);
        const CommandResult result =
            runCommand({"export", graph, "--particles", node, "-o", folder.path("frames"), "--from", "0.5",
                        "--to", "0.6", "--fps", "60", "--format", "ply"});
        ASSERT_EQ(result.status, 0) << result.errors;
        std::map<uint32_t, Point> before;
        for (int frame = 30; frame < 36; ++frame) {
            const std::map<uint32_t, Point> now =
                pointsOf(readText(folder.path("frames/0000" + std::to_string(frame) + ".ply")));
            ASSERT_FALSE(now.empty());
            std::size_t common = 0;
            for (const auto& [id, point] : now) {
                const auto found = before.find(id);
                if (found == before.end()) continue;
                ++common;
                // No farther than it flies, by the faster of both speeds, with some for walls and pressure.
                double way = 0.0, first = 0.0, last = 0.0;
                for (int k = 0; k < 3; ++k) {
                    way += std::pow(point.place[k] - found->second.place[k], 2);
                    first += std::pow(found->second.velocity[k], 2), last += std::pow(point.velocity[k], 2);
                }
                EXPECT_LE(std::sqrt(way), 1.5 * std::sqrt(std::max(first, last)) / 60 + 0.02) << node << id;
            }
            if (!before.empty()) { EXPECT_GE(double(common), kept * double(before.size())) << node; }
            before = now;
        }
        fs::remove_all(folder.path("frames"));
    }
}

TEST_F(ParticleCaches, SequencesOfPointsGoOnAndAreTheMoments) {
    write(kRain);
    for (const std::string format : {"ply", "vtk", "bgeo", "csv"}) {
        const std::string frames = folder.path(format);
        const std::vector<std::string> words = {"export", graph,  "--particles", "rain",     "-o",
                                                frames,   "--to", "0.2",         "--format", format};
        CommandResult result = runCommand(words);
        ASSERT_EQ(result.status, 0) << result.errors;
        EXPECT_EQ(result.output + result.errors, "");
        EXPECT_EQ(test::namesIn(frames).size(), 6u);
        const std::string file = frames + "/000003." + format, bytes = readText(file);
        ASSERT_EQ(exported("rain", "0.1", "moment." + format).status, 0);
        EXPECT_TRUE(readText(folder.path("moment." + format)) == bytes) << format;
        test::writeText(file, "x");
        result = runCommand(words);
        EXPECT_EQ(result.status, 0);
        EXPECT_NE(result.errors.find("5 of 6 frames were there already"), std::string::npos) << result.errors;
        EXPECT_TRUE(readText(file) == bytes) << format;
    }
    expectRefusal(runCommand({"export", graph, "--particles", "rain", "-o", folder.path("x"), "--to", "0.2",
                              "--format", "glb"}),
                  2, {"--format glb", "holds none"});
    expectRefusal(
        runCommand({"export", graph, "--particles", "rain", "-o", folder.path("x.ply"), "--to", "0.2"}), 2,
        {"in a folder", "--format ply"});
    expectRefusal(runCommand({"export", graph, "-o", folder.path("x"), "--to", "0.2", "--format", "bgeo"}), 2,
                  {".bgeo"});
}

}  // namespace fw::particle_cache_test
