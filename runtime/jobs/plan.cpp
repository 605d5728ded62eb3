#include "runtime/jobs/plan.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "graph/base/words.h"

namespace fw {

namespace fs = std::filesystem;

namespace {

constexpr long kFramesOfTask = 10, kVariantsOfTask = 100;

bool isTable(const std::string& text) { return lowered(text).ends_with(".csv"); }

/// The command with absolute paths, wherever it is begun.
TypedCommand anywhere(TypedCommand command) {
    for (TypedOption& option : command.options)
        for (std::string& value : option.values)
            if (option.name.empty() || option.name == "--output" || option.name == "--report" ||
                option.name == "--cache" || (option.name == "--sweep" && isTable(value)))
                value = fs::absolute(value).string();
    return command;
}

TypedOption* find(TypedCommand& command, std::string_view name) {
    const auto found = std::ranges::find(command.options, name, &TypedOption::name);
    return found == command.options.end() ? nullptr : &*found;
}

std::string valueOf(TypedCommand& command, std::string_view name) {
    const TypedOption* option = find(command, name);
    return option && !option->values.empty() ? option->values.front() : std::string();
}

TypedCommand without(TypedCommand command, std::initializer_list<std::string_view> names) {
    std::erase_if(command.options,
                  [&](const TypedOption& option) { return std::ranges::count(names, option.name) > 0; });
    return command;
}

TypedCommand with(TypedCommand command, TypedOption option) {
    command.options.push_back(std::move(option));
    return command;
}

std::vector<std::string> wordsOf(const TypedCommand& command) {
    std::vector<std::string> words = {command.name};
    const auto add = [&](const std::string& name, const std::string& value) {
        if (value.starts_with('-') && name.starts_with("--")) return words.push_back(name + "=" + value);
        words.insert(words.end(), {name, value});
    };
    for (const TypedOption& option : command.options) {
        if (option.each || (option.values.size() == 1 && !option.name.empty())) {
            for (const std::string& value : option.values) add(option.name, value);
            continue;
        }
        if (!option.name.empty()) words.push_back(option.name);
        words.insert(words.end(), option.values.begin(), option.values.end());
    }
    return words;
}

/// Runs of consecutive numbers, a task each.
JobStep stepOfMany(const TypedCommand& command, const JobWork& work, long chunk) {
    JobStep step{.name = std::string(work.one) + "s"};
    for (long first = work.first; first < work.last; first += chunk) {
        const long last = std::min(first + chunk, work.last) - 1;
        const std::string from = std::to_string(first), to = std::to_string(last);
        step.tasks.push_back({first == last ? work.one + (" " + from) : step.name + " " + from + " to " + to,
                              wordsOf(with(command, {"--frames", {from + "-" + to}}))});
    }
    return step;
}

void addParts(Job& job, const TypedCommand& command, long parts, const std::string& folder) {
    const TypedCommand bare = without(command, {"--output", "--report", "--require"});
    TypedCommand merge{.name = "merge", .options = {{.name = ""}}};
    JobStep tiles{.name = "tiles"};
    for (long part = 1; part <= parts; ++part) {
        const std::string file = folder + "/parts/" + std::to_string(part) + ".part";
        const std::string share = std::to_string(part) + "/" + std::to_string(parts);
        tiles.tasks.push_back({"part " + share + " of the tiles",
                               wordsOf(with(with(bare, {"--output", {file}}), {"--tile", {share}}))});
        merge.options.front().values.push_back(file);
    }
    for (const TypedOption& option : command.options)
        if (option.name == "--output" || option.name == "--report" || option.name == "--require")
            merge.options.push_back(option);
    job.steps = {std::move(tiles),
                 {"merge", {{"the merge of " + std::to_string(parts) + " parts", wordsOf(merge)}}}};
}

/// The first step, into a cache that the command then reads.
void addSimulation(Job& job, TypedCommand& command, const std::string& cache) {
    TypedCommand simulate{.name = "simulate", .options = {}};
    for (const TypedOption& option : command.options)
        if (option.name == "--particles")
            simulate.options.push_back({"--node", option.values});
        else if (option.name.empty() || option.name == "--set" || option.name == "--from" ||
                 option.name == "--to" || option.name == "--fps" || option.name == "--range" ||
                 option.name == "--device")
            simulate.options.push_back(option);
    simulate.options.push_back({"--output", {cache}});
    job.steps.push_back({"simulate", {{"the simulation", wordsOf(simulate)}}});
    command.options.push_back({"--cache", {cache}});
}

std::string jobName(const std::string& graph) {
    std::string name = fs::path(graph).filename().string();
    name = name.substr(0, name.find(".field.json"));
    for (char& letter : name)
        if (!std::isalnum(static_cast<unsigned char>(letter)) && letter != '-' && letter != '.') letter = '_';
    return name.empty() || name.size() > 60 ? "fieldwright" : name;
}

}  // namespace

Result<Job> planJob(const TypedCommand& typed, const JobWork& work, const JobSharing& sharing,
                    const std::string& folder) {
    TypedCommand command = anywhere(typed);
    Job job{.graph = valueOf(command, ""), .output = valueOf(command, "--output")};
    job.name = jobName(job.graph), job.makesFolder = work.one;
    const long count = work.last - work.first;
    if (!work.one) {
        if (sharing.chunk)
            return Error{.message =
                             "--chunk is of frames or variants, and this makes one file: leave it out"};
        if (work.parts <= 1 && sharing.tasks && *sharing.tasks > 1)
            return Error{.message =
                             "--tasks is of frames, of variants and of the tiles of one mesh, and this is "
                             "made as a whole: leave it out"};
        if (work.parts > 1)
            addParts(job, command, work.parts, fs::absolute(folder).string());
        else
            job.steps = {{command.name, {{"the " + command.name, wordsOf(command)}}}};
        return job;
    }
    if (work.simulates) addSimulation(job, command, fs::absolute(folder).string() + "/cache");
    const long usual = work.one == std::string_view("frame") ? kFramesOfTask : kVariantsOfTask;
    const long least = (count + kMostJobTasks - 1) / kMostJobTasks;
    const long chunk = sharing.chunk   ? *sharing.chunk
                       : sharing.tasks ? (count + *sharing.tasks - 1) / *sharing.tasks
                                       : std::max(usual, least);
    if (chunk < least)
        return Error{.message = "a job has at most " + std::to_string(kMostJobTasks) +
                                " tasks: give --chunk " + std::to_string(least) + " or more"};
    job.steps.push_back(stepOfMany(without(command, {"--report", "--frames"}), work, chunk));
    if (find(command, "--report"))
        job.steps.push_back(
            {"report", {{"the report", wordsOf(without(command, {"--overwrite", "--require"}))}}});
    return job;
}

}  // namespace fw
