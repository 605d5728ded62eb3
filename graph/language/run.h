// The execution of checked code: see lower.h for what it does. Not for use outside lower*.cpp.
#pragma once

#include <optional>
#include <vector>

#include "graph/language/lower.h"

namespace fw::language {

struct Failure {
    Error error;
};

/// What a variable was when a structure began, of those that it assigned.
struct Change {
    int slot;
    std::optional<Value> before;
    int logged;  ///< where it stood in the log of changes when this one came; -1: nowhere
};

/// Some places left a loop, or an iteration, under this condition, with these variables.
struct Exit {
    IrId condition;
    std::vector<std::pair<int, Value>> values;
};

/// A branch or a loop that is under way.
struct Structure {
    bool known = false;            ///< a branch whose condition is
    int depth = 0;                 ///< slots that were declared at it or deeper are its own
    std::size_t log = 0;           ///< where its changes begin
    IrId condition = 0, live = 0;  ///< live: before it
    // of a branch: of its first side
    IrId firstLive = 0, firstBegan = 0;
    std::vector<std::pair<int, std::optional<Value>>> first = {};
    // of a loop
    bool loops = false;
    std::vector<Exit> left = {}, skipped = {};  ///< by break; by continue, in this iteration
    std::size_t returns = 0;                    ///< of the frame, when it began
    std::size_t departures = 0;                 ///< breaks and returns, when this iteration began
};

/// One running function.
struct Frame {
    const CodeFunction* function;
    std::size_t at = 0;
    IrId live = 0;  ///< boolean: the instruction counts
    std::vector<std::optional<Value>> slots = {};
    std::vector<int> logged = {};  ///< of each slot: its newest entry in the log, -1 if there is none
    std::vector<Change> log = {};
    std::vector<Structure> structures = {};
    std::optional<Value> result = {};
    std::size_t returns = 0;
    std::size_t operands = 0;  ///< on the stack below it
};

class Run {
  public:
    Run(Lowering& state_, const Code& code_, std::vector<Value> inputs_, const LowerOptions& options_)
        : state(state_), ir(state_.ir), code(code_), inputs(std::move(inputs_)), options(options_) {}

    std::vector<Value> outputs();

  private:
    // lower.cpp
    [[noreturn]] static void fail(Place place, const std::string& message,
                                  Error::Code code = Error::Code::other);
    Value checked(Result<Value> result, Place place);
    /// `value` as a variable of `type` holds it: an int truncates.
    Value stored(const Value& value, Type type, Place place);
    void step(Place place);
    void enter(int index, Place place);
    void leave();
    std::vector<Value> results(const Frame& frame);
    Value positionValue() const;
    static Value boolean(IrId id) { return Value{Type::boolean, {id}}; }
    Value pop();
    void push(const Value& value);
    void run(Frame& frame, const Instruction& i);
    void joined(const Instruction& i);
    IrId compared(char symbol, const Value& a, const Value& b);
    /// An Error where a divisor of the user's code is the constant 0.
    void refuseZero(const Value& divisor, Place place);
    Value part(const Value& whole, const Instruction& i);
    void element(const Instruction& i);
    void call(const Instruction& i);
    /// The choices and ranges of a node's input hold for arguments as they do for what a document gives.
    void requireRange(const NodeType& type, std::size_t index, const Value& value, Place place);
    void elsewhere(const Instruction& i);
    // lower_structures.cpp
    void conditional(Frame& frame, const Instruction& i);
    /// The innermost structure whose changes are kept; nullptr if there is none.
    static Structure* innermost(Frame& frame);
    static void assign(Frame& frame, int slot, std::optional<Value> value);
    /// Takes the structure's changes off the log, oldest first.
    static std::vector<Change> takeChanges(Frame& frame, std::size_t from);
    void store(Frame& frame, const Instruction& i);
    /// At the end of a structure: whoever is not reached goes on behind the one around.
    void skipUnreached(Frame& frame, const Instruction& i);
    void branch(Frame& frame, const Instruction& i);
    /// Both sides of a branch come together.
    void join(Frame& frame, const Structure& done, Place place);
    static int depthOf(const Frame& frame) { return static_cast<int>(frame.structures.size()); }
    Structure& loopOf(Frame& frame);
    void loop(Frame& frame, const Instruction& i);
    /// Whoever left comes back: each variable that the loop changed is, for them, what it was when they left.
    void rejoin(Frame& frame, const Structure& own, const std::vector<Exit>& exits, Place place);
    void depart(Frame& frame, const Instruction& i);
    Lowering& state;
    Ir& ir;
    const Code& code;
    std::vector<Value> inputs;
    const LowerOptions& options;
    std::vector<Frame> frames;
    std::vector<Value> stack;
    std::vector<IrId> choices;  ///< conditions of ?: under way
};

}  // namespace fw::language
