#include "editor/probe/along.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>

namespace fw::editor {

namespace {

constexpr int kHalvingsOfLine = std::countr_zero(unsigned(kPieces));
constexpr int kNestings = 60;
constexpr double kSame = 1e-9;  // of the line's length: a crossing at its beginning

class Crossings {
  public:
    explicit Crossings(const Segment& line_) : line(line_), length(line_.length()) {}

    void find(const Tape& tape, double from, double to, int halvings = kHalvingsOfLine) {
        const Point a = line.at(from), b = line.at(to);
        Box box;
        for (std::size_t i = 0; i < 3; ++i)
            box.lo[i] = std::min(a[i], b[i]), box.hi[i] = std::max(a[i], b[i]);
        const Interval range = machine.interval(tape, box);
        if (range.lo > 0.0 || range.hi < 0.0) return;
        const Tape shorter = machine.shortens() ? machine.shortenedForSigns(tape) : Tape();
        const Tape& inside = machine.shortens() ? shorter : tape;
        if (halvings == 0) return nest(inside, from, to);
        const double middle = 0.5 * (from + to);
        find(inside, from, middle, halvings - 1);
        find(inside, middle, to, halvings - 1);
    }

    std::vector<double> found;

  private:
    double value(const Tape& tape, double metres) {
        const Point p = line.at(metres);
        for (int axis = 0; axis < 3; ++axis) *machine.position(axis) = p[std::size_t(axis)];
        return *machine.value(tape, 1);
    }

    void nest(const Tape& tape, double from, double to) {
        const bool inside = value(tape, from) < 0.0;
        if (inside == (value(tape, to) < 0.0)) return;
        for (int i = 0; i < kNestings; ++i) {
            const double middle = 0.5 * (from + to);
            ((value(tape, middle) < 0.0) == inside ? from : to) = middle;
        }
        found.push_back(to);
    }

    const Segment& line;
    double length;
    TapeMachine<double> machine;
};

double valueAt(const Tape& tape, const Point& point) {
    double value = 0.0;
    TapeMachine<double>().evaluate(tape, std::span(&point, 1), std::span(&value, 1));
    return value;
}

}  // namespace

double Segment::length() const { return std::hypot(to[0] - from[0], to[1] - from[1], to[2] - from[2]); }

Point Segment::at(double metres) const {
    const double whole = length(), part = whole > 0.0 ? metres / whole : 0.0;
    Point point;
    for (std::size_t i = 0; i < 3; ++i) point[i] = from[i] + part * (to[i] - from[i]);
    return point;
}

std::vector<double> crossingsAlong(const Tape& tape, const Segment& line) {
    const double length = line.length();
    if (!(length > 0.0) || !std::isfinite(length)) return {};
    Crossings crossings(line);
    crossings.find(tape, 0.0, length);
    return std::move(crossings.found);
}

std::vector<Stretch> wallsAlong(const Tape& tape, const Segment& line, std::span<const double> crossings) {
    bool inside = valueAt(tape, line.from) < 0.0;
    bool whole = false;  // its beginning is a crossing
    double begin = 0.0;
    std::vector<Stretch> walls;
    for (const double at : crossings) {
        inside = !inside;
        if (!inside && whole) walls.push_back({begin, at});
        whole = inside, begin = at;
    }
    return walls;
}

std::optional<WallAt> wallAt(const Tape& tape, const Point& surface, double reach) {
    TapeMachine<double> machine;
    ValueGradient here{};
    evaluateGradient(machine, tape, std::span(&surface, 1), std::span(&here, 1));
    const double length = std::hypot(here.gradient[0], here.gradient[1], here.gradient[2]);
    if (!(length > 0.0) || !std::isfinite(length) || !(reach > 0.0)) return std::nullopt;
    Segment inward{surface, surface};
    for (std::size_t i = 0; i < 3; ++i) inward.to[i] -= reach * here.gradient[i] / length;
    const std::vector<double> crossings = crossingsAlong(tape, inward);
    bool inside = valueAt(tape, surface) < 0.0;
    for (const double at : crossings) {
        inside = !inside;
        // The surface is where the solid begins, to the last bits on one side of it or the other.
        if (!inside && at > kSame * reach) return WallAt{{surface, inward.at(at)}};
    }
    return std::nullopt;
}

Plot plotOf(const Tape& tape, const Segment& line) {
    Plot plot;
    plot.line = line;
    std::vector<Point> points;
    for (int i = 0; i < kSamples; ++i) {
        plot.places.push_back(line.length() * double(i) / double(kSamples - 1));
        points.push_back(line.at(plot.places.back()));
    }
    std::vector<ValueGradient> samples(points.size());
    TapeMachine<double> machine;
    evaluateGradient(machine, tape, points, samples);
    for (const ValueGradient& sample : samples) {
        plot.values.push_back(sample.value);
        plot.slopes.push_back(std::hypot(sample.gradient[0], sample.gradient[1], sample.gradient[2]));
    }
    plot.crossings = crossingsAlong(tape, line);
    plot.walls = wallsAlong(tape, line, plot.crossings);
    return plot;
}

std::string csvOf(const Plot& plot) {
    std::string text = "along,x,y,z,value,gradient\n";
    for (std::size_t i = 0; i < plot.places.size(); ++i) {
        const Point p = plot.line.at(plot.places[i]);
        char line[200];
        std::snprintf(line, sizeof line, "%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n", plot.places[i], p[0], p[1], p[2],
                      plot.values[i], plot.slopes[i]);
        text += line;
    }
    return text;
}

}  // namespace fw::editor
