// A document compiled for all times: what its timeline moves, and the time itself, are live parameters, whose
// values at a time are a pure function of it.
//
// Lifetime: a plain value.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "graph/compile/compile.h"
#include "graph/document/timeline.h"

namespace fw {

struct LiveProgram {
    /// Numbers of an input that stand in slots of the parameter buffer.
    struct Input {
        std::vector<double> value;  ///< where no track moves it
        std::vector<int> slots;     ///< one a component; negative where the field has none
        bool operator==(const Input&) const = default;
    };
    struct Motion {
        Track track;
        AnimatedInput input;
    };

    Graph graph;
    Timeline timeline;
    Program program;
    std::map<std::string, Input> inputs;  ///< by "node.input"
    std::vector<Motion> motions;
    std::vector<bool> read;   ///< of each slot: whether the field reads it
    bool fieldMoves = false;  ///< whether the field is another at another time

    /// The live parameters' values so many seconds after the start.
    std::vector<double> valuesAt(double seconds) const;
    /// Intervals that contain the live parameters' values at all times from `from` to `to` on the timeline.
    std::vector<Interval> rangesBetween(double from, double to) const;
};

/// Compiles the document with what moves live, and what `options` and `exposed` say: further inputs,
/// "node.input", which are live if all code can do with that. Errors as readTimeline() and compile().
Result<LiveProgram> compileLive(Graph graph, CompileOptions options,
                                const std::set<std::string>& exposed = {});

}  // namespace fw
