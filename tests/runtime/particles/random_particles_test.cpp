// Chains of particle nodes with any numbers, however small or large: they are played, or refused with a
// reason.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <random>

#include "graph/check/check.h"
#include "graph/document/json.h"
#include "graph/library/node_type.h"
#include "runtime/play/mesh_program.h"
#include "tests/support/gpu.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::random_particles_test {

using nlohmann::json;

/// All inputs that the node library has, so that new ones are tried as well.
class Chain {
  public:
    explicit Chain(uint32_t seed) : random(seed) {}

    json document(const test::TempDir& dir) {
        json nodes = {{{"id", "solid"}, {"type", chance(0.5) ? "box" : "sphere"}},
                      {{"id", "obstacle"}, {"type", chance(0.5) ? "torus" : "plane"}}};
        const auto add = [&](const std::string& id, const std::string& type, const std::string& from) {
            nodes.push_back({{"id", id}, {"type", type}, {"inputs", inputs(*findNodeType(type), from)}});
        };
        constexpr const char* kSources[] = {"emitter", "sph_fluid", "particle_file"};
        const std::string source = kSources[random() % 3];
        add("source", source, "");
        if (source == "particle_file") {
            std::string places;
            for (int i = 1 + int(random() % 20); i > 0; --i) {
                for (int axis = 0; axis < 3; ++axis)
                    places += std::to_string(std::clamp(number(0.5), -1e37, 1e37)) + " ";
                places += "\n";
            }
            test::writeText(dir.path("some.xyz"), places);
            nodes.back()["inputs"] = {{"path", "some.xyz"}};
        }
        std::string last = "source";
        for (int i = source == "sph_fluid" ? 0 : int(random() % 3); i > 0; --i) {
            const std::string id = "move" + std::to_string(i);
            add(id, "particle_dynamics", last);
            last = id;
        }
        add("field", "particles_to_field", last);
        nodes.push_back({{"id", "out"}, {"type", "output"}, {"inputs", {{"surface", {{"from", "field"}}}}}});
        json timeline = {{"length", 1}};
        json& moved = nodes[2 + random() % (nodes.size() - 3)];
        const std::string type = moved["type"];
        for (const InputSpec& spec : findNodeType(type)->inputs)
            if (spec.type == Type::scalar && chance(0.1))
                timeline["tracks"].push_back({{"node", moved["id"]},
                                              {"input", spec.name},
                                              {"keys",
                                               {{{"time", 0}, {"value", fit(number(1.0), spec)}},
                                                {{"time", 0.2}, {"value", fit(number(1.0), spec)}}}}});
        return {{"fieldwright", 1}, {"nodes", nodes}, {"timeline", timeline}};
    }

    double number(double usual) {
        constexpr double kAny[] = {0.0, 1e-45, 1e-30, 1e-9, 1e3, 1e6, 1e9, 1e20, 1e38, 1e100, 1e300};
        if (chance(0.06)) return kAny[random() % std::size(kAny)] * (chance(0.5) ? 1.0 : -1.0);
        return (usual == 0.0 ? 0.5 : usual) * std::uniform_real_distribution<double>(-0.2, 2.0)(random);
    }

  private:
    bool chance(double p) { return std::uniform_real_distribution<double>(0.0, 1.0)(random) < p; }

    static double fit(double value, const InputSpec& spec) {
        value = std::clamp(value, spec.min, spec.max);
        return spec.positive ? std::max(std::abs(value), 1e-45) : value;
    }

    json inputs(const NodeType& type, const std::string& from) {
        json made = json::object();
        for (const InputSpec& spec : type.inputs) {
            if (spec.type == Type::particles) {
                made[spec.name] = {{"from", from}};
            } else if (spec.type == Type::surface) {
                if (spec.name == "source") made[spec.name] = {{"from", "solid"}};
                if (spec.name != "source" && chance(0.5)) made[spec.name] = {{"from", "obstacle"}};
            } else if (chance(spec.value.numbers.empty() ? 0.9 : 0.5) ||
                       spec.value.kind == InputDefault::Kind::position) {
                continue;
            } else if (!spec.options.empty()) {
                made[spec.name] = spec.options[random() % spec.options.size()];
            } else if (spec.type == Type::integer) {
                const double most = spec.name == "substeps" ? 4.0 : 48.0;  // parts of a step; cells
                made[spec.name] = std::round(fit(std::min(40.0 * number(0.3), most), spec));
            } else if (spec.type == Type::scalar) {
                made[spec.name] = fit(number(spec.value.numbers[0]), spec);
            } else if (spec.type == Type::vec3) {
                const std::vector<double>& usual = spec.value.numbers;  // none of corners, which are found
                const double corner = spec.name.ends_with("_min") ? -1.0 : 1.0;
                for (std::size_t axis = 0; axis < 3; ++axis)
                    made[spec.name].push_back(fit(number(usual.empty() ? corner : usual[axis]), spec));
            }
        }
        return made;
    }

    std::mt19937 random;
};

TEST(RandomParticles, ArePlayedOrRefused) {
    const uint32_t most = std::getenv("FIELDWRIGHT_LONG") ? 150 : 12;
    test::TempDir dir;
    uint32_t played = 0, refused = 0;
    for (uint32_t seed = 1; seed <= most; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Chain chain(seed);
        const std::string text = chain.document(dir).dump();
        const Result<Graph> graph = parseGraph(text, dir.path("a.field.json"), nullptr);
        ASSERT_TRUE(graph) << format(graph.error()) << text;
        const std::vector<Error> findings = check(*graph);
        const bool faulty = std::ranges::any_of(
            findings, [](const Error& finding) { return finding.severity == Error::Severity::error; });
        const Result<Program> program =
            faulty ? Result<Program>(findings.front())
                   : compileAtTime(*graph, seed % 3 * 0.1, {}, [] { return &test::device(); });
        if (!program) {
            EXPECT_FALSE(program.error().message.empty());
            ++refused;
            continue;
        }
        ++played;
        for (int i = 0; i < 50; ++i) {
            const Point p = {chain.number(1.0), chain.number(1.0), chain.number(1.0)};
            EXPECT_FALSE(std::isnan(evaluate(program->ir, program->distance(), program->parameters(), p)))
                << text;
        }
    }
    std::printf("%u chains played, %u refused\n", played, refused);
    EXPECT_GT(played, most / 4);
}

}  // namespace fw::random_particles_test
