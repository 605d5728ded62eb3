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
    constexpr const char* kNames[] = {"a.ply", "a.obj",  "a.csv", "a.txt",
                                      "a.xyz", "a.tiff", "a.vtk", "a.bgeo"};
    if (size == 0) return 0;
    const std::string name = kNames[data[0] % 8];
    const std::string bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
    const fw::Result<fw::FilePoints> points = fw::parseParticlePlaces(bytes, name);
    if (!points) {
        require(points.error().message.find("'" + name + "'") != std::string::npos,
                "a refusal names the file");
        return 0;
    }
    require(name != "a.tiff", "only what is a format is read");
    const std::size_t count = points->places.size();
    require(count > 0 && count <= bytes.size(), "there are places, of a byte each at least");
    require(points->velocities.empty() || points->velocities.size() == count,
            "each has a velocity, or none has");
    require(points->ids.empty() || points->ids.size() == count, "each has a number, or none has");
    for (const auto* list : {&points->places, &points->velocities})
        for (const glm::vec3& p : *list)
            require(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z), "numbers are finite");
    return 0;
}
