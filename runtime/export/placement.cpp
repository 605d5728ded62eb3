#include "runtime/export/placement.h"

#include "graph/base/words.h"
#include "runtime/system/output_file.h"

namespace fw {

namespace {

/// Those of parts that are printed or milled, millimetres.
constexpr double kSmallestPart = 1.0, kLargestPart = 2000.0;

}  // namespace

glm::vec3 Placement::placeBack(glm::vec3 p) const {
    const glm::vec3 back = zUp ? glm::vec3(p.x, p.z, -p.y) : p;
    return scale == 1.0 ? back : glm::vec3(glm::dvec3(back) / scale);
}

std::string Placement::words() const { return std::string(unit.words) + (zUp ? ", +Z up" : ", +Y up"); }

Result<Placement> placementOf(const std::string& path, const LengthUnit& document,
                              const PlacementWish& wish) {
    const std::string ending = lowerExtension(path);
    const auto refuse = [&](std::string message) {
        return Error{.message = std::move(message), .file = path};
    };
    const bool gltf = ending == ".glb" || ending == ".gltf", threeMf = ending == ".3mf";
    if (wish.forPrinting() && ending != ".stl" && !threeMf)
        return refuse(ending + " is not what is printed: write .stl or .3mf, or give --unit and --up");
    if (wish.forPrinting() && !(wish.unit.empty() && wish.up.empty()))
        return refuse("for printing is millimetres and +Z up: leave out --unit and --up");
    const std::string named = wish.forPrinting() ? "mm" : wish.unit;
    const LengthUnit* unit = named.empty() ? &document : lengthUnit(named);
    if (!unit) {
        std::vector<std::string> names;
        for (const LengthUnit& known : lengthUnits()) names.emplace_back(known.name);
        return refuse("the unit '" + named + "' is none of " + listed(names));
    }
    if (!wish.up.empty() && wish.up != "y" && wish.up != "z")
        return refuse("the axis '" + wish.up + "' is none of y, z");
    Placement placement{.scale = document.metres / unit->metres,
                        .zUp = wish.forPrinting() || wish.up == "z",
                        .unit = *unit,
                        .document = document};
    if (gltf) {
        if (placement.zUp)
            return refuse(
                "glTF has +Y up by its specification, and programs turn it as they like: leave out --up");
        if (!named.empty() && named != "m")
            return refuse("glTF is in metres by its specification: leave out --unit");
        placement.scale = document.metres, placement.unit = *lengthUnit("m");
    } else if (threeMf) {
        if (!named.empty() && named != "mm") return refuse("3MF is written in millimetres: leave out --unit");
        placement.scale = document.metres, placement.unit = *lengthUnit("mm");
    }
    return placement;
}

Mesh placed(Mesh mesh, const Placement& placement) {
    if (placement.isNone()) return mesh;
    for (glm::vec3& p : mesh.positions) p = placement.place(p);
    for (glm::vec3& n : mesh.normals) n = placement.turned(n);
    for (glm::vec4& t : mesh.tangents) t = glm::vec4(placement.turned(glm::vec3(t)), t.w);
    const auto scale = float(placement.scale);
    mesh.material.absorption /= scale;
    for (MeshPart& part : mesh.parts) part.material.absorption /= scale;
    return mesh;
}

std::optional<std::string> unlikelySize(double longest, const LengthUnit& unit) {
    const double millimetres = longest * unit.metres * 1000.0;
    if (millimetres >= kSmallestPart && millimetres <= kLargestPart) return std::nullopt;
    return "it is " + shortNumber(millimetres) + " mm long, which is " +
           (millimetres < kSmallestPart ? "small" : "large") + " for a part: is the document's unit (" +
           unit.words + ") what was meant?";
}

}  // namespace fw
