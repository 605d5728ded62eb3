// The parts of the reader behind read_back.h that have files of their own, and what they share. Internal to
// runtime/export.
#pragma once

#include <cmath>
#include <cstring>
#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <string>

#include "runtime/measure/read_back.h"

namespace fw {

using Bytes = std::span<const unsigned char>;

/// Makes the Error that names the file.
using Fault = std::function<Error(std::string what)>;

/// The value whose bytes start at `at`; the caller has checked that they are there.
template <class T>
T load(const Bytes& bytes, std::size_t at) {
    T value;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

inline bool finite(glm::vec3 p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

/// A file's bytes as long as this lives, paged in on demand.
class MappedFile {
  public:
    MappedFile() = default;
    MappedFile(const MappedFile&) = delete;
    MappedFile& operator=(const MappedFile&) = delete;
    ~MappedFile();
    /// The reason if it fails, else empty.
    std::string open(const std::string& path);
    Bytes bytes() const { return content; }

  private:
    Bytes content;
};

Result<WeldedMesh> read3mf(const Bytes& bytes, const Fault& fault);
Result<WeldedMesh> readGlb(const Bytes& bytes, const Fault& fault);
/// The bytes are the JSON's; the binary file may not lie elsewhere than beside it.
Result<WeldedMesh> readGltf(const Bytes& bytes, const StoredMesh& mesh, const Fault& fault);

}  // namespace fw
