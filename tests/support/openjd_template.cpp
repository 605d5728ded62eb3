#include "tests/support/openjd_template.h"

#include <algorithm>
#include <functional>
#include <map>
#include <regex>
#include <set>

namespace fw::test {

namespace {

using nlohmann::json;

const std::regex kIdentifier("[A-Za-z_][A-Za-z0-9_]{0,63}"), kReference(R"(\{\{\s*([A-Za-z0-9_.]+)\s*\}\})");

std::size_t lettersOf(const std::string& text) {  // of UTF-8
    return std::size_t(std::ranges::count_if(text, [](unsigned char c) { return (c & 0xC0) != 0x80; }));
}

bool hasControl(const std::string& text) {
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto c = static_cast<unsigned char>(text[i]);
        if (c < 0x20 || c == 0x7F) return true;
        if (c == 0xC2 && i + 1 < text.size() && static_cast<unsigned char>(text[i + 1]) < 0xA0) return true;
    }
    return false;
}

class Schema {
  public:
    std::vector<std::string> findings;

    void root(const json& job) {
        keys(job, "template", {"specificationVersion", "name", "steps"},
             {"$schema", "description", "parameterDefinitions"});
        expect(job.value("specificationVersion", "") == "jobtemplate-2023-09", "specificationVersion");
        known.clear();
        if (job.contains("parameterDefinitions")) {
            const json& list = job["parameterDefinitions"];
            expect(list.is_array() && !list.empty() && list.size() <= 50, "parameterDefinitions: 1 to 50");
            for (const json& parameter : list) jobParameter(parameter);
        }
        formatted(job.value("name", json()), "name", 1, 128, false);
        const json steps = job.value("steps", json::array());
        expect(steps.is_array() && !steps.empty(), "steps: none");
        std::set<std::string> before;
        for (const json& each : steps) {
            step(each, before);
            expect(before.insert(each.value("name", "")).second, "step name twice");
        }
    }

  private:
    std::set<std::string> known;  ///< what format strings may name

    void expect(bool fine, const std::string& finding) {
        if (!fine) findings.push_back(finding);
    }
    void keys(const json& object, const std::string& where, const std::set<std::string>& needed,
              const std::set<std::string>& allowed) {
        expect(object.is_object(), where + ": no object");
        if (!object.is_object()) return;
        for (const std::string& key : needed) expect(object.contains(key), where + ": no " + key);
        for (const auto& [key, value] : object.items())
            expect(needed.contains(key) || allowed.contains(key), where + ": unknown " + key);
    }
    void text(const json& value, const std::string& where, std::size_t least, std::size_t most,
              bool controls) {
        expect(value.is_string(), where + ": no text");
        if (!value.is_string()) return;
        const auto content = value.get<std::string>();
        expect(lettersOf(content) >= least && lettersOf(content) <= most, where + ": length");
        expect(controls || !hasControl(content), where + ": control character");
    }
    void formatted(const json& value, const std::string& where, std::size_t least, std::size_t most,
                   bool controls) {
        text(value, where, least, most, controls);
        if (!value.is_string()) return;
        const auto content = value.get<std::string>();
        for (std::sregex_iterator at(content.begin(), content.end(), kReference), end; at != end; ++at)
            expect(known.contains((*at)[1]), where + ": " + std::string((*at)[1]) + " is not known");
        const std::string rest = std::regex_replace(content, kReference, "");
        expect(rest.find("{{") == rest.npos, where + ": a reference that is none");
    }
    void identifier(const json& value, const std::string& where) {
        expect(value.is_string() && std::regex_match(value.get<std::string>(), kIdentifier),
               where + ": no identifier");
    }
    void jobParameter(const json& parameter) {
        keys(parameter, "job parameter", {"name", "type"},
             {"description", "default", "objectType", "dataFlow"});
        identifier(parameter.value("name", json()), "job parameter");
        expect(parameter.value("type", "") == "PATH", "job parameter: type");
        if (parameter.contains("default")) {
            text(parameter["default"], "default", 0, 1024, true);
            expect(!parameter.value("default", "").starts_with('/'), "default: absolute");
        }
        if (parameter.contains("description")) text(parameter["description"], "description", 1, 2048, false);
        const std::set<std::string> types = {"FILE", "DIRECTORY"}, flows = {"NONE", "IN", "OUT", "INOUT"};
        expect(types.contains(parameter.value("objectType", "DIRECTORY")), "objectType");
        expect(flows.contains(parameter.value("dataFlow", "NONE")), "dataFlow");
        const std::string name = parameter.value("name", "");
        expect(!known.contains("RawParam." + name), "job parameter twice");
        known.insert("RawParam." + name);
    }
    void step(const json& each, const std::set<std::string>& before) {
        keys(each, "step", {"name", "script"}, {"description", "dependencies", "parameterSpace"});
        text(each.value("name", json()), "step name", 1, 64, false);
        const json dependencies = each.value("dependencies", json::array());
        expect(!each.contains("dependencies") || !dependencies.empty(), "dependencies: none");
        for (const json& dependency : dependencies) {
            keys(dependency, "dependency", {"dependsOn"}, {});
            expect(before.contains(dependency.value("dependsOn", "")), "dependsOn: no step before it");
        }
        const std::set<std::string> outside = known;
        if (each.contains("parameterSpace")) space(each["parameterSpace"]);
        for (const std::string& name : outside)  // paths are known where they can be mapped
            if (name.starts_with("RawParam.")) known.insert(name.substr(3));
        keys(each.value("script", json()), "script", {"actions"}, {});
        const json actions = each.value("script", json::object()).value("actions", json());
        keys(actions, "actions", {"onRun"}, {});
        if (actions.contains("onRun")) action(actions["onRun"]);
        known = outside;
    }
    void space(const json& parameters) {
        keys(parameters, "parameterSpace", {"taskParameterDefinitions"}, {"combination"});
        const json list = parameters.value("taskParameterDefinitions", json::array());
        expect(list.is_array() && !list.empty() && list.size() <= 16, "taskParameterDefinitions: 1 to 16");
        std::multiset<std::string> names;
        std::set<std::size_t> lengths;
        for (const json& parameter : list) {
            keys(parameter, "task parameter", {"name", "type", "range"}, {});
            identifier(parameter.value("name", json()), "task parameter");
            expect(parameter.value("type", "") == "STRING", "task parameter: type");
            const json range = parameter.value("range", json::array());
            expect(range.is_array() && !range.empty() && range.size() <= 1024, "range: 1 to 1024");
            for (const json& value : range) formatted(value, "range", 1, 1024, true);
            names.insert(parameter.value("name", ""));
            lengths.insert(range.size());
            known.insert("Task.Param." + parameter.value("name", ""));
        }
        if (!parameters.contains("combination")) return expect(names.size() == 1, "combination: all of all");
        const std::string combination = parameters["combination"];
        expect(combination.size() >= 1 && combination.size() <= 1280, "combination: length");
        static const std::regex together(R"(\(\s*\w+(\s*,\s*\w+)*\s*\))"), word(R"(\w+)");
        expect(std::regex_match(combination, together), "combination: form");
        std::multiset<std::string> combined;
        for (std::sregex_iterator at(combination.begin(), combination.end(), word), end; at != end; ++at)
            combined.insert(at->str());
        expect(combined == names, "combination: not each once");
        expect(lengths.size() == 1, "combination: ranges of different lengths");
    }
    void action(const json& run) {
        keys(run, "action", {"command"}, {"args", "timeout", "cancelation"});
        constexpr std::size_t kAny = std::size_t(-1);
        formatted(run.value("command", json()), "command", 1, kAny, false);
        for (const json& argument : run.value("args", json::array()))
            formatted(argument, "args", 0, kAny, false);
        if (!run.contains("cancelation")) return;
        const json& cancelation = run["cancelation"];
        keys(cancelation, "cancelation", {"mode"}, {"notifyPeriodInSeconds"});
        expect(cancelation.value("mode", "") == "NOTIFY_THEN_TERMINATE", "cancelation: mode");
        const int seconds = cancelation.value("notifyPeriodInSeconds", 120);
        expect(seconds >= 1 && seconds <= 600, "notifyPeriodInSeconds");
    }
};

std::string resolved(std::string text, const std::map<std::string, std::string>& values) {
    for (std::smatch found; std::regex_search(text, found, kReference);)
        text = found.prefix().str() + values.at(found[1]) + found.suffix().str();
    return text;
}

}  // namespace

std::vector<std::string> openJdFindings(const json& jobTemplate) {
    Schema schema;
    schema.root(jobTemplate);
    return schema.findings;
}

std::vector<OpenJdTask> openJdTasks(const json& jobTemplate, const json& given) {
    std::map<std::string, std::string> values;
    for (const json& parameter : given["parameterValues"])
        values["Param." + std::string(parameter["name"])] = parameter["value"];
    std::vector<OpenJdTask> tasks;
    for (const json& step : jobTemplate["steps"]) {
        const json parameters =
            step.value("parameterSpace", json::object()).value("taskParameterDefinitions", json::array());
        const std::size_t count = parameters.empty() ? 1 : parameters[0]["range"].size();
        const json& run = step["script"]["actions"]["onRun"];
        for (std::size_t i = 0; i < count; ++i) {
            for (const json& parameter : parameters)
                values["Task.Param." + std::string(parameter["name"])] = parameter["range"][i];
            OpenJdTask& task = tasks.emplace_back(OpenJdTask{step["name"], {}});
            task.words.push_back(resolved(run["command"], values));
            for (const json& argument : run["args"]) task.words.push_back(resolved(argument, values));
        }
    }
    return tasks;
}

}  // namespace fw::test
