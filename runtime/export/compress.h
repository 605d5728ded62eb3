// A glTF document made small: vertices in few bits (KHR_mesh_quantization), and arrays in the order and the
// code of meshoptimizer (EXT_meshopt_compression), of which decoders are in three.js, Babylon and game
// engines.
//
// Positions become 16-bit steps of the longest side of their mesh's box, which is made part of the
// transforms of the nodes and instances that show it; a node that moves, or has children, gets one for it. So
// every place is off by at most a 131,070th of that side, and vertices at one place stay at one place: what
// is closed stays closed. Normals and tangents become 8-bit vectors (0.4 degrees), texture coordinates
// 16-bit; colours have 16 bits already. Triangles are put in the order that a GPU's cache likes, and vertices
// in the order in which triangles name them: the coder needs both. Vertices that no triangle names are left
// out.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

namespace fw {

/// Makes the document, whose one buffer holds `bytes`, small. It is one of our own writing: floats, or 16-bit
/// colours, and triangles by index.
void compressGltf(nlohmann::json& document, std::vector<unsigned char>& bytes);

}  // namespace fw
