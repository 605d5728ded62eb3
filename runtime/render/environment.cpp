#include "runtime/render/environment.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/packing.hpp>
#include <numbers>

#include "graph/base/parallel.h"

namespace fw {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr float kMostPacked = 65408.0f;  // of numbers of 9 bits with an exponent of 5
constexpr int kLeastSharp = 256;         // texels across of the last level that is halved only
constexpr int kLeastSource = 64;         // of what is blurred, twice that at most
constexpr int kMostColumns = 512;        // of the chances
constexpr float kRough[] = {0.2f, 0.4f, 0.6f, 0.8f, 1.0f};

/// The sine of how far from straight up the middle of a row is.
double acrossRow(int y, int height) { return std::sin(kPi * (y + 0.5) / height); }

glm::vec3 directionOf(int x, int y, int width, int height) {
    const double around = 2 * kPi * (1.0 - (x + 0.5) / width), across = acrossRow(y, height);
    return {across * std::sin(around), std::cos(kPi * (y + 0.5) / height), across * std::cos(around)};
}

/// The map, halved while it is wider than that.
EnvironmentMap atMost(EnvironmentMap map, int width) {
    while (map.width > width) map = halved(map);
    return map;
}

/// With every texel repeated, if it has fewer of them than kLeastSource across.
EnvironmentMap atLeast(const EnvironmentMap& map) {
    const int across = (kLeastSource + map.width - 1) / map.width,
              down = (kLeastSource / 2 + map.height - 1) / map.height;
    EnvironmentMap more{map.width * across, map.height * down, {}};
    for (int y = 0; y < more.height; ++y)
        for (int x = 0; x < more.width; ++x)
            more.texels.push_back(
                map.texels[std::size_t(y / down) * std::size_t(map.width) + std::size_t(x / across)]);
    return more;
}

/// Light from one direction and the part of the sphere that it comes from.
struct Ray {
    glm::vec3 direction;
    float share;
    glm::vec3 radiance;
};
std::vector<Ray> raysOf(const EnvironmentMap& map) {
    std::vector<Ray> rays;
    for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x) {
            const Radiance& texel = map.texels[rays.size()];
            rays.push_back({directionOf(x, y, map.width, map.height),
                            float(acrossRow(y, map.height)),
                            {texel[0], texel[1], texel[2]}});
        }
    return rays;
}

/// The mean of the rays about each direction, by weight(cosine between them), above 0 only.
template <class Weight>
EnvironmentMap blurred(const std::vector<Ray>& rays, int width, const Weight& weight) {
    EnvironmentMap map{width, width / 2, std::vector<Radiance>(std::size_t(width * width / 2))};
    forBlocks(map.texels.size(), 64, [&](std::size_t, std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            const glm::vec3 n = directionOf(int(i) % width, int(i) / width, width, width / 2);
            glm::vec3 sum(0);
            float weights = 0;
            for (const Ray& ray : rays) {
                const float cosine = glm::dot(n, ray.direction);
                if (cosine <= 0) continue;
                const float share = weight(cosine) * ray.share;
                sum += share * ray.radiance;
                weights += share;
            }
            sum /= weights;
            map.texels[i] = {sum.r, sum.g, sum.b};
        }
    });
    return map;
}

/// What a mirror sees that is looked at straight on: by the distribution of its facets (GGX) and the cosine.
EnvironmentMap inMirror(const std::vector<Ray>& rays, float roughness) {
    const float a2 = roughness * roughness * roughness * roughness;
    return blurred(rays, roughness < 0.3f ? 128 : 64, [a2](float cosine) {
        const float lobe = 0.5f * (1 + cosine) * (a2 - 1) + 1;
        return cosine / (lobe * lobe);
    });
}

struct Level {
    EnvironmentMap map;
    float roughness;
};
std::vector<Level> levelsOf(const EnvironmentMap& map) {
    std::vector<Level> levels{{map, 0.0f}};
    while (levels.back().map.width > kLeastSharp) {
        EnvironmentMap half = halved(levels.back().map);
        // About as blurred as a mirror whose facets lean half a texel.
        const float roughness = float(std::sqrt(kPi / half.width));
        levels.push_back({std::move(half), roughness});
    }
    const std::vector<Ray> rays = raysOf(atLeast(atMost(levels.back().map, 2 * kLeastSource)));
    for (const float roughness : kRough) levels.push_back({inMirror(rays, roughness), roughness});
    levels.push_back({blurred(rays, 32, [](float cosine) { return cosine; }), 2.0f});
    return levels;
}

/// Ascending numbers, the last of which is 1: sums of the weights, which are taken for equal if all are 0.
std::vector<float> sums(std::vector<double> weights) {
    double all = 0;
    for (const double weight : weights) all += weight;
    if (!(all > 0)) std::ranges::fill(weights, 1.0), all = double(weights.size());
    std::vector<float> sums;
    double sum = 0;
    for (const double weight : weights) sums.push_back(float((sum += weight) / all));
    sums.back() = 1.0f;
    return sums;
}

/// Ends of the rows' chances, then those of each row's columns. Between texels light is interpolated: each
/// has a part of its neighbours'.
std::vector<float> chancesOf(const EnvironmentMap& map) {
    const auto light = [&](int x, int y) {
        const Radiance& texel =
            map.texels[std::size_t(std::clamp(y, 0, map.height - 1)) * std::size_t(map.width) +
                       std::size_t((x + map.width) % map.width)];
        return double(texel[0]) + texel[1] + texel[2];
    };
    std::vector<double> rows;
    std::vector<float> columns;
    for (int y = 0; y < map.height; ++y) {
        std::vector<double> row;
        double whole = 0;
        for (int x = 0; x < map.width; ++x) {
            double sum = 0;
            for (int j = -1; j <= 1; ++j)
                for (int i = -1; i <= 1; ++i)
                    sum += (2 - std::abs(i)) * (2 - std::abs(j)) * light(x + i, y + j);
            row.push_back(sum * acrossRow(y, map.height));
            whole += row.back();
        }
        rows.push_back(whole);
        const std::vector<float> ends = sums(std::move(row));
        columns.insert(columns.end(), ends.begin(), ends.end());
    }
    std::vector<float> chances = sums(std::move(rows));
    chances.insert(chances.end(), columns.begin(), columns.end());
    return chances;
}

glm::vec3 meanOfRow(const EnvironmentMap& map, int y) {
    glm::vec3 sum(0);
    for (int x = 0; x < map.width; ++x) {
        const Radiance& texel = map.texels[std::size_t(y * map.width + x)];
        sum += glm::vec3(texel[0], texel[1], texel[2]);
    }
    return sum / float(map.width);
}

}  // namespace

void useEnvironment(const Device& device, Environment& environment, const EnvironmentMapPtr& map) {
    if (environment.map == map) return;
    environment.map.reset();  // until there is room for the other
    if (!map) return;
    const std::vector<Level> levels = levelsOf(atMost(*map, kMostEnvironmentWidth));
    float most = kMostPacked;
    for (const Radiance& texel : map->texels) most = std::max({most, texel[0], texel[1], texel[2]});
    environment.scale = most / kMostPacked;
    environment.levels.clear();
    std::vector<uint32_t> words;
    for (const auto& [picture, roughness] : levels) {
        environment.levels.push_back(
            {uint32_t(words.size()), uint32_t(picture.width), uint32_t(picture.height), roughness});
        for (const Radiance& texel : picture.texels)
            words.push_back(glm::packF3x9_E1x5(glm::vec3(texel[0], texel[1], texel[2]) / environment.scale));
    }
    const EnvironmentMap& matt = levels.back().map;
    environment.matt = {meanOfRow(matt, 0), meanOfRow(matt, matt.height / 2),
                        meanOfRow(matt, matt.height - 1)};
    const EnvironmentMap coarse = atMost(*map, kMostColumns);
    environment.chances = uint32_t(words.size());
    environment.columns = uint32_t(coarse.width), environment.rows = uint32_t(coarse.height);
    for (const float end : chancesOf(coarse)) words.push_back(std::bit_cast<uint32_t>(end));
    reserve(device, environment.words, 4 * words.size());
    upload(device, environment.words, words);
    environment.map = map;
}

void describeEnvironment(const Environment& environment, const Sky& sky, gpu::RenderFrame& frame) {
    const float strength = float(sky.strength);
    frame.skyLevels = uint32_t(environment.levels.size()) - 1;
    std::ranges::copy(environment.levels, frame.sky);
    frame.skyScale = environment.scale * strength;
    frame.skyTurn = float(std::fmod(sky.rotation, 360.0) / 360.0);
    frame.skyChances = environment.chances;
    frame.skyColumns = environment.columns;
    frame.skyRows = environment.rows;
    frame.zenith = strength * environment.matt[0];
    frame.horizon = strength * environment.matt[1];
    frame.groundColor = strength * environment.matt[2];
}

}  // namespace fw
