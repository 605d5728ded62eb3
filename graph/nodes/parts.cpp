// Parts of machines: what turns in each other, and what is screwed together.
#include "graph/nodes/inputs.h"

namespace fw {
namespace {

// Metric coarse threads, ISO 261: nominal diameter and pitch, millimetres.
constexpr std::string_view kThreads = R"(
vec2 coarse = size == "M3" ? vec2(3.0, 0.5) : size == "M4" ? vec2(4.0, 0.7) : size == "M5" ? vec2(5.0, 0.8)
    : size == "M6" ? vec2(6.0, 1.0) : size == "M8" ? vec2(8.0, 1.25) : size == "M10" ? vec2(10.0, 1.5)
    : size == "M12" ? vec2(12.0, 1.75) : size == "M14" ? vec2(14.0, 2.0) : size == "M16" ? vec2(16.0, 2.0)
    : size == "M18" ? vec2(18.0, 2.5) : size == "M20" ? vec2(20.0, 2.5) : size == "M22" ? vec2(22.0, 2.5)
    : size == "M24" ? vec2(24.0, 3.0) : size == "M27" ? vec2(27.0, 3.0) : size == "M30" ? vec2(30.0, 3.5)
    : size == "M33" ? vec2(33.0, 3.5) : size == "M36" ? vec2(36.0, 4.0) : size == "M39" ? vec2(39.0, 4.0)
    : size == "M42" ? vec2(42.0, 4.5) : size == "M45" ? vec2(45.0, 4.5) : size == "M48" ? vec2(48.0, 5.0)
    : size == "M52" ? vec2(52.0, 5.0) : size == "M56" ? vec2(56.0, 5.5) : size == "M60" ? vec2(60.0, 5.5)
    : vec2(64.0, 6.0);
vec2 own = vec2(diameter, pitch);
vec2 made = size == "own" ? own : coarse * (0.001 * metre());
float outer = 0.5 * made.x;
float rise = made.y;)";

}  // namespace

std::vector<NodeType> partNodes() {
    return {
        {.id = "gear",
         .label = "Gear",
         .category = Category::shape2d,
         .doc = "A spur gear with involute teeth in the xy plane, a tooth on the x axis. Two of one module "
                "and pressure angle "
                "turn in each other at half the sum of their teeth times the module apart.",
         .inputs = {positionInput(),
                    known(positiveLength("module", 0.1, "Pitch diameter divided by the number of teeth.")),
                    integer("teeth", 20, 3, 400, "Number of teeth; few are undercut, as a rack would."),
                    known(angle("pressure_angle", 20, 10, 35,
                                "Between the flanks and the radius at the pitch circle.")),
                    known(length("backlash", 0,
                                 "How much thinner each tooth is along the pitch circle, for play."))},
         .outputs = kSurface,
         .exactness = always(kExact),
         .body = "return gear_outline(p.xy, module, teeth, pressure_angle, backlash);",
         .aliases = {"cogwheel"}},
        // The profile is that of ISO 68: flanks of 60 degrees, crests cut off by an eighth of their triangle,
        // roots by a quarter. It is looked up at the height that the turn about the axis leaves, folded into
        // one pitch; that steepens it a little, which the factor takes back. The slope of a turn grows
        // towards the axis without limit. The flank is therefore clamped at the core: inside the core
        // r - root is the minimum, and the factor is that of the core's radius.
        {.id = "thread",
         .label = "Thread",
         .category = Category::shape,
         .doc = "A metric thread about the y axis, right-handed: the bolt, or what is cut out for the nut.",
         .inputs =
             {positionInput(),
              choice("size", {"M8",  "M3",  "M4",  "M5",  "M6",  "M10", "M12", "M14", "M16",
                              "M18", "M20", "M22", "M24", "M27", "M30", "M33", "M36", "M39",
                              "M42", "M45", "M48", "M52", "M56", "M60", "M64", "own"},
                     "The standard's coarse thread of this diameter in millimetres, whatever the document's "
                     "unit; or the two below."),
              positiveLength("height", 0.02, "From end to end."),
              choice("kind", {"bolt", "nut"}, "A bolt, whose ends are chamfered; or what a nut has cut out."),
              length("fit", 0, "By how much all of it is smaller, of a bolt, or larger, of what is cut out."),
              positiveLength("diameter", 0.5, "Over the crests, of an own thread."),
              positiveLength("pitch", 0.1, "From turn to turn, of an own thread."),
              integer("starts", 1, 1, 8, "Number of threads side by side, for a cap that closes fast.")},
         .outputs = kSurface,
         .exactness = always(kBound),
         .body = std::string(kThreads) + R"(
float root = max(outer - 0.5412659 * rise, 0.1 * outer);
float r = length(p.xz);
float turned = atan2(p.x, p.z == 0.0 && p.x == 0.0 ? 1.0 : p.z) / TAU;
float lead = rise * starts;
float u = p.y - lead * turned;
u = abs(u - rise * round(u / rise));
float flank = 0.5 * (r - outer) + 0.8660254 * (u - 0.0625 * rise);
float core = max(root - 0.325 * rise, 0.75 * root);
float steep = lead / (TAU * core);
float d = min(r - root, max(r - outer, flank, core - root)) / sqrt(1.0 + 0.75 * steep * steep);
d = kind == "bolt" ? d + fit : d - fit;
float end = abs(p.y) - 0.5 * height;
if (kind == "bolt") d = max(d, (r - root + end) * 0.7071068);
return max(d, end);)",
         .aliases = {"screw"}},
        {.id = "spring",
         .label = "Spring",
         .category = Category::shape,
         .doc = "A wire wound into a helix about the y axis, right-handed, with round ends.",
         .inputs = {positionInput(),
                    positiveLength("radius", 0.5, "From the axis to the middle of the wire."),
                    positiveLength("pitch", 0.25, "From turn to turn."),
                    {.name = "turns",
                     .type = Type::scalar,
                     .value = numbers({4}),
                     .min = 0,
                     .max = 1000,
                     .doc = "How often it goes round; also a part of a turn."},
                    length("wire", 0.06, "Radius of the wire.")},
         .outputs = kSurface,
         .exactness = always(distorted()),
         .body = R"(
float half = 0.5 * turns;
float r = length(p.xz);
float turned = atan2(p.x, p.z == 0.0 && p.x == 0.0 ? 1.0 : p.z) / TAU;
float least = ceil(-half - turned);
float most = floor(half - turned);
float n = clamp(round(p.y / pitch - turned), least, max(least, most));
float slope = pitch / (TAU * radius);
float along = (p.y - pitch * (turned + n)) / sqrt(1.0 + slope * slope);
float coil = length(vec2(r - radius, along));
vec3 tip = vec3(radius * sin(half * TAU), half * pitch, radius * cos(half * TAU));
float ends = min(length(p - tip), length(p - vec3(-tip.x, -tip.y, tip.z)));
return (least <= most ? min(coil, ends) : ends) - wire;)",
         .aliases = {"coil"}},
    };
}

}  // namespace fw
