// Templates of the Open Job Description, version 2023-09, as a farm takes them: held against the rules of its
// "Template Schemas" (github.com/OpenJobDescription/openjd-specifications), and their tasks one by one.
//
// The rules are those for what this program writes: job parameters of type PATH, task parameters of type
// STRING, one action a step. Anything else is a finding, so that a template with more needs more rules here.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace fw::test {

/// Where and how the template breaks a rule; empty if it is fine.
std::vector<std::string> openJdFindings(const nlohmann::json& jobTemplate);

/// A task with everything resolved: the command and its arguments.
struct OpenJdTask {
    std::string step;
    std::vector<std::string> words;
};
/// All tasks of a template without findings, in an order in which they may be run; its parameters are as a
/// bundle's parameter_values.json has them.
std::vector<OpenJdTask> openJdTasks(const nlohmann::json& jobTemplate, const nlohmann::json& values);

}  // namespace fw::test
