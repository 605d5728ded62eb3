// The command line of the real program: usage errors, help, and what goes to which stream.
#include <gtest/gtest.h>

#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tests/support/command.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::command_test {

using test::CommandResult;
using test::expectRefusal;
using test::runCommand;
using test::TempDir;

constexpr const char* kBall = R"({"fieldwright": 1,
  "nodes": [{"id": "ball", "type": "sphere"},
            {"id": "size", "type": "parameter", "inputs": {"name": "size", "value": 1, "min": -2, "max": 2}},
            {"id": "fat", "type": "offset", "inputs": {"surface": {"from": "ball"}, "distance": {"from": "size"}}},
            {"id": "out", "type": "output", "inputs": {"surface": {"from": "fat"}, "resolution": 16}}],
  "parameters": [{"name": "radius", "node": "ball", "input": "radius", "min": 0.125, "max": 4}]})";

struct Command : testing::Test {
    TempDir folder;
    std::string graph = folder.path("ball.field.json"), mesh = folder.path("ball.stl");
    void SetUp() override { test::writeText(graph, kBall); }

    /// Runs an export with these further arguments, expects it to be refused and no file to be made.
    void expectBadUsage(std::vector<std::string> arguments, const std::vector<std::string>& parts) {
        arguments.insert(arguments.begin(), {"export", graph, "-o", mesh});
        expectRefusal(runCommand(arguments), 2, parts);
        EXPECT_EQ(folder.names(), std::vector<std::string>{"ball.field.json"});
    }
    double valueAt(const std::vector<std::string>& arguments) {
        std::vector<std::string> words = {"eval", graph};
        words.insert(words.end(), arguments.begin(), arguments.end());
        const CommandResult result = runCommand(words);
        EXPECT_EQ(result.status, 0) << result.errors;
        EXPECT_EQ(result.errors, "");
        return std::atof(result.output.c_str());
    }
};

TEST_F(Command, WithoutAKnownCommandIsUsage) {
    expectRefusal(runCommand({}), 2, {"fieldwright: A subcommand is required", "Try: fieldwright --help"});
    expectRefusal(runCommand({"frobnicate"}), 2, {"there is no command 'frobnicate'"});
    expectRefusal(runCommand({"exprot"}), 2, {"'exprot': did you mean 'export'?"});
    expectRefusal(runCommand({"--frobnicate"}), 2, {"there is no option '--frobnicate'"});
    expectRefusal(runCommand({"--hlep"}), 2, {"'--hlep': did you mean '--help'?"});
    expectRefusal(runCommand({std::string(100'000, 'x')}), 2, {"there is no command 'xxx", "…'"});
}

TEST_F(Command, MissingArgumentsAndUnknownOptionsAreUsage) {
    expectRefusal(runCommand({"export"}), 2, {"fieldwright export: GRAPH is required", "export --help"});
    expectRefusal(runCommand({"export", graph}), 2, {"--output is required"});
    expectRefusal(runCommand({"check"}), 2, {"GRAPH is required"});
    expectRefusal(runCommand({"eval", graph}), 2, {"--at x y z"});
    expectRefusal(runCommand({"info", "extra"}), 2, {"not expected: extra"});
    expectRefusal(runCommand({"nodes", "--json", "--markdown"}), 2, {"--json excludes --markdown"});
    expectRefusal(runCommand({"compile", graph, "--emit", "hlsl"}), 2, {"--emit", "hlsl", "glsl, ir, spirv"});
    expectRefusal(runCommand({"bench", "nosuch"}), 2, {"'nosuch'"});
    expectBadUsage({"--bogus"}, {"there is no option '--bogus'\n"});
    expectBadUsage({"--resoluton", "8"}, {"no option '--resoluton': did you mean '--resolution'?"});
    expectBadUsage({"--units", "mm"},
                   {"there is no option '--units': lengths are metres, in .3mf millimetres"});
    expectBadUsage({"--region", "3.2mm", "0", "0", "1", "1", "1"},
                   {"'3.2mm' is not a finite number", "0.0032"});
    for (const std::vector<std::string>& traced :
         {std::vector<std::string>{"--reference"}, {"--view", "ao"}}) {
        std::vector<std::string> words = {"render", graph, "-o", "a.png", "--quality", "draft"};
        words.insert(words.end(), traced.begin(), traced.end());
        expectRefusal(runCommand(words), 2, {"traces the field", "leave one of them out"});
    }
    expectRefusal(runCommand({"render", graph, "-o", "a.png", "--view", "normal"}), 2,
                  {"'normal' is none of picture, ao, normals", "did you mean 'normals'?"});
    expectRefusal(runCommand({"render", graph, "-o", "a.png", "--least", "1mm"}), 2, {"--view thickness"});
    for (const char* none : {"0", "-1mm", "1kg", "wide"})
        expectRefusal(runCommand({"render", graph, "-o", "a.png", "--view", "gap", "--least", none}), 2,
                      {"fieldwright render: --least: "});
    expectBadUsage({"extra"}, {"not expected: extra"});
    expectBadUsage({"-o", mesh}, {"--output"});
    expectBadUsage({"--method", "dual"}, {"--method", "marching-cubes"});
    expectBadUsage({"--device", "nosuch"}, {"no device matches 'nosuch'"});
}

TEST_F(Command, OutputsThatAreNoMeshFileAreUsage) {
    expectRefusal(runCommand({"export", graph, "-o", folder.path("ball.xyz")}), 2,
                  {"unknown format '.xyz'", ".glb, .gltf, .obj, .stl, .ply, .3mf and .vdb"});
    expectRefusal(runCommand({"export", graph, "-o", folder.path("ball")}), 2, {"needs an extension"});
    expectRefusal(runCommand({"export", graph, "-o", ""}), 2, {"needs an extension"});
    expectRefusal(runCommand({"export", graph, "-o", "a.ply", "--report", ""}), 2, {"--report", "is empty"});
    expectRefusal(runCommand({"export", graph, "-o", "a.ply", "--tile", ""}), 2, {"--tile", "is empty"});
    for (const std::vector<std::string>& asked :
         {std::vector<std::string>{"--require", "closed"}, {"--report", folder.path("report.json")}}) {
        std::vector<std::string> words{"export", graph, "-o", folder.path("ball.vdb")};
        words.insert(words.end(), asked.begin(), asked.end());
        expectRefusal(runCommand(words), 2, {"ball.vdb", "no triangles that a report could measure", ".ply"});
    }
    expectRefusal(runCommand({"export", graph, "-o", mesh, "--manifold"}), 2,
                  {"ball.stl", "marked as a solid in .glb and .gltf alone"});
}

TEST_F(Command, ResolutionsOutOfRangeAreUsage) {
    for (const char* resolution :
         {"0", "-1", "1000000000", "99999999999999999999", "4097", "many", "1.5", "nan"})
        expectBadUsage({"--resolution", resolution},
                       {"--resolution", std::string(resolution) + "' is not a whole number from 1 to 4096"});
}

TEST_F(Command, PicturesOfNoTimeOrTwoAreUsage) {
    const auto refused = [&](std::vector<std::string> arguments, const std::string& part) {
        arguments.insert(arguments.begin(), {"render", graph, "-o", folder.path("frames")});
        expectRefusal(runCommand(arguments), 2, {part});
    };
    refused({"--fps", "nan"}, "--fps: 'nan' is not a finite number");
    refused({"--fps", "30", "--time", "2"}, "--time excludes --fps");
    refused({"--to", "1", "--time", "2"}, "--time excludes --to");
    refused({"--from", "0", "--time", "2"}, "--time excludes --from");
}

TEST_F(Command, InputsThatCannotBeLiveAreRefused) {
    const auto live = [&](const std::string& name) { return runCommand({"compile", graph, "--live", name}); };
    for (const char* name : {"ball.radius", "size.value", "time"})
        EXPECT_EQ(live(name).status, 0) << name << live(name).errors;
    expectRefusal(live("ball.radios"), 1, {"no input 'ball.radios'", "did you mean 'ball.radius'?"});
    expectRefusal(live("ball.nope"), 1, {"'ball.nope'", "the node has ball.radius"});
    expectRefusal(live("fat.distance"), 1, {"'fat.distance'", "not linked"});
    for (const char* name : {"x.y", "ball", "a.b.c", ""}) expectRefusal(live(name), 1, {"there is no input"});
}

TEST_F(Command, ResultsThatAreLostAreAFailure) {
    test::CommandOptions full;
    full.wrapper = {"sh", "-c", "\"$0\" \"$@\" > /dev/full"};
    for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
             {"nodes", "--json"}, {"info"}, {"eval", graph, "--at", "0", "0", "0"}, {"--help"}})
        expectRefusal(runCommand(words, full), 3, {"cannot write the results to standard output"});
    EXPECT_EQ(runCommand({"compile", graph}, full).status, 3);
    EXPECT_EQ(runCommand({"check", graph}, full).status, 0);  // has nothing to say
}

TEST_F(Command, EvalAnswersEveryLineOfAFileInOrder) {
    const auto eval = [&](std::vector<std::string> words, const std::string& text) {
        const std::string path = folder.path("lines.txt");
        test::writeText(path, text);
        words.insert(words.begin(), {"eval", graph});
        words.push_back(path);
        return runCommand(words);
    };
    const CommandResult few =
        eval({"--points"}, "# x y z\n2 0 0\n\n 0,-3.5 ,0 # far\r\n\t0 0 0\n+.5\t0,0\n1e1 1e-400 -0");
    EXPECT_EQ(few.output, "0\n1.5\n-2\n-1.5\n8\n") << few.errors;
    EXPECT_EQ(few.status, 0);
    EXPECT_EQ(eval({"--gradient", "--points"}, "5 0 0\n0 -4 0\n").output, "3 1 0 0\n2 0 -1 0\n");
    EXPECT_EQ(eval({"--boxes"}, "").output, "");
    const CommandResult bounds = eval({"--boxes"}, "3 -1 -1 4 1 1\n0 0 0 0 0 0\n");
    double lo = 0, hi = 0;
    ASSERT_EQ(std::sscanf(bounds.output.c_str(), "%lf %lf", &lo, &hi), 2) << bounds.errors;
    EXPECT_NEAR(lo, 1.0, 1e-9);
    EXPECT_NEAR(hi, std::sqrt(18.0) - 2.0, 1e-9);

    // More than are read at once, through a file and through a pipe.
    std::string many, expected;
    for (int i = 0; i < 500'000; ++i) {
        char number[32];
        many += std::to_string(i) + ", 0 0\n";
        expected.append(number, std::to_chars(number, std::end(number), double(i - 2)).ptr) += '\n';
    }
    EXPECT_TRUE(eval({"--points"}, many).output == expected);
    test::CommandOptions piped;
    piped.wrapper = {"sh", "-c", "cat '" + folder.path("lines.txt") + "' | \"$0\" \"$@\""};
    const CommandResult result = runCommand({"eval", graph, "--points", "-"}, piped);
    EXPECT_TRUE(result.output == expected) << result.errors;
    EXPECT_LE(result.peakMegabytes, 300.0);
    piped.wrapper[2] += " | head -n 2";
    const CommandResult cut = runCommand({"eval", graph, "--points", "-"}, piped);
    EXPECT_EQ(cut.output, "-2\n-1\n");
    EXPECT_EQ(cut.errors, "");
}

TEST_F(Command, EvalRefusesALineThatIsWrongByItsNumber) {
    const auto refused = [&](const std::string& option, const std::string& text, const std::string& message,
                             const std::string& before = "") {
        SCOPED_TRACE(text.substr(0, 100));
        test::writeText(folder.path("lines.txt"), text);
        const CommandResult result = runCommand({"eval", graph, option, folder.path("lines.txt")});
        EXPECT_EQ(result.status, 1);
        EXPECT_NE(result.errors.find("lines.txt:" + message), std::string::npos) << result.errors;
        EXPECT_EQ(result.output, before);
    };
    refused("--points", "2 0 0\n1 2\n", "2:4: error: expected 3 numbers, found 2", "0\n");
    refused("--points", "2 0 0 0", "1:7: error: expected 3 numbers and no more: there is '0' behind them");
    refused("--points", "\n# but\n1 two 3", "3:3: error: 'two' is not a finite number");
    refused("--points", "# " + std::string((4 << 20) - 2, '-') + "9 8 7\n0 0 0\n",
            "1:1: error: a line is longer than 4 MiB");
    refused("--points", "1 nan 3", "1:3: error: 'nan' is not a finite number");
    refused("--points", "1 2 1e999", "1:5: error: '1e999' is not a finite number");
    refused("--points", "1,,3", "1:3: error: expected a number before ',3'");
    refused("--points", "1 2 3,", "1:6: error: expected 3 numbers and no more");
    refused("--points", "1-2 3 4", "1:2: error: expected a blank or a comma before '-2 3 4'");
    refused("--points", "0x10 2 3", "1:2: error: expected a blank or a comma before 'x10 2 3'");
    refused("--boxes", "0 1 0 1 0 1", "1:1: error: the first corner lies beyond the second along y");
    std::string many;
    for (int i = 0; i < 300'000; ++i) many += "3 0 0\n";
    test::writeText(folder.path("lines.txt"), many + "3 0\n" + many);
    const CommandResult late = runCommand({"eval", graph, "--points", folder.path("lines.txt")});
    EXPECT_NE(late.errors.find("lines.txt:300001:4: error"), std::string::npos) << late.errors;
    EXPECT_EQ(late.output.size(), 600'000u);
    expectRefusal(runCommand({"eval", graph, "--points", folder.path("none.txt")}), 1,
                  {"none.txt: error: cannot be read: No such file"});
    expectRefusal(runCommand({"eval", graph, "--points", folder.folder.string()}), 1,
                  {"cannot be read: Is a directory"});
    expectRefusal(runCommand({"eval", graph, "--points", "-", "--at", "0", "0", "0"}), 2,
                  {"--at excludes --points"});
    expectRefusal(runCommand({"eval", graph, "--boxes", "-", "--gradient"}), 2,
                  {"--gradient excludes --boxes"});
}

TEST_F(Command, RegionsThatAreNoBoxAreUsage) {
    expectBadUsage({"--region", "0", "0", "0", "1", "1"}, {"--region", "6 required but received 5"});
    expectBadUsage({"--region", "0", "0", "0", "1", "1", "1", "1"}, {"6 required but received 7"});
    expectBadUsage({"--region", "0", "0", "0", "1", "1", "nan"},
                   {"--region", "'nan' is not a finite number"});
    expectBadUsage({"--region", "0", "0", "0", "1", "inf", "1"}, {"--region", "'inf' is not a finite"});
    expectBadUsage({"--region", "0", "0", "0", "1", "1e999", "1"}, {"'1e999' is not a finite number"});
    expectBadUsage({"--region", "0", "0", "0", "1", "one", "1"}, {"'one' is not a finite number"});
    expectBadUsage({"--region", "0", "1", "0", "1", "0", "1"}, {"no extent along y", "least corner"});
    expectBadUsage({"--region", "0", "0", "2", "1", "1", "2"}, {"no extent along z"});
    expectRefusal(runCommand({"eval", graph, "--interval", "0", "1", "0", "1", "0", "1"}), 2,
                  {"--interval", "along y", "least corner"});
}

TEST_F(Command, NumbersAreReadInEveryWayOfWritingThem) {
    EXPECT_DOUBLE_EQ(valueAt({"--at", "-.25", "-0.0", ".0"}), -1.75);
    EXPECT_DOUBLE_EQ(valueAt({"--at", "-.3e1", "+4", "0"}), 3.0);
    EXPECT_DOUBLE_EQ(valueAt({"--at", "-3", "4e0", "-0"}), 3.0);
    EXPECT_DOUBLE_EQ(valueAt({"--time", "-.5", "--at", "3", "4", "0"}), 3.0);
    EXPECT_DOUBLE_EQ(valueAt({"--set", "size=-.5", "--at", "3", "4", "0"}), 4.5);
    for (const char* number : {"nan", "inf", "-inf", "1e999", "0x", "--", "1,5", ""})
        expectRefusal(runCommand({"eval", graph, "--at", number, "0", "0"}), 2, {});
    expectRefusal(runCommand({"eval", graph, "--at", "0", "0", "0", "--time", "nan"}), 2, {"--time"});
    const CommandResult corner = runCommand(
        {"export", graph, "-o", mesh, "--region", "-.5", "-.5", "-.5", "5", "5", "5", "--resolution", "16"});
    EXPECT_EQ(corner.status, 0) << corner.errors;
}

TEST_F(Command, AssignmentsTakeOneWordAndKnowTheParameters) {
    EXPECT_DOUBLE_EQ(valueAt({"--set", "radius=2", "--set", "size=0", "--at", "3", "4", "0"}), 3.0);
    const CommandResult before =
        runCommand({"eval", "--set", "size=0", "--set", "radius=0.5", graph, "--at", "1", "0", "0"});
    EXPECT_EQ(before.status, 0) << before.errors;
    EXPECT_DOUBLE_EQ(std::atof(before.output.c_str()), 0.5);
    const auto refused = [&](const std::string& assignment, const std::vector<std::string>& parts) {
        expectRefusal(runCommand({"eval", graph, "--at", "0", "0", "0", "--set", assignment}), 1, parts);
    };
    expectRefusal(runCommand({"eval", graph, "--at", "0", "0", "0", "--set", "radius"}), 2,
                  {"--set: 'radius'", "name=value"});
    refused("radios=1", {"no parameter 'radios'", "did you mean 'radius'?"});
    refused("=1", {"no parameter ''"});
    refused("radius=", {"given no value"});
    refused("radius=big", {"'big' is no value"});
    refused("radius=nan", {"'nan' is no value"});
    refused("radius=1e999", {"'1e999' is no value"});
    refused("radius=9", {"'radius' takes values from 0.125 to 4"});
    refused("radius=1,2,3", {"the parameter 'radius' takes one number, not 3"});
    refused("radius=0,5", {"takes one number, not 2; the decimal sign is a point: 0.5"});
    refused("size=0,5", {"takes one number, not 2; the decimal sign is a point: 0.5"});
    refused("radius=1,", {"radius"});
    refused("size=-3", {"'size' takes values from -2 to 2"});
}

TEST_F(Command, ADivisionByZeroIsJudgedAtTheTimeAskedFor) {
    test::writeText(graph, R"({"fieldwright": 1, "nodes": [
        {"id": "a", "type": "expression", "inputs": {"k": 0}, "code": "return length(p) - 1 / time - 1 / k;"},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "a"}}}],
        "parameters": [{"name": "k", "node": "a", "input": "k"}]})");
    EXPECT_EQ(runCommand({"check", graph}).status, 0);
    EXPECT_DOUBLE_EQ(valueAt({"--time", "1", "--set", "k=2", "--at", "3", "4", "0"}), 3.5);
    expectRefusal(runCommand({"eval", graph, "--at", "3", "4", "0", "--set", "k=2"}), 1,
                  {"node 'a', code 1:22: division by zero at 0.000000 s"});
    expectRefusal(runCommand({"eval", graph, "--at", "3", "4", "0", "--time", "1"}), 1,
                  {"node 'a', code 1:33: division by zero"});
}

TEST_F(Command, HelpOfEveryCommandSaysWhatThereIs) {
    const auto help = [](std::vector<std::string> words, const std::vector<std::string>& parts) {
        words.push_back("--help");
        const CommandResult result = runCommand(words);
        EXPECT_EQ(result.status, 0);
        EXPECT_EQ(result.errors, "");
        for (const std::string& part : parts)
            EXPECT_NE(result.output.find(part), std::string::npos) << part << "\n" << result.output;
    };
    help({}, {"export", "check", "eval", "compile", "nodes", "info", "bench", "Exit status", "130", "Try:"});
    help({"export"},
         {"Usage: fieldwright export", "-o,--output", ".glb .gltf .obj .stl .ply .3mf .vdb", "--manifold",
          "--resolution", "4096", "--region", "x0 y0 z0 x1 y1 z1", "metres", "--set", "name=value", "--time",
          "--report", "--device", "--tiles", "--tile", ".part", "Exit status"});
    help({"merge"}, {"PART...", "-o,--output", ".glb .gltf .stl .ply"});
    help({"check"}, {"GRAPH...", "file:line:column"});
    help({"import"}, {"FILE", "-o,--output", ".3mf", "--overwrite"});
    help({"eval"}, {"--at", "--gradient", "--interval", "negative inside"});
    help({"compile"}, {"--emit", "glsl", "spirv", "--live", "node.input"});
    help({"nodes"}, {"--json", "--markdown"});
    help({"info"}, {"Show the version"});
    help({"bench"}, {"mesher", "--repeats"});
}

TEST_F(Command, FieldsGoInto3mfFilesAndComeBack) {
    const std::string file = folder.path("ball.3mf"), again = folder.path("again.field.json");
    const CommandResult exported = runCommand({"export", graph, "-o", file, "--implicit"});
    EXPECT_EQ(exported.status, 0) << exported.errors;
    EXPECT_EQ(exported.output, "");
    const CommandResult imported = runCommand({"import", file, "-o", again});
    EXPECT_EQ(imported.status, 0) << imported.errors;
    EXPECT_EQ(imported.output, again + "\n");
    for (const std::string place : {"0.3", "1.7", "2.01"}) {
        const std::string there = runCommand({"eval", again, "--at", place, "0", "0"}).output;
        EXPECT_NEAR(std::atof(there.c_str()), valueAt({"--at", place, "0", "0"}), 1e-9) << place;
    }
    expectRefusal(runCommand({"import", file, "-o", again}), 1, {"is there already", "--overwrite"});
    EXPECT_EQ(runCommand({"import", file, "-o", again, "--overwrite"}).status, 0);
    expectRefusal(runCommand({"import", graph}), 1, {"is of no format that is read", ".3mf"});
    expectRefusal(runCommand({"import", folder.path("gone.3mf")}), 1, {"gone.3mf", "is not there"});
    test::writeText(file, "PK but no archive");
    expectRefusal(runCommand({"import", file, "-o", folder.path("b.field.json")}), 1,
                  {"ball.3mf: error", "damaged"});
    expectRefusal(runCommand({"export", graph, "-o", mesh, "--implicit"}), 2,
                  {"functions go into a .3mf file"});
    expectRefusal(runCommand({"export", graph, "-o", file, "--implicit", "--lods", "2"}), 2,
                  {"--lods excludes --implicit"});
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"again.field.json", "ball.3mf", "ball.field.json"}));
}

TEST_F(Command, ResultsAloneGoToStandardOutput) {
    const CommandResult exported =
        runCommand({"export", graph, "-o", mesh, "--report", folder.path("report.json")});
    EXPECT_EQ(exported.status, 0) << exported.errors;
    EXPECT_EQ(exported.output, "");
    EXPECT_EQ(exported.errors, "");
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"ball.field.json", "ball.stl", "report.json"}));
    const auto report = nlohmann::json::parse(test::readText(folder.path("report.json")));
    EXPECT_EQ(report["boundaryEdges"], 0);
    EXPECT_EQ(report["capped"], false);

    const CommandResult value = runCommand({"eval", graph, "--at", "3", "4", "0", "--gradient"});
    EXPECT_EQ(value.output, "3\n0.59999999999999998 0.80000000000000004 0\n");
    EXPECT_EQ(value.errors, "");

    const CommandResult compiled = runCommand({"compile", graph, "--emit", "ir"});
    EXPECT_EQ(compiled.status, 0);
    EXPECT_TRUE(compiled.output.starts_with("%0 = ")) << compiled.output;
    EXPECT_NE(compiled.errors.find("operations"), std::string::npos);

    const CommandResult listed = runCommand({"nodes", "--json"});
    EXPECT_EQ(listed.status, 0);
    EXPECT_FALSE(nlohmann::json::parse(listed.output, nullptr, false).is_discarded());

    EXPECT_EQ(runCommand({"--version"}).output.find("fieldwright "), 0u);
    EXPECT_EQ(runCommand({"info"}).status, 0);
    EXPECT_EQ(runCommand({"check", graph}).status, 0);
}

}  // namespace fw::command_test
