// What a hand does to the stops of a ramp and the points of a curve: functions from list to list.
//
// A list is what an input of type stops, or of ordered points, holds: entries of entrySize() numbers, of
// which the first is the position. They stay in its order whatever is done to them, so an edit tells which
// entry the one that it was done to has become.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "graph/library/node_type.h"

namespace fw::editor::ramps {

struct List {
    Type type = Type::stops;
    std::vector<double> numbers = {};

    std::size_t size() const { return std::size_t(entrySize(type)); }
    std::size_t count() const { return numbers.size() / size(); }
    double at(std::size_t entry) const { return numbers[size() * entry]; }
    std::span<const double> entry(std::size_t entry) const {
        return std::span(numbers).subspan(size() * entry, size());
    }
    bool operator==(const List&) const = default;
};

struct Edited {
    List list;
    std::size_t entry;  ///< that it was about
};

/// With the entry in another place, and its other numbers as they are. Where it comes upon another one it
/// stays on the side that it came from.
Edited moved(const List& list, std::size_t entry, double to);
/// With other numbers in place of the entry's.
Edited replaced(const List& list, std::size_t entry, std::span<const double> numbers);
/// With one more, behind those in its place. None if there are kMostStops already.
std::optional<Edited> inserted(const List& list, std::span<const double> numbers);
/// Without the entry; the one that is selected then is the one before. None if it is the last one.
std::optional<Edited> removed(const List& list, std::size_t entry);
/// With one more half way between the entry and the next, or the one before if there is none: of stops with
/// the colour that is there. None if there are none, or kMostStops.
std::optional<Edited> divided(const List& list, std::size_t entry, std::string_view interpolation);
/// Right is left: the first and the last place stay as they are.
List reversed(const List& list);
/// All as far from each other, between the first and the last.
List distributed(const List& list);

/// A list that is one (orderProblem): in order, of so many as there may be, evenly taken of more, no colour
/// below 0; of none one entry.
List mended(const List& list);

/// The colour of a ramp in a place, as the node color_ramp has it; grey if it has no stop.
std::array<double, 3> colorAt(const List& stops, std::string_view interpolation, double at);
/// What a curve gives at `count` places from `from` to `to`, by the node itself; a word that is empty is its
/// default. Nothing if it cannot be: its points are out of order.
std::vector<double> curveValues(const List& points, const std::string& interpolation, const std::string& ends,
                                double from, double to, std::size_t count);

/// Where the entries lie: 0 to 1 if they are all within; never empty.
struct Range {
    double lo = 0.0, hi = 1.0;
    double span() const { return hi - lo; }
};
Range placesOf(const List& list);
/// Of the second numbers, with some room above and below.
Range heightsOf(const List& points);
/// The number with as many digits as a pixel tells, of so many on the range.
double rounded(double number, const Range& range, double pixels);

struct Preset {
    std::string_view name;
    std::span<const double> stops;  ///< between 0 and 1
};
std::span<const Preset> presets();
/// The preset where the stops lie now.
List stretched(const Preset& preset, const Range& range);

}  // namespace fw::editor::ramps
