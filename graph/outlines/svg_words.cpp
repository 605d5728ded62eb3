#include "graph/outlines/svg_words.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

namespace fw {

namespace {

constexpr std::string_view kSpace = " \t\r\n\f";

/// From its ends to its centre (SVG 2, B.2.4).
void ellipticalArc(Pen& pen, double rx, double ry, double tilt, bool large, bool sweep, glm::dvec2 to) {
    const glm::dvec2 from = pen.place();
    if (from == to) return;
    if (!(rx > 0 && ry > 0)) return pen.lineTo(to);
    const glm::dvec2 u{std::cos(tilt), std::sin(tilt)}, v = leftOf(u), middle = 0.5 * (from - to);
    const glm::dvec2 half{glm::dot(middle, u), glm::dot(middle, v)};
    const double needed = half.x * half.x / (rx * rx) + half.y * half.y / (ry * ry);
    if (needed > 1) rx *= std::sqrt(needed), ry *= std::sqrt(needed);
    const glm::dvec2 round = half / glm::dvec2(rx, ry);  // on a circle of radius 1
    const double off = std::sqrt(std::max(0.0, 1 / glm::dot(round, round) - 1)) * (large == sweep ? -1 : 1);
    const glm::dvec2 c = off * glm::dvec2(round.y, -round.x);
    const glm::dvec2 centre = 0.5 * (from + to) + c.x * rx * u + c.y * ry * v;
    const glm::dvec2 first = round - c, second = -round - c;
    const double begin = std::atan2(first.y, first.x);
    double turn = std::atan2(second.y, second.x) - begin;
    if (sweep && turn < 0) turn += 2 * std::numbers::pi;
    if (!sweep && turn > 0) turn -= 2 * std::numbers::pi;
    pen.ellipse(centre, rx * u, ry * v, begin, begin + turn);
    pen.lineTo(to);
}

}  // namespace

void SvgWords::skip() {
    const auto spaces = [&] { rest.remove_prefix(std::min(rest.find_first_not_of(kSpace), rest.size())); };
    spaces();
    if (rest.starts_with(',')) rest.remove_prefix(1), spaces();
}

std::optional<double> SvgWords::number() {
    skip();
    std::string_view from = rest;
    if (from.starts_with('+')) from.remove_prefix(1);
    std::string_view digits = from;
    if (digits.starts_with('-')) digits.remove_prefix(1);
    if (digits.empty() || !(std::isdigit(static_cast<unsigned char>(digits[0])) || digits[0] == '.'))
        return std::nullopt;
    double value = 0;
    const auto [end, problem] = std::from_chars(from.data(), from.data() + from.size(), value);
    if (problem != std::errc() || !(std::abs(value) <= 1e12)) return std::nullopt;
    rest = std::string_view(end, std::size_t(rest.data() + rest.size() - end));
    return value;
}

std::optional<bool> SvgWords::flag() {
    skip();
    if (rest.empty() || (rest[0] != '0' && rest[0] != '1')) return std::nullopt;
    const bool value = rest[0] == '1';
    rest.remove_prefix(1);
    return value;
}

std::string_view SvgWords::name() {
    skip();
    std::size_t length = 0;
    while (length < rest.size() && std::isalpha(static_cast<unsigned char>(rest[length]))) ++length;
    const std::string_view found = rest.substr(0, length);
    rest.remove_prefix(length);
    return found;
}

bool SvgWords::take(char c) {
    skip();
    if (!rest.starts_with(c)) return false;
    rest.remove_prefix(1);
    return true;
}

std::string_view trimmed(std::string_view text) {
    const std::size_t from = std::min(text.find_first_not_of(kSpace), text.size());
    return text.substr(from, text.find_last_not_of(kSpace) + 1 - from);
}

std::optional<double> lengthIn(std::string_view text, double whole) {
    SvgWords words{text};
    const std::optional<double> value = words.number();
    if (!value) return std::nullopt;
    static const std::map<std::string_view, double> units = {
        {"", 1},           {"px", 1},         {"pt", 96 / 72.0}, {"pc", 16}, {"in", 96},
        {"mm", 96 / 25.4}, {"cm", 96 / 2.54}, {"Q", 24 / 25.4},  {"em", 16}, {"ex", 8}};
    if (words.rest.starts_with('%')) return *value / 100 * whole;
    const auto found = units.find(words.name());
    return found == units.end() ? std::nullopt : std::optional(*value * found->second);
}

std::optional<PlaneTransform> transformOf(std::string_view text) {
    PlaneTransform all;
    SvgWords words{text};
    words.skip();
    while (!words.rest.empty()) {
        const std::string_view name = words.name();
        if (!words.take('(')) return std::nullopt;
        std::vector<double> n;
        while (!words.take(')')) {
            const auto number = words.number();
            if (!number || n.size() > 6) return std::nullopt;
            n.push_back(*number);
        }
        const auto at = [&](std::size_t i, double otherwise) { return i < n.size() ? n[i] : otherwise; };
        if (n.empty()) return std::nullopt;
        constexpr double degree = std::numbers::pi / 180;
        if (name == "matrix" && n.size() == 6)
            all = all * PlaneTransform{{n[0], n[1]}, {n[2], n[3]}, {n[4], n[5]}};
        else if (name == "translate")
            all = all * PlaneTransform{{1, 0}, {0, 1}, {n[0], at(1, 0)}};
        else if (name == "scale")
            all = all * PlaneTransform{{n[0], 0}, {0, at(1, n[0])}, {0, 0}};
        else if (name == "rotate") {
            const double c = std::cos(n[0] * degree), s = std::sin(n[0] * degree);
            const glm::dvec2 about{at(1, 0), at(2, 0)};
            all =
                all * PlaneTransform{
                          {c, s}, {-s, c}, about - about.x * glm::dvec2(c, s) - about.y * glm::dvec2(-s, c)};
        } else if (name == "skewX")
            all = all * PlaneTransform{{1, 0}, {std::tan(n[0] * degree), 1}, {0, 0}};
        else if (name == "skewY")
            all = all * PlaneTransform{{1, std::tan(n[0] * degree)}, {0, 1}, {0, 0}};
        else
            return std::nullopt;
        words.skip();
    }
    return all;
}

bool drawPath(std::string_view data, Pen& pen, std::size_t mostArcs) {
    SvgWords words{data};
    char command = 0;
    glm::dvec2 last{0};  // the last control point, where the next may mirror it
    char lastKind = 0;
    bool drawn = false;
    while (pen.arcs() < mostArcs) {
        words.skip();
        if (words.rest.empty()) return true;
        if (std::isalpha(static_cast<unsigned char>(words.rest[0]))) {
            command = words.rest[0];
            words.rest.remove_prefix(1);
        } else if (command == 0 || command == 'z' || command == 'Z') {
            return false;
        }
        const char kind = char(std::toupper(command));
        if (!drawn && kind != 'M') return false;
        const glm::dvec2 from = std::islower(command) ? pen.place() : glm::dvec2(0);
        const auto point = [&]() -> std::optional<glm::dvec2> {
            const auto x = words.number();
            const auto y = x ? words.number() : x;
            return y ? std::optional(from + glm::dvec2(*x, *y)) : std::nullopt;
        };
        const glm::dvec2 at = pen.place();
        char nextKind = kind;
        if (kind == 'Z') {
            pen.close();
            pen.moveTo(pen.place());
        } else if (kind == 'M') {
            const auto p = point();
            if (!p) return false;
            pen.moveTo(*p);
            drawn = true;
            command = command == 'm' ? 'l' : 'L';
        } else if (kind == 'L' || kind == 'T') {
            const auto p = point();
            if (!p) return false;
            if (kind == 'L') {
                pen.lineTo(*p);
            } else {
                last = lastKind == 'Q' ? 2.0 * at - last : at;
                pen.curveTo(last, *p);
                nextKind = 'Q';
            }
        } else if (kind == 'H' || kind == 'V') {
            const auto to = words.number();
            if (!to) return false;
            pen.lineTo(kind == 'H' ? glm::dvec2(from.x + *to, at.y) : glm::dvec2(at.x, from.y + *to));
        } else if (kind == 'Q' || kind == 'S' || kind == 'C') {
            std::optional<glm::dvec2> first = lastKind == 'C' ? 2.0 * at - last : at;
            if (kind != 'S') first = point();
            const auto second = kind == 'Q' ? first : point(), p = point();
            if (!first || !second || !p) return false;
            if (kind == 'Q')
                pen.curveTo(*first, *p);
            else
                pen.curveTo(*first, *second, *p);
            last = *second;
            nextKind = kind == 'Q' ? 'Q' : 'C';
        } else if (kind == 'A') {
            const auto rx = words.number(), ry = words.number(), tilt = words.number();
            const auto large = words.flag(), sweep = words.flag();
            const auto p = point();
            if (!rx || !ry || !tilt || !large || !sweep || !p) return false;
            ellipticalArc(pen, std::abs(*rx), std::abs(*ry), *tilt * std::numbers::pi / 180, *large, *sweep,
                          *p);
        } else {
            return false;
        }
        lastKind = nextKind;
    }
    return true;  // too many: told elsewhere
}

}  // namespace fw
