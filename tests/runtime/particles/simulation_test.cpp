// Particles over time: falls that are known exactly, births and deaths, the same bytes whichever way a time
// is reached, obstacles.
#include "runtime/particles/simulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <map>

#include "graph/compile/live_program.h"
#include "graph/document/json.h"
#include "runtime/play/mesh_program.h"
#include "tests/support/gpu.h"

namespace fw::simulation_test {

using test::device;

LiveProgram liveOf(const std::string& emitter, const std::string& dynamics, const std::string& more = "",
                   const std::string& keys = "", double radius = 0.15) {
    const std::string text =
        R"({"fieldwright": 1, "nodes": [{"id": "rain", "type": "emitter", "inputs": {)" + emitter + "}}," +
        more +
        (dynamics == "none"
             ? ""
             : R"({"id": "fall", "type": "particle_dynamics", "inputs": {"particles": {"from": "rain"})" +
                   std::string(dynamics.empty() ? "" : ",") + dynamics + "}},") +
        R"({"id": "field", "type": "particles_to_field", "inputs": {"particles": {"from": ")" +
        (dynamics == "none" ? "rain" : "fall") + R"("}, "radius": )" + std::to_string(radius) +
        R"(}}, {"id": "out", "type": "output", "inputs": {"surface": {"from": "field"}}}])" + keys + "}";
    Result<Graph> graph = parseGraph(text, "test.field.json", nullptr);
    if (!graph) throw SystemError(format(graph.error()));
    Result<LiveProgram> live = compileLive(std::move(*graph), {});
    if (!live) throw SystemError(format(live.error()));
    return std::move(*live);
}

struct Played {
    explicit Played(LiveProgram program)
        : live(std::move(program)), simulation(device(), live.program.ir.volumes()[0]->particles) {}
    bool goTo(double seconds) {
        const Result<bool> changed = simulation.goTo(seconds, [&](double at) { return live.valuesAt(at); });
        if (!changed) throw SystemError(changed.error().message);
        return *changed;
    }
    std::vector<glm::vec4> places() {
        return download<glm::vec4>(device(), simulation.places(), simulation.slots());
    }
    std::vector<glm::vec4> alive() {
        std::vector<glm::vec4> list = places();
        std::erase_if(list, [](const glm::vec4& p) { return std::isnan(p.x); });
        return list;
    }
    LiveProgram live;
    Simulation simulation;
};

/// Equal but for what is not a number in both.
void expectSame(const std::vector<glm::vec4>& a, const std::vector<glm::vec4>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i)
        for (int k = 0; k < 4; ++k)
            ASSERT_TRUE(a[i][k] == b[i][k] || (std::isnan(a[i][k]) && std::isnan(b[i][k]))) << i << ' ' << k;
}

TEST(Simulation, BurstsFallFreely) {
    Played player(liveOf(
        R"("burst": 500, "rate": 0, "velocity": [1, 2, 0], "spread": 0, "size": [0.5, 0.1, 0.2], "lifetime": 9)",
        ""));
    player.goTo(0.0);
    const std::vector<glm::vec4> first = player.alive();
    ASSERT_EQ(first.size(), 500u);
    for (const glm::vec4& p : first) {
        EXPECT_LE(glm::length(glm::vec3(p) / glm::vec3(0.5f, 0.1f, 0.2f)), 1.0001f);
        EXPECT_EQ(p.w, 0.0f);
    }
    player.goTo(1.0);
    const std::vector<glm::vec4> last = player.alive();
    ASSERT_EQ(last.size(), 500u);
    for (std::size_t i = 0; i < 500; ++i) {
        // Semi-implicit steps fall half a step's speed farther.
        const glm::vec3 wanted =
            glm::vec3(first[i]) + glm::vec3(1, 2, 0) + glm::vec3(0, -0.5f * 9.81f * (1.0f + 1.0f / 60), 0);
        EXPECT_LT(glm::distance(glm::vec3(last[i]), wanted), 1e-5f);
        EXPECT_NEAR(last[i].w, 1.0f, 1e-5f);
    }
}

TEST(Simulation, BirthsAreEvenAndDeathsComeInTime) {
    Played player(liveOf(
        R"("rate": 250, "lifetime": 0.5, "velocity": [0, 3, 0], "spread": 0, "shape": "point", "size": [0, 0, 0])",
        "none"));
    for (const double time : {0.0, 0.1, 0.25, 0.5, 1.0, 2.0}) {
        player.goTo(time);
        std::vector<glm::vec4> alive = player.alive();
        EXPECT_NEAR(double(alive.size()), 250 * std::min(time, 0.5), 250.0 / 60 + 1) << time;
        std::ranges::sort(alive, {}, [](const glm::vec4& p) { return p.w; });
        for (std::size_t i = 0; i < alive.size(); ++i) {
            EXPECT_NEAR(alive[i].y, 3.0f * alive[i].w, 1e-5f);  // each flies since its own birth
            if (i > 0) { EXPECT_NEAR(alive[i].w - alive[i - 1].w, 1.0f / 250, 1e-5f); }
            EXPECT_LE(alive[i].w, 0.5f);
        }
    }
    EXPECT_LT(player.simulation.slots(), 250u);
}

TEST(Simulation, ATimeIsTheSameHoweverItIsReached) {
    const char* emitter = R"("rate": 300, "burst": 40, "lifetime": 1.5, "seed": 7)";
    const char* dynamics =
        R"("turbulence": 5, "drag": 0.4, "attraction": 2, "attractor": [0, 1, 0], "collide": {"from": "floor"})";
    const char* more = R"({"id": "floor", "type": "plane", "inputs": {"offset": -0.5}},)";
    const auto straight = [&](double to) {
        Played player(liveOf(emitter, dynamics, more));
        player.goTo(to);
        return player.places();
    };
    Played player(liveOf(emitter, dynamics, more));
    for (const double time : {0.4, 3.3, 1.9, 2.5, 0.0, 3.3, 3.3 + 1.0 / 60, 1.0}) {
        EXPECT_TRUE(player.goTo(time));
        expectSame(player.places(), straight(time));
    }
    EXPECT_FALSE(player.goTo(1.0));
    EXPECT_FALSE(player.goTo(1.0 + 0.9 / 60));  // within a step
    // Another seed is another rain.
    Played other(liveOf(R"("rate": 300, "burst": 40, "lifetime": 1.5, "seed": 8)", dynamics, more));
    other.goTo(1.0);
    EXPECT_NE(other.places()[0], player.places()[0]);
}

TEST(Simulation, MovingValuesAreTakenStepByStep) {
    // The rate falls from 600 to 0 within a second: 300 births. And they rise more and more.
    Played player(liveOf(R"("rate": 600, "lifetime": 20, "velocity": [0, 0, 0], "spread": 0)",
                         R"("gravity": [0, 0, 0])", "",
                         R"(, "timeline": {"length": 4, "tracks": [{"node": "rain", "input": "rate", "keys": [
                              {"time": 0, "value": 600}, {"time": 1, "value": 0}]}]})"));
    player.goTo(1.5);
    EXPECT_NEAR(double(player.alive().size()), 300, 8);
    player.goTo(2.5);
    EXPECT_NEAR(double(player.alive().size()), 300, 8);
}

/// A timeline that makes the input live.
std::string trackOf(const std::string& node, const std::string& input, const std::string& value) {
    return R"(, "timeline": {"length": 4, "tracks": [{"node": ")" + node + R"(", "input": ")" + input +
           R"(", "keys": [{"time": 0, "value": )" + value + "}]}]}";
}

TEST(Simulation, ChangedValuesBearOnWhatComes) {
    Played player(liveOf(R"("rate": 60, "lifetime": 20, "velocity": [0, 0, 0], "spread": 0)", "", "",
                         trackOf("rain", "rate", "60")));
    player.live.motions.clear();
    double& rate = player.live.inputs.at("rain.rate").value[0];
    const ValuesAt values = [&](double at) { return player.live.valuesAt(at); };
    const auto aliveAt = [&](double seconds) {
        if (!player.simulation.goTo(seconds, values)) throw SystemError("it went nowhere");
        return player.alive().size();
    };
    EXPECT_EQ(aliveAt(1.0), 60u);
    rate = 120.0;
    player.simulation.valuesChanged();
    EXPECT_FALSE(*player.simulation.goTo(1.0, values));  // it goes on from where it is
    EXPECT_EQ(aliveAt(2.0), 180u);
    EXPECT_EQ(aliveAt(0.5), 60u);  // and what was before is played anew from the start,
    EXPECT_EQ(aliveAt(2.0), 240u);
    EXPECT_EQ(aliveAt(1.5), 180u);  // of which nothing is left of before
    rate = 0.0;
    player.simulation.valuesChanged();
    EXPECT_EQ(aliveAt(0.0), 0u);
    EXPECT_EQ(aliveAt(2.0), 0u);
}

/// Whatever the live values are, at the start or later, it goes on or says why not.
void expectNoHarm(const LiveProgram& live) {
    ASSERT_FALSE(live.program.live.empty());
    for (const double value : {double(NAN), double(INFINITY), -double(INFINITY), 1e300, -1e300, 1e-300, -3.0})
        for (const double from : {0.0, 0.05}) {
            Simulation simulation(device(), live.program.ir.volumes()[0]->particles);
            const std::vector<double> values(live.program.live.size(), value);
            const Result<bool> gone = simulation.goTo(
                from + 0.05, [&](double at) { return at < from ? live.valuesAt(at) : values; });
            if (!gone) { EXPECT_FALSE(gone.error().message.empty()); }
        }
}

TEST(Simulation, ValuesThatAreNoNumbersDoNoHarm) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "some ten seconds: with FIELDWRIGHT_LONG";
    const std::string one = "3", three = "[0.1, 0.2, 0.3]";
    using Inputs = std::map<std::string, std::string>;
    for (const auto& [input, value] : Inputs{{"position", three},
                                             {"size", three},
                                             {"velocity", three},
                                             {"rate", one},
                                             {"lifetime", one},
                                             {"spread", one}})
        expectNoHarm(liveOf(R"("rate": 300, "burst": 10)", "", "", trackOf("rain", input, value)));
    for (const auto& [input, value] : Inputs{{"gravity", three},
                                             {"attractor", three},
                                             {"attraction", one},
                                             {"drag", one},
                                             {"turbulence", one},
                                             {"turbulence_size", one},
                                             {"friction", "0.5"}})
        expectNoHarm(liveOf(R"("rate": 300)", R"("turbulence": 1)", "", trackOf("fall", input, value)));
}

/// Particles that rain on a surface for some seconds: none may be in it, and how many got below.
void rainOn(const std::string& collide, const std::string& more,
            const std::function<double(glm::vec3)>& distance, double seconds,
            const std::function<void(const std::vector<glm::vec4>&)>& look) {
    Played player(liveOf(
        R"("shape": "box", "position": [0, 2, 0], "size": [0.9, 0.1, 0.9], "rate": 2000, "lifetime": 3, "velocity": [0, -6, 0])",
        R"("turbulence": 3, "bounce": 0.5, "radius": 0.01, "collide": {"from": ")" + collide + "\"}", more));
    double deepest = 1e9;
    const int steps = int(seconds * 60);
    for (int step = 20; step <= steps; step += std::max(20, steps / 20)) {
        player.goTo(step / 60.0);
        for (const glm::vec4& p : player.alive()) {
            ASSERT_TRUE(std::isfinite(p.x + p.y + p.z));
            deepest = std::min(deepest, distance(glm::vec3(p)));
        }
    }
    EXPECT_GE(deepest, 0.0);
    look(player.alive());
}

TEST(Simulation, NothingGetsIntoAnObstacleNorThroughAThinOne) {
    const double seconds = std::getenv("FIELDWRIGHT_LONG") ? 10'000 / 60.0 : 4.0;
    rainOn(
        "ball", R"({"id": "ball", "type": "sphere", "inputs": {"radius": 0.7}},)",
        [](glm::vec3 p) { return glm::length(p) - 0.7; }, seconds,
        [](const auto& alive) {
            EXPECT_GT(std::ranges::count_if(alive, [](const glm::vec4& p) { return p.y < -1.0f; }), 100);
        });
    // Two centimetres thick, at some ten metres a second: a step is eight times as long.
    rainOn(
        "sheet", R"({"id": "sheet", "type": "box", "inputs": {"half_extents": [9, 0.01, 9]}},)",
        [](glm::vec3 p) { return std::abs(p.y) - 0.01; }, seconds,
        [](const auto& alive) {
            EXPECT_EQ(std::ranges::count_if(alive, [](const glm::vec4& p) { return p.y < 0.0f; }), 0);
        });
}

TEST(Simulation, AHoleLetsThemThrough) {
    rainOn(
        "drilled", R"({"id": "sheet", "type": "box", "inputs": {"half_extents": [9, 0.05, 9]}},
        {"id": "drill", "type": "infinite_cylinder", "inputs": {"radius": 0.4}},
        {"id": "drilled", "type": "subtract", "inputs": {"a": {"from": "sheet"}, "b": {"from": "drill"}}},)",
        [](glm::vec3 p) {
            const double sheet = std::abs(p.y) - 0.05, wall = 0.4 - std::hypot(p.x, p.z);
            return std::max(sheet, wall);
        },
        4.0,
        [](const auto& alive) {
            const auto below = std::ranges::count_if(alive, [](const glm::vec4& p) { return p.y < -0.1f; });
            EXPECT_GT(below, 50);
            EXPECT_LT(below, std::ptrdiff_t(alive.size()) / 2);
        });
}

TEST(Simulation, AGridThatIsFoundHasRoomForAllTimes) {
    const auto reachOf = [](const LiveProgram& live) {
        const VolumeGrid& grid = live.program.ir.volumes()[0]->grid;
        return std::pair(grid.origin.x, grid.origin.x + grid.cell * (grid.size.x - 1));
    };
    const std::string still = R"("rate": 60, "lifetime": 1, "velocity": [0, 1, 0], "spread": 0)";
    const auto [low, high] =
        reachOf(liveOf(still, "none", "",
                       R"(, "timeline": {"length": 4, "tracks": [{"node": "rain", "input": "position.x",
        "keys": [{"time": 0, "value": -2}, {"time": 4, "value": 3}]}]})"));
    EXPECT_LT(low, -2.1);
    EXPECT_GT(high, 3.1);
    const auto [first, last] =
        reachOf(liveOf(still + R"(, "position": {"from": "place"})", "none",
                       R"({"id": "clock", "type": "time"}, {"id": "place", "type": "combine_xyz",
        "inputs": {"x": {"from": "clock"}}},)"));
    EXPECT_LT(first, -0.1);
    EXPECT_GT(last, kDefaultTimelineLength);
}

TEST(Simulation, AGridThatIsFoundIsAsFineAsTheRadiiOfAllTimesAsk) {
    // The graph's own radius is never used.
    const LiveProgram live =
        liveOf(R"("shape": "point", "rate": 0, "burst": 5, "velocity": [0, 0, 0], "spread": 0)", "none", "",
               trackOf("field", "radius", "0.05"), 1.0);
    const VolumeGrid& grid = live.program.ir.volumes()[0]->grid;
    EXPECT_GT(0.05, 4.0 * grid.cell);
    EXPECT_TRUE(live.program.notes.empty());
}

TEST(Simulation, CellsOfAGridForAllTimesAreWarnedOfAtAnyTime) {
    const LiveProgram live =
        liveOf(R"("shape": "point", "rate": 60, "lifetime": 1, "velocity": [0, 1, 0])", "none", "",
               R"(, "timeline": {"length": 4, "tracks": [{"node": "rain", "input": "position.x",
        "keys": [{"time": 0, "value": 0}, {"time": 4, "value": 30}]}]})");
    const Result<Program> program = compileAtTime(live.graph, 1.0, {}, [] { return &device(); });
    ASSERT_TRUE(program);
    ASSERT_EQ(program->notes.size(), 1u);
    EXPECT_NE(program->notes[0].message.find("wide for particles"), std::string::npos)
        << program->notes[0].message;
}

TEST(Simulation, ATimeWithoutEndIsRefusedAtOnce) {
    Played played(liveOf(R"("rate": 10)", ""));
    for (const double seconds : {1e12, double(HUGE_VAL), std::nan("")})
        EXPECT_THROW(played.goTo(seconds), SystemError);
    EXPECT_TRUE(played.goTo(-1e12));
    EXPECT_TRUE(played.goTo(0.5));
    Played still(liveOf(R"("rate": 0, "burst": 10)", "none"));
    EXPECT_THROW(still.goTo(1e12), SystemError);
}

TEST(Simulation, TooManyAreRefusedAndNoneIsFine) {
    for (const char* rate : {"1e7", "1e30"}) {
        Played player(liveOf(R"("lifetime": 60, "rate": )" + std::string(rate), ""));
        const Result<bool> gone =
            player.simulation.goTo(1.0, [&](double at) { return player.live.valuesAt(at); });
        ASSERT_FALSE(gone);
        EXPECT_NE(gone.error().message.find("more than 4000000"), std::string::npos) << gone.error().message;
        EXPECT_NE(gone.error().message.find("lower the rate"), std::string::npos) << gone.error().message;
    }
    Played none(liveOf(R"("rate": 0)", ""));
    const auto noStep = [](int, int) { return ADD_FAILURE() << "the start is no step", false; };
    EXPECT_TRUE(none.simulation.goTo(
        0.0, [&](double at) { return none.live.valuesAt(at); }, noStep));
    none.goTo(2.0);
    EXPECT_TRUE(none.alive().empty());
    int told = 0;
    const Result<bool> ended = none.simulation.goTo(
        9.0, [&](double at) { return none.live.valuesAt(at); },
        [&](int, int all) {
            EXPECT_EQ(all, 420);
            return ++told < 5;
        });
    EXPECT_FALSE(ended);
    EXPECT_EQ(told, 5);
}

/// A column of water beside a ball, in a tank of 2 by 1 by 1 m.
LiveProgram water(const std::string& inputs = "", const std::string& source = "column",
                  const std::string& keys = "") {
    const std::string text = R"({"fieldwright": 1, "nodes": [
        {"id": "cube", "type": "box", "inputs": {"half_extents": [0.4, 0.4, 0.5]}},
        {"id": "column", "type": "translate", "inputs": {"surface": {"from": "cube"}, "offset": [-0.6, 0.4, 0]}},
        {"id": "ball", "type": "sphere", "inputs": {"radius": 0.3}},
        {"id": "fluid", "type": "sph_fluid", "inputs": {"source": {"from": ")" +
                             source + R"("}, "collide": {"from": "ball"}, "spacing": 0.08,
            "tank_min": [-1, 0, -0.5], "tank_max": [1, 1.5, 0.5])" +
                             inputs + R"(}},
        {"id": "field", "type": "particles_to_field", "inputs": {"particles": {"from": "fluid"}, "radius": 0.16}},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "field"}}}])" +
                             keys + "}";
    Result<Graph> graph = parseGraph(text, "test.field.json", nullptr);
    if (!graph) throw SystemError(format(graph.error()));
    Result<LiveProgram> live = compileLive(std::move(*graph), {});
    if (!live) throw SystemError(format(live.error()));
    return std::move(*live);
}

TEST(Simulation, WaterFlowsAroundWhatIsInItsWay) {
    Played player(water());
    player.goTo(0.0);
    // As many as fit between the walls, and leave the ball half a spacing.
    std::size_t room = 0;
    for (int z = 0; z < 12; ++z)
        for (int y = 0; y < 10; ++y)
            for (int x = 0; x < 10; ++x)
                room += glm::length(glm::vec3(x, y, z) * 0.08f - glm::vec3(0.96f, -0.04f, 0.46f)) >= 0.34f;
    const std::size_t count = player.alive().size();
    EXPECT_EQ(count, room);
    EXPECT_LT(room, 10u * 10u * 12u);
    for (const double time : {0.25, 0.5, 1.0, 2.0}) {
        player.goTo(time);
        const std::vector<glm::vec4> alive = player.alive();
        EXPECT_EQ(alive.size(), count);
        for (const glm::vec4& p : alive) {
            ASSERT_TRUE(std::abs(p.x) <= 1.0f && p.y >= 0.0f && p.y <= 1.5f && std::abs(p.z) <= 0.5f);
            ASSERT_GT(glm::length(glm::vec3(p)), 0.3f - 1e-4f);
        }
    }
    const std::vector<glm::vec4> last = player.places();
    EXPECT_GT(std::ranges::count_if(last, [](const glm::vec4& p) { return p.x > 0.5f; }), 100);
    // And the same again, whichever way it is reached.
    player.goTo(0.5);
    player.goTo(2.0);
    expectSame(player.places(), last);
    Played other(water());
    other.goTo(2.0);
    expectSame(other.places(), last);
}

/// A fluid in a tank of 4 by 2 by 0.64 m, and a box, which moves as the track says, in its way.
LiveProgram pushed(const std::string& size, const std::string& water, const std::string& keys,
                   const std::string& inputs = "") {
    const std::string text = R"({"fieldwright": 1, "nodes": [
        {"id": "block", "type": "box", "inputs": {"half_extents": )" +
                             size + R"(}},
        {"id": "piston", "type": "translate", "inputs": {"surface": {"from": "block"}}},
        {"id": "lake", "type": "expression", "code": ")" +
                             water + R"("},
        {"id": "fluid", "type": "sph_fluid", "inputs": {"source": {"from": "lake"}, "collide": {"from": "piston"},
            "spacing": 0.08, "tank_min": [0, 0, 0], "tank_max": [4, 2, 0.64])" +
                             inputs + R"(}},
        {"id": "field", "type": "particles_to_field", "inputs": {"particles": {"from": "fluid"}, "radius": 0.16}},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "field"}}}],
        "timeline": {"length": 60, "tracks": [{"node": "piston", "input": "offset", "keys": [)" +
                             keys + "]}]}}";
    Result<Graph> graph = parseGraph(text, "test.field.json", nullptr);
    if (!graph) throw SystemError(format(graph.error()));
    Result<LiveProgram> live = compileLive(std::move(*graph), {});
    if (!live) throw SystemError(format(live.error()));
    return std::move(*live);
}

std::vector<glm::vec4> velocitiesOf(const Played& player) {
    return download<glm::vec4>(device(), *player.simulation.velocities(), player.simulation.slots());
}

TEST(Simulation, APistonPushesWaterUpByWhatItDisplaces) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "an experiment of half a minute: FIELDWRIGHT_LONG";
    // From the left wall, a metre in two seconds, once 0.48 m of water lie still: they come to stand a third
    // higher.
    Played player(pushed("[2, 3, 3]", "return p.y - 0.48;",
                         R"({"time": 2, "value": [-2, 1, 0]}, {"time": 4, "value": [-1, 1, 0]})",
                         R"(, "viscosity": 10, "error": 0.003)"));
    const auto height = [&](double seconds, float piston) {
        player.goTo(seconds);
        double mean = 0.0;
        const std::vector<glm::vec4> places = player.places();
        for (const glm::vec4& p : places) {
            EXPECT_GE(p.x, piston - 1e-4f);
            mean += p.y / double(places.size());
        }
        return mean;
    };
    const double before = height(2.0, 0.0f), after = height(9.0, 1.0f);
    std::printf("a piston that takes a fourth of the tank: water stands %.3f times as high\n",
                after / before);
    EXPECT_NEAR(after / before, 4.0 / 3.0, 0.02 * 4.0 / 3.0);
}

TEST(Simulation, WhatAPistonPushesGetsItsSpeed) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "some ten seconds: with FIELDWRIGHT_LONG";
    // Whatever the parts of a step; without weight. One particle has it exactly; a block springs off a
    // little, for what is squeezed moves what is before it.
    for (const char* parts : {"0", "1", "5"})
        for (const bool block : {false, true}) {
            Played player(pushed(
                "[2, 3, 3]",
                block ? "return abs(p.x - 1.2) - 0.2;" : "return length(p - vec3(1.24, 1, 0.36)) - 0.05;",
                R"({"time": 0, "value": [-1.2, 1, 0]}, {"time": 1, "value": [0.3, 1, 0]})",
                R"(, "gravity": [0, 0, 0], "error": 0.001, "substeps": )" + std::string(parts)));
            player.goTo(0.75);
            double mean = 0.0;
            const std::vector<glm::vec4> velocities = velocitiesOf(player);
            for (const glm::vec4& v : velocities) mean += v.x / double(velocities.size());
            std::printf("a piston of 1.5 m/s, %s parts, %s: %.3f m/s\n", parts,
                        block ? "a block" : "a particle", mean);
            EXPECT_GT(mean, 1.49);
            EXPECT_LT(mean, block ? 2.1 : 1.51);
        }
}

TEST(Simulation, AWallThatMovesLetsNothingThrough) {
    // Two spacings thick, and more than one a step fast.
    Played player(pushed("[0.08, 3, 3]", "return max(abs(p.x - 1.2) - 0.4, p.y - 1.2);",
                         R"({"time": 0, "value": [0.5, 1, 0]}, {"time": 0.25, "value": [2.3, 1, 0]})"));
    for (int step = 0; step <= 30; ++step) {
        player.goTo(step / 60.0);
        const double wall = 0.5 + std::min(step / 60.0, 0.25) * 7.2;
        for (const glm::vec4& p : player.places()) ASSERT_GE(p.x, wall + 0.08 - 1e-3) << step;
    }
}

TEST(Simulation, AnObstacleThatJumpsHasNothingInItThen) {
    // A metre at once, in the midst of water that lies still.
    Played player(pushed(
        "[0.3, 0.3, 3]", "return p.y - 1.0;",
        R"({"time": 0, "value": [1, 0.5, 0], "interpolation": "step"}, {"time": 0.5, "value": [2, 0.5, 0]})"));
    for (const double time : {31.0 / 60.0, 2.0}) {
        player.goTo(time);
        for (const glm::vec4& p : player.places()) {
            ASSERT_TRUE(std::isfinite(p.x + p.y + p.z));
            ASSERT_GE(std::max(std::abs(p.x - 2.0f), std::abs(p.y - 0.5f)), 0.3f - 1e-3f);
        }
    }
}

TEST(Simulation, NorDoTheyToWater) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "some ten seconds: with FIELDWRIGHT_LONG";
    for (const char* input : {"viscosity", "tension", "spacing"})
        if (input == std::string("spacing") || std::getenv("FIELDWRIGHT_LONG"))
            expectNoHarm(water("", "column", trackOf("fluid", input, "1")));
    expectNoHarm(water("", "column", trackOf("fluid", "gravity", "[0, -9, 0]")));
}

TEST(Simulation, ATankWhoseSidesMeetIsRefusedWithTheTime) {
    Played player(water("", "column", R"(, "timeline": {"tracks": [{"node": "fluid", "input": "tank_max",
        "keys": [{"time": 0, "value": [1, 1.5, 0.5]}, {"time": 1, "value": [1, -1.5, 0.5]}]}]})"));
    const auto values = [&](double at) { return player.live.valuesAt(at); };
    EXPECT_TRUE(player.simulation.goTo(0.25, values));
    const Result<bool> gone = player.simulation.goTo(1.0, values);
    ASSERT_FALSE(gone);
    EXPECT_NE(gone.error().message.find("(at 0.5 s)"), std::string::npos) << gone.error().message;
}

/// A tap of 0.2 by 0.2 m in a tank of 0.8 by 1 by 0.8 m, from which water falls at 1.5 m/s: 16 particles a
/// layer.
LiveProgram tap(const std::string& inputs, const std::string& speed = "1.5",
                const std::string& spacing = "0.05") {
    const std::string text = R"({"fieldwright": 1, "nodes": [
        {"id": "block", "type": "box", "inputs": {"half_extents": [0.1, 0.05, 0.1]}},
        {"id": "tap", "type": "translate", "inputs": {"surface": {"from": "block"}, "offset": [0, 0.9, 0]}},
        {"id": "lake", "type": "expression", "code": "p.y - 0.5"},
        {"id": "hole", "type": "sphere", "inputs": {"radius": 0.2}},
        {"id": "fluid", "type": "sph_fluid", "inputs": {"inflow_velocity": [0, -)" +
                             speed + R"(, 0], "spacing": )" + spacing +
                             R"(, "tank_min": [-0.4, 0, -0.4], "tank_max": [0.4, 1, 0.4], )" + inputs + R"(}},
        {"id": "field", "type": "particles_to_field", "inputs": {"particles": {"from": "fluid"}, "radius": 0.1}},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "field"}}}]})";
    Result<Graph> graph = parseGraph(text, "test.field.json", nullptr);
    if (!graph) throw SystemError(format(graph.error()));
    Result<LiveProgram> live = compileLive(std::move(*graph), {});
    if (!live) throw SystemError(format(live.error()));
    return std::move(*live);
}
constexpr const char* kTap = R"("inflow": {"from": "tap"})";
constexpr const char* kHole = R"("outflow": {"from": "hole"})";
constexpr const char* kLake = R"("source": {"from": "lake"})";

TEST(Simulation, ATapFillsATankAtItsRate) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "a quarter of a minute: with FIELDWRIGHT_LONG";
    for (const double speed : {1.5, 0.7, 4.0}) {
        Played player(tap(kTap, std::to_string(speed)));
        player.goTo(0.0);
        EXPECT_EQ(player.simulation.slots(), 0u);
        for (const double time : {0.0, 0.02, 1.0, 2.0, 3.0}) {
            player.goTo(time);
            const double wanted = 0.2 * 0.2 * speed * time / std::pow(0.05, 3), layer = 16.0;
            EXPECT_NEAR(double(player.simulation.slots()), wanted, std::max(0.005 * wanted, layer)) << time;
            for (const glm::vec4& p : player.alive())
                ASSERT_TRUE(std::abs(p.x) <= 0.4f && p.y >= 0.0f && p.y <= 1.0f && std::abs(p.z) <= 0.4f);
        }
        EXPECT_NEAR(player.simulation.slots() * std::pow(0.05, 3) / (0.2 * 0.2 * speed * 3.0), 1.0, 0.02);
    }
}

TEST(Simulation, WhatFlowsInIsAsDenseAsAtRest) {
    // Without weight, and before anything is met: a lattice that drifts.
    Played player(tap(std::string(kTap) + R"(, "gravity": [0, 0, 0])"));
    player.goTo(0.5);
    const std::vector<glm::vec4> alive = player.alive();
    ASSERT_GT(alive.size(), 200u);
    for (const glm::vec4& p : alive) {
        float nearest = 1.0f;
        for (const glm::vec4& other : alive)
            if (&other != &p) nearest = std::min(nearest, glm::distance(glm::vec3(p), glm::vec3(other)));
        ASSERT_NEAR(nearest, 0.05f, 0.003f);
    }
}

TEST(Simulation, ADrainEmptiesATank) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "a quarter of a minute: with FIELDWRIGHT_LONG";
    Played player(tap(std::string(kLake) + ", " + kHole));
    player.goTo(0.0);
    uint32_t left = player.simulation.slots();
    EXPECT_EQ(left, 16u * 10u * 16u);
    for (const double time : {1.0 / 60, 0.25, 0.5, 1.0, 3.0, 5.0}) {
        player.goTo(time);
        EXPECT_LT(player.simulation.slots(), left) << time;
        left = player.simulation.slots();
        for (const glm::vec4& p : player.alive()) ASSERT_GE(glm::length(glm::vec3(p)), 0.2f - 1e-5f);
    }
    EXPECT_LT(left, 16u * 10u * 16u / 20);
}

TEST(Simulation, NoMoreFlowsInThanMayBe) {
    Played player(tap(std::string(kTap) + R"(, "most": 300)"));
    for (const double time : {0.5, 1.0, 2.0}) {
        player.goTo(time);
        EXPECT_LE(player.simulation.slots(), 300u);
    }
    EXPECT_EQ(player.simulation.slots(), 300u);
}

TEST(Simulation, WhatFlowsInAndOutIsTheSameHoweverATimeIsReached) {
    const std::string inputs = std::string(kTap) + ", " + kHole + R"(, "most": 500)";
    Played player(tap(inputs));
    player.goTo(3.0);
    const std::vector<glm::vec4> last = player.places();
    EXPECT_GT(last.size(), 100u);
    EXPECT_LT(last.size(), 500u);
    player.goTo(0.0);
    EXPECT_TRUE(player.places().empty());
    for (const double time : {0.7, 0.3, 3.0}) player.goTo(time);
    expectSame(player.places(), last);
    Played other(tap(inputs));
    other.goTo(3.0);
    expectSame(other.places(), last);
    other.simulation.valuesChanged();
    other.goTo(1.0);
    other.goTo(3.0);
    expectSame(other.places(), last);
}

TEST(Simulation, ManyKeepTheirOrderWhereSomeLeave) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "a quarter of a minute: with FIELDWRIGHT_LONG";
    // More than a sort puts in order of one key.
    Played player(tap(std::string(kLake) + ", " + kHole, "1", "0.03"));
    Played other(tap(std::string(kLake) + ", " + kHole, "1", "0.03"));
    for (Played* each : {&player, &other}) each->goTo(0.2);
    EXPECT_GT(player.simulation.slots(), 5000u);
    expectSame(player.places(), other.places());
}

TEST(Simulation, WaterThatCannotBeIsRefused) {
    const auto says = [](const std::string& inputs, const std::string& source, const std::string& what) {
        std::string message;
        try {
            Played player(water(inputs, source));
            const Result<bool> gone =
                player.simulation.goTo(0.0, [&](double at) { return player.live.valuesAt(at); });
            message = gone ? "went" : format(gone.error());
        } catch (const SystemError& error) { message = error.what(); }
        EXPECT_NE(message.find(what), std::string::npos) << message;
    };
    says(R"(, "tank_max": [1, -1, 0.5])", "column", "stands twice");
    says(R"(, "substeps": 2)", "column", "went");
    says("", "cube", "went");
    says(R"(, "gravity": [0, 0, 0], "velocity": [1, 0, 0])", "column", "went");
    Graph far = water().graph;
    for (Node& node : far.nodes)
        if (node.id == "column") node.set("offset", {std::vector<double>{9, 0, 0}});
    Result<LiveProgram> live = compileLive(far, {});
    ASSERT_TRUE(live);
    Played away(std::move(*live));
    const Result<bool> gone = away.simulation.goTo(0.0, [&](double at) { return away.live.valuesAt(at); });
    ASSERT_FALSE(gone);
    EXPECT_NE(format(gone.error()).find("node 'fluid': no place of the source is in the tank"),
              std::string::npos)
        << format(gone.error());
    Graph full = water().graph;  // of the ball
    for (Node& node : full.nodes)
        if (node.id == "ball") node.set("radius", {9.0});
    live = compileLive(full, {});
    ASSERT_TRUE(live);
    Played stuck(std::move(*live));
    const Result<bool> none = stuck.simulation.goTo(0.0, [&](double at) { return stuck.live.valuesAt(at); });
    ASSERT_FALSE(none);
    EXPECT_NE(none.error().message.find("in the tank and free"), std::string::npos) << none.error().message;
    for (Node& node : far.nodes)
        if (node.id == "fluid") node.set("tank_max", {std::vector<double>{1, -1, 1}});
    live = compileLive(far, {});
    ASSERT_FALSE(live);
    EXPECT_NE(format(live.error()).find("above tank_min along y"), std::string::npos) << format(live.error());
}

}  // namespace fw::simulation_test
