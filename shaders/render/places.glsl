// The field as pictures ask for it, at any place: of its families' members (graph/ir/families.h) those alone that can matter there.
// For that the space in and about the region is parted into a grid of RENDER_PLACES boxes along each axis. places.comp makes
// their lists, out of those of grids of half as many boxes, and so on; a place is numbered with its grid. Coordinates are from
// the region's middle, in halves of its sides. In place of field.glsl, and after render.h.
#define FIELD_PRUNED
#include "field.glsl"

const float kReach = 1.5;  // of the grid: shadows and ambient occlusion fall beside the solid

// The least corner of a box; the one above it has the greatest.
vec3 cornerOfPlace(uvec3 box, uint side) { return kReach * (2.0 * vec3(box) / float(side) - 1.0); }

uint placeOfBox(uvec3 box, uint side) {
    uint least = RENDER_LEAST_PLACES, before = (side * side * side - least * least * least) / 7;  // of the coarser grids
    return 1 + before + (box.z * side + box.y) * side + box.x;
}

// Whether there are lists for a place. Where not, the region's distance is enough to go by.
bool withinPlaces(vec3 at) {
#ifdef FIELD_FAMILIES
    return all(lessThan(abs(at), vec3(kReach)));
#else
    return true;
#endif
}

// For the next evaluation, which is of use withinPlaces().
void chooseMembers(vec3 at) {
#ifdef FIELD_FAMILIES
    vec3 through = clamp(0.5 + 0.5 / kReach * at, 0.0, 0.9999);
    fieldChoose(placeOfBox(uvec3(through * RENDER_PLACES), RENDER_PLACES));
#endif
}
