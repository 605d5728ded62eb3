#include <algorithm>
#include <charconv>
#include <cmath>
#include <pugixml.hpp>
#include <set>

#include "graph/assets/image.h"
#include "graph/base/words.h"
#include "graph/implicit3mf/model.h"

namespace fw::threemf {

namespace {

using Xml = pugi::xml_node;

constexpr const char* kModelPart = "3D/3dmodel.model";
constexpr const char* kModelRelation = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel";

/// Extensions that are read, as far as they tell what a solid is.
constexpr std::string_view kKnownExtensions[] = {
    "http://schemas.microsoft.com/3dmanufacturing/core/2015/02",
    "http://schemas.microsoft.com/3dmanufacturing/material/2015/02",
    "http://schemas.microsoft.com/3dmanufacturing/production/2015/06",
    "http://schemas.microsoft.com/3dmanufacturing/trianglesets/2021/07",
    "http://schemas.3mf.io/3dmanufacturing/volumetric/2022/01",
    "http://schemas.3mf.io/3dmanufacturing/implicit/2023/12",
};

std::string_view localName(std::string_view name) {
    const std::size_t colon = name.find(':');
    return colon == name.npos ? name : name.substr(colon + 1);
}
std::string_view nameOf(const Xml& node) { return localName(node.name()); }
std::string_view get(const Xml& node, const char* name) { return node.attribute(name).value(); }

constexpr std::string_view kBlanks = " \t\r\n";

std::string_view trimmed(std::string_view text) {
    const std::size_t from = text.find_first_not_of(kBlanks);
    return from == text.npos ? std::string_view()
                             : text.substr(from, text.find_last_not_of(kBlanks) - from + 1);
}

template <class Number>
std::optional<Number> numberOf(std::string_view text) {
    text = trimmed(text);
    if (text.starts_with('+')) text.remove_prefix(1);
    Number value{};
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (problem != std::errc() || end != text.data() + text.size()) return std::nullopt;
    if constexpr (std::is_floating_point_v<Number>)
        if (!std::isfinite(value)) return std::nullopt;
    return value;
}

/// Exactly so many numbers between blanks.
template <std::size_t count>
std::optional<std::array<double, count>> numbersOf(std::string_view text) {
    std::array<double, count> values{};
    for (double& value : values) {
        text = trimmed(text);
        const std::size_t end = std::min(text.find_first_of(kBlanks), text.size());
        const auto number = numberOf<double>(text.substr(0, end));
        if (!number) return std::nullopt;
        value = *number;
        text.remove_prefix(end);
    }
    if (!trimmed(text).empty()) return std::nullopt;
    return values;
}

std::optional<ValueType> valueTypeOf(std::string_view name) {
    if (name.ends_with("ref")) name.remove_suffix(3);
    if (name == "scalar") return ValueType::scalar;
    if (name == "vector") return ValueType::vector;
    if (name == "matrix") return ValueType::matrix;
    if (name == "resource" || name == "resourceid") return ValueType::resource;
    return std::nullopt;
}

class ModelReader {
  public:
    explicit ModelReader(const Package& package_) : package(package_) {}

    Result<Model> run() {
        if (const Done loaded = load(); !loaded) return loaded.error();
        const Xml root = document.document_element();
        if (nameOf(root) != "model")
            fail("its outermost element is " + inQuotes(root.name()) + ", not 'model'");
        extensions(root);
        unit(root);
        for (const Xml& resource : root.child("resources").children()) read(resource);
        for (const Xml& item : root.child("build").children())
            if (nameOf(item) == "item") build(component(item, "a build item"));
        if (problem) return *problem;
        for (const std::string& what : left) model.left.push_back(what);
        return std::move(model);
    }

  private:
    /// Keeps the first.
    void fail(const std::string& what) {
        if (!problem) problem = Error{.message = what};
    }
    void leave(const std::string& what) { left.insert(what + " is left away"); }

    Done load() {
        std::string name = kModelPart;
        if (package.has("_rels/.rels")) {
            const Result<std::string> bytes = package.part("_rels/.rels", 1u << 20);
            pugi::xml_document relations;
            if (!bytes) return bytes.error();
            relations.load_buffer(bytes->data(), bytes->size());
            for (const Xml& relation : relations.document_element().children())
                if (get(relation, "Type") == kModelRelation) name = get(relation, "Target");
        }
        if (!package.has(name)) return Error{.message = "is no 3MF file: it has no part " + inQuotes(name)};
        Result<std::string> bytes = package.part(name, kMostModelBytes);
        if (!bytes) return bytes.error();
        text = std::move(*bytes);
        const std::size_t elements = static_cast<std::size_t>(std::ranges::count(text, '<')),
                          attributes = static_cast<std::size_t>(std::ranges::count(text, '='));
        if (elements > 2 * kMostElements || attributes > 2 * kMostElements)
            return Error{.message = "its model has more than " + std::to_string(kMostElements) +
                                    " elements: at most as many are read"};
        const pugi::xml_parse_result parsed = document.load_buffer_inplace(text.data(), text.size());
        if (!parsed) {
            const auto end = text.begin() + std::min(parsed.offset, ptrdiff_t(text.size()));
            return Error{.message = "its model is damaged in line " +
                                    std::to_string(1 + std::count(text.begin(), end, '\n')) + ": " +
                                    parsed.description()};
        }
        return done();
    }

    void extensions(const Xml& root) {
        std::string_view wanted = get(root, "requiredextensions");
        while (!(wanted = trimmed(wanted)).empty()) {
            const std::size_t end = std::min(wanted.find_first_of(kBlanks), wanted.size());
            const std::string prefix(wanted.substr(0, end));
            wanted.remove_prefix(end);
            const std::string_view uri = get(root, ("xmlns:" + prefix).c_str());
            if (std::ranges::find(kKnownExtensions, uri) == std::end(kKnownExtensions))
                fail("it cannot be read without an extension that is not known here, " +
                     inQuotes(uri.empty() ? prefix : uri) +
                     ": write it from its program without that, or as a mesh");
        }
    }

    void unit(const Xml& root) {
        static constexpr std::pair<std::string_view, double> kUnits[] = {
            {"", 0.001},      {"micron", 1e-6}, {"millimeter", 0.001}, {"centimeter", 0.01},
            {"inch", 0.0254}, {"foot", 0.3048}, {"meter", 1.0}};
        const auto found =
            std::ranges::find(kUnits, get(root, "unit"), [](const auto& u) { return u.first; });
        if (found == std::end(kUnits))
            return fail("its unit " + inQuotes(get(root, "unit")) + " is not known");
        model.unit = found->second;
    }

    /// What is no part of the model, though it stands beside it, is not built.
    void build(const Component& item) {
        const auto other = noModels.find(item.object);
        if (other == noModels.end()) return model.items.push_back(item);
        leave("the object " + std::to_string(item.object) + ", of the type " + inQuotes(other->second) + ",");
    }

    /// A positive number; 0 where there is none.
    int idOf(const Xml& node, const char* attribute) {
        return std::max(0, numberOf<int>(get(node, attribute)).value_or(0));
    }
    double numberIn(const Xml& node, const char* attribute, double none, const std::string& whose) {
        const std::string_view words = get(node, attribute);
        if (words.empty()) return none;
        const auto number = numberOf<double>(words);
        if (!number)
            fail(whose + " has " + inQuotes(words) + " for its " + attribute + ", which is no number");
        return number.value_or(none);
    }
    Affine transformIn(const Xml& node, const std::string& whose) {
        const std::string_view words = get(node, "transform");
        if (words.empty()) return kIdentity;
        const auto rows = numbersOf<12>(words);
        if (!rows) {
            fail("the transform of " + whose + " is not of twelve numbers");
            return kIdentity;
        }
        Affine result;
        for (int i = 0; i < 12; ++i) result[i / 3][i % 3] = (*rows)[std::size_t(i)];
        return result;
    }

    void read(const Xml& node) {
        const std::string_view name = nameOf(node);
        if (name.empty()) return;
        const int id = idOf(node, "id");
        if (id == 0) return fail("a resource " + inQuotes(name) + " has no id");
        if (!ids.insert(id).second) return fail("two resources have the id " + std::to_string(id));
        if (name == "implicitfunction" || name == "function")
            function(node, model.functions[id]);
        else if (name == "functionfromimage3d")
            imageFunction(node, model.imageFunctions[id]);
        else if (name == "image3d")
            stack(node, model.stacks[id]);
        else if (name == "object")
            object(node, model.objects[id]);
        else if (name == "volumedata")
            volume(node, id);
        else if (name == "colorgroup")
            palette(node, "color", "color", id);
        else if (name == "basematerials")
            palette(node, "base", "displaycolor", id);
        else
            leave("the resource " + inQuotes(name));
    }

    // ---- functions

    /// None, told, if there is no such type.
    auto typeOf(const Xml& node, const std::string& whose) {
        const auto type = valueTypeOf(nameOf(node));
        if (!type) fail(whose + " has a value of the unknown type " + inQuotes(nameOf(node)));
        return type;
    }
    std::vector<Socket> sockets(const Xml& list, const std::string& whose) {
        std::vector<Socket> result;
        for (const Xml& node : list.children()) {
            if (nameOf(node).empty()) continue;
            const auto type = typeOf(node, whose);
            if (!type) continue;
            result.push_back({std::string(get(node, "identifier")), *type});
        }
        return result;
    }

    std::vector<Reference> references(const Xml& list, const std::string& whose) {
        std::vector<Reference> result;
        for (const Xml& node : list.children()) {
            if (nameOf(node).empty()) continue;
            const auto type = typeOf(node, whose);
            if (!type) continue;
            const std::string_view ref = get(node, "ref");
            const std::size_t dot = ref.find('.');
            Reference& made =
                result.emplace_back(Reference{std::string(get(node, "identifier")), *type, {}, {}});
            if (ref.empty()) continue;
            made.node = ref.substr(0, dot);
            if (dot != ref.npos) made.output = ref.substr(dot + 1);
            if (made.node.empty() || made.output.empty())
                fail(whose + " refers to " + inQuotes(ref) + ", which is not of the form node.output");
        }
        return result;
    }

    void function(const Xml& from, Function& to) {
        to.id = idOf(from, "id");
        to.name = get(from, "displayname");
        const std::string whose = "the function " + inQuotes(to.name) + " (id " + std::to_string(to.id) + ")";
        for (const Xml& child : from.children()) {
            const std::string_view kind = nameOf(child);
            if (kind == "in")
                to.inputs = sockets(child, whose);
            else if (kind == "out")
                to.outputs = references(child, whose);
            else if (!kind.empty())
                functionNode(child, to.nodes.emplace_back(), whose);
        }
    }

    void functionNode(const Xml& from, FunctionNode& to, const std::string& function) {
        to.kind = nameOf(from);
        to.id = get(from, "identifier");
        to.label = get(from, "displayname");
        const std::string whose = "node " + inQuotes(to.id) + " of " + function;
        if (to.id.empty() || to.id == "inputs")
            fail("a node " + inQuotes(to.kind) + " of " + function + " has no identifier of its own");
        for (const Xml& child : from.children()) {
            if (nameOf(child) == "in") to.inputs = references(child, whose);
            if (nameOf(child) == "out") to.outputs = sockets(child, whose);
        }
        const auto number = [&](const char* attribute) {
            if (get(from, attribute).empty()) fail(whose + " has no " + attribute);
            return numberIn(from, attribute, 0.0, whose);
        };
        if (to.kind == "constant") to.numbers[0] = number("value");
        if (to.kind == "constvec") to.numbers = {number("x"), number("y"), number("z")};
        if (to.kind == "constmat") {
            const auto matrix = numbersOf<16>(get(from, "matrix"));
            if (!matrix) fail(whose + " has no matrix of sixteen numbers");
            to.numbers = matrix.value_or(std::array<double, 16>{});
        }
        if (to.kind == "constresourceid") {
            to.resource = std::max(idOf(from, "value"), idOf(from, "resourceid"));
            if (to.resource == 0) fail(whose + " names no resource");
        }
    }

    FunctionUse functionUse(const Xml& from, const std::string& whose) {
        return {idOf(from, "functionid"), std::string(get(from, "channel")), transformIn(from, whose)};
    }

    // ---- pictures

    void imageFunction(const Xml& from, ImageFunction& to) {
        to.id = idOf(from, "id");
        to.stack = std::max(idOf(from, "image3did"), idOf(from, "image3dID"));
        to.name = get(from, "displayname");
        const std::string whose = "the function from image3d " + std::to_string(to.id);
        to.offset = numberIn(from, "valueoffset", numberIn(from, "offset", 0.0, whose), whose);
        to.scale = numberIn(from, "valuescale", numberIn(from, "scale", 1.0, whose), whose);
        const std::string_view filter = get(from, "filter");
        to.nearest = filter == "nearest";
        if (!filter.empty() && filter != "nearest" && filter != "linear")
            fail(whose + " has the unknown filter " + inQuotes(filter));
        const char* const names[] = {"tilestyleu", "tilestylev", "tilestylew"};
        for (std::size_t i = 0; i < 3; ++i) {
            const std::string_view style = get(from, names[i]);
            if (style == "mirror")
                to.tiles[i] = TileStyle::mirror;
            else if (style == "clamp")
                to.tiles[i] = TileStyle::clamp;
            else if (!style.empty() && style != "wrap")
                fail(whose + " has the unknown " + std::string(names[i]) + " " + inQuotes(style));
        }
    }

    void stack(const Xml& from, ImageStack& to) {
        to.id = idOf(from, "id");
        const std::string whose = "the image3d " + std::to_string(to.id);
        for (const Xml& child : from.children()) {
            if (nameOf(child) != "imagestack") continue;
            to.rows = idOf(child, "rowcount"), to.columns = idOf(child, "columncount");
            for (const Xml& sheet : child.children())
                if (nameOf(sheet) == "imagesheet") to.sheets.emplace_back(get(sheet, "path"));
            if (std::size_t(idOf(child, "sheetcount")) != to.sheets.size())
                fail(whose + " has " + std::to_string(to.sheets.size()) + " sheets, not as many as it says");
        }
        if (to.sheets.empty()) fail(whose + " has no imagestack with sheets, and nothing else is read");
    }

    // ---- objects

    void object(const Xml& from, Object& to) {
        to.id = idOf(from, "id");
        to.name = get(from, "name");
        const std::string whose = "the object " + std::to_string(to.id);
        const std::string_view type = get(from, "type");
        if (type == "support" || type == "solidsupport" || type == "other") noModels.emplace(to.id, type);
        to.color = colorOf(idOf(from, "pid"), get(from, "pindex"));
        if (!get(from, "pid").empty() && !to.color) leave("the material of " + whose);
        for (const Xml& child : from.children()) {
            const std::string_view kind = nameOf(child);
            if (kind == "mesh")
                mesh(child, to, whose);
            else if (kind == "levelset")
                levelSet(child, to, whose);
            else if (kind == "components")
                for (const Xml& part : child.children()) {
                    if (nameOf(part) == "component")
                        to.components.push_back(component(part, "a component of " + whose));
                }
            else if (!kind.empty() && kind != "metadatagroup")
                leave(inQuotes(kind) + " of " + whose);
        }
    }

    void mesh(const Xml& from, Object& to, const std::string& whose) {
        to.volume = std::max(to.volume, idOf(from, "volumeid"));
        bool painted = false;
        for (const Xml& child : from.children()) {
            const std::string_view kind = nameOf(child);
            if (kind == "vertices") {
                for (const Xml& v : child.children()) {
                    for (const char* axis : {"x", "y", "z"})
                        if (get(v, axis).empty()) return fail("a vertex of " + whose + " has no " + axis);
                    glm::dvec3& p = to.positions.emplace_back();
                    p.x = numberIn(v, "x", 0.0, whose), p.y = numberIn(v, "y", 0.0, whose);
                    p.z = numberIn(v, "z", 0.0, whose);
                }
            } else if (kind == "triangles") {
                for (const Xml& t : child.children())
                    for (const char* corner : {"v1", "v2", "v3"}) {
                        const auto index = numberOf<uint32_t>(get(t, corner));
                        if (!index) return fail("a triangle of " + whose + " has no " + corner);
                        to.indices.push_back(*index);
                        painted |= !get(t, "p1").empty();
                    }
            } else if (!kind.empty()) {
                leave(inQuotes(kind) + " of " + whose);
            }
        }
        if (painted) leave("what triangles of " + whose + " are painted with");
        if (to.positions.empty() || to.indices.empty()) fail(whose + " has a mesh without triangles");
        for (const uint32_t index : to.indices)
            if (index >= to.positions.size())
                return fail("a triangle of " + whose + " has a corner that is not there");
    }

    void levelSet(const Xml& from, Object& to, const std::string& whose) {
        LevelSet& set = to.levelSet.emplace();
        set.field = functionUse(from, "the level set of " + whose);
        set.mesh = idOf(from, "meshid");
        const std::string_view boxOnly = get(from, "meshbboxonly");
        set.boxOnly = boxOnly == "true" || boxOnly == "1";
        to.volume = std::max(to.volume, idOf(from, "volumeid"));
        if (numberIn(from, "fallbackvalue", 0.0, whose) != 0.0)
            leave("the fallback value of " + whose + ", which holds where its function has no value,");
    }

    void volume(const Xml& from, int id) {
        const std::string whose = "volumedata " + std::to_string(id);
        for (const Xml& child : from.children()) {
            const std::string_view kind = nameOf(child);
            if (kind == "color")
                model.colors[id] = functionUse(child, "the colour of " + whose);
            else if (kind == "property" &&
                     (get(child, "required") == "true" || get(child, "required") == "1"))
                fail("the property " + inQuotes(get(child, "name")) + " of " + whose +
                     " is required, and not known here");
            else if (!kind.empty())
                leave(inQuotes(kind) + " of " + whose);
        }
    }

    Component component(const Xml& from, const std::string& what) {
        for (const pugi::xml_attribute& attribute : from.attributes())
            if (localName(attribute.name()) == "path")
                fail(what + " lies in another part of the file, " + inQuotes(attribute.value()) +
                     ", which is not read: write the model as one part");
        return {idOf(from, "objectid"), transformIn(from, what)};
    }

    // ---- colours

    void palette(const Xml& from, const char* entryName, const char* attribute, int id) {
        for (const Xml& child : from.children()) {
            if (nameOf(child) != entryName) continue;
            const std::string_view code = get(child, attribute);
            uint32_t value = 0x808080;
            if ((code.size() != 7 && code.size() != 9) || code[0] != '#' ||
                std::from_chars(code.data() + 1, code.data() + 7, value, 16).ptr != code.data() + 7)
                fail("a colour of the resource " + std::to_string(id) + " is " + inQuotes(code));
            palettes[id].push_back({decodeSrgb((value >> 16 & 255) / 255.0),
                                    decodeSrgb((value >> 8 & 255) / 255.0),
                                    decodeSrgb((value & 255) / 255.0)});
        }
    }

    std::optional<glm::dvec3> colorOf(int palette, std::string_view index) {
        const auto found = palettes.find(palette);
        const auto at = numberOf<std::size_t>(index.empty() ? "0" : index);
        if (found == palettes.end() || !at || *at >= found->second.size()) return std::nullopt;
        return found->second[*at];
    }

    const Package& package;
    std::string text;
    pugi::xml_document document;
    Model model;
    std::optional<Error> problem;
    std::set<int> ids;
    std::set<std::string> left;
    std::map<int, std::string> noModels;  ///< types of objects that are none
    std::map<int, std::vector<glm::dvec3>> palettes;
};

}  // namespace

const char* nameOf(ValueType type) {
    switch (type) {
        case ValueType::scalar: return "scalar";
        case ValueType::vector: return "vector";
        case ValueType::matrix: return "matrix";
        case ValueType::resource: break;
    }
    return "resource";
}

const Reference* FunctionNode::input(std::string_view name) const {
    const auto found = std::ranges::find(inputs, name, &Reference::name);
    return found == inputs.end() || found->none() ? nullptr : &*found;
}

Result<Model> readModel(const Package& package) { return ModelReader(package).run(); }

}  // namespace fw::threemf
