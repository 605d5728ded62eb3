#include "graph/implicit3mf/export.h"

#include <stb/stb_image_write.h>

#include <algorithm>

#include "graph/assets/triangle_mesh.h"
#include "graph/base/words.h"
#include "graph/implicit3mf/function_text.h"

namespace fw {

namespace threemf {
namespace {

constexpr const char* kTextureRelation = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dtexture";

/// Our y is the model's z, our z its -y.
std::string vertex(double x, double y, double z) {
    return "<vertex x=\"" + exactNumber(x) + "\" y=\"" + exactNumber(-z + 0.0) + "\" z=\"" + exactNumber(y) +
           "\"/>";
}

std::string meshObject(int id, const std::string& name, const std::string& vertices,
                       std::span<const uint32_t> corners) {
    std::string text = "<object id=\"" + std::to_string(id) + "\" name=\"" + name +
                       "\" type=\"model\"><mesh><vertices>" + vertices + "</vertices><triangles>";
    for (std::size_t i = 0; i < corners.size(); i += 3)
        text += "<triangle v1=\"" + std::to_string(corners[i]) + "\" v2=\"" + std::to_string(corners[i + 1]) +
                "\" v3=\"" + std::to_string(corners[i + 2]) + "\"/>";
    return text + "</triangles></mesh></object>\n";
}

std::string boxObject(int id, const Box& box) {
    std::string vertices;
    for (int i = 0; i < 8; ++i)
        vertices += vertex(i & 1 ? box.hi[0] : box.lo[0], i & 2 ? box.hi[1] : box.lo[1],
                           i & 4 ? box.hi[2] : box.lo[2]);
    static constexpr uint32_t kCorners[] = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                            2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
    return meshObject(id, "bounds", vertices, kCorners);
}

std::string meshOf(int id, const TriangleMesh& mesh) {
    // The vertices are as they are: a mesh node is asked in our coordinates.
    std::string vertices;
    for (const glm::vec3& p : mesh.positions)
        vertices += "<vertex x=\"" + exactNumber(double(p.x)) + "\" y=\"" + exactNumber(double(p.y)) +
                    "\" z=\"" + exactNumber(double(p.z)) + "\"/>";
    return meshObject(id, "mesh", vertices, mesh.indices);
}

/// The grey of a picture as a PNG file, from its highest row on.
std::string greyPng(const FieldImage& image) {
    std::vector<unsigned char> grey;
    grey.reserve(image.texels.size());
    for (int y = image.height; y-- > 0;)
        for (int x = 0; x < image.width; ++x)
            grey.push_back(static_cast<unsigned char>(
                image.texels[std::size_t(y) * std::size_t(image.width) + std::size_t(x)] >> 24));
    std::string bytes;
    stbi_write_png_to_func(
        [](void* to, void* data, int size) {
            static_cast<std::string*>(to)->append(static_cast<const char*>(data), std::size_t(size));
        },
        &bytes, image.width, image.height, 1, grey.data(), image.width);
    return bytes;
}

std::string escaped(std::string_view text) {
    std::string safe;
    for (const char c : text) {
        if (c == '&')
            safe += "&amp;";
        else if (c == '<')
            safe += "&lt;";
        else if (c == '"')
            safe += "&quot;";
        else
            safe += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
    }
    return safe;
}

std::string colorCode(const std::array<double, 3>& linear) {
    char code[8];
    const auto byte = [](double light) {
        return static_cast<unsigned>(std::lround(255.0 * encodeSrgb(std::clamp(light, 0.0, 1.0))));
    };
    std::snprintf(code, sizeof code, "#%02X%02X%02X", byte(linear[0]), byte(linear[1]), byte(linear[2]));
    return code;
}

struct WrittenFunction {
    std::string text, problem, troubled;
    std::size_t nodes = 0;
};

/// The function with these roots, as `shape`, or three as the vector `color`.
WrittenFunction functionOf(const Program& program, FunctionResources& resources, int id,
                           const std::string& name, std::span<const IrId> roots) {
    FunctionText text(program, resources);
    std::vector<std::string> values;
    for (const IrId root : roots) values.push_back(text.value(root));
    if (!text.problem.empty()) return {{}, text.problem, text.troubled};
    std::string out = "<i:scalarref identifier=\"shape\" ref=\"" + values[0] + "\"/>";
    if (values.size() == 3) {
        out = "<i:vectorref identifier=\"color\" ref=\"mixed.result\"/>";
        text.nodes += "<i:composevector identifier=\"mixed\"><i:in>";
        for (std::size_t i = 0; i < 3; ++i)
            text.nodes += std::string("<i:scalarref identifier=\"") + char('x' + int(i)) + "\" ref=\"" +
                          values[i] + "\"/>";
        text.nodes += "</i:in><i:out><i:vector identifier=\"result\"/></i:out></i:composevector>\n";
    }
    return {"<i:implicitfunction id=\"" + std::to_string(id) + "\" displayname=\"" + name +
                "\"><i:in><i:vector identifier=\"pos\"/></i:in>\n" + text.nodes + "<i:out>" + out +
                "</i:out></i:implicitfunction>\n",
            {},
            {},
            text.count};
}

const char* unitName(const LengthUnit& unit) {
    return unit.metres == 0.001    ? "millimeter"
           : unit.metres == 0.01   ? "centimeter"
           : unit.metres == 0.0254 ? "inch"
                                   : "meter";
}

}  // namespace
}  // namespace threemf

Result<Exported3mf> export3mf(const Program& program, const Box& bounds, const LengthUnit& unit,
                              const std::string& name) {
    using namespace threemf;
    Exported3mf made;
    FunctionResources resources;
    const int box = resources.next++, shapeId = resources.next++;
    const WrittenFunction shape =
        functionOf(program, resources, shapeId, "shape", std::array{program.surface[distanceComponent]});
    if (!shape.problem.empty()) return Error{.message = shape.problem, .node = shape.troubled};
    made.nodes = shape.nodes;

    std::string color, colorUse, paint, body;
    const auto* base = &program.surface[baseColorComponent];
    if (program.ir.isConstant(base[0]) && program.ir.isConstant(base[1]) && program.ir.isConstant(base[2])) {
        const int id = resources.next++;
        color =
            "<basematerials id=\"" + std::to_string(id) + "\"><base name=\"" + escaped(name) +
            "\" displaycolor=\"" +
            colorCode({program.ir.number(base[0]), program.ir.number(base[1]), program.ir.number(base[2])}) +
            "\"/></basematerials>\n";
        paint = " pid=\"" + std::to_string(id) + "\" pindex=\"0\"";
    } else {
        const int id = resources.next++, data = resources.next++;
        const WrittenFunction field = functionOf(program, resources, id, "color", std::span(base, 3));
        if (field.problem.empty()) {
            color = field.text + "<v:volumedata id=\"" + std::to_string(data) + "\"><v:color functionid=\"" +
                    std::to_string(id) + "\" channel=\"color\"/></v:volumedata>\n";
            colorUse = " volumeid=\"" + std::to_string(data) + "\"";
        } else {
            made.warnings.push_back({.message = "its colour is left away: it " + field.problem,
                                     .node = field.troubled,
                                     .severity = Error::Severity::warning});
        }
    }

    std::vector<Part> parts;
    std::string relations;
    for (const auto& [picture, id] : resources.pictures) {
        const int stack = resources.next++;
        const std::string path = "3D/volumetric/picture" + std::to_string(stack) + "/sheet0000.png";
        parts.push_back({path, greyPng(*picture)});
        relations += "<Relationship Target=\"/" + path + "\" Id=\"rel" + std::to_string(stack) +
                     "\" Type=\"" + kTextureRelation + "\"/>";
        body += "<v:image3d id=\"" + std::to_string(stack) + "\"><v:imagestack rowcount=\"" +
                std::to_string(picture->height) + "\" columncount=\"" + std::to_string(picture->width) +
                "\" sheetcount=\"1\"><v:imagesheet path=\"/" + path +
                "\"/></v:imagestack></v:image3d>\n<v:functionfromimage3d id=\"" + std::to_string(id) +
                "\" image3did=\"" + std::to_string(stack) + "\" filter=\"linear\"/>\n";
    }
    for (const auto& [volume, id] : resources.meshes) body += meshOf(id, *volume->mesh);
    const int object = resources.next++;

    const std::string model =
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<model unit=\"" +
        std::string(unitName(unit)) +
        "\" xml:lang=\"en-US\" "
        "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" "
        "xmlns:v=\"http://schemas.3mf.io/3dmanufacturing/volumetric/2022/01\" "
        "xmlns:i=\"http://schemas.3mf.io/3dmanufacturing/implicit/2023/12\" requiredextensions=\"v i\">\n"
        "<metadata name=\"Application\">Fieldwright</metadata>\n<resources>\n" +
        body + boxObject(box, bounds) + shape.text + color + "<object id=\"" + std::to_string(object) +
        "\" name=\"" + escaped(name) + "\" type=\"model\"" + paint + "><v:levelset functionid=\"" +
        std::to_string(shapeId) + "\" channel=\"shape\" meshid=\"" + std::to_string(box) +
        "\" meshbboxonly=\"true\"" + colorUse + "/></object>\n</resources>\n<build><item objectid=\"" +
        std::to_string(object) + "\"/></build>\n</model>\n";

    const std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n",
                      related = "http://schemas.openxmlformats.org/package/2006/relationships";
    std::vector<Part> all = {
        {"[Content_Types].xml",
         xml + "<Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">"
               "<Default Extension=\"rels\" "
               "ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>"
               "<Default Extension=\"model\" "
               "ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/>"
               "<Default Extension=\"png\" ContentType=\"image/png\"/></Types>\n"},
        {"_rels/.rels",
         xml + "<Relationships xmlns=\"" + related +
             "\"><Relationship Target=\"/3D/3dmodel.model\" Id=\"rel0\" "
             "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>\n"},
        {"3D/3dmodel.model", model}};
    if (!relations.empty())
        all.push_back({"3D/_rels/3dmodel.model.rels",
                       xml + "<Relationships xmlns=\"" + related + "\">" + relations + "</Relationships>\n"});
    all.insert(all.end(), parts.begin(), parts.end());
    made.bytes = packed(all);
    return made;
}

}  // namespace fw
