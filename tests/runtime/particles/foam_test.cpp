// Spray, foam and bubbles: where a fluid gives them off, how each moves, and the same bytes whichever way a
// time is reached.
#include "runtime/particles/foam.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <random>

#include "graph/assets/particle_file.h"
#include "graph/check/check.h"
#include "graph/compile/live_program.h"
#include "graph/document/json.h"
#include "runtime/export/points.h"
#include "runtime/particles/particle_fields.h"
#include "runtime/play/particles_at.h"
#include "runtime/play/player.h"
#include "shaders/shared.h"
#include "tests/support/command.h"
#include "tests/support/golden.h"
#include "tests/support/gpu.h"
#include "tests/support/graph/temp_dir.h"

#include "shaders/particles/foam.h"

namespace fw::foam_test {

using test::device;

constexpr const char* kColumn = "max(max(p.x - 0.4, p.y - 0.6), -1)";
constexpr const char* kLake = "p.y - 0.4";

/// A tank of 1.2 by 1 by 0.24 m with some water, and its foam in a field; and what else the nodes get.
std::string textOf(const std::string& water, const std::string& foam = "", const std::string& fluid = "",
                   const std::string& more = "", const std::string& keys = "") {
    const auto added = [](const std::string& inputs) { return inputs.empty() ? "" : ", " + inputs; };
    return R"({"fieldwright": 1, "nodes": [
        {"id": "full", "type": "expression", "code": ")" +
           water + R"("},
        {"id": "water", "type": "sph_fluid", "inputs": {"source": {"from": "full"}, "spacing": 0.04,
            "tank_min": [0, 0, 0], "tank_max": [1.2, 1, 0.24])" +
           added(fluid) + R"(}},
        {"id": "white", "type": "foam", "inputs": {"particles": {"from": "water"})" +
           added(foam) + R"(}},)" + more + R"(
        {"id": "field", "type": "particles_to_field", "inputs": {"particles": {"from": "white"}, "radius": 0.08,
            "resolution": 32}},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "field"}}}])" +
           keys + "}";
}

LiveProgram liveOf(const std::string& text) {
    Result<Graph> graph = parseGraph(text, "test.field.json", nullptr);
    if (!graph) throw SystemError(format(graph.error()));
    Result<LiveProgram> live = compileLive(std::move(*graph), {});
    if (!live) throw SystemError(format(live.error()));
    return std::move(*live);
}

/// What a slot of foam holds.
struct Slot {
    glm::vec3 place, velocity;
    float age;
    int kind;
};

struct Played {
    explicit Played(const std::string& text)
        : live(liveOf(text)), simulation(device(), live.program.ir.volumes()[0]->particles) {}
    void goTo(double seconds) {
        const Result<bool> changed = simulation.goTo(seconds, [&](double at) { return live.valuesAt(at); });
        if (!changed) throw SystemError(changed.error().message);
    }
    std::vector<glm::vec4> places() { return read(simulation.places()); }
    std::vector<glm::vec4> velocities() { return read(*simulation.velocities()); }
    /// By their slots.
    std::map<std::size_t, Slot> slots() {
        std::map<std::size_t, Slot> found;
        const std::vector<glm::vec4> at = places(), fast = velocities();
        for (std::size_t i = 0; i < at.size(); ++i)
            if (!std::isnan(at[i].x)) found[i] = {at[i], fast[i], at[i].w, int(fast[i].w)};
        return found;
    }
    std::vector<glm::vec4> read(const Buffer& buffer) {
        return download<glm::vec4>(device(), buffer, simulation.slots());
    }
    LiveProgram live;
    Simulation simulation;
};

std::size_t countOf(const std::map<std::size_t, Slot>& slots, int kind) {
    return std::size_t(
        std::ranges::count_if(slots, [&](const auto& slot) { return slot.second.kind == kind; }));
}

bool sameBytes(const std::vector<glm::vec4>& a, const std::vector<glm::vec4>& b) {
    return std::ranges::equal(a, b, [](const glm::vec4& p, const glm::vec4& q) {
        for (int k = 0; k < 4; ++k)
            if (std::bit_cast<uint32_t>(p[k]) != std::bit_cast<uint32_t>(q[k])) return false;
        return true;
    });
}

TEST(Foam, StillWaterGivesOffNone) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "a quarter of a minute: with FIELDWRIGHT_LONG";
    Played player(textOf(kLake));
    for (const double time : {0.0, 0.5, 1.0, 2.0}) {
        player.goTo(time);
        EXPECT_TRUE(player.slots().empty()) << time;
    }
}

TEST(Foam, TornWaterGivesOffEveryKindAndItAllStaysInTheTank) {
    Played player(textOf(kColumn));
    std::size_t most[3] = {};
    for (int step = 0; step <= 90; step += 6) {
        player.goTo(step / 60.0);
        const auto slots = player.slots();
        for (const auto& [slot, foam] : slots) {
            ASSERT_TRUE(foam.kind >= FOAM_SPRAY && foam.kind <= FOAM_BUBBLE);
            for (int k = 0; k < 3; ++k) {
                ASSERT_TRUE(foam.place[k] >= 0.0f && foam.place[k] <= glm::vec3(1.2f, 1.0f, 0.24f)[k]);
                ASSERT_TRUE(std::abs(foam.velocity[k]) < 20.0f);  // not where it is no number
            }
            ASSERT_TRUE(foam.age >= 0.0f && foam.age <= 1.5f * 3.0f);
        }
        for (int kind = 0; kind < 3; ++kind) most[kind] = std::max(most[kind], countOf(slots, kind));
    }
    std::printf("a column that breaks: at most %zu of spray, %zu of foam, %zu bubbles\n", most[0], most[1],
                most[2]);
    for (const std::size_t each : most) EXPECT_GT(each, 20u);
}

TEST(Foam, SprayFliesInAParabola) {
    // While it is spray it keeps its slot and meets nothing.
    Played player(textOf(kColumn));
    player.goTo(0.4);
    auto before = player.slots();
    const glm::vec3 gravity(0.0f, -9.81f, 0.0f);
    constexpr float kStep = 1.0f / 60;
    std::size_t followed = 0;
    std::map<std::size_t, std::pair<Slot, int>> flights;  // from where, and the step
    for (int step = 0; step < 40; ++step) {
        player.goTo(0.4 + (step + 1) / 60.0);
        const auto after = player.slots();
        for (const auto& [slot, foam] : after) {
            const auto was = before.find(slot);
            const bool flew = was != before.end() && was->second.kind == FOAM_SPRAY &&
                              foam.kind == FOAM_SPRAY && foam.age == was->second.age;
            // A slot may have been taken by another: then it has another velocity.
            if (!flew || glm::distance(foam.velocity, was->second.velocity + kStep * gravity) > 1e-4f) {
                flights.erase(slot);
                continue;
            }
            const auto& [from, since] = flights.try_emplace(slot, was->second, step).first->second;
            const float time = float(step + 1 - since) * kStep;
            const glm::vec3 wanted = from.place + time * from.velocity + 0.5f * time * time * gravity;
            ASSERT_LT(glm::distance(foam.place, wanted), 1e-5f) << time;
            ++followed;
        }
        before = after;
    }
    std::printf("spray was followed over %zu steps\n", followed);
    EXPECT_GT(followed, 200u);
}

/// Foam of the test's own in a lake that has come to rest, 0.48 m deep.
struct Lake {
    explicit Lake(const std::vector<glm::vec3>& places, float lifetime = 3.0f) {
        config.lo = glm::vec3(0.0f), config.hi = glm::vec3(0.8f, 1.0f, 0.24f), config.spacing = 0.04f;
        config.viscosity = 20.0f;
        setFluid(device(), fluid, fluidBlock(config.lo, {0.8f, 0.48f, 0.24f}, config.spacing), {});
        Commands commands(device());
        EXPECT_TRUE(recordSettling(commands, kernels, fluid, config));
        EXPECT_TRUE(recordFluidSteps(commands, kernels, fluid, config, 1.0f / 240, 480));
        submit(commands);
        foaming.amount = 0.0f, foaming.lifetime = lifetime;
        if (places.empty()) return;
        clearFoam(device(), foam, uint32_t(places.size()));
        std::vector<glm::vec4> at, fast;
        for (const glm::vec3& place : places)
            at.emplace_back(place, 0.0f), fast.emplace_back(0.0f, 0.0f, 0.0f, FOAM_FOAM + 0.5f);
        upload(device(), foam.places, at);
        upload(device(), foam.velocities, fast);
    }
    void run(int steps) {
        Commands commands(device());
        for (int i = 0; i < steps; ++i) {
            EXPECT_TRUE(recordFluidSteps(commands, kernels, fluid, config, 1.0f / 240, 4));
            recordFoamStep(commands, foamKernels, foam, foaming, fluid, config, 1.0f / 60);
        }
        submit(commands);
    }
    std::vector<Slot> slots() {
        const auto at = download<glm::vec4>(device(), foam.places, foam.slots),
                   fast = download<glm::vec4>(device(), foam.velocities, foam.slots);
        std::vector<Slot> all;
        for (std::size_t i = 0; i < at.size(); ++i)
            all.push_back({at[i], fast[i], at[i].w, int(std::floor(fast[i].w))});
        return all;
    }
    FluidKernels kernels = createFluidKernels(device(), {});
    FoamKernels foamKernels = createFoamKernels(device(), {});
    FluidConfig config;
    FoamConfig foaming;
    FluidParticles fluid;
    FoamParticles foam;
};

std::vector<glm::vec3> rowAt(float height) {
    std::vector<glm::vec3> places;
    for (int i = 0; i < 20; ++i) places.emplace_back(0.1f + 0.03f * float(i), height, 0.12f);
    return places;
}

TEST(Foam, BubblesRiseAtTheirSpeedAndBecomeFoam) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "a quarter of a minute: with FIELDWRIGHT_LONG";
    Lake lake(rowAt(0.1f));
    lake.run(30);
    for (const Slot& bubble : lake.slots()) {
        EXPECT_EQ(bubble.kind, FOAM_BUBBLE);
        EXPECT_NEAR(bubble.velocity.y, 0.025f * 9.81f, 0.01f);
        EXPECT_NEAR(bubble.place.y, 0.1f + 0.5f * 0.025f * 9.81f, 0.01f);
        EXPECT_EQ(bubble.age, 0.0f);
    }
    lake.run(90);
    for (const Slot& foam : lake.slots()) {
        EXPECT_EQ(foam.kind, FOAM_FOAM);
        EXPECT_NEAR(foam.place.y, 0.46f, 0.03f);
        EXPECT_GT(foam.age, 0.1f);
    }
}

TEST(Foam, FloatsUntilItsLifeEnds) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "a quarter of a minute: with FIELDWRIGHT_LONG";
    Lake lake(rowAt(0.475f), 0.5f);  // and their share of chance is a half
    lake.run(29);
    for (const Slot& foam : lake.slots()) {
        EXPECT_EQ(foam.kind, FOAM_FOAM);
        EXPECT_NEAR(foam.place.y, 0.475f, 0.01f);
        EXPECT_NEAR(foam.age, 29.0f / 60, 1e-4f);
    }
    lake.run(2);
    for (const Slot& foam : lake.slots()) EXPECT_TRUE(std::isnan(foam.place.x));
}

TEST(Foam, IsCarriedByTheWaterAboutIt) {
    Lake lake(rowAt(0.475f));
    upload(device(), lake.fluid.velocities,
           std::vector<glm::vec4>(lake.fluid.count, glm::vec4(0.6f, 0.0f, 0.0f, 0.0f)));
    lake.run(1);
    const auto fast = download<glm::vec4>(device(), lake.fluid.velocities, lake.fluid.count),
               at = download<glm::vec4>(device(), lake.fluid.places, lake.fluid.count);
    for (const Slot& foam : lake.slots()) {
        EXPECT_EQ(foam.kind, FOAM_FOAM);
        glm::vec3 least(1e9f), most(-1e9f);
        for (std::size_t i = 0; i < at.size(); ++i)
            if (glm::distance(glm::vec3(at[i]), foam.place) < 0.1f)
                least = glm::min(least, glm::vec3(fast[i])), most = glm::max(most, glm::vec3(fast[i]));
        for (int k = 0; k < 3; ++k) {
            EXPECT_GE(foam.velocity[k], least[k] - 1e-5f);
            EXPECT_LE(foam.velocity[k], most[k] + 1e-5f);
        }
    }
    const Slot middle = lake.slots()[10];  // far from the walls that stop the water
    EXPECT_NEAR(middle.velocity.x, 0.6f, 0.1f);
    EXPECT_NEAR(middle.place.x, 0.4f + middle.velocity.x / 60, 1e-5f);
}

TEST(Foam, ThereIsNeverMoreThanMayBe) {
    Played player(textOf(kColumn, R"("most": 150)"));
    std::size_t most = 0;
    for (int step = 0; step <= 60; step += 3) {
        player.goTo(step / 60.0);
        EXPECT_EQ(player.simulation.slots(), 150u);
        most = std::max(most, player.slots().size());
    }
    EXPECT_EQ(most, 150u);  // all are taken
}

TEST(Foam, BirthsAreThinnedAlikeEverywhere) {
    // Water that is torn all over gives off far more than there is room for: what comes is from all of it.
    Lake lake({});
    clearFoam(device(), lake.foam, 200);
    lake.foaming.amount = 600.0f;
    std::vector<glm::vec4> velocities;
    std::mt19937 random(5);
    const auto any = [&] { return 4.0f * (float(random() % 1024) / 512.0f - 1.0f); };
    for (uint32_t i = 0; i < lake.fluid.count; ++i) velocities.emplace_back(any(), any(), any(), 0.0f);
    upload(device(), lake.fluid.velocities, velocities);
    lake.run(1);
    std::vector<float> z;
    for (const Slot& foam : lake.slots())
        if (!std::isnan(foam.place.z)) z.push_back(foam.place.z);
    std::ranges::sort(z);
    ASSERT_GT(z.size(), 150u);                  // spray may be lost at the walls at once
    for (const double share : {0.1, 0.5, 0.9})  // cells come by z
        EXPECT_NEAR(z[std::size_t(share * double(z.size()))], share * 0.24, 0.03) << share;
}

TEST(Foam, ATimeIsTheSameHoweverItIsReached) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "some ten seconds: with FIELDWRIGHT_LONG";
    const std::string text = textOf(kColumn, R"("kinds": "spray", "most": 3000)");
    Played player(text);
    std::map<double, std::pair<std::vector<glm::vec4>, std::vector<glm::vec4>>> known;
    for (const double time : {0.2, 0.35, 0.5, 0.8}) {
        player.goTo(time);
        known[time] = {player.places(), player.velocities()};
    }
    EXPECT_FALSE(sameBytes(known[0.5].first, known[0.8].first));
    const auto expectKnown = [&](Played& other, double time) {
        EXPECT_TRUE(sameBytes(other.places(), known[time].first)) << time;
        EXPECT_TRUE(sameBytes(other.velocities(), known[time].second)) << time;
    };
    for (const double time : {0.5, 0.2, 0.8, 0.35}) {
        player.goTo(time);
        expectKnown(player, time);
    }
    Played other(text);
    other.goTo(0.8);
    expectKnown(other, 0.8);
    other.simulation.valuesChanged();  // and all is simulated again
    other.goTo(0.35);
    expectKnown(other, 0.35);
    // Another seed is other foam of the same fluid.
    Played seeded(textOf(kColumn, R"("kinds": "spray", "most": 3000, "seed": 7)"));
    seeded.goTo(0.5);
    EXPECT_FALSE(sameBytes(seeded.places(), known[0.5].first));
}

TEST(Foam, WhatIsShownIsThatOfTheStepAlsoWhereThatWasCancelled) {
    const std::string text = textOf(kColumn, R"("kinds": "spray")");
    Played cancelled(text), fresh(text);
    const Result<bool> gone = cancelled.simulation.goTo(
        0.5, [&](double at) { return cancelled.live.valuesAt(at); },
        [](int done, int all) { return done < all; });
    EXPECT_FALSE(gone);
    cancelled.goTo(0.5), fresh.goTo(0.5);
    EXPECT_GT(fresh.slots().size(), 0u);
    EXPECT_TRUE(sameBytes(cancelled.places(), fresh.places()));
}

TEST(Foam, ComesWhereItsWaterIs) {
    // All of the water flies by 0.1 m in the first step.
    Played player(textOf("p.x - 0.4", R"("amount": 3000)", R"("velocity": [6, 0, 0], "gravity": [0, 0, 0])"));
    player.goTo(1.0 / 60);
    const auto slots = player.slots();
    ASSERT_GT(slots.size(), 100u);
    float least = 10.0f, most = -10.0f;
    for (const auto& [slot, foam] : slots)
        least = std::min(least, foam.place.x), most = std::max(most, foam.place.x);
    std::printf("water is up to 0.5 m, foam from %.3f m to %.3f m\n", least, most);
    EXPECT_LT(most, 0.5f);
    EXPECT_GT(most, 0.42f);
}

TEST(Foam, KindsArePartsOfOne) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "some ten seconds: with FIELDWRIGHT_LONG";
    Played all(textOf(kColumn));
    all.goTo(0.6);
    const std::vector<glm::vec4> places = all.places();
    const auto slots = all.slots();
    std::size_t sum = 0;
    for (int kind = 0; kind < 3; ++kind) {
        static constexpr const char* kNames[] = {"spray", "foam", "bubbles"};
        Played one(textOf(kColumn, R"("kinds": ")" + std::string(kNames[kind]) + '"'));
        one.goTo(0.6);
        const auto own = one.slots();
        EXPECT_EQ(own.size(), countOf(slots, kind));
        for (const auto& [slot, foam] : own) {
            ASSERT_TRUE(slots.contains(slot));
            EXPECT_EQ(slots.at(slot).kind, kind);
            EXPECT_EQ(slots.at(slot).place, foam.place);
        }
        sum += own.size();
    }
    EXPECT_EQ(sum, slots.size());
}

TEST(Foam, StaysOutOfWhatIsInTheWay) {
    Played player(textOf(kColumn, "", R"("collide": {"from": "post"})",
                         R"({"id": "ball", "type": "sphere", "inputs": {"radius": 0.15}},
                            {"id": "post", "type": "translate", "inputs": {"surface": {"from": "ball"}, "offset": [0.75, 0.1, 0.12]}},)"));
    std::size_t seen = 0;
    for (const double time : {0.3, 0.4, 0.5, 0.7, 1.0}) {
        player.goTo(time);
        for (const auto& [slot, foam] : player.slots()) {
            ASSERT_GE(glm::distance(foam.place, glm::vec3(0.75f, 0.1f, 0.12f)), 0.15f - 1e-4f);
            ++seen;
        }
    }
    EXPECT_GT(seen, 500u);
}

TEST(Foam, OfAFluidThatBeginsWithNothingAndComesAndGoes) {
    Played player(textOf(
        "1", "", R"("inflow": {"from": "tap"}, "inflow_velocity": [0, -3, 0], "outflow": {"from": "hole"})",
        R"({"id": "block", "type": "box", "inputs": {"half_extents": [0.1, 0.06, 0.1]}},
                            {"id": "tap", "type": "translate", "inputs": {"surface": {"from": "block"}, "offset": [0.3, 0.9, 0.12]}},
                            {"id": "hole", "type": "sphere", "inputs": {"radius": 0.2}},)"));
    player.goTo(0.0);
    EXPECT_TRUE(player.slots().empty());
    player.goTo(0.7);
    const std::vector<glm::vec4> places = player.places();
    EXPECT_GT(player.slots().size(), 20u);
    player.goTo(0.1);
    player.goTo(0.7);
    EXPECT_TRUE(sameBytes(player.places(), places));
}

TEST(Foam, AFluidAndItsFoamAreSimulatedAsOne) {
    // Both in one graph give the bytes that each gives alone, and the fluid has flowed once: the simulations
    // that work is reported of.
    const std::string more =
        R"({"id": "blue", "type": "particles_to_field", "inputs": {"particles": {"from": "water"}, "resolution": 32}},)";
    const auto texelsOf = [](const LiveProgram& live, int& told) {
        const Program& program = live.program;
        std::size_t texels = 0;
        for (const FieldVolumePtr& volume : program.ir.volumes()) texels += texelCount(*volume);
        Buffer volumes;
        reserve(device(), volumes, kTexelBytes * texels);
        ParticleFields fields(device());
        fields.setProgram(program);
        told = 0;
        const auto made = fields.make(
            program, 0.5, [&](double at) { return live.valuesAt(at); }, volumes, true,
            [&](int, int) { return ++told, true; });
        EXPECT_TRUE(made && made->places && made->fields);
        std::map<std::string, std::vector<uint32_t>> words;
        for (const FieldVolumePtr& volume : downloadParticles(device(), program, volumes))
            words[volume->particles->node] = volume->words;
        const auto again = fields.make(
            program, 0.5, [&](double at) { return live.valuesAt(at); }, volumes);
        EXPECT_TRUE(again && !again->places && !again->fields);
        // Another time is another field of both.
        const auto later = fields.make(
            program, 0.55, [&](double at) { return live.valuesAt(at); }, volumes);
        EXPECT_TRUE(later && later->places && later->fields);
        for (const FieldVolumePtr& volume : downloadParticles(device(), program, volumes))
            EXPECT_NE(words[volume->particles->node], volume->words) << volume->particles->node;
        return words;
    };
    const auto shown = [&](const std::string& surface) {
        std::string text = textOf(kColumn, "", "", more + R"({"id": "both", "type": "union", "inputs": {
            "a": {"from": "blue"}, "b": {"from": "field"}}},)");
        const std::string out = R"("surface": {"from": "field"}}}])";
        return text.replace(text.find(out), out.size(), R"("surface": {"from": ")" + surface + R"("}}}])");
    };
    int together = 0, blue = 0, white = 0;
    auto both = texelsOf(liveOf(shown("both")), together);
    EXPECT_EQ(both.size(), 2u);
    EXPECT_EQ(both["blue"], texelsOf(liveOf(shown("blue")), blue)["blue"]);
    EXPECT_EQ(both["field"], texelsOf(liveOf(shown("field")), white)["field"]);
    EXPECT_EQ(together, 30);
    EXPECT_EQ(blue, 30);
    EXPECT_EQ(white, 30);
}

TEST(Foam, WrongWiringIsAnError) {
    const auto messages = [](const std::string& nodes) {
        const std::string text = R"({"fieldwright": 1, "nodes": [)" + nodes + R"(,
            {"id": "field", "type": "particles_to_field", "inputs": {"particles": {"from": "last"}}},
            {"id": "out", "type": "output", "inputs": {"surface": {"from": "field"}}}]})";
        const Result<Graph> graph = parseGraph(text, "test.field.json", nullptr);
        std::string all;
        if (!graph) return format(graph.error());
        for (const Error& finding : check(*graph)) all += format(finding) + "\n";
        return all;
    };
    const std::string fluid = R"({"id": "ball", "type": "sphere"},
        {"id": "water", "type": "sph_fluid", "inputs": {"source": {"from": "ball"}}},)";
    const std::string ofEmitter = messages(R"({"id": "rain", "type": "emitter"},
        {"id": "last", "type": "foam", "inputs": {"particles": {"from": "rain"}}})");
    EXPECT_NE(ofEmitter.find("'last'"), std::string::npos) << ofEmitter;
    EXPECT_NE(ofEmitter.find("'rain' is none: link the sph_fluid itself"), std::string::npos) << ofEmitter;
    const std::string ofFoam = messages(fluid + R"(
        {"id": "first", "type": "foam", "inputs": {"particles": {"from": "water"}}},
        {"id": "last", "type": "foam", "inputs": {"particles": {"from": "first"}}})");
    EXPECT_NE(ofFoam.find("'first' is none: link the sph_fluid itself"), std::string::npos) << ofFoam;
    const std::string moved = messages(fluid + R"(
        {"id": "first", "type": "foam", "inputs": {"particles": {"from": "water"}}},
        {"id": "last", "type": "particle_dynamics", "inputs": {"particles": {"from": "first"}}})");
    EXPECT_NE(moved.find("foam goes with its fluid"), std::string::npos) << moved;
    EXPECT_EQ(
        messages(fluid + R"({"id": "last", "type": "foam", "inputs": {"particles": {"from": "water"}}})"),
        "");
    EXPECT_NE(messages(R"({"id": "last", "type": "foam"})"), "");  // nothing is linked
}

TEST(Foam, TheSampleLooksAsItDid) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "half a minute: with FIELDWRIGHT_LONG";
    Result<Player> player = Player::open(FIELDWRIGHT_SOURCE_DIR "/samples/breaker.field.json", {});
    ASSERT_TRUE(player) << format(player.error());
    player->seek(0.75);
    const Result<Picture> picture = player->frame({.width = 320, .height = 200, .samples = 8});
    ASSERT_TRUE(picture) << format(picture.error());
    test::expectGolden(*picture, "breaker_foam");
}

/// `fieldwright export --particles`, and what it writes.
struct PointsOfParticles : testing::Test {
    test::TempDir folder;
    std::string graph = folder.path("test.field.json");
    void SetUp() override { test::writeText(graph, textOf(kColumn)); }
    test::CommandResult exported(const std::string& node, const std::string& file,
                                 const std::string& time = "0.4") {
        return test::runCommand(
            {"export", graph, "--particles", node, "-o", folder.path(file), "--time", time});
    }
};

TEST_F(PointsOfParticles, AreReadAgainBitForBit) {
    Played player(textOf(kColumn));
    player.goTo(0.4);
    std::vector<glm::vec3> wanted;
    for (const auto& [slot, foam] : player.slots()) wanted.push_back(foam.place);
    ASSERT_GT(wanted.size(), 100u);
    for (const char* file : {"white.ply", "white.csv", "white.xyz", "WHITE.TXT"}) {
        const test::CommandResult result = exported("white", file);
        ASSERT_EQ(result.status, 0) << result.errors;
        EXPECT_EQ(result.errors, "");
        const Result<ParticlePlacesPtr> read = readParticlePlaces(graph, file);
        ASSERT_TRUE(read) << format(read.error());
        EXPECT_EQ((*read)->places, wanted) << file;
    }
    // The fluid's own, and a graph that reads them.
    ASSERT_EQ(exported("water", "water.ply").status, 0);
    test::writeText(folder.path("again.field.json"), R"({"fieldwright": 1, "nodes": [
        {"id": "points", "type": "particle_file", "inputs": {"path": "water.ply"}},
        {"id": "field", "type": "particles_to_field", "inputs": {"particles": {"from": "points"}}},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "field"}}}]})");
    const test::CommandResult again =
        test::runCommand({"export", folder.path("again.field.json"), "--particles", "points", "-o",
                          folder.path("points.ply")});
    ASSERT_EQ(again.status, 0) << again.errors;
    EXPECT_EQ((*readParticlePlaces(graph, "points.ply"))->places,
              (*readParticlePlaces(graph, "water.ply"))->places);
}

TEST_F(PointsOfParticles, OfAGroupByTheNameOfItsOutput) {
    test::writeText(folder.path("sea.field.json"), R"({"fieldwright": 1, "nodes": [
        {"id": "sea", "type": "group", "group": "sea"},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "sea", "output": "solid"}}}],
      "groups": [{"id": "sea", "outputs": [{"name": "solid", "type": "surface"}, {"name": "wet", "type": "particles"},
        {"name": "white", "type": "particles"}], "nodes": [
        {"id": "full", "type": "expression", "code": "p.y - 0.3"},
        {"id": "water", "type": "sph_fluid", "inputs": {"source": {"from": "full"}, "spacing": 0.1}},
        {"id": "torn", "type": "foam", "inputs": {"particles": {"from": "water"}}},
        {"id": "field", "type": "particles_to_field", "inputs": {"particles": {"from": "water"}}},
        {"id": "ends", "type": "group_output", "inputs": {"solid": {"from": "field"}, "wet": {"from": "water"},
            "white": {"from": "torn"}}}]}]})");
    graph = folder.path("sea.field.json");
    const test::CommandResult wet = exported("sea.wet", "wet.csv", "0");
    ASSERT_EQ(wet.status, 0) << wet.errors;
    EXPECT_GT((*readParticlePlaces(graph, "wet.csv"))->places.size(), 1000u);
    EXPECT_EQ(exported("sea.white", "white.csv", "0").status, 0);
    expectRefusal(exported("sea", "a.ply", "0"), 1, {"'sea'", "sea.wet, sea.white"});
    expectRefusal(exported("sea.solid", "a.ply", "0"), 1, {"'sea'", "sea.wet, sea.white"});
}

TEST_F(PointsOfParticles, NoneAreANote) {
    const test::CommandResult result = exported("white", "none.csv", "0");
    EXPECT_EQ(result.status, 0);
    EXPECT_NE(result.errors.find("node 'white' has no particles then"), std::string::npos) << result.errors;
    EXPECT_EQ(test::readText(folder.path("none.csv")), "x,y,z,vx,vy,vz,id\n");
}

TEST_F(PointsOfParticles, WhatCannotBeIsRefused) {
    expectRefusal(exported("whit", "a.ply"), 1, {"there is no node 'whit'", "did you mean 'white'?"});
    expectRefusal(exported("full", "a.ply"), 1, {"'full'", "gives no particles", "white"});
    expectRefusal(exported("white.foam", "a.ply"), 1, {"'white'", "ask for white"});
    expectRefusal(exported("white", "a.glb"), 2,
                  {"'.glb' holds none", ".ply, .vtk, .bgeo, .csv, .xyz, .txt"});
    expectRefusal(exported("white", "a"), 2, {"needs an ending"});
    expectRefusal(test::runCommand({"export", graph, "--particles", "white", "-o", folder.path("a.ply"),
                                    "--resolution", "8"}),
                  2, {"--particles", "--resolution"});
    EXPECT_EQ(folder.names(), std::vector<std::string>{"test.field.json"});
}

}  // namespace fw::foam_test
