// `fieldwright serve` as other programs have it: a real child process, over pipes and over a socket.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <glm/vec3.hpp>
#include <set>

#include "runtime/measure/mesh_report.h"
#include "tests/support/command.h"
#include "tests/support/graph/json_schema.h"
#include "tests/support/graph/temp_dir.h"
#include "tests/support/served.h"

namespace fw::serve_test {

using test::ServedJson;
using test::ServerClient;
using test::ServerMessage;
using test::ServerProcess;
using test::TempDir;

constexpr const char* kBall = R"({"fieldwright": 1, "unit": "mm",
  "nodes": [{"id": "ball", "type": "sphere", "inputs": {"radius": 1}},
            {"id": "out", "type": "output", "inputs": {"surface": {"from": "ball"}, "resolution": 24}}],
  "parameters": [{"name": "radius", "node": "ball", "input": "radius", "min": 0.125, "max": 4}]})";

template <class T>
std::vector<T> valuesOf(const std::string& bytes) {
    std::vector<T> values(bytes.size() / sizeof(T));
    std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
    return values;
}

double volumeOf(const ServerMessage& mesh) {
    const Report report = reportOnMesh(valuesOf<glm::vec3>(mesh.blobs.at("positions")),
                                       valuesOf<uint32_t>(mesh.blobs.at("indices")));
    EXPECT_TRUE(report.closedManifold());
    return report.volume;
}

double ballVolume(double radius) { return 4.0 / 3.0 * 3.14159265 * radius * radius * radius; }

struct Serve : testing::Test {
    TempDir folder;
    void SetUp() override { test::writeText(folder.path("ball.field.json"), kBall); }
};

TEST_F(Serve, MeshesWhatIsSet) {
    ServerProcess server({}, folder.folder.string());
    ServerClient& client = server.client;
    const int ball = client.open("ball.field.json");
    const ServerMessage first = client.ask("mesh", {{"document", ball}});
    ASSERT_FALSE(first.failed()) << first.json.dump();
    EXPECT_EQ(first.result().at("resolution"), 24);
    EXPECT_EQ(first.result().at("unit"), "mm");
    const std::size_t n = first.result().at("vertices").get<std::size_t>();
    EXPECT_EQ(first.blobs.at("positions").size(), n * 12);
    EXPECT_EQ(first.blobs.at("normals").size(), n * 12);
    EXPECT_NEAR(volumeOf(first), ballVolume(1), 0.1);

    const ServerMessage set = client.ask("set", {{"document", ball}, {"values", {{"radius", 2}}}});
    ASSERT_FALSE(set.failed()) << set.json.dump();
    EXPECT_EQ(set.result().at("parameters")[0].at("value"), 2.0);
    const ServerMessage second = client.ask(
        "mesh", {{"document", ball}, {"resolution", 32}, {"method", "dual-contouring"}, {"normals", false}});
    EXPECT_EQ(second.result().at("resolution"), 32);
    EXPECT_FALSE(second.blobs.contains("normals"));
    EXPECT_NEAR(volumeOf(second), ballVolume(2), 0.8);
    // The progress of what takes long is told, of this very request.
    ASSERT_FALSE(client.progress.empty());
    EXPECT_EQ(client.progress[0].json.at("method"), "progress");
    EXPECT_EQ(client.progress[0].json.at("params").at("id"), 2);
    EXPECT_TRUE(client.progress[0].json.at("params").at("part").is_string());
}

TEST_F(Serve, GivesEdgesEachOnce) {
    ServerProcess server({}, folder.folder.string());
    const int ball = server.client.open("ball.field.json");
    const ServerMessage mesh = server.client.ask("mesh", {{"document", ball}, {"edges", true}});
    ASSERT_FALSE(mesh.failed()) << mesh.json.dump();
    const auto indices = valuesOf<uint32_t>(mesh.blobs.at("indices"));
    const auto edges = valuesOf<uint32_t>(mesh.blobs.at("edges"));
    const auto sides = valuesOf<uint32_t>(mesh.blobs.at("triangle_edges"));
    ASSERT_EQ(sides.size(), indices.size());
    EXPECT_EQ(edges.size(), indices.size()) << "of a closed solid two triangles share each";
    std::set<std::pair<uint32_t, uint32_t>> once;
    for (std::size_t i = 0; i < edges.size(); i += 2) {
        EXPECT_LT(edges[i], edges[i + 1]);
        EXPECT_TRUE(once.emplace(edges[i], edges[i + 1]).second);
    }
    for (std::size_t i = 0; i < sides.size(); ++i) {
        const auto [lower, upper] = std::minmax(indices[i], indices[i % 3 == 2 ? i - 2 : i + 1]);
        ASSERT_LT(sides[i], edges.size() / 2);
        EXPECT_EQ(edges[2 * sides[i]], lower);
        EXPECT_EQ(edges[2 * sides[i] + 1], upper);
    }
}

TEST_F(Serve, TellsParametersAndChecks) {
    ServerProcess server({}, folder.folder.string());
    ServerClient& client = server.client;
    const int ball = client.openText(kBall);
    const ServedJson list = client.ask("parameters", {{"document", ball}}).result().at("parameters");
    ASSERT_EQ(list.size(), 1u);
    EXPECT_EQ(list[0].at("name"), "radius");
    EXPECT_EQ(list[0].at("value"), 1.0);
    EXPECT_EQ(list[0].at("default"), 1.0);
    EXPECT_EQ(list[0].at("min"), 0.125);
    EXPECT_EQ(list[0].at("max"), 4.0);
    EXPECT_EQ(list[0].at("unit"), "m");
    EXPECT_EQ(list[0].at("animated"), false);
    EXPECT_TRUE(client.ask("check", {{"document", ball}}).result().at("sound").get<bool>());

    const ServerMessage beyond = client.ask("set", {{"document", ball}, {"values", {{"radius", 5}}}});
    EXPECT_EQ(beyond.code(), -32000);
    EXPECT_NE(beyond.message().find("from 0.125 to 4"), std::string::npos) << beyond.message();
    EXPECT_EQ(beyond.json.at("error").at("data").at("node"), "ball");
    const ServerMessage unknown = client.ask("set", {{"document", ball}, {"values", {{"radios", 1}}}});
    EXPECT_NE(unknown.message().find("did you mean 'radius'"), std::string::npos) << unknown.message();
    // Neither changed anything.
    EXPECT_EQ(client.ask("parameters", {{"document", ball}}).result().at("parameters")[0].at("value"), 1.0);

    EXPECT_FALSE(client.ask("close", {{"document", ball}}).failed());
    EXPECT_EQ(client.ask("parameters", {{"document", ball}}).code(), -32602);
}

TEST_F(Serve, EvaluatesAsTheCommandDoes) {
    ServerProcess server({}, folder.folder.string());
    ServerClient& client = server.client;
    const std::string sample = FIELDWRIGHT_SOURCE_DIR "/samples/tower.field.json";
    std::filesystem::copy_file(sample, folder.folder / "tower.field.json");
    const int tower = client.open("tower.field.json");
    const ServerMessage listed = client.ask(
        "eval", {{"document", tower}, {"points", {{0.1, 0.2, 0.3}, {2, 0, 0}}}, {"gradient", true}});
    ASSERT_FALSE(listed.failed()) << listed.json.dump();
    const test::CommandResult command =
        test::runCommand({"eval", sample, "--at", "0.1", "0.2", "0.3", "--gradient"});
    double value = 0, x = 0, y = 0, z = 0;
    ASSERT_EQ(std::sscanf(command.output.c_str(), "%lf %lf %lf %lf", &value, &x, &y, &z), 4);
    EXPECT_EQ(listed.result().at("distance")[0], value);
    EXPECT_EQ(listed.result().at("gradient")[0], ServedJson({x, y, z}));

    const std::vector<float> points = {0.0f, 0.0f, 0.0f, 2.0f, 0.0f, 0.0f};
    const std::string bytes(reinterpret_cast<const char*>(points.data()), points.size() * 4);
    const ServerMessage many = client.ask("eval", {{"document", tower}}, {{"points", {"f32", bytes}}});
    ASSERT_FALSE(many.failed()) << many.json.dump();
    EXPECT_EQ(valuesOf<double>(many.blobs.at("distance"))[1],
              listed.result().at("distance")[1].get<double>());

    const ServerMessage odd =
        client.ask("eval", {{"document", tower}}, {{"points", {"f32", bytes.substr(1)}}});
    EXPECT_EQ(odd.code(), -32602);
    EXPECT_FALSE(client.ask("version").failed()) << "the odd bytes were taken for a message";
}

TEST_F(Serve, MakesPictures) {
    ServerProcess server({}, folder.folder.string());
    ServerClient& client = server.client;
    const int ball = client.open("ball.field.json");
    const ServedJson wish = {{"document", ball}, {"width", 64}, {"height", 48}};
    for (const char* quality : {"auto", "draft", "live", "draft", "live"}) {
        ServedJson params = wish;
        params["quality"] = quality;
        const ServerMessage picture = client.ask("picture", params);
        ASSERT_FALSE(picture.failed()) << picture.json.dump();
        const std::string& pixels = picture.blobs.at("picture");
        ASSERT_EQ(pixels.size(), 64u * 48 * 4);
        // The ball in the middle is of another brightness than the corner.
        EXPECT_NE(pixels.substr((24 * 64 + 32) * 4, 3), pixels.substr(0, 3)) << quality;
    }
    ServedJson png = wish;
    png["format"] = "png";
    png["view"] = "normals";
    png["camera"] = {{"position", {0, 0, 5}}, {"target", {0, 0, 0}}};
    EXPECT_TRUE(client.ask("picture", png).blobs.at("picture").starts_with("\x89PNG"));
    png["camera"] = {{"position", {0, 0, 0}}, {"target", {0, 0, 0}}};
    EXPECT_EQ(client.ask("picture", png).code(), -32602);
    EXPECT_EQ(client.ask("picture", {{"document", ball}, {"width", 1}}).code(), -32602);
    EXPECT_EQ(client.ask("picture", {{"document", ball}, {"view", "normal"}}).code(), -32602);
}

TEST_F(Serve, MeasuresAndExportsAsTheCommandDoes) {
    ServerProcess server({}, folder.folder.string());
    ServerClient& client = server.client;
    const int ball = client.open("ball.field.json");
    const ServerMessage measured = client.ask("measure", {{"document", ball}});
    ASSERT_FALSE(measured.failed()) << measured.json.dump();
    EXPECT_NEAR(measured.result().at("volume").get<double>(), ballVolume(1), 0.1);
    EXPECT_EQ(measured.result().at("unit"), "mm");
    EXPECT_TRUE(measured.result().contains("leastWall"));

    client.ask("set", {{"document", ball}, {"values", {{"radius", 2}}}});
    const std::vector<std::string> endings = {".stl", ".glb", ".obj"};
    for (const std::string& ending : endings) {
        const ServerMessage written = client.ask("export", {{"document", ball}, {"path", "served" + ending}});
        ASSERT_FALSE(written.failed()) << written.json.dump();
        EXPECT_EQ(written.result().at("files")[0], "served" + ending);
    }
    const std::string made = folder.path("made.stl");
    const test::CommandResult command =
        test::runCommand({"export", folder.path("ball.field.json"), "--set", "radius=2", "-o", made});
    ASSERT_EQ(command.status, 0) << command.errors;
    EXPECT_TRUE(test::readText(made) == test::readText(folder.path("served.stl")));
    EXPECT_EQ(client.ask("export", {{"document", ball}, {"path", "a.xyz"}}).code(), -32000);
    EXPECT_EQ(client.ask("export", {{"document", ball}, {"path", "ball.field.json"}}).code(), -32000);
}

TEST_F(Serve, FollowsTheTime) {
    ServerProcess server({"--root", FIELDWRIGHT_SOURCE_DIR "/samples"}, folder.folder.string());
    ServerClient& client = server.client;
    const int moving = client.open("moving_booleans.field.json");
    const auto meshAt = [&](double seconds) {
        const ServerMessage time = client.ask("time", {{"document", moving}, {"seconds", seconds}});
        EXPECT_FALSE(time.failed()) << time.json.dump();
        return client.ask("mesh", {{"document", moving}, {"resolution", 24}}).blobs.at("positions");
    };
    const std::string first = meshAt(0.0), second = meshAt(1.0);
    EXPECT_NE(first, second);
    EXPECT_EQ(meshAt(0.0), first);
}

TEST_F(Serve, ErrorsOfBadGraphsNameTheirPlace) {
    ServerProcess server({"--root", FIELDWRIGHT_SOURCE_DIR "/tests/data/bad"}, folder.folder.string());
    for (const auto& entry : std::filesystem::directory_iterator(FIELDWRIGHT_SOURCE_DIR "/tests/data/bad")) {
        const std::string name = entry.path().filename().string();
        const ServerMessage opened = server.client.ask("open", {{"path", name}});
        ASSERT_TRUE(opened.failed()) << name;
        EXPECT_EQ(opened.code(), -32000);
        EXPECT_FALSE(opened.message().empty());
        const ServedJson& data = opened.json.at("error").at("data");
        EXPECT_EQ(data.at("file"), name);
        EXPECT_GT(data.at("line").get<int>(), 0) << data.dump();
        EXPECT_GT(data.at("column").get<int>(), 0);
        const ServerMessage checked = server.client.ask("check", {{"path", name}});
        ASSERT_FALSE(checked.failed()) << name;
        EXPECT_FALSE(checked.result().at("sound").get<bool>());
        EXPECT_EQ(checked.result().at("findings").size() > 1, data.at("findings").size() > 1);
    }
}

TEST_F(Serve, WhatIsNoRequestIsAnsweredAndPassedOver) {
    ServerProcess server({}, folder.folder.string());
    ServerClient& client = server.client;
    const auto refused = [&](const std::string& line, int code, const char* part) {
        client.sendLine(line);
        const ServerMessage message = client.next();
        ASSERT_TRUE(message.failed()) << line;
        EXPECT_EQ(message.code(), code) << line;
        EXPECT_NE(message.message().find(part), std::string::npos) << message.message();
    };
    refused("{", -32700, "");
    refused("\xff", -32700, "UTF-8");
    refused("[]", -32600, "several requests");
    refused("1", -32600, "an object");
    refused(R"({"id": 1, "method": "version"})", -32600, "jsonrpc");
    refused(R"({"jsonrpc": "2.0", "id": 1})", -32600, "method");
    refused(R"({"jsonrpc": "2.0", "id": [], "method": "version"})", -32600, "id");
    refused(R"({"jsonrpc": "2.0", "id": 1, "method": "version", "params": []})", -32602, "params");
    refused(R"({"jsonrpc": "2.0", "id": "a", "method": "mehs", "params": {}})", -32601, "'mesh'");
    refused(R"({"jsonrpc": "2.0", "id": 1, "method": "mesh", "params": {"document": 7}})", -32602, "closed");
    refused(R"({"jsonrpc": "2.0", "id": 1, "method": "mesh", "params": {"document": "x"}})", -32602,
            "number");
    refused(R"({"jsonrpc": "2.0", "id": 1, "method": "open", "params": {"pth": "x"}})", -32602, "path");
    refused(R"({"jsonrpc": "2.0", "id": 1, "method": "check"})", -32602, "path");
    refused(std::string(100, '[') + std::string(100, ']'), -32700, "nest");
    refused("\"" + std::string(33 << 20, 'x') + "\"", -32002, "MiB");
    // Bytes that were announced are passed over, wrong or too many.
    client.sendLine(
        R"({"jsonrpc": "2.0", "id": 5, "method": "nothing", "params": {"blobs": [{"name": "a", "bytes": 3}]}})");
    client.sendBytes("abc");
    EXPECT_EQ(client.next().code(), -32601);
    client.sendLine(
        R"({"jsonrpc": "2.0", "id": {}, "method": "version", "params": {"blobs": [{"name": "a", "bytes": 3}]}})");
    client.sendBytes("abc");
    EXPECT_EQ(client.next().code(), -32600);
    ServedJson many = ServedJson::array();
    for (int i = 0; i < 17; ++i) many.push_back({{"name", std::to_string(i)}, {"type", "u8"}, {"bytes", 1}});
    client.sendLine(
        ServedJson{{"jsonrpc", "2.0"}, {"id", 6}, {"method", "version"}, {"params", {{"blobs", many}}}}
            .dump());
    client.sendBytes(std::string(17, 'x'));
    EXPECT_EQ(client.next().code(), -32602);
    client.sendLine(R"({"jsonrpc": "2.0", "method": "version"})");  // a notification has no answer
    client.sendLine("");
    EXPECT_EQ(client.ask("version").result().at("name"), "fieldwright");
    EXPECT_GT(client.ask("nodes").result().at("nodes").size(), 50u);
}

TEST_F(Serve, WhatIsNoParameterIsRefused) {
    ServerProcess server({}, folder.folder.string());
    ServerClient& client = server.client;
    const int ball = client.open("ball.field.json");
    const auto refused = [&](const std::string& method, ServedJson params, const char* part,
                             const char* remedy = "", int code = -32602) {
        if (method != "open" && method != "version") params["document"] = ball;
        const ServerMessage message = client.ask(method, params);
        ASSERT_TRUE(message.failed()) << method << params;
        EXPECT_EQ(message.code(), code);
        EXPECT_NE(message.message().find(part), std::string::npos) << message.message();
        EXPECT_EQ(message.json.at("error").at("data").value("remedy", ""), remedy) << message.message();
    };
    refused("open", {{"paht", "ball.field.json"}}, "no parameter 'paht'", "did you mean 'path'?");
    refused("open", {{"path", std::string("ball.field.json\0x", 17)}}, "NUL", "leave that out");
    refused("open", {{"path", 1}}, "is a text");
    refused("open", {{"graph", ServedJson::object()}}, "begins with {\"fieldwright\": 1, …}",
            "its object has no \"fieldwright\"; a graph begins with {\"fieldwright\": 1, …}", -32000);
    refused("version", {{"x", 1}}, "no parameter 'x'");
    refused("close", {{"x", 1}}, "no parameter 'x'");
    refused("time", {{"seconds", nullptr}}, "is missing", "give it");
    refused("set", {{"values", ServedJson::array()}}, "is an object", "{\"name\": number, …}");
    refused("mesh", {{"resolution", 0}}, "from 1 to 1024");
    refused("picture", {{"width", 1}}, "from 16 to 8192");
    refused("picture", {{"from", "top"}, {"camera", {{"position", {0, 0, 5}}}}}, "without a camera",
            "leave one of them out");
    // A list of no blobs is none; a blob that the method does not take, points twice, and points that lie
    // otherwise.
    const std::string bytes(48, '\0');
    EXPECT_FALSE(client.ask("parameters", {{"document", ball}, {"blobs", ServedJson::array()}}).failed());
    EXPECT_EQ(client.ask("mesh", {{"document", ball}}, {{"points", {"f64", bytes}}}).code(), -32602);
    EXPECT_EQ(client.ask("eval", {{"document", ball}, {"points", {{0, 0, 0}}}}, {{"points", {"f64", bytes}}})
                  .code(),
              -32602);
    for (const auto& [shape, fits] : {std::pair(ServedJson{2, 3}, true), std::pair(ServedJson{3, 2}, false),
                                      std::pair(ServedJson{6}, false), std::pair(ServedJson("a"), false)}) {
        const ServedJson blob = {{"name", "points"}, {"type", "f64"}, {"shape", shape}, {"bytes", 48}};
        client.sendLine(ServedJson{{"jsonrpc", "2.0"},
                                   {"id", 100},
                                   {"method", "eval"},
                                   {"params", {{"document", ball}, {"blobs", ServedJson::array({blob})}}}}
                            .dump());
        client.sendBytes(bytes);
        EXPECT_EQ(client.answer(100).failed(), !fits) << shape;
    }
    // A line may be longer than a graph file.
    const ServerMessage large = client.ask("open", {{"graph", std::string(20 << 20, 'a')}});
    EXPECT_EQ(large.code(), -32000);
    EXPECT_NE(large.message().find("larger than 16 MiB"), std::string::npos) << large.message();
    EXPECT_FALSE(client.ask("mesh", {{"document", ball}}).failed());
}

TEST_F(Serve, AnExportThatCannotBeWrittenIsNotMadeFirst) {
    ServerProcess server({}, folder.folder.string());
    ServerClient& client = server.client;
    const int ball = client.open("ball.field.json");
    std::filesystem::create_directory(folder.folder / "folder.stl");
    std::filesystem::create_symlink("nowhere/x.stl", folder.folder / "link.stl");
    for (const auto& [path, why] : {std::pair("folder.stl", "it is a folder"), std::pair("link.stl", "link"),
                                    std::pair("missing/a.stl", "folder")}) {
        const ServerMessage message = client.ask("export", {{"document", ball}, {"path", path}});
        EXPECT_EQ(message.code(), -32000) << path;
        EXPECT_NE(message.message().find(why), std::string::npos) << message.message();
    }
    EXPECT_TRUE(client.progress.empty()) << client.progress.front().json;
    EXPECT_FALSE(client.ask("export", {{"document", ball}, {"path", "ball.stl"}}).failed());
    EXPECT_FALSE(client.progress.empty());
}

TEST_F(Serve, SaysWhatItsSchemaSays) {
    const Json schema = Json::parse(test::readText(FIELDWRIGHT_SOURCE_DIR "/docs/server.schema.json"));
    const test::JsonSchema fits(schema);
    ServerProcess server({}, folder.folder.string());
    ServerClient& client = server.client;
    std::set<std::string> asked;
    const auto ask = [&](const std::string& method, ServedJson params) {
        asked.insert(method);
        const ServerMessage message = client.ask(method, std::move(params));
        EXPECT_TRUE(fits.fits(schema, message.json)) << message.json.dump();
        if (message.failed()) return message;
        EXPECT_TRUE(fits.fits(schema["$defs"][method], message.result())) << method << message.json.dump();
        return message;
    };
    const int ball = ask("open", {{"graph", kBall}, {"path", "ball.field.json"}}).result().at("document");
    ask("open", {{"graph", ServedJson::parse(kBall)}});
    ask("open", {{"graph", "{}"}});
    ask("open", {{"graph", R"({"fieldwright": 1, "nodes": [{"id": "a", "type": "spere"}]})"}});
    ask("set", {{"document", ball}, {"values", {{"radius", 1.5}}}});
    ask("set", {{"document", ball}, {"values", {{"radius", 100}}}});
    ask("parameters", {{"document", ball}});
    ask("time", {{"document", ball}, {"seconds", 2}});
    ask("check", {{"document", ball}});
    ask("check", {{"graph", R"({"fieldwright": 1, "nodes": [{"id": "a", "type": "spere"}]})"}});
    ask("mesh", {{"document", ball}, {"materials", true}, {"edges", true}});
    const ServerMessage textured = ask("mesh", {{"document", ball}, {"textures", 64}});
    EXPECT_EQ(textured.blobs.at("normal").size(), 64u * 64 * 3);
    ask("picture", {{"document", ball}, {"width", 32}, {"height", 32}});
    ask("eval", {{"document", ball}, {"points", {{0, 0, 0}}}, {"gradient", true}});
    ask("measure", {{"document", ball}});
    ask("export", {{"document", ball}, {"path", "ball.ply"}});
    ask("nodes", {});
    ask("cancel", {{"id", 1}});
    ask("version", {});
    ask("close", {{"document", ball}});
    ask("shutdown", {});
    for (const ServerMessage& message : client.progress)
        EXPECT_TRUE(fits.fits(schema, message.json)) << message.json.dump();
    EXPECT_EQ(server.wait(), 0);
    // The page has a row for each method, and the schema an entry.
    const std::string page = test::readText(FIELDWRIGHT_SOURCE_DIR "/docs/server.md");
    for (const std::string& method : asked) {
        EXPECT_NE(page.find("\n| `" + method + "` |"), std::string::npos) << method;
        EXPECT_TRUE(schema["$defs"].contains(method));
    }
}

TEST_F(Serve, TheClientOfThePageRuns) {
    const std::string page = test::readText(FIELDWRIGHT_SOURCE_DIR "/docs/server.md");
    const std::size_t begin = page.find("```python\n") + 10;
    test::writeText(folder.path("client.py"), page.substr(begin, page.find("```", begin) - begin));
    const test::ProgramResult result =
        test::runProgram("python3 '" + folder.path("client.py") +
                         "' " FIELDWRIGHT_BINARY_DIR "/fieldwright " FIELDWRIGHT_SOURCE_DIR "/samples");
    EXPECT_EQ(result.status, 0) << result.output;
    for (const char* line : {"\n0.1 ", "\n0.15 ", "\n0.2 "})
        EXPECT_NE(("\n" + result.output).find(line), std::string::npos) << result.output;
}

TEST_F(Serve, NothingOutsideItsRootsIsOpened) {
    const TempDir outside;
    test::writeText(outside.path("ball.field.json"), kBall);
    test::writeText(outside.path("wall.png"), "no picture");
    std::filesystem::create_symlink(outside.path("ball.field.json"), folder.path("link.field.json"));
    std::filesystem::create_directory_symlink(outside.folder, folder.folder / "elsewhere");
    std::filesystem::create_symlink(outside.path("wall.png"), folder.path("wall.png"));
    ServerProcess server({}, folder.folder.string());
    ServerClient& client = server.client;
    const auto refused = [&](const ServerMessage& message) {
        EXPECT_TRUE(message.failed()) << message.json.dump();
        if (message.failed()) {
            EXPECT_NE(message.message().find("outside"), std::string::npos) << message.message();
        }
    };
    const std::string up = "../" + outside.folder.filename().string();
    for (const std::string& path : {outside.path("ball.field.json"), outside.path("nothing.field.json"),
                                    up + "/ball.field.json", std::string("link.field.json"),
                                    std::string("elsewhere/ball.field.json"), std::string("/etc/passwd"),
                                    std::string("/proc/self/environ"), std::string("sub/../../x.field.json")})
        refused(client.ask("open", {{"path", path}}));
    const int ball = client.open("ball.field.json");
    for (const std::string& path : {outside.path("a.stl"), up + "/a.stl", std::string("elsewhere/a.stl"),
                                    std::string("../a.stl"), std::string("/tmp/a.stl")})
        refused(client.ask("export", {{"document", ball}, {"path", path}}));
    EXPECT_EQ(outside.names(), (std::vector<std::string>{"ball.field.json", "wall.png"}));
    // What graphs name: a picture, a mesh, a font, a particle cache, the sky.
    const auto graphWith = [](const std::string& node, const std::string& scene = "") {
        return R"({"fieldwright": 1, "nodes": [{"id": "ball", "type": "sphere"}, )" + node +
               R"(, {"id": "out", "type": "output", "inputs": {"surface": {"from": "it"}}}])" + scene + "}";
    };
    const auto painted = [&](const std::string& file) {
        return graphWith(R"({"id": "paint", "type": "triplanar", "inputs": {"image": ")" + file +
                         R"("}}, {"id": "it", "type": "material", "inputs": {"surface": {"from": "ball"}, )"
                         R"("base_color": {"from": "paint"}}})");
    };
    const auto letters = [&](const std::string& file) {
        return graphWith(R"({"id": "flat", "type": "text", "inputs": {"font_file": ")" + file +
                         R"("}}, {"id": "it", "type": "extrude", "inputs": {"surface": {"from": "flat"}}})");
    };
    const auto fromMesh = [&](const std::string& file) {
        return graphWith(
            R"({"id": "mesh", "type": "mesh_file", "inputs": {"path": ")" + file +
            R"("}}, {"id": "it", "type": "mesh_to_field", "inputs": {"mesh": {"from": "mesh"}}})");
    };
    refused(client.ask("open", {{"graph", fromMesh("/usr/share/thing.obj")}}));
    refused(client.ask("open", {{"graph", fromMesh("elsewhere/ball.obj")}}));
    refused(client.ask("open", {{"graph", painted("wall.png")}}));
    refused(client.ask("open", {{"graph", painted(outside.path("wall.png"))}}));
    refused(client.ask("open", {{"graph", painted(up + "/wall.png")}}));
    refused(client.ask("open", {{"graph", letters("/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf")}}));
    for (const char* way : {"../x.png", "/etc/hostname"})
        refused(client.ask("open", {{"graph", painted(way)}}));
}

TEST_F(Serve, ACacheOfParticlesLiesWithinTheRootsToo) {
    const TempDir outside;
    test::writeText(outside.path("particles.cache"), "{}");
    const std::string graph = R"({"fieldwright": 1, "nodes": [
        {"id": "rain", "type": "emitter", "inputs": {"cache": ")" +
                              outside.path("particles.cache") + R"("}},
        {"id": "it", "type": "particles_to_field", "inputs": {"particles": {"from": "rain"}}},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "it"}}}]})";
    ServerProcess server({}, folder.folder.string());
    const ServerMessage opened = server.client.ask("open", {{"graph", graph}});
    // A cache of no use is no error of a graph: it simulates. But what lies outside was not read.
    const ServedJson findings = opened.failed() ? opened.json.at("error") : opened.result().at("findings");
    EXPECT_NE(findings.dump().find("outside the folders that are served"), std::string::npos)
        << opened.json.dump();
}

TEST_F(Serve, SeveralRoots) {
    const TempDir other;
    test::writeText(other.path("second.field.json"), kBall);
    ServerProcess server({"--root", folder.folder.string(), "--root", other.folder.string()}, "/");
    EXPECT_GT(server.client.open("ball.field.json"), 0);
    EXPECT_GT(server.client.open(other.path("second.field.json")), 0);
    ServerProcess none({"--root", folder.path("nothing")}, "/");
    EXPECT_EQ(none.wait(), 2);
    EXPECT_NE(none.errors().find("is no folder"), std::string::npos);
}

/// A picture that takes long, but looks whether it is still wanted.
int askForLong(ServerClient& client, int document) {
    return client.send("picture",
                       {{"document", document}, {"width", 1024}, {"height", 1024}, {"samples", 100}});
}

TEST_F(Serve, CancelsWhatRunsAndWhatWaits) {
    ServerProcess server({}, folder.folder.string());
    ServerClient& client = server.client;
    const int ball = client.open("ball.field.json");
    const int running = askForLong(client, ball);
    const int waiting = client.send("mesh", {{"document", ball}});
    const int behind = client.send("check", {{"document", ball}});
    while (client.progress.empty() || client.progress.back().json.at("params").at("part") != "picture")
        client.progress.push_back(client.next());
    EXPECT_FALSE(client.ask("parameters", {{"document", ball}}).failed()) << "is answered while another runs";
    EXPECT_TRUE(client.ask("cancel", {{"id", waiting}}).result().at("cancelled").get<bool>());
    EXPECT_TRUE(client.ask("cancel", {{"id", running}}).result().at("cancelled").get<bool>());
    EXPECT_EQ(client.answer(running).code(), -32800);
    EXPECT_EQ(client.answer(waiting).code(), -32800);
    EXPECT_FALSE(client.answer(behind).failed());
    EXPECT_FALSE(client.ask("cancel", {{"id", running}}).result().at("cancelled").get<bool>());
    EXPECT_FALSE(client.ask("mesh", {{"document", ball}}).failed());
}

TEST_F(Serve, AClientThatVanishesEndsIt) {
    for (const bool whole : {true, false}) {
        ServerProcess server({}, folder.folder.string());
        const int ball = server.client.open("ball.field.json");
        askForLong(server.client, ball);
        while (server.client.next().json.at("params").at("part") != "picture") {}
        if (whole)
            server.client.hangUp();
        else
            server.client.sendBytes(R"({"jsonrpc": "2.0", "id")"), server.client.endSending();
        EXPECT_EQ(server.wait(), 0) << server.errors();
    }
}

TEST_F(Serve, ASocketServesSeveralAtOnce) {
    const std::string path = folder.path("here");
    ServerProcess server({"--socket", path}, folder.folder.string());
    ServerClient one = ServerProcess::connect(path), two = ServerProcess::connect(path);
    EXPECT_EQ(std::filesystem::status(path).permissions() & std::filesystem::perms::others_all,
              std::filesystem::perms::none);
    const int first = one.open("ball.field.json"), second = two.open("ball.field.json");
    EXPECT_FALSE(two.ask("set", {{"document", second}, {"values", {{"radius", 2}}}}).failed());
    const int a = one.send("mesh", {{"document", first}}), b = two.send("mesh", {{"document", second}});
    EXPECT_NEAR(volumeOf(one.answer(a)), ballVolume(1), 0.1);
    EXPECT_NEAR(volumeOf(two.answer(b)), ballVolume(2), 0.8);
    // While one waits for long, the other is answered; then that one goes, and a third comes.
    askForLong(one, first);
    EXPECT_FALSE(two.ask("mesh", {{"document", second}}).failed());
    one.hangUp();
    ServerClient three = ServerProcess::connect(path);
    EXPECT_FALSE(three.ask("version").failed());
    EXPECT_EQ(three.ask("mesh", {{"document", second}}).code(), -32602)
        << "documents are those of their client";
    EXPECT_FALSE(three.ask("shutdown").failed());
    EXPECT_EQ(server.wait(), 0);
    EXPECT_FALSE(std::filesystem::exists(path));
}

TEST_F(Serve, TakesTheSocketOfOneThatWasKilled) {
    const std::string path = folder.path("here");
    {
        ServerProcess killed({"--socket", path}, folder.folder.string());
        ServerProcess::connect(path);
        ServerProcess second({"--socket", path}, folder.folder.string());
        EXPECT_EQ(second.wait(), 2);
        EXPECT_NE(second.errors().find("another server listens there"), std::string::npos) << second.errors();
    }
    ASSERT_TRUE(std::filesystem::exists(path));
    ServerProcess server({"--socket", path}, folder.folder.string());
    EXPECT_FALSE(ServerProcess::connect(path).ask("version").failed());

    test::writeText(folder.path("file"), "kept");
    ServerProcess third({"--socket", folder.path("file")}, folder.folder.string());
    EXPECT_EQ(third.wait(), 2);
    EXPECT_NE(third.errors().find("choose another path"), std::string::npos) << third.errors();
    EXPECT_EQ(test::readText(folder.path("file")), "kept");
}

TEST_F(Serve, AsksNothingOfADocumentThatDidNotOpen) {
    ServerProcess server({}, folder.folder.string());
    ServerClient& client = server.client;
    const int open = client.send("open", {{"path", "nothing.field.json"}});
    std::vector<int> guessed;
    for (const char* method : {"mesh", "check", "parameters", "set", "time", "measure"})
        guessed.push_back(
            client.send(method, {{"document", 1}, {"values", ServedJson::object()}, {"seconds", 1}}));
    EXPECT_EQ(client.answer(open).code(), -32000);
    for (const int id : guessed) {
        const ServerMessage message = client.answer(id);
        EXPECT_TRUE(message.failed() || message.result().at("parameters").empty()) << message.json.dump();
    }
    EXPECT_GT(client.open("ball.field.json"), 1);
}

TEST_F(Serve, HoldsNoMoreDocumentsThanItSays) {
    ServerProcess server({}, folder.folder.string());
    const auto most = server.client.ask("version").result().at("limits").at("documents").get<int>();
    std::vector<int> open;
    for (int i = 0; i < most; ++i) open.push_back(server.client.open("ball.field.json"));
    EXPECT_EQ(server.client.ask("open", {{"path", "ball.field.json"}}).code(), -32002);
    // Whoever has the answer has the room, however the threads of the two take turns.
    for (int i = 0; i < 200; ++i) {
        EXPECT_FALSE(server.client.ask("close", {{"document", open[i % most]}}).failed());
        EXPECT_EQ(server.client.ask("open", {{"path", "none.field.json"}}).code(), -32000);
        open[i % most] = server.client.open("ball.field.json");
        ASSERT_GT(open[i % most], 0);
    }
}

TEST_F(Serve, ManyDocumentsLeaveNothingBehind) {
    // The validation layers keep some of each device that there was.
    ServerProcess server({}, folder.folder.string(), {"FIELDWRIGHT_VALIDATION=0"});
    ServerClient& client = server.client;
    const bool all = std::getenv("FIELDWRIGHT_LONG") != nullptr;
    const int documents = all ? 1000 : 24;
    double before = 0;
    for (int i = 0; i < documents; ++i) {
        const int ball = client.open("ball.field.json");
        ASSERT_FALSE(
            client.ask("set", {{"document", ball}, {"values", {{"radius", 1 + 0.001 * i}}}}).failed());
        if (all || i % 8 == 0) { ASSERT_FALSE(client.ask("mesh", {{"document", ball}}).failed()); }
        ASSERT_FALSE(client.ask("close", {{"document", ball}}).failed());
        if (i == documents / 4) before = server.megabytes();
    }
    EXPECT_LT(server.megabytes(), before + 40);
}

}  // namespace fw::serve_test
