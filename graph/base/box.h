// A place in space, and a box along the axes; metres.
#pragma once

#include <array>

namespace fw {

using Point = std::array<double, 3>;

struct Box {
    Point lo{}, hi{};
    bool operator==(const Box&) const = default;
};

}  // namespace fw
