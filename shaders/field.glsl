// The field that a shader samples. This default is the reference tower of docs/benchmarks.md, so that every
// shader compiles alone; at run time text generated from a graph (graph/emit/glsl.cpp) answers this #include instead.
//
// A shader asks for what it needs by defining, before the include, any of
//   FIELD_VALUE     float fieldValue(vec3 p)                    distance: < 0 inside, >= 0 outside
//   FIELD_GRADIENT  vec4 fieldGradient(vec3 p)                  xyz = gradient, w = value
//   FIELD_INTERVAL  vec2 fieldInterval(vec3 lo, vec3 hi)        (least, greatest) bound of the value over a box
//   FIELD_ROWS      FieldPlane fieldPlane(float at); FieldRow fieldRow(FieldPlane plane, float at);
//                   float fieldAt(FieldRow row, float at)       the value, from positions along z, x and y, with what does
//                   not depend on y hoisted; along z, y and x where FIELD_ALONG is 0, along x, y and z where it is 2
//   FIELD_PRUNED    with some of the above: of the members of families (graph/ir/families.h) those alone are evaluated that are
//                   listed for a place, which bool fieldChoose(uint place) sets: false if it is known to hold no surface
//   FIELD_PRUNE     with FIELD_PRUNED and FIELD_INTERVAL: void fieldPrune(vec3 lo, vec3 hi, uint place), which writes the
//                   place's lists, out of those chosen; the shader declares uint fieldAllocate(uint entries) and
//                   bool fieldMayHold(vec2 f), whether an interval lets the place hold surface, before
//   FIELD_MATERIAL  FieldMaterial fieldMaterial(vec3 p)
//   FIELD_OPAQUE    with FIELD_MATERIAL: float fieldOpaque(vec3 p), vec4 fieldOpaqueGradient(vec3 p) and FieldMaterial
//                   fieldOpaqueMaterial(vec3 p), the same of the part through which no light passes; only if FIELD_TRANSMITS
//                   is defined then, for else all of it is opaque; and FIELD_MEDIA, if what it passes through is not the
//                   same everywhere
// If the field has families, FIELD_FAMILIES is their number, and rows are FieldColumn fieldColumn(FieldRow row, float at[9]);
// float fieldAt(FieldRow row, FieldColumn column, uint k, float at), where at is at[k].
// A shader, with any of them, calls fieldBegin() first in main: it loads the live parameters once per invocation.
//   FIELD_BEFORE    fieldBeginBefore(), which loads those of the frame before in their place; only if FIELD_MOVES is defined then,
//                   for else there are none
// Live parameters stand in the storage buffer at binding FIELD_PARAMETERS (15), those of the frame before at FIELD_PARAMETERS_BEFORE (26), images in the one at
// FIELD_IMAGES (14), those of volumes at FIELD_VOLUMES (16), each only if the field has some; the families' tables follow the live parameters. With FIELD_PRUNED and families the tables are also at FIELD_TABLES (9), the lists
// at FIELD_LISTS (11), and where each place has its own at FIELD_HEADS (12).

struct FieldMaterial {
    vec3 baseColor;
    float roughness;
    float metallic;
    vec3 emission;
    float transmission;
    float ior;
    vec3 absorption;  // 1/m
};

void fieldBegin() {}

#ifdef FIELD_PRUNED
bool fieldChoose(uint place) { return true; }
#endif

#ifdef FIELD_VALUE
float fieldBox(vec3 p, vec3 h) {
    vec3 a = abs(p) - h;
    return max(a.x, max(a.y, a.z));
}
float fieldValue(vec3 p) {
    float d = fieldBox(p, vec3(1, 2, 1));
    vec3 c = abs(mod(p, vec3(0.5)) - 0.25) - 0.15;
    d = max(d, -min(max(c.x, c.y), min(max(c.y, c.z), max(c.x, c.z))));
    return max(d, -fieldBox(mod(p + vec3(0, 0.25, 0), vec3(1.0)) - 0.5, vec3(0.45, 0.2, 0.45)));
}
#endif

#ifdef FIELD_GRADIENT
// Distance with its gradient, forward mode, of each intermediate result.
vec4 fieldMax(vec4 a, vec4 b) { return a.w >= b.w ? a : b; }
vec4 fieldMin(vec4 a, vec4 b) { return a.w <= b.w ? a : b; }
vec4 fieldAbsOffset(float x, vec3 axis, float offset) { return vec4(x < 0.0 ? -axis : axis, abs(x) - offset); }
vec4 fieldGradient(vec3 p) {
    const vec3 X = vec3(1, 0, 0), Y = vec3(0, 1, 0), Z = vec3(0, 0, 1);
    vec4 d = fieldMax(fieldAbsOffset(p.x, X, 1.0), fieldMax(fieldAbsOffset(p.y, Y, 2.0), fieldAbsOffset(p.z, Z, 1.0)));
    vec3 m = mod(p, vec3(0.5)) - 0.25;
    vec4 a = fieldAbsOffset(m.x, X, 0.15), b = fieldAbsOffset(m.y, Y, 0.15), c = fieldAbsOffset(m.z, Z, 0.15);
    d = fieldMax(d, -fieldMin(fieldMax(a, b), fieldMin(fieldMax(b, c), fieldMax(a, c))));
    m = mod(p + vec3(0, 0.25, 0), vec3(1.0)) - 0.5;
    a = fieldAbsOffset(m.x, X, 0.45), b = fieldAbsOffset(m.y, Y, 0.2), c = fieldAbsOffset(m.z, Z, 0.45);
    return fieldMax(d, -fieldMax(a, fieldMax(b, c)));
}
#endif

#ifdef FIELD_INTERVAL
vec2 fieldAbsInterval(vec2 a) { return vec2(max(0.0, max(a.x, -a.y)), max(-a.x, a.y)); }
vec2 fieldModInterval(vec2 a, float m) {
    float k = floor(a.x / m);
    return floor(a.y / m) == k ? a - k * m : vec2(0, m);
}
vec2 fieldBoxInterval(vec2 x, vec2 y, vec2 z, vec3 h) {
    return max(fieldAbsInterval(x) - h.x, max(fieldAbsInterval(y) - h.y, fieldAbsInterval(z) - h.z));
}
vec2 fieldInterval(vec3 lo, vec3 hi) {
    vec2 x = vec2(lo.x, hi.x), y = vec2(lo.y, hi.y), z = vec2(lo.z, hi.z);
    vec2 d = fieldBoxInterval(x, y, z, vec3(1, 2, 1));
    vec2 cx = fieldAbsInterval(fieldModInterval(x, 0.5) - 0.25) - 0.15;
    vec2 cy = fieldAbsInterval(fieldModInterval(y, 0.5) - 0.25) - 0.15;
    vec2 cz = fieldAbsInterval(fieldModInterval(z, 0.5) - 0.25) - 0.15;
    d = max(d, -min(max(cx, cy), min(max(cy, cz), max(cx, cz))).yx);
    d = max(d, -fieldBoxInterval(fieldModInterval(x, 1.0) - 0.5, fieldModInterval(y + 0.25, 1.0) - 0.5,
                                 fieldModInterval(z, 1.0) - 0.5, vec3(0.45, 0.2, 0.45)).yx);
    return d + vec2(-1e-5, 1e-5);
}
#endif

#ifdef FIELD_ROWS
struct FieldPlane {
    float box, tube, floors;
};
struct FieldRow {
    float box, tubeMin, tubeMax, floors;
};
FieldPlane fieldPlane(float z) {
    return FieldPlane(abs(z) - 1.0, abs(mod(z, 0.5) - 0.25) - 0.15, abs(mod(z, 1.0) - 0.5) - 0.45);
}
FieldRow fieldRow(FieldPlane plane, float x) {
    float tube = abs(mod(x, 0.5) - 0.25) - 0.15;
    return FieldRow(max(abs(x) - 1.0, plane.box), min(tube, plane.tube), max(tube, plane.tube),
                    max(abs(mod(x, 1.0) - 0.5) - 0.45, plane.floors));
}
float fieldAt(FieldRow row, float y) {
    float tube = abs(mod(y, 0.5) - 0.25) - 0.15;
    float d = max(row.box, abs(y) - 2.0);
    d = max(d, -min(row.tubeMax, max(tube, row.tubeMin)));
    return max(d, -max(row.floors, abs(mod(y + 0.25, 1.0) - 0.5) - 0.2));
}
#endif

#ifdef FIELD_MATERIAL
FieldMaterial fieldMaterial(vec3 p) { return FieldMaterial(vec3(0.8), 0.5, 0.0, vec3(0.0), 0.0, 1.5, vec3(0.0)); }
#endif
