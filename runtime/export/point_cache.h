// A mesh that moves as the places of its points at many times, for programs that move a mesh by such: .pc2, a
// sample for each frame, from frame 0 on, and .mdd, at seconds. The mesh itself stands beside it, as an OBJ
// of the same stem, as it is at the first time; its vertices are in the same order.
//
// Formats: "Point Cache 2" of 3ds Max (Microsoft's byte order: "POINTCACHE2", version 1, points, first frame,
// frames a sample, samples, then three floats a point) and LightWave's "Motion Designer" file (the high byte
// first: frames, points, the times, then three floats a point).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/export/export.h"
#include "runtime/system/output_file.h"

namespace fw {

/// Whether the path ends as a point cache does.
bool isPointCache(const std::string& path);
/// The cache, and the files of the mesh beside it.
std::vector<std::string> pointCachePaths(const std::string& path);
/// Refuses options that an OBJ does not have.
Done checkPointCache(const std::string& path, const ExportOptions& options);

class PointCache {
  public:
    /// Of meshes at these seconds, one at least. Errors: as checkPointCache(), an unwritable folder.
    static Result<PointCache> open(const std::string& path, std::vector<double> seconds,
                                   const ExportOptions& options = {});

    /// The next of them, which has the triangles of the first one. Errors: of one that has others, or none.
    Done add(const Mesh& mesh);
    /// The files appear, the cache last. Errors: as of exportMesh().
    Result<ExportedFiles> end();

  private:
    PointCache(std::string path, std::vector<double> seconds, ExportOptions options, OutputFile file);
    void begin();

    std::string path;
    std::vector<double> seconds;
    ExportOptions options;
    OutputFile file;
    std::optional<Mesh> first;
};

}  // namespace fw
