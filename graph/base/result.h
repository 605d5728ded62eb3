// The project's one error type, and the value-or-error that carries it.
//
// Three classes of failure exist (see ARCHITECTURE.md). A bug is an assert. What a user can cause (a file, a
// graph, code in a node, an option) is an `Error` returned inside a `Result<T>`. A failure of the device or
// the system is a `SystemError`, thrown, and caught once, in main.
#pragma once

#include <cassert>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace fw {

/// One finding about a user's input: what is wrong, where, and what to do about it. Empty fields are unknown.
struct Error {
    enum class Severity { error, warning };
    /// What some code must tell from other findings; the words of a message are for people alone.
    enum class Code : unsigned char {
        other,           ///< nothing that any code asks for
        unfinished,      ///< something is still missing: an output, a link
        wrongFile,       ///< an input names a file of another kind than it takes
        divisionByZero,  ///< by a constant, in a node's code
        tooMuchSurface,  ///< more than one mesh can have: in tiles there is room for it
        uselessCache,    ///< a particle cache is not there, or of another simulation: one simulates anew
        cancelled,       ///< the caller ended the work
    };

    std::string message = {};  ///< what is wrong and what to do, one sentence, no full stop needed
    std::string file = {};     ///< path as the user gave it
    std::string node = {};     ///< id of the node, "group/node" inside a group
    std::string input = {};    ///< name of the input of that node
    int line = 0;              ///< 1-based line in `file`, 0 if unknown
    int column = 0;            ///< 1-based column in `file`
    int codeLine = 0;          ///< 1-based line inside the node's code, 0 if the finding is not about code
    int codeColumn = 0;        ///< 1-based column inside the node's code
    Severity severity = Severity::error;
    Code code = Code::other;
    bool operator==(const Error&) const = default;
};

/// The error of work that was cancelled.
inline Error cancelledError() { return {.message = "cancelled", .code = Error::Code::cancelled}; }

/// "tower.field.json:12:5: error: node 'cut', input 'b', code 1:14: message"; parts that are unknown are left
/// out. One line whatever the parts hold: control characters as '?', and long parts are shortened.
std::string format(const Error& error);

/// At most `longest` bytes of `text`, whole characters, for one line of a terminal: control characters as
/// '?', and "…" where something was cut.
std::string inOneLine(std::string_view text, std::size_t longest);

/// `name` in single quotes for a message: shortened beyond 60 bytes, control characters as '?'.
std::string inQuotes(std::string_view name);

/// A failure of the device or the system (Vulkan, memory, disk): exit status 3.
struct SystemError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A value, or the Error that prevented it. `if (!result) return result.error();` passes an error on.
template <class T>
class [[nodiscard]] Result {
  public:
    Result(T value) : content(std::move(value)) {}
    Result(Error error) : content(std::move(error)) {}

    explicit operator bool() const { return content.index() == 0; }
    T& operator*() { return assert(*this), std::get<0>(content); }
    const T& operator*() const { return assert(*this), std::get<0>(content); }
    T* operator->() { return &**this; }
    const T* operator->() const { return &**this; }
    const Error& error() const { return assert(!*this), std::get<1>(content); }

  private:
    std::variant<T, Error> content;
};

/// Result of an action that yields nothing.
using Done = Result<std::monostate>;
inline Done done() { return std::monostate{}; }

}  // namespace fw
