// CodeField: the first component of a code's result, as the field of an Ir.
#pragma once

#include <string>

#include "graph/ir/ir.h"

namespace fw::test {

struct CodeField {
    Ir ir;
    IrId distance;
};

/// The code at that time. Reports a failure of the test if it does not compile.
CodeField fieldOfCode(const std::string& code, double time = 0.0);

}  // namespace fw::test
