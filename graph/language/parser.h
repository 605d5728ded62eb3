// The field language: text into a syntax tree. What the tree means is in lower.h.
//
// Grammar (GLSL's, less types that a field does not need, plus what procedural listings are written in):
//
//   code      = { function } { statement }
//   function  = type name "(" [ type name { "," type name } ] ")" block
//   statement = [ "const" ] type name [ "=" expr ] { "," name [ "=" expr ] } ";"
//             | target ( "=" | "+=" | "-=" | "*=" | "/=" | "%=" ) expr ";" | target ( "++" | "--" ) ";"
//             | "if" "(" expr ")" statement [ "else" statement ] | "return" [ expr ] ";" | "break" ";" |
//             "continue" ";" | "for" "(" statement expr ";" step ")" statement | block | ";" | expr ";"
//   block     = "{" { statement } "}"
//   target    = name { "." swizzle }
//   type      = "float" | "int" | "bool" | "vec2" | "vec3"      (and HLSL's float2, float3)
//
// Assigning to an unknown name declares it. The semicolon of the last statement may be missing.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "graph/language/lexer.h"
#include "graph/library/types.h"

namespace fw::language {

/// Index of an expression or statement in its Tree.
using ExprId = int;
using StmtId = int;
inline constexpr int kNothing = -1;

struct Expr {
    enum class Kind : unsigned char {
        number,
        string,
        name,
        member,
        index,
        call,
        unary,
        binary,
        conditional
    } kind;
    Place place;
    std::string text;  ///< the name, member, called function, operator or string
    double number = 0.0;
    bool integer = false;             ///< a number without point or exponent
    std::vector<ExprId> arguments{};  ///< operands, call arguments; of member and index: the object first
    int depth = 1;                    ///< of the tree below
};

struct Stmt {
    enum class Kind : unsigned char { assign, branch, loop, result, leave, next, block, evaluate } kind;
    Place place;
    // assign
    bool declares = false;
    bool constant = false;     ///< of a declaration: const
    Type type = Type::scalar;  ///< of a declaration
    std::string target{}, swizzle{};
    std::string operation{};  ///< "" for =, else the operator of +=, -=, …
    // assign: the value (kNothing for a declaration without one); branch, loop: the condition; result: the
    // value
    ExprId expression = kNothing;
    // branch: then, else; loop: start, step, body; block: its statements
    std::vector<StmtId> body{};
};

struct Function {
    std::string name;
    Type result;
    std::vector<std::pair<Type, std::string>> parameters;
    StmtId body;
    Place place;
};

/// One parsed code text. Expressions and statements refer to each other by index, so a tree of any shape is
/// freed without recursion.
struct Tree {
    std::vector<Expr> expressions;
    std::vector<Stmt> statements;
    std::vector<Function> functions;
    std::vector<StmtId> body;

    const Function* function(std::string_view name) const;
};

/// Greatest depth of nested expressions and statements.
inline constexpr int kMaxDepth = 256;

/// Parses `code`; the Error names the place inside it.
Result<std::shared_ptr<const Tree>> parse(std::string_view code);

}  // namespace fw::language
