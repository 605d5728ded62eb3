// `fieldwright job`: what is shared out and how, what is refused at once, and jobs that GNU parallel really
// runs.
#include <gtest/gtest.h>
#include <cstdlib>

#include <algorithm>
#include <filesystem>

#include "runtime/jobs/plan.h"
#include "runtime/jobs/task_script.h"
#include "tests/support/command.h"
#include "tests/support/graph/temp_dir.h"
#include "tests/support/shared_out.h"

namespace fw::job_test {

namespace fs = std::filesystem;

using test::CommandResult;
using test::expectRefusal;
using test::namesIn;
using test::ProgramResult;
using test::readText;
using test::runCommand;
using test::runProgram;
using test::SharedOut;
using test::TempDir;

const TypedCommand kExport = {"export",
                              {{"", {"/g.field.json"}},
                               {"--output", {"/out"}},
                               {"--set", {"a=1", "b=2"}, true},
                               {"--region", {"-1", "-1", "-1", "1", "1", "1"}},
                               {"--overwrite"},
                               {"--report", {"/r.json"}},
                               {"--require", {"closed"}}}};

std::string joined(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
    return text;
}

TEST(JobPlan, SharesFramesOutByTheirNumbersAndReportsInTheEnd) {
    const Result<Job> job = planJob(kExport, {"frame", 5, 30}, {}, "/job");
    ASSERT_TRUE(job) << job.error().message;
    EXPECT_EQ(job->name, "g");
    ASSERT_EQ(job->steps.size(), 2u);
    EXPECT_EQ(job->steps[0].name, "frames");
    const std::vector<JobTask>& tasks = job->steps[0].tasks;
    ASSERT_EQ(tasks.size(), 3u);
    EXPECT_EQ(tasks[0].name, "frames 5 to 14");
    EXPECT_EQ(joined(tasks[0].words),
              "export /g.field.json --output /out --set a=1 --set b=2 --region -1 -1 -1 1 1 1 --overwrite "
              "--require closed --frames 5-14");
    EXPECT_EQ(tasks[2].words.back(), "25-29");
    EXPECT_EQ(job->steps[1].tasks.size(), 1u);
    EXPECT_EQ(
        joined(job->steps[1].tasks[0].words),
        "export /g.field.json --output /out --set a=1 --set b=2 --region -1 -1 -1 1 1 1 --report /r.json");
    EXPECT_EQ(planJob(kExport, {"frame", 0, 25}, {.chunk = 1}, "/job")->steps[0].tasks.size(), 25u);
    EXPECT_EQ(planJob(kExport, {"frame", 0, 25}, {.chunk = 1}, "/job")->steps[0].tasks[3].name, "frame 3");
    EXPECT_EQ(planJob(kExport, {"frame", 0, 25}, {.tasks = 4}, "/job")->steps[0].tasks.size(), 4u);
}

TEST(JobPlan, SharesVariantsOutAndKeepsToWhatEnginesTake) {
    EXPECT_EQ(planJob(kExport, {"variant", 0, 10'000}, {}, "/job")->steps[0].tasks.size(), 100u);
    const Result<Job> many = planJob(kExport, {"frame", 0, kMostFrames}, {}, "/job");
    EXPECT_EQ(many->steps[0].tasks.size(), std::size_t(kMostJobTasks));
    const Result<Job> tooMany = planJob(kExport, {"frame", 0, 1001}, {.chunk = 1}, "/job");
    ASSERT_FALSE(tooMany);
    EXPECT_NE(tooMany.error().message.find("give --chunk 2 or more"), std::string::npos);
}

TEST(JobPlan, SharesOneMeshOutInPartsThatAreMerged) {
    const Result<Job> job = planJob(kExport, {.parts = 3}, {}, "/job");
    ASSERT_TRUE(job);
    ASSERT_EQ(job->steps.size(), 2u);
    EXPECT_EQ(job->steps[0].name, "tiles");
    ASSERT_EQ(job->steps[0].tasks.size(), 3u);
    EXPECT_EQ(joined(job->steps[0].tasks[1].words),
              "export /g.field.json --set a=1 --set b=2 --region -1 -1 -1 1 1 1 --overwrite --output "
              "/job/parts/2.part --tile 2/3");
    EXPECT_EQ(joined(job->steps[1].tasks[0].words),
              "merge /job/parts/1.part /job/parts/2.part /job/parts/3.part --output /out --report /r.json "
              "--require closed");
    EXPECT_EQ(joined(planJob(kExport, {}, {}, "/job")->steps[0].tasks[0].words).find("--tile"),
              std::string::npos);
    EXPECT_FALSE(planJob(kExport, {}, {.chunk = 3}, "/job"));
}

TEST(JobPlan, SimulatesOnceBeforeTheFrames) {
    TypedCommand command = kExport;
    command.options.push_back({"--from", {"1"}});
    const Result<Job> job = planJob(command, {"frame", 30, 60, true}, {}, "/job");
    ASSERT_TRUE(job);
    ASSERT_EQ(job->steps.size(), 3u);
    EXPECT_EQ(joined(job->steps[0].tasks[0].words),
              "simulate /g.field.json --set a=1 --set b=2 --from 1 --output /job/cache");
    EXPECT_EQ(job->steps[1].tasks.size(), 3u);
    for (const std::size_t step : {1u, 2u})
        EXPECT_NE(joined(job->steps[step].tasks[0].words).find(" --cache /job/cache"), std::string::npos);
}

TEST(JobPlan, MakesPathsAbsoluteAndWordsThatAreRead) {
    const TypedCommand command = {"render",
                                  {{"", {"g.field.json"}},
                                   {"--output", {"a b"}},
                                   {"--device", {"-odd"}},
                                   {"--sweep", {"size=0:1:3", "table.csv"}, true}}};
    const std::string here = fs::current_path().string();
    EXPECT_EQ(joined(planJob(command, {}, {}, "/job")->steps[0].tasks[0].words),
              "render " + here + "/g.field.json --output " + here +
                  "/a b --device=-odd --sweep size=0:1:3 --sweep " + here + "/table.csv");
}

TEST(JobPlan, QuotesWhateverAShellWouldRead) {
    EXPECT_EQ(shellWord("/a/b-c_1.glb"), "/a/b-c_1.glb");
    EXPECT_EQ(shellWord("it's"), "'it'\\''s'");
    for (const std::string& word :
         {std::string(), std::string("a b"), std::string("$HOME `id` \"x\" \\ ! * ~ # & ;"),
          std::string("a\nb'c"), std::string("\xc3\xa4")}) {
        const ProgramResult back = runProgram("printf %s " + shellWord(word));
        EXPECT_EQ(back.output, word);
    }
}

struct Jobs : SharedOut {};

TEST_F(Jobs, RefuseAtOnceWhatTheCommandWouldRefuseOnTheFarm) {
    const auto refused = [&](const std::vector<std::string>& words, int status,
                             const std::vector<std::string>& said) {
        SCOPED_TRACE(joined(words));
        expectRefusal(runCommand(words), status, said);
        EXPECT_FALSE(fs::exists(job));
    };
    const std::string out = folder.path("out");
    const std::vector<std::string> slurm = {"job", "--for", "slurm", "-o", job, "--"};
    const auto with = [](std::vector<std::string> words, const std::vector<std::string>& more) {
        words.insert(words.end(), more.begin(), more.end());
        return words;
    };
    refused({"job", "--for", "slurm", "-o", job}, 2,
            {"fieldwright job: it shares out an export, a render or a simulate"});
    refused(with(slurm, {"play", graph}), 2, {"it shares out an export"});
    refused({"job", "--for", "lsf", "-o", job, "--", "export", graph, "-o", out}, 2,
            {"'lsf' is none of slurm"});
    refused(with(slurm, {"export", graph, "-o", out, "--form", "0"}), 2,
            {"fieldwright export: there is no option '--form'"});
    refused(with(slurm, {"export", folder.path("none.field.json"), "-o", out + ".glb"}), 1,
            {"none.field.json: error: there is no such file"});
    refused(with(slurm, {"export", graph, "-o", out + ".xyz"}), 2, {"out.xyz"});
    refused(with(slurm, {"export", graph, "-o", out, "--from", "9"}), 2, {"there is no frame from"});
    refused(with(slurm, {"export", graph, "-o", out, "--from", "0", "--set", "siz=1"}), 1, {"did you mean"});
    refused(with(slurm, {"export", graph, "-o", out, "--sweep", "siz=0.2:1:3"}), 2, {"siz"});
    refused(with(slurm, {"simulate", graph, "-o", out}), 1, {"nothing that this graph shows is simulated"});
    refused(with(slurm, {"render", graph, "-o", out + ".jpg"}), 2, {"a picture is a PNG or an OpenEXR file"});
    refused({"job", "--for", "slurm", "-o", job, "--chunk", "4", "--", "export", graph, "-o", out + ".glb"},
            2, {"--chunk is of frames or variants"});
    refused({"job", "--for", "slurm", "-o", job, "--tasks", "4", "--", "export", graph, "-o", out + ".glb"},
            2, {"too few tiles, 1, for 4 parts"});
    for (const std::vector<std::string>& whole : std::vector<std::vector<std::string>>{
             {"export", graph, "-o", out + ".glb", "--animated"}, {"render", graph, "-o", out + ".png"}})
        refused(with({"job", "--for", "slurm", "-o", job, "--tasks", "4", "--"}, whole), 2,
                {"is made as a whole: leave it out"});
    refused({"job", "--for", "openjd", "-o", job, "--", "export", graph, "-o", folder.path("{{x}}.glb")}, 1,
            {"cannot be in an OpenJD template"});
}

TEST_F(Jobs, MakeNothingOfTheCommandItself) {
    const std::string out = folder.path("frames");
    EXPECT_EQ(shareOut("parallel", {},
                       {"export", graph, "-o", out, "--from", "0", "--report", folder.path("r.json")})
                  .status,
              0);
    EXPECT_EQ(shareOut("slurm", {}, {"export", graph, "-o", folder.path("m.glb"), "--animated"}).status, 0);
    EXPECT_EQ(shareOut("slurm", {}, {"render", graph, "-o", folder.path("p.png")}).status, 0);
    EXPECT_EQ(shareOut("slurm", {}, {"render", graph, "-o", out, "--turntable", "2", "--time", "1"}).status,
              0);
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.field.json", "job"}));
}

TEST_F(Jobs, OfPartsOfASequenceHaveTheFilesOfTheWhole) {
    const std::string whole = folder.path("whole"), parts = folder.path("parts");
    const auto made = [&](const std::string& to, std::vector<std::string> words, const std::string& part) {
        words.insert(words.begin() + 1, {graph, "-o", to});
        if (!part.empty()) words.insert(words.end(), {"--frames", part});
        const CommandResult result = runCommand(words);
        EXPECT_EQ(result.status, 0) << result.errors;
    };
    const std::vector<std::vector<std::string>> kinds = {
        {"export", "--fps", "4"},
        {"export", "--sweep", "size=0.2:0.8:7"},
        {"render", "--turntable", "1.75", "--size", "48x32", "--samples", "1"}};
    for (const std::vector<std::string>& words : kinds) {
        SCOPED_TRACE(joined(words));
        made(whole, words, "");
        for (const char* part : {"4-6", "3", "0-2"}) made(parts, words, part);
        const std::vector<std::string> names = namesIn(parts);
        EXPECT_GE(names.size(), 7u);
        for (const std::string& name : names)
            EXPECT_EQ(readText(parts + "/" + name), readText(whole + "/" + name)) << name;
        fs::remove_all(whole);
        fs::remove_all(parts);
    }
    for (const char* none : {"6-9", "8", "3-2", "a", "1-", "-1", "1:2"})
        expectRefusal(runCommand({"export", graph, "-o", parts, "--frames", none}), 2, {"--frames"});
    EXPECT_FALSE(fs::exists(parts));
}

TEST_F(Jobs, AreRunByGnuParallelWhateverFoldersAreCalled) {
    const std::string odd = folder.path("it's \"$HOME\"\n(odd)");
    fs::create_directory(odd);
    graph = odd + "/a b.field.json";
    test::writeText(graph, kGraph);
    job = odd + "/a job";
    const std::string whole = folder.path("whole"), out = odd + "/frames";
    EXPECT_EQ(runCommand({"export", graph, "-o", whole, "--from", "0"}).status, 0);
    ASSERT_EQ(shareOut("parallel", {"--chunk", "3"},
                       {"export", graph, "-o", out, "--from", "0", "--report", odd + "/r.json"})
                  .status,
              0);
    EXPECT_EQ(readText(job + "/frames.jobs"), "./task frames 0\n./task frames 1\n./task frames 2\n");
    const ProgramResult run = submit("--jobs 2");
    EXPECT_EQ(run.status, 0) << run.output;
    expectSameFiles(out, whole);
    EXPECT_NE(readText(odd + "/r.json").find("000007.glb"), std::string::npos);
    EXPECT_EQ(submit().status, 0) << "all frames are there, and are passed over";
}

TEST_F(Jobs, KilledWithAllTheirTasksAndSubmittedAgainMakeTheSameBytes) {
    const std::string whole = folder.path("whole"), out = folder.path("frames"),
                      report = folder.path("r.json");
    const auto exported = [&](const std::string& to) -> std::vector<std::string> {
        return {"export", graph, "-o", to, "--fps", "8", "--report", report};
    };
    ASSERT_EQ(shareOut("parallel", {"--chunk", "4"}, exported(out)).status, 0);
    const int kills = std::getenv("FIELDWRIGHT_LONG") ? 12 : 2;
    for (int kill = 0; kill < kills; ++kill)  // as when the machine goes: processes of a space of their own
        runProgram(
            "timeout --signal=KILL " + std::to_string(0.3 + 0.3 * kill) +
            " unshare --map-root-user --mount --pid --fork --mount-proc --kill-child env XDG_CACHE_HOME=" +
            shellWord(folder.path("caches")) + " " + shellWord(job + "/submit") + " --jobs 2");
    const ProgramResult run = submit("--jobs 2");
    EXPECT_EQ(run.status, 0) << run.output;
    EXPECT_FALSE(fs::exists(job + "/failed"));
    EXPECT_TRUE(fs::exists(report));
    EXPECT_EQ(runCommand(exported(whole)).status, 0);
    expectSameFiles(out, whole);
}

TEST_F(Jobs, OfTilesAreMergedToTheMeshThatOneMachineMakes) {
    const std::vector<std::string> words = {"--resolution", "150", "--tiles", "2"};
    const auto exported = [&](const std::string& to) {
        std::vector<std::string> all = {"export", graph, "-o", to};
        all.insert(all.end(), words.begin(), words.end());
        return all;
    };
    const std::string mesh = folder.path("mesh.ply"), whole = folder.path("whole.ply");
    ASSERT_EQ(shareOut("parallel", {"--tasks", "2"}, exported(mesh)).status, 0);
    const ProgramResult run = submit();
    EXPECT_EQ(run.status, 0) << run.output;
    EXPECT_EQ(runCommand(exported(whole)).status, 0);
    EXPECT_TRUE(readText(mesh) == readText(whole));
}

TEST_F(Jobs, OfWhatIsSimulatedReadOneSimulation) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "some ten seconds: with FIELDWRIGHT_LONG";
    test::writeText(graph, R"({"fieldwright": 1, "nodes": [
      {"id": "cloud", "type": "emitter", "inputs": {"rate": 300, "burst": 30, "lifetime": 0.6}},
      {"id": "rain", "type": "particle_dynamics", "inputs": {"particles": {"from": "cloud"}}},
      {"id": "field", "type": "particles_to_field", "inputs": {"particles": {"from": "rain"}}},
      {"id": "out", "type": "output", "inputs": {"surface": {"from": "field"}, "resolution": 24}}],
     "timeline": {"length": 2, "fps": 30}})");
    const std::string out = folder.path("frames"), whole = folder.path("whole");
    const auto exported = [&](const std::string& to) -> std::vector<std::string> {
        return {"export", graph, "-o", to, "--from", "0.5", "--to", "0.8", "--format", "ply"};
    };
    ASSERT_EQ(shareOut("parallel", {"--chunk", "5"}, exported(out)).status, 0);
    EXPECT_EQ(readText(job + "/simulate.jobs"), "./task simulate 0\n");
    const ProgramResult run = submit();
    EXPECT_EQ(run.status, 0) << run.output;
    EXPECT_TRUE(fs::exists(job + "/cache/rain"));
    EXPECT_EQ(runCommand(exported(whole)).status, 0);
    expectSameFiles(out, whole);
    // A cache that is there already is read, and what is not simulated has none.
    fs::rename(job, folder.path("first"));
    ASSERT_EQ(shareOut("parallel", {},
                       {"export", graph, "-o", out, "--from", "0.5", "--cache", folder.path("first/cache")})
                  .status,
              0);
    EXPECT_FALSE(fs::exists(job + "/simulate.jobs"));
    ASSERT_EQ(shareOut("slurm", {}, {"simulate", graph, "-o", folder.path("cache"), "--to", "0.5"}).status,
              0);
    EXPECT_FALSE(fs::exists(folder.path("cache")));
}

TEST_F(Jobs, TellWhichTaskHasFailedAndWhyAndGoNoFurther) {
    const std::string out = folder.path("out"), report = folder.path("r.json");
    ASSERT_EQ(
        shareOut("parallel", {"--chunk", "4"},
                 {"export", graph, "-o", out, "--from", "0", "--report", report, "--require", "bodies=1"})
            .status,
        0);
    const ProgramResult run = submit();
    EXPECT_EQ(run.status, 1);
    const std::string failed = readText(job + "/failed");
    for (const char* said : {"frames 0 to 3: exit status 1", "frames 4 to 7: exit status 1",
                             "000002.glb: not bodies=1: it has 2 bodies"}) {
        EXPECT_NE(failed.find(said), std::string::npos) << said;
        EXPECT_NE(run.output.find(said), std::string::npos) << said;
    }
    EXPECT_FALSE(fs::exists(report)) << "the last step has run";
    EXPECT_EQ(namesIn(out).size(), 8u);
}

TEST_F(Jobs, OfTenThousandVariantsAreSharedOutAtOnce) {
    ASSERT_EQ(shareOut("slurm", {},
                       {"export", graph, "-o", folder.path("out"), "--sweep", "size=0.2:0.8:100", "--sweep",
                        "high=1:2:100"})
                  .status,
              0);
    const std::string task = readText(job + "/task");
    EXPECT_NE(task.find("'variants 99'"), std::string::npos);
    EXPECT_NE(task.find("--frames 9900-9999"), std::string::npos);
    EXPECT_EQ(task.find("'variants 100'"), std::string::npos);
    EXPECT_NE(readText(job + "/variants.sbatch").find("--array=0-99\n"), std::string::npos);
}

}  // namespace fw::job_test
