#include "graph/assets/particle_cache.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "graph/base/asset_file.h"
#include "graph/base/hash.h"

namespace fw {

using nlohmann::ordered_json;

namespace {

std::string asHex(uint64_t number) {
    char digits[16];
    return {digits, std::to_chars(digits, digits + sizeof digits, number, 16).ptr};
}

/// The simulations of a header, or what is wrong with it.
Result<std::vector<CachedSimulation>> parseCache(const std::string& bytes, const std::string& path) {
    const auto wrong = [&](const std::string& what) { return fileProblem(path, kParticleCacheFile, what); };
    const ordered_json header = ordered_json::parse(bytes, nullptr, false);
    const auto isNone = [&] {
        return wrong(std::string("is no header of one: name the ") + kParticleCacheName +
                     " that fieldwright simulate wrote");
    };
    if (!header.is_object() || !header.contains("fieldwright_particle_cache")) return isNone();
    const ordered_json& version = header["fieldwright_particle_cache"];
    if (!version.is_number_integer() || version.get<int64_t>() < 1) return isNone();
    if (version.get<int64_t>() > kParticleCacheVersion)
        return wrong("is of a newer Fieldwright: use that, or simulate again");
    std::vector<CachedSimulation> simulations;
    if (!header.contains("simulations") || !header["simulations"].is_array()) return isNone();
    for (const ordered_json& entry : header["simulations"]) {
        if (!entry.is_object()) return isNone();
        const auto text = [&](const char* key) {
            const auto found = entry.find(key);
            return found != entry.end() && found->is_string() ? found->get<std::string>() : std::string();
        };
        CachedSimulation& made = simulations.emplace_back();
        made.node = text("node");
        made.part = text("part");
        const std::string data = text("data");
        std::from_chars(data.data(), data.data() + data.size(), made.data, 16);
        const auto algorithms = entry.find("algorithms");
        const bool isRecorded = algorithms != entry.end() && algorithms->is_number_unsigned();
        made.algorithms = isRecorded ? algorithms->get<uint32_t>() : 0;
        if (made.node.empty() || made.part.empty()) return isNone();
    }
    return simulations;
}

}  // namespace

uint64_t CachedSimulation::key() const {
    uint64_t hash = mixed(data, algorithms);
    for (const unsigned char c : node + '\n' + part) hash = mixed(hash, c);
    return hash ^ hash >> 32;
}

std::string CachedSimulation::folder() const {
    std::string name = node;
    std::ranges::replace(name, '/', '.');
    return name;
}

const CachedSimulation* ParticleCache::of(const std::string& node) const {
    const auto found = std::ranges::find(simulations, node, &CachedSimulation::node);
    return found == simulations.end() ? nullptr : &*found;
}

Result<ParticleCachePtr> readParticleCache(const std::string& graphPath, const std::string& path) {
    return readAsset<ParticleCache>(
        graphPath, path, kParticleCacheFile,
        [&](const std::string& bytes, const std::string& file) -> Result<ParticleCachePtr> {
            if (!endsAs(kParticleCacheFile, path)) return wrongEnding(path, kParticleCacheFile);
            Result<std::vector<CachedSimulation>> simulations = parseCache(bytes, path);
            if (!simulations) return simulations.error();
            return std::make_shared<const ParticleCache>(
                ParticleCache{std::filesystem::path(file).parent_path().string(), std::move(*simulations)});
        });
}

std::string writeParticleCache(const ParticleCache& cache, double step, const std::string& about) {
    ordered_json header = {{"fieldwright_particle_cache", kParticleCacheVersion}, {"step", step}};
    header.update(ordered_json::parse(about));
    header["simulations"] = ordered_json::array();
    for (const CachedSimulation& each : cache.simulations)
        header["simulations"].push_back({{"node", each.node},
                                         {"folder", each.folder()},
                                         {"data", asHex(each.data)},
                                         {"algorithms", each.algorithms},
                                         {"part", each.part}});
    return header.dump(2) + "\n";
}

}  // namespace fw
