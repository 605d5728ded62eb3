// Implicit 3MF files for tests to read.
#pragma once

#include <string>
#include <vector>

#include "graph/implicit3mf/package.h"

namespace fw::test {

/// A model's text. The bounds are a box of 2000 about the origin, as the object 1.
inline std::string modelText(const std::string& resources, const std::string& build,
                             const std::string& attributes = "unit=\"millimeter\"") {
    std::string corners;
    for (int i = 0; i < 8; ++i)
        corners += "<vertex x='" + std::to_string(i & 1 ? 1000 : -1000) + "' y='" +
                   std::to_string(i & 2 ? 1000 : -1000) + "' z='" + std::to_string(i & 4 ? 1000 : -1000) +
                   "'/>";
    const char* triangles =
        "<triangle v1='0' v2='2' v3='3'/><triangle v1='0' v2='3' v3='1'/><triangle v1='4' v2='5' v3='7'/>"
        "<triangle v1='4' v2='7' v3='6'/><triangle v1='0' v2='1' v3='5'/><triangle v1='0' v2='5' v3='4'/>"
        "<triangle v1='2' v2='6' v3='7'/><triangle v1='2' v2='7' v3='3'/><triangle v1='0' v2='4' v3='6'/>"
        "<triangle v1='0' v2='6' v3='2'/><triangle v1='1' v2='3' v3='7'/><triangle v1='1' v2='7' v3='5'/>";
    return "<?xml version='1.0'?>\n<model xmlns='http://schemas.microsoft.com/3dmanufacturing/core/2015/02' "
           "xmlns:v='http://schemas.3mf.io/3dmanufacturing/volumetric/2022/01' "
           "xmlns:i='http://schemas.3mf.io/3dmanufacturing/implicit/2023/12' " +
           attributes + "><resources><object id='1'><mesh><vertices>" + corners + "</vertices><triangles>" +
           triangles + "</triangles></mesh></object>" + resources + "</resources><build>" + build +
           "</build></model>";
}

/// A 3MF file of the model, and more parts.
inline std::string modelPackage(const std::string& model, std::vector<threemf::Part> more = {}) {
    more.insert(more.begin(), {"3D/3dmodel.model", model});
    return threemf::packed(more);
}

/// Function 5: the distance to a ball of radius 10 about the origin, as `shape`.
inline constexpr const char* kBallFunction =
    "<i:implicitfunction id='5' displayname='ball'><i:in><i:vector identifier='pos'/></i:in>"
    "<i:length identifier='l'><i:in><i:vectorref identifier='A' ref='inputs.pos'/></i:in>"
    "<i:out><i:scalar identifier='result'/></i:out></i:length>"
    "<i:constant identifier='r' value='10'><i:out><i:scalar identifier='value'/></i:out></i:constant>"
    "<i:subtraction identifier='s'><i:in><i:scalarref identifier='A' ref='l.result'/>"
    "<i:scalarref identifier='B' ref='r.value'/></i:in><i:out><i:scalar identifier='result'/></i:out>"
    "</i:subtraction><i:out><i:scalarref identifier='shape' ref='s.result'/></i:out></i:implicitfunction>";

/// Object 9: its level set.
inline constexpr const char* kLevelSet =
    "<object id='9'><v:levelset functionid='5' channel='shape' meshid='1' meshbboxonly='true'/></object>";

}  // namespace fw::test
