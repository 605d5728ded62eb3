// 3MF, written with lib3mf: the core specification, vertex colours as its materials extension
// has them, UUIDs as its production extension.
//
// Millimetres, which is what slicers reckon in: positions are times 1000, written to 1e-6 mm. +Y stays up.
// The specification wants one vertex at one place and a closed solid, so equal positions are merged
// beforehand, and triangles that thereby collapse are left out. A mesh of one colour has it as the display
// colour of a base material, one with vertex colours has a colour at each corner of each triangle; both are
// 8-bit sRGB.
//
// lib3mf does not escape metadata, so the name stands at the object alone. It ends the process where its
// output fails while it closes the archive, so the archive, which is compressed, is gathered in memory and
// then written.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <memory>

#include "runtime/export/fingerprint.h"
#include "runtime/export/formats.h"
#include "runtime/measure/lib3mf_calls.h"
#include "runtime/mesh/corners.h"

namespace fw {
namespace {

using namespace lib3mf;

constexpr double kMillimetres = 1000.0;  // in a metre

/// An archive that lib3mf writes; its counts are put in behind.
struct Archive {
    std::string bytes;
    std::size_t at = 0;

    static BOOL write(const BYTE* data, DWORD size, void* self) {
        Archive& archive = *static_cast<Archive*>(self);
        archive.bytes.resize(std::max(archive.bytes.size(), archive.at + size));
        std::memcpy(archive.bytes.data() + archive.at, data, size);
        archive.at += size;
        return LIB3MF_OK;
    }
    static BOOL seek(ULONG64 position, void* self) {
        static_cast<Archive*>(self)->at = position;
        return LIB3MF_OK;
    }
};

MODELMESHCOLOR_SRGB srgbOf(glm::vec3 color) {
    return {encodeSrgb(color.x), encodeSrgb(color.y), encodeSrgb(color.z), 255};
}

void setColors(Calls& calls, const Object& model, const Object& object, const Mesh& mesh,
               std::vector<MODELMESH_TRIANGLECOLOR_SRGB>& colors, const std::string& name) {
    const MODELMESHCOLOR_SRGB base = srgbOf(mesh.baseColor);
    const Object whole = calls.make(lib3mf_object_createdefaultpropertyhandler, object);
    if (!colors.empty()) {
        // The specification asks for a colour of the whole object beside those of the triangles.
        calls.check(lib3mf_defaultpropertyhandler_setcolorrgba(whole.get(), base.m_Red, base.m_Green,
                                                               base.m_Blue, base.m_Alpha),
                    whole);
        const Object each = calls.make(lib3mf_meshobject_createpropertyhandler, object);
        calls.check(lib3mf_propertyhandler_setgradientcolorarray(each.get(), colors.data()), each);
        return;
    }
    const Object group = calls.make(lib3mf_model_addbasematerialgroup, model);
    DWORD number = 0, material = 0;
    calls.check(lib3mf_basematerial_getresourceid(group.get(), &number), group);
    calls.check(lib3mf_basematerial_addmaterialutf8(group.get(), name.c_str(), base.m_Red, base.m_Green,
                                                    base.m_Blue, &material),
                group);
    calls.check(lib3mf_basematerial_setdisplaycolorrgba(group.get(), material, base.m_Red, base.m_Green,
                                                        base.m_Blue, base.m_Alpha),
                group);
    calls.check(lib3mf_defaultpropertyhandler_setbasematerial(whole.get(), number, material), whole);
}

}  // namespace

std::string write3mf(const Mesh& mesh, const WeldedMesh& solid, const std::string& name,
                     const std::atomic<bool>* cancel, OutputFile& file) {
    std::vector<MODELMESHVERTEX> vertices;
    vertices.reserve(solid.positions.size());
    for (const glm::dvec3 p : solid.positions) {
        const glm::vec3 scaled(p * kMillimetres);
        vertices.push_back({{scaled.x, scaled.y, scaled.z}});
    }
    std::vector<MODELMESHTRIANGLE> triangles;
    std::vector<MODELMESH_TRIANGLECOLOR_SRGB> colors;
    triangles.reserve(mesh.triangleCount());
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const uint32_t* corner = &solid.indices[i];
        if (collapsed(corner)) continue;
        triangles.push_back({{corner[0], corner[1], corner[2]}});
        if (mesh.colors.empty()) continue;
        colors.emplace_back();
        for (std::size_t k = 0; k < 3; ++k)
            colors.back().m_Colors[k] = srgbOf(mesh.colors[mesh.indices[i + k]]);
    }
    Fingerprint content;
    content.add(std::span<const MODELMESHVERTEX>(vertices));
    content.add(std::span<const MODELMESHTRIANGLE>(triangles));
    content.add(std::span<const MODELMESH_TRIANGLECOLOR_SRGB>(colors));

    Calls calls;
    const Object model = emptyModel(calls);
    const std::string generator = generatorName();
    calls.check(lib3mf_model_setunit(model.get(), MODELUNIT_MILLIMETER), model);
    calls.check(lib3mf_model_addmetadatautf8(model.get(), "Application", generator.c_str()), model);
    calls.check(lib3mf_model_setbuilduuidutf8(model.get(), content.uuid(1).c_str()), model);
    if (!triangles.empty()) {
        const Object object = calls.make(lib3mf_model_addmeshobject, model);
        calls.check(lib3mf_object_setnameutf8(object.get(), name.c_str()), object);
        calls.check(lib3mf_object_setuuidutf8(object.get(), content.uuid(2).c_str()), object);
        calls.check(
            lib3mf_meshobject_setgeometry(object.get(), vertices.data(), static_cast<DWORD>(vertices.size()),
                                          triangles.data(), static_cast<DWORD>(triangles.size())),
            object);
        setColors(calls, model, object, mesh, colors, name);
        const Object item = calls.make(lib3mf_model_addbuilditem, model, object.get(), nullptr);
        calls.check(lib3mf_builditem_setuuidutf8(item.get(), content.uuid(3).c_str()), item);
    }

    const Object writer = calls.make(lib3mf_model_querywriter, model, "3mf");
    const auto goesOn = [](int, ProgressIdentifier, void* flag) {
        return !static_cast<const std::atomic<bool>*>(flag)->load(std::memory_order_relaxed);
    };
    const std::atomic<bool> never = false;
    void* flag = const_cast<std::atomic<bool>*>(cancel ? cancel : &never);
    calls.check(lib3mf_writer_setprogresscallback(writer.get(), goesOn, flag), writer);
    Archive archive;
    calls.check(lib3mf_writer_writetocallback(writer.get(), reinterpret_cast<void*>(Archive::write),
                                              reinterpret_cast<void*>(Archive::seek), &archive),
                writer);
    file.write(archive.bytes);
    return cancel && *cancel ? std::string() : calls.failure;
}

}  // namespace fw
