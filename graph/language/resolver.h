// The state of resolve(), and its expressions. Not for use outside resolve*.cpp.
#pragma once

#include <optional>
#include <unordered_map>
#include <vector>

#include "graph/language/resolve.h"

namespace fw::language {

/// Names of variables in the blocks that are open, later ones hiding earlier ones.
class Names {
  public:
    void open() { opened.push_back(added.size()); }
    void close();
    void add(std::string_view name, int slot);
    /// The slot; -1 if there is no variable of this name.
    int find(std::string_view name) const;
    void collect(std::vector<std::string>& names) const;

  private:
    std::unordered_map<std::string_view, std::vector<int>> slots;
    std::vector<std::string_view> added;
    std::vector<std::size_t> opened;
};

/// Which slots hold surfaces though they begin as numbers: of all functions, counted on.
struct SurfaceSlots {
    std::vector<bool> known;                ///< from the resolution before
    std::vector<std::pair<int, int>> flow;  ///< whatever makes the first a surface makes the second one
    std::vector<int> given;                 ///< those that are given a surface
    /// Follows the flow; whether there are more than are known.
    bool follow(int count);
};

/// What an expression's part gives.
struct Operand {
    std::optional<Type> type;  ///< none: a mistake was told already
    Place place;
    std::vector<int> sources{};  ///< slots of numbers that would make it a surface
};

class Resolver {
  public:
    Resolver(const Tree& tree, const Declared& declared, SurfaceSlots& surfaces);

    void run();
    Code code;
    Type type = Type::scalar;  ///< of the first result
    std::vector<Error> errors;
    int slotCount() const { return slotBase + static_cast<int>(made().slots.size()); }

  private:
    /// What a part of a function has come to.
    struct Side {
        int last;
        bool ended;
    };

    // resolve.cpp: functions, statements, results
    void function(int index, const Function* declaration);
    void captureInputs(const Function* declaration);
    void statement(StmtId id);
    void declaration(const Stmt& s);
    void assignment(const Stmt& s);
    void storeInto(int slot, const Stmt& s, Operand value);
    void partialStore(int slot, const Stmt& s);
    void branch(const Stmt& s);
    int lastOf(const Side& before, const Side& first, const Side& second) const;
    void loop(const Stmt& s);
    void returned(const Stmt& s);
    void block(const Stmt& s);
    void finish();
    void checkCalls();
    int newSlot(std::optional<Type> type, const Operand* value);
    void leaveStructure(Instruction::Kind kind, Place place);
    void patchEnds(int target);
    std::optional<Type> slotType(int slot) const;

    // resolve_expressions.cpp
    Operand expression(Range range);
    void element(const Expr& e);
    void name(const Expr& e);
    void member(const Expr& e);
    void index(const Expr& e);
    void unary(const Expr& e);
    void binary(const Expr& e);
    void comparison(const Expr& e, const Operand& a, const Operand& b);
    void conditional(const Expr& e);
    void call(const Expr& e);
    void callBuiltin(const Expr& e, const Builtin& builtin, std::vector<Operand> arguments);
    void callNode(const Expr& e, const NodeType& type, const std::vector<Operand>& arguments);
    void callFunction(const Expr& e, int index, const std::vector<Operand>& arguments);
    void callField(const Expr& e, std::optional<Type> type, const std::vector<Operand>& arguments);
    void condition(const Operand& operand);
    bool pushNamed(std::string_view name, Place place);
    std::optional<Type> inputType(std::string_view name, int* index) const;
    void unknown(const Expr& e, std::string_view what);

    void error(Place place, std::string message);
    int emit(Instruction instruction);
    void push(std::optional<Type> pushedType, Place place, std::vector<int> sources = {}) {
        operands.push_back({pushedType, place, std::move(sources)});
    }
    Operand pop();
    CodeFunction& made() { return code.functions[current]; }
    const CodeFunction& made() const { return code.functions[current]; }

    const Tree& tree;
    const Declared& declared;
    SurfaceSlots& surfaces;
    std::unordered_map<std::string_view, int> functionIndices, inputIndices;
    std::vector<std::vector<std::pair<int, Place>>> callees;  ///< of each function
    std::vector<std::vector<bool>> known;  ///< of each function's slots: whether its type is

    // of the function at hand
    std::size_t current = 0;
    int slotBase = 0;
    Names names;
    std::vector<int> constants;  ///< slots that were declared const
    int depth = 0;               ///< of branches and loops
    int loops = 0;
    std::vector<std::vector<int>> ends;  ///< of each open structure: what goes to its end
    std::vector<Operand> operands;
    std::optional<Type> returnType;
    Place returnPlace;
    int last = -1;       ///< slot of what was assigned last; -2 where that depends
    int lonely = -1;     ///< slot of lone expressions
    bool ended = false;  ///< a return was passed on every path
};

extern const std::string kSurfaceMembers;  ///< listed for messages
/// The slot's place in a member list of surfaces: first scalar and type; none if surfaces have none of that
/// name.
std::optional<std::pair<int, Type>> surfaceMember(std::string_view name);
/// A swizzle's components, two bits each from the lowest; none if one is not among the first `width` of x, y,
/// z (or r, g, b or u, v).
std::optional<int> swizzleOf(std::string_view name, int width);

}  // namespace fw::language
