#include "runtime/cli/options/words.h"

#include <cmath>

#include "graph/base/result.h"
#include "graph/base/words.h"
#include "graph/language/typed_number.h"

namespace fw::cli {

CLI::Validator finite() {
    return CLI::Validator(
        [](const std::string& text) {
            double number = 0.0;
            const bool fine = CLI::detail::lexical_cast(text, number) && std::isfinite(number);
            return fine ? std::string() : inQuotes(text) + " is not a finite number" + unitHint(text);
        },
        "NUMBER");
}

CLI::Validator whole(int least, int greatest) {
    const std::string range = std::to_string(least) + " to " + std::to_string(greatest);
    return CLI::Validator(
        [=](const std::string& text) {
            int number = 0;
            const bool fine =
                CLI::detail::lexical_cast(text, number) && number >= least && number <= greatest;
            return fine ? std::string() : inQuotes(text) + " is not a whole number from " + range;
        },
        range);
}

CLI::Validator something() {
    return CLI::Validator(
        [](const std::string& text) { return text.empty() ? std::string("is empty") : std::string(); }, "");
}

CLI::Validator length() {
    return CLI::Validator(
        [](const std::string& text) {
            const Result<double> number = typedNumber(text, "m", *lengthUnit("m"));
            if (!number) return number.error().message;
            return *number > 0.0 ? std::string() : inQuotes(text) + " is not above 0";
        },
        "");
}

CLI::Validator assignment() {
    return CLI::Validator(
        [](const std::string& text) {
            return text.find('=') != std::string::npos ? std::string()
                                                       : inQuotes(text) + " sets nothing: write name=value";
        },
        "NAME=VALUE");
}

CLI::Validator oneOf(std::vector<std::string> words) {
    const std::string shown = "{" + CLI::detail::join(words, ",") + "}";
    return CLI::Validator(
        [words = std::move(words)](const std::string& text) {
            if (std::find(words.begin(), words.end(), text) != words.end()) return std::string();
            const std::string near = nearestName(text, words);
            return inQuotes(text) + " is none of " + listed(words) +
                   (near.empty() ? "" : ": did you mean " + inQuotes(near) + "?");
        },
        shown);
}

namespace {

/// Of the first word that the command does not take: an option that there is not, or a word too many.
std::string extraMessage(const CLI::App* command) {
    std::vector<std::string> extras = command->remaining(true), names;
    for (const CLI::Option* option : command->get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    const auto option = std::find_if(extras.begin(), extras.end(),
                                     [](const std::string& word) { return word.starts_with('-'); });
    if (option == extras.end()) return "not expected: " + (extras.empty() ? "" : extras.front());
    const std::string name = option->substr(0, option->find('=')), near = nearestName(name, names);
    std::string message = "there is no option " + inQuotes(name);
    if (name.starts_with("--unit") || name.starts_with("--scale"))
        message += ": lengths are metres, in .3mf millimetres";
    return message + (near.empty() ? "" : ": did you mean " + inQuotes(near) + "?");
}

}  // namespace

TypedCommand typedCommand(const CLI::App& command) {
    TypedCommand typed{.name = command.get_name(), .options = {}};
    for (const CLI::Option* option : command.get_options()) {
        if (option->count() == 0) continue;
        TypedOption& given = typed.options.emplace_back();
        if (!option->get_positional()) given.name = "--" + option->get_lnames().front();
        if (option->get_expected_min() == 0) continue;  // a flag
        given.values = option->results();
        given.each = !option->get_allow_extra_args() && given.values.size() > 1;
    }
    return typed;
}

std::string usageMessage(const CLI::App* app, const CLI::Error& error) {
    std::string command = "fieldwright";
    const CLI::App* inner = app;
    for (const CLI::App* used : app->get_subcommands()) command += " " + used->get_name(), inner = used;
    const bool extra = error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError);
    return command + ": " + (extra ? extraMessage(inner) : error.what()) + "\nTry: " + command + " --help\n";
}

}  // namespace fw::cli
