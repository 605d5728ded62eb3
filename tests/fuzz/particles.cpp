// libFuzzer: the first byte says the format, the others are read as a file of particles. What is read must be
// places; what is refused must be refused with a reason.
//
//   cmake --preset fuzz && cmake --build --preset fuzz --target fuzz_particles
//   build/fuzz/fuzz_particles -max_total_time=60 -max_len=4096 -dict=tests/fuzz/particles.dict CORPUS
//   tests/fuzz/particles

#include <cmath>
#include <cstdint>

#include "graph/assets/particle_file.h"
#include "tests/fuzz/require.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, std::size_t size) {
    constexpr const char* kNames[] = {"a.ply", "a.obj", "a.csv", "a.txt", "a.xyz", "a.tiff"};
    if (size == 0) return 0;
    const std::string name = kNames[data[0] % 6];
    const std::string bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
    const fw::Result<std::vector<glm::vec3>> places = fw::parseParticlePlaces(bytes, name);
    if (!places) {
        require(places.error().message.find("'" + name + "'") != std::string::npos,
                "a refusal names the file");
        return 0;
    }
    require(name != "a.tiff", "only what is a format is read");
    require(!places->empty() && places->size() <= bytes.size(), "there are places, of a byte each at least");
    for (const glm::vec3& p : *places)
        require(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z), "places are finite");
    return 0;
}
