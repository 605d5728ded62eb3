// PLY: elements with properties that a header lists, as text or in binary of either byte order. Of the
// vertices their places and colours are read, of particles their velocities and numbers, of the faces their
// corners; all else is passed over.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>

#include "graph/assets/file_points.h"
#include "graph/assets/image.h"
#include "graph/assets/triangle_mesh.h"
#include "graph/assets/triangle_mesh_text.h"

namespace fw {

namespace {

struct Fault {
    std::string what;
};
[[noreturn]] void fail(const std::string& what) { throw Fault{what}; }

enum class Kind { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
constexpr std::pair<std::string_view, Kind> kKinds[] = {
    {"char", Kind::int8},      {"int8", Kind::int8},       {"uchar", Kind::uint8},
    {"uint8", Kind::uint8},    {"short", Kind::int16},     {"int16", Kind::int16},
    {"ushort", Kind::uint16},  {"uint16", Kind::uint16},   {"int", Kind::int32},
    {"int32", Kind::int32},    {"uint", Kind::uint32},     {"uint32", Kind::uint32},
    {"float", Kind::float32},  {"float32", Kind::float32}, {"double", Kind::float64},
    {"float64", Kind::float64}};

Kind kindOf(std::string_view word) {
    for (const auto& [name, kind] : kKinds)
        if (name == word) return kind;
    fail("has a property of a type that PLY does not have");
}

struct Property {
    std::string_view name;
    Kind kind;
    std::optional<Kind> count;  ///< of a list
};

struct Element {
    std::string_view name;
    uint64_t count;
    std::vector<Property> properties;
};

enum class Form { text, little, big };

class Reader {
  public:
    explicit Reader(std::string_view bytes) : scanner{bytes} {}

    TriangleMesh run() {
        header();
        for (const Element& element : elements) {
            // Each takes at least a byte, or a line that may be empty; so many are not read for nothing.
            if (element.count > scanner.rest.size() && !element.properties.empty())
                fail("is cut off: copy it again");
            if (element.name == "vertex")
                vertices(element);
            else if (element.name == "face")
                faces(element);
            else
                for (uint64_t i = 0; i < element.count && !element.properties.empty(); ++i)
                    each(
                        element, [](std::size_t, double) {}, [](std::size_t, const std::vector<double>&) {});
        }
        return std::move(mesh);
    }
    /// What vertices have as particles, once they were read.
    FilePoints asPoints() { return std::move(points); }

  private:
    void header() {
        if (scanner.line() != "ply") fail("is no PLY file");
        bool formed = false;
        for (bool more = true; more;) {
            if (scanner.atEnd()) fail("ends within its header");
            Scanner words{scanner.line()};
            const std::string_view word = words.word();
            if (word == "format") {
                const std::string_view name = words.word();
                form = name == "ascii"                  ? Form::text
                       : name == "binary_little_endian" ? Form::little
                       : name == "binary_big_endian"
                           ? Form::big
                           : (fail("is of a format that PLY does not have"), Form::text);
                formed = true;
            } else if (word == "element") {
                Element element{words.word(), 0, {}};
                const auto count = words.number<uint64_t>();
                if (!count) fail("has an element without a count");
                element.count = *count;
                elements.push_back(element);
            } else if (word == "property") {
                if (elements.empty()) fail("has a property of no element");
                const std::string_view type = words.word();
                Property property{};
                if (type == "list") {
                    property.count = kindOf(words.word());
                    property.kind = kindOf(words.word());
                } else {
                    property.kind = kindOf(type);
                }
                property.name = words.word();
                elements.back().properties.push_back(property);
                if (elements.back().properties.size() > 256) fail("has more properties than can be read");
            } else if (word == "end_header") {
                more = false;
            } else if (word != "comment" && word != "obj_info" && !word.empty()) {
                fail("has a line in its header that PLY does not have");
            }
        }
        if (!formed) fail("does not tell its format");
    }

    template <class T>
    double raw() {
        std::optional<T> value = scanner.raw<T>();
        if (!value) fail("is cut off: copy it again");
        if (form == Form::big) {
            auto bytes = std::bit_cast<std::array<unsigned char, sizeof(T)>>(*value);
            std::ranges::reverse(bytes);
            value = std::bit_cast<T>(bytes);
        }
        return double(*value);
    }

    double number(Kind kind) {
        if (form == Form::text) {
            const std::string_view word = scanner.word();
            if (word.empty()) fail("is cut off: copy it again");
            const auto value = Scanner::numberIn<double>(word);
            if (!value) fail("has " + inQuotes(std::string(word)) + " where a number should be");
            return *value;
        }
        switch (kind) {
            case Kind::int8: return raw<int8_t>();
            case Kind::uint8: return raw<uint8_t>();
            case Kind::int16: return raw<int16_t>();
            case Kind::uint16: return raw<uint16_t>();
            case Kind::int32: return raw<int32_t>();
            case Kind::uint32: return raw<uint32_t>();
            case Kind::float32: return raw<float>();
            case Kind::float64: return raw<double>();
        }
        return 0;
    }

    /// One element: one(property, value) and many(property, values).
    template <class One, class Many>
    void each(const Element& element, One one, Many many) {
        for (std::size_t p = 0; p < element.properties.size(); ++p) {
            const Property& property = element.properties[p];
            if (!property.count) {
                one(p, number(property.kind));
                continue;
            }
            const double count = number(*property.count);
            if (!(count >= 0 && count <= double(scanner.rest.size())))
                fail("has a list of an impossible length");
            list.clear();
            for (double i = 0; i < count; ++i) list.push_back(number(property.kind));
            many(p, list);
        }
    }

    void vertices(const Element& element) {
        if (element.count > kMostMeshVertices) fail("has more vertices than can be read");
        const auto place = [&](std::initializer_list<std::string_view> names) {
            const auto& all = element.properties;
            return std::size_t(std::ranges::find_if(all,
                                                    [&](const Property& property) {
                                                        return !property.count &&
                                                               std::ranges::find(names, property.name) !=
                                                                   names.end();
                                                    }) -
                               all.begin());
        };
        const std::size_t none = element.properties.size();
        const std::array places = {place({"x"}), place({"y"}), place({"z"})};
        const std::array colors = {place({"red", "r", "diffuse_red"}), place({"green", "g", "diffuse_green"}),
                                   place({"blue", "b", "diffuse_blue"})};
        if (std::ranges::find(places, none) != places.end()) fail("has vertices without x, y and z");
        const bool colored = std::ranges::find(colors, none) == colors.end();
        const std::array velocity = {place({"vx", "velocity_x"}), place({"vy", "velocity_y"}),
                                     place({"vz", "velocity_z"})};
        const bool moves = std::ranges::find(velocity, none) == velocity.end();
        const std::size_t id = place({"id", "particle_id"});
        std::vector<double> values(none);
        for (uint64_t i = 0; i < element.count; ++i) {
            each(
                element, [&](std::size_t p, double value) { values[p] = value; },
                [](std::size_t, const std::vector<double>&) {});
            glm::vec3 p, color;
            for (int k = 0; k < 3; ++k) {
                p[k] = float(values[places[std::size_t(k)]]);
                if (!std::isfinite(p[k])) fail("has a vertex that is not finite");
                if (!colored) continue;
                const Property& property = element.properties[colors[std::size_t(k)]];
                const bool bytes = property.kind == Kind::uint8 || property.kind == Kind::int8;
                const double code = values[colors[std::size_t(k)]] / (bytes ? 255.0 : 1.0);
                color[k] = code >= 0 ? float(decodeSrgb(std::min(code, 1.0))) : 0.0f;
            }
            mesh.positions.push_back(p);
            if (colored) mesh.colors.push_back(color);
            if (moves)
                points.velocities.emplace_back(values[velocity[0]], values[velocity[1]], values[velocity[2]]);
            if (id != none) points.ids.push_back(asId(values[id]));
        }
    }

    static uint32_t asId(double number) {
        if (!(number >= -2147483648.0 && number <= 4294967295.0)) fail("has an id beyond 32 bits");
        return uint32_t(int64_t(number));
    }

    void faces(const Element& element) {
        const auto& all = element.properties;
        const auto corners = std::ranges::find_if(all, [](const Property& property) {
            return property.count && (property.name == "vertex_indices" || property.name == "vertex_index");
        });
        if (corners == all.end()) fail("has faces without corners");
        const auto wanted = std::size_t(corners - all.begin());
        const auto vertex = [&](double index) {
            if (!(index >= 0 && index < double(mesh.positions.size())))
                fail("has a face with vertex " + std::to_string(int64_t(std::clamp(index, -1e15, 1e15))) +
                     " of " + std::to_string(mesh.positions.size()));
            return uint32_t(index);
        };
        for (uint64_t i = 0; i < element.count; ++i)
            each(
                element, [](std::size_t, double) {},
                [&](std::size_t p, const std::vector<double>& of) {
                    if (p != wanted) return;
                    if (mesh.indices.size() / 3 + of.size() > kMostMeshTriangles)
                        fail("has more triangles than can be read");
                    for (std::size_t c = 2; c < of.size(); ++c)
                        mesh.indices.insert(mesh.indices.end(),
                                            {vertex(of[0]), vertex(of[c - 1]), vertex(of[c])});
                });
    }

    Scanner scanner;
    Form form = Form::text;
    std::vector<Element> elements;
    std::vector<double> list;
    TriangleMesh mesh;
    FilePoints points;
};

}  // namespace

Result<TriangleMesh> readPlyMesh(const MeshFile& file) {
    try {
        return Reader(file.bytes).run();
    } catch (const Fault& fault) { return meshProblem(file, fault.what); }
}

Result<FilePoints> readPlyPoints(std::string_view bytes, const std::string& path) {
    try {
        Reader reader(bytes);
        TriangleMesh mesh = reader.run();
        FilePoints points = reader.asPoints();
        points.places = std::move(mesh.positions);
        return points;
    } catch (const Fault& fault) { return fileProblem(path, kParticleFile, fault.what); }
}

}  // namespace fw
