#include "tests/bench/baseline.h"

#include <chrono>

#include "tests/bench/case_table.h"
#include "tests/bench/two_threads.h"

namespace fw::bench {
namespace {

double now() {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

}  // namespace

Baseline::Baseline(int cells)
    : side(cells + 1), grid(new float[side * side * side]), lookup(new uint32_t[3 * side * side * side]) {}

template <class F>
void Baseline::sample(glm::vec3 origin, float spacing, std::size_t firstZ, std::size_t lastZ) {
    for (std::size_t z = firstZ; z < lastZ; z++) {
        for (std::size_t y = 0; y < side; y++) {
            float* row = &grid[(z * side + y) * side];
            for (std::size_t x = 0; x < side; x++) {
                row[x] = F::at(origin.x + float(x) * spacing, origin.y + float(y) * spacing,
                               origin.z + float(z) * spacing);
            }
        }
    }
}

void Baseline::classify(glm::vec3 origin, float spacing, std::size_t firstZ, std::size_t lastZ, Slab& slab) {
    const auto& table = caseTable();
    const std::size_t strides[3] = {1, side, side * side};
    slab.vertices.clear();
    slab.cells.clear();
    slab.triangles = 0;
    for (std::size_t z = firstZ; z < lastZ; z++) {
        for (std::size_t y = 0; y < side; y++) {
            const std::size_t row = (z * side + y) * side;
            for (std::size_t x = 0; x < side; x++) {
                const std::size_t at[3] = {x, y, z};
                const float* f = &grid[row + x];
                const bool inside = f[0] < 0;
                for (int axis = 0; axis < 3; axis++) {
                    if (at[axis] + 1 == side) continue;
                    const float end = f[strides[axis]];
                    if (inside == (end < 0)) continue;
                    glm::vec3 p = origin + glm::vec3(x, y, z) * spacing;
                    p[axis] += spacing * (f[0] / (f[0] - end));
                    lookup[3 * (row + x) + axis] = uint32_t(slab.vertices.size());
                    slab.vertices.push_back(p);
                }
            }
            if (y + 1 == side || z + 1 == side) continue;
            // The four samples on a cell's right side are those on the left side of the next cell.
            auto sideBits = [&](std::size_t x) {
                const float* f = &grid[row + x];
                return int(f[0] < 0) | int(f[strides[1]] < 0) << 2 | int(f[strides[2]] < 0) << 4 |
                       int(f[strides[1] + strides[2]] < 0) << 6;
            };
            int left = sideBits(0);
            for (std::size_t x = 0; x + 1 < side; x++) {
                const int right = sideBits(x + 1);
                const int code = left | right << 1;
                left = right;
                if (code == 0 || code == 255) continue;
                slab.cells.push_back({uint32_t(y * side + x), uint16_t(z), uint8_t(code)});
                slab.triangles += table[code].count / 3;
            }
        }
    }
}

void Baseline::writeIndices(const Slab& slab, std::size_t firstTriangle) {
    const auto& table = caseTable();
    const std::size_t strides[3] = {1, side, side * side};
    // The second thread counted its vertices from 0; those of the first come before them.
    const std::size_t secondSlab = side / 2;
    const uint32_t base[2] = {0, uint32_t(slabs[0].vertices.size())};
    uint32_t* out = corners.data() + 3 * firstTriangle;
    for (const ActiveCell& cell : slab.cells) {
        const std::size_t point = cell.z * side * side + cell.point;
        for (CaseEdge edge : table[cell.code]) {
            const std::size_t start = point + edge.x * strides[0] + edge.y * strides[1] + edge.z * strides[2];
            *out++ = lookup[3 * start + edge.axis] + base[cell.z + edge.z >= secondSlab];
        }
    }
}

BaselineTimes Baseline::run(Field field) {
    const std::size_t split[3] = {0, side / 2, side};
    const glm::vec3 origin(-regionHalf(field));
    const float spacing = 2 * regionHalf(field) / float(side - 1);
    BaselineTimes times;
    const double start = now();

    withField(field, [&](auto f) {
        onTwoThreads([&](int t) { sample<decltype(f)>(origin, spacing, split[t], split[t + 1]); });
    });
    const double sampled = now();

    onTwoThreads([&](int t) { classify(origin, spacing, split[t], split[t + 1], slabs[t]); });
    const double classified = now();

    vertices.resize(slabs[0].vertices.size() + slabs[1].vertices.size());
    corners.resize(3 * (slabs[0].triangles + slabs[1].triangles));
    onTwoThreads([&](int t) {
        std::copy(slabs[t].vertices.begin(), slabs[t].vertices.end(),
                  vertices.begin() + (t == 0 ? 0 : slabs[0].vertices.size()));
        writeIndices(slabs[t], t == 0 ? 0 : slabs[0].triangles);
    });
    const double written = now();

    times.sampleMs = sampled - start;
    times.vertexMs = classified - sampled;
    times.indexMs = written - classified;
    return times;
}

}  // namespace fw::bench
