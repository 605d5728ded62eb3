// Solids. Those of revolution stand on the y axis; half sizes are measured from the origin.
//
// Where the surface is, a gradient is wanted that gives the normal; so no case that holds there may be a root
// of what is 0 there. Convex solids whose distance needs a case distinction are written max(planes, outside
// distance) where the planes (max of signed plane distances) are the exact value inside and a lower bound
// outside: the maximum changes no value, but the planes give a narrow interval where the case is not decided,
// which is what culling lives on.
//
// Formulas after Inigo Quilez' collection of distance functions; the differences are noted at each entry.
#include "graph/nodes/code.h"
#include "graph/nodes/inputs.h"

namespace fw {
namespace {

/// To a corner of a tetrahedron or a dodecahedron, of unit length; and of an icosahedron.
constexpr std::array<double, 3> kDiagonal = {0.57735026918962576, 0.57735026918962576, 0.57735026918962576},
                                kIcosahedronCorner = {0.52573111211913361, 0, 0.85065080835203993};

/// A tube around a closed centre line whose curvature radius is `major_radius`: thicker than that, it
/// overlaps itself.
Exactness tubeExactness(const ExactnessArguments& node) {
    const auto major = node.constant("major_radius", 0), minor = node.constant("minor_radius", 0);
    return major && minor && *minor <= *major ? kExact : kExactOutside;
}

/// A tube around an arc: its two ends may also meet.
Exactness arcExactness(const ExactnessArguments& node) {
    const auto angle = node.constant("half_angle", 0);
    if (tubeExactness(node) != kExact || !angle) return kExactOutside;
    if (*angle <= 90 || *angle >= 180) return kExact;
    const double reach = *node.constant("major_radius", 0) * std::sin(*angle * 3.14159265358979323846 / 180);
    return *node.constant("minor_radius", 0) <= reach ? kExact : kExactOutside;
}

/// The wall |g| <= thickness of a periodic minimal surface g = 0, with k the wave number 2 pi / period. The
/// sums g below have |grad g| <= k sqrt(3), reached on the surface itself.
std::string wall(const std::string& sum) {
    return "float k = TAU / period;\nvec3 q = p * k;\nreturn abs(" + sum + ") / (k * sqrt(3.0)) - thickness;";
}

std::vector<InputSpec> wallInputs() {
    return {positionInput(),
            gripped(kRight,
                    positiveLength("period", 1, "Size of the cell that repeats in all three directions.")),
            length("thickness", 0.05, "Half the least thickness of the wall.")};
}

std::vector<NodeType> roundSolids() {
    return {
        {.id = "sphere",
         .label = "Sphere",
         .category = Category::shape,
         .doc = "A ball centred at the origin.",
         .inputs = {positionInput(),
                    gripped(kRight, length("radius", 1, "Distance from the centre to the surface."))},
         .outputs = kSurface,
         .exactness = always(kExact),
         .body = "return length(p) - radius;",
         .aliases = {"ball"}},
        {.id = "cylinder",
         .label = "Cylinder",
         .category = Category::shape,
         .doc = "An upright cylinder centred at the origin, its rims rounded if wished.",
         .inputs = {positionInput(),
                    gripped(kRight, length("radius", 0.5, "Distance from the axis to the side.")),
                    gripped(kUp, length("half_height", 1, "Half the height.")),
                    length("rounding", 0,
                           "Radius of the rounded rims, within the given size; what fits is used.")},
         .outputs = kSurface,
         .exactness = always(kExact),
         .body = std::string(kExtent) + R"(
float r = min(rounding, radius, half_height);
return ext2(vec2(length(p.xz) - (radius - r), abs(p.y) - (half_height - r))) - r;)"},
        {.id = "infinite_cylinder",
         .label = "Infinite cylinder",
         .category = Category::shape,
         .doc = "An upright cylinder without ends, for drilling holes.",
         .inputs = {positionInput(),
                    gripped(kRight, length("radius", 0.5, "Distance from the axis to the side."))},
         .outputs = kSurface,
         .exactness = always(kExact),
         .body = "return length(p.xz) - radius;"},
        {.id = "capsule",
         .label = "Capsule",
         .category = Category::shape,
         .doc = "A rod with round ends between two points.",
         .inputs = {positionInput(), place("a", {0, -0.5, 0}, "Centre of one round end."),
                    place("b", {0, 0.5, 0}, "Centre of the other round end."),
                    gripped(kRight, length("radius", 0.25, "Half the thickness of the rod."), "b")},
         .outputs = kSurface,
         .exactness = always(kExact),
         .body = R"(
vec3 along = b - a;
vec3 q = p - a;
return length(q - along * clamp(dot(q, along) / max(dot(along, along), 1e-12), 0.0, 1.0)) - radius;)"},
        {.id = "torus",
         .label = "Torus",
         .category = Category::shape,
         .doc = "A ring lying flat around the y axis.",
         .inputs = {positionInput(),
                    gripped(kRight,
                            length("major_radius", 1, "Distance from the centre to the middle of the tube.")),
                    gripped(kUp, length("minor_radius", 0.25, "Half the thickness of the tube."),
                            "major_radius")},
         .outputs = kSurface,
         .exactness = tubeExactness,
         .body = "return length(vec2(length(p.xz) - major_radius, p.y)) - minor_radius;",
         .aliases = {"ring", "donut"}},
        {.id = "capped_torus",
         .label = "Capped torus",
         .category = Category::shape,
         .doc = "A piece of an upright ring with round ends, opening downwards like a rainbow.",
         .inputs = {positionInput(),
                    grippedAngle(
                        kUp, kRight,
                        angle("half_angle", 90, 0, 180, "Angle from the top of the ring to either end."),
                        "major_radius"),
                    gripped(kUp, length("major_radius", 0.5,
                                        "Distance from the centre to the middle of the tube.")),
                    gripped(kToEye, length("minor_radius", 0.1, "Half the thickness of the tube."),
                            "major_radius")},
         .outputs = kSurface,
         .exactness = arcExactness,
         .body = R"(
float s = max(sin(radians(half_angle)), 0.0);
float c = cos(radians(half_angle));
float x = abs(p.x);
bool beyond = half_angle <= 0.0 || x * c > p.y * s;
vec2 q = beyond ? vec2(x - major_radius * s, p.y - major_radius * c) : vec2(length(p.xy) - major_radius, 0.0);
return length(vec3(q, p.z)) - minor_radius;)"},
        {.id = "link",
         .label = "Chain link",
         .category = Category::shape,
         .doc = "An upright ring cut in half and stretched along y.",
         .inputs = {positionInput(),
                    gripped(kUp, length("half_length", 0.25, "Half the length of the straight part.")),
                    gripped(kUp,
                            length("major_radius", 0.3,
                                   "Distance from the middle line to the middle of the tube."),
                            "half_length"),
                    gripped(kToEye, length("minor_radius", 0.1, "Half the thickness of the tube."),
                            "major_radius")},
         .outputs = kSurface,
         .exactness = tubeExactness,
         .body = R"(
float y = max(abs(p.y) - half_length, 0.0);
return length(vec2(length(vec2(p.x, y)) - major_radius, p.z)) - minor_radius;)"},
        {.id = "cone",
         .label = "Cone",
         .category = Category::shape,
         .doc = "A cone with its tip at the origin and its base below.",
         .inputs = {positionInput(), gripped(kRight, length("radius", 0.5, "Radius of the base."), "height"),
                    gripped(kDown, length("height", 1, "Distance from the tip down to the base."))},
         .outputs = kSurface,
         .exactness = always(kExact),
         .body = std::string(kSegment) + R"(
vec2 w = vec2(length(p.xz), p.y);
float h = max(height, 1e-12);
float planes = max((w.x * h + w.y * radius) / length(vec2(radius, h)), -p.y - h);
float side = segment(w, vec2(0.0), vec2(radius, -h));
float base = length(vec2(max(w.x - radius, 0.0), p.y + h));
return planes <= 0.0 ? planes : max(planes, min(side, base));)"},
        {.id = "capped_cone",
         .label = "Capped cone",
         .category = Category::shape,
         .doc = "A cone with its tip cut off, centred at the origin.",
         .inputs = {positionInput(), gripped(kUp, length("half_height", 0.5, "Half the height.")),
                    gripped(kRight, length("radius_bottom", 0.5, "Radius of the lower face."),
                            "-half_height"),
                    gripped(kRight, length("radius_top", 0.25, "Radius of the upper face."), "half_height")},
         .outputs = kSurface,
         .exactness = always(kExact),
         .body = std::string(kSegment) + R"(
vec2 w = vec2(length(p.xz), p.y);
float h = max(half_height, 1e-12);
vec2 slope = normalize(vec2(2.0 * h, radius_bottom - radius_top));
float cap = abs(p.y) - h;
float planes = max(dot(w - vec2(radius_bottom, -h), slope), cap);
float side = segment(w, vec2(radius_bottom, -h), vec2(radius_top, h));
float ends = length(vec2(max(w.x - (p.y < 0.0 ? radius_bottom : radius_top), 0.0), cap));
return planes <= 0.0 ? planes : max(planes, min(side, ends));)",
         .aliases = {"frustum"}},
        // Where one ball swallows the other (height <= |difference of radii|) the hull is the larger ball.
        {.id = "round_cone",
         .label = "Round cone",
         .category = Category::shape,
         .doc = "Two balls above each other with a straight skin stretched around them.",
         .inputs = {positionInput(),
                    gripped(kDown,
                            length("radius_bottom", 0.5, "Radius of the lower ball, centred at the origin.")),
                    gripped(kUp, length("radius_top", 0.25, "Radius of the upper ball."), "height"),
                    gripped(kUp, length("height", 0.75, "Distance between the centres of the balls."))},
         .outputs = kSurface,
         .exactness = always(kExact),
         .body = R"(
vec2 w = vec2(length(p.xz), p.y);
float bottom = length(w) - radius_bottom;
float top = length(vec2(w.x, p.y - height)) - radius_top;
if (height <= abs(radius_bottom - radius_top)) return radius_bottom > radius_top ? bottom : top;
float b = clamp((radius_bottom - radius_top) / max(height, 1e-12), -1.0, 1.0);
float a = sqrt(1.0 - b * b);
float k = p.y * a - w.x * b;
float skin = w.x * a + p.y * b - radius_bottom;
return k < 0.0 ? max(skin, bottom) : (k > a * height ? max(skin, top) : skin);)"},
        // A sphere scaled by the radii, times the least of them. The common first-order formula k0 (k0 - 1) /
        // k1 is nearer to the distance outside, but its gradient reaches 36 for axes of 1:0.1 and it
        // overshoots inside.
        {.id = "ellipsoid",
         .label = "Ellipsoid",
         .category = Category::shape,
         .doc = "A ball stretched differently along x, y and z.",
         .inputs = {positionInput(), lengths("radii", {0.75, 0.5, 0.4}, "Half the size along x, y and z.")},
         .outputs = kSurface,
         .exactness =
             [](const ExactnessArguments& node) {
                 const auto x = node.constant("radii", 0), y = node.constant("radii", 1),
                            z = node.constant("radii", 2);
                 return x && y && z && *x == *y && *y == *z ? kExact : kBound;
             },
         .body = R"(
vec3 r = max(radii, 1e-6);
if (r.x == r.y && r.y == r.z) return length(p) - r.x;
return (length(p / r) - 1.0) * min(r.x, r.y, r.z);)"},
        {.id = "cut_sphere",
         .label = "Cut sphere",
         .category = Category::shape,
         .doc = "A ball centred at the origin of which only what lies above a height remains.",
         .inputs = {positionInput(), gripped(kRight, length("radius", 0.5, "Radius of the ball.")),
                    gripped(kUp, coordinate("height", 0,
                                            "Height of the flat face; negative keeps more than half."))},
         .outputs = kSurface,
         .exactness = always(kExact),
         .body = R"(
float h = clamp(height, -radius, radius);
float w = sqrt(max(radius * radius - h * h, 0.0));
float q = length(p.xz);
float planes = max(length(p) - radius, h - p.y);
return q > w && w * p.y < h * q ? max(planes, length(vec2(q - w, p.y - h))) : planes;)"},
        {.id = "solid_angle",
         .label = "Solid angle",
         .category = Category::shape,
         .doc = "A cone with its tip at the origin, opening upwards and closed by a piece of a ball.",
         .inputs = {positionInput(),
                    grippedAngle(kUp, kRight,
                                 angle("half_angle", 30, 0, 180, "Angle between the axis and the side."),
                                 "radius"),
                    gripped(kUp, length("radius", 1, "Distance from the tip to the round end."))},
         .outputs = kSurface,
         .exactness = always(kExact),
         .body = R"(
float ball = length(p) - radius;
if (half_angle >= 180.0) return ball;
vec2 edge = vec2(sin(radians(half_angle)), cos(radians(half_angle)));
vec2 w = vec2(length(p.xz), p.y);
float foot = dot(w, edge);
float line = w.x * edge.y - w.y * edge.x;
float ends = length(w - edge * clamp(foot, 0.0, radius));
return max(ball, foot >= 0.0 && foot <= radius ? line : (line < 0.0 ? -ends : ends));)"},
        {.id = "vesica",
         .label = "Vesica",
         .category = Category::shape,
         .doc = "A pointed lens on end: an arc turned around the y axis.",
         .inputs =
             {positionInput(),
              gripped(kUp, length("half_height", 0.5, "Distance from the centre to each point.")),
              gripped(
                  kRight,
                  length(
                      "radius", 0.25,
                      "Radius at the waist, kept between a thousandth of the half height and all of it."))},
         .outputs = kSurface,
         .exactness = always(kExact),
         .body = R"(
float w = clamp(radius, 0.001 * half_height, half_height);
float d = (half_height * half_height - w * w) / max(2.0 * w, 1e-12);
vec2 q = vec2(length(p.xz), abs(p.y));
float arc = length(vec2(q.x + d, q.y)) - (d + w);
return half_height * q.x < d * (q.y - half_height) ? max(arc, length(vec2(q.x, q.y - half_height))) : arc;)",
         .aliases = {"lens"}},
    };
}

std::vector<NodeType> flatSolids() {
    return {
        {.id = "box",
         .label = "Box",
         .category = Category::shape,
         .doc = "A box centred at the origin, its edges rounded if wished.",
         .inputs = {positionInput(), lengths("half_extents", {1, 1, 1}, "Half the size along x, y and z."),
                    length("rounding", 0,
                           "Radius of the rounded edges, within the given size; what fits is used.")},
         .outputs = kSurface,
         .exactness = always(kExact),
         .body = std::string(kExtent) + R"(
float r = min(rounding, half_extents.x, half_extents.y, half_extents.z);
return ext3(abs(p) - (half_extents - r)) - r;)",
         .aliases = {"cube", "cuboid"}},
        {.id = "box_max",
         .label = "Box (max norm)",
         .category = Category::shape,
         .doc = "A box whose field keeps sharp corners when offset; the cheapest solid there is.",
         .inputs = {positionInput(), lengths("half_extents", {1, 1, 1}, "Half the size along x, y and z.")},
         .outputs = kSurface,
         .exactness = always(kExactInside),
         .body = "vec3 q = abs(p) - half_extents;\nreturn max(q.x, q.y, q.z);"},
        {.id = "box_frame",
         .label = "Box frame",
         .category = Category::shape,
         .doc = "The twelve edges of a box as square bars.",
         .inputs = {positionInput(),
                    lengths("half_extents", {1, 1, 1}, "Half the outer size along x, y and z."),
                    length("thickness", 0.1, "Half the width of a bar.")},
         .outputs = kSurface,
         .exactness = always(kExactOutside),
         .body = std::string(kExtent) + R"(
vec3 q = abs(p) - half_extents;
vec3 w = abs(q + thickness) - thickness;
return min(ext3(vec3(q.x, w.yz)), ext3(vec3(w.x, q.y, w.z)), ext3(vec3(w.xy, q.z)));)"},
        {.id = "plane",
         .label = "Plane",
         .category = Category::shape,
         .doc = "Everything below a plane.",
         .inputs = {positionInput(),
                    grippedDirection(direction("normal", {0, 1, 0},
                                               "Direction out of the solid; its length does not matter."),
                                     "offset"),
                    grippedAlong(
                        "normal",
                        coordinate("offset", 0, "Distance of the plane from the origin along the normal."))},
         .outputs = kSurface,
         .exactness = always(kExact),
         .body = "vec3 n = length(normal) > 0.0 ? normalize(normal) : vec3(0.0, 1.0, 0.0);\n"
                 "return dot(p, n) - offset;",
         .aliases = {"half_space"}},
        {.id = "slab",
         .label = "Slab",
         .category = Category::shape,
         .doc = "An endless level plate around the height 0.",
         .inputs = {positionInput(),
                    gripped(kUp, length("half_thickness", 0.5, "Half the thickness of the plate."))},
         .outputs = kSurface,
         .exactness = always(kExact),
         .body = "return abs(p.y) - half_thickness;"},
        {.id = "octahedron",
         .label = "Octahedron",
         .category = Category::shape,
         .doc = "Two square pyramids base to base, with a corner on each axis.",
         .inputs = {positionInput(),
                    gripped(kRight, length("size", 0.5, "Distance from the centre to each corner."))},
         .outputs = kSurface,
         .exactness = always(kExact),
         .body = R"(
vec3 q = abs(p);
float u = max(q.x, q.y, q.z);
float w = min(q.x, q.y, q.z);
float v = q.x + q.y + q.z - u - w;
float m = (q.x + q.y + q.z - size) / 3.0;
float t = clamp((u - v + size) * 0.5, 0.0, size);
float face = m * sqrt(3.0);
return w >= m ? face : max(face, length(vec3(u - t, v - (size - t), w)));)"},
        {.id = "pyramid",
         .label = "Pyramid",
         .category = Category::shape,
         .doc = "A square pyramid standing on the ground, its base centred at the origin.",
         .inputs = {positionInput(), gripped(kRight, length("half_side", 0.5, "Half the side of the base.")),
                    gripped(kUp, length("height", 0.8, "Height of the tip above the base."))},
         .outputs = kSurface,
         .exactness = always(kExact),
         // Folded so that x >= z >= 0; (along, z) are coordinates in the lateral face, `slope` is the
         // distance to its plane.
         .body = std::string(kSegment) + R"(
float x = max(abs(p.x), abs(p.z));
float z = abs(p.x) + abs(p.z) - x;
float c = half_side;
float h = max(height, 1e-12);
float l = length(vec2(c, h));
float slope = (x * h + (p.y - h) * c) / l;
float along = (p.y * h - (x - c) * c) / l;
float planes = max(slope, -p.y);
float outer = c * along + (z - c) * l;
float foot = length(vec2(min(along, 0.0), max(z - c, 0.0)));
float face = length(vec2(slope, outer < 0.0 ? foot : segment(vec2(along, z), vec2(0.0, c), vec2(l, 0.0))));
float base = length(vec3(max(x - c, 0.0), p.y, max(z - c, 0.0)));
return planes <= 0.0 ? planes : max(planes, min(face, base));)"},
        {.id = "prism",
         .label = "Prism",
         .category = Category::shape,
         .doc = "A regular polygon in the xy plane, standing on an edge, with thickness along z.",
         .inputs = {positionInput(), integer("sides", 6, 3, 128, "Number of sides."),
                    gripped(kDown,
                            length("apothem", 0.5, "Distance from the centre to the middle of each side.")),
                    gripped(kToEye, length("half_height", 0.5, "Half the thickness along z."))},
         .outputs = kSurface,
         .exactness = always(kExact),
         .body = std::string(kExtent) + kSector + R"(
return ext2(vec2(regularPolygon(p.xy, sides, apothem), abs(p.z) - half_height));)"},
        {.id = "tetrahedron",
         .label = "Tetrahedron",
         .category = Category::shape,
         .doc = "A solid of four triangles, centred at the origin.",
         .inputs = {positionInput(),
                    gripped(kDiagonal, length("size", 0.75, "Distance from the centre to each corner."))},
         .outputs = kSurface,
         .exactness = always(kExactInside),
         .body = "return max(abs(p.x + p.y) - p.z, abs(p.x - p.y) + p.z) / sqrt(3.0) - size / 3.0;"},
        // The faces of a dodecahedron look along (golden ratio, 1, 0) and its turns; those of an icosahedron
        // along (1, 1, 1) and (golden ratio, 1 / golden ratio, 0) and its turns. Both have inradius /
        // circumradius = sqrt((5 + 2 sqrt(5)) / 15).
        {.id = "dodecahedron",
         .label = "Dodecahedron",
         .category = Category::shape,
         .doc = "A solid of twelve pentagons, centred at the origin.",
         .inputs = {positionInput(),
                    gripped(kDiagonal, length("size", 0.5, "Distance from the centre to each corner."))},
         .outputs = kSurface,
         .exactness = always(kExactInside),
         .body = R"(
vec3 q = abs(p);
vec2 n = normalize(vec2(0.5 + 0.5 * sqrt(5.0), 1.0));
float faces = max(dot(q.xy, n), dot(q.yz, n), dot(q.zx, n));
return faces - size * sqrt((5.0 + 2.0 * sqrt(5.0)) / 15.0);)"},
        {.id = "icosahedron",
         .label = "Icosahedron",
         .category = Category::shape,
         .doc = "A solid of twenty triangles, centred at the origin.",
         .inputs = {positionInput(),
                    gripped(kIcosahedronCorner,
                            length("size", 0.5, "Distance from the centre to each corner."))},
         .outputs = kSurface,
         .exactness = always(kExactInside),
         .body = R"(
vec3 q = abs(p);
float golden = 0.5 + 0.5 * sqrt(5.0);
vec2 n = vec2(1.0 / golden, golden);
float faces = max(q.x + q.y + q.z, dot(q.xy, n), dot(q.yz, n), dot(q.zx, n)) / sqrt(3.0);
return faces - size * sqrt((5.0 + 2.0 * sqrt(5.0)) / 15.0);)"},
    };
}

std::vector<NodeType> periodicSolids() {
    return {
        {.id = "gyroid",
         .label = "Gyroid",
         .category = Category::shape,
         .doc = "An endless winding wall without straight lines that divides space in two.",
         .inputs = wallInputs(),
         .outputs = kSurface,
         .exactness = always(kBound),
         .body = wall("sin(q.x) * cos(q.y) + sin(q.y) * cos(q.z) + sin(q.z) * cos(q.x)")},
        {.id = "schwarz_p",
         .label = "Schwarz P",
         .category = Category::shape,
         .doc = "An endless wall of joined balls, one tunnel along each axis.",
         .inputs = wallInputs(),
         .outputs = kSurface,
         .exactness = always(kBound),
         .body = wall("cos(q.x) + cos(q.y) + cos(q.z)")},
        // The four products of Schwarz' diamond surface, joined by the addition theorems.
        {.id = "diamond",
         .label = "Diamond",
         .category = Category::shape,
         .doc = "An endless wall whose tunnels meet like the bonds of a diamond.",
         .inputs = wallInputs(),
         .outputs = kSurface,
         .exactness = always(kBound),
         .body = wall("sin(q.x) * cos(q.y - q.z) + cos(q.x) * sin(q.y + q.z)")},
    };
}

std::vector<NodeType> picturedSolids() {
    return {
        // The height over the ground is as steep as its steepest step from pixel to pixel, which the picture
        // tells; divided by that, y - height never exceeds the distance. Above the highest point the plane
        // through it is a better bound. The picture ends half a pixel within its border, where the heights of
        // the outermost pixels go on.
        {.id = "heightfield",
         .label = "Heightfield",
         .category = Category::shape,
         .doc = "A block whose top is a relief: the lighter the picture, the higher.",
         .inputs = {positionInput(), picture("image", " Seen from above it stands upright, with -z up."),
                    gripped({0.5, 1, 0.5},
                            {.name = "size",
                             .type = Type::vec3,
                             .value = numbers({2, 0.5, 2}),
                             .min = 1e-6,
                             .unit = "m",
                             .doc = "Extent along x, height of white over black, extent along z."}),
                    gripped(kDown, length("base", 0.1, "Thickness below black, which is at y = 0."))},
         .outputs = kSurface,
         .exactness = always(kBound),
         .body = R"(
vec2 half = 0.5 / image_size(image);
vec2 uv = clamp(vec2(p.x / size.x, -p.z / size.z) + 0.5, half, 1.0 - half);
vec2 steep = image_slope(image) * size.y / vec2(size.x, size.z);
float top = image_range(image).y * size.y;
float relief = (p.y - size.y * image_grey(image, uv)) / sqrt(1.0 + dot(steep, steep));
return max(relief, p.y - top, -base - p.y, abs(p.x) - 0.5 * size.x, abs(p.z) - 0.5 * size.z);)",
         .aliases = {"heightmap", "terrain"}},
    };
}

}  // namespace

std::vector<NodeType> shapeNodes() {
    std::vector<NodeType> all = roundSolids();
    for (auto family : {flatSolids, periodicSolids, picturedSolids}) {
        for (NodeType& node : family()) all.push_back(std::move(node));
    }
    return all;
}

}  // namespace fw
