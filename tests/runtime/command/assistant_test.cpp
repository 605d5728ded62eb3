// `fieldwright serve --mcp` as an assistant's client has it: a real child process.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/graph/temp_dir.h"
#include "tests/support/served.h"

namespace fw::assistant_test {

using test::ServedJson;
using test::ServerMessage;
using test::ServerProcess;
using test::TempDir;

const ServedJson kBall = ServedJson::parse(R"({"fieldwright": 1, "unit": "mm",
  "nodes": [{"id": "ball", "type": "sphere", "inputs": {"radius": 1}},
            {"id": "out", "type": "output", "inputs": {"surface": {"from": "ball"}, "resolution": 24}}],
  "parameters": [{"name": "radius", "node": "ball", "input": "radius", "min": 0.125, "max": 4}]})");

struct Assistant : testing::Test {
    TempDir folder;
    std::optional<ServerProcess> server;
    void SetUp() override { server.emplace(std::vector<std::string>{"--mcp"}, folder.folder.string()); }

    ServerMessage greet(const std::string& revision) {
        const ServerMessage message =
            server->client.ask("initialize", {{"protocolVersion", revision},
                                              {"capabilities", ServedJson::object()},
                                              {"clientInfo", {{"name", "test"}, {"version", "1"}}}});
        server->client.sendLine(R"({"jsonrpc": "2.0", "method": "notifications/initialized"})");
        return message;
    }
    ServedJson call(const std::string& tool, ServedJson arguments) {
        const ServerMessage message = server->client.ask(
            "tools/call", {{"name", tool}, {"arguments", arguments}, {"_meta", {{"progressToken", "t"}}}});
        EXPECT_FALSE(message.failed()) << message.json.dump();
        return message.failed() ? ServedJson() : message.result();
    }
    std::string said(const std::string& tool, ServedJson arguments, bool wrong = false) {
        const ServedJson result = call(tool, std::move(arguments));
        EXPECT_EQ(result.value("isError", false), wrong) << result.dump();
        return result.at("content")[0].at("text").get<std::string>();
    }
};

TEST_F(Assistant, AgreesOnARevision) {
    for (const auto& [asked, given] :
         {std::pair("2025-06-18", "2025-06-18"), std::pair("2024-11-05", "2024-11-05"),
          std::pair("2099-01-01", "2025-06-18")}) {
        server.emplace(std::vector<std::string>{"--mcp"}, folder.folder.string());
        EXPECT_EQ(server->client.ask("tools/list").code(), -32600) << "initialize comes first";
        EXPECT_FALSE(server->client.ask("ping").failed());
        const ServedJson result = greet(asked).result();
        EXPECT_EQ(result.at("protocolVersion"), given);
        EXPECT_TRUE(result.at("capabilities").contains("tools"));
        EXPECT_EQ(result.at("serverInfo").at("name"), "fieldwright");
        EXPECT_NE(result.at("instructions").get<std::string>().find("\"output\""), std::string::npos);
    }
    const ServedJson tools = server->client.ask("tools/list").result().at("tools");
    std::vector<std::string> names;
    for (const ServedJson& tool : tools) {
        names.push_back(tool.at("name"));
        EXPECT_EQ(tool.at("inputSchema").at("type"), "object");
        EXPECT_GT(tool.at("description").get<std::string>().size(), 40u);
    }
    EXPECT_EQ(names, (std::vector<std::string>{"list_nodes", "node_help", "write_graph", "check_graph",
                                               "look", "measure", "export"}));
    EXPECT_EQ(server->client.ask("tools/call", {{"name", "nothing"}}).code(), -32602);
    EXPECT_EQ(server->client.ask("resources/list").code(), -32601);
    server->client.endSending();
    EXPECT_EQ(server->wait(), 0);
}

TEST_F(Assistant, Models) {
    greet("2025-06-18");
    EXPECT_NE(said("list_nodes", {{"category", "Shapes"}}).find("\nsphere ("), std::string::npos);
    const std::string help = said("node_help", {{"types", {"sphere", "spere"}}});
    EXPECT_NE(help.find("| `radius` |"), std::string::npos) << help;
    EXPECT_NE(help.find("did you mean 'sphere'"), std::string::npos) << help;

    ServedJson wrong = kBall;
    wrong["nodes"][0]["inputs"]["radius"] = -1;
    EXPECT_NE(said("write_graph", {{"path", "ball.field.json"}, {"graph", wrong}}, true)
                  .find("node 'ball', input 'radius'"),
              std::string::npos);
    EXPECT_NE(said("write_graph", {{"path", "no.field.json"}, {"graph", "{"}}, true).find("error"),
              std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(folder.folder / "no.field.json"));
    EXPECT_EQ(said("write_graph", {{"path", "ball.field.json"}, {"graph", kBall}}),
              "Written to ball.field.json. Nothing is wrong with it.");
    EXPECT_NE(said("check_graph", {{"path", "ball.field.json"}}).find("\"name\":\"radius\""),
              std::string::npos);

    for (const char* from : {"front", "top", "bottom", "three_quarters"}) {
        const ServedJson looked =
            call("look", {{"path", "ball.field.json"}, {"from", from}, {"width", 64}, {"height", 64}});
        ASSERT_EQ(looked.at("content")[0].at("type"), "image") << looked.dump();
        EXPECT_EQ(looked.at("content")[0].at("mimeType"), "image/png");
        // The signature of a PNG file, in base 64.
        EXPECT_TRUE(looked.at("content")[0].at("data").get<std::string>().starts_with("iVBORw0KGgo"));
    }
    const auto volume = [&](ServedJson arguments) {
        arguments["path"] = "ball.field.json";
        return ServedJson::parse(said("measure", arguments)).at("volume").get<double>();
    };
    EXPECT_NEAR(volume({}), 4.19, 0.1);
    EXPECT_NEAR(volume({{"values", {{"radius", 2}}}}), 33.5, 0.8);
    EXPECT_NEAR(volume({}), 4.19, 0.1) << "values are those of one call";
    // The user changes the file: what is looked at is what lies there.
    ServedJson larger = kBall;
    larger["nodes"][0]["inputs"]["radius"] = 2;
    test::writeText(folder.path("ball.field.json"), larger.dump());
    EXPECT_NEAR(volume({}), 33.5, 0.8);

    said("export", {{"path", "ball.field.json"}, {"output", "ball.glb"}});
    EXPECT_TRUE(std::filesystem::exists(folder.folder / "ball.glb"));
    EXPECT_NE(said("look", {{"path", "nothing.field.json"}}, true).find("no such file"), std::string::npos);
    EXPECT_NE(said("look", {{"path", "ball.field.json"}, {"form", "top"}}, true).find("'from'"),
              std::string::npos);
    // Progress has the token that was given, and grows.
    double last = -1;
    for (const ServerMessage& message : server->client.progress) {
        EXPECT_EQ(message.json.at("method"), "notifications/progress");
        EXPECT_EQ(message.json.at("params").at("progressToken"), "t");
    }
    for (const ServerMessage& message : server->client.progress)
        if (message.json.at("params").at("message") == "compile")
            last = message.json.at("params").at("progress");
    EXPECT_GT(last, 0.0);
}

/// What an assistant reads first is what it copies.
TEST_F(Assistant, TheGraphOfItsInstructionsIsSound) {
    const std::string text = greet("2025-06-18").result().at("instructions");
    const std::size_t begin = text.find("{\"fieldwright\"");
    ASSERT_NE(begin, std::string::npos);
    const std::string graph = text.substr(begin, text.find("\n\n", begin) - begin);
    EXPECT_EQ(said("write_graph", {{"path", "lamp.field.json"}, {"graph", graph}}),
              "Written to lamp.field.json. Nothing is wrong with it.");
    EXPECT_EQ(server->client.ask("tools/call", {{"nmae", "look"}}).code(), -32602);
    const ServerMessage near = server->client.ask("tools/call", {{"name", "loook"}});
    EXPECT_NE(near.message().find("no tool 'loook': did you mean 'look'?"), std::string::npos)
        << near.message();
}

TEST_F(Assistant, StaysWithinItsRoots) {
    greet("2024-11-05");
    const TempDir outside;
    test::writeText(outside.path("ball.field.json"), kBall.dump());
    const std::string up = "../" + outside.folder.filename().string() + "/";
    for (const std::string& path : {outside.path("x.field.json"), up + "x.field.json"})
        EXPECT_NE(said("write_graph", {{"path", path}, {"graph", kBall}}, true).find("outside"),
                  std::string::npos);
    EXPECT_NE(said("check_graph", {{"path", up + "ball.field.json"}}, true).find("outside"),
              std::string::npos);
    said("write_graph", {{"path", "ball.field.json"}, {"graph", kBall}});
    EXPECT_NE(said("export", {{"path", "ball.field.json"}, {"output", up + "a.stl"}}, true).find("outside"),
              std::string::npos);
    EXPECT_EQ(outside.names(), std::vector<std::string>{"ball.field.json"});
}

TEST_F(Assistant, WhatIsCancelledHasNoAnswer) {
    greet("2025-06-18");
    said("write_graph", {{"path", "ball.field.json"}, {"graph", kBall}});
    const int first = server->client.send(
        "tools/call", {{"name", "measure"}, {"arguments", {{"path", "ball.field.json"}}}});
    const int second =
        server->client.send("tools/call", {{"name", "look"}, {"arguments", {{"path", "ball.field.json"}}}});
    server->client.sendLine(ServedJson{
        {"jsonrpc", "2.0"}, {"method", "notifications/cancelled"}, {"params", {{"requestId", second}}}}
                                .dump());
    EXPECT_FALSE(server->client.ask("ping").failed());
    EXPECT_FALSE(server->client.answer(first).failed());
    const int third = server->client.send("tools/call", {{"name", "list_nodes"}});
    const ServerMessage next = server->client.next();
    EXPECT_EQ(next.json.at("id"), third);
}

}  // namespace fw::assistant_test
