// A number as a hand types it: "2*pi/3", "3mm", "1/4in", "2 cm + 1/8in", "1'6\"", "90deg".
//
// It is a constant expression of the field language, in which units may stand behind numbers and brackets. A
// unit goes with the product before it up to the unit before that: "1/4in" is a quarter of an inch, "3mm/2mm"
// a number; "1 1/2in" and "1'6\"" are one number each. Numbers without a unit are in the document's.
//
// That units come to a length is tried rather than reckoned: with all of them twice and three times as long
// the result has to grow evenly, as that of a product of two lengths, or of one divided by a length, does
// not. So whatever the language can do with lengths may be typed ("max(2mm, 1/8in)", "sqrt(2)*3mm").
#pragma once

#include <string>
#include <string_view>

#include "graph/base/result.h"
#include "graph/library/units.h"

namespace fw {

/// The value of a constant expression. Error: why it is none, or no finite number.
Result<double> constantOf(std::string_view text);

/// A number for an input with this unit (InputSpec::unit) of a document with those lengths. Lengths may be in
/// mm, cm, m, km, um, in, ft, ' and "; angles in deg, °, rad and turn; a number that may be anything in both,
/// others in none. Errors: as constantOf(); what is no unit; a unit that does not fit; units that come to no
/// length.
Result<double> typedNumber(std::string_view text, std::string_view unit, const LengthUnit& lengths);

}  // namespace fw
