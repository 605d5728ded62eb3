// Units: what a number of the table is measured in, and the units of length that a document can have.
//
// An input says what its numbers are in metres and seconds (InputSpec::unit): "m", "m/s²", "1/m", "degrees".
// There "m" stands for a length of 1, which is what the document's unit says: of a document in millimetres
// "m/s" is millimetres a second. So one word tells what a number is called, which units may be typed behind
// it (language/typed_number.h), and what becomes of it where a document changes its unit and keeps its sizes.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace fw {

struct LengthUnit {
    const char* name;   ///< "mm"
    const char* words;  ///< "millimetres"
    double metres;      ///< in one of it
};

/// All that a document can have, the smallest first.
std::span<const LengthUnit> lengthUnits();
/// That of the name; nullptr if there is none.
const LengthUnit* lengthUnit(std::string_view name);

/// In which power lengths are in numbers of this unit: 1 of "m" and "m/s", 3 of "m³/s²", -1 of "1/m", 0 of
/// "degrees". A number becomes itself times (how many of the new unit the old one is) to this power.
int lengthPower(std::string_view unit);

/// What is said behind a number of this unit where lengths are in `lengths`: "mm", "mm/s", "°", "°/mm".
/// Empty for a plain number, a colour and what may be anything.
std::string unitSign(std::string_view unit, const LengthUnit& lengths);

/// The number with its sign, to six digits: "3.5 mm", "45°".
std::string withSign(double number, std::string_view unit, const LengthUnit& lengths);

}  // namespace fw
