// Blender without its window, as another program that judges files.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace fw::test {

/// What Blender makes of a .glb, .gltf or .obj, as tests/support/in_blender.py tells it: "frames" by their
/// numbers with "names", "volume", "min" and "max" of what is seen, in the file's axes and Blender's metres,
/// when its scene has `fps` frames a second; "parents", "meshes", "materials" and "images" by their names.
/// Null, and a failure of the test, if there is no Blender or it cannot read the file.
nlohmann::json inBlender(const std::string& path, const std::vector<int>& frames = {0}, int fps = 30);

}  // namespace fw::test
