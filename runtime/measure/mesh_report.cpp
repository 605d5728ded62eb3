#include "runtime/measure/mesh_report.h"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <future>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>
#include <random>

#include "graph/assets/triangle_tree.h"
#include "graph/base/parallel.h"
#include "graph/base/words.h"
#include "graph/library/reference.h"
#include "runtime/measure/read_back.h"
#include "runtime/mesh/corners.h"

namespace fw {
namespace {

constexpr double kDegenerateRatio =
    1e-12;  // area below this part of the longest side squared is rounding noise

/// Union-find that threads may share: a link always points to a smaller number, so the roots do not depend on
/// order.
class SharedSets {
  public:
    explicit SharedSets(std::size_t count) : parents(count) {
        for (std::size_t i = 0; i < count; ++i) parents[i] = static_cast<uint32_t>(i);
    }
    uint32_t root(uint32_t item) {
        for (uint32_t parent = at(item).load(std::memory_order_relaxed); parent != item;) {
            const uint32_t above = at(parent).load(std::memory_order_relaxed);
            if (above != parent)
                at(item).store(above, std::memory_order_relaxed);  // halves the path; still an ancestor
            item = parent;
            parent = above;
        }
        return item;
    }
    void unite(uint32_t a, uint32_t b) {
        while ((a = root(a)) != (b = root(b))) {
            if (a < b) std::swap(a, b);
            uint32_t expected = a;
            if (at(a).compare_exchange_weak(expected, b, std::memory_order_relaxed)) return;
        }
    }

  private:
    std::atomic_ref<uint32_t> at(uint32_t item) { return std::atomic_ref<uint32_t>(parents[item]); }
    std::vector<uint32_t> parents;
};

struct Topology {
    uint64_t vertices = 0, edges = 0, boundary = 0, nonManifold = 0, flipped = 0, nonManifoldVertices = 0;

    void add(const Topology& other) {
        vertices += other.vertices;
        edges += other.edges;
        boundary += other.boundary;
        nonManifold += other.nonManifold;
        flipped += other.flipped;
        nonManifoldVertices += other.nonManifoldVertices;
    }
};

/// Looks at one vertex after another; keeps its working arrays between them.
class VertexScan {
  public:
    VertexScan(const WeldedMesh& welded, const Corners& all, SharedSets& faces)
        : mesh(welded), corners(all), shells(faces) {}

    void visit(std::size_t vertex, Topology& counts) {
        const uint32_t degree = corners.degree(vertex);
        if (degree == 0) return;
        ++counts.vertices;
        const std::span<const uint32_t> list = corners.at(vertex);
        spokes.clear();
        fans.resize(degree);
        for (uint32_t i = 0; i < degree; ++i) {
            const uint32_t corner = list[i], triangle = corner / 3 * 3;
            fans[i] = i;
            spokes.push_back({mesh.indices[triangle + (corner - triangle + 1) % 3], i, true});
            spokes.push_back({mesh.indices[triangle + (corner - triangle + 2) % 3], i, false});
        }
        std::sort(spokes.begin(), spokes.end(),
                  [](const Spoke& a, const Spoke& b) { return a.neighbour < b.neighbour; });
        uint32_t fanCount = degree;
        for (std::size_t first = 0; first < spokes.size();) {
            std::size_t last = first + 1, outgoing = spokes[first].outgoing;
            for (; last < spokes.size() && spokes[last].neighbour == spokes[first].neighbour; ++last) {
                outgoing += spokes[last].outgoing;
                fanCount -= uniteFans(spokes[first].corner, spokes[last].corner);
            }
            if (spokes[first].neighbour > vertex) {  // each edge is counted at its lower end
                ++counts.edges;
                if (last - first == 1) ++counts.boundary;
                if (last - first > 2) ++counts.nonManifold;
                if (last - first == 2 && outgoing != 1) ++counts.flipped;
                for (std::size_t i = first + 1; i < last; ++i)
                    shells.unite(list[spokes[first].corner] / 3, list[spokes[i].corner] / 3);
            }
            first = last;
        }
        if (fanCount > 1) ++counts.nonManifoldVertices;
    }

  private:
    struct Spoke {
        uint32_t neighbour;
        uint32_t corner : 31;
        uint32_t outgoing : 1;
    };

    uint32_t fanRoot(uint32_t corner) {
        while (fans[corner] != corner) corner = fans[corner] = fans[fans[corner]];
        return corner;
    }
    /// 1 if they were apart.
    uint32_t uniteFans(uint32_t a, uint32_t b) {
        a = fanRoot(a);
        b = fanRoot(b);
        if (a == b) return 0;
        fans[std::max(a, b)] = std::min(a, b);
        return 1;
    }

    const WeldedMesh& mesh;
    const Corners& corners;
    SharedSets& shells;
    std::vector<Spoke> spokes;
    std::vector<uint32_t> fans;
};

void measureTopology(const WeldedMesh& mesh, const Corners& corners, Report& report) {
    constexpr std::size_t kVertices = 8192;
    const std::size_t count = mesh.positions.size();
    SharedSets shells(mesh.indices.size() / 3);
    std::vector<Topology> parts((count + kVertices - 1) / kVertices);
    forBlocks(count, kVertices, [&](std::size_t block, std::size_t first, std::size_t last) {
        VertexScan scan(mesh, corners, shells);
        for (std::size_t v = first; v < last; ++v) scan.visit(v, parts[block]);
    });
    Topology total;
    for (const Topology& part : parts) total.add(part);
    uint64_t faces = 0;
    std::vector<double> volumes(mesh.indices.size() / 3);  // of each shell, at its root
    for (std::size_t t = 0; t < mesh.indices.size() / 3; ++t) {
        if (collapsed(&mesh.indices[t * 3])) continue;
        ++faces;
        const uint32_t root = shells.root(static_cast<uint32_t>(t));
        if (root == t) ++report.shells;
        // Tetrahedra to a place on the shell: to a far one they would cancel.
        const glm::dvec3 from(mesh.positions[mesh.indices[std::size_t{root} * 3]]);
        const auto corner = [&](std::size_t k) {
            return glm::dvec3(mesh.positions[mesh.indices[t * 3 + k]]) - from;
        };
        volumes[root] += glm::dot(corner(0), glm::cross(corner(1), corner(2)));
    }
    report.cavities = uint64_t(std::ranges::count_if(volumes, [](double volume) { return volume < 0.0; }));
    report.vertices = total.vertices;
    report.boundaryEdges = total.boundary;
    report.nonManifoldEdges = total.nonManifold;
    report.flippedEdges = total.flipped;
    report.nonManifoldVertices = total.nonManifoldVertices;
    report.eulerCharacteristic = static_cast<int64_t>(total.vertices) - static_cast<int64_t>(total.edges) +
                                 static_cast<int64_t>(faces);
}

/// An angle between two sides, as what has its tangent: larger angles have lesser cotangents.
struct MeshAngle {
    double cosine = 0, sine = 0, cotangent = 0;  ///< the first two in any one unit
    double degrees() const { return std::atan2(sine, cosine) * (180.0 / 3.14159265358979323846); }
};

/// Of the triangles that are degenerate, how many; of the others the angles.
void measureShapes(const WeldedMesh& mesh, Report& report) {
    constexpr std::size_t kTriangles = 65536;
    struct Part {
        MeshAngle smallest{0, 0, -std::numeric_limits<double>::infinity()},
            largest{0, 0, std::numeric_limits<double>::infinity()};
        uint64_t degenerate = 0;
    };
    if (mesh.indices.empty()) return;
    const std::size_t count = mesh.indices.size() / 3;
    std::vector<Part> parts((count + kTriangles - 1) / kTriangles);
    forBlocks(count, kTriangles, [&](std::size_t block, std::size_t first, std::size_t last) {
        Part& part = parts[block];
        for (std::size_t t = first; t < last; ++t) {
            const uint32_t* triangle = &mesh.indices[t * 3];
            const glm::dvec3 a = glm::dvec3(mesh.positions[triangle[0]]);
            const glm::dvec3 ab = glm::dvec3(mesh.positions[triangle[1]]) - a;
            const glm::dvec3 ac = glm::dvec3(mesh.positions[triangle[2]]) - a;
            const glm::dvec3 normal = glm::cross(ab, ac);
            const double area = glm::length(normal) * 0.5;
            const glm::dvec3 bc = ac - ab;
            const double longest = std::max({glm::dot(ab, ab), glm::dot(ac, ac), glm::dot(bc, bc)});
            const bool degenerate = collapsed(triangle) || area <= kDegenerateRatio * longest;
            part.degenerate += degenerate;
            if (!degenerate)
                for (const double cosine : {glm::dot(ab, ac), -glm::dot(ab, bc), glm::dot(ac, bc)}) {
                    const MeshAngle corner{cosine, 2.0 * area, cosine / (2.0 * area)};
                    if (corner.cotangent > part.smallest.cotangent) part.smallest = corner;
                    if (corner.cotangent < part.largest.cotangent) part.largest = corner;
                }
        }
    });
    report.smallestAngle = 180;
    for (const Part& part : parts) {
        if (part.smallest.sine > 0.0) {
            report.smallestAngle = std::min(report.smallestAngle, part.smallest.degrees());
            report.largestAngle = std::max(report.largestAngle, part.largest.degrees());
        }
        report.degenerateTriangles += part.degenerate;
    }
}

struct ErrorSum {
    double greatest = 0, sum = 0;
    uint64_t count = 0;

    void add(double error) {
        if (std::isnan(error))
            error = std::numeric_limits<double>::infinity();  // an unknown distance is no small one
        greatest = std::max(greatest, error);
        sum += error;
        ++count;
    }
};

/// Measures the points that `collect(first, last, points)` gives for items 0..count.
template <class Collect>
void measureError(std::size_t count, const FieldError& fieldError, const Collect& collect, ErrorSum& total) {
    constexpr std::size_t kPoints = 4096;
    std::vector<ErrorSum> parts((count + kPoints - 1) / kPoints);
    forBlocks(count, kPoints, [&](std::size_t block, std::size_t first, std::size_t last) {
        std::vector<glm::dvec3> points;
        points.reserve(last - first);
        collect(first, last, points);
        if (points.empty()) return;
        std::vector<double> errors(points.size());
        fieldError(points, errors);
        for (const double error : errors) parts[block].add(error);
    });
    for (const ErrorSum& part : parts) {
        total.greatest = std::max(total.greatest, part.greatest);
        total.sum += part.sum;
        total.count += part.count;
    }
}

/// Points spread evenly over the triangles' area: one in each of equal shares of it, at random there.
std::vector<glm::dvec3> pointsOn(const WeldedMesh& mesh, double area, std::size_t count) {
    std::vector<glm::dvec3> points;
    std::mt19937_64 random(1);
    const auto any = [&] { return double(random() >> 11) * 0x1p-53; };
    const double share = area / double(count);
    double next = any() * share, passed = 0.0;
    for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
        const glm::dvec3 a(mesh.positions[mesh.indices[t]]),
            ab = glm::dvec3(mesh.positions[mesh.indices[t + 1]]) - a,
            ac = glm::dvec3(mesh.positions[mesh.indices[t + 2]]) - a;
        passed += 0.5 * glm::length(glm::cross(ab, ac));
        for (; next < passed && points.size() < count; next = (double(points.size()) + any()) * share) {
            const double u = std::sqrt(any()), v = any();
            points.push_back(a + (1.0 - u) * ab + u * v * ac);
        }
    }
    return points;
}

void measureToSurface(const WeldedMesh& mesh, const MeasureOptions& options, Report& report) {
    const std::vector<glm::dvec3> points = pointsOn(mesh, report.area, options.samples);
    ErrorSum total;
    const auto same = [&](std::size_t first, std::size_t last, std::vector<glm::dvec3>& some) {
        some.assign(points.begin() + std::ptrdiff_t(first), points.begin() + std::ptrdiff_t(last));
    };
    measureError(points.size(), options.distance, same, total);
    if (total.count > 0)
        report.meshToSurface = {total.greatest, total.sum / double(total.count), total.count};
}

void measureFromSurface(const TriangleTree& tree, const std::vector<SurfacePoint>& surface, Report& report) {
    if (surface.empty()) return;
    std::vector<double> distances(surface.size());
    forBlocks(distances.size(), 256, [&](std::size_t, std::size_t first, std::size_t last) {
        // The next point of a line, or of the one beside it, is near: so is what is nearest to it.
        uint32_t near = TriangleTree::kNoGuess;
        for (std::size_t i = first; i < last; ++i) {
            NearestPoint on;
            near = tree.nearest(surface[i].position, near, on);
            distances[i] = std::sqrt(on.squared);
        }
    });
    SampledDistance found{0, 0, distances.size()};
    double weights = 0.0;
    for (std::size_t i = 0; i < distances.size(); ++i) {
        found.max = std::max(found.max, distances[i]);
        found.mean += surface[i].weight * distances[i];
        weights += surface[i].weight;
    }
    found.mean /= weights;
    report.surfaceToMesh = found;
}

uint64_t selfIntersectionsOf(const TriangleTree& tree) {
    constexpr std::size_t kTriangles = 1024;
    std::vector<uint64_t> parts(tree.size() / kTriangles + 1);
    forBlocks(tree.size(), kTriangles, [&](std::size_t block, std::size_t first, std::size_t last) {
        parts[block] = tree.selfIntersections(first, last);
    });
    return std::accumulate(parts.begin(), parts.end(), uint64_t{0});
}

}  // namespace

Report reportOnWelded(const WeldedMesh& mesh, const MeasureOptions& options) {
    Report report;
    report.triangles = mesh.indices.size() / 3;
    std::future<TriangleTree> growing;
    if (options.selfIntersections || options.widths || !options.surface.empty())
        growing = std::async(std::launch::async, [&mesh] {
            return TriangleTree(mesh.positions, mesh.indices, TriangleTree::Purpose::distances);
        });
    const Corners corners = cornersOf(mesh.indices, mesh.positions.size());
    measureTopology(mesh, corners, report);
    measureShapes(mesh, report);
    static_cast<MeshSize&>(report) = sizeOf(mesh.positions, mesh.indices);
    if (growing.valid()) {
        const TriangleTree tree = growing.get();
        if (options.selfIntersections) report.selfIntersections = selfIntersectionsOf(tree);
        if (options.widths) report.widths = leastWidths(mesh.positions, mesh.indices, tree);
        if (!tree.empty()) measureFromSurface(tree, options.surface, report);
    }
    if (options.distance && report.area > 0.0) measureToSurface(mesh, options, report);
    if (!options.error) return report;
    ErrorSum total;
    const auto vertices = [&](std::size_t first, std::size_t last, std::vector<glm::dvec3>& points) {
        for (std::size_t v = first; v < last; ++v)
            if (corners.degree(v) > 0) points.emplace_back(mesh.positions[v]);
    };
    const auto centroids = [&](std::size_t first, std::size_t last, std::vector<glm::dvec3>& points) {
        for (std::size_t t = first; t < last; ++t) {
            const uint32_t* triangle = &mesh.indices[t * 3];
            if (collapsed(triangle)) continue;
            points.push_back((glm::dvec3(mesh.positions[triangle[0]]) +
                              glm::dvec3(mesh.positions[triangle[1]]) +
                              glm::dvec3(mesh.positions[triangle[2]])) /
                             3.0);
        }
    };
    measureError(mesh.positions.size(), options.error, vertices, total);
    measureError(mesh.indices.size() / 3, options.error, centroids, total);
    if (total.count > 0) {
        report.maxError = total.greatest;
        report.errorNote = options.errorNote;
        report.lipschitz = options.lipschitz;
        report.meanError = total.sum / static_cast<double>(total.count);
    }
    return report;
}

Result<Report> reportOnFile(const std::string& path, const MeasureOptions& options) {
    const Result<WeldedMesh> mesh = readWelded({path, path});
    if (!mesh) return mesh.error();
    return reportOnWelded(*mesh, options);
}

Report reportOnMesh(std::span<const glm::vec3> positions, std::span<const uint32_t> indices,
                    const MeasureOptions& options) {
    return reportOnWelded(weld(positions, indices), options);
}

double farthest(const Report& report) {
    double most = report.errorNote.empty() ? report.maxError.value_or(0.0) : 0.0;
    for (const std::optional<SampledDistance>& sampled : {report.meshToSurface, report.surfaceToMesh})
        if (sampled) most = std::max(most, sampled->max);
    return most;
}

std::string writeReport(const Report& report) {
    nlohmann::ordered_json out;
    const auto known = [](const std::optional<double>& value) {
        return value && std::isfinite(*value) ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
    };
    out["vertices"] = report.vertices;
    out["triangles"] = report.triangles;
    out["shells"] = report.shells;
    out["bodies"] = report.bodies();
    out["cavities"] = report.cavities;
    out["boundaryEdges"] = report.boundaryEdges;
    out["nonManifoldEdges"] = report.nonManifoldEdges;
    out["nonManifoldVertices"] = report.nonManifoldVertices;
    out["flippedEdges"] = report.flippedEdges;
    out["degenerateTriangles"] = report.degenerateTriangles;
    out["eulerCharacteristic"] = report.eulerCharacteristic;
    out["unit"] = report.unit;
    if (!report.fileLengths.empty()) out["fileLengths"] = report.fileLengths;
    out["volume"] = report.volume;
    out["area"] = report.area;
    out["boundsMin"] = report.boundsMin;
    out["boundsMax"] = report.boundsMax;
    out["size"] = report.extent();
    out["centreOfMass"] = report.centre;
    out["density"] = known(report.density);
    out["mass"] = known(report.mass());
    const auto least = [](const std::optional<LeastWidth>& width) {
        return width ? nlohmann::ordered_json({{"width", width->width}, {"place", width->place}})
                     : nlohmann::ordered_json();
    };
    out["leastWall"] = least(report.widths ? report.widths->wall : std::nullopt);
    out["leastGap"] = least(report.widths ? report.widths->gap : std::nullopt);
    out["units"] = {{"volume", report.unit + "³"},
                    {"area", report.unit + "²"},
                    {"density", "g/cm³"},
                    {"mass", "g"},
                    {"angles", "degrees"}};
    const bool distances = report.errorNote.empty();
    out["maxError"] = known(distances ? report.maxError : std::nullopt);
    out["meanError"] = known(distances ? report.meanError : std::nullopt);
    if (!distances) out["errorNote"] = report.errorNote;
    if (report.lipschitz) out["lipschitz"] = *report.lipschitz;
    out["selfIntersections"] = report.selfIntersections ? nlohmann::ordered_json(*report.selfIntersections)
                                                        : nlohmann::ordered_json();
    out["smallestAngle"] = report.smallestAngle;
    out["largestAngle"] = report.largestAngle;
    const auto sampled = [&](const std::string& name, const std::optional<SampledDistance>& distance) {
        out[name + "Max"] = known(distance ? std::optional(distance->max) : std::nullopt);
        out[name + "Mean"] = known(distance ? std::optional(distance->mean) : std::nullopt);
        out[name + "Samples"] = distance ? distance->samples : 0;
    };
    sampled("meshToSurface", report.meshToSurface);
    sampled("surfaceToMesh", report.surfaceToMesh);
    for (const LevelReport& level : report.levels)
        out["levels"].push_back({{"name", level.name},
                                 {"vertices", level.vertices},
                                 {"triangles", level.triangles},
                                 {"error", level.error}});
    out["capped"] = report.capped;
    const std::optional<Completeness>& completeness = report.completeness;
    out["complete"] =
        completeness ? nlohmann::ordered_json(completeness->complete()) : nlohmann::ordered_json();
    out["completeness"] = completeness && completeness->complete()
                              ? nlohmann::ordered_json(completeness->proven ? "proven" : "sampled")
                              : nlohmann::ordered_json();
    out["solidOutside"] = completeness && !completeness->complete()
                              ? nlohmann::ordered_json(*completeness->solidOutside)
                              : nlohmann::ordered_json();
    out["stages"] = nlohmann::ordered_json::object();
    for (const auto& [name, milliseconds] : report.stages) out["stages"][name] = milliseconds;
    out["totalMs"] = report.totalMs;
    out["peakMemoryBytes"] = report.peakMemoryBytes;
    out["device"] = report.device;
    return out.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::string reportWords(const Report& report) {
    std::vector<std::pair<std::string, std::string>> rows =
        sizeRows(report, report.lengths(), report.density);
    const auto length = [&](double number) { return withSign(number, "m", report.lengths()); };
    const auto width = [&](const char* name, const std::optional<LeastWidth>& least) {
        if (!least) return;
        std::string place;
        for (const double at : least->place) place += (place.empty() ? "" : ", ") + shortNumber(at);
        rows.emplace_back(name, length(least->width) + " at " + place);
    };
    if (report.widths)
        width("Thinnest wall", report.widths->wall), width("Narrowest gap", report.widths->gap);
    rows.emplace_back("Triangles", std::to_string(report.triangles));
    rows.emplace_back("Closed", report.closedManifold() ? "yes" : "no");
    rows.emplace_back("Bodies", std::to_string(report.bodies()));
    rows.emplace_back("Cavities", std::to_string(report.cavities));
    if (const auto& completeness = report.completeness)
        rows.emplace_back("Complete",
                          completeness->complete()
                              ? completeness->proven ? "yes, proven" : "yes, as far as samples show"
                              : "no: " + describeMissing(*completeness));
    if (report.lipschitz && *report.lipschitz > 1.0)
        rows.emplace_back("Field", lipschitzText(*report.lipschitz) + " within the region");
    if (report.meshToSurface) rows.emplace_back("From mesh to surface", length(report.meshToSurface->max));
    if (report.surfaceToMesh) rows.emplace_back("From surface to mesh", length(report.surfaceToMesh->max));
    std::string words;
    for (const auto& [name, value] : rows) words += name + ": " + value + "\n";
    return words;
}

Done checkMeasurable(uint64_t triangles, uint64_t freeBytes) {
    constexpr uint64_t kBytesOfATriangle = 105;  // measured, of 15 million
    const uint64_t needed = triangles * kBytesOfATriangle;
    if (needed <= freeBytes) return done();
    const auto gigabytes = [](uint64_t bytes) {
        return std::to_string((bytes + 500'000'000) / 1'000'000'000);
    };
    return Error{.message = "to measure " + std::to_string(triangles) + " triangles takes about " +
                            gigabytes(needed) + " GB of memory, and " + gigabytes(freeBytes) +
                            " GB are free: leave out --report and --require, or lower the resolution"};
}

uint64_t freeMemoryBytes() {
    std::ifstream file("/proc/meminfo");
    std::string name;
    for (uint64_t kilobytes = 0; file >> name >> kilobytes; file.ignore(256, '\n'))
        if (name == "MemAvailable:") return kilobytes * 1024;
    return std::numeric_limits<uint64_t>::max();
}

uint64_t peakMemoryBytes() {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return static_cast<uint64_t>(usage.ru_maxrss) * 1024;
}

}  // namespace fw
