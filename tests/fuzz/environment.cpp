// libFuzzer: what is given is read as an environment map. What is read must be light; what is refused must be
// refused with a reason.
//
//   cmake --preset fuzz && cmake --build --preset fuzz --target fuzz_environment
//   build/fuzz/fuzz_environment -max_total_time=60 -max_len=4096 -dict=tests/fuzz/environment.dict CORPUS
//   tests/fuzz/environment

#include <cstdint>

#include "graph/assets/environment.h"
#include "tests/fuzz/require.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, std::size_t size) {
    const std::string bytes(reinterpret_cast<const char*>(data), size);
    const fw::Result<fw::EnvironmentMap> map = fw::parseEnvironment(bytes, "a.exr", 1024);
    if (!map) {
        require(map.error().message.find("'a.exr'") != std::string::npos, "a refusal names the file");
        return 0;
    }
    require(map->width > 0 && map->height > 0 &&
                map->texels.size() == std::size_t(map->width) * std::size_t(map->height),
            "there is a texel for each place");
    for (const fw::Radiance& texel : map->texels)
        for (const float value : texel) require(value >= 0 && value <= fw::kMostRadiance, "light is light");
    return 0;
}
