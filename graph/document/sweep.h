// A sweep: the values that parameters take one after the other, a variant of the graph for each.
//
// Written as a range, "hole=0.1:0.9:9" or "hole=1mm:9mm:9": nine values, evenly spaced, both ends among them.
// Or as a table, the name of a .csv file (RFC 4180): its first line names the parameters, each further one is
// a variant. Of several the sweep is every combination, the last of them changing soonest. Values are texts
// as setParameter() takes them, those of ranges of up to twelve digits, so that a variant can be made again
// by hand. Knows nothing of the graph: whether there are such parameters, only it can tell.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "graph/base/result.h"

namespace fw {

struct NamedValue {
    std::string name, value;
    bool operator==(const NamedValue&) const = default;
};

struct Variant {
    std::vector<NamedValue> values;
    /// What its file is called, but for the ending: "hole=0.1,size=2", with '_' for what file names cannot
    /// have. Unlike that of any other variant of the sweep: where values do not tell them apart, or are too
    /// long, all are numbered from 0 instead, "000042".
    std::string stem;
};

inline constexpr std::size_t kMostVariants = 1'000'000;

/// The variants of all these together. Errors: what is no range, in a table with its file and line; a name
/// that is swept twice; more than kMostVariants.
Result<std::vector<Variant>> readSweep(std::span<const std::string> texts);

}  // namespace fw
