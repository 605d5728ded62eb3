// Of all kernels of foam (runtime/particles/foam.h says how). A slot's place is followed by the seconds that its particle has been
// foam, its velocity by the kind and, behind the point, its share of chance; without a particle by a number below 0.
#include "particles/fluid.glsl"
#include "particles/foam.h"

layout(binding = 0, scalar) readonly buffer Numbers { FoamNumbers foam; };

const float kNoFoam = -1.0;
