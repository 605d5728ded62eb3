// What a program's field asks of whoever evaluates it, known before that is tried; and by which node.
//
// A driver compiles a field's code once for each kernel, and its time grows faster than the code: of some
// thousand operations it takes minutes, where tapes on the host (graph/evaluate/tape.h) give a mesh at once.
// The figures are those of Mesa's software driver on two cores, by which a runtime chooses and check() warns.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "graph/compile/program.h"

namespace fw {

/// Operations in the code of a distance, each weighed by what it is compiled to beside an addition. Members
/// of a family count once.
double codeWeight(const Ir& ir, IrId distance, const Families& families);

/// About how many seconds the driver takes to compile the mesher's kernels. Pictures take about as long
/// again.
double secondsToCompile(double codeWeight);
double secondsToCompile(const Program& program);

/// About how many seconds tapes take for a mesh of so many cells along the longest side, most of whose bricks
/// need the whole field.
double secondsByTapes(const Program& program, int resolution);

/// What a sample of the field costs a device near its surface, in additions: the code, and what of families
/// can matter in parts of the region.
double weightAtSurface(const Ir& ir, IrId distance, const Families& families,
                       std::span<const double> parameters, const Box& region);
double weightAtSurface(const Program& program, const Box& region);

/// About how many seconds light that is traced through a field of this weight takes for 640 x 360 pixels, one
/// sample each: within a factor of three.
double secondsToTrace(double weightAtSurface);

/// Above this many, pictures are drafts, if nothing else is asked for.
inline constexpr double kMostSecondsToTrace = 3;

/// Above this many seconds of compiling, tapes are used where they are sooner done.
inline constexpr double kMostSecondsToCompile = 1.5;

/// What came from one node.
struct NodeEffort {
    std::string node;       ///< as in Program::origins
    double operations = 0;  ///< that vary
    double sample = 0;      ///< weight of all of them: what a sample costs, in additions
    double code = 0;        ///< as codeWeight()
};

/// Those of the operations that distance and material need, the heaviest code first. Of what nodes share each
/// has the same part, if the program was compiled with CompileOptions::costByNode; else it is the first
/// one's.
std::vector<NodeEffort> effortByNode(const Program& program);

}  // namespace fw
