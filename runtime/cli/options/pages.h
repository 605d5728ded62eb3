// A program's manual page and its completions for shells. Both are read from the table of options that its
// command line is parsed with, so that each fact stands there once.
#pragma once

#include <CLI/CLI.hpp>

namespace fw::cli {

/// Adds the options --manual and --completion SHELL, which print a page (roff, as `man` reads it) or a script
/// for bash, zsh or fish, and end the parsing with CLI::Success. The program and all its commands must
/// outlive the parsing.
void addPages(CLI::App& program);

}  // namespace fw::cli
