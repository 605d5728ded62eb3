// A picture as light, before exposure and tone map, with what is seen beside it; and its OpenEXR file, for
// programs that go on from there.
//
// Colours are the mean over each pixel, with its edges; what is seen is that of its middle, through the
// middle of the lens: depths and normals of several surfaces have no mean.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "graph/base/result.h"

namespace fw {

inline constexpr float kNoDepth = 1e10f;                  ///< where nothing is
inline constexpr uint32_t kNothingId = 0, kGroundId = 1;  ///< materials have others

/// Rows from the top.
struct LightPicture {
    int width = 0, height = 0;
    std::vector<float> color;       ///< four floats a pixel: linear radiance times alpha, and alpha
    std::vector<float> depth;       ///< metres along the view
    std::vector<glm::vec3> normal;  ///< unit length, in the world; 0 where nothing is
    /// A number of 24 bits that stands for the surface's material: base colour, roughness, metallic and
    /// emission, as finely as the renderer keeps them. The same in every picture.
    std::vector<uint32_t> id;
};

/// Writes the channels R, G, B, A, Z, N.X, N.Y, N.Z as floats and id as whole numbers; `kept` as in
/// OutputFile::commit(). Errors: as OutputFile.
Done saveLight(const LightPicture& picture, const std::string& path, const std::function<void()>& kept = {});

/// Width and height of the picture in an OpenEXR file; none if it is none, or not a whole one.
std::optional<std::pair<int, int>> sizeOfLight(const std::string& path);

}  // namespace fw
