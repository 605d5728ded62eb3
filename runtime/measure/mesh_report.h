// What a written mesh file holds, measured from the file itself: topology, size, and distance from the field.
//
// Why from the file: the mesher's own belief proves nothing about what another program will read. The file is
// read back (export/read_back.h), vertices with equal float32 positions are merged, and only then is anything
// counted.
//
// How: the corners at each vertex are gathered (counting sort); sorting the few neighbours of one vertex
// yields its edges, their winding and its fans, so all vertices are independent and two threads share them.
// Shells come from a union-find over faces, linked at the edges. Sums are taken in blocks of fixed size, in
// double, so that the result does not depend on the number of threads.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "graph/base/result.h"
#include "runtime/measure/completeness.h"
#include "runtime/measure/mesh_size.h"
#include "runtime/measure/read_back.h"
#include "runtime/measure/widths.h"
#include "runtime/mesh/mesh.h"

namespace fw {

/// Fills `errors[i]` with |f| / |gradient f| at `points[i]`, in metres. Called from several threads at once,
/// with at most a few thousand points.
using FieldError = std::function<void(std::span<const glm::dvec3> points, std::span<double> errors)>;

/// A point of the true surface, and the area that it stands for beside the others'.
struct SurfacePoint {
    glm::dvec3 position;
    double weight = 1.0;
};

/// What is measured besides topology and size; field_measure.h fills what compares with a field.
struct MeasureOptions {
    bool selfIntersections = false, widths = false;
    FieldError error = {};
    std::string errorNote = {};            ///< of the report
    std::optional<double> lipschitz = {};  ///< constant of the field within its region; empty if unknown
    FieldError distance = {};              ///< the same, but metres to a point of the surface nearby,
    std::size_t samples = 32768;           ///< asked of so many points of the mesh
    std::vector<SurfacePoint> surface = {};
};

/// Distances in metres over sampled points.
struct SampledDistance {
    double max = 0, mean = 0;
    uint64_t samples = 0;
};

/// A level of detail, and the largest distance between it and the field's surface, metres.
struct LevelReport {
    std::string name;
    uint64_t vertices = 0, triangles = 0;
    double error = 0;
};

/// Lengths are in `unit`.
struct Report : MeshSize {
    uint64_t vertices = 0;             ///< welded, used by a triangle that is not collapsed
    uint64_t triangles = 0;            ///< as the file lists them, collapsed ones included
    uint64_t shells = 0;               ///< parts connected across edges
    uint64_t cavities = 0;             ///< those of them that face inwards: hollows that nothing leads out of
    uint64_t boundaryEdges = 0;        ///< edges of one triangle
    uint64_t nonManifoldEdges = 0;     ///< edges of three or more
    uint64_t nonManifoldVertices = 0;  ///< vertices whose triangles form more than one fan
    uint64_t flippedEdges = 0;         ///< edges of two triangles that disagree in winding
    uint64_t degenerateTriangles =
        0;  ///< two corners at one place, or area below 1e-12 of the longest side squared
    int64_t eulerCharacteristic = 0;  ///< vertices - edges + triangles, the collapsed ones left out

    std::optional<double> density;  ///< g/cm³, of what the document says it is made of
    std::optional<Widths> widths;   ///< none: not measured
    std::optional<double> maxError,
        meanError;               ///< over vertices and triangle centroids; none without a field
    std::string errorNote = {};  ///< why these two are no distances and are not told; empty if they are
    /// Lipschitz constant of the field within the region, as declared or proven; empty if neither is known.
    std::optional<double> lipschitz = {};
    std::optional<uint64_t> selfIntersections;   ///< pairs of triangles that cut each other (triangle_tree.h)
    double smallestAngle = 0, largestAngle = 0;  ///< of the triangles that are not degenerate, degrees
    /// From points spread evenly over the mesh's area to the surface; from points of the surface, found
    /// without regard to the mesh, to its nearest triangle (field_measure.h).
    std::optional<SampledDistance> meshToSurface, surfaceToMesh;

    /// Of a file of several levels of detail, all of them; what is above is that of the finest.
    std::vector<LevelReport> levels = {};

    // The run that made the file: the caller fills these in.
    std::string unit = "m", fileLengths = {};            ///< of the lengths here; of those in the file
    bool capped = false;                                 ///< the surface left the region and was closed there
    std::optional<Completeness> completeness = {};       ///< empty: not checked, as of a mesh without a field
    bool regionFound = false;                            ///< by the program, not given by the user
    std::vector<std::pair<std::string, double>> stages;  ///< name, ms
    double totalMs = 0;
    uint64_t peakMemoryBytes = 0;
    std::string device;

    const LengthUnit& lengths() const { return *lengthUnit(unit); }
    /// Grams; none without a density.
    std::optional<double> mass() const {
        return density ? std::optional(grams(volume, lengths(), *density)) : std::nullopt;
    }
    /// The shells that are no cavities: pieces that hang together.
    uint64_t bodies() const { return shells - cavities; }
    bool closedManifold() const {
        return boundaryEdges + nonManifoldEdges + nonManifoldVertices + flippedEdges + degenerateTriangles ==
               0;
    }
};

/// The largest of a report's distances from the field, metres: those that are measured, where the field is no
/// distance.
double farthest(const Report& report);

/// Measures the mesh file at `path`. An Error says what in the file is not as it should be.
Result<Report> reportOnFile(const std::string& path, const MeasureOptions& options = {});

/// Measures what was read of a file.
Report reportOnWelded(const WeldedMesh& mesh, const MeasureOptions& options = {});

/// Measures triangles in memory as if they had been read from a file.
Report reportOnMesh(std::span<const glm::vec3> positions, std::span<const uint32_t> indices,
                    const MeasureOptions& options = {});

/// One JSON object with the keys named as the members of Report; an unknown error is null, and so is one that
/// is no distance. Lengths are in `unit`; of what is none `units` has the unit. Ends with a newline.
std::string writeReport(const Report& report);

/// The same for a person: what counts, a line each. Ends with a newline.
std::string reportWords(const Report& report);

/// Refuses to measure a file of so many triangles with `freeBytes` of memory: what is read of it is held as a
/// whole.
Done checkMeasurable(uint64_t triangles, uint64_t freeBytes);

/// Largest resident set of this process so far, in bytes.
uint64_t peakMemoryBytes();
/// What the system could still give to it, in bytes, without swapping.
uint64_t freeMemoryBytes();

}  // namespace fw
