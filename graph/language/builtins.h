// The built-in functions of the field language (see builtins.cpp for the list).
#pragma once

#include <span>
#include <string_view>

#include "graph/language/lower.h"

namespace fw::language {

/// True if `name` is a built-in function.
bool isBuiltin(std::string_view name);

/// Calls the built-in; the Error (wrong number or types of arguments) has no place yet.
Result<Value> callBuiltin(Lowering& state, std::string_view name, std::span<const Value> arguments);

/// a op b for + - * / %, componentwise, a scalar joining every component.
Result<Value> arithmetic(Lowering& state, char operation, const Value& a, const Value& b);

/// condition ? a : b on any two values of one type (surfaces and floats mix). `condition` is a boolean's id.
Result<Value> choose(Lowering& state, IrId condition, const Value& a, const Value& b);

/// Names of all built-ins, for "did you mean".
std::vector<std::string> builtinNames();

}  // namespace fw::language
