// What a program's field asks of whoever evaluates it, before that is tried.
//
// A driver compiles a field's code once for each kernel, and its time grows faster than the code: of some
// thousand operations it takes minutes, where tapes on the host (graph/evaluate/tape.h) give a mesh at once.
// The figures are those of Mesa's software driver on two cores, by which a runtime chooses and check() warns.
#pragma once

#include "graph/compile/program.h"

namespace fw {

/// Operations in the code of the distance, each weighed by what it is compiled to beside an addition. Members
/// of a family count once.
double codeWeight(const Program& program);

/// About how many seconds the driver takes to compile the mesher's kernels. Pictures take about as long
/// again.
double secondsToCompile(const Program& program);

/// About how many seconds tapes take for a mesh of so many cells along the longest side, most of whose bricks
/// need the whole field.
double secondsByTapes(const Program& program, int resolution);

/// Above this many seconds of compiling, tapes are used where they are sooner done.
inline constexpr double kMostSecondsToCompile = 1.5;

}  // namespace fw
