// What is wrong with the document, as it is known now.
#pragma once

#include "editor/document/remedies.h"

namespace fw::editor {

struct Editor;

/// What there is to say of the document: of its file, of its groups' files, and what the preview's check
/// found. In this order; errors and warnings mixed.
std::vector<Error> problemsOf(const Editor& editor);

/// Problems with what can be done about each: found once for a state of the document.
struct ShownProblems {
    struct Problem {
        Error error = {};
        std::vector<Remedy> remedies = {};
    };
    std::vector<Problem> all = {};
    std::vector<Error> of = {};  ///< what it was made of,
    uint64_t drawn = 0;          ///< and of which revision of the document
};

}  // namespace fw::editor
