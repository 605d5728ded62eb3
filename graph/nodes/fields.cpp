// Sources of values that may vary over space and time, and the bridges between numbers and surfaces.
#include "graph/nodes/inputs.h"

namespace fw {

std::vector<NodeType> fieldNodes() {
    return {
        {.id = "position",
         .label = "Position",
         .category = Category::field,
         .doc = "The place at which the graph is being evaluated.",
         .inputs = {},
         .outputs = {{"position", Type::vec3}},
         .body = "return p;"},
        {.id = "time",
         .label = "Time",
         .category = Category::field,
         .doc = "The time of the animation.",
         .inputs = {},
         .outputs = {{"seconds", Type::scalar}},
         .body = "return time;"},
        {.id = "value",
         .label = "Value",
         .category = Category::field,
         .doc = "A number to share between several nodes.",
         .inputs = {anything(scalar("value", 0, "The number."))},
         .outputs = {{"value", Type::scalar}},
         .body = "return value;"},
        {.id = "vector",
         .label = "Vector",
         .category = Category::field,
         .doc = "A point or direction to share between several nodes.",
         .inputs = {anything(vector("value", {0, 0, 0}, "The components x, y and z."))},
         .outputs = {{"vector", Type::vec3}},
         .body = "return value;"},
        {.id = "color",
         .label = "Colour",
         .category = Category::field,
         .doc = "A colour to share between several nodes.",
         .inputs = {color("value", {0.8, 0.8, 0.8}, "The colour.")},
         .outputs = {{"color", Type::vec3}},
         .body = "return value;",
         .aliases = {"colour"}},
        {.id = "parameter",
         .label = "Parameter",
         .category = Category::field,
         .doc = "A number with a name and a range, for whoever plays the graph to change.",
         .inputs = {textInput("name", "parameter", "What the player calls it."),
                    anything(scalar("value", 0.5, "The number.")),
                    anything(scalar("min", 0, "Smallest value; smaller ones are raised to it.")),
                    anything(scalar("max", 1, "Largest value; larger ones are lowered to it."))},
         .outputs = {{"value", Type::scalar}},
         .body = "return clamp(value, min, max);",
         .role = NodeRole::parameter},
        // Octaves double the frequency and halve the size; their sum is divided by the sum of sizes, so that
        // the range does not depend on how many there are. Each octave and each component of the vector has a
        // seed of its own.
        {.id = "noise",
         .label = "Noise",
         .category = Category::field,
         .doc = "Random values that change smoothly from place to place, for bumps, clouds and landscapes.",
         .inputs = {positionInput(),
                    choice("kind", {"perlin", "simplex", "worley"},
                           "Perlin and simplex are soft bumps between about -1 and 1; worley is the distance "
                           "to the nearest of "
                           "scattered points."),
                    {.name = "scale",
                     .type = Type::scalar,
                     .value = numbers({2}),
                     .min = 0,
                     .unit = "1/m",
                     .doc = "Number of bumps in a metre."},
                    integer("octaves", 1, 1, 16,
                            "Layers of ever finer detail, each half as strong as the one before."),
                    integer("seed", 0, 0, 1000000, "Another number gives another pattern.")},
         .outputs = {{"value", Type::scalar}, {"vector", Type::vec3}},
         .body = R"(
vec3 q = p * scale;
vec3 sum = vec3(0.0);
float size = 1.0;
float total = 0.0;
for (int i = 0; i < octaves; i++) {
    float s = seed + 17.0 * i;
    if (kind == "perlin") sum += size * vec3(perlin(q, s), perlin(q, s + 1009.0), perlin(q, s + 2003.0));
    else if (kind == "simplex") sum += size * vec3(simplex(q, s), simplex(q, s + 1009.0), simplex(q, s + 2003.0));
    else sum += size * vec3(worley(q, s), worley(q, s + 1009.0), worley(q, s + 2003.0));
    total += size;
    size *= 0.5;
    q *= 2.0;
}
sum /= total;
value = sum.x;
vector = sum;)"},
        {.id = "hash",
         .label = "Hash",
         .category = Category::field,
         .doc = "A random number between 0 and 1 for each unit cube of space, the same everywhere inside the "
                "cube.",
         .inputs = {positionInput(), integer("seed", 0, 0, 1000000, "Another number gives another pattern.")},
         .outputs = {{"value", Type::scalar}, {"vector", Type::vec3}},
         .body = "value = hash(p, seed);\nvector = hash3(p, seed);"},
        {.id = "distance",
         .label = "Distance",
         .category = Category::field,
         .doc = "How far a place is from a surface: positive outside, negative inside.",
         .inputs = {surfaceInput("surface", "The surface to measure from.")},
         .outputs = {{"value", Type::scalar}},
         .body = "return surface.distance;"},
        {.id = "from_distance",
         .label = "From distance",
         .category = Category::field,
         .doc = "A surface wherever a number changes from positive (outside) to negative (inside).",
         .inputs = {coordinate("value", 1, "The number, best about the distance to the surface.")},
         .outputs = {{"surface", Type::surface}},
         .exactness = always(distorted()),
         .body = "return value;"},
        {.id = "layers",
         .label = "Layers along a surface",
         .category = Category::field,
         .doc = "The position with the distance from a surface as one of its coordinates: wired to a "
                "lattice's position, the lattice follows the surface.",
         .inputs = {surfaceInput("surface", "What the layers follow."),
                    choice("axis", {"y", "x", "z"}, "Which coordinate becomes the distance.")},
         .outputs = {{"place", Type::vec3}},
         .body = R"(
float d = surface.distance;
return axis == "y" ? vec3(p.x, d, p.z) : axis == "x" ? vec3(d, p.y, p.z) : vec3(p.x, p.y, d);)",
         .aliases = {"conformal"}},
    };
}

}  // namespace fw
