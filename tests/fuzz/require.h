// What a fuzz target holds to be true.
#pragma once

#include <cstdio>
#include <cstdlib>

/// Stops the run, which then counts as a finding, unless it does.
inline void require(bool condition, const char* what) {
    if (condition) return;
    std::fprintf(stderr, "does not hold: %s\n", what);
    std::abort();
}
