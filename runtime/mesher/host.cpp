#include "runtime/mesher/host.h"

#include <atomic>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <thread>

#include "runtime/mesh/octahedral.h"
#include "runtime/mesher/grid_edge.h"

namespace fw {

using gpu::MesherPush;
using gpu::MeshVertex;
using gpu::uvec2;
using gpu::uvec3;
using gpu::uvec4;

namespace {

constexpr int kMostNewtonSteps = 10;                                 // as in vertices.comp
constexpr double kTolerance = 0.02;                                  // ditto
constexpr std::size_t kBatch = TapeMachine<float>::kGradientPoints;  // of vertices
/// A tape that is not shorter than this part of the one before is not worth its memory.
constexpr double kWorthKeeping = 0.8;
/// Of all shortened tapes of a run together: about 256 MB.
constexpr int64_t kMostSteps = (256 << 20) / sizeof(TapeStep);

float samplePosition(const MesherPush& push, int axis, uint32_t i) {
    return push.origin[axis] + float(int(i) - 1) * push.cellSize[axis];
}

/// One edge's search for its root: t from a to b, as in vertices.comp.
struct Search {
    double a = 0, b = 1, t = 0.5, root = 0.5;
    bool found = false;

    void step(double f, double slope, bool insideAtA, bool lastStep) {
        (((f < 0) == insideAtA) ? a : b) = t;
        const double newton = f == 0 ? t : t - f / slope;
        root = newton >= a && newton <= b ? newton : 0.5 * (a + b);
        found = lastStep || std::abs(f) <= kTolerance * std::abs(slope);
        if (!found) t = root;
    }
};

}  // namespace

MesherHost::MesherHost(const Ir& ir, IrId root, const std::vector<double>& parameters,
                       std::span<const IrId> color_)
    : field(std::make_shared<Tape>(makeTape(ir, root, parameters))),
      color(color_.empty() ? Tape{} : makeTape(ir, color_, parameters)),
      machines(std::max(1u, std::thread::hardware_concurrency())) {}

void MesherHost::parallel(std::size_t count, const std::function<void(Machine&, std::size_t)>& work) {
    std::atomic<std::size_t> next = 0;
    const auto run = [&](Machine& machine) {
        for (std::size_t i; (i = next++) < count;) work(machine, i);
    };
    std::vector<std::jthread> threads;
    for (std::size_t i = 1; i < machines.size(); ++i) threads.emplace_back(run, std::ref(machines[i]));
    run(machines[0]);
}

void MesherHost::descend(Machine& machine, const MesherPush& push, uvec3 first, uint32_t size,
                         const SharedTape& tape, Block& block) {
    const uvec3 last = first + size;
    if (glm::any(glm::greaterThanEqual(first, glm::min(push.cells + 2u, push.end * 8u + 8u))) ||
        glm::any(glm::lessThanEqual(last, push.first * 8u)))
        return;
    Box box;
    bool atRim = false;
    for (int axis = 0; axis < 3; ++axis) {
        box.lo[axis] = samplePosition(push, axis, std::max(first[axis], 1u));
        box.hi[axis] = samplePosition(push, axis, std::min(last[axis], push.cells[axis] + 1));
        atRim = atRim || first[axis] == 0 || last[axis] > push.cells[axis] + 1;
    }
    const Interval f = machine.interval(*tape, box);
    if (f.lo >= push.margin || (f.hi < -push.margin && !atRim)) return;
    SharedTape own = tape;
    if (machine.shortens()) {
        // A margin is asked for where signs have not been enough.
        Tape shorter = push.margin > 0 ? machine.shortened(*tape) : machine.shortenedForSigns(*tape);
        const auto steps = int64_t(shorter.steps.size());
        if (double(steps) <= kWorthKeeping * double(tape->steps.size()) &&
            stepsLeft.fetch_sub(steps) >= steps)
            own = std::make_shared<Tape>(std::move(shorter));
    }
    if (size == 8) {
        const uvec3 local = (first - block.first) / 8u;
        block.bricks[local.x | local.y << 3 | local.z << 6] = own;
        return;
    }
    for (uint32_t child = 0; child < 8; ++child)
        descend(machine, push, first + uvec3(child & 1, child >> 1 & 1, child >> 2) * (size / 2), size / 2,
                own, block);
}

MesherHost::Culled MesherHost::cull(const MesherPush& push) {
    const std::size_t count = std::size_t(push.blocks.x) * push.blocks.y * push.blocks.z;
    blocks.assign(count, {});
    stepsLeft = kMostSteps;
    Culled result;
    result.rows.resize(count * 64);
    result.blockCounts.resize(count);
    parallel(count, [&](Machine& machine, std::size_t i) {
        const auto index = uint32_t(i);
        Block& block = blocks[i];
        block.first = (push.begin / 8u + uvec3(index % push.blocks.x, index / push.blocks.x % push.blocks.y,
                                               index / push.blocks.x / push.blocks.y)) *
                      64u;
        descend(machine, push, block.first, 64, field, block);
        uint32_t place = 0;
        for (std::size_t row = 0; row < 64; ++row) {
            uvec2& bits = result.rows[i * 64 + row] = {0, place};
            for (uint32_t x = 0; x < 8; ++x)
                if (block.bricks[row * 8 + x]) bits.x |= 1u << x, ++place;
        }
        result.blockCounts[i] = {place, 0, 0, 0};
    });
    return result;
}

const Tape& MesherHost::tapeOf(const MesherPush& push, uvec3 brick) const {
    const uvec3 block = (brick - push.begin) / 8u, local = brick % 8u;
    const Block& at = blocks[(block.z * push.blocks.y + block.y) * push.blocks.x + block.x];
    return *at.bricks[local.x | local.y << 3 | local.z << 6];
}

void MesherHost::samplePlanes(Machine& machine, const MesherPush& push, uvec3 brick, uvec3* planes) const {
    const Tape& tape = tapeOf(push, brick);
    const uvec3 first = brick * 8u;
    const auto within = [&](int axis, uint32_t i) {
        return first[axis] + i >= 1 && first[axis] + i <= push.cells[axis] + 1;
    };
    for (uint32_t i = 0; i < 81; ++i) {
        machine.position(0)[i] = samplePosition(push, 0, first.x + i / 9);
        machine.position(1)[i] = samplePosition(push, 1, first.y + i % 9);
    }
    // Which of the nine along an axis are within the grid.
    uint32_t inGrid[3] = {};
    for (int axis = 0; axis < 3; ++axis)
        for (uint32_t i = 0; i < 9; ++i) inGrid[axis] |= uint32_t(within(axis, i)) << i;
    for (uint32_t z = 0; z < 9; ++z) {
        std::fill_n(machine.position(2), 81, samplePosition(push, 2, first.z + z));
        const float* f = machine.value(tape, 81, z > 0);
        uvec3 bits(0);
        for (uint32_t x = 0; x < 9; ++x) {
            uint32_t row = 0;
            for (uint32_t y = 0; y < 9; ++y) row |= uint32_t(f[x * 9 + y] < 0) << y;
            if (!(inGrid[0] >> x & 1) || !(inGrid[2] >> z & 1)) row = 0;
            row &= inGrid[1];
            // sample.comp tells what the words hold.
            if (x < 8) bits[x / 4] |= (row & 255) << (x & 3) * 8;
            bits.z |= (x == 8 ? row : 0) | (row >> 8) << (9 + x);
        }
        planes[z] = bits;
    }
}

std::vector<uvec3> MesherHost::sample(const MesherPush& push, std::span<const uint32_t> brickList) {
    std::vector<uvec3> planes(brickList.size() * 9);
    parallel(brickList.size(), [&](Machine& machine, std::size_t slot) {
        samplePlanes(machine, push, unpackBrick(brickList[slot]), &planes[slot * 9]);
    });
    return planes;
}

void MesherHost::placeVertices(Machine& machine, const MesherPush& push, uvec3 brick,
                               std::span<const uint32_t> vertexList, std::span<const uint32_t> indices,
                               std::span<MeshVertex> result) const {
    struct Edge : GridEdge {
        glm::dvec3 p;
        double length;
    };
    const Tape& tape = tapeOf(push, brick);
    const std::size_t count = indices.size();
    std::array<Edge, kBatch> edges;
    std::array<Search, kBatch> searches;
    std::array<glm::dvec3, kBatch> gradients;
    std::array<uint8_t, kBatch> sought;  // those whose root is not found
    for (std::size_t i = 0; i < count; ++i) {
        Edge& edge = edges[i] = {unpackEdge(vertexList[indices[i]], brick), {}, 0.0};
        for (int axis = 0; axis < 3; ++axis) edge.p[axis] = samplePosition(push, axis, edge.start[axis]);
        edge.length = samplePosition(push, int(edge.axis), edge.start[edge.axis] + 1) - edge.p[edge.axis];
        sought[i] = uint8_t(i);
    }
    std::size_t left = count;
    for (int step = 1; left > 0; ++step) {
        for (std::size_t k = 0; k < left; ++k) {
            const std::size_t i = sought[k];
            glm::dvec3 at = edges[i].p;
            at[edges[i].axis] += searches[i].t * edges[i].length;
            for (int axis = 0; axis < 3; ++axis) machine.position(axis)[k] = float(at[axis]);
        }
        const auto [f, g] = machine.gradient(tape, left);
        std::size_t still = 0;
        for (std::size_t k = 0; k < left; ++k) {
            const std::size_t i = sought[k];
            const Edge& edge = edges[i];
            searches[i].step(f[k], g[edge.axis][k] * edge.length, edge.insideAtStart,
                             step == kMostNewtonSteps);
            if (searches[i].found)
                gradients[i] = {g[0][k], g[1][k], g[2][k]};
            else
                sought[still++] = uint8_t(i);
        }
        left = still;
    }
    const glm::dvec3 inset = glm::dvec3(push.cellSize) * double(push.nudge);
    for (std::size_t i = 0; i < count; ++i) {
        const Edge& edge = edges[i];
        const uint32_t axis = edge.axis;
        // On the region's boundary as vertices.comp places it.
        const bool atLow = edge.start[axis] == 0, atHigh = edge.start[axis] == push.cells[axis] + 1;
        glm::dvec3 position = edge.p, normal(0);
        if (atLow || atHigh) {
            for (int other = 0; other < 3; ++other)
                position[other] =
                    std::clamp(edge.p[other], samplePosition(push, other, 1) + inset[other],
                               samplePosition(push, other, push.cells[other] + 1) - inset[other]);
            position[axis] = samplePosition(push, int(axis), atLow ? 1 : push.cells[axis] + 1);
            normal[axis] = atLow ? -1 : 1;
        } else {
            position[axis] +=
                std::clamp(searches[i].root, double(push.nudge), 1 - double(push.nudge)) * edge.length;
            const double size = glm::length(gradients[i]);
            if (size > 0 && size < 1e30)
                normal = gradients[i] / size;
            else
                normal[axis] = 1;
        }
        result[indices[i]] = {glm::vec3(position), packOctahedral(normal)};
    }
}

std::vector<MeshVertex> MesherHost::vertices(const MesherPush& push, std::span<const uint32_t> brickList,
                                             std::span<const uint32_t> vertexList) {
    // Sorted by brick, so that a batch has one tape.
    std::vector<uint32_t> starts(brickList.size() + 1), order(vertexList.size());
    for (uint32_t word : vertexList) ++starts[slotOfEdge(word) + 1];
    for (std::size_t i = 1; i < starts.size(); ++i) starts[i] += starts[i - 1];
    std::vector<uint32_t> place(starts.begin(), starts.end() - 1);
    for (uint32_t i = 0; i < vertexList.size(); ++i) order[place[slotOfEdge(vertexList[i])]++] = i;

    std::vector<MeshVertex> result(vertexList.size());
    parallel(brickList.size(), [&](Machine& machine, std::size_t slot) {
        const std::span<const uint32_t> own(&order[0] + starts[slot], &order[0] + starts[slot + 1]);
        for (std::size_t at = 0; at < own.size(); at += kBatch)
            placeVertices(machine, push, unpackBrick(brickList[slot]), vertexList,
                          own.subspan(at, std::min(kBatch, own.size() - at)), result);
    });
    return result;
}

std::vector<glm::vec3> MesherHost::colors(std::span<const MeshVertex> at) {
    constexpr std::size_t kBatchOfColors = Machine::kPoints;
    std::vector<glm::vec3> result(at.size());
    parallel((at.size() + kBatchOfColors - 1) / kBatchOfColors, [&](Machine& machine, std::size_t batch) {
        const std::size_t first = batch * kBatchOfColors;
        const std::size_t count = std::min(kBatchOfColors, at.size() - first);
        for (std::size_t i = 0; i < count; ++i)
            for (int axis = 0; axis < 3; ++axis) machine.position(axis)[i] = at[first + i].position[axis];
        machine.value(color, count);
        for (int channel = 0; channel < 3; ++channel) {
            const float* values = machine.root(color, std::size_t(channel));
            for (std::size_t i = 0; i < count; ++i)
                result[first + i][channel] = glm::clamp(values[i], 0.0f, 1.0f);
        }
    });
    return result;
}

}  // namespace fw
