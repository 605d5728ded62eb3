// The field language: text into a syntax tree. What the tree means is in resolve.h.
//
// Grammar (GLSL's, less types that a field does not need, plus what procedural listings are written in):
//
//   code      = { function } { statement }
//   function  = type name "(" [ type name { "," type name } ] ")" block
//   statement = [ "const" ] type name [ "=" expr ] { "," name [ "=" expr ] } ";"
//             | target ( "=" | "+=" | "-=" | "*=" | "/=" | "%=" ) expr ";" | target ( "++" | "--" ) ";"
//             | "if" "(" expr ")" statement [ "else" statement ] | "return" [ expr ] ";" | "break" ";"
//             | "continue" ";" | "for" "(" statement expr ";" step ")" statement | block | ";" | expr ";"
//   block     = "{" { statement } "}"
//   target    = name { "." swizzle }
//   type      = "float" | "int" | "bool" | "vec2" | "vec3"      (and HLSL's float2, float3)
//
// Assigning to an unknown name declares it. The semicolon of the last statement may be missing.
//
// Expressions are read by operator precedence with a stack of what is still open, and kept in postfix order,
// operands before what joins them, so that nothing that reads them needs recursion. Statements nest by
// recursion, at most kMaxDepth deep. After a mistake reading goes on behind the statement, so that one pass
// finds several.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "graph/language/lexer.h"
#include "graph/library/types.h"

namespace fw::language {

/// One operand or operator of an expression in postfix order.
struct Expr {
    enum class Kind : unsigned char {
        number,
        text,
        name,
        member,       ///< of one operand
        index,        ///< of the operand before, the one on top being the index
        call,         ///< with `count` arguments
        unary,        ///< - or !
        binary,       ///< any of the others
        then,         ///< behind the condition of ?:
        otherwise,    ///< behind its first value
        conditional,  ///< behind its second
    } kind;
    Place place;
    std::string text{};  ///< the name, member, called function, operator or string
    double number = 0.0;
    bool integer = false;  ///< a number without point or exponent
    int count = 0;
};

/// Part of Tree::expressions, [first, last).
struct Range {
    int first = 0, last = 0;
    bool empty() const { return first == last; }
};

/// Index of a statement in its Tree.
using StmtId = int;

struct Stmt {
    enum class Kind : unsigned char { assign, branch, loop, result, leave, next, block, evaluate } kind;
    Place place;
    // assign
    bool declares = false;     ///< of a block: its declarations belong to the surrounding one
    bool constant = false;     ///< of a declaration: const
    Type type = Type::scalar;  ///< of a declaration
    std::string target{}, swizzle{};
    char operation = 0;  ///< 0 for =, else the operator of +=, -=, …
    /// assign: the value (empty for a declaration without one, and for ++ and --, which add and take 1);
    /// branch, loop: the condition; result: the value
    Range expression{};
    /// branch: then, else; loop: start, step, body; block: its statements
    std::vector<StmtId> body{};
};

struct Function {
    std::string name;
    Type result;
    std::vector<std::pair<Type, std::string>> parameters;
    StmtId first, body;  ///< the statements of it: from `first` to its block
    Place place;
};

/// One parsed code text. Statements refer to each other by index.
struct Tree {
    std::vector<Expr> expressions;
    std::vector<Stmt> statements;
    std::vector<Function> functions;
    std::vector<StmtId> body;
    std::vector<Error> errors;  ///< what could not be read; the tree then lacks those statements
};

/// Greatest depth of nested expressions and statements.
inline constexpr int kMaxDepth = 256;
/// Mistakes that are told of one code text.
inline constexpr std::size_t kMaxCodeErrors = 20;

/// The type that code declares with this word; none if it is no type's.
std::optional<Type> declaredType(std::string_view name);
/// Whether it is a word of the language that names nothing: "if", "return", …
bool isReserved(std::string_view name);

/// Parses `code`. Each Error names its place.
Tree parse(std::string_view code);

}  // namespace fw::language
