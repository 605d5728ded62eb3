#include "runtime/jobs/openjd.h"

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "graph/base/words.h"
#include "runtime/jobs/task_script.h"
#include "runtime/system/output_file.h"

namespace fw {

namespace {

using nlohmann::ordered_json;

constexpr std::size_t kLongestValue = 1024;
constexpr int kSecondsToEnd = 30;

struct PathParameter {
    const char *name, *type, *flow, *what;
    std::string value;
};

/// The last step is run with those before it: all of them.
std::string submitText(const Job& job, const std::vector<PathParameter>& parameters) {
    std::string text = R"(if command -v deadline >/dev/null; then
    exec deadline bundle submit . "$@"
elif command -v openjd >/dev/null; then
    exec openjd run template.json --run-dependencies --step )" +
                       shellWord(job.steps.back().name);
    for (const PathParameter& parameter : parameters)
        text += " \\\n        --job-param " + shellWord(parameter.name + ("=" + parameter.value));
    return text + R"( "$@"
fi
echo "$0: neither deadline nor openjd is installed (pip install openjd-cli): hand template.json in to your farm, with the values of parameter_values.json" >&2
exit 1
)";
}

/// Why the text cannot be in a template; empty if it can.
std::string unfit(const std::string& text) {
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto letter = static_cast<unsigned char>(text[i]);
        const bool c1 =
            letter == 0xC2 && i + 1 < text.size() && static_cast<unsigned char>(text[i + 1]) < 0xA0;
        if (letter < 0x20 || letter == 0x7F || c1) return "has a control character";
    }
    if (text.find("{{") != text.npos) return "has \"{{\", which means something else there";
    if (text.size() > kLongestValue) return "is longer than " + std::to_string(kLongestValue) + " letters";
    return {};
}

/// "Frames" of "--frames".
std::string parameterName(const std::string& option) {
    std::string name;
    for (const char letter : option)
        if (std::isalnum(static_cast<unsigned char>(letter)))
            name += name.empty() ? char(std::toupper(static_cast<unsigned char>(letter))) : letter;
    return name;
}

std::string reference(const std::string& name) { return "{{" + name + "}}"; }

/// The step, all of whose tasks have as many words.
ordered_json stepOf(const Job& job, const JobStep& step) {
    const std::vector<std::string>& words = step.tasks.front().words;
    ordered_json definitions = ordered_json::array(), arguments = ordered_json::array();
    std::string together;
    for (std::size_t at = 0; at < words.size(); ++at) {
        const auto same = [&](const JobTask& task) { return task.words[at] == words[at]; };
        if (std::ranges::all_of(step.tasks, same)) {
            arguments.push_back(words[at] == job.graph    ? reference("Param.Graph")
                                : words[at] == job.output ? reference("Param.Output")
                                                          : words[at]);
            continue;
        }
        const std::string name = parameterName(words[at - 1]);
        ordered_json values = ordered_json::array();
        for (const JobTask& task : step.tasks) values.push_back(task.words[at]);
        definitions.push_back({{"name", name}, {"type", "STRING"}, {"range", values}});
        arguments.push_back(reference("Task.Param." + name));
        together += (together.empty() ? "" : ", ") + name;
    }
    arguments.push_back("--openjd");
    ordered_json made = {{"name", step.name}};
    if (!definitions.empty()) {
        made["parameterSpace"] = {{"taskParameterDefinitions", definitions}};
        if (definitions.size() > 1) made["parameterSpace"]["combination"] = "(" + together + ")";
    }
    made["script"]["actions"]["onRun"] = {
        {"command", reference("Param.Fieldwright")},
        {"args", arguments},
        {"cancelation", {{"mode", "NOTIFY_THEN_TERMINATE"}, {"notifyPeriodInSeconds", kSecondsToEnd}}}};
    return made;
}

Done writeJson(const std::string& path, const ordered_json& text) {
    Result<OutputFile> file = OutputFile::open(path, nullptr);
    if (!file) return file.error();
    file->write(text.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n");
    return file->commit();
}

}  // namespace

Done writeOpenJdJob(const Job& job, const std::string& folder) {
    ordered_json steps = ordered_json::array();
    for (const JobStep& step : job.steps) {
        for (const JobTask& task : step.tasks)
            for (const std::string& word : task.words)
                if (const std::string why = unfit(word); !why.empty())
                    return Error{.message = inQuotes(word) + " cannot be in an OpenJD template: it " + why +
                                            ": give it another name"};
        steps.push_back(stepOf(job, step));
        if (steps.size() > 1)
            steps.back()["dependencies"] = {{{"dependsOn", job.steps[steps.size() - 2].name}}};
    }
    if (const std::string why = unfit(job.program); !why.empty())
        return Error{.message = inQuotes(job.program) + " cannot be in an OpenJD template: it " + why};
    const std::vector<PathParameter> parameters = {
        {"Fieldwright", "FILE", "NONE", "The program, as the machines call it", job.program},
        {"Graph", "FILE", "IN", "The graph", job.graph},
        {"Output", job.makesFolder ? "DIRECTORY" : "FILE", "OUT", "What is made", job.output}};
    ordered_json definitions = ordered_json::array(), values = ordered_json::array();
    for (const PathParameter& parameter : parameters) {
        definitions.push_back({{"name", parameter.name},
                               {"type", "PATH"},
                               {"objectType", parameter.type},
                               {"dataFlow", parameter.flow},
                               {"description", parameter.what}});
        values.push_back({{"name", parameter.name}, {"value", parameter.value}});
    }
    const Done written =
        writeJson(folder + "/template.json", {{"specificationVersion", "jobtemplate-2023-09"},
                                              {"name", job.name},
                                              {"parameterDefinitions", definitions},
                                              {"steps", steps}});
    if (!written) return written;
    const Done valued = writeJson(folder + "/parameter_values.json", {{"parameterValues", values}});
    if (!valued) return valued;
    return writeScript(folder + "/submit",
                       "#!/bin/sh\n"
                       "# Hands template.json in: by deadline to a farm, or by openjd to be run here.\n" +
                           std::string(kSubmitBegin) + submitText(job, parameters));
}

}  // namespace fw
