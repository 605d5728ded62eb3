// What the kernels of runtime/gpu/counting_sort.h share with C++. After shared.h.
#ifndef FW_SORT_H
#define FW_SORT_H
#ifdef __cplusplus
namespace fw::gpu {
#endif

#define SORT_GROUP 256          // items of a work group
#define SORT_SUM_LANES 256      // of a work group that sums counts,
#define SORT_SUM_EACH 16        // and counts of a lane
#define SORT_MOST_SETTLED 2048  // items of a key that are put in order

struct SortPush {
    uint items;  // that are sorted
    uint keys;   // all are below
};

#ifdef __cplusplus
}  // namespace fw::gpu
#endif
#endif
