// What the command's options take, and what is said of an argument that is none of it.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "runtime/jobs/plan.h"

namespace fw::cli {

/// Accepts a number that is neither infinite nor a NaN.
CLI::Validator finite();
/// Accepts a whole number of this range.
CLI::Validator whole(int least, int greatest);
/// Accepts anything but nothing.
CLI::Validator something();
/// Accepts a length above 0, with or without a unit.
CLI::Validator length();
/// Accepts "name=value".
CLI::Validator assignment();
/// Accepts one of these words.
CLI::Validator oneOf(std::vector<std::string> words);

/// What was typed of a command that has been read.
TypedCommand typedCommand(const CLI::App& command);

/// What is wrong with the command line, and where more is said.
std::string usageMessage(const CLI::App* app, const CLI::Error& error);

}  // namespace fw::cli
