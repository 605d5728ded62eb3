// Counting sort by keys that are whole numbers below a bound, and the prefix sums that it is made of, for
// what lies in device memory: the corners of triangles by vertex, particles by cell.
//
// From Matt Swoboda's "Advanced Procedural Rendering in DirectX 11" (GDC 2012): count with atomics, which
// give each item its place among those of its key; sum the counts before each key; scatter. Deviations: the
// sums are those of a histopyramid of three levels (shaders/lib/histopyramid.glsl); and atomics give the
// items of a key in an order that may be another on each run, so that who needs the same order every time has
// it settled by the items' numbers.
//
// Lifetime: pipelines serve everything; buffers grow with what is sorted.
#pragma once

#include "runtime/gpu/commands.h"

namespace fw {

struct KeyCounting {
    Pipeline count, sum, top, place;
};
KeyCounting createKeyCounting(const Device& device);

struct CountingSort {
    KeyCounting counting;
    Pipeline scatter, settle;
};
CountingSort createCountingSort(const Device& device);

struct CountingSortBuffers {
    Buffer counts, starts;  ///< of each key: its items, and the first one's place
    Buffer ranks;           ///< of each item among those of its key
    Buffer sums;
    Buffer unsettled;
};

/// Records: `starts` gets the sum of `counts` before each of so many keys. `sums` is scratch memory; all
/// grow.
void sumCounts(Commands& commands, const KeyCounting& counting, Buffer& sums, const Buffer& counts,
               Buffer& starts, uint32_t keys);

/// Records: counts, starts and ranks of the items whose keys, all below `keys`, are given. Up to 2^32 - 1 of
/// each.
void countKeys(Commands& commands, const KeyCounting& counting, CountingSortBuffers& buffers,
               const Descriptor& keysOfItems, uint32_t items, uint32_t keys);

/// Records countKeys() and then: `order` gets the numbers of the items by key, and those of a key in their
/// order, unless there are more than SORT_MOST_SETTLED.
void sortByKey(Commands& commands, const CountingSort& sort, CountingSortBuffers& buffers,
               const Buffer& keysOfItems, Buffer& order, uint32_t items, uint32_t keys);

}  // namespace fw
