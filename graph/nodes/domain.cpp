// Nodes that move, repeat and deform the space in which a surface stands, or change its distance.
#include <algorithm>

#include "graph/compile/graph_lowering.h"
#include "graph/compile/repetitions.h"
#include "graph/nodes/inputs.h"

namespace fw {
namespace {

InputSpec subject(const char* doc) { return surfaceInput("surface", doc); }

/// Keeps the Lipschitz constant and nothing else.
Exactness weakened(const ExactnessArguments& node) { return distorted(node.surface("surface").lipschitz); }

/// Unchanged while the constant `input` is 0, else of unknown distortion.
ExactnessRule distortedBy(std::string input) {
    return [input = std::move(input)](const ExactnessArguments& node) {
        return node.constant(input, 0) == 0.0 ? node.surface("surface") : distorted();
    };
}

/// a - distance: the side that the surface moves towards stays as exact as it was there.
Exactness offsetBy(const ExactnessArguments& node, std::optional<double> distance) {
    const Exactness a = node.surface("surface");
    if (!distance) return distorted(a.lipschitz);
    return {a.outside && *distance >= 0, a.inside && *distance <= 0, a.lipschitz};
}

InputSpec neighbours() {
    return toggle("neighbours", true,
                  "Looks at the neighbouring copies too, so that copies may touch; off is faster, for copies "
                  "well inside their cells.");
}

/// Sine and cosine of angles in degrees, exact at multiples of 90; `turned` undoes rotations about x, then y,
/// then z.
constexpr const char* kRotation = R"(
float sinOf(float a) { return mod(a, 180.0) == 0.0 ? 0.0 : sin(radians(a)); }
float cosOf(float a) { return mod(a - 90.0, 180.0) == 0.0 ? 0.0 : cos(radians(a)); }
vec3 turned(vec3 q, vec3 angles) {
    vec3 s = vec3(sinOf(angles.x), sinOf(angles.y), sinOf(angles.z));
    vec3 c = vec3(cosOf(angles.x), cosOf(angles.y), cosOf(angles.z));
    q = vec3(c.z * q.x + s.z * q.y, c.z * q.y - s.z * q.x, q.z);
    q = vec3(c.y * q.x - s.y * q.z, q.y, c.y * q.z + s.y * q.x);
    return vec3(q.x, c.x * q.y + s.x * q.z, c.x * q.z - s.x * q.y);
}
)";

std::vector<NodeType> placements() {
    return {
        {.id = "translate",
         .label = "Translate",
         .category = Category::domain,
         .doc = "Moves a surface.",
         .inputs = {subject("The surface to move."),
                    place("offset", {0, 0, 0}, "How far to move along x, y and z.")},
         .outputs = kSurface,
         .exactness = sameAs("surface"),
         .body = "return surface(p - offset);",
         .aliases = {"move"}},
        {.id = "rotate",
         .label = "Rotate",
         .category = Category::domain,
         .doc = "Turns a surface about the x axis, then the y axis, then the z axis.",
         .inputs = {subject("The surface to turn."),
                    {.name = "angles",
                     .type = Type::vec3,
                     .value = numbers({0, 0, 0}),
                     .unit = "degrees",
                     .doc = "Angles about x, y and z, counter-clockwise seen from the tip of the axis."}},
         .outputs = kSurface,
         .exactness = sameAs("surface"),
         .body = std::string(kRotation) + "return surface(turned(p, angles));",
         .aliases = {"turn"}},
        {.id = "scale",
         .label = "Scale",
         .category = Category::domain,
         .doc = "Makes a surface larger or smaller, the same in all directions.",
         .inputs = {subject("The surface to scale."),
                    {.name = "factor",
                     .type = Type::scalar,
                     .value = numbers({1}),
                     .min = 0,
                     .doc = "How many times larger.",
                     .positive = true}},
         .outputs = kSurface,
         .exactness = sameAs("surface"),
         .body = "s = surface(p / factor);\nreturn with_distance(s, s.distance * factor);"},
        {.id = "stretch",
         .label = "Stretch",
         .category = Category::domain,
         .doc = "Scales a surface by different factors along x, y and z.",
         .inputs = {subject("The surface to stretch."),
                    {.name = "factors",
                     .type = Type::vec3,
                     .value = numbers({1, 1, 1}),
                     .min = 0,
                     .doc = "How many times larger along x, y and z.",
                     .positive = true}},
         .outputs = kSurface,
         .exactness =
             [](const ExactnessArguments& node) {
                 const auto x = node.constant("factors", 0), y = node.constant("factors", 1),
                            z = node.constant("factors", 2);
                 return x && y && z && *x == *y && *y == *z ? node.surface("surface") : weakened(node);
             },
         .body = "s = surface(p / factors);\nreturn with_distance(s, s.distance * min(factors.x, factors.y, "
                 "factors.z));"},
        {.id = "transform",
         .label = "Transform",
         .category = Category::domain,
         .doc = "Scales, turns and moves a surface, in this order.",
         .inputs = {subject("The surface to transform."),
                    place("translation", {0, 0, 0}, "How far to move along x, y and z."),
                    {.name = "rotation",
                     .type = Type::vec3,
                     .value = numbers({0, 0, 0}),
                     .unit = "degrees",
                     .doc =
                         "Angles about x, then y, then z, counter-clockwise seen from the tip of the axis."},
                    {.name = "scale",
                     .type = Type::scalar,
                     .value = numbers({1}),
                     .min = 0,
                     .doc = "How many times larger, the same in all directions.",
                     .positive = true}},
         .outputs = kSurface,
         .exactness = sameAs("surface"),
         .body = std::string(kRotation) + "s = surface(turned(p - translation, rotation) / scale);\nreturn "
                                          "with_distance(s, s.distance * scale);"},
        // |d| n replaces the part of p along n; along an axis it is written so that the part cancels exactly,
        // which keeps intervals narrow.
        {.id = "mirror",
         .label = "Mirror",
         .category = Category::domain,
         .doc = "Replaces what lies behind a plane by the mirror image of what lies before it.",
         .inputs = {subject("The surface to mirror."),
                    grippedDirection(
                        direction(
                            "normal", {1, 0, 0},
                            "Direction from the plane to the side that is kept; its length does not matter."),
                        "offset"),
                    grippedAlong(
                        "normal",
                        coordinate("offset", 0, "Distance of the plane from the origin along the normal."))},
         .outputs = kSurface,
         .exactness = weakened,
         .body = R"(
vec3 n = normalize(normal);
float d = dot(p, n) - offset;
vec3 q = p - d * n + abs(d) * n;
if (abs(n.x) == 1.0) q.x = n.x * (offset + abs(d));
if (abs(n.y) == 1.0) q.y = n.y * (offset + abs(d));
if (abs(n.z) == 1.0) q.z = n.z * (offset + abs(d));
return surface(q);)"},
    };
}

std::vector<NodeType> repetitions() {
    return {
        // The two nearest copies along an axis are those whose centres enclose p: with mod these two have one
        // jump a
        // period, where "nearest and next nearest" have two, and every jump widens the intervals of the boxes
        // it cuts.
        {.id = "repeat",
         .label = "Repeat",
         .category = Category::domain,
         .doc = "Copies a surface along x, y and z, the copies centred on the origin.",
         .inputs = {subject("The surface to repeat; it should fit into one cell of the size of the period."),
                    lengths("period", {2.5, 2.5, 2.5},
                            "Distance between copies along x, y and z; 0 does not repeat along that axis."),
                    {.name = "count",
                     .type = Type::vec3,
                     .value = numbers({0, 0, 0}),
                     .min = 0,
                     .doc = "Number of copies along x, y and z; 0 is endless."},
                    neighbours()},
         .outputs = kSurface,
         .exactness = repeatExactness,
         .body = R"(
// Offsets of x from the two copies that enclose it; both the same where there is one.
vec2 enclosing(float x, float period, float count) {
    if (period <= 0.0 || count == 1.0) return vec2(x);
    if (count == 0.0) return vec2(mod(x, period), mod(x, period) - period);
    float last = 0.5 * (count - 1.0);
    float shift = fract(last);
    float cell = floor(x / period - shift) + shift;
    // The outer clamps change no value; they tell the interval what the cells do.
    float left = x + last * period;
    float right = x - last * period;
    return vec2(clamp(x - period * clamp(cell, -last, last), min(0.0, left), max(period, right)),
                clamp(x - period * clamp(cell + 1.0, -last, last), min(-period, left), max(0.0, right)));
}
// Offset of x from the copy whose cell it is in.
float nearest(float x, float period, float count) {
    if (period <= 0.0 || count == 1.0) return x;
    if (count == 0.0) return mod(x + 0.5 * period, period) - 0.5 * period;
    float last = 0.5 * (count - 1.0);
    float shift = fract(last);
    float cell = floor(x / period - shift + 0.5) + shift;
    float left = x + last * period;
    float right = x - last * period;
    return clamp(x - period * clamp(cell, -last, last), min(-0.5 * period, left), max(0.5 * period, right));
}
vec3 n = round(count);
if (!neighbours) return surface(vec3(nearest(p.x, period.x, n.x), nearest(p.y, period.y, n.y), nearest(p.z, period.z, n.z)));
vec2 x = enclosing(p.x, period.x, n.x);
vec2 y = enclosing(p.y, period.y, n.y);
vec2 z = enclosing(p.z, period.z, n.z);
s = surface(vec3(x.x, y.x, z.x));
for (int i = 0; i < 2; i++) {
    for (int j = 0; j < 2; j++) {
        for (int k = 0; k < 2; k++) {
            if (i == 1 && (period.x <= 0.0 || n.x == 1.0)) continue;
            if (j == 1 && (period.y <= 0.0 || n.y == 1.0)) continue;
            if (k == 1 && (period.z <= 0.0 || n.z == 1.0)) continue;
            s = min(s, surface(vec3(i == 0 ? x.x : x.y, j == 0 ? y.x : y.y, k == 0 ? z.x : z.y)));
        }
    }
}
return s;)",
         .lower = lowerRepeat,
         .aliases = {"array"}},
        // Of the 27 cells about p all copies are looked at. A copy reaches at most half a period beyond its
        // cell, so
        // those of all other cells are half a period away, which bounds the distance. Cells are counted from
        // seven
        // before their own: the same sum for each of them, so that the copies are alike (graph/ir/families.h)
        // and a
        // brick pays only for those near it.
        {.id = "scatter",
         .label = "Scatter",
         .category = Category::domain,
         .doc = "Copies a surface to the cells of a grid, each moved, turned, sized and left out at random.",
         .inputs =
             {subject(
                  "The surface to scatter, centred on the origin; at its greatest size it should fit into a "
                  "cell, whichever way it is turned."),
              lengths("period", {2.5, 2.5, 2.5},
                      "Size of a cell along x, y and z; 0 has one layer along that axis."),
              share("jitter", 0.5,
                    "How far copies stand off the middle of their cells; 1 is up to its sides."),
              share("turn", 1, "How far copies are turned about y; 1 is any way."),
              share("size_variation", 0.5, "How much smaller the smallest copy is."),
              share("chance", 1, "Share of the cells that have a copy."),
              integer("seed", 0, 0, 1000000, "Another number gives another pattern.")},
         .outputs = kSurface,
         .exactness = scatterExactness,
         .body = R"(
float own(float x, float period) { return period > 0.0 ? floor(x / period + 0.5) : 0.5; }
vec3 home = vec3(own(p.x, period.x), own(p.y, period.y), own(p.z, period.z));
float reach = 0.5 * min(period.x > 0.0 ? period.x : 1e9, period.y > 0.0 ? period.y : 1e9, period.z > 0.0 ? period.z : 1e9);
s = empty();
for (int i = 0; i < 27; i++) {
    vec3 offset = vec3(mod(i, 3), mod(floor(i / 3), 3), floor(i / 9));
    if (period.x <= 0.0 && offset.x != 0.0) continue;
    if (period.y <= 0.0 && offset.y != 0.0) continue;
    if (period.z <= 0.0 && offset.z != 0.0) continue;
    vec3 cell = floor(home + (offset - 0.5));
    vec3 place = hash3(cell, seed);
    vec3 kind = hash3(cell, seed + 1000001);
    vec3 q = p - period * (cell + (place - 0.5) * jitter);
    float angle = TAU * turn * kind.x;
    float size = max(1.0 - size_variation * kind.y, 0.01);
    q = vec3(cos(angle) * q.x - sin(angle) * q.z, q.y, cos(angle) * q.z + sin(angle) * q.x) / size;
    copy = surface(q);
    copy = with_distance(copy, (chance >= 1.0 || kind.z < chance) ? min(copy.distance * size, reach) : reach);
    if (i == 0) s = copy; else s = min(s, copy);
}
return s;)",
         .lower = lowerScatter},
        // u points to the first copy, v a quarter turn on. Up to four copies are each looked at: their
        // rotations are constants, so intervals are as narrow as those of one. Of more, the two that enclose
        // p, as in repeat, but in the angle. It jumps from copy to copy alone: where the cut of atan2 would
        // lie between them, it is turned by half a sector.
        {.id = "polar_repeat",
         .label = "Polar repeat",
         .category = Category::domain,
         .doc = "Copies a surface in a circle around an axis; the first copy stands where the surface is, "
                "along +x (along +y if the "
                "axis is x).",
         .inputs =
             {subject(
                  "The surface to repeat, moved away from the axis along +x; it should fit into its sector."),
              integer("count", 6, 1, 1024, "Number of copies around the circle."),
              grippedDirection(
                  direction("axis", {0, 1, 0},
                            "Direction of the axis through the origin; its length does not matter.")),
              neighbours()},
         .outputs = kSurface,
         .exactness = polarRepeatExactness,
         .body = std::string(kRotation) + R"(
float n = max(round(count), 1.0);
if (n == 1.0) return surface(p);
vec3 w = length(axis) > 0.0 ? normalize(axis) : vec3(0.0, 1.0, 0.0);
vec3 u = abs(w.x) < 0.9 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
u = normalize(u - w * dot(u, w));
vec3 v = cross(w, u);
float x = dot(p, u);
float y = dot(p, v);
float height = dot(p, w);
if (neighbours && n <= 4.0) {
    s = surface(p);
    for (int i = 1; i < 4; i++) {
        float c = cosOf(360.0 / n * i);
        float t = sinOf(360.0 / n * i);
        if (i < n) s = min(s, surface(w * height + u * (c * x + t * y) + v * (c * y - t * x)));
    }
    return s;
}
if (!neighbours && n == 2.0) return surface(w * height + u * abs(x) + v * (x < 0.0 ? -y : y));
float r = length(vec2(x, y));
float width = TAU / n;
float odd = mod(n, 2.0);
float turn = 0.5 * width * (neighbours ? odd : 1.0 - odd);
vec2 side = vec2(x * cos(turn) + y * sin(turn), y * cos(turn) - x * sin(turn));
float angle = turn + atan2(side.y, side.x == 0.0 && side.y == 0.0 ? 1.0 : side.x);
if (!neighbours) {
    angle = mod(angle + 0.5 * width, width) - 0.5 * width;
    return surface(w * height + u * (r * cos(angle)) + v * (r * sin(angle)));
}
angle = mod(angle, width);
vec2 q = r * vec2(cos(angle), sin(angle));
vec2 next = vec2(q.x * cos(width) + q.y * sin(width), q.y * cos(width) - q.x * sin(width));
return min(surface(w * height + u * q.x + v * q.y), surface(w * height + u * next.x + v * next.y));)",
         .lower = lowerPolarRepeat,
         .aliases = {"circular_repeat", "radial_repeat"}},
    };
}

std::vector<NodeType> deformations() {
    const auto rate = [](double value, const char* doc) {
        return InputSpec{
            .name = "rate", .type = Type::scalar, .value = numbers({value}), .unit = "degrees/m", .doc = doc};
    };
    return {
        {.id = "twist",
         .label = "Twist",
         .category = Category::domain,
         .doc = "Turns a surface about the y axis, the more the higher; keeps its volume.",
         .inputs = {subject("The surface to twist."),
                    grippedAngle(kRight, kToEye, rate(45, "Degrees of turn for each metre of height."), {},
                                 kUp)},
         .outputs = kSurface,
         .exactness = distortedBy("rate"),
         .body = R"(
float angle = radians(rate) * p.y;
float s = sin(angle);
float c = cos(angle);
return surface(vec3(c * p.x + s * p.z, p.y, c * p.z - s * p.x));)"},
        {.id = "bend",
         .label = "Bend",
         .category = Category::domain,
         .doc = "Bends a surface that lies along x, downwards at both ends.",
         .inputs = {subject("The surface to bend."),
                    grippedAngle(kRight, kDown, rate(30, "Degrees of bend for each metre along x."))},
         .outputs = kSurface,
         .exactness = distortedBy("rate"),
         .body = R"(
float angle = radians(rate) * p.x;
float s = sin(angle);
float c = cos(angle);
return surface(vec3(c * p.x - s * p.y, s * p.x + c * p.y, p.z));)"},
        // Scaling the distance back by the factor keeps the gradient from growing where the surface is
        // narrowed.
        {.id = "taper",
         .label = "Taper",
         .category = Category::domain,
         .doc = "Narrows a surface towards the top, down to a hundredth of its width.",
         .inputs = {subject("The surface to taper."),
                    measured(scalar("rate", 0.25, "Share of the width lost for each metre of height."),
                             "1/m")},
         .outputs = kSurface,
         .exactness = distortedBy("rate"),
         .body = R"(
float width = max(1.0 - rate * p.y, 0.01);
s = surface(vec3(p.x / width, p.y, p.z / width));
return with_distance(s, s.distance * min(width, 1.0));)"},
        {.id = "elongate",
         .label = "Elongate",
         .category = Category::domain,
         .doc = "Cuts a surface at the origin, pulls the parts apart and fills the gap straight.",
         .inputs = {subject("The surface to elongate, best symmetric about the origin."),
                    lengths("half_extents", {0.25, 0, 0}, "How far the parts move along x, y and z.")},
         .outputs = kSurface,
         .exactness = weakened,
         .body = R"(
s = surface(p - clamp(p, -half_extents, half_extents));
vec3 q = abs(p) - half_extents;
return with_distance(s, s.distance + min(max(q.x, q.y, q.z), 0.0));)"},
        {.id = "warp",
         .label = "Warp",
         .category = Category::domain,
         .doc = "Looks a surface up at a position of your own making.",
         .inputs = {subject("The surface to deform."), positionInput()},
         .outputs = kSurface,
         .exactness = always(distorted()),
         .body = "return surface(p);"},
    };
}

std::vector<NodeType> offsets() {
    return {
        {.id = "offset",
         .label = "Offset",
         .category = Category::domain,
         .doc = "Grows a surface outwards by a distance, rounding its outer edges.",
         .inputs = {subject("The surface to grow."),
                    coordinate("distance", 0.1, "How far to grow; negative shrinks.")},
         .outputs = kSurface,
         .exactness =
             [](const ExactnessArguments& node) { return offsetBy(node, node.constant("distance", 0)); },
         .body = "return with_distance(surface, surface.distance - distance);",
         .lower = lowerOffset,
         .aliases = {"inflate", "grow"}},
        {.id = "shell",
         .label = "Shell",
         .category = Category::domain,
         .doc = "Keeps only a wall that reaches to both sides of the surface.",
         .inputs = {subject("The surface to hollow out."),
                    length(
                        "thickness", 0.05,
                        "Half the thickness of the wall: how far it reaches to each side of the surface.")},
         .outputs = kSurface,
         .exactness =
             [](const ExactnessArguments& node) {
                 const Exactness a = node.surface("surface");
                 return Exactness{a.outside && a.inside, false, a.lipschitz};
             },
         .body = "return with_distance(surface, abs(surface.distance) - thickness);",
         .lower = lowerOffset,
         .aliases = {"onion", "hollow"}},
        {.id = "true_distance",
         .label = "True distance",
         .category = Category::domain,
         .doc = "The same solid with distances that are true, inside and out: measured on a grid, once. In "
                "front of a shell, an offset or a blend it makes them even, whatever the solid was bent by.",
         .inputs = {subject("The surface whose distances are measured."),
                    integer("resolution", 96, kLeastFieldResolution, kMostFieldResolution,
                            "Samples along the grid's longest side. What is thinner than two of its cells "
                            "gets holes."),
                    length("margin", 0,
                           "How far around the solid distances are measured. Beyond, they are bounds: right "
                           "at the grid, and then rather too small.")},
         .outputs = kSurface,
         .lower = lowerTrueDistance,
         .aliases = {"redistance", "eikonal"}},
        {.id = "round_edges",
         .label = "Round edges",
         .category = Category::domain,
         .doc = "Rounds all edges of a solid by a ball of one radius. Distances are measured on a grid, "
                "once.",
         .inputs = {subject("The solid whose edges are rounded."),
                    length("radius", 0.05, "Of the ball, some cells of the grid at least."),
                    choice("edges", {"outer", "inner", "all"},
                           "Edges that stand out, those that run inwards, or both."),
                    integer("resolution", 128, kLeastFieldResolution, kMostFieldResolution,
                            "Samples along the grid's longest side.")},
         .outputs = kSurface,
         .lower = lowerRoundEdges,
         .aliases = {"fillet", "bevel"}},
        {.id = "chamfer_edges",
         .label = "Chamfer edges",
         .category = Category::domain,
         .doc = "Cuts all edges of a solid that stand out flat, between where a ball that is rolled along "
                "them inside touches the two faces; those sharper than 45 degrees stay. Distances are "
                "measured on a "
                "grid, once.",
         .inputs = {subject("The solid whose edges are cut."),
                    length(
                        "size", 0.05,
                        "Radius of the ball, some cells of the grid at least: at right angles how far from "
                        "the edge each face ends."),
                    integer("resolution", 128, kLeastFieldResolution, kMostFieldResolution,
                            "Samples along the grid's longest side.")},
         .outputs = kSurface,
         .lower = lowerChamferEdges,
         .aliases = {"chamfer"}},
        {.id = "displace",
         .label = "Displace",
         .category = Category::domain,
         .doc = "Adds a field to the distance, to give a surface bumps and dents.",
         .inputs = {subject("The surface to displace."),
                    coordinate("amount", 0,
                               "Distance to add: positive moves the surface inwards, negative outwards.")},
         .outputs = kSurface,
         .exactness =
             [](const ExactnessArguments& node) {
                 const auto amount = node.constant("amount", 0);
                 return amount ? offsetBy(node, -*amount) : distorted();
             },
         .body = "return with_distance(surface, surface.distance + amount);"},
    };
}

}  // namespace

std::vector<NodeType> domainNodes() {
    std::vector<NodeType> all = placements();
    for (auto family : {repetitions, deformations, offsets}) {
        for (NodeType& node : family()) all.push_back(std::move(node));
    }
    return all;
}

}  // namespace fw
