#include "runtime/play/copied_meshes.h"

#include <algorithm>
#include <cmath>
#include <glm/mat4x4.hpp>
#include <map>
#include <numeric>

#include "graph/evaluate/evaluate.h"
#include "runtime/mesh/field_values.h"
#include "runtime/mesh/joined.h"
#include "runtime/mesh/separate_parts.h"
#include "runtime/play/part_meshes.h"

namespace fw {
namespace {

/// Of a cell: by so much a copy may be off. A vertex on a smooth surface is off by far less.
constexpr double kFarOff = 0.1;
/// Points of a copy that are looked at, of a piece, and of another solid.
constexpr std::size_t kPointsOfACopy = 96, kPointsOfAPiece = 32, kPointsOfASolid = 1000;
/// Vertices of a piece at which the map's gradient is asked for, until there is one.
constexpr std::size_t kTries = 6;
/// Numbers of a material may differ by so much; and of so many points one, for it may lie on a border.
constexpr float kOtherMaterial = 1.0f / 256.0f;
constexpr std::size_t kPointsForABorder = 16;

constexpr const char* kApart = "do not stand apart: they touch, or reach into each other";
constexpr const char* kWhole = "are not whole: a border of a cell or of the region cuts them, or they differ";
constexpr const char* kAlone = "cannot be meshed by themselves";
constexpr const char* kAlike = "are not of the same material";

struct Piece {
    Mesh mesh;
    std::size_t first = 0;  ///< of its vertices among those of all pieces
};

struct Copy {
    CopyPlace place;
    glm::dmat4 matrix;
    std::vector<std::size_t> pieces;
    const char* fault = nullptr;
};

/// Every so manieth number below `count`, `most` at most.
std::vector<std::size_t> some(std::size_t count, std::size_t most) {
    std::vector<std::size_t> chosen;
    const std::size_t step = std::max<std::size_t>(1, (count + most - 1) / most);
    for (std::size_t i = 0; i < count; i += step) chosen.push_back(i);
    return chosen;
}

glm::vec3 at(const glm::dmat4& matrix, const glm::vec3& p) {
    return glm::vec3(matrix * glm::dvec4(glm::dvec3(p), 1.0));
}

/// Distance, material and the painter of a field at places.
struct Asked {
    const Program& program;
    std::vector<float> values;

    Asked(const Program& field, std::span<const glm::vec3> places)
        : program(field),
          values(fieldValues(makeTape(field.ir, field.surface, field.parameters()), places)) {}
    const float* of(std::size_t place) const { return &values[place * kSurfaceComponents]; }
    float distance(std::size_t place) const { return of(place)[distanceComponent]; }
    std::string_view painter(std::size_t place) const {
        const auto number = std::size_t(of(place)[painterComponent]);
        return number < program.painters.size() ? program.painters[number] : std::string_view();
    }
};

bool sameMaterial(const Asked& a, std::size_t i, const Asked& b, std::size_t k) {
    for (int part = baseColorComponent; part < painterComponent; ++part)
        if (!(std::abs(a.of(i)[part] - b.of(k)[part]) <=
              kOtherMaterial * std::max(1.0f, std::abs(b.of(k)[part]))))
            return false;
    return a.painter(i) == b.painter(k);
}

class CopyFinder {
  public:
    CopyFinder(const MeshedField& whole, const Program& map_, const std::optional<Box>& given)
        : solid(whole), map(map_), region(given) {}

    CopiedMesh find(const MeshContent& meshContent) {
        part();
        placePieces();
        CopiedMesh found;
        if (!copies.empty()) {
            double largest = 0;
            for (const Copy& copy : copies) largest = std::max(largest, copy.place.pose.size);
            const Result<MeshedField> content = meshContent(solid.cellSize / largest);
            if (content && !content->mesh.indices.empty()) {
                check(*content);
                found.mesh = content->mesh;
            } else {
                for (Copy& copy : copies) copy.fault = kAlone;
                if (!content) found.why = content.error().message;
            }
        }
        std::vector<bool> copied(pieces.size());
        for (const Copy& copy : copies) {
            if (copy.fault) {
                why = why ? why : copy.fault;
                continue;
            }
            found.places.push_back(copy.place);
            for (const std::size_t piece : copy.pieces) copied[piece] = true;
        }
        if (found.places.size() < 2) {  // one shares with no other
            found.places.clear(), found.mesh = {};
            found.rest = solid.mesh;
        } else {
            std::vector<Mesh> left;
            for (std::size_t i = 0; i < pieces.size(); ++i)
                if (!copied[i]) left.push_back(std::move(pieces[i].mesh));
            found.rest = joined(left);
        }
        if (why) found.why = found.why.empty() ? why : std::string(why) + " (" + found.why + ")";
        return found;
    }

  private:
    void part() {
        for (Mesh& mesh : separateParts(solid.mesh)) {
            pieces.push_back({std::move(mesh), vertices.size()});
            const std::vector<glm::vec3>& own = pieces.back().mesh.positions;
            vertices.insert(vertices.end(), own.begin(), own.end());
        }
    }

    /// Finds the map of each piece, and joins those of one.
    void placePieces() {
        const std::span<const IrId> roots(&map.surface[emissionComponent], 3);
        const std::vector<double> parameters = map.parameters();
        places = fieldValues(makeTape(map.ir, roots, parameters), vertices);
        std::vector<Point> tried;
        std::vector<std::size_t> from;  // of each piece, its first in that list
        for (const Piece& piece : pieces) {
            from.push_back(tried.size());
            for (const std::size_t i : some(piece.mesh.positions.size(), kTries)) {
                const glm::vec3& p = piece.mesh.positions[i];
                tried.push_back({p.x, p.y, p.z});
            }
        }
        from.push_back(tried.size());
        std::array<std::vector<ValueGradient>, 3> seen;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            seen[axis].resize(tried.size());
            evaluateGradient(map.ir, roots[axis], parameters, tried, seen[axis]);
        }
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            std::optional<CopyPlace> place;
            for (std::size_t k = from[i]; k < from[i + 1] && !place; ++k) {
                place = placeOf(mapAt({seen[0][k].gradient, seen[1][k].gradient, seen[2][k].gradient},
                                      {seen[0][k].value, seen[1][k].value, seen[2][k].value}, tried[k]));
                if (place && !holds(pieces[i], matrixOf(*place))) place.reset();
            }
            if (place)
                join(*place, i);
            else
                why = kApart;
        }
    }

    /// Whether the piece is that of one copy.
    bool holds(const Piece& piece, const glm::dmat4& matrix) const {
        for (std::size_t i = 0; i < piece.mesh.positions.size(); ++i) {
            const float* q = &places[3 * (piece.first + i)];
            const glm::vec3 back = at(matrix, {q[0], q[1], q[2]});
            if (!(glm::length(back - piece.mesh.positions[i]) <= kFarOff * solid.cellSize)) return false;
        }
        return true;
    }

    /// Copies lie in the order of their moves along a line on which few of those of a grid meet.
    void join(const CopyPlace& place, std::size_t piece) {
        const auto& [x, y, z] = place.pose.move;
        const double along = 0.61803 * x + 0.54369 * y + 0.56714 * z, near = 0.01 * solid.cellSize;
        for (auto known = order.lower_bound(along - near);
             known != order.end() && known->first <= along + near; ++known)
            if (same(copies[known->second].place, place, near))
                return copies[known->second].pieces.push_back(piece);
        order.emplace(along, copies.size());
        copies.push_back({place, matrixOf(place), {piece}});
    }

    static bool same(const CopyPlace& a, const CopyPlace& b, double near) {
        double cosine = 0, off = 0;
        for (std::size_t i = 0; i < 4; ++i) cosine += a.pose.turn[i] * b.pose.turn[i];
        for (std::size_t i = 0; i < 3; ++i) off = std::max(off, std::abs(a.pose.move[i] - b.pose.move[i]));
        return a.mirrored == b.mirrored && off <= near && std::abs(cosine) > 1.0 - 1e-9 &&
               std::abs(a.pose.size / b.pose.size - 1.0) < 1e-5;
    }

    void check(const MeshedField& content) {
        checkCopies(content);
        checkPieces(content);
        if (!region) return;
        for (Copy& copy : copies)
            if (!copy.fault && !std::ranges::all_of(content.mesh.positions, [&](const glm::vec3& p) {
                    const glm::vec3 q = at(copy.matrix, p);
                    for (int axis = 0; axis < 3; ++axis)
                        if (q[axis] < region->lo[std::size_t(axis)] ||
                            q[axis] > region->hi[std::size_t(axis)])
                            return false;
                    return true;
                }))
                copy.fault = kWhole;
    }

    void checkCopies(const MeshedField& content) {
        std::vector<glm::vec3> own, carried;
        for (const std::size_t i : some(content.mesh.positions.size(), kPointsOfACopy))
            own.push_back(content.mesh.positions[i]);
        for (const Copy& copy : copies)
            for (const glm::vec3& p : own) carried.push_back(at(copy.matrix, p));
        const Asked here(content.program, own), there(solid.program, carried);
        for (std::size_t c = 0; c < copies.size(); ++c) {
            std::size_t others = 0;
            for (std::size_t i = 0; i < own.size(); ++i) {
                const std::size_t k = c * own.size() + i;
                if (!(std::abs(there.distance(k)) <= most(here.distance(i), copies[c])))
                    copies[c].fault = kWhole;
                others += !sameMaterial(here, i, there, k);
            }
            if (others > own.size() / kPointsForABorder && !copies[c].fault) copies[c].fault = kAlike;
        }
    }

    void checkPieces(const MeshedField& content) {
        std::vector<glm::vec3> seen, on;
        for (const Copy& copy : copies)
            for (const std::size_t piece : copy.pieces)
                for (const std::size_t i : some(pieces[piece].mesh.positions.size(), kPointsOfAPiece)) {
                    const float* q = &places[3 * (pieces[piece].first + i)];
                    seen.emplace_back(q[0], q[1], q[2]);
                    on.push_back(pieces[piece].mesh.positions[i]);
                }
        const Asked there(content.program, seen), here(solid.program, on);
        std::size_t k = 0;
        for (Copy& copy : copies)
            for (const std::size_t piece : copy.pieces)
                for (std::size_t i = some(pieces[piece].mesh.positions.size(), kPointsOfAPiece).size();
                     i-- > 0; ++k)
                    if (!(std::abs(there.distance(k)) * copy.place.pose.size <=
                          std::abs(here.distance(k)) + kFarOff * solid.cellSize))
                        copy.fault = kWhole;
    }

    /// How far from the solid's surface a point may be that is so far from that of what is copied.
    double most(float distance, const Copy& copy) const {
        return std::abs(distance) * copy.place.pose.size + kFarOff * solid.cellSize;
    }

    const MeshedField& solid;
    const Program& map;
    const std::optional<Box>& region;
    std::vector<Piece> pieces;
    std::vector<glm::vec3> vertices;  ///< of all pieces
    std::vector<float> places;        ///< of what is copied, that are seen there
    std::vector<Copy> copies;
    std::multimap<double, std::size_t> order;
    const char* why = nullptr;
};

}  // namespace

glm::dmat4 matrixOf(const CopyPlace& place) {
    glm::dmat4 matrix = matrixOf(place.pose);
    if (place.mirrored) matrix[0] = -matrix[0];
    return matrix;
}

CopiedMesh copiedMesh(const MeshedField& solid, const Program& map, const std::optional<Box>& region,
                      const MeshContent& meshContent) {
    return CopyFinder(solid, map, region).find(meshContent);
}

bool reachInto(const std::vector<MeshedSolid>& solids, const Program& document, double depth) {
    std::vector<glm::vec3> points;
    for (const MeshedSolid& solid : solids) {
        for (const std::size_t i : some(solid.mesh.positions.size(), kPointsOfASolid))
            points.push_back(solid.mesh.positions[i]);
        for (const CopyPlace& place : solid.copied.places)
            for (const std::size_t i : some(solid.copied.mesh.positions.size(), kPointsOfAPiece))
                points.push_back(at(matrixOf(place), solid.copied.mesh.positions[i]));
    }
    const std::vector<float> distances =
        fieldValues(makeTape(document.ir, document.distance(), document.parameters()), points);
    return std::ranges::any_of(distances, [&](float distance) { return distance < -depth; });
}

}  // namespace fw
