#include "runtime/measure/lib3mf_calls.h"
#include "runtime/measure/readers.h"

namespace fw {

using namespace lib3mf;

Result<WeldedMesh> read3mf(const Bytes& bytes, const Fault& fault) {
    if (bytes.empty()) return fault("not a 3MF: it is empty");
    Calls calls;
    const Object model = emptyModel(calls), reader = calls.make(lib3mf_model_queryreader, model, "3mf");
    calls.check(lib3mf_reader_setstrictmodeactive(reader.get(), 1), reader);
    calls.check(lib3mf_reader_readfrombuffer(reader.get(), const_cast<BYTE*>(bytes.data()), bytes.size()),
                reader);
    DWORD unit = 0;
    calls.check(lib3mf_model_getunit(model.get(), &unit), model);
    if (!calls.failure.empty()) return fault("not a 3MF as it should be: " + calls.failure);
    constexpr double kMetres[] = {1e-6, 1e-3, 1e-2, 0.0254, 0.3048, 1.0};  // in the order of eModelUnit
    if (unit >= std::size(kMetres)) return fault("it is in an unknown unit");

    Welder welder(1024);
    WeldedMesh mesh;
    const Object items = calls.make(lib3mf_model_getbuilditems, model);
    BOOL more = 0;
    while (calls.check(lib3mf_builditemiterator_movenext(items.get(), &more), items) && more) {
        const Object item = calls.make(lib3mf_builditemiterator_getcurrent, items);
        const Object object = calls.make(lib3mf_builditem_getobjectresource, item);
        BOOL moved = 0, solid = 0;
        calls.check(lib3mf_builditem_hasobjecttransform(item.get(), &moved), item);
        if (moved) return fault("items with transforms are not read back");
        calls.check(lib3mf_object_ismeshobject(object.get(), &solid), object);
        if (!solid) return fault("objects made of components are not read back");
        DWORD count = 0, triangleCount = 0;
        calls.check(lib3mf_meshobject_getvertexcount(object.get(), &count), object);
        calls.check(lib3mf_meshobject_gettrianglecount(object.get(), &triangleCount), object);
        std::vector<MODELMESHVERTEX> vertices(count);
        std::vector<MODELMESHTRIANGLE> triangles(triangleCount);
        calls.check(lib3mf_meshobject_getvertices(object.get(), vertices.data(), count, nullptr), object);
        calls.check(
            lib3mf_meshobject_gettriangleindices(object.get(), triangles.data(), triangleCount, nullptr),
            object);
        if (!calls.failure.empty()) break;
        std::vector<uint32_t> numbers;
        for (const MODELMESHVERTEX& v : vertices) {
            const glm::vec3 p(glm::dvec3(v.m_fPosition[0], v.m_fPosition[1], v.m_fPosition[2]) *
                              kMetres[unit]);
            if (!finite(p)) return fault("a vertex is not finite");
            numbers.push_back(welder.add(p));
        }
        for (const MODELMESHTRIANGLE& triangle : triangles)
            for (const DWORD index : triangle.m_nIndices) {
                if (index >= numbers.size()) return fault("a triangle names a vertex that is not there");
                mesh.indices.push_back(numbers[index]);
            }
    }
    if (!calls.failure.empty()) return fault(calls.failure);
    mesh.positions = welder.take();
    return mesh;
}

}  // namespace fw
