// A job as a template of the Open Job Description, version 2023-09
// (github.com/OpenJobDescription/openjd-specifications, "Template Schemas").
//
// The folder is a bundle as AWS Deadline Cloud takes it: template.json, and parameter_values.json. The
// program, the graph and the output are job parameters of type PATH, so that farms can map them to where they
// are there; they are no defaults of the template, which openjd refuses to be absolute. What
// tells the tasks of a step from each other, "--frames 0-9", are task parameters that go together. `--openjd`
// has fieldwright print openjd_progress and openjd_status. A task that is to end is told so by SIGTERM first.
#pragma once

#include "runtime/jobs/job.h"

namespace fw {

/// Writes submit, template.json and parameter_values.json into the folder. Errors: a word that no template
/// can hold: control characters, "{{", a path of more than 1,024 letters.
Done writeOpenJdJob(const Job& job, const std::string& folder);

}  // namespace fw
