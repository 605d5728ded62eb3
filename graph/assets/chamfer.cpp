#include "graph/assets/chamfer.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <optional>
#include <vector>

#include "graph/base/parallel.h"

namespace fw {

namespace {

constexpr double kReachOfCut = 2.0;                  // radii from a face within which another one matters
constexpr double kOneFace = 0.93;                    // cosine of normals that may be of one face
constexpr double kSharpest = -0.71;                  // of the faces of an edge that is cut
constexpr double kSteps[] = {0.35, 0.7, 1.4, 2.1};   // radii from a sample, where faces are looked for
constexpr double kShare[] = {1.0, 0.75, 0.5, 0.25};  // of the way to where a sample lies above a face
constexpr std::size_t kMostFaces = 6;                // around a place
constexpr double kFollows = 1.35;                    // of 2, by which a nearest point follows its sample
constexpr double kBehind = 0.2;  // each other's planes, of the distance of two faces' places
// Cells:
constexpr double kApart = 0.25, kLeastFar = 0.5, kLeastCut = 1e-3;
constexpr double kClose = 1.5, kBehindEdge = 4.0,
                 kOff = 0.5;  // behind an edge's planes, where distances are theirs

/// A plane by its normal and its distance from the origin, cells; and where on the surface it was found.
struct Plane {
    glm::dvec3 normal;
    double offset;
    glm::dvec3 touches;
    double at(const glm::dvec3& p) const { return glm::dot(normal, p) - offset; }
};

/// The planes that cut samples off.
class Cut {
  public:
    Cut(const VolumeGrid& grid_, double radius_, std::span<const glm::vec3> nearest_,
        std::span<const float> distances_)
        : grid(grid_),
          radius(std::min(radius_ / grid_.cell,
                          double(glm::max(glm::max(grid_.size.x, grid_.size.y), grid_.size.z)))),
          nearest(nearest_),
          distances(distances_),
          onFace(nearest.size(), 0) {
        for (int z = -1; z <= 1; ++z)
            for (int y = -1; y <= 1; ++y)
                for (int x = -1; x <= 1; ++x)
                    if (x != 0 || y != 0 || z != 0) ways.push_back(glm::normalize(glm::dvec3(x, y, z)));
        forBlocks(std::size_t(grid.size.z), 1, [&](std::size_t z, std::size_t, std::size_t) {
            std::size_t index = grid.index(0, 0, int(z));
            for (int y = 0; y < grid.size.y; ++y)
                for (int x = 0; x < grid.size.x; ++x, ++index)
                    onFace[index] = isInside(index) && isOnFace({x, y, int(z)}, index);
        });
    }

    /// The plane that cuts a sample off the most, if that is more than its own distance tells.
    std::optional<Plane> planeFor(const glm::ivec3& at) const {
        const std::size_t index = grid.index(at.x, at.y, at.z);
        const double own = distances[index] / grid.cell;
        if (std::abs(own) > kReachOfCut * radius) return std::nullopt;
        const glm::dvec3 p(at);
        const std::vector<Plane> faces = facesAround(p);
        std::optional<Plane> found;
        double most = own + kLeastCut;
        for (std::size_t i = 1; i < faces.size(); ++i)
            for (std::size_t k = 0; k < i; ++k) {
                const Plane &a = faces[i], &b = faces[k];
                if (!makeEdge(a, b) || !meetNear(a, b, p)) continue;
                const Plane cut = between(a, b);
                if (const double value = cut.at(p); value > most) most = value, found = cut;
            }
        return found;
    }
    bool isInside(std::size_t index) const { return distances[index] < 0.0f; }

  private:
    bool holds(const glm::ivec3& at) const {
        return glm::all(glm::greaterThanEqual(at, glm::ivec3(0))) && glm::all(glm::lessThan(at, grid.size));
    }
    /// Whether the nearest point of a sample follows it both ways along the surface, as it does over a face;
    /// beside an edge it does so one way alone. Where it leaps to another face on one side the other side
    /// tells.
    bool isOnFace(const glm::ivec3& at, std::size_t index) const {
        double follows = 0.0;
        for (int axis = 0; axis < 3; ++axis) {
            float least = 1e30f, along = 0.0f;
            for (const int step : {-1, 1}) {
                glm::ivec3 beside = at;
                beside[axis] += step;
                if (!holds(beside)) continue;
                const glm::vec3 moved = nearest[grid.index(beside.x, beside.y, beside.z)] - nearest[index];
                if (const float far = glm::length(moved); far < least)
                    least = far, along = moved[axis] * float(step);
            }
            follows += double(along);
        }
        return follows > kFollows;
    }
    /// The face that a sample inside is nearest to.
    std::optional<Plane> faceOf(const glm::ivec3& at) const {
        if (!holds(at)) return std::nullopt;
        const std::size_t index = grid.index(at.x, at.y, at.z);
        if (!onFace[index]) return std::nullopt;
        const glm::dvec3 touches(nearest[index]), off = touches - glm::dvec3(at);
        const double far = glm::length(off);
        if (far < kLeastFar) return std::nullopt;  // its direction is not known well
        return Plane{off / far, glm::dot(off / far, touches), touches};
    }
    /// The faces around a place, of each the plane where the place lies above it the most nearly.
    std::vector<Plane> facesAround(const glm::dvec3& p) const {
        struct Found {
            Plane face;
            glm::dvec3 from;  // a sample that is nearest to it
            double beside;    // where p lies above it
        };
        std::vector<Found> all;
        const auto look = [&](const glm::dvec3& from) {
            if (const std::optional<Plane> face = faceOf(glm::ivec3(glm::floor(from + 0.5))))
                all.push_back({*face, from, beside(*face, p)});
        };
        look(p);
        for (const double step : kSteps)
            for (const glm::dvec3& way : ways) look(p + step * radius * way);
        std::ranges::sort(all, {}, &Found::beside);
        std::vector<Plane> faces;
        for (const Found& found : all) {
            const auto same = [&](const Plane& face) {
                return glm::dot(face.normal, found.face.normal) > kOneFace;
            };
            if (faces.size() < kMostFaces && std::ranges::none_of(faces, same))
                faces.push_back(walked(found.face, found.from, p));
        }
        return faces;
    }
    static double beside(const Plane& face, const glm::dvec3& p) {
        const glm::dvec3 way = p - face.touches;
        return glm::length(way - face.normal * glm::dot(face.normal, way));
    }
    /// Whether two faces are at an angle to cut, and each lies behind the other: not beside an edge that runs
    /// inwards, of which all samples have that edge for their nearest place.
    static bool makeEdge(const Plane& a, const Plane& b) {
        const double c = glm::dot(a.normal, b.normal), behind = a.at(b.touches), other = b.at(a.touches);
        return c < kOneFace && c > kSharpest && std::max(behind, other) <= kLeastCut &&
               behind + other < -kBehind * glm::distance(a.touches, b.touches) - kApart;
    }
    /// Whether the surface has the two planes' edge where it is the nearest to a place, and a ball that
    /// touches the face that is nearer there is as far from the other one as from its plane: distances are
    /// nowhere more than to the planes. Those to a bent face are, far from where its plane was found, and
    /// those beside edges of others.
    bool meetNear(const Plane& a, const Plane& b, const glm::dvec3& p) const {
        const double c = glm::dot(a.normal, b.normal), offA = a.at(p), offB = b.at(p);
        const auto isAsPlanes = [&](const glm::dvec3& place) {
            const glm::ivec3 at(glm::floor(place + 0.5));
            if (!holds(at)) return false;
            const double there = distances[grid.index(at.x, at.y, at.z)] / grid.cell;
            return there > std::max(a.at(glm::dvec3(at)), b.at(glm::dvec3(at))) - kOff;
        };
        const auto behind = [&](double ofA, double ofB) {
            const double byA = offA + ofA, byB = offB + ofB;
            return p - ((byA - c * byB) * a.normal + (byB - c * byA) * b.normal) / (1.0 - c * c);
        };
        return isAsPlanes(behind(0.0, 0.0)) && isAsPlanes(behind(kClose, kBehindEdge)) &&
               isAsPlanes(behind(kBehindEdge, kClose)) &&
               isAsPlanes(p - (radius + std::max(offA, offB)) * (offA > offB ? a.normal : b.normal));
    }
    Plane between(const Plane& a, const Plane& b) const {
        const double c = glm::dot(a.normal, b.normal), size = std::sqrt(2.0 + 2.0 * c);
        return {(a.normal + b.normal) / size, (a.offset + b.offset - radius * (1.0 - c)) / size, a.touches};
    }
    /// The same face as it is nearer to where p lies above it; `from` is a place that is nearest to the face.
    Plane walked(const Plane& face, const glm::dvec3& from, const glm::dvec3& p) const {
        const glm::dvec3 way = p - face.touches, along = way - face.normal * glm::dot(face.normal, way);
        if (glm::length(along) < 1.0) return face;
        for (const double share : kShare) {
            const std::optional<Plane> closer = faceOf(glm::ivec3(glm::floor(from + share * along + 0.5)));
            if (closer && glm::dot(closer->normal, face.normal) > kOneFace) return *closer;
        }
        return face;
    }

    const VolumeGrid& grid;
    double radius;  // cells
    std::span<const glm::vec3> nearest;
    std::span<const float> distances;
    std::vector<char> onFace;  ///< of samples inside
    std::vector<glm::dvec3> ways;
};

}  // namespace

void chamferEdges(const VolumeGrid& grid, double radius, std::span<const glm::vec3> nearest,
                  std::span<float> distances, std::span<glm::vec3> gradients) {
    const std::vector<float> given(distances.begin(), distances.end());
    const Cut cut(grid, radius, nearest, given);
    forBlocks(std::size_t(grid.size.z), 1, [&](std::size_t z, std::size_t, std::size_t) {
        std::size_t index = grid.index(0, 0, int(z));
        for (int y = 0; y < grid.size.y; ++y)
            for (int x = 0; x < grid.size.x; ++x, ++index)
                if (const std::optional<Plane> plane = cut.planeFor({x, y, int(z)})) {
                    distances[index] = float(grid.cell * plane->at(glm::dvec3(x, y, double(z))));
                    gradients[index] = glm::vec3(plane->normal);
                }
    });
}

}  // namespace fw
