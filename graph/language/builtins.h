// The built-in functions and the operators of the field language: what types they take and give, and what
// they are made of.
//
// A function of the table at the end of builtins.cpp has a rule for its types, by which code is checked
// before any of it is lowered, and a way to lower it, which can rely on those types. A number is a float, an
// int or a surface, which stands for its distance. What varies at run time is only whether a value that is
// typed as a surface is one or a float.
#pragma once

#include <span>
#include <string_view>
#include <variant>

#include "graph/language/value.h"

namespace fw::language {

/// What is wrong with the types of arguments: which of them (-1: all), and "expected …, found …".
struct TypeProblem {
    int argument = -1;
    std::string message;
};
using TypeResult = std::variant<Type, TypeProblem>;

struct Builtin {
    std::string_view name;
    int least, most;  ///< number of arguments
    TypeResult (*type)(std::span<const Type>);
    /// Errors without a place: an image that cannot be read.
    Result<Value> (*lower)(Lowering&, std::span<const Value>);
};

/// The built-in function of this name; nullptr if there is none.
const Builtin* findBuiltin(std::string_view name);
/// Names of all built-ins, for "did you mean".
std::vector<std::string> builtinNames();

bool isVector(Type type);
/// A float, an int, or a surface as its distance.
bool isNumber(Type type);
/// "a float", "an int", …
std::string aType(Type type);

/// Of a op b for + - * / %: componentwise, a number joining every component.
TypeResult arithmeticType(Type a, Type b, char operation);
Value arithmetic(Lowering& state, char operation, const Value& a, const Value& b);

/// Of condition ? a : b: the type that both sides have, or that one converts to: a number to a vector or a
/// surface.
std::optional<Type> commonType(Type a, Type b);
/// `condition` is a boolean's id. Error, without a place: texts and points, which differ, by a condition that
/// is not known when the graph is compiled.
Result<Value> choose(Lowering& state, IrId condition, const Value& a, const Value& b);

}  // namespace fw::language
