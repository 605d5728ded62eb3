// Fields whose code keeps a driver busy for long: first mesh and first picture of processes with empty
// caches, beside what the driver takes for the kernels.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "graph/compile/effort.h"
#include "graph/document/json.h"
#include "graph/emit/glsl.h"
#include "runtime/mesher/mesher.h"
#include "tests/bench/command.h"
#include "tests/bench/tables.h"

namespace fw::bench {
namespace {

using nlohmann::json;

constexpr double kMostMeshSeconds = 3, kMostPictureSeconds = 5;
constexpr double kMostDriverSeconds = 30;  // what is more is not waited for

json linkTo(const char* node) { return {{"from", node}}; }

json graphOf(json nodes, const char* last) {
    nodes.push_back({{"id", "out"}, {"type", "output"}, {"inputs", {{"surface", linkTo(last)}}}});
    return {{"fieldwright", 1}, {"nodes", std::move(nodes)}};
}

json expression(const std::string& code) { return {{"id", "field"}, {"type", "expression"}, {"code", code}}; }

/// A gear's outline, extruded.
json polygon(int corners, double difference) {
    json points = json::array();
    for (int i = 0; i < corners; ++i) {
        const double angle = 2 * 3.14159265 * i / corners;
        const double radius = 1 + difference + 0.15 * std::sin(9 * angle) + 0.02 * std::sin(40 * angle);
        points.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    }
    return graphOf({{{"id", "outline"}, {"type", "polygon"}, {"inputs", {{"points", points}}}},
                    {{"id", "solid"}, {"type", "extrude"}, {"inputs", {{"surface", linkTo("outline")}}}}},
                   "solid");
}

/// A ball under waves of unlike directions.
json waves(int count, double difference) {
    std::mt19937 random(3);
    const auto within = [&](double most) {
        return std::to_string(most * (2.0 * double(random() >> 8) / double(1 << 24) - 1));
    };
    std::string code = "return length(p) - 1.0";
    for (int i = 0; i < count; ++i)
        code += " + " + std::to_string((0.3 + difference) / count) + " * sin(dot(p, vec3(" + within(9) +
                ", " + within(9) + ", " + within(9) + ")) + " + within(3) + ")";
    return graphOf(json::array({expression(code + ";")}), "field");
}

/// A ball under noises of one kind, each of its own scale and place.
json noises(const char* kind, int count, double difference) {
    std::mt19937 random(4);
    const auto upTo = [&](double most) {
        return std::to_string(most * double(random() >> 8) / double(1 << 24));
    };
    std::string code = "return length(p) - 1.0";
    for (int i = 0; i < count; ++i)
        code += " + " + std::to_string((0.3 + difference) / count) + " * " + kind + "(p * (2.0 + " + upTo(4) +
                ") + vec3(" + upTo(9) + ", " + upTo(9) + ", " + upTo(9) + "))";
    return graphOf(json::array({expression(code + ";")}), "field");
}

/// A ball warped by three octaves of Perlin noise, alone or repeated with its neighbours.
json warped(bool repeated, double difference) {
    json nodes = json::array({expression("vec3 q = p + " + std::to_string(0.05 + difference) +
                                         " * vec3(perlin(p * 3.0) + 0.5 * perlin(p * 6.0) + 0.25 * perlin(p "
                                         "* 12.0)); return length(q) - 0.4;")});
    if (!repeated) return graphOf(nodes, "field");
    nodes.push_back(
        {{"id", "all"},
         {"type", "repeat"},
         {"inputs", {{"surface", linkTo("field")}, {"period", {1, 1, 1}}, {"count", {3, 3, 3}}}}});
    return graphOf(nodes, "all");
}

struct Large {
    std::string name;
    json (*make)(int size, double difference);
    int size;
};

const Large kLarge[] = {
    {"polygon of 100 corners, extruded", polygon, 100},
    {"polygon of 300 corners", polygon, 300},
    {"polygon of 1,000 corners", polygon, 1000},
    {"sum of 400 sines", waves, 400},
    {"sum of 1,000 sines", waves, 1000},
    {"sum of 7,000 sines", waves, 7000},
    {"sum of 1,000 Perlin noises",
     [](int count, double difference) { return noises("perlin", count, difference); }, 1000},
    {"sum of 300 Worley noises",
     [](int count, double difference) { return noises("worley", count, difference); }, 300},
    {"ball warped by three octaves", [](int, double difference) { return warped(false, difference); }, 0},
    {"the same, repeated with neighbours", [](int, double difference) { return warped(true, difference); },
     0},
};

/// Seconds that the driver takes for the mesher's kernels of a field that no cache knows.
std::string driverSeconds(Bench& bench, const Program& program) {
    const double expected = secondsToCompile(program);
    if (expected > kMostDriverSeconds) return "about " + number(expected);
    const auto start = Clock::now();
    createMesherPipelines(bench.device(), emitField(program));
    return number(secondsSince(start));
}

}  // namespace

void largeTable(Bench& bench) {
    Table table{.title = "Large fields: processes with empty caches (s)",
                .header = {"field", "operations", "first mesh at 64", "peak MiB", "first picture, 640x360",
                           "the driver, for kernels"}};
    std::random_device seed;
    bool meshMet = true, pictureMet = true;
    std::vector<Program> programs;
    for (const Large& large : kLarge) {
        TemporaryFolder folder;
        const std::string path = folder.path + "/large.field.json";
        std::ofstream(path) << large.make(large.size, double(seed()) * 1e-12);
        const Result<Graph> graph = readGraph(path, nullptr);
        Result<Program> program = graph ? compile(*graph) : Result<Program>(graph.error());
        if (!program) return bench.fail(format(program.error()));
        const auto run = [&](std::vector<std::string> arguments) {
            arguments.insert(arguments.begin() + 1, {path, "--resolution", "64"});
            const std::string cache = folder.path + "/" + arguments[0];
            std::filesystem::create_directory(cache);
            const Outcome outcome = runCommand(arguments, cache);
            if (outcome.status != 0) bench.fail(large.name + ": status " + std::to_string(outcome.status));
            return outcome;
        };
        const Outcome mesh = run({"export", "-o", folder.path + "/mesh.ply"});
        const Outcome picture =
            run({"render", "--size", "640x360", "--samples", "1", "-o", folder.path + "/picture.png"});
        meshMet = meshMet && mesh.milliseconds <= 1000 * kMostMeshSeconds;
        pictureMet = pictureMet && picture.milliseconds <= 1000 * kMostPictureSeconds;
        table.rows.push_back({large.name, count(program->ir.size()), number(mesh.milliseconds / 1000),
                              number(double(mesh.peakBytes) / (1 << 20)),
                              number(picture.milliseconds / 1000)});
        programs.push_back(std::move(*program));
    }
    // At last, for the system counts this process's memory at a spawn towards that of the new one.
    for (std::size_t i = 0; i < programs.size(); ++i)
        table.rows[i].push_back(driverSeconds(bench, programs[i]));
    table.notes = {
        "Wanted: at most " + number(kMostMeshSeconds) + " s to the first mesh (" +
            (meshMet ? "met" : "missed") + ") and " + number(kMostPictureSeconds) +
            " s to the first picture (" + (pictureMet ? "met" : "missed") + ").",
        "Where the driver would be longer, meshes come from tapes on the host and pictures are "
        "drafts. What it takes for the kernels of the mesher alone is measured in this process, once; "
        "\"about\" is an estimate."};
    print(table, bench.options.markdown);
}

}  // namespace fw::bench
