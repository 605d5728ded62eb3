// Invariants of the node table that need no compiler, and its look-ups.
#include "graph/library/node_type.h"
#include "graph/base/words.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <set>

namespace fw::node_type_test {

bool isName(const std::string& name) {
    return !name.empty() && std::islower(static_cast<unsigned char>(name[0])) &&
           std::ranges::all_of(
               name, [](unsigned char c) { return std::islower(c) || std::isdigit(c) || c == '_'; });
}

bool isSentence(const std::string& text) {
    return text.size() > 5 && !std::islower(static_cast<unsigned char>(text[0])) && text.back() == '.';
}

/// The names that files, tutorials and other programs rely on: id -> inputs, beside `p`.
const std::map<std::string, std::vector<std::string>>& promised() {
    static const std::vector<std::string> blend = {"a", "b", "radius", "profile", "steps"};
    static const std::map<std::string, std::vector<std::string>> names = {
        {"sphere", {"p", "radius"}},
        {"box", {"p", "half_extents", "rounding"}},
        {"box_max", {"p", "half_extents"}},
        {"box_frame", {"p", "half_extents", "thickness"}},
        {"plane", {"p", "normal", "offset"}},
        {"slab", {"p", "half_thickness"}},
        {"cylinder", {"p", "radius", "half_height", "rounding"}},
        {"infinite_cylinder", {"p", "radius"}},
        {"capsule", {"p", "a", "b", "radius"}},
        {"torus", {"p", "major_radius", "minor_radius"}},
        {"capped_torus", {"p"}},
        {"link", {"p", "half_length", "major_radius", "minor_radius"}},
        {"cone", {"p", "radius", "height"}},
        {"capped_cone", {"p", "half_height", "radius_bottom", "radius_top"}},
        {"round_cone", {"p", "radius_bottom", "radius_top", "height"}},
        {"ellipsoid", {"p", "radii"}},
        {"octahedron", {"p", "size"}},
        {"pyramid", {"p", "half_side", "height"}},
        {"prism", {"p", "sides", "apothem", "half_height"}},
        {"tetrahedron", {"p", "size"}},
        {"dodecahedron", {"p", "size"}},
        {"icosahedron", {"p", "size"}},
        {"cut_sphere", {"p", "radius", "height"}},
        {"solid_angle", {"p"}},
        {"vesica", {"p"}},
        {"gyroid", {"p", "period", "thickness"}},
        {"schwarz_p", {"p", "period", "thickness"}},
        {"diamond", {"p", "period", "thickness"}},
        {"circle", {"p", "radius"}},
        {"rectangle", {"p", "half_extents"}},
        {"polygon", {"p", "points"}},
        {"regular_polygon", {"p", "sides", "apothem"}},
        {"star", {"p", "points", "outer_radius", "inner_radius"}},
        {"extrude", {"surface", "half_height", "rounding"}},
        {"revolve", {"surface", "offset"}},
        {"union", blend},
        {"intersect", blend},
        {"subtract", blend},
        {"xor", blend},
        {"morph", {"a", "b", "t"}},
        {"translate", {"surface", "offset"}},
        {"rotate", {"surface", "angles"}},
        {"scale", {"surface", "factor"}},
        {"stretch", {"surface", "factors"}},
        {"transform", {"surface", "translation", "rotation", "scale"}},
        {"mirror", {"surface", "normal", "offset"}},
        {"repeat", {"surface", "period", "count"}},
        {"scatter", {"surface", "period", "jitter"}},
        {"polar_repeat", {"surface", "count", "axis"}},
        {"twist", {"surface", "rate"}},
        {"bend", {"surface", "rate"}},
        {"taper", {"surface", "rate"}},
        {"elongate", {"surface", "half_extents"}},
        {"offset", {"surface", "distance"}},
        {"shell", {"surface", "thickness"}},
        {"displace", {"surface", "amount"}},
        {"warp", {"surface", "p"}},
        {"position", {}},
        {"time", {}},
        {"value", {"value"}},
        {"vector", {"value"}},
        {"color", {"value"}},
        {"parameter", {"name", "value", "min", "max"}},
        {"math", {"op", "a", "b", "c"}},
        {"vector_math", {"op", "a", "b", "scale"}},
        {"combine_xyz", {"x", "y", "z"}},
        {"separate_xyz", {"vector"}},
        {"map_range", {}},
        {"mix", {"a", "b", "factor"}},
        {"noise", {"p", "kind", "scale", "octaves", "seed"}},
        {"hash", {"p", "seed"}},
        {"distance", {"surface"}},
        {"from_distance", {"value"}},
        {"expression", {}},
        {"material", {"surface", "base_color", "roughness", "metallic", "emission"}},
        {"polygonize", {"surface", "region_min", "region_max", "resolution", "method"}},
        {"smooth", {"mesh", "iterations"}},
        {"subdivide", {"mesh", "levels", "project"}},
        {"decimate", {"mesh", "error", "triangles"}},
        {"output", {"surface", "mesh", "resolution", "method"}},
        {"reroute", {}},
        {"frame", {}},
        {"group", {}},
        {"group_input", {}},
        {"group_output", {}},
    };
    return names;
}

TEST(NodeTable, HoldsEveryPromisedNameInItsOrder) {
    for (const auto& [id, inputs] : promised()) {
        const NodeType* type = findNodeType(id);
        ASSERT_TRUE(type) << id;
        EXPECT_EQ(type->id, id) << "an alias stands where an id was promised";
        for (std::size_t i = 0; i < inputs.size(); i++)
            EXPECT_EQ(inputIndex(*type, inputs[i]), int(i)) << id << "." << inputs[i];
    }
    const std::map<std::string, std::vector<std::string>> outputs = {
        {"position", {"position"}},
        {"time", {"seconds"}},
        {"value", {"value"}},
        {"math", {"value"}},
        {"vector_math", {"vector", "value"}},
        {"combine_xyz", {"vector"}},
        {"separate_xyz", {"x", "y", "z"}},
        {"noise", {"value", "vector"}},
        {"distance", {"value"}},
        {"from_distance", {"surface"}},
        {"polygonize", {"mesh"}},
        {"smooth", {"mesh"}},
        {"subdivide", {"mesh"}},
        {"decimate", {"mesh"}},
    };
    for (const auto& [id, names] : outputs) {
        for (std::size_t i = 0; i < names.size(); i++)
            EXPECT_EQ(outputIndex(*findNodeType(id), names[i]), int(i)) << id;
    }
}

TEST(NodeTable, NamesAreUniqueAndWellFormed) {
    std::set<std::string> names;
    for (const NodeType& type : nodeTypes()) {
        EXPECT_TRUE(isName(type.id)) << type.id;
        EXPECT_TRUE(names.insert(type.id).second) << type.id;
        for (const std::string& alias : type.aliases) {
            EXPECT_TRUE(isName(alias)) << alias;
            EXPECT_TRUE(names.insert(alias).second) << alias;
            EXPECT_EQ(findNodeType(alias), &type) << alias;
        }
        EXPECT_EQ(findNodeType(type.id), &type);
        std::set<std::string> inputs, outputs;
        for (const InputSpec& input : type.inputs) {
            EXPECT_TRUE(isName(input.name)) << type.id << "." << input.name;
            EXPECT_TRUE(inputs.insert(input.name).second) << type.id << "." << input.name;
        }
        for (const OutputSpec& output : type.outputs)
            EXPECT_TRUE(outputs.insert(output.name).second) << type.id;
    }
}

TEST(NodeTable, EverythingIsExplainedInSentences) {
    for (const NodeType& type : nodeTypes()) {
        EXPECT_FALSE(type.label.empty()) << type.id;
        EXPECT_TRUE(isSentence(type.doc)) << type.id << ": " << type.doc;
        for (const InputSpec& input : type.inputs)
            EXPECT_TRUE(isSentence(input.doc)) << type.id << "." << input.name << ": " << input.doc;
    }
}

TEST(NodeTable, DefaultsFitTheirInputs) {
    for (const NodeType& type : nodeTypes()) {
        for (const InputSpec& input : type.inputs) {
            SCOPED_TRACE(type.id + "." + input.name);
            const InputDefault& value = input.value;
            switch (input.type) {
                case Type::surface:
                case Type::mesh:
                case Type::particles:
                case Type::spline: EXPECT_EQ(value.kind, InputDefault::Kind::none); break;
                case Type::string:
                case Type::image:
                    EXPECT_EQ(value.kind, InputDefault::Kind::text);
                    if (!input.options.empty()) {
                        EXPECT_TRUE(std::ranges::find(input.options, value.text) != input.options.end());
                    }
                    break;
                case Type::knots: EXPECT_EQ(value.numbers.size() % 5, 0u); break;
                case Type::points:
                    EXPECT_EQ(value.numbers.size() % 2, 0u);
                    if (!input.ordered) {
                        EXPECT_GE(value.numbers.size(), 6u);
                        break;
                    }
                    [[fallthrough]];
                case Type::stops:
                    EXPECT_EQ(value.numbers.size() % std::size_t(entrySize(input.type)), 0u);
                    EXPECT_EQ(orderProblem(input.type, value.numbers), std::nullopt);
                    break;
                default:
                    if (value.kind == InputDefault::Kind::position) {
                        EXPECT_EQ(input.type, Type::vec3);
                    } else if (value.kind == InputDefault::Kind::numbers) {
                        EXPECT_EQ(int(value.numbers.size()), componentCount(input.type));
                    } else {
                        EXPECT_TRUE(type.category == Category::mesh || type.category == Category::particles)
                            << "a field input needs a default";
                    }
            }
            EXPECT_LE(input.min, input.max);
            EXPECT_TRUE(input.options.empty() || input.type == Type::string);
            for (double number : value.numbers) {
                EXPECT_TRUE(std::isfinite(number));
                EXPECT_GE(number, input.min);
                EXPECT_LE(number, input.max);
                EXPECT_TRUE(!input.positive || number > 0);
                EXPECT_TRUE(input.type != Type::integer || number == std::floor(number));
            }
        }
    }
}

TEST(NodeTable, EveryNodeHasAMeaning) {
    const std::set<std::string> treatedByTheCompiler = {"expression",
                                                        "polygonize",
                                                        "smooth",
                                                        "subdivide",
                                                        "decimate",
                                                        "output",
                                                        "reroute",
                                                        "frame",
                                                        "group",
                                                        "group_input",
                                                        "group_output",
                                                        "mesh_file",
                                                        "mesh_to_field",
                                                        "emitter",
                                                        "particle_file",
                                                        "particle_dynamics",
                                                        "sph_fluid",
                                                        "foam",
                                                        "particles_to_field",
                                                        "true_distance",
                                                        "round_edges",
                                                        "chamfer_edges",
                                                        "drop_crumbs"};
    for (const NodeType& type : nodeTypes()) {
        EXPECT_EQ(type.body.empty(), treatedByTheCompiler.contains(type.id)) << type.id;
        EXPECT_EQ(type.open, type.body.empty() && type.inputs.empty()) << type.id;
        const bool makesSurface = !type.body.empty() && type.outputs.front().type == Type::surface;
        EXPECT_EQ(bool(type.exactness), makesSurface) << type.id;
        EXPECT_TRUE(type.category != Category::shape || inputIndex(type, "p") == 0)
            << type.id << ": a shape is callable as shape(p, …)";
    }
}

TEST(NodeTable, CategoriesAndTypesHaveDistinctNames) {
    std::set<std::string_view> names;
    for (int i = 0; i < kCategories; i++) names.insert(categoryName(Category(i)));
    EXPECT_EQ(names.size(), std::size_t(kCategories));
    names.clear();
    for (int i = 0; i < kTypes; i++) names.insert(typeName(Type(i)));
    EXPECT_EQ(names.size(), std::size_t(kTypes));
}

TEST(NearestName, FindsWhatWasMeant) {
    EXPECT_EQ(nearestNodeType("sphre"), "sphere");
    EXPECT_EQ(nearestNodeType("shpere"), "sphere");
    EXPECT_EQ(nearestNodeType("cilinder"), "cylinder");
    EXPECT_EQ(nearestNodeType("substract"), "subtract");
    EXPECT_EQ(nearestNodeType("unoin"), "union");
    EXPECT_EQ(nearestNodeType("boxx"), "box");
    EXPECT_EQ(nearestNodeType("ball"), "sphere") << "an alias leads to its node";
    EXPECT_EQ(nearestNodeType("fluxcapacitor"), "");
    EXPECT_EQ(nearestNodeType(""), "");

    const std::vector<std::string> names = {"radius", "rounding", "half_extents"};
    EXPECT_EQ(nearestName("raduis", names), "radius");
    EXPECT_EQ(nearestName("half_extent", names), "half_extents");
    EXPECT_EQ(nearestName("zzz", names), "");
    EXPECT_EQ(nearestName("radius", {}), "");
}

TEST(NodeLookup, UnknownNamesAreRefused) {
    EXPECT_EQ(findNodeType("no_such_node"), nullptr);
    EXPECT_EQ(findNodeType(""), nullptr);
    EXPECT_EQ(inputIndex(*findNodeType("sphere"), "half_extents"), -1);
    EXPECT_EQ(outputIndex(*findNodeType("sphere"), "value"), -1);
}

}  // namespace fw::node_type_test
