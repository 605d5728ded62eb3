#include "graph/library/units.h"

#include <algorithm>
#include <array>

#include "graph/base/words.h"

namespace fw {

namespace {

constexpr std::array kUnits = {LengthUnit{"mm", "millimetres", 0.001}, LengthUnit{"cm", "centimetres", 0.01},
                               LengthUnit{"in", "inches", 0.0254}, LengthUnit{"m", "metres", 1.0}};

/// Where the metre stands in "m/s²", "1/m", "degrees/m": behind it the end, a stroke or a power.
std::size_t metreIn(std::string_view unit) {
    for (std::size_t at = unit.find('m'); at != unit.npos; at = unit.find('m', at + 1)) {
        const std::string_view before = unit.substr(0, at), behind = unit.substr(at + 1);
        const bool begins = before.empty() || before.ends_with('/');
        if (begins &&
            (behind.empty() || behind[0] == '/' || behind.starts_with("²") || behind.starts_with("³")))
            return at;
    }
    return unit.npos;
}

}  // namespace

std::span<const LengthUnit> lengthUnits() { return kUnits; }

const LengthUnit* lengthUnit(std::string_view name) {
    const auto found = std::ranges::find(kUnits, name, &LengthUnit::name);
    return found == kUnits.end() ? nullptr : &*found;
}

int lengthPower(std::string_view unit) {
    const std::size_t at = metreIn(unit);
    if (at == unit.npos) return 0;
    const std::string_view behind = unit.substr(at + 1);
    const int power = behind.starts_with("²") ? 2 : behind.starts_with("³") ? 3 : 1;
    return unit.substr(0, at).ends_with('/') ? -power : power;
}

std::string unitSign(std::string_view unit, const LengthUnit& lengths) {
    if (unit == "color" || unit == "any") return {};
    std::string sign(unit);
    if (const std::size_t at = metreIn(unit); at != unit.npos) sign.replace(at, 1, lengths.name);
    constexpr std::string_view kDegrees = "degrees";
    if (sign.starts_with(kDegrees)) sign.replace(0, kDegrees.size(), "°");
    if (sign.starts_with("1/")) sign.erase(0, 1);
    return sign;
}

std::string withSign(double number, std::string_view unit, const LengthUnit& lengths) {
    const std::string sign = unitSign(unit, lengths);
    const bool close = sign.empty() || sign.starts_with("°");
    return shortNumber(number) + (close ? "" : " ") + sign;
}

}  // namespace fw
