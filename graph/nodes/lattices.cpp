// Lattices: cells that repeat without end in all three directions, for what is to be light and stiff.
//
// Struts. The crystals that struts follow are their own mirror images, so a place is folded into the one
// chamber between the mirrors (q, with q.x >= q.y >= q.z >= 0 for all cubic ones but diamond) where one or
// two struts are left: the nearest of a set that is mirrored there lies in the chamber. Distances are exact
// outside the struts. Hexagonal: a honeycomb in x and z, in layers along y, with posts at its corners.
//
// Surfaces. Sums of products of sines and cosines whose zero set is near a triply periodic minimal surface
// (Schoen, "Infinite periodic minimal surfaces without self-intersections", NASA TN D-5541, 1970; Lidinoid
// and split P: von Schnering and Nesper, Z. Phys. B 83, 1991). Their value divided by the length of their
// gradient is the distance to first order, so that walls are even; the value itself is added under the root,
// since the gradient is 0 somewhere. That leaves it close to 1-Lipschitz for most; slopeOf() has the greatest
// slope of each, found by maximising over 10^6 places, rounded up. It grows no more about a ninth of a cell
// from the surface.
//
// Grading. Thickness may be any field. Cells cannot be stretched by a field without tearing far from the
// Grading. Thickness may be any field. Cells cannot be stretched by a field without tearing far from the
// origin, so they are halved, once for each whole number of `grade`; between two whole numbers the fields of
// both are mixed. Struts of the finer lattice contain those of the coarser (but for diamond, Kelvin and
// hexagonal), which then stay, and the others grow out of them.
//
// Foam: the walls of a Voronoi diagram (cellWall in graph/ir/noise.h).
#include <utility>

#include "graph/nodes/inputs.h"

namespace fw {
namespace {

/// The greatest slope of a surface's distance, or that of struts; see above.
double slopeOf(const std::string& kind) {
    constexpr std::pair<std::string_view, double> kSteepest[] = {{"gyroid", 1.001},   {"schwarz p", 1.02},
                                                                 {"schwarz d", 1.01}, {"neovius", 1.8},
                                                                 {"lidinoid", 4.5},   {"split p", 1.3}};
    for (const auto& [surface, slope] : kSteepest)
        if (kind == surface) return slope;
    return 1.0;
}
Exactness latticeExactness(const ExactnessArguments& node) {
    const double slope = slopeOf(node.option("kind"));
    if (node.constant("grade", 0) != 0.0) return distorted();
    return slope > 1.0 ? distorted(slope) : kExactOutside;
}

/// The distance from the middle of a strut, or along the gradient from a surface, in cells.
constexpr std::string_view kCell = R"(
vec3 sorted(vec3 a) {
    float most = max(a.x, a.y, a.z);
    float least = min(a.x, a.y, a.z);
    return vec3(most, max(min(a.x, a.y), min(max(a.x, a.y), a.z)), least);
}
float segment3(vec3 q, vec3 a, vec3 along) {
    return length(q - a - along * clamp(dot(q - a, along) / dot(along, along), 0.0, 1.0));
}
float even(float sum, vec3 slope) {
    return sum / sqrt(dot(slope, slope) + 2.0 * sum * sum) / TAU;
}
float cellOf(vec3 u) {
    if (kind == "cubic") {
        vec3 q = abs(u - round(u));
        float all = dot(q, q);
        return sqrt(all - max(q.x * q.x, q.y * q.y, q.z * q.z));
    }
    if (kind == "body centred") {
        vec3 q = abs(u - round(u));
        return length(q - (q.x + q.y + q.z) / 3.0);
    }
    if (kind == "face centred") {
        vec3 q = sorted(abs(u - round(u)));
        return sqrt(q.z * q.z + 0.5 * (q.x - q.y) * (q.x - q.y));
    }
    if (kind == "octet") {
        vec3 q = sorted(abs(u - round(u)));
        float face = q.z * q.z + 0.5 * (q.x - q.y) * (q.x - q.y);
        float between = (0.5 - q.x) * (0.5 - q.x) + 0.5 * (q.y + q.z - 0.5) * (q.y + q.z - 0.5);
        return sqrt(min(face, between));
    }
    if (kind == "kelvin") {
        vec3 q = sorted(abs(u - round(u)));
        vec3 corner = vec3(0.5, 0.25, 0.0);
        return min(segment3(q, corner, vec3(0.0, -0.125, 0.125)), segment3(q, corner, vec3(-0.125, 0.125, 0.0)));
    }
    if (kind == "diamond") {
        vec3 n = round(2.0 * u);
        vec3 off = 2.0 * u - n;
        vec3 size = abs(off);
        float odd = mod(n.x + n.y + n.z, 2.0);
        float most = max(size.x, size.y, size.z);
        vec3 move = size.x >= most ? vec3(off.x < 0.0 ? -1.0 : 1.0, 0.0, 0.0)
            : size.y >= most ? vec3(0.0, off.y < 0.0 ? -1.0 : 1.0, 0.0)
            : vec3(0.0, 0.0, off.z < 0.0 ? -1.0 : 1.0);
        vec3 r = 0.5 * (off - move * odd);
        vec3 a = sorted(abs(r));
        float way = r.x * r.y * r.z < 0.0 ? -1.0 : 1.0;
        vec3 q = vec3(a.x, a.y, way * a.z);
        return length(q - clamp((q.x + q.y + q.z) / 3.0, 0.0, 0.25));
    }
    if (kind == "hexagonal") {
        vec2 h = vec2(1.7320508, 1.0);
        vec2 a = vec2(u.x, u.z) - h * round(vec2(u.x, u.z) / h);
        vec2 moved = vec2(u.x, u.z) - 0.5 * h;
        vec2 b = moved - h * round(moved / h);
        vec2 q = abs(dot(a, a) < dot(b, b) ? a : b);
        if (q.y < q.x * 1.7320508) q = vec2(abs(0.5 * q.x - 0.8660254 * q.y), 0.8660254 * q.x + 0.5 * q.y);
        float layer = abs(u.y - round(u.y));
        return min(length(vec2(q.y - 0.5, layer)), length(vec2(q.y - 0.5, q.x - 0.2886751)));
    }
    vec3 q = TAU * u;
    vec3 s = sin(q);
    vec3 c = cos(q);
    if (kind == "gyroid")
        return even(s.x * c.y + s.y * c.z + s.z * c.x,
            vec3(c.x * c.y - s.z * s.x, c.y * c.z - s.x * s.y, c.z * c.x - s.y * s.z));
    if (kind == "schwarz p") return even(c.x + c.y + c.z, s);
    if (kind == "schwarz d") {
        float same = c.y * c.z + s.y * s.z;
        float sum = s.y * c.z + c.y * s.z;
        float turn = s.x * (c.y * s.z - s.y * c.z);
        float fall = c.x * (c.y * c.z - s.y * s.z);
        return even(s.x * same + c.x * sum, vec3(c.x * same - s.x * sum, fall + turn, fall - turn));
    }
    if (kind == "neovius")
        return even(3.0 * (c.x + c.y + c.z) + 4.0 * c.x * c.y * c.z,
            vec3(s.x * (3.0 + 4.0 * c.y * c.z), s.y * (3.0 + 4.0 * c.z * c.x), s.z * (3.0 + 4.0 * c.x * c.y)));
    vec3 s2 = 2.0 * s * c;
    vec3 c2 = 1.0 - 2.0 * s * s;
    float pairs = c2.x * c2.y + c2.y * c2.z + c2.z * c2.x;
    vec3 fall = s2 * vec3(c2.y + c2.z, c2.z + c2.x, c2.x + c2.y);
    if (kind == "lidinoid")
        return even(0.5 * (s2.x * c.y * s.z + s2.y * c.z * s.x + s2.z * c.x * s.y) - 0.5 * pairs + 0.15,
            vec3(c2.x * c.y * s.z + 0.5 * (s2.y * c.z * c.x - s2.z * s.x * s.y),
                 c2.y * c.z * s.x + 0.5 * (s2.z * c.x * c.y - s2.x * s.y * s.z),
                 c2.z * c.x * s.y + 0.5 * (s2.x * c.y * c.z - s2.y * s.z * s.x)) + fall);
    return even(1.1 * (s2.x * s.z * c.y + s2.y * s.x * c.z + s2.z * s.y * c.x) - 0.2 * pairs - 0.4 * (c2.x + c2.y + c2.z),
        1.1 * vec3(2.0 * c2.x * s.z * c.y + s2.y * c.x * c.z - s2.z * s.y * s.x,
                   2.0 * c2.y * s.x * c.z + s2.z * c.y * c.x - s2.x * s.z * s.y,
                   2.0 * c2.z * s.y * c.x + s2.x * c.z * c.y - s2.y * s.x * s.z) + 0.4 * fall + 0.8 * s2);
}
float solid(float off, float size, float thick) {
    return (fill == "sheet" ? abs(off) : off) * size - 0.5 * thick;
}
)";

constexpr std::string_view kLattice = R"(
if (grade <= 0.0) return solid(cellOf(p / cell), cell, thickness);
float whole = floor(grade);
float part = grade - whole;
float coarse = cell * exp2(-whole);
float fine = 0.5 * coarse;
float a = solid(cellOf(p / coarse), coarse, thickness);
float b = solid(cellOf(p / fine), fine, thickness);
if (kind == "cubic" || kind == "body centred" || kind == "face centred" || kind == "octet") b = min(a, b);
return mix(a, b, part);)";

}  // namespace

std::vector<NodeType> latticeNodes() {
    return {
        {.id = "lattice",
         .label = "Lattice",
         .category = Category::shape,
         .doc = "Struts, or a winding surface, in cells that repeat without end: intersect it with the part "
                "that is to be light.",
         .inputs = {positionInput(),
                    choice(
                        "kind",
                        {"octet", "cubic", "body centred", "face centred", "kelvin", "diamond", "hexagonal",
                         "gyroid", "schwarz p", "schwarz d", "neovius", "lidinoid", "split p"},
                        "The first seven are struts, the others surfaces."),
                    gripped(kRight, positiveLength("cell", 0.5, "Size of the cell that repeats.")),
                    length("thickness", 0.05,
                           "Of struts or walls, from side to side; any field, for what is graded. Of a solid "
                           "how far it is grown, twice."),
                    choice("fill", {"sheet", "solid"},
                           "Of a surface: a wall along it, or all on one side of it."),
                    {.name = "grade",
                     .type = Type::scalar,
                     .value = numbers({0}),
                     .min = 0,
                     .max = 6,
                     .doc = "How often cells are halved; a field makes them finer in places."}},
         .outputs = kSurface,
         .exactness = latticeExactness,
         .body = std::string(kCell) + std::string(kLattice),
         .aliases = {"struts", "tpms", "infill"}},
        {.id = "voronoi_foam",
         .label = "Voronoi foam",
         .category = Category::shape,
         .doc = "Closed cells of all shapes about scattered points, with walls between them, without end.",
         .inputs =
             {positionInput(), positiveLength("cell", 0.5, "Size of a cell, on average."),
              length("thickness", 0.05,
                     "Of the walls, from side to side, below 0.3 of a cell; any field, for what is graded."),
              integer("seed", 0, 0, 1 << 24, "Another one scatters other points.")},
         .outputs = kSurface,
         .exactness = always(kBound),
         .body = "return cell_wall(p / cell, seed) * cell - 0.5 * thickness;",
         .aliases = {"voronoi", "sponge"}},
    };
}

}  // namespace fw
