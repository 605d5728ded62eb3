// StepConstant: the Lipschitz constant by which rays step through a program's field.
//
// A declared constant holds everywhere and is used as declared. Where none is declared, interval
// differentiation proves one over the box in which the solid is meshed (graph/evaluate/local_lipschitz.h),
// for the present live values. Rays only read the field at points of that box (shaders/render/solid.glsl,
// steppingPoint), so the constant need not hold outside.
//
// A proven constant may be large, and steps are its inverse: rays need as many times more steps. Above
// kMaxStillConstant or kMaxLiveConstant it is not used, and the renderer steps by its own guess
// (Renderer::trust).
//
// A search costs milliseconds, and its result is kept while program, live values and box stay the same. Of
// values that move, each live frame has a quick search of about 1 ms. Fields of particles change with every
// step of a simulation, and have no proven constant here.
#pragma once

#include <optional>
#include <vector>

#include "graph/compile/program.h"

namespace fw {

/// The largest proven constants by which rays step in live frames and thumbnails, and in stills, which may
/// take longer.
inline constexpr double kMaxLiveConstant = 8.0, kMaxStillConstant = 16.0;

/// The Lipschitz constant within a box by which rays may step: the declared or the proven one; infinity where
/// neither is known, or where the proven one is above `maxProven`.
double stepConstantWithin(const Program& program, const Box& box, double maxProven);

class StepConstant {
  public:
    /// As stepConstantWithin(). `thorough`: by a search of kThoroughSteps; otherwise one of kQuickSteps is
    /// enough.
    double of(const Program& program, const Box& box, double maxProven, bool thorough);

    /// Forgets the result: the program's data changed.
    void reset() { known.reset(); }

  private:
    struct Known {
        uint64_t structureHash;
        std::vector<double> values;
        Box box;
        bool thorough;
        double constant;  ///< declared or proven, whatever its size
    };
    std::optional<Known> known;
};

}  // namespace fw
