// Splines, and what is made along them.
#include "graph/compile/graph_lowering.h"
#include "graph/nodes/code.h"
#include "graph/nodes/inputs.h"

namespace fw {
namespace {

const std::vector<OutputSpec> kSpline = {{"spline", Type::spline}};

InputSpec splineInput() {
    return {.name = "spline", .type = Type::spline, .value = {}, .doc = "The curve in space."};
}

}  // namespace

std::vector<NodeType> splineNodes() {
    return {
        {.id = "spline",
         .label = "Spline",
         .category = Category::spline,
         .doc = "A curve in space through points, for tube and sweep. Its points are moved by hand in the "
                "viewport while the node is selected.",
         .inputs = {{.name = "knots",
                     .type = Type::knots,
                     .value = numbers(
                         {-0.8, 0, 0, 1, 0, -0.3, 0.5, 0.2, 1, 0, 0.3, -0.3, -0.2, 1, 0, 0.8, 0.2, 0, 1, 0}),
                     .unit = "m",
                     .doc = "The points: x, y and z; a share of the radius of what is made along it; and a "
                            "twist of that, degrees. 1 and 0 if only three numbers are given."},
                    choice("kind", {"smooth", "straight", "bezier"},
                           "Smooth goes through all points, straight makes lines between them; bezier takes "
                           "two handles between each two points that it goes through: point, handle, handle, "
                           "point and so on."),
                    known(toggle("closed", false, "Whether it comes back to its first point.")),
                    known(length(
                        "bend", 0,
                        "Radius of the rounded corners of a straight one, less where its lines are too "
                        "short."))},
         .outputs = kSpline,
         .body = "return spline_through(knots, kind, closed, bend);",
         .aliases = {"curve_3d", "path", "polyline", "bezier"}},
        {.id = "helix",
         .label = "Helix",
         .category = Category::spline,
         .doc = "A curve that winds about the y axis, for tube and sweep; a spiral if it has no height.",
         .inputs = {known(gripped(kRight, length("radius", 0.5, "From the axis, at the bottom."))),
                    known(length("top_radius", 0.5, "From the axis, at the top.")),
                    known(gripped(kUp, coordinate("height", 1, "From the beginning to the end, along y."))),
                    known({.name = "turns",
                           .type = Type::scalar,
                           .value = numbers({3}),
                           .min = 0,
                           .max = 200,
                           .doc = "How often it goes round; also a part of a turn."}),
                    known(toggle("left", false, "Left-handed; a common screw is not."))},
         .outputs = kSpline,
         .body = "return spline_of_helix(radius, top_radius, height, turns, left);",
         .aliases = {"spiral"}},
        {.id = "drawing_spline",
         .label = "Spline of a Drawing",
         .category = Category::spline,
         .doc = "A path of an SVG or DXF file as a curve in the xy plane, for tube and sweep.",
         .inputs = {optionalFile("path", kDrawingFile,
                                 "The drawing's path, from the folder of the graph's file."),
                    textInput("part", "",
                              "An id or label of an SVG file, or a layer of a DXF file; all if empty."),
                    known(integer("number", 1, 1, 100000,
                                  "Which of its paths, in the order in which they are drawn.")),
                    known(length(
                        "size", 1,
                        "The longer side of the page, whose centre is the origin; 0: as the file has it.")),
                    known(toggle("reversed", false, "From its end to its beginning."))},
         .outputs = kSpline,
         .body = "return spline_of_drawing(path, part, number, size, reversed);",
         .aliases = {"svg_path"}},
        {.id = "tube",
         .label = "Tube",
         .category = Category::spline,
         .doc = "A round solid along a spline: all that a ball covers which runs along it.",
         .inputs = {positionInput(), splineInput(),
                    length("radius", 0.1, "Of the ball, times the share at each point of the spline."),
                    choice("ends", {"round", "flat"}, "What an open spline's ends are.")},
         .outputs = kSurface,
         .exactness =
             [](const ExactnessArguments& node) {
                 return node.option("ends") == "round" ? kExactOutside : distorted();
             },
         .body = std::string(kExtent) + R"(
float d = spline_distance(p, spline, radius);
if (ends == "round" || spline_closed(spline)) return d;
vec3 at = spline_place(p, spline);
float side = length(at.xy) - radius * spline_radius(p, spline);
return max(d, ext2(vec2(side, max(-at.z, at.z - spline_length(spline)))));)",
         .aliases = {"pipe"}},
        {.id = "sweep",
         .label = "Sweep",
         .category = Category::spline,
         .doc = "Moves a flat shape along a spline, upright and without a twist of its own. A solid is laid "
                "along it with its z axis, from z = 0 on: what is bent so is text, a chain, a whole model.",
         .inputs = {positionInput(), surfaceInput("surface", "The flat shape, or a solid that lies along z."),
                    splineInput(),
                    toggle("scaled", true, "Whether the points' radii are shares of its size."),
                    toggle("capped", true,
                           "Whether it ends where the spline does; else what lies beyond goes straight on.")},
         .outputs = kSurface,
         .exactness = always(distorted()),
         .body = std::string(kExtent) + R"(
vec3 at = spline_place(p, spline);
float share = scaled ? max(spline_radius(p, spline), 0.001) : 1.0;
swept = surface(vec3(at.xy / share, at.z));
float d = swept.distance * share;
bool ends = capped && !spline_closed(spline);
return with_distance(swept, ends ? ext2(vec2(d, max(-at.z, at.z - spline_length(spline)))) : d);)",
         .lower = lowerSweep,
         .aliases = {"follow_path", "bend_along"}},
        // A mean is never below the smaller one: that changes no value, but tells a search for bounds that
        // the solid lies within both shapes together.
        {.id = "loft",
         .label = "Loft",
         .category = Category::spline,
         .doc = "A solid that is one flat shape at its bottom and another one at its top, along z.",
         .inputs = {positionInput(), surfaceInput("bottom", "The flat shape at z = 0."),
                    surfaceInput("top", "The flat shape at z = height."),
                    gripped(kToEye, positiveLength("height", 1, "Along z.")),
                    choice(
                        "between", {"linear", "smooth"},
                        "Linear changes evenly from the one to the other, smooth begins and ends slowly.")},
         .outputs = kSurface,
         .exactness = always(distorted()),
         .body = std::string(kExtent) + R"(
float t = saturate(p.z / height);
if (between == "smooth") t = t * t * (3.0 - 2.0 * t);
low = bottom(vec3(p.xy, 0.0));
high = top(vec3(p.xy, 0.0));
blend = mix(low, high, t);
float d = max(blend.distance, min(low.distance, high.distance));
return with_distance(blend, ext2(vec2(d, max(-p.z, p.z - height))));)"},
    };
}

}  // namespace fw
