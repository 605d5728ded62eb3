// Checked code: what a code text does, as one list of instructions without names or recursion.
//
// Expressions are postfix: operands are pushed, operators take theirs from the top. Names have become slots:
// each function has its own, numbered in the order of their declarations. Structures (?:, if, for) are
// instructions around what they hold, whose `target` is the instruction behind their next part.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "graph/language/builtins.h"
#include "graph/language/lexer.h"

namespace fw::language {

struct Instruction {
    enum class Kind : unsigned char {
        // push
        number,  ///< `number`, of `type`
        text,    ///< texts[index]
        slot,
        input,
        position,
        time,
        // take from the top, and push
        negate,
        logicalNot,
        arithmetic,  ///< by `symbol`; and so the next two: '<', 'l' for <=, '>', 'g' for >=, '=', '!' for !=;
                     ///< '&', '|'
        compare,
        logical,
        part,       ///< `count` of the surface's scalars from `index`
        swizzle,    ///< `count` components, two bits each in `index`
        element,    ///< of points or a vector, by the index on top
        builtin,    ///< builtins[index]
        node,       ///< nodes[index]
        function,   ///< functions[index]
        elsewhere,  ///< the field below, at the position on top
        // ?: behind its condition, its first value, its second
        then,
        otherwise,
        chosen,
        // take from the top
        declare,       ///< slot `index`: as `type`, or as it is where `count` is 1
        store,         ///< slot `index`
        storePart,     ///< as part, of slot `target`
        storeSwizzle,  ///< as swizzle, of slot `target`
        result,        ///< return; goes to `target`, the end of the innermost structure
        // structures
        branch,     ///< if, behind its condition; `target` is behind the matching `otherSide`
        otherSide,  ///< `target` is behind `joined`
        joined,
        loop,    ///< `target` is behind `looped`
        test,    ///< behind a loop's condition, `target` likewise
        step,    ///< before a loop's step: `target` likewise
        repeat,  ///< back to `index`, the loop's condition
        looped,
        leave,  ///< break; goes to `target`, the end of the innermost structure
        next,   ///< continue; likewise
    } kind;
    char symbol = 0;
    uint8_t count = 0;
    Type type = Type::scalar;
    int index = 0;
    int target = 0;
    Place place{};
    double number = 0.0;
};

/// A variable of a function.
struct Slot {
    Type type;  ///< a surface: may hold a float too, as long as it was given nothing else
    int depth;  ///< how many branches and loops it was declared in
};

/// The code itself, or a function of its own.
struct CodeFunction {
    std::string name{};
    std::vector<Type> parameters{};  ///< held by the first slots
    Type result = Type::scalar;
    std::vector<Slot> slots{};
    std::vector<std::pair<int, int>>
        captured{};  ///< slots that begin as inputs, with the input; -1: as the position
    std::vector<Instruction> instructions{};
    Place place{};
};

struct Code {
    std::vector<CodeFunction> functions;  ///< the first is the code itself
    std::vector<std::string> texts;
    std::vector<const Builtin*> builtins;
    std::vector<const NodeType*> nodes;
    std::vector<int> outputs;  ///< of code that assigns its outputs: their slots
    bool returns = false;      ///< whether any `return` stands in the code itself
    int last = -1;             ///< the slot that is the result where none was returned; -1 if there is none
};

}  // namespace fw::language
