// Particles on the host: what nodes compile to, files of places, the volume's bounds and its stand-in.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "graph/base/words.h"
#include "graph/bounds/region.h"
#include "graph/check/check.h"
#include "graph/compile/compile.h"
#include "graph/compile/particle_recipe.h"
#include "graph/document/json.h"
#include "tests/support/graph/volume_intervals.h"

namespace fw::particles_test {

Graph graphOf(const std::string& nodes, const std::string& more = "") {
    const std::string text = R"({"fieldwright": 1, "nodes": [)" + nodes +
                             R"({"id": "out", "type": "output", "inputs": {"surface": {"from": "field"}}}])" +
                             more + "}";
    Result<Graph> graph = parseGraph(text, "test.field.json", nullptr);
    if (!graph) throw SystemError(format(graph.error()));
    return std::move(*graph);
}
const std::string kEmitter =
    R"({"id": "rain", "type": "emitter", "inputs": {"rate": 100, "position": [0, 2, 0]}},)";
const std::string kFall =
    R"({"id": "fall", "type": "particle_dynamics", "inputs": {"particles": {"from": "rain"}}},)";
std::string field(const std::string& from, const std::string& inputs = "") {
    return R"({"id": "field", "type": "particles_to_field", "inputs": {"particles": {"from": ")" + from +
           "\"}" + inputs + "}},";
}

const ParticleField& particlesOf(const Program& program) { return *program.ir.volumes().at(0)->particles; }

std::string firstError(const Graph& graph) {
    for (const Error& error : check(graph))
        if (error.severity == Error::Severity::error) return format(error);
    const Result<Program> program = compile(graph);
    return program ? "" : format(program.error());
}

TEST(Particles, AChainIsARecipe) {
    const Graph graph = graphOf(kEmitter + kFall + field("fall", R"(, "radius": 0.2, "method": "exact")"));
    for (const Error& error : check(graph))
        EXPECT_NE(error.severity, Error::Severity::error) << format(error);
    const Program program = *compile(graph);
    const ParticleField& particles = particlesOf(program);
    ASSERT_EQ(particles.particles.stages.size(), 2u);
    const ParticleStage& rain = particles.particles.stages[0];
    EXPECT_EQ(rain.kind, ParticleStage::Kind::emitter);
    EXPECT_EQ(rain.node, "rain");
    EXPECT_EQ(rain.words.at("shape"), "ball");
    const StageNumbers numbers(particles.ir, rain, {});
    EXPECT_EQ(numbers.scalar("rate"), 100.0);
    EXPECT_EQ(numbers.vector("position"), glm::dvec3(0, 2, 0));
    EXPECT_EQ(StageNumbers(particles.ir, particles.particles.stages[1], {}).vector("gravity").y, -9.81);
    EXPECT_EQ(particles.method, DensityMethod::exact);
    EXPECT_EQ(surfaceNumbers(particles.ir, particles.particles, particles.toField, {}).radius, 0.2);
    EXPECT_TRUE(particles.particles.stages[1].fields.empty());
}

TEST(Particles, NumbersMayMoveAndWhatCollidesToo) {
    const Graph graph = graphOf(kEmitter + R"({"id": "clock", "type": "time"},
        {"id": "ball", "type": "sphere", "inputs": {"radius": {"from": "clock"}}},
        {"id": "fall", "type": "particle_dynamics", "inputs": {"particles": {"from": "rain"},
            "attraction": {"from": "clock"}, "collide": {"from": "ball"}}},)" +
                                field("fall"));
    CompileOptions options;
    options.live = {"time", "rain.rate"};
    const Program program = *compile(graph, options);
    const ParticleField& particles = particlesOf(program);
    std::vector<double> values = program.parameters();
    for (std::size_t slot = 0; slot < values.size(); ++slot)
        values[slot] = program.live[slot].name == "time" ? 3.0 : 7.0;
    EXPECT_EQ(StageNumbers(particles.ir, particles.particles.stages[0], values).scalar("rate"), 7.0);
    const ParticleStage& fall = particles.particles.stages[1];
    EXPECT_EQ(StageNumbers(particles.ir, fall, values).scalar("attraction"), 3.0);
    const Program& ball = *fall.fields.at("collide");
    values.resize(ball.live.size());
    EXPECT_EQ(evaluate(ball.ir, ball.distance(), values, {5, 0, 0}), 2.0);

    // A live number is no part of the structure, another one is.
    const auto hashWith = [&](const char* rate, const CompileOptions& with) {
        Graph changed = graph;
        changed.nodes[0].set("rate", {std::stod(rate)});
        return std::pair(compile(changed, with)->structureHash, particlesOf(*compile(changed, with)).hash);
    };
    EXPECT_EQ(hashWith("100", options), hashWith("300", options));
    EXPECT_NE(hashWith("100", {}), hashWith("300", {}));
}

TEST(Particles, WhatCannotBeIsRefusedWithItsNode) {
    const auto says = [](const std::string& nodes, const std::string& what) {
        const std::string error = firstError(graphOf(nodes));
        EXPECT_NE(error.find(what), std::string::npos) << error;
    };
    says(R"({"id": "field", "type": "particles_to_field"},)", "link a node that gives particles");
    says(
        R"({"id": "here", "type": "position"}, {"id": "far", "type": "expression", "code": "return length(p);"},
         {"id": "rain", "type": "emitter", "inputs": {"rate": {"from": "far"}}},)" +
            field("rain"),
        "cannot depend on the place");
    says(R"({"id": "ball", "type": "sphere"},)" + field("ball"), "expected a link to a node with particles");
    says(R"({"id": "file", "type": "particle_file"},)" + field("file"), "no file is named");
    says(R"({"id": "file", "type": "particle_file", "inputs": {"path": "a.gif"}},)" + field("file"), "a.gif");
    says(kEmitter + field("rain", R"(, "radius": 0)"), "above 0");
    says(kEmitter + field("rain", R"(, "region_min": [0, 0, 0], "region_max": [1, 0, 1])"),
         "no extent along y");
    says(kEmitter + field("rain", R"(, "region_min": [-1e300, 0, 0], "region_max": [1e300, 1, 1])"),
         "nearer corners");
    says(kEmitter + field("rain", R"(, "margin": 1e300)"), "nearer corners");
    says(kEmitter + field("rain", R"(, "resolution": 4)"), "at least 8");
    says(kEmitter + field("rain", R"(, "margin": -1)"), "at least 0");
    says(kEmitter +
             R"({"id": "first", "type": "particles_to_field", "inputs": {"particles": {"from": "rain"}}},
         {"id": "fall", "type": "particle_dynamics", "inputs": {"particles": {"from": "rain"}, "collide": {"from": "first"}}},)" +
             field("fall"),
         "cannot be a surface that particles make");
    const Graph output =
        graphOf(kEmitter + R"({"id": "field", "type": "reroute", "inputs": {"value": {"from": "rain"}}},)");
    EXPECT_NE(firstError(output).find("particles"), std::string::npos) << firstError(output);
}

TEST(Particles, TheGridIsWhereTheyCanBe) {
    const Program program = *compile(graphOf(
        R"({"id": "jet", "type": "emitter", "inputs": {"position": [1, 0, 0], "size": [0.1, 0.2, 0.3], "velocity": [1, 4, 0],
            "spread": 0.5, "lifetime": 2}},
        {"id": "fall", "type": "particle_dynamics", "inputs": {"particles": {"from": "jet"}, "gravity": [0, -10, 0]}},)" +
        field("fall", R"(, "radius": 0.25)")));
    const Region region = findRegion(program.ir, program.distance(), program.parameters());
    ASSERT_EQ(region.extent, Extent::bounded);
    const FieldVolume& volume = *program.ir.volumes()[0];
    const double margin = 0.25 + volume.grid.cell;
    // Up to the top of the flight, and down to where it ends.
    const double lo[] = {1 - 0.1, -0.2 + 3.5 * 2 - 0.5 * 10 * 4, -0.3 - 1.0};
    const double hi[] = {1 + 0.1 + 1.5 * 2, 0.2 + 4.5 * 4.5 / 20, 0.3 + 1.0};
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(region.box.lo[axis], lo[axis] - 0.25, margin) << axis;
        EXPECT_NEAR(region.box.hi[axis], hi[axis] + 0.25, margin) << axis;
    }
    for (int axis = 0; axis < 3; ++axis) EXPECT_LE(volume.grid.origin[axis], lo[axis] - 0.2499);
}

std::string placesIn(const std::string& bytes, const std::string& name) {
    const Result<FilePoints> points = parseParticlePlaces(bytes, name);
    if (!points) return points.error().message;
    std::string text;
    for (const glm::vec3& p : points->places) {
        char line[96];
        std::snprintf(line, sizeof line, "%g %g %g;", double(p.x), double(p.y), double(p.z));
        text += line;
    }
    return text;
}

TEST(Particles, ATrackCannotMoveTheirGrid) {
    const std::string error = firstError(
        graphOf(kEmitter + field("rain", R"(, "region_min": [-1, -1, -1], "region_max": [1, 1, 1])"),
                R"(, "timeline": {"tracks": [{"node": "field", "input": "region_max",
                    "keys": [{"time": 0, "value": [1, 1, 1]}, {"time": 1, "value": [2, 2, 2]}]}]})"));
    EXPECT_NE(error.find("cannot move over time"), std::string::npos) << error;
}

TEST(Particles, AnOffsetOfDistancesNearTheSurfaceIsWarnedOf) {
    const auto notes = [](const std::string& distance) {
        return compile(graphOf(kEmitter + R"({"id": "rough", "type": "particles_to_field", "inputs": {
            "particles": {"from": "rain"}, "distance": ")" +
                               distance + R"("}},
            {"id": "field", "type": "offset", "inputs": {"surface": {"from": "rough"}}},)"))
            ->notes;
    };
    const std::vector<Error> near = notes("near");
    ASSERT_FALSE(near.empty());
    EXPECT_EQ(near.back().node, "field");
    EXPECT_NE(near.back().message.find("'rough'"), std::string::npos) << near.back().message;
    for (const Error& note : notes("true")) EXPECT_NE(note.node, "field") << note.message;
}

TEST(Particles, AnInflowFromWhichNothingComesIsWarnedOf) {
    const auto said = [](const std::string& place, const std::string& velocity) {
        const Result<Program> program = compile(graphOf(
            R"({"id": "block", "type": "box", "inputs": {"half_extents": [0.1, 0.05, 0.1]}},
               {"id": "tap", "type": "translate", "inputs": {"surface": {"from": "block"}, "offset": )" +
            place + R"(}}, {"id": "water", "type": "sph_fluid", "inputs": {"inflow": {"from": "tap"},
                "inflow_velocity": )" +
            velocity + "}}," + field("water")));
        for (const Error& note : program->notes)
            if (note.node == "water") return note.input + ": " + note.message;
        return std::string();
    };
    EXPECT_EQ(said("[0, 1, 0]", "[0, -5, 0]"), "");
    EXPECT_EQ(said("[0, 1, 0]", "[0, 0, 0]").substr(0, 16), "inflow_velocity:");
    EXPECT_NE(said("[0, 3, 0]", "[0, -1, 0]").find("outside of the tank"), std::string::npos);
    EXPECT_NE(said("[0, 1, 0]", "[0, -7, 0]").find("thinner"), std::string::npos);
}

TEST(Particles, AGridThatIsFoundIsAsFineAsItsParticlesAsk) {
    const auto grid = [](const std::string& inputs) {
        return compile(graphOf(R"({"id": "drop", "type": "emitter", "inputs": {"shape": "point"}},)" +
                               field("drop", R"(, "radius": 0.5, "resolution": 200)" + inputs)))
            ->ir.volumes()[0]
            ->grid;
    };
    EXPECT_LE(0.5, (8.0 + 1e-6) * grid("").cell);
    EXPECT_EQ(grid(R"(, "region_min": [-1, -1, -1], "region_max": [1, 1, 1])").cell, 2.0 / 200);
    // More room, at every side.
    const VolumeGrid roomy = grid(R"(, "margin": 2)");
    for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(roomy.origin[axis], grid("").origin[axis] - 2.0, roomy.cell + grid("").cell) << axis;
    // One corner alone moves that one.
    const VolumeGrid found = grid(""), cut = grid(R"(, "region_min": [-9, -9, -9])");
    EXPECT_NEAR(cut.origin[0], -9.0, cut.cell);
    EXPECT_NEAR(cut.origin[1] + cut.cell * (cut.size[1] - 1),
                found.origin[1] + found.cell * (found.size[1] - 1), cut.cell + found.cell);
}

TEST(Particles, ASmoothSurfaceFindsItsDropAndItsCells) {
    const auto compiled = [](const std::string& inputs) {
        return *compile(graphOf(R"({"id": "cube", "type": "box"},
            {"id": "water", "type": "sph_fluid", "inputs": {"source": {"from": "cube"}, "spacing": 0.1}},)" +
                                field("water", inputs)));
    };
    const auto dropOf = [](const Program& program) {
        const ParticleField& own = particlesOf(program);
        return surfaceNumbers(own.ir, own.particles, own.toField, {}).drop;
    };
    for (const char* surface : {R"(, "surface": "average")", R"(, "surface": "anisotropic")"}) {
        const Program program = compiled(surface);
        const double drop = dropOf(program);
        EXPECT_NEAR(4.0 / 3.0 * 3.14159265358979 * drop * drop * drop, 0.001,
                    1e-9);  // that of a spacing's cube
        EXPECT_LE(program.ir.volumes()[0]->grid.cell, 0.5 * drop);
        EXPECT_GT(program.ir.volumes()[0]->grid.cell, 0.48 * drop);
        EXPECT_TRUE(program.notes.empty());
        const Program given = compiled(std::string(surface) + R"(, "drop": 0.2, "resolution": 20)");
        EXPECT_EQ(dropOf(given), 0.2);
        EXPECT_NEAR(given.ir.volumes()[0]->grid.cell, (2.0 + 4 * 0.2) / 20,
                    1e-9);  // the tank, two drops to each side
        ASSERT_EQ(given.notes.size(), 1u);
        EXPECT_NE(given.notes[0].message.find("drops with a radius of 0.2 m: raise the resolution to 28"),
                  std::string::npos)
            << given.notes[0].message;
        EXPECT_NE(program.ir.volumes()[0]->hash, compiled("").ir.volumes()[0]->hash);
        // As many as fit, told with what they are; more only where they are asked for.
        const Program large = compiled(std::string(surface) + R"(, "drop": 0.01)");
        const FieldVolume& most = *large.ir.volumes()[0];
        EXPECT_LE(kTexelBytes * texelCount(most), std::size_t(119) << 20);
        EXPECT_GT(kTexelBytes * texelCount(most), std::size_t(115) << 20);
        ASSERT_EQ(large.notes.size(), 1u);
        EXPECT_NE(
            large.notes[0].message.find("drops with a radius of 0.01 m: finer ones would take more than 119 "
                                        "MiB; raise drop, or give the grid a smaller region"),
            std::string::npos)
            << large.notes[0].message;
        EXPECT_EQ(large.notes[0].message.find("cells of " + shortNumber(most.grid.cell)), 0u);
        EXPECT_GT(
            texelCount(
                *compiled(std::string(surface) + R"(, "drop": 0.01, "resolution": 300)").ir.volumes()[0]),
            texelCount(most));
    }
    // Of other particles, and of blobs, the one of a blob alone.
    const double blob = 0.15 * std::sqrt(1.0 - std::cbrt(0.3));
    EXPECT_NEAR(dropOf(compiled("")), blob, 1e-12);
    EXPECT_NEAR(dropOf(*compile(graphOf(kEmitter + field("rain", R"(, "surface": "average")")))), blob,
                1e-12);
    EXPECT_EQ(compiled("").ir.volumes()[0]->grid.size,
              compiled(R"(, "resolution": 96)").ir.volumes()[0]->grid.size);
}

TEST(Particles, FilesOfPlaces) {
    EXPECT_EQ(placesIn("x,y,z\n1,2,3\r\n4;5;6;0.5\n\n# end\n-7 8e-1 9 red\n", "a.csv"),
              "1 2 3;4 5 6;-7 0.8 9;");
    EXPECT_EQ(placesIn("1 2 3", "a.XYZ"), "1 2 3;");
    EXPECT_EQ(placesIn("\xEF\xBB\xBF"
                       "1,2,3\n",
                       "a.csv"),
              "1 2 3;");
    EXPECT_EQ(placesIn("id,x,Y,z\n7,1,2,3\n", "a.csv"), "1 2 3;");
    EXPECT_EQ(placesIn("\"Z\";\"x\";\"y\"\n\"3\";\"1\"; 2 ;\n", "a.csv"), "1 2 3;");
    EXPECT_EQ(placesIn("east north up\n1 2 3\n", "a.txt"), "1 2 3;");
    EXPECT_EQ(placesIn("v 1 2 3\nv 4 5 6\n", "a.obj"), "1 2 3;4 5 6;");
    EXPECT_EQ(
        placesIn(
            "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float "
            "z\nend_header\n1 2 3\n4 5 6\n",
            "a.ply"),
        "1 2 3;4 5 6;");
    for (const auto& [bytes, name, what] : {std::tuple{"", "a.csv", "has no places"},
                                            {"a b c\n", "a.csv", "has no places"},
                                            {"a b c\nd e f\n", "a.csv", "line 2"},
                                            {"0,,0,5\n", "a.csv", "line 1"},
                                            {"0,5;0,5;0,5\n", "a.csv", "three numbers in line 1"},
                                            {"x,y,z\n0,5;0,5;0,5\n", "a.csv", "line 2"},
                                            {"x y z\n0m 0m 0m\n", "a.txt", "line 2"},
                                            {"1 2 3\n1 2\n", "a.txt", "line 2"},
                                            {"1 2\n", "a.txt", "line 1"},
                                            {"1 2 3", "a.vdb", "no format"},
                                            {"1e39,0,0\n0,0,0", "a.csv", "three numbers in line 1"},
                                            {"1 2 3\n1 2 nan", "a.csv", "not a number in line 2"},
                                            {"f 1 2 3", "a.obj", "a.obj"},
                                            {"ply\n", "a.ply", "the particle file"},
                                            {"1 2 3\n4 5 1e99\n", "a.csv", "line 2"}}) {
        const std::string found = placesIn(bytes, name);
        EXPECT_NE(found.find(what), std::string::npos) << bytes << ": " << found;
        EXPECT_NE(found.find(name), std::string::npos) << found;
    }
}

FieldVolumePtr roughVolume(const glm::ivec3& size, uint32_t seed) {
    const Program program = *compile(graphOf(kEmitter + field("rain")));
    VolumeGrid grid;
    grid.origin = {-1.0, 0.5, 2.0};
    grid.cell = 0.37;
    grid.size = size;
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(-1.0f, 1.0f);
    std::vector<uint32_t> words;
    for (std::size_t i = 0; i < grid.samples(); ++i) {
        glm::vec3 gradient(unit(random), unit(random), unit(random));
        const int x = int(i) % size.x, y = int(i) / size.x % size.y, z = int(i) / (size.x * size.y);
        const bool border =
            x == 0 || y == 0 || z == 0 || x == size.x - 1 || y == size.y - 1 || z == size.z - 1;
        const float value = 3.0f * unit(random);
        words.push_back(std::bit_cast<uint32_t>(border ? std::abs(value) + 0.2f : value));
        words.push_back(packGradient(gradient / std::max(1.0f, glm::length(gradient))));
    }
    const std::vector<uint32_t> blocks = blockRanges(grid, words);
    words.insert(words.end(), blocks.begin(), blocks.end());
    const FieldVolume unmade(grid, program.ir.volumes()[0]->particles, program.ir.volumes()[0]->hash);
    EXPECT_FALSE(unmade.made());
    return std::make_shared<const FieldVolume>(unmade, std::move(words));
}

TEST(Particles, BoundsHoldForAnySamples) {
    std::mt19937 random(4);
    uint32_t seed = 1;
    for (const glm::ivec3& size :
         {glm::ivec3(2), glm::ivec3(5, 3, 2), glm::ivec3(17, 40, 9), glm::ivec3(33)}) {
        const FieldVolumePtr volume = roughVolume(size, seed++);
        EXPECT_EQ(volumeTexels({volume}).size(), 4 * texelCount(*volume));
        test::expectIntervalsContain(*volume, 800, 0.5, random);
        test::expectIntervalsContain(*volume, 800, 0.0, random);
    }
}

TEST(Particles, WhatIsNotMadeMayBeAnywhere) {
    const Program program = *compile(graphOf(kEmitter + field("rain")));
    std::mt19937 random(4);
    test::expectIntervalsContain(*program.ir.volumes()[0], 500, 0.5, random);
    const FieldVolume& volume = *program.ir.volumes()[0];
    const glm::dvec3 middle = volume.grid.origin + 0.5 * volume.grid.cell * glm::dvec3(volume.grid.size - 1);
    EXPECT_LT(sampleVolume(volume.layers[0], middle).value, 0.0);
    EXPECT_NEAR(sampleVolume(volume.layers[0], volume.grid.origin - glm::dvec3(3, 4, 0)).value, 5.0, 1e-9);
}

}  // namespace fw::particles_test
