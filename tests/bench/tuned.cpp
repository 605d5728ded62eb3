#include "tests/bench/tuned.h"

#include <bit>
#include <chrono>
#include <cstring>
#ifdef __AVX2__
#include <immintrin.h>
#endif

#include "tests/bench/case_table.h"
#include "tests/bench/two_threads.h"

namespace fw::bench {
namespace {

constexpr std::size_t kMostTriangles = 5;  // of a cell
constexpr float kQuarterTurn = 1.57079632679489662f;

/// The benchmark's gyroid with sines alone: the compiler makes calls for eight values at once of them, and of
/// a sine and a cosine of the same angle it does not.
struct GyroidOfSines {
    static float at(float x, float y, float z) {
        const float k = 12;
        const float g = std::sin(k * x) * std::sin(k * y + kQuarterTurn) +
                        std::sin(k * y) * std::sin(k * z + kQuarterTurn) +
                        std::sin(k * z) * std::sin(k * x + kQuarterTurn);
        return std::max(std::abs(g) / k - 0.03f, std::sqrt(x * x + y * y + z * z) - 1);
    }
};

/// The edges' numbers, three a triangle: axis * 4 + the end's place along the two others.
struct Pattern {
    uint8_t count = 0;
    std::array<uint8_t, 3 * kMostTriangles> edges{};
};

std::array<Pattern, 256> patterns() {
    std::array<Pattern, 256> all;
    for (std::size_t pattern = 0; pattern < 256; pattern++)
        for (const CaseEdge& edge : caseTable()[pattern]) {
            const int across = edge.axis == 0   ? edge.y | edge.z << 1
                               : edge.axis == 1 ? edge.x | edge.z << 1
                                                : edge.x | edge.y << 1;
            all[pattern].edges[all[pattern].count++] = uint8_t(edge.axis * 4 + across);
        }
    return all;
}

/// 64 signs from the sample at x, a multiple of 32.
uint64_t signsAt(const uint8_t* row, std::size_t x) {
    uint64_t bits;
    std::memcpy(&bits, row + x / 8, 8);
    return bits;
}

template <class T>
void makeRoom(std::vector<T>& list, std::size_t used, std::size_t more) {
    if (list.size() < used + more) list.resize(2 * list.size() + used + more);
}

/// The bits of x in [from, from + 32) that are of [0, end).
uint64_t within(std::size_t from, std::size_t end) {
    return end - from >= 32 ? 0xffffffffu : (uint64_t(1) << (end - from)) - 1;
}

}  // namespace

Tuned::Tuned(int cellsAlong)
    : cells(std::size_t(cellsAlong)), side(cells + 1), rowBytes((side + 63) / 32 * 4 + 8), xs(side) {
    for (Half& half : halves) {
        for (int i = 0; i < 2; i++) {
            half.samples[i].resize(side * side + 8);
            half.signs[i].resize(side * rowBytes);
        }
        half.lookup.resize(5 * side * side);
    }
}

template <class F>
void Tuned::samplePlane(Half& half, std::size_t z) const {
    float* plane = half.samples[z % 2].data();
    const float atZ = origin + float(z) * spacing;
    const float* at = xs.data();
    for (std::size_t y = 0; y < side; y++) {
        float* row = plane + y * side;
        const float atY = origin + float(y) * spacing;
        for (std::size_t x = 0; x < side; x++) row[x] = F::at(at[x], atY, atZ);
        uint8_t* signs = half.signs[z % 2].data() + y * rowBytes;
        for (std::size_t x = 0; x < side; x += 8) {
#ifdef __AVX2__
            const __m256 zero = _mm256_setzero_ps();
            uint32_t bits =
                uint32_t(_mm256_movemask_ps(_mm256_cmp_ps(_mm256_loadu_ps(row + x), zero, _CMP_LT_OQ)));
#else
            uint32_t bits = 0;
            for (int i = 0; i < 8; i++) bits |= uint32_t(row[x + i] < 0) << i;
#endif
            if (side - x < 8) bits &= (1u << (side - x)) - 1;
            signs[x / 8] = uint8_t(bits);
        }
    }
}

void Tuned::placeInPlane(Half& half, std::size_t z) const {
    const float* plane = half.samples[z % 2].data();
    const uint8_t* signs = half.signs[z % 2].data();
    uint32_t* alongX = half.lookup.data() + z % 2 * 2 * side * side;
    uint32_t* alongY = alongX + side * side;
    const float atZ = origin + float(z) * spacing;
    for (std::size_t y = 0; y < side; y++) {
        makeRoom(half.vertices, half.vertexCount, 2 * side);
        glm::vec3* out = half.vertices.data();
        std::size_t count = half.vertexCount;
        const float* row = plane + y * side;
        const float atY = origin + float(y) * spacing;
        for (std::size_t from = 0; from < side; from += 32) {
            const uint64_t own = signsAt(signs + y * rowBytes, from);
            for (uint64_t edges = (own ^ own >> 1) & within(from, cells); edges; edges &= edges - 1) {
                const std::size_t x = from + std::size_t(std::countr_zero(edges));
                const float f = row[x], end = row[x + 1];
                alongX[y * side + x] = uint32_t(count);
                out[count++] = {origin + (float(x) + f / (f - end)) * spacing, atY, atZ};
            }
            if (y == cells) continue;
            const uint64_t next = signsAt(signs + (y + 1) * rowBytes, from);
            for (uint64_t edges = (own ^ next) & within(from, side); edges; edges &= edges - 1) {
                const std::size_t x = from + std::size_t(std::countr_zero(edges));
                const float f = row[x], end = row[x + side];
                alongY[y * side + x] = uint32_t(count);
                out[count++] = {xs[x], origin + (float(y) + f / (f - end)) * spacing, atZ};
            }
        }
        half.vertexCount = count;
    }
}

void Tuned::placeBetween(Half& half, std::size_t z) const {
    const float* below = half.samples[z % 2].data();
    const float* above = half.samples[(z + 1) % 2].data();
    uint32_t* alongZ = half.lookup.data() + 4 * side * side;
    for (std::size_t y = 0; y < side; y++) {
        makeRoom(half.vertices, half.vertexCount, side);
        glm::vec3* out = half.vertices.data();
        std::size_t count = half.vertexCount;
        const float atY = origin + float(y) * spacing;
        for (std::size_t from = 0; from < side; from += 32) {
            const uint64_t a = signsAt(half.signs[z % 2].data() + y * rowBytes, from),
                           b = signsAt(half.signs[(z + 1) % 2].data() + y * rowBytes, from);
            for (uint64_t edges = (a ^ b) & within(from, side); edges; edges &= edges - 1) {
                const std::size_t x = from + std::size_t(std::countr_zero(edges)), i = y * side + x;
                const float f = below[i], end = above[i];
                alongZ[i] = uint32_t(count);
                out[count++] = {xs[x], atY, origin + (float(z) + f / (f - end)) * spacing};
            }
        }
        half.vertexCount = count;
    }
}

void Tuned::writeLayer(Half& half, std::size_t z) const {
    static const std::array<Pattern, 256> kPatterns = patterns();
    const std::size_t area = side * side, low = z % 2 * 2 * area, high = (z + 1) % 2 * 2 * area;
    const std::size_t place[12] = {
        low,         low + side,      high,     high + side,  low + area,      low + area + 1,
        high + area, high + area + 1, 4 * area, 4 * area + 1, 4 * area + side, 4 * area + side + 1};
    for (std::size_t y = 0; y < cells; y++) {
        makeRoom(half.corners, half.cornerCount, cells * 3 * kMostTriangles);
        uint32_t* out = half.corners.data() + half.cornerCount;
        const uint8_t* a = half.signs[z % 2].data() + y * rowBytes;
        const uint8_t* b = half.signs[(z + 1) % 2].data() + y * rowBytes;
        for (std::size_t from = 0; from < cells; from += 32) {
            const uint64_t s0 = signsAt(a, from), s1 = signsAt(a + rowBytes, from), s2 = signsAt(b, from),
                           s3 = signsAt(b + rowBytes, from);
            const uint64_t some = s0 | s1 | s2 | s3, all = s0 & s1 & s2 & s3;
            uint64_t active = (some | some >> 1) & ~(all & all >> 1) & within(from, cells);
            for (; active; active &= active - 1) {
                const int bit = std::countr_zero(active);
                const std::size_t pattern =
                    (s0 >> bit & 3) | (s1 >> bit & 3) << 2 | (s2 >> bit & 3) << 4 | (s3 >> bit & 3) << 6;
                const uint32_t* cell = half.lookup.data() + y * side + from + std::size_t(bit);
                const Pattern& row = kPatterns[pattern];
                for (int i = 0; i < row.count; i++) out[i] = cell[place[row.edges[i]]];
                out += row.count;
            }
        }
        half.cornerCount = std::size_t(out - half.corners.data());
    }
}

template <class F>
void Tuned::meshHalf(Half& half, std::size_t firstZ, std::size_t lastZ) const {
    half.vertexCount = half.cornerCount = 0;
    samplePlane<F>(half, firstZ);
    placeInPlane(half, firstZ);
    half.borrowed = firstZ > 0 ? half.vertexCount : 0;
    for (std::size_t z = firstZ; z < lastZ; z++) {
        samplePlane<F>(half, z + 1);
        placeBetween(half, z);
        placeInPlane(half, z + 1);  // last: what the other half has first comes to stand at the end
        writeLayer(half, z);
    }
}

double Tuned::run(Field field) {
    const auto start = std::chrono::steady_clock::now();
    origin = -regionHalf(field);
    spacing = 2 * regionHalf(field) / float(cells);
    for (std::size_t x = 0; x < side; x++) xs[x] = origin + float(x) * spacing;
    const std::size_t split[3] = {0, cells / 2, cells};
    const auto mesh = [&]<class F>(F) {
        onTwoThreads([&](int t) { meshHalf<F>(halves[std::size_t(t)], split[t], split[t + 1]); });
    };
    if (field == Field::gyroid)
        mesh(GyroidOfSines{});
    else
        withField(field, mesh);

    const Half &first = halves[0], &second = halves[1];
    vertexCount = first.vertexCount + second.vertexCount - second.borrowed;
    cornerCount = first.cornerCount + second.cornerCount;
    if (vertices.size() < vertexCount) vertices.resize(vertexCount);
    if (corners.size() < cornerCount) corners.resize(cornerCount);
    const uint32_t base = uint32_t(first.vertexCount - second.borrowed);
    onTwoThreads([&](int t) {
        const Half& half = halves[std::size_t(t)];
        const std::size_t skipped = t == 0 ? 0 : half.borrowed;
        std::memcpy(vertices.data() + (t == 0 ? 0 : first.vertexCount), half.vertices.data() + skipped,
                    (half.vertexCount - skipped) * sizeof(glm::vec3));
        uint32_t* out = corners.data() + (t == 0 ? 0 : first.cornerCount);
        for (std::size_t i = 0; i < half.cornerCount; i++) out[i] = half.corners[i] + (t == 0 ? 0 : base);
    });
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace fw::bench
