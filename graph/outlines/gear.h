// Spur gears with involute teeth, as outlines.
//
// A tooth is what a straight rack leaves of a blank that rolls along it (ISO 53): involutes of the base
// circle, and below them the path of the rack's corner, which undercuts gears of few teeth. So two gears of
// one module and one pressure angle turn in each other without meeting anywhere but on the line of action,
// whatever their numbers of teeth.
#pragma once

#include "graph/base/result.h"
#include "graph/outlines/outline.h"

namespace fw {

struct GearShape {
    double module = 0.1;        ///< pitch diameter / teeth, metres, above 0
    int teeth = 20;             ///< 3 to 1000
    double pressureAngle = 20;  ///< degrees, 10 to 35
    double backlash =
        0;  ///< how much thinner each tooth is along the pitch circle, metres; 1.4 modules at most
};

/// The gear about the origin, a tooth's middle on the x axis. One that was made lately is not made again. The
/// Error, with a message only: no tooth is left.
Result<OutlinePtr> outlineOfGear(const GearShape& shape);

}  // namespace fw
