// What the kernels of runtime/bake/mesh_field_baker.h share with C++. After shared.h.
#ifndef FW_BAKE_H
#define FW_BAKE_H
#ifdef __cplusplus
namespace fw::gpu {
#endif

#define BAKE_GROUP 64        // items of a work group
#define BAKE_ROWS 8          // slices, and rows of each, that one item of scatter.comp goes through at most
#define BAKE_BAND 2.0        // cells from the surface: kBand
#define BAKE_UNREACHED 1e30  // the first coordinate of a nearest point that is not known
#define BAKE_INSIDE 0x80000000u  // with a triangle's number: the sample is inside
#define BAKE_LEAST 1e-4          // kLeastDistance

// A triangle, and the rows that one lane measures it in.
struct BakeItem {
    uint triangle;
    uint rows;  // the first row and slice, 16 bits each
};

struct BakePush {
    ivec3 size;  // samples
    uint items;
    float cell;  // metres
    int axis;    // of a sweep,
    int slice;   // where it is,
    int step;    // and its way: 1 or -1
    uint signs;  // 1: normals tell what is inside
};

// What the kernels find, beside the samples.
struct BakeCounts {
    uint listed;          // samples of the band
    uint groups[3];       // work groups for them
    uint contradictions;  // not 0 where neighbours have unlike signs without the surface between them
};

#ifdef __cplusplus
}  // namespace fw::gpu
#endif
#endif
