// Flat shapes, endless along z, and the two nodes that make solids of them.
#include "graph/nodes/code.h"
#include "graph/nodes/inputs.h"

namespace fw {
namespace {

/// Extruding keeps the class of a flat shape. The slice of a solid is a bound: what is nearest may lie off
/// the plane. Rounding shrinks the profile first, which is exact on smooth rims only.
Exactness extrudedExactness(const ExactnessArguments& node) {
    const Exactness profile = node.surface("surface");
    if (node.constant("rounding", 0) == 0.0 && !node.varies("surface", 2)) return profile;
    return {false, false, std::max(profile.lipschitz, 1.0)};
}

/// Nothing is known here of a profile that crosses the axis: the part beyond it is not in the solid but in
/// its field.
Exactness revolvedExactness(const ExactnessArguments& node) {
    return {false, false, std::max(node.surface("surface").lipschitz, 1.0)};
}

/// A drawing's file, which of it, and how large it is to be.
std::vector<InputSpec> drawingInputs(const FileKind& kind, const std::string& part) {
    return {
        positionInput(),
        optionalFile("path", kind,
                     "The drawing's path, from the folder of the graph's file; a washer if there is none."),
        textInput("part", "", part),
        length("size", 1, "The longer side of the page, whose centre is the origin; 0: as the file has it.")};
}
constexpr std::string_view kDrawing = R"(
float unit = size > 0.0 ? size : drawing_scale(path, part);
return drawing(p.xy / unit, path, part) * unit;)";

}  // namespace

std::vector<NodeType> shape2dNodes() {
    return {
        {.id = "circle",
         .label = "Circle",
         .category = Category::shape2d,
         .doc = "A disc in the xy plane, centred at the origin.",
         .inputs = {positionInput(),
                    gripped(kRight, length("radius", 0.5, "Distance from the centre to the rim."))},
         .outputs = kSurface,
         .exactness = always(kExact),
         .body = "return length(p.xy) - radius;"},
        {.id = "rectangle",
         .label = "Rectangle",
         .category = Category::shape2d,
         .doc = "A rectangle in the xy plane, centred at the origin.",
         .inputs = {positionInput(), gripped(kEach, {.name = "half_extents",
                                                     .type = Type::vec2,
                                                     .value = numbers({0.5, 0.5}),
                                                     .min = 0,
                                                     .unit = "m",
                                                     .doc = "Half the size along x and y."})},
         .outputs = kSurface,
         .exactness = always(kExact),
         .body = std::string(kExtent) + "return ext2(abs(p.xy) - half_extents);"},
        // Few corners are quicker in the code than from a table.
        //
        // Sign by counting the edges that a ray to the right crosses; the nearest edge gives the magnitude,
        // as a signed distance to its line where the foot lies inside the edge, so that the gradient is right
        // on the outline too: with normals that point to +x (or +y), a place on an edge counts to the same
        // side for the line and for the ray. The distance to the bounding rectangle is never above that to
        // the polygon; it changes no value but settles the sign of boxes outside it, which may straddle a
        // corner's height.
        {.id = "polygon",
         .label = "Polygon",
         .category = Category::shape2d,
         .doc = "A closed outline in the xy plane through a list of points, drawn in order.",
         .inputs = {positionInput(),
                    {.name = "points",
                     .type = Type::points,
                     .value = numbers({-0.5, -0.5, 0.5, -0.5, 0.5, 0.2, 0, 0.6, -0.5, 0.2}),
                     .unit = "m",
                     .doc = "Corners of the outline, x and y each; the last is joined to the first."}},
         .outputs = kSurface,
         .exactness = always(kExact),
         .body = R"(
int n = count(points);
if (n == 0) return empty();
vec2 lo = points[0];
vec2 hi = points[0];
for (int i = 1; i < n; i++) {
    lo = min(lo, points[i]);
    hi = max(hi, points[i]);
}
vec2 bounds = max(lo - p.xy, p.xy - hi);
if (n > 16) return max(outline(p.xy, points), bounds.x, bounds.y);
float near = 1e18;
float line = 1e9;
bool onEdge = false;
bool inside = false;
for (int i = 0; i < n; i++) {
    vec2 a = points[i];
    vec2 b = points[i + 1 < n ? i + 1 : 0];
    vec2 along = b - a;
    vec2 q = p.xy - a;
    float foot = dot(q, along);
    float size = dot(along, along);
    vec2 off = q - along * clamp(foot / max(size, 1e-12), 0.0, 1.0);
    bool closer = dot(off, off) < near;
    near = min(near, dot(off, off));
    if (size > 0.0) {
        vec2 right = normalize(vec2(along.y, -along.x)) * (along.y > 0.0 || (along.y == 0.0 && along.x < 0.0) ? 1.0 : -1.0);
        line = closer ? dot(q, right) : line;
        onEdge = closer ? foot >= 0.0 && foot <= size : onEdge;
        bool crossing = min(a.y, b.y) <= p.y && p.y < max(a.y, b.y) && dot(q, right) < 0.0;
        inside = crossing ? !inside : inside;
    } else {
        onEdge = closer ? false : onEdge;
    }
}
float d = sqrt(near);
float wanted = inside ? -1.0 : 1.0;
float found = line < 0.0 ? -1.0 : 1.0;
return max(onEdge ? line * (wanted * found) : wanted * d, bounds.x, bounds.y);)"},
        {.id = "regular_polygon",
         .label = "Regular polygon",
         .category = Category::shape2d,
         .doc = "A polygon of equal sides in the xy plane, standing on one of them.",
         .inputs = {positionInput(), integer("sides", 6, 3, 128, "Number of sides."),
                    gripped(kDown,
                            length("apothem", 0.5, "Distance from the centre to the middle of each side."))},
         .outputs = kSurface,
         .exactness = always(kExact),
         .body = std::string(kSector) + "return regularPolygon(p.xy, sides, apothem);"},
        // The last maximum changes no value; it tells a search for bounds that the star ends.
        {.id = "star",
         .label = "Star",
         .category = Category::shape2d,
         .doc = "A star in the xy plane with one tip pointing up.",
         .inputs = {positionInput(), integer("points", 5, 2, 128, "Number of tips."),
                    gripped(kUp, length("outer_radius", 0.6, "Distance from the centre to the tips.")),
                    length("inner_radius", 0.3, "Distance from the centre to the notches between the tips.")},
         .outputs = kSurface,
         .exactness = always(kExact),
         .body = std::string(kSegment) + kSector + R"(
vec2 q = sector(p.xy, points);
vec2 tip = vec2(0.0, outer_radius);
vec2 notch = inner_radius * vec2(sin(PI / points), cos(PI / points));
vec2 along = notch - tip;
float size = length(along);
float foot = dot(q - tip, along);
float line = (along.y * q.x - along.x * (q.y - outer_radius)) / max(size, 1e-12);
float d = segment(q, tip, notch);
float star = 0.0 < size && foot >= 0.0 && foot <= size * size ? -line : (line > 0.0 ? -d : d);
return max(star, length(p.xy) - max(outer_radius, inner_radius));)"},
        {.id = "text",
         .label = "Text",
         .category = Category::shape2d,
         .doc = "Letters in the xy plane: any script that the font has, in one line or several.",
         .inputs =
             {positionInput(),
              linesInput("string", "Text", "What is written, with a line break between lines."),
              textInput("font", "DejaVu Sans",
                        "A font family of this machine, with a style behind a colon: DejaVu Serif:bold."),
              optionalFile("font_file", kFontFile,
                           "A font's path, from the folder of the graph's file, in place of a family."),
              positiveLength("size", 0.5,
                             "Height of an em: from the foot of one line to that of the next, about."),
              choice("align", {"center", "left", "right"}, "Where the lines lie about x = 0."),
              choice("anchor", {"middle", "baseline", "top", "bottom"},
                     "What lies at y = 0: the middle of the text, the foot of the first line, the top of its "
                     "capitals, or the "
                     "foot of the last line."),
              known(scalar("letter_spacing", 0, "Further space behind each letter, in parts of the size.")),
              known({.name = "line_spacing",
                     .type = Type::scalar,
                     .value = numbers({1}),
                     .min = 0,
                     .doc = "From line to line, in parts of what the font wants."}),
              toggle("kerning", true, "Whether pairs of letters are brought together as the font wants.")},
         .outputs = kSurface,
         .exactness = always(kExact),
         .body = "return letters(p.xy / size, string, font, font_file, align, anchor, letter_spacing, "
                 "line_spacing, "
                 "float(kerning)) * size;",
         .aliases = {"lettering"}},
        {.id = "svg_file",
         .label = "SVG file",
         .category = Category::shape2d,
         .doc = "What an SVG drawing paints, fills and strokes, as one flat shape.",
         .inputs = drawingInputs(
             kSvgFile, "The id or label of a layer, a group or a path, to take it alone; empty: all."),
         .outputs = kSurface,
         .exactness = always(kExact),
         .body = std::string(kDrawing),
         .aliases = {"svg"}},
        {.id = "dxf_file",
         .label = "DXF file",
         .category = Category::shape2d,
         .doc = "The closed outlines of a DXF drawing as one flat shape; outlines within others are holes.",
         .inputs = drawingInputs(kDxfFile, "A layer, to take it alone; empty: all."),
         .outputs = kSurface,
         .exactness = always(kExact),
         .body = std::string(kDrawing),
         .aliases = {"dxf"}},
        {.id = "extrude",
         .label = "Extrude",
         .category = Category::shape2d,
         .doc = "Gives a flat shape thickness along z; of a solid it takes the slice at z = 0, whose "
                "distance is a "
                "bound.",
         .inputs = {surfaceInput("surface", "The flat shape."),
                    gripped(kToEye, length("half_height", 0.5, "Half the thickness along z.")),
                    length("rounding", 0,
                           "Radius of the rounded edges, within the given size; what fits is used.")},
         .outputs = kSurface,
         .exactness = extrudedExactness,
         .body = std::string(kExtent) + R"(
profile = surface(vec3(p.xy, 0.0));
float r = min(rounding, half_height);
return with_distance(profile, ext2(vec2(profile.distance + r, abs(p.z) - (half_height - r))) - r);)"},
        {.id = "revolve",
         .label = "Revolve",
         .category = Category::shape2d,
         .doc = "Turns a flat shape around the y axis, as on a lathe.",
         .inputs = {surfaceInput("surface", "The flat shape; what lies right of the axis is used."),
                    gripped(kRight,
                            coordinate("offset", 0, "How far the shape is moved away from the axis first.")),
                    angle("angle", 360, 0, 360, "How far it goes round, half of it to each side of +x.")},
         .outputs = kSurface,
         .exactness = revolvedExactness,
         .body = R"(
turned = surface(vec3(length(p.xz) - offset, p.y, 0.0));
if (angle >= 360.0) return turned;
float half = radians(0.5 * angle);
return with_distance(turned, max(turned.distance, abs(p.z) * cos(half) - p.x * sin(half)));)",
         .aliases = {"lathe"}},
    };
}

}  // namespace fw
