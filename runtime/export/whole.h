// Whether a mesh file is there as it was written, as far as its beginning, its end and its length tell.
//
// What this program writes appears whole (output_file.h); what was copied, synchronised or cut off by others
// may not be. Content is not read: a file of 100 MB is judged as soon as one of 100 bytes.
#pragma once

#include <string>

namespace fw {

/// Of a file that exportMesh wrote, with the one beside it if the format has one.
bool isWholeMesh(const std::string& path);

}  // namespace fw
