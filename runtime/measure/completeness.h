// Completeness: whether the meshed region holds all of a solid.
//
// The check looks for solid outside the region. It shares no code with the search that finds regions
// (graph/bounds/region.h, box_contractor.h, hull_refinement.h), so that an error there does not hide here.
// It evaluates the field at points and on boxes, and nothing else:
//
// 1. Intervals over the six slabs around the region. Ordinary solids are proven complete by these.
// 2. Samples outside the region, at distances from 1e-3 of its size to kFarthest, uniform in the logarithm,
//    in general position and on axes and planes through its centre and the origin. From the samples of lowest
//    value for their distance, Newton's method on the field descends to the solid nearby.
// 3. The same descent on every operand of a minimum or a choice within the field. A small solid far away is
//    the nearest one only for few points, but the only solid of its operand. What this finds counts only
//    where the whole field is negative.
// 4. Interval subdivision of shells around the region, with simplified tapes, best first: the cells with the
//    lowest values for their size are split before others, and samples are taken in them.
//
// The work is limited by a number of tape steps, not by time, so the result is the same on every run. A field
// with more steps gets fewer samples and cells, but always some dozens of samples.
//
// Limits: "sampled" is no proof. Samples and descent can miss a solid that is small for its distance and is
// not a separate operand, such as a single copy made by a modulo or by noise.
#pragma once

#include <atomic>
#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "graph/base/box.h"
#include "graph/ir/ir.h"

namespace fw {

struct Program;

struct Completeness {
    /// A point outside the region where the field is negative; empty if none was found.
    std::optional<Point> solidOutside = {};
    bool proven = false;  ///< no such point exists up to kFarthest, by interval arithmetic
    Box region = {};
    /// Work that was done on points and on boxes, in units of CompletenessBudget.
    std::size_t pointWork = 0, intervalWork = 0;

    bool complete() const { return !solidOutside; }
};

/// Limits of the work, in steps of a tape by their weights: an addition at one point, or on one box,
/// counts 1. The defaults take some 0.1 s on one thread.
struct CompletenessBudget {
    std::size_t pointWork = 80'000'000;
    std::size_t intervalWork = 3'000'000;
};

/// Looks for solid, distance < 0, outside the region. `parameters` are the live values in their slots. Once
/// `cancel` is set, it returns soon and the result means nothing.
Completeness checkCompleteness(const Ir& ir, IrId distance, std::span<const double> parameters,
                               const Box& region, const std::atomic<bool>* cancel = nullptr,
                               const CompletenessBudget& budget = {});

/// The same of the program's field, with its live values as they are.
Completeness checkCompleteness(const Program& program, const Box& region,
                               const std::atomic<bool>* cancel = nullptr);

/// "there is solid at (4, 2, 3), outside the meshed region (-1 -1 -1) to (1 1 1)", of one that is not
/// complete.
std::string describeMissing(const Completeness& completeness);

}  // namespace fw
