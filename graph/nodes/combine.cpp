// Booleans and blends of two surfaces.
//
// With radius 0 the sharp minimum and maximum; else the corner where the two meet is filled (union) or cut
// back (intersect, subtract) over that width. The round profile is the quadratic smooth minimum, whose fill
// is radius / 4 deep where the two fields are equal; chamfer is a flat at 45 degrees for perpendicular faces;
// stairs follow the stepped blend of the hg_sdf library. Materials blend as the quadratic smooth minimum
// does.
//
// The groove takes away what is within the radius of the seam, the curve on which both distances are 0: where
// sqrt(a^2 + b^2) is less, the hg_sdf library's pipe along it. Of faces that are square to each other that is
// the distance to the seam, and the groove round; of others it is as much deeper or flatter as two slopes
// with a . b = c make it, which grow together to at most sqrt(1 + |c|).
//
// The exact profile is a ball of that radius rolled along the corner, whatever the angle of the faces. Their
// normals m, n are slopes of the two fields, by differences over a hundredth of the radius; with c = m . n
// the ball's centre, where both distances are the radius r, lies at y = s m + t n from a place whose
// distances are a and b, for m . y = r - a and n . y = r - b: s (1 - c^2) = (r - a) - c (r - b), and t
// likewise. Where s and t are positive the place is in the ball's wedge, at r - |y| from the round.
#include <cmath>

#include "graph/nodes/code.h"
#include "graph/nodes/inputs.h"

namespace fw {
namespace {

/// `sharp` says which sides stay exact without a blend, given those of the inputs.
ExactnessRule blendRule(Exactness (*sharp)(Exactness a, Exactness b)) {
    return [sharp](const ExactnessArguments& node) {
        const Exactness a = node.surface("a"), b = node.surface("b");
        const double lipschitz = std::max(a.lipschitz, b.lipschitz);
        Exactness result = sharp(a, b);
        result.lipschitz = lipschitz;
        if (node.constant("radius", 0) == 0.0) return result;
        if (node.option("profile") == "exact") return distorted();
        if (node.option("profile") == "chamfer" || node.option("profile") == "groove")
            return distorted(lipschitz * std::sqrt(2.0));
        return distorted(lipschitz);
    };
}

/// The slopes of a and b, for the exact profile.
constexpr const char* kSlopes = R"(
vec3 slopeA = vec3(0.0);
vec3 slopeB = vec3(0.0);
if (profile == "exact") {
    float h = max(0.01 * radius, 1e-9);
    slopeA = vec3(distance(a(p + vec3(h, 0.0, 0.0))), distance(a(p + vec3(0.0, h, 0.0))), distance(a(p + vec3(0.0, 0.0, h)))) - a.distance;
    slopeB = vec3(distance(b(p + vec3(h, 0.0, 0.0))), distance(b(p + vec3(0.0, h, 0.0))), distance(b(p + vec3(0.0, 0.0, h)))) - b.distance;
}
)";
/// d = the blended minimum of the two distances, each with this sign.
std::string blendedMin(const std::string& signA, const std::string& signB) {
    const std::string arguments = "(" + signA + "a.distance, " + signB + "b.distance, radius";
    return "float d;\nif (profile == \"chamfer\") d = chamferMin" + arguments +
           ");\nelse if (profile == \"stairs\") d = stairsMin" + arguments +
           ", steps);\nelse if (profile == \"exact\") d = rolledMin" + arguments + ", " + signA + "slopeA, " +
           signB + "slopeB);\nelse if (profile == \"groove\") d = min(" + signA + "a.distance, " + signB +
           "b.distance);\nelse d = smooth_min" + arguments + ");\n";
}
/// made = this distance, with the groove cut out.
std::string grooved(const std::string& distance) {
    return "float made = " + distance +
           ";\nif (profile == \"groove\") made = max(made, radius - length(vec2(a.distance, b.distance)));\n";
}

NodeType blendNode(std::string id, std::string label, std::string doc, ExactnessRule rule, std::string body,
                   std::vector<std::string> aliases) {
    return {
        .id = std::move(id),
        .label = std::move(label),
        .category = Category::combine,
        .doc = std::move(doc),
        .inputs = {surfaceInput("a", "The first surface."), surfaceInput("b", "The second surface."),
                   length("radius", 0,
                          "Width of the blend where the two meet, or the radius of an exact round or of a "
                          "groove; 0 keeps the edge sharp."),
                   choice("profile", {"round", "chamfer", "stairs", "exact", "groove"},
                          "Shape of the blend. Exact is the round of a ball of that radius, also between "
                          "faces that are not square to each other; it asks both surfaces four times. A "
                          "groove is cut along the seam, round where the faces are square to each other."),
                   integer("steps", 4, 1, 64, "Number of steps of the stairs profile.")},
        .outputs = {{"surface", Type::surface}},
        .exactness = std::move(rule),
        .body = kBlend + std::move(body),
        .aliases = std::move(aliases)};
}

/// Whose second surface only cuts, so that it is what it is, though light may pass through it.
NodeType cutting(NodeType type) {
    type.inputs[1] = asWhole(std::move(type.inputs[1]));
    return type;
}

}  // namespace

std::vector<NodeType> combineNodes() {
    return {
        blendNode("union", "Union", "Both surfaces together.", blendRule([](Exactness a, Exactness b) {
                      return Exactness{a.outside && b.outside, false, 1};
                  }),
                  std::string("if (radius <= 0.0) return min(a, b);\n") + kSlopes + blendedMin("", "") +
                      grooved("d") +
                      "return with_distance(mix(a, b, clamp(0.5 + 0.5 * (a.distance - b.distance) / "
                      "max(radius, 1e-9), 0.0, 1.0)), made);",
                  {"join"}),
        blendNode("intersect", "Intersect",
                  "What lies inside both surfaces. Light passes through it unless both are opaque.",
                  blendRule([](Exactness a, Exactness b) {
                      return Exactness{false, a.inside && b.inside, 1};
                  }),
                  std::string("if (radius <= 0.0) return max(a, b);\n") + kSlopes + blendedMin("-", "-") +
                      grooved("-d") +
                      "return with_distance(mix(a, b, clamp(0.5 + 0.5 * (b.distance - a.distance) / "
                      "max(radius, 1e-9), 0.0, 1.0)), made);",
                  {"intersection"}),
        cutting(blendNode(
            "subtract", "Subtract",
            "The first surface with the second cut out of it; the cut keeps the material of the first.",
            blendRule([](Exactness a, Exactness b) {
                return Exactness{false, a.inside && b.outside, 1};
            }),
            std::string("if (radius <= 0.0) return with_distance(a, max(a.distance, -b.distance));\n") +
                kSlopes + blendedMin("-", "") + grooved("-d") + "return with_distance(a, made);",
            {"difference", "cut"})),
        // Rounds the creases where the two meet: union blended, minus intersection blended.
        blendNode(
            "xor", "Exclusive or", "What lies inside exactly one of the two surfaces.",
            blendRule([](Exactness a, Exactness b) { return a.exact() && b.exact() ? kExact : kBound; }),
            std::string("if (radius <= 0.0) return with_distance(abs(a.distance) < abs(b.distance) ? a : b,\n"
                        "    max(min(a.distance, b.distance), min(-a.distance, -b.distance)));\n") +
                kSlopes + blendedMin("", "") + "float either = d;\n" +
                blendedMin("-", "-").substr(std::string("float d;\n").size()) + grooved("max(either, d)") +
                "float nearer = abs(a.distance) - abs(b.distance);\n"
                "return with_distance(mix(a, b, clamp(0.5 + 0.5 * nearer / max(radius, 1e-9), 0.0, 1.0)), "
                "made);",
            {"symmetric_difference"}),
        {.id = "morph",
         .label = "Morph",
         .category = Category::combine,
         .doc = "Fades from one surface to another.",
         .inputs = {surfaceInput("a", "The surface at 0."), surfaceInput("b", "The surface at 1."),
                    share("t", 0.5, "How far along the way from a to b.")},
         .outputs = {{"surface", Type::surface}},
         .exactness =
             [](const ExactnessArguments& node) {
                 const Exactness a = node.surface("a"), b = node.surface("b");
                 if (node.constant("t", 0) == 0.0) return a;
                 if (node.constant("t", 0) == 1.0) return b;
                 return distorted(std::max(a.lipschitz, b.lipschitz));
             },
         .body = "return mix(a, b, t);"},
    };
}

}  // namespace fw
