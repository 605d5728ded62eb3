// What work beside the interface does alike, whatever it makes.
#pragma once

#include <functional>
#include <new>
#include <vector>

#include "graph/check/check.h"
#include "runtime/gpu/device.h"

namespace fw::editor {

/// The work, once more if its device is lost, of which `again` hears; what it throws is an Error. `remedy`:
/// what to do where there was no memory.
template <class Work>
auto attempt(Work work, const std::function<void()>& again, const char* remedy) -> decltype(work()) {
    try {
        return onceMoreIfLost(work, again);
    } catch (const std::bad_alloc&) {
        return Error{.message = std::string("out of memory: ") + remedy};
    } catch (const std::exception& error) { return Error{.message = error.what()}; }
}

/// What keeps the graph from being made into anything.
inline std::vector<Error> errorsOf(const Graph& graph) {
    std::vector<Error> errors = check(graph);
    std::erase_if(errors, [](const Error& each) { return each.severity != Error::Severity::error; });
    return errors;
}

}  // namespace fw::editor
