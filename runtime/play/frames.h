// The frames of a timeline as numbered files, of whatever kind.
//
// Frame n shows the time n / fps, whatever the sequence that it belongs to, and its file is named after n: so
// sequences of one graph and rate can be extended, taken up again after a stop, and shared between machines.
// A file that is there is whole (system/output_file.h), and is passed over unless it is to be made anew.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "graph/document/graph.h"
#include "graph/document/timeline.h"

namespace fw {

/// Frames first <= n < last.
struct FrameRange {
    long first = 0, last = 0;
    double framesPerSecond = 30.0;

    double time(long frame) const { return static_cast<double>(frame) / framesPerSecond; }
    long count() const { return last - first; }
};

inline constexpr long kMostFrames = 1'000'000;

/// The frames with from <= time < to. Errors: times below zero, no frame between them, more than kMostFrames.
Result<FrameRange> framesBetween(double from, double to, double framesPerSecond);

/// Frames first to last, both among them: what one of several machines makes of a sequence.
struct FramePart {
    long first = 0, last = 0;
};
/// "first-last", or one number.
std::optional<FramePart> readFramePart(std::string_view text);
/// That part of all the frames; all if there is none. Error: it reaches beyond them.
Result<FrameRange> partOf(const FrameRange& all, const std::optional<FramePart>& part);

/// What of a timeline is asked for; what is left open is as the timeline has it.
struct FrameTimes {
    std::optional<double> from = {}, to = {};  ///< seconds
    std::optional<double> framesPerSecond = {};
    bool range = false;                  ///< from and to are the timeline's range
    std::optional<FramePart> part = {};  ///< of those; framesOf() does not mind it

    bool asked() const { return from || to || framesPerSecond || range || part; }
};
/// Errors: as framesBetween(), and a timeline without the range that is asked for.
Result<FrameRange> framesOf(const Timeline& timeline, const FrameTimes& times);

/// Where the files of a sequence are.
struct FrameFiles {
    std::string folder = {};
    std::string ending = {};  ///< behind the number: ".png"
    FrameRange frames = {};
    bool overwrite = false;  ///< frames that are there already; else they are passed over
    /// What a file is called in place of its number, but for the ending.
    std::function<std::string(long number)> stem = {};
    /// Whether the file that lies there is one of this sequence.
    std::function<bool(const std::string& path)> whole = {};
    /// All files that are written with that one, itself included; empty: it alone.
    std::function<std::vector<std::string>(const std::string& path)> together = {};

    /// "000042.png"
    std::string name(long frame) const;
    std::string path(long frame) const;
    /// Whether the frame's file lies there and is to stay.
    bool isThere(long frame) const;
    /// How many are there, whether they are to stay or not.
    long countThere() const;
};

/// Whether the frames may be written: none is a file that the graph reads, or another thing than a file. The
/// Error names it.
Done checkFrames(const FrameFiles& files, const Graph& graph);

}  // namespace fw
