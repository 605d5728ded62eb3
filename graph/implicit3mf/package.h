// A 3MF file's parts: a ZIP archive by the Open Packaging Conventions, read and written with libzip.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "graph/base/result.h"

struct zip;

namespace fw::threemf {

inline constexpr std::size_t kMost3mfBytes = 256u << 20;   ///< of a file
inline constexpr std::size_t kMostModelBytes = 64u << 20;  ///< of the model's part, unpacked
inline constexpr std::size_t kMostSheetBytes = 32u << 20;  ///< of a picture

class Package {
  public:
    /// The Error has a message only: what the bytes are, if no archive.
    static Result<Package> open(const std::string& bytes);

    bool has(const std::string& name) const;
    /// The part's bytes, unpacked no further than `most`. The Error names it.
    Result<std::string> part(const std::string& name, std::size_t most) const;

  private:
    struct Discard {
        void operator()(zip* archive) const;
    };
    std::shared_ptr<const std::string> bytes;  // that the archive reads
    std::unique_ptr<zip, Discard> archive;
};

struct Part {
    std::string name;  ///< "3D/3dmodel.model"
    std::string bytes;
};
/// The archive of the parts, in their order; the same bytes for the same parts.
std::string packed(const std::vector<Part>& parts);

}  // namespace fw::threemf
