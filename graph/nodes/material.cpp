// What a surface looks like.
#include "graph/nodes/inputs.h"

namespace fw {

std::vector<NodeType> materialNodes() {
    return {
        {.id = "material",
         .label = "Material",
         .category = Category::material,
         .doc = "Gives a surface its colour and finish.",
         .inputs = {asWhole(surfaceInput("surface", "The surface to paint.")),
                    color("base_color", {0.8, 0.8, 0.8}, "Colour of the surface."),
                    share("roughness", 0.5, "0 is a mirror, 1 is chalk."),
                    share("metallic", 0, "0 is plastic, stone or wood; 1 is metal."),
                    color("emission", {0, 0, 0}, "Light that the surface gives off by itself."),
                    share("transmission", 0,
                          "How much light goes through: 0 is opaque, 1 is water or glass. Then the base "
                          "colour tints what enters: white for clear glass."),
                    {.name = "ior",
                     .type = Type::scalar,
                     .value = numbers({1.5}),
                     .min = 0.1,
                     .max = 10,
                     .doc = "Index of refraction, by which light bends: water 1.33, glass 1.5, diamond 2.4."},
                    {.name = "absorption",
                     .type = Type::vec3,
                     .value = numbers({0, 0, 0}),
                     .min = 0,
                     .unit = "1/m",
                     .doc =
                         "What is lost of red, green and blue within: exp(-absorption * length) remains."}},
         .outputs = {{"surface", Type::surface}},
         .exactness = sameAs("surface"),
         .body = "return with_material(surface, base_color, roughness, metallic, emission, transmission, "
                 "ior, absorption);"},
        // Each of the three pictures stands upright and unmirrored for who looks at its side from outside;
        // from above -z is up, from below z is. The normal comes from four samples on the corners of a
        // tetrahedron. They lie a two hundredth of the scale away, so that at a sharp edge the pictures meet
        // over that width.
        {.id = "triplanar",
         .label = "Triplanar",
         .category = Category::material,
         .doc = "Paints a picture onto a solid from its six sides, blended where the surface is oblique.",
         .inputs = {positionInput(),
                    picture("image"),
                    positiveLength("scale", 1, "Width of the picture on the surface; it repeats beyond."),
                    {.name = "blend",
                     .type = Type::scalar,
                     .value = numbers({4}),
                     .min = 1,
                     .max = 64,
                     .doc = "How sharply one side gives way to the next: 1 is soft, 16 nearly an edge."},
                    surfaceInput("surface",
                                 "The solid that is painted; its slope says which side a place is on. "
                                 "Without it all sides count alike.")},
         .outputs = {{"color", Type::vec3}},
         .body = R"(
float e = 0.005 * scale;
vec3 n = vec3(1.0, -1.0, -1.0) * distance(surface(p + vec3(e, -e, -e)))
       + vec3(-1.0, -1.0, 1.0) * distance(surface(p + vec3(-e, -e, e)))
       + vec3(-1.0, 1.0, -1.0) * distance(surface(p + vec3(-e, e, -e)))
       + vec3(1.0, 1.0, 1.0) * distance(surface(p + vec3(e, e, e)));
float steep = max(abs(n.x), abs(n.y), abs(n.z));
vec3 w = vec3(1.0);
if (steep > 0.0) w = pow(abs(n) / max(steep, 1e-20), blend);
w /= w.x + w.y + w.z;
vec2 texels = image_size(image);
vec2 s = vec2(1.0, texels.x / texels.y) / scale;
vec3 q = vec3(n.x < 0.0 ? -1.0 : 1.0, n.y < 0.0 ? -1.0 : 1.0, n.z < 0.0 ? -1.0 : 1.0);
return w.x * image_color(image, vec2(-q.x * p.z, p.y) * s)
     + w.y * image_color(image, vec2(p.x, -q.y * p.z) * s)
     + w.z * image_color(image, vec2(q.z * p.x, p.y) * s);)",
         .aliases = {"texture", "image_texture"}},
    };
}

}  // namespace fw
