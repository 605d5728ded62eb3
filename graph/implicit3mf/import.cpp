#include "graph/implicit3mf/import.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <numbers>

#include "graph/base/words.h"
#include "graph/document/unit.h"
#include "graph/implicit3mf/functions.h"

namespace fw {

namespace threemf {
namespace {

constexpr int kObjectResolution = 192,
              kOutputResolution = 192;  // samples along a mesh's and the solid's side

std::string objectWords(const Object& object) {
    return "the object " + std::to_string(object.id) +
           (object.name.empty() ? "" : " " + inQuotes(object.name));
}

glm::dmat3 linear(const Affine& m) { return {m[0], m[1], m[2]}; }

/// Its triangles as a binary PLY file.
std::string plyOf(const Object& object) {
    std::string bytes =
        "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(object.positions.size()) +
        "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
        std::to_string(object.indices.size() / 3) + "\nproperty list uchar int vertex_indices\nend_header\n";
    const auto append = [&](const auto& value) {
        bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    };
    for (const glm::dvec3& p : object.positions) append(float(p.x)), append(float(p.y)), append(float(p.z));
    for (std::size_t i = 0; i < object.indices.size(); ++i) {
        if (i % 3 == 0) bytes += '\3';
        append(object.indices[i]);
    }
    return bytes;
}

struct Bounds {
    glm::dvec3 least, most;
};
Bounds boundsOf(const Object& object) {
    Bounds bounds{object.positions[0], object.positions[0]};
    for (const glm::dvec3& p : object.positions)
        bounds.least = glm::min(bounds.least, p), bounds.most = glm::max(bounds.most, p);
    return bounds;
}

/// Whether a mesh is its bounds: twelve triangles with their corners.
bool isBox(const Object& object) {
    const Bounds bounds = boundsOf(object);
    return object.indices.size() == 36 && object.positions.size() == 8 &&
           std::ranges::all_of(object.positions, [&](const glm::dvec3& p) {
               for (int i = 0; i < 3; ++i)
                   if (p[i] != bounds.least[i] && p[i] != bounds.most[i]) return false;
               return true;
           });
}

/// What transforms of the library do: a scale, then turns about x, y and z, degrees, then a move.
struct Placing {
    glm::dvec3 move{0.0}, angles{0.0};
    double scale = 1.0;
};
/// None for a transform that shears, mirrors or stretches.
std::optional<Placing> placingOf(const Affine& m) {
    const double scale = glm::length(m[0]);
    if (!(scale > 0.0)) return std::nullopt;
    const glm::dmat3 turn = linear(m) * (1.0 / scale);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            if (std::abs(glm::dot(turn[i], turn[j]) - double(i == j)) > 1e-9) return std::nullopt;
    if (glm::determinant(turn) < 0.0) return std::nullopt;
    // The matrix is Rz Ry Rx; turn[column][row].
    const double sine = std::clamp(-turn[0][2], -1.0, 1.0);
    const bool level = std::abs(sine) < 1.0 - 1e-12;
    const glm::dvec3 radians(level ? std::atan2(turn[1][2], turn[2][2]) : std::atan2(-turn[2][1], turn[1][1]),
                             std::asin(sine), level ? std::atan2(turn[0][1], turn[0][0]) : 0.0);
    Placing placing{m[3], radians * (180.0 / std::numbers::pi), std::abs(scale - 1.0) < 1e-12 ? 1.0 : scale};
    for (int i = 0; i < 3; ++i)  // right angles stay right
        if (std::abs(placing.angles[i] - std::round(placing.angles[i])) < 1e-9)
            placing.angles[i] = std::round(placing.angles[i]) + 0.0;
    return placing;
}

InputValue numbersValue(const glm::dvec3& v) { return {.value = std::vector<double>{v.x, v.y, v.z}}; }

class Importer {
  public:
    Importer(const Package& package, const Model& model_, const std::string& folder_)
        : model(model_),
          folder(folder_),
          functions(model_, package, imported.graph,
                    {.mesh = [this](const Object& object) { return meshFile(object); },
                     .picture =
                         [this](int stack, const SheetPicture& picture) {
                             return file("image_" + std::to_string(stack) + "_" + picture.name + ".png",
                                         picture.bytes);
                         }}) {}

    Result<Imported> run() {
        std::vector<InputValue> items;
        for (const Component& item : model.items) {
            const Result<InputValue> object = placedObject(item, 0);
            if (!object) return object.error();
            items.push_back(*object);
        }
        if (items.empty()) return Error{.message = "it builds nothing: it has no build item"};
        InputValue all = together(std::move(items), "all");
        all = inUnit(turned(all));
        Node& output = add("output", "out");
        output.set("surface", all);
        output.set("resolution", {.value = double(kOutputResolution)});
        if (imported.graph.nodes.size() > kMaxNodes)
            return Error{.message = "it builds more than a graph has room for, " + std::to_string(kMaxNodes) +
                                    " nodes"};

        // What nothing uses is there for whoever goes on with it; what of it makes no sense harms nobody.
        for (const auto& [id, function] : model.functions) {
            if (std::ranges::any_of(function.inputs,
                                    [](const Socket& s) { return s.type == ValueType::resource; }))
                continue;
            if (const Result<const Group*> group = functions.group(id); !group)
                warn(group.error().message + "; nothing that is built uses it, so it is left away");
        }
        for (const std::string& what : model.left) warn(what);
        for (const std::string& what : functions.remarks) warn(what);
        return std::move(imported);
    }

  private:
    Node& add(std::string type, std::string_view name) {
        return addNode(imported.graph.nodes, ids, std::move(type), name);
    }
    void warn(const std::string& what) {
        imported.warnings.push_back({.message = what, .severity = Error::Severity::warning});
    }

    std::string file(const std::string& name, const std::string& bytes) {
        const std::string path = folder + "/" + name;
        const auto known = std::ranges::find(imported.files, path, &FileBeside::path);
        if (known == imported.files.end()) imported.files.push_back({path, bytes});
        return path;
    }
    Result<std::string> meshFile(const Object& object) {
        return file("mesh_" + std::to_string(object.id) + ".ply", plyOf(object));
    }

    // ---- nodes

    InputValue together(std::vector<InputValue> parts, const std::string& name) {
        while (parts.size() > 1) {
            std::vector<InputValue> pairs;
            for (std::size_t i = 0; i + 1 < parts.size(); i += 2) {
                Node& both = add("union", name);
                both.set("a", parts[i]), both.set("b", parts[i + 1]);
                pairs.push_back(linkTo(both.id));
            }
            if (parts.size() % 2) pairs.push_back(parts.back());
            parts = std::move(pairs);
        }
        return parts[0];
    }

    InputValue turned(const InputValue& solid) {
        Node& node = add("rotate", "upright");
        node.label = "z up becomes y up";
        node.set("surface", solid);
        node.set("angles", numbersValue({-90, 0, 0}));
        return linkTo(node.id);
    }

    /// In the document's unit, which is the model's if there is such a one, else a part of it.
    InputValue inUnit(const InputValue& solid) {
        const std::span<const LengthUnit> units = lengthUnits();
        auto unit = std::ranges::find(units, model.unit, &LengthUnit::metres);
        if (unit == units.end())
            unit = std::ranges::find(units, std::string_view(model.unit < 0.01 ? "mm" : "in"),
                                     &LengthUnit::name);
        setUnit(imported.graph, *unit);
        if (model.unit == unit->metres) return solid;
        Node& node = add("scale", "unit");
        node.set("surface", solid);
        node.set("factor", {.value = model.unit / unit->metres});
        return linkTo(node.id);
    }

    /// Where a function is asked for its value, of a place of the object.
    InputValue place(const Affine& transform) {
        if (position.empty()) position = add("position", "position").id;
        if (transform == kIdentity) return linkTo(position);
        const std::string from = position;
        Node& node = add("expression", "place");
        node.code = productCode(transform, "v");
        node.set("v", linkTo(from));
        return linkTo(node.id);
    }

    Result<InputValue> placed(const InputValue& solid, const Affine& transform, const std::string& what) {
        if (transform == kIdentity) return solid;
        if (const std::optional<Placing> placing = placingOf(transform)) {
            const bool moves = placing->angles == glm::dvec3(0.0) && placing->scale == 1.0;
            Node& node = add(moves ? "translate" : "transform", "placed");
            node.set("surface", solid);
            node.set(moves ? "offset" : "translation", numbersValue(placing->move));
            if (!moves) node.set("rotation", numbersValue(placing->angles));
            if (!moves) node.set("scale", {.value = placing->scale});
            return linkTo(node.id);
        }
        const glm::dmat3 shape = linear(transform);
        const double size = std::max({glm::length(shape[0]), glm::length(shape[1]), glm::length(shape[2])});
        if (!(std::abs(glm::determinant(shape)) > 1e-12 * size * size * size))
            return Error{.message = "the transform of " + what + " makes it flat"};
        const glm::dmat3 back = glm::inverse(shape);
        Affine inverse(back[0], back[1], back[2], back * -transform[3]);
        Node& node = add("expression", "placed");
        node.code = "return solid(" + productCode(inverse, "p") + ");";
        node.set("solid", solid);
        return linkTo(node.id);
    }

    // ---- objects

    Result<InputValue> placedObject(const Component& item, int depth) {
        const Object* object = entry(model.objects, item.object);
        if (!object)
            return Error{.message = "what is built asks for the object " + std::to_string(item.object) +
                                    ", and there is none"};
        const Result<InputValue> solid = solidOf(*object, depth);
        return solid ? placed(*solid, item.transform, objectWords(*object)) : solid;
    }

    Result<InputValue> solidOf(const Object& object, int depth) {
        const auto known = solids.find(object.id);
        if (known != solids.end()) return known->second;
        if (!within.insert(object.id).second || depth > kMaxNesting)
            return Error{.message = objectWords(object) + " is a component of itself, or of too many others"};
        if (imported.graph.nodes.size() > kMaxNodes)
            return Error{.message = "it builds more than a graph has room for, " + std::to_string(kMaxNodes) +
                                    " nodes"};
        Result<InputValue> solid = object.levelSet    ? levelSet(object)
                                   : object.hasMesh() ? mesh(object, kObjectResolution)
                                                      : components(object, depth);
        within.erase(object.id);
        if (!solid) return solid;
        solid = painted(object, *solid);
        if (solid) solids[object.id] = *solid;
        return solid;
    }

    Result<InputValue> components(const Object& object, int depth) {
        std::vector<InputValue> parts;
        for (const Component& component : object.components) {
            const Result<InputValue> part = placedObject(component, depth + 1);
            if (!part) return part;
            parts.push_back(*part);
        }
        if (parts.empty())
            return Error{.message =
                             objectWords(object) + " has neither a level set nor a mesh nor components"};
        return together(std::move(parts), object.name.empty() ? "parts" : object.name);
    }

    Result<InputValue> mesh(const Object& object, int resolution) {
        const Result<std::string> path = meshFile(object);
        if (!path) return path.error();
        Node& read = add("mesh_file", object.name.empty() ? "mesh" : object.name);
        read.set("path", {.value = *path});
        const std::string from = read.id;
        Node& field = add("mesh_to_field", "solid");
        field.set("mesh", linkTo(from));
        field.set("resolution", {.value = double(resolution)});
        return linkTo(field.id);
    }

    /// What a function gives in a place.
    Result<InputValue> fieldOf(const FunctionUse& use, ValueType type, const std::string& whose) {
        const Result<const Group*> group = functions.group(use.function);
        if (!group) return Error{.message = whose + ": " + group.error().message};
        const auto input = std::ranges::find((*group)->inputs, "pos", &GroupInput::name);
        const std::string channel = socketName(use.channel);
        const auto output = std::ranges::find((*group)->outputs, channel, &GroupOutput::name);
        const char* wanted = type == ValueType::vector ? "vec3" : "float";
        if (input == (*group)->inputs.end() || input->type != "vec3")
            return Error{.message = whose + ": its function takes no vector 'pos'"};
        for (const GroupInput& other : (*group)->inputs)
            if (other.name != "pos" && !other.value)
                return Error{.message =
                                 whose + ": its function takes more than 'pos', " + inQuotes(other.name)};
        if (output == (*group)->outputs.end() || output->type != wanted)
            return Error{.message =
                             whose + ": its function gives no " + nameOf(type) + " " + inQuotes(use.channel)};
        const std::string id = (*group)->id;
        const InputValue at = place(use.transform);
        Node& node = add("group", id);
        node.group = id;
        node.set("pos", at);
        return linkTo(node.id, channel);
    }

    Result<InputValue> levelSet(const Object& object) {
        const LevelSet& set = *object.levelSet;
        const std::string whose = "the level set of " + objectWords(object);
        const Result<InputValue> field = fieldOf(set.field, ValueType::scalar, whose);
        if (!field) return field;
        const Object* domain = entry(model.objects, set.mesh);
        if (!domain || !domain->hasMesh())
            return Error{.message = whose + " is bounded by the mesh of the object " +
                                    std::to_string(set.mesh) + ", and there is none"};
        InputValue within_;
        if (set.boxOnly || isBox(*domain)) {
            const Bounds bounds = boundsOf(*domain);
            Node& box = add("box", "bounds");
            box.set("half_extents", numbersValue(0.5 * (bounds.most - bounds.least)));
            const std::string inner = box.id;
            Node& moved = add("translate", "bounds_placed");
            moved.set("surface", linkTo(inner));
            moved.set("offset", numbersValue(0.5 * (bounds.least + bounds.most)));
            within_ = linkTo(moved.id);
        } else {
            const Result<InputValue> solid = mesh(*domain, kObjectResolution);
            if (!solid) return solid;
            within_ = *solid;
        }
        Node& cut = add("intersect", object.name.empty() ? "level_set" : object.name);
        cut.label = object.name;
        cut.set("a", *field), cut.set("b", within_);
        return linkTo(cut.id);
    }

    Result<InputValue> painted(const Object& object, const InputValue& solid) {
        const FunctionUse* colored = entry(model.colors, object.volume);
        if (!colored && !object.color) return solid;
        InputValue color = object.color ? numbersValue(*object.color) : InputValue{};
        if (colored) {
            const Result<InputValue> field =
                fieldOf(*colored, ValueType::vector, "the colour of " + objectWords(object));
            if (!field) return field;
            color = *field;
        }
        Node& node = add("material", "painted");
        node.set("surface", solid);
        node.set("base_color", color);
        return linkTo(node.id);
    }

    const Model& model;
    std::string folder;
    Imported imported;
    FunctionGroups functions;
    std::set<std::string, std::less<>> ids;
    std::string position;
    std::map<int, InputValue> solids;
    std::set<int> within;
};

}  // namespace
}  // namespace threemf

Result<Imported> import3mf(const std::string& bytes, const std::string& path, const std::string& folder) {
    const auto named = [&](Error error) {
        error.file = path;
        return error;
    };
    const Result<threemf::Package> package = threemf::Package::open(bytes);
    if (!package) return named(package.error());
    const Result<threemf::Model> model = threemf::readModel(*package);
    if (!model) return named(model.error());
    Result<Imported> imported = threemf::Importer(*package, *model, folder).run();
    if (!imported) return named(imported.error());
    for (Error& warning : imported->warnings) warning.file = path;
    return imported;
}

}  // namespace fw
