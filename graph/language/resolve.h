// The checked front end: names become slots and every expression gets a type, before anything is lowered.
//
// What a code text may hold is decided here, statement by statement, from the types of its inputs alone:
// names that exist, functions with the arguments they take, widths that agree, conditions that are booleans,
// results on every path that reads. What only the values can tell (a loop's bounds, an index, a division by
// zero, the size of what comes out) is left to lower.h.
//
// A variable has one type, that of its declaration. Only one thing depends on what comes later: a name that
// begins as a number and is given a surface somewhere is a surface's name from the start. So that this takes
// time linear in the code, each store of a number notes which other variables would make it a surface, the
// notes are followed once, and the code is resolved a second time where that changed anything.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "graph/language/code.h"
#include "graph/language/parser.h"

namespace fw::language {

/// What a code text sees, and what is wanted of it.
struct Declared {
    /// Names and types of inputs; none for what is not known because of a mistake elsewhere.
    std::vector<std::pair<std::string, std::optional<Type>>> inputs = {};
    /// Wanted results: of one, the type that the code's own converts to; of several, names that the code
    /// assigns. None: one of any type that a socket can hold.
    std::vector<OutputSpec> outputs = {};
};

/// The checked code, or what is wrong with it: up to kMaxCodeErrors, in the order of their places.
struct Resolved {
    std::shared_ptr<const Code> code;
    Type type = Type::scalar;  ///< of the first result
    std::vector<Error> errors;
};

Resolved resolve(std::string_view code, const Declared& declared);

}  // namespace fw::language
