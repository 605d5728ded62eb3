#include "editor/ramps/edits.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "graph/evaluate/evaluate.h"
#include "graph/language/lower.h"

namespace fw::editor::ramps {

namespace {

/// Of what the numbers are themselves: in less no pixels could be told apart.
constexpr double kLeastWidthSeen = 1e-6, kLeastHeightSeen = 1e-9;

Edited put(List list, std::size_t entry, std::span<const double> numbers) {
    const std::vector<double> kept(numbers.begin(), numbers.end());
    list.numbers.insert(list.numbers.begin() + std::ptrdiff_t(list.size() * entry), kept.begin(), kept.end());
    return {std::move(list), entry};
}

List without(List list, std::size_t entry) {
    const auto first = list.numbers.begin() + std::ptrdiff_t(list.size() * entry);
    list.numbers.erase(first, first + std::ptrdiff_t(list.size()));
    return list;
}

/// Of another list: how many entries lie before this place, or at it too.
std::size_t before(const List& list, double place, bool orAt) {
    std::size_t count = 0;
    while (count < list.count() && (orAt ? list.at(count) <= place : list.at(count) < place)) ++count;
    return count;
}

// The presets' own values. A grey that is even to the eye needs none in linear light: it has two stops, and
// its neighbours a middle. Heat goes through red and yellow as what glows does. The rainbow's hues go around
// at one lightness and one strength (of the space OKLab: lightness 0.75, chroma 0.12), so that no colour
// stands out; they are 45 degrees apart.
constexpr double kGrey[] = {0, 0, 0, 0, 1, 1, 1, 1};
constexpr double kHeat[] = {0,   0,   0,    0,   0.3, 0.35, 0.01, 0,   0.6, 0.9,
                            0.2, 0.0, 0.85, 1.0, 0.7, 0.1,  1,    1.0, 1.0, 0.9};
constexpr double kTerrain[] = {0,    0.01, 0.04, 0.12, 0.3, 0.03, 0.16, 0.26, 0.34, 0.5,
                               0.42, 0.24, 0.45, 0.08, 0.2, 0.04, 0.65, 0.16, 0.13, 0.06,
                               0.85, 0.22, 0.2,  0.18, 1,   0.9,  0.92, 0.95};

/// OKLab, Ottosson 2020: linear sRGB of a lightness, a chroma and a hue in degrees.
std::array<double, 3> ofHue(double lightness, double chroma, double hue) {
    const double a = chroma * std::cos(hue * M_PI / 180.0), b = chroma * std::sin(hue * M_PI / 180.0);
    const double l = lightness + 0.3963377774 * a + 0.2158037573 * b,
                 m = lightness - 0.1055613458 * a - 0.0638541728 * b,
                 s = lightness - 0.0894841775 * a - 1.2914855480 * b;
    const double x = l * l * l, y = m * m * m, z = s * s * s;
    return {4.0767416621 * x - 3.3077115913 * y + 0.2309699292 * z,
            -1.2684380046 * x + 2.6097574011 * y - 0.3413193965 * z,
            -0.0041960863 * x - 0.7034186147 * y + 1.7076147010 * z};
}

const std::vector<double>& rainbow() {
    static const std::vector<double> stops = [] {
        std::vector<double> all;
        for (int i = 0; i < 8; ++i) {
            all.push_back(std::round(i / 7.0 * 1e4) / 1e4);
            for (const double channel : ofHue(0.75, 0.12, 20.0 + 45.0 * i))
                all.push_back(std::round(std::clamp(channel, 0.0, 1.0) * 1e4) / 1e4);
        }
        return all;
    }();
    return stops;
}

}  // namespace

Edited moved(const List& list, std::size_t entry, double to) {
    std::vector<double> numbers(list.entry(entry).begin(), list.entry(entry).end());
    numbers[0] = to;
    return replaced(list, entry, numbers);
}

Edited replaced(const List& list, std::size_t entry, std::span<const double> numbers) {
    const List rest = without(list, entry);
    if (numbers[0] == list.at(entry)) return put(rest, entry, numbers);
    return put(rest, before(rest, numbers[0], numbers[0] < list.at(entry)), numbers);
}

std::optional<Edited> inserted(const List& list, std::span<const double> numbers) {
    if (list.count() >= kMostStops) return {};
    return put(list, before(list, numbers[0], true), numbers);
}

std::optional<Edited> removed(const List& list, std::size_t entry) {
    if (list.count() < 2) return {};
    return Edited{without(list, entry), entry > 0 ? entry - 1 : 0};
}

std::optional<Edited> divided(const List& list, std::size_t entry, std::string_view interpolation) {
    if (list.count() == 0 || list.count() >= kMostStops) return {};
    const std::size_t first = entry + 1 < list.count() ? entry
                              : entry > 0              ? entry - 1
                                                       : entry,
                      second = std::min(first + 1, list.count() - 1);
    const double at = 0.5 * (list.at(first) + list.at(second));
    std::vector<double> numbers = {at};
    if (list.type == Type::stops)
        for (const double channel : colorAt(list, interpolation, at)) numbers.push_back(channel);
    else
        numbers.push_back(0.5 * (list.entry(first)[1] + list.entry(second)[1]));
    return put(list, first + 1, numbers);
}

List reversed(const List& list) {
    List result{list.type, {}};
    for (std::size_t i = list.count(); i-- > 0;) {
        const auto entry = list.entry(i);
        result.numbers.insert(result.numbers.end(), entry.begin(), entry.end());
        // The ends to the digit; between them what is near to a short number is that number.
        double& at = result.numbers[result.numbers.size() - list.size()];
        at = i == 0                  ? list.at(list.count() - 1)
             : i + 1 == list.count() ? list.at(0)
                                     : std::round((list.at(0) + list.at(list.count() - 1) - at) * 1e9) / 1e9;
    }
    return result;
}

List distributed(const List& list) {
    List result = list;
    const std::size_t count = list.count();
    for (std::size_t i = 1; i + 1 < count; ++i)
        result.numbers[list.size() * i] =
            std::round((list.at(0) + (list.at(count - 1) - list.at(0)) * double(i) / double(count - 1)) *
                       1e4) /
            1e4;
    return result;
}

List mended(const List& list) {
    if (list.count() == 0) return {list.type, std::vector<double>(list.size(), 0.0)};
    std::vector<std::size_t> order(list.count());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return list.at(i); });
    const std::size_t count = std::min(order.size(), kMostStops);
    List result{list.type, {}};
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t taken = count < 2 ? 0 : i * (order.size() - 1) / (count - 1);
        const auto entry = list.entry(order[taken]);
        result.numbers.push_back(entry[0]);
        for (const double number : entry.subspan(1))
            result.numbers.push_back(list.type == Type::stops ? std::max(number, 0.0) : number);
    }
    return result;
}

std::array<double, 3> colorAt(const List& stops, std::string_view interpolation, double at) {
    const auto color = [&](std::size_t i) {
        const auto entry = stops.entry(i);
        return std::array{entry[1], entry[2], entry[3]};
    };
    if (stops.count() == 0) return {0.5, 0.5, 0.5};
    const std::size_t next = before(stops, at, true);
    if (next == 0) return color(0);
    if (next == stops.count() || interpolation == "constant") return color(next - 1);
    double t = (at - stops.at(next - 1)) / (stops.at(next) - stops.at(next - 1));
    if (interpolation == "smooth") t = t * t * (3.0 - 2.0 * t);
    const auto a = color(next - 1), b = color(next);
    return {a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t, a[2] + (b[2] - a[2]) * t};
}

std::vector<double> curveValues(const List& points, const std::string& interpolation, const std::string& ends,
                                double from, double to, std::size_t count) {
    language::Lowering state;
    const NodeType& type = *findNodeType("curve");
    const auto word = [&](std::string_view input, const std::string& text) {
        language::Value value{Type::string};
        value.text = text.empty() ? type.inputs[std::size_t(inputIndex(type, input))].value.text : text;
        return value;
    };
    language::Value x{Type::scalar}, list{Type::points};
    x.ids[0] = state.ir.position(0);
    list.points = std::make_shared<const std::vector<double>>(points.numbers);
    const Result<std::vector<language::Value>> made =
        language::lowerNode(state, type, {x, list, word("interpolation", interpolation), word("ends", ends)});
    if (!made) return {};
    std::vector<Point> places(count);
    for (std::size_t i = 0; i < count; ++i)
        places[i] = {from + (to - from) * double(i) / double(count - 1), 0.0, 0.0};
    std::vector<double> values(count);
    evaluate(state.ir, made->front().id(), {}, places, values);
    return values;
}

Range placesOf(const List& list) {
    if (list.count() == 0) return {};
    const double lo = list.at(0), hi = list.at(list.count() - 1);
    if (lo >= 0.0 && hi <= 1.0) return {};
    const double least = kLeastWidthSeen * std::max({1.0, std::abs(lo), std::abs(hi)}),
                 room = std::max(0.5, least);
    return hi - lo < least ? Range{lo - room, lo + room} : Range{lo, hi};
}

Range heightsOf(const List& points) {
    if (points.count() == 0) return {};
    Range range{points.entry(0)[1], points.entry(0)[1]};
    for (std::size_t i = 1; i < points.count(); ++i) {
        range.lo = std::min(range.lo, points.entry(i)[1]);
        range.hi = std::max(range.hi, points.entry(i)[1]);
    }
    const double least = kLeastHeightSeen * std::max({1.0, std::abs(range.lo), std::abs(range.hi)}),
                 room = range.span() < least ? std::max(0.5, least) : 0.1 * range.span();
    return {range.lo - room, range.hi + room};
}

double rounded(double number, const Range& range, double pixels) {
    const double grain = std::pow(10.0, std::floor(std::log10(range.span() / std::max(pixels, 1.0))));
    // By what is whole, where it can be: 0.29 and not 0.29000000000000004.
    const double result = grain < 1.0 ? std::round(number / grain) / std::round(1.0 / grain)
                                      : std::round(number / grain) * grain;
    return result == 0.0 ? 0.0 : result;
}

std::span<const Preset> presets() {
    static const std::array<Preset, 4> all = {
        {{"Grey", kGrey}, {"Heat", kHeat}, {"Terrain", kTerrain}, {"Rainbow", rainbow()}}};
    return all;
}

List stretched(const Preset& preset, const Range& range) {
    List result{Type::stops, {preset.stops.begin(), preset.stops.end()}};
    for (std::size_t i = 0; i < result.count(); ++i) {
        double& at = result.numbers[result.size() * i];
        at = rounded(range.lo + at * range.span(), range, 1e4);
    }
    return result;
}

}  // namespace fw::editor::ramps
