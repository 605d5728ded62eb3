// Jobs as templates of the Open Job Description: by its rules, and run task by task.
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>

#include "runtime/jobs/task_script.h"
#include "tests/support/openjd_template.h"
#include "tests/support/shared_out.h"

namespace fw::openjd_test {

using nlohmann::json;
using test::OpenJdTask;
using test::ProgramResult;
using test::readText;
using test::runCommand;

struct OpenJd : test::SharedOut {
    json templateOf(const std::vector<std::string>& options, const std::vector<std::string>& command) const {
        EXPECT_EQ(shareOut("openjd", options, command).status, 0);
        json read = json::parse(readText(job + "/template.json"));
        EXPECT_EQ(test::openJdFindings(read), std::vector<std::string>{});
        return read;
    }
    /// With the values that stand beside it.
    std::vector<OpenJdTask> tasksOf(const json& read) const {
        const json values = json::parse(readText(job + "/parameter_values.json"));
        EXPECT_EQ(values["parameterValues"].size(), read["parameterDefinitions"].size());
        return test::openJdTasks(read, values);
    }
    ProgramResult run(const OpenJdTask& task) const {
        std::string line = "XDG_CACHE_HOME=" + shellWord(folder.path("caches"));
        for (const std::string& word : task.words) line += " " + shellWord(word);
        return test::runProgram(line);
    }
};

TEST_F(OpenJd, TemplatesOfFramesRunToTheFramesOfTheWhole) {
    const std::string whole = folder.path("whole"), out = folder.path("a 'b' \"c\"");
    EXPECT_EQ(runCommand({"export", graph, "-o", whole, "--from", "0"}).status, 0);
    const json read = templateOf({"--chunk", "3"}, {"export", graph, "-o", out, "--from", "0"});
    const json& space = read["steps"][0]["parameterSpace"]["taskParameterDefinitions"];
    ASSERT_EQ(space.size(), 1u);
    EXPECT_EQ(space[0]["name"], "Frames");
    EXPECT_EQ(space[0]["range"], (json{"0-2", "3-5", "6-7"}));
    for (const OpenJdTask& task : tasksOf(read)) {
        const ProgramResult result = run(task);
        EXPECT_EQ(result.status, 0) << result.output;
        double last = -1.0;
        std::string status, line;
        for (std::istringstream lines(result.output); std::getline(lines, line);) {
            if (line.starts_with("openjd_status: ")) {
                status = line.substr(15);
            } else {
                ASSERT_TRUE(line.starts_with("openjd_progress: ")) << line;
                EXPECT_GT(std::stod(line.substr(17)), last);
                last = std::stod(line.substr(17));
            }
        }
        EXPECT_EQ(last, 100.0);
        EXPECT_EQ(status, task.words[task.words.size() - 2] == "6-7" ? "frame 2 of 2" : "frame 3 of 3");
    }
    expectSameFiles(out, whole);
}

TEST_F(OpenJd, TemplatesOfTilesRunToTheMergedMesh) {
    const std::string mesh = folder.path("mesh.stl"), whole = folder.path("whole.stl");
    const json read = templateOf({"--tasks", "2"}, {"export", graph, "-o", mesh, "--resolution", "150",
                                                    "--tiles", "2", "--require", "closed"});
    EXPECT_EQ(read["steps"][0]["parameterSpace"]["combination"], "(Output, Tile)");
    EXPECT_EQ(read["steps"][1]["dependencies"], (json{{{"dependsOn", "tiles"}}}));
    for (const OpenJdTask& task : tasksOf(read)) EXPECT_EQ(run(task).status, 0);
    EXPECT_EQ(runCommand({"export", graph, "-o", whole, "--resolution", "150", "--tiles", "2"}).status, 0);
    EXPECT_TRUE(readText(mesh) == readText(whole));
}

TEST_F(OpenJd, TemplatesOfAllElseKeepTheRules) {
    const std::string out = folder.path("out");
    templateOf({}, {"render", graph, "-o", out, "--turntable", "60", "--fps", "24"});
    templateOf({}, {"render", graph, "-o", out + ".png"});
    templateOf({}, {"export", graph, "-o", out, "--sweep", "size=0.2:0.8:1000", "--report", out + ".json"});
    const json most =
        templateOf({"--chunk", "1"}, {"export", graph, "-o", out, "--sweep", "size=0.2:0.8:1000"});
    EXPECT_EQ(tasksOf(most).size(), 1000u);
    // Paths that a farm maps are parameters, what they are said.
    EXPECT_EQ(json::parse(readText(job + "/parameter_values.json"))["parameterValues"][2]["value"], out);
    EXPECT_EQ(most["parameterDefinitions"][2]["objectType"], "DIRECTORY");
    EXPECT_EQ(most["steps"][0]["script"]["actions"]["onRun"]["args"][1], "{{Param.Graph}}");
}

TEST_F(OpenJd, SubmitHandsTheValuesInWithTheTemplate) {
    const std::string out = folder.path("it's $out");
    templateOf({}, {"export", graph, "-o", out, "--from", "0", "--report", folder.path("r.json")});
    // Programs of those names, which say what they were called with and where.
    std::filesystem::create_directory(folder.path("bin"));
    const auto saysIts = [&](const char* name) {
        const std::string path = folder.path("bin/") + name;
        test::writeText(path, "#!/bin/sh\npwd\nprintf '%s\\n' \"$@\"\n");
        std::filesystem::permissions(path, std::filesystem::perms(0755));
    };
    const std::string submit = "PATH=" + shellWord(folder.path("bin")) + ":/usr/bin:/bin " +
                               shellWord(job + "/submit") + " --verbose";
    const ProgramResult none = test::runProgram(submit);
    EXPECT_EQ(none.status, 1);
    EXPECT_NE(none.output.find("neither deadline nor openjd is installed"), std::string::npos) << none.output;
    saysIts("openjd");
    EXPECT_EQ(test::runProgram(submit).output,
              job + "\nrun\ntemplate.json\n--run-dependencies\n--step\nreport\n--job-param\nFieldwright=" +
                  FIELDWRIGHT_BINARY_DIR + "/fieldwright\n--job-param\nGraph=" + graph +
                  "\n--job-param\nOutput=" + out + "\n--verbose\n");
    saysIts("deadline");
    EXPECT_EQ(test::runProgram(submit).output, job + "\nbundle\nsubmit\n.\n--verbose\n");
}

TEST_F(OpenJd, RulesFindWhatBreaksThem) {
    const json fine = templateOf({"--tasks", "2"}, {"export", graph, "-o", folder.path("a.ply"),
                                                    "--resolution", "150", "--tiles", "2"});
    using Break = void (*)(json&);
    const std::vector<std::pair<const char*, Break>> breaks = {
        {"specificationVersion", [](json& t) { t["specificationVersion"] = "jobtemplate-2024-01"; }},
        {"unknown", [](json& t) { t["steps"][0]["tasks"] = 1; }},
        {"control character", [](json& t) { t["name"] = "a\nb"; }},
        {"is not known",
         [](json& t) { t["steps"][0]["script"]["actions"]["onRun"]["args"][0] = "{{Param.X}}"; }},
        {"a reference that is none",
         [](json& t) { t["steps"][0]["script"]["actions"]["onRun"]["args"][0] = "{{x"; }},
        {"no step before it", [](json& t) { t["steps"][1]["dependencies"][0]["dependsOn"] = "merge"; }},
        {"different lengths",
         [](json& t) {
             t["steps"][0]["parameterSpace"]["taskParameterDefinitions"][0]["range"].push_back("x");
         }},
        {"not each once", [](json& t) { t["steps"][0]["parameterSpace"]["combination"] = "(Output)"; }},
        {"1 to 1024",
         [](json& t) {
             t["steps"][0]["parameterSpace"]["taskParameterDefinitions"][0]["range"] =
                 std::vector<std::string>(1025, "x");
         }},
        {"step name twice", [](json& t) { t["steps"][1]["name"] = "tiles"; }},
        {"default: absolute", [](json& t) { t["parameterDefinitions"][0]["default"] = "/a"; }},
        {"no identifier", [](json& t) { t["parameterDefinitions"][0]["name"] = "1st"; }}};
    for (const auto& [said, breakIt] : breaks) {
        json broken = fine;
        breakIt(broken);
        const std::vector<std::string> findings = test::openJdFindings(broken);
        EXPECT_TRUE(std::ranges::any_of(findings, [what = said](const std::string& finding) {
            return finding.find(what) != finding.npos;
        })) << said;
    }
}

}  // namespace fw::openjd_test
