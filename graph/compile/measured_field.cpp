#include "graph/compile/measured_field.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>
#include <mutex>
#include <utility>

#include "graph/assets/grid_around.h"
#include "graph/assets/mesh_field.h"
#include "graph/base/hash.h"
#include "graph/base/parallel.h"
#include "graph/bounds/region.h"
#include "graph/compile/unbounded_node.h"

namespace fw {

namespace {

constexpr int kBlock = 8;         // samples along a side of what is looked at with one tape
constexpr double kReach = 4.0;    // cells around a block in which nearest points are looked for
constexpr int kSteps = 16;        // towards a nearest point
constexpr double kRefined = 8.0;  // cells from the surface, where points are sought after the sweeps too
constexpr int kRefiningSteps = 6;
constexpr float kCreased = 0.15f;    // between the direction to the nearest point and the distances' slope
constexpr double kOnSurface = 1e-3;  // cells
constexpr int kHalvings = 14;        // of a step between samples on both sides
constexpr double kLongest = 1.5;     // cells of a step at most

/// One measurement: fields of samples are in the grid's order.
class Measuring {
  public:
    Measuring(const Tape& tape_, const VolumeGrid& grid_)
        : tape(tape_),
          grid(grid_),
          values(grid.samples()),
          nearest{std::vector<float>(grid.samples(), kUnreached), std::vector<glm::vec3>(grid.samples()),
                  std::vector<uint32_t>(grid.samples(), 0)} {
        for (int axis = 0; axis < 3; ++axis) blocks[axis] = (grid.size[axis] + kBlock - 1) / kBlock;
    }

    FieldVolumePtr measure(double chamfer) {
        forEachBlock(&Measuring::sample);
        forEachBlock(&Measuring::seed);
        sweep(grid, nearest);
        forEachBlock(&Measuring::refine);
        sweep(grid, nearest);
        forEachBlock(&Measuring::refine);
        std::vector<float> distances(grid.samples());
        std::vector<glm::vec3> gradients(grid.samples());
        for (std::size_t i = 0; i < grid.samples(); ++i)
            nearest.distance[i] = std::copysign(nearest.distance[i], values[i]);
        forBlocks(std::size_t(grid.size.z), 1, [&](std::size_t z, std::size_t, std::size_t) {
            std::size_t index = grid.index(0, 0, int(z));
            for (int y = 0; y < grid.size.y; ++y)
                for (int x = 0; x < grid.size.x; ++x, ++index) {
                    gradients[index] = slopeAt({x, y, int(z)});
                    distances[index] = float(grid.cell * double(nearest.distance[index]));
                }
        });
        if (chamfer > 0.0) chamferEdges(grid, chamfer, nearest.point, distances, gradients);
        return std::make_shared<FieldVolume>(grid, distances, gradients);
    }

  private:
    /// What a block's samples are looked at with.
    struct Block {
        TapeMachine<double> machine;
        std::vector<Point> points;
        std::vector<double> found;
        std::vector<ValueGradient> gradients;
    };
    template <class Work>
    void forEachBlock(Work work) {
        forBlocks(std::size_t(blocks.z), 1, [&](std::size_t z, std::size_t, std::size_t) {
            Block block;
            for (int y = 0; y < blocks.y; ++y)
                for (int x = 0; x < blocks.x; ++x) {
                    const glm::ivec3 first = kBlock * glm::ivec3(x, y, int(z));
                    (this->*work)(block, first, glm::min(first + kBlock, grid.size));
                }
        });
    }
    /// The box of samples from `first` to before `end`, grown by so many cells.
    Box boxOf(const glm::ivec3& first, const glm::ivec3& end, double by) const {
        const glm::dvec3 lo = grid.place(first) - by * grid.cell, hi = grid.place(end - 1) + by * grid.cell;
        return {{lo.x, lo.y, lo.z}, {hi.x, hi.y, hi.z}};
    }
    template <class Visit>
    void eachOf(const glm::ivec3& first, const glm::ivec3& end, const Visit& visit) const {
        for (int z = first.z; z < end.z; ++z)
            for (int y = first.y; y < end.y; ++y)
                for (int x = first.x; x < end.x; ++x) visit(glm::ivec3(x, y, z), grid.index(x, y, z));
    }

    /// The field's values, or their sign where that is known without.
    void sample(Block& block, glm::ivec3 first, glm::ivec3 end) {
        const Interval range = block.machine.interval(tape, boxOf(first, end, 0.0));
        if (range.lo > 0.0 || range.hi < 0.0) {
            eachOf(first, end, [&](const glm::ivec3&, std::size_t index) {
                values[index] = range.lo > 0.0 ? kUnreached : -kUnreached;
            });
            return;
        }
        const Tape own = block.machine.shortened(tape);
        block.points.clear();
        eachOf(first, end, [&](const glm::ivec3& at, std::size_t) { block.points.push_back(pointOf(at)); });
        block.found.resize(block.points.size());
        block.machine.evaluate(own, block.points, block.found);
        std::size_t next = 0;
        eachOf(first, end,
               [&](const glm::ivec3&, std::size_t index) { values[index] = float(block.found[next++]); });
    }

    /// Where two sides of the surface are as near, samples lie on one or the other side of a crease, whose
    /// edge would be jagged with the slopes of either.
    glm::vec3 slopeAt(const glm::ivec3& at) const {
        const glm::vec3 own = awayFromSurface(grid, nearest, at, float(kRefined)),
                        between = awayFromSurface(grid, nearest, at, 0.0f);
        return glm::length(own - between) < kCreased ? own : between;
    }

    Tape shortenedFor(Block& block, const Box& box) const {
        block.machine.interval(tape, box);
        return block.machine.shortened(tape);
    }
    Point pointOf(const glm::ivec3& at) const {
        const glm::dvec3 place = grid.place(at);
        return {place.x, place.y, place.z};
    }

    /// The nearest points of samples beside the surface.
    void seed(Block& block, glm::ivec3 first, glm::ivec3 end) {
        std::vector<std::pair<glm::ivec3, glm::ivec3>> seeds;  // with a neighbour on the other side
        eachOf(first, end, [&](const glm::ivec3& at, std::size_t index) {
            const glm::ivec3 lo = glm::max(at - 1, 0), hi = glm::min(at + 2, grid.size);
            glm::ivec3 other(-1);
            int least = 4;
            eachOf(lo, hi, [&](const glm::ivec3& beside, std::size_t i) {
                const glm::ivec3 way = glm::abs(beside - at);
                if (std::signbit(values[i]) == std::signbit(values[index]) || way.x + way.y + way.z >= least)
                    return;
                least = way.x + way.y + way.z;
                other = beside;
            });
            if (other.x >= 0) seeds.push_back({at, other});
        });
        if (seeds.empty()) return;
        // At worst it is the point between the two.
        const Tape own = shortenedFor(block, boxOf(first, end, 1.0));
        std::vector<std::pair<glm::dvec3, glm::dvec3>> ends;
        for (const auto& [at, other] : seeds) ends.push_back({grid.place(at), grid.place(other)});
        block.points.resize(seeds.size());
        block.found.resize(seeds.size());
        for (int step = 0; step < kHalvings; ++step) {
            for (std::size_t i = 0; i < seeds.size(); ++i) {
                const glm::dvec3 middle = 0.5 * (ends[i].first + ends[i].second);
                block.points[i] = {middle.x, middle.y, middle.z};
            }
            block.machine.evaluate(own, block.points, block.found);
            for (std::size_t i = 0; i < seeds.size(); ++i) {
                const glm::ivec3& at = seeds[i].first;
                const bool same =
                    std::signbit(float(block.found[i])) == std::signbit(values[grid.index(at.x, at.y, at.z)]);
                (same ? ends[i].first : ends[i].second) = 0.5 * (ends[i].first + ends[i].second);
            }
        }
        std::vector<Descent> descents;
        for (std::size_t i = 0; i < seeds.size(); ++i) {
            const glm::dvec3 place = grid.place(seeds[i].first),
                             between = 0.5 * (ends[i].first + ends[i].second);
            descents.push_back({seeds[i].first, place, between, glm::length(between - place)});
        }
        descend(block, boxOf(first, end, kReach), descents, kSteps);
    }

    /// Nearer points than those that were handed on, for samples within kRefined cells.
    void refine(Block& block, glm::ivec3 first, glm::ivec3 end) {
        std::vector<Descent> descents;
        eachOf(first, end, [&](const glm::ivec3& at, std::size_t index) {
            if (std::abs(nearest.distance[index]) > kRefined) return;
            const glm::dvec3 point = grid.origin + grid.cell * glm::dvec3(nearest.point[index]);
            descents.push_back({at, point, point, glm::length(point - grid.place(at))});
        });
        descend(block, boxOf(first, end, kRefined + kReach), descents, kRefiningSteps);
    }

    /// A search for the point that is nearest to a sample: where it is, and what it has found.
    struct Descent {
        glm::ivec3 sample;
        glm::dvec3 at, best;
        double least;
    };
    void descend(Block& block, const Box& box, std::span<Descent> descents, int steps) {
        if (descents.empty()) return;
        const Tape own = shortenedFor(block, box);
        block.points.resize(descents.size());
        block.gradients.resize(descents.size());
        for (int step = 0; step < steps; ++step) {
            for (std::size_t i = 0; i < descents.size(); ++i)
                block.points[i] = {descents[i].at.x, descents[i].at.y, descents[i].at.z};
            evaluateGradient(block.machine, own, block.points, block.gradients);
            for (std::size_t i = 0; i < descents.size(); ++i) follow(descents[i], block.gradients[i], box);
        }
        for (std::size_t i = 0; i < descents.size(); ++i) keep(descents[i], block.gradients[i]);
    }
    void follow(Descent& descent, const ValueGradient& here, const Box& box) const {
        const glm::dvec3 gradient(here.gradient[0], here.gradient[1], here.gradient[2]);
        const double size = glm::length(gradient), off = here.value / size;
        if (!(size > 0.0) || !std::isfinite(off)) return;
        const glm::dvec3 normal = gradient / size;
        glm::dvec3 move = -normal * off;
        if (std::abs(off) <= kOnSurface * grid.cell) {
            const glm::dvec3 back = grid.place(descent.sample) - descent.at;
            if (const double far = glm::length(back); far < descent.least)
                descent.least = far, descent.best = descent.at;
            move += back - normal * glm::dot(back, normal);
        }
        const double length = glm::length(move), most = kLongest * grid.cell;
        descent.at += length > most ? move * (most / length) : move;
        for (int axis = 0; axis < 3; ++axis)
            descent.at[axis] =
                std::clamp(descent.at[axis], box.lo[std::size_t(axis)], box.hi[std::size_t(axis)]);
    }
    void keep(const Descent& descent, const ValueGradient& last) {
        const std::size_t index = grid.index(descent.sample.x, descent.sample.y, descent.sample.z);
        glm::dvec3 point = (descent.best - grid.origin) / grid.cell;
        glm::dvec3 off = glm::dvec3(descent.sample) - point;
        if (glm::length(off) < kLeastDistance) {
            // The gradient of a sample on the surface is known from a little way off.
            const glm::dvec3 normal(last.gradient[0], last.gradient[1], last.gradient[2]);
            const double size = glm::length(normal);
            off = size > 0.0 ? normal * (std::copysign(kLeastDistance, values[index]) / size) : off;
            point = glm::dvec3(descent.sample) - off;
        }
        nearest.point[index] = glm::vec3(point);
        nearest.distance[index] = std::copysign(float(glm::length(off)), values[index]);
    }

    const Tape& tape;
    const VolumeGrid& grid;
    glm::ivec3 blocks{};
    std::vector<float> values;
    NearestPoints nearest;
};

}  // namespace

Result<FieldVolumePtr> measuredField(const Ir& ir, const MeasuredField& wish) {
    static std::mutex mutex;
    static std::map<uint64_t, std::weak_ptr<const FieldVolume>> known;
    uint64_t key = mixed(ir.hash(std::span(&wish.distance, 1)), uint64_t(wish.resolution));
    for (const double length : {wish.margin, wish.chamfer}) key = mixed(key, std::bit_cast<uint64_t>(length));
    {
        const std::lock_guard lock(mutex);
        if (const auto found = known.find(key); found != known.end())
            if (FieldVolumePtr held = found->second.lock()) return held;
        std::erase_if(known, [](const auto& entry) { return entry.second.expired(); });
    }
    // Other parts of the graph may read live parameters.
    IrId distance = wish.distance;
    const Ir needed = ir.compact(std::span(&distance, 1));
    const Region region = findRegion(needed, distance, {}, wish.lipschitz, wish.stop);
    if (wish.stop.stop_requested()) return cancelledError();
    if (region.extent == Extent::empty) return FieldVolumePtr();
    if (region.extent == Extent::unbounded)
        return Error{.message =
                         "is unbounded, so its distances cannot be measured: intersect it with a box first"};
    if (region.extent == Extent::unproven)
        return Error{.message = "cannot be proven bounded, so its distances cannot be measured: " +
                                describeUnproven(region.unproven) + "; intersect it with a box first"};
    const auto& [lo, hi] = region.box;
    const VolumeGrid grid = gridAround({lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]},
                                       std::min(wish.resolution, wish.finest), wish.margin);
    if (!hasUsableCells(grid))
        return Error{.message = "the solid is too small or too large for distances to be measured: scale it"};
    const Tape tape = makeTape(ir, wish.distance, {});
    const FieldVolumePtr volume = Measuring(tape, grid).measure(wish.chamfer);
    if (wish.finest >= wish.resolution) {
        const std::lock_guard lock(mutex);
        known[key] = volume;
    }
    return volume;
}

}  // namespace fw
