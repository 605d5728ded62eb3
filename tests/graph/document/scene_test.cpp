// The document's scene: every key read, every wrong one refused with its name and place, the schema's ranges
// and defaults those of the reader, tracks of the timeline on keys that the document does not have.
#include "graph/document/scene.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "graph/check/check.h"
#include "graph/document/json.h"
#include "graph/document/schema.h"
#include "graph/document/timeline.h"

namespace fw::scene_test {

Scene sceneOf(const std::string& text) {
    const Result<Scene> scene = readScene(Json::parse(text));
    EXPECT_TRUE(scene) << text << (scene ? "" : "\n" + scene.error().message);
    return scene ? *scene : Scene{};
}
/// Of a scene that must be refused.
std::string refusal(const Json& json) {
    const Result<Scene> scene = readScene(json);
    EXPECT_FALSE(scene) << json;
    return scene ? "" : scene.error().message;
}

/// A document with this scene and, if any, these tracks.
std::string documentWith(const std::string& scene, const std::string& tracks = "") {
    return "{\"fieldwright\": 1, \"nodes\": [\n"
           "{\"id\": \"ball\", \"type\": \"sphere\"},\n"
           "{\"id\": \"out\", \"type\": \"output\", \"inputs\": {\"surface\": {\"from\": \"ball\"}}}]" +
           (scene.empty() ? "" : ",\n\"scene\": " + scene) +
           (tracks.empty() ? "" : ",\n\"timeline\": {\"tracks\": [" + tracks + "]}") + "}";
}
Graph graphWith(const std::string& scene, const std::string& tracks = "") {
    const Result<Graph> graph = parseGraph(documentWith(scene, tracks), "a.field.json", nullptr);
    EXPECT_TRUE(graph) << (graph ? "" : format(graph.error()));
    return graph ? *graph : Graph{};
}
std::vector<std::string> findings(const std::string& scene, const std::string& tracks = "") {
    std::vector<std::string> texts;
    for (const Error& finding : check(graphWith(scene, tracks))) texts.push_back(format(finding));
    return texts;
}
void expectFinding(const std::string& scene, const std::string& tracks,
                   const std::vector<std::string>& parts) {
    const std::vector<std::string> texts = findings(scene, tracks);
    ASSERT_EQ(texts.size(), 1u) << scene << tracks << (texts.empty() ? "" : "\n" + texts[0]);
    for (const std::string& part : parts) EXPECT_NE(texts[0].find(part), std::string::npos) << texts[0];
}
std::string track(const std::string& path, const std::string& keys) {
    return "{\"scene\": \"" + path + "\", \"keys\": [" + keys + "]}";
}
constexpr const char* kRising = R"({"time": 0, "value": 1}, {"time": 2, "value": 3})";
constexpr const char* kOne = R"({"time": 0, "value": 1})";

TEST(Scene, NothingIsTheDefault) {
    EXPECT_EQ(sceneOf("null"), Scene{});
    EXPECT_EQ(sceneOf("{}"), Scene{});
    EXPECT_EQ(sceneOf(R"({"unknown": {"any": [1]}, "sun": {"colour": 3}})"), Scene{});
    const Scene scene;
    EXPECT_TRUE(scene.sun && scene.ao && scene.ground);
    EXPECT_FALSE(scene.camera || scene.sky || scene.fog);
}

TEST(Scene, ReadsEveryKey) {
    const Scene scene = sceneOf(R"({
      "camera": {"position": [1, 2, 3], "target": [4, 5, 6], "fov": 50, "aperture": 0.1, "focus": 3},
      "sun": {"azimuth": -400, "elevation": -90, "color": [0.1, 0.2, 0.3], "strength": 7, "size": 0.5},
      "sky": {"zenith": [1, 2, 3], "horizon": [4, 5, 6], "ground": [7, 8, 9], "strength": 0.5},
      "ao": {"radius": 0.25, "strength": 0.75},
      "ground": {"height": -2},
      "fog": {"density": 0.5, "height": 3, "color": [0.4, 0.5, 0.6]},
      "lights": [
        {"type": "spot", "position": [1, 0, 0], "target": [0, 1, 0], "color": [0, 0, 1], "strength": 2,
         "angle": 20, "blend": 0.5, "size": 0.4},
        {"type": "directional"}, {"type": "point"}, {}],
      "exposure": -1.5, "tone": "neutral"})");
    Scene wanted;
    wanted.camera = Camera{{1, 2, 3}, {4, 5, 6}, 50, 0.1, 3};
    wanted.sun = Sun{-400, -90, {0.1, 0.2, 0.3}, 7, 0.5};
    wanted.sky = Sky{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, 0.5};
    wanted.ao = AmbientOcclusion{0.25, 0.75};
    wanted.ground = Ground{-2};
    wanted.fog = Fog{0.5, 3, {0.4, 0.5, 0.6}};
    wanted.lights = {Lamp{Lamp::Type::spot, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, 2, 20, 0.5, 0.4},
                     Lamp{.type = Lamp::Type::directional}, Lamp{}, Lamp{}};
    wanted.exposure = -1.5;
    wanted.tone = Tone::neutral;
    EXPECT_EQ(scene, wanted);
}

TEST(Scene, SwitchesOnAndOff) {
    const Scene off = sceneOf(R"({"sun": false, "sky": false, "ao": false, "ground": false, "fog": false})");
    EXPECT_FALSE(off.sun || off.sky || off.ao || off.ground || off.fog);
    const Scene on =
        sceneOf(R"({"sun": true, "sky": true, "ao": true, "ground": true, "fog": true, "bloom": true})");
    EXPECT_EQ(on.sun, Sun{});
    EXPECT_EQ(on.sky, Sky{});
    EXPECT_EQ(on.ao, AmbientOcclusion{});
    EXPECT_EQ(on.ground, Ground{});
    EXPECT_EQ(on.fog, Fog{});
    EXPECT_EQ(on.bloom, Bloom{});
    for (const char* key : {"sun", "sky", "ao", "ground", "fog", "bloom"}) {
        for (const char* wrong : {"null", "0", "\"off\"", "[]"}) {
            const std::string text = refusal({{key, Json::parse(wrong)}});
            EXPECT_NE(text.find("the scene's " + std::string(key) + " must be an object such as {"),
                      std::string::npos);
            EXPECT_TRUE(text.ends_with(", or false")) << text;
        }
        EXPECT_EQ(sceneOf("{\"" + std::string(key) + "\": {}}"),
                  sceneOf("{\"" + std::string(key) + "\": true}"));
    }
    EXPECT_EQ(refusal({{"camera", false}}).find("or false"), std::string::npos);
    EXPECT_EQ(refusal(Json::parse(R"({"lights": [false]})")).find("or false"), std::string::npos);
    for (const char* wrong : {"false", "{}", "null", "5"}) refusal({{"lights", Json::parse(wrong)}});
    for (const char* wrong : {"false", "[]", "5", "\"dusk\""})
        EXPECT_EQ(refusal(Json::parse(wrong)), "\"scene\" must be an object");
}

/// Calls use(path, its schema) for every number, vector and choice of the scene; `path` is a JSON pointer.
template <class Use>
void forValues(const Json& schema, const std::string& path, Use use) {
    const Json& object = schema.contains("anyOf") ? schema["anyOf"][1] : schema;
    if (object.value("type", "") == "object")
        for (const auto& [key, member] : object["properties"].items())
            forValues(member, path + "/" + key, use);
    else if (object.value("type", "") == "array" && !object.contains("minItems"))
        forValues(object["items"], path + "/0", use);
    else
        use(path, schema);
}
/// A sound scene with this value at the path.
Json sceneWith(const std::string& path, const Json& value) {
    Json scene = Json::object();
    if (path.starts_with("/lights")) scene["lights"] = Json::parse(R"([{"type": "spot"}])");
    scene[Json::json_pointer(path)] = value;
    return scene;
}
std::string dotted(std::string path) {
    path.erase(0, 1);
    std::replace(path.begin(), path.end(), '/', '.');
    return path;
}

TEST(Scene, TheSchemaKnowsWhatIsRead) {
    const Json schema = Json::parse(fileSchema())["properties"]["scene"];
    int values = 0;
    forValues(schema, "", [&](const std::string& path, const Json& value) {
        ++values;
        if (path == "/sky/image") {
            for (const char* wrong : {"null", "true", "3", "[]", "{}", "\"\""})
                EXPECT_NE(refusal(sceneWith(path, Json::parse(wrong))).find("the scene's sky.image"),
                          std::string::npos);
            EXPECT_TRUE(readScene(sceneWith(path, "maps/harbour.hdr")));
            return;
        }
        if (value.contains("default")) {
            const Result<Scene> given = readScene(sceneWith(path, value["default"]));
            EXPECT_TRUE(given) << path;
            // A light's own type is given beside it, so that of a light without one is the default.
            Json without = sceneWith(path, value["default"]);
            if (path == "/lights/0/type")
                without["lights"][0] = Json::object();
            else
                without[Json::json_pointer(path).parent_pointer()].erase(path.substr(path.rfind('/') + 1));
            const Result<Scene> absent = readScene(without);
            EXPECT_TRUE(given && absent && *given == *absent) << path << " is not " << value["default"];
        } else {
            EXPECT_EQ(path, "/ground/height");
        }
        const auto expectRefused = [&](const Json& wrong) {
            const std::string text = refusal(sceneWith(path, wrong));
            EXPECT_NE(text.find("the scene's " + dotted(path)), std::string::npos) << text;
        };
        for (const char* wrong :
             {"\"1\"", "null", "{}", "true", "[]", "[1, 2]", "[1, 2, 3, 4]", "[1, \"2\", 3]"})
            if (value.value("type", "") != "boolean" || wrong != std::string("true"))
                expectRefused(Json::parse(wrong));
        const double infinity = std::numeric_limits<double>::infinity();
        for (double wrong : {infinity, -infinity, std::nan("")}) {
            expectRefused(wrong);
            expectRefused({1.0, wrong, 1.0});
        }
        if (value.contains("enum")) {
            for (const Json& option : value["enum"])
                EXPECT_TRUE(readScene(sceneWith(path, option))) << option;
            return;
        }
        if (value["type"] == "boolean") return expectRefused(1);
        const bool vector = value["type"] == "array";
        expectRefused(vector ? Json(1) : Json({1, 1, 1}));
        const Json& number = vector ? value["items"] : value;
        const auto written = [&](double x) { return vector ? Json({x, x, x}) : Json(x); };
        for (const auto& [bound, outward] : {std::pair("minimum", -1.0), std::pair("maximum", 1.0)}) {
            ASSERT_TRUE(number.contains(bound)) << path;
            const double limit = number[bound].get<double>();
            EXPECT_LE(std::abs(limit), kMostSceneNumber) << path;
            EXPECT_TRUE(readScene(sceneWith(path, written(limit)))) << path << " " << limit;
            expectRefused(written(limit + outward * 1e-6));
        }
    });
    EXPECT_EQ(values, 6 + 6 + 6 + 2 + 1 + 3 + 2 + 8 + 4);
}

TEST(Scene, NothingStandsOnItsTarget) {
    EXPECT_EQ(refusal(Json::parse(R"({"camera": {"position": [1, 2, 3], "target": [1, 2, 3]}})")),
              "the scene's camera stands on its target: move one of them");
    EXPECT_EQ(refusal(Json::parse(R"({"camera": {"position": [0, 0, 0]}})")),
              "the scene's camera stands on its target: move one of them");
    // In single precision; nor so near that no direction is left.
    EXPECT_EQ(refusal(Json::parse(R"({"camera": {"position": [1e9, 0, 0], "target": [999999999, 0, 0]}})")),
              "the scene's camera stands on its target: move one of them");
    EXPECT_EQ(refusal(Json::parse(R"({"camera": {"position": [1e-30, 0, 0], "target": [0, 0, 0]}})")),
              "the scene's camera stands on its target: move one of them");
    for (const char* type : {"spot", "directional"})
        EXPECT_EQ(refusal({{"lights", {Json::object(), {{"type", type}, {"position", {0, 0, 0}}}}}}),
                  "the scene's lights.1 stands on its target: move one of them");
    EXPECT_TRUE(readScene(Json::parse(R"({"lights": [{"type": "point", "position": [0, 0, 0]}]})")));
}

TEST(Scene, HasALimitedNumberOfLights) {
    Json lights = Json::array();
    for (std::size_t i = 0; i < kMostLights; ++i) lights.push_back(Json::object());
    EXPECT_EQ(sceneOf(Json{{"lights", lights}}.dump()).lights.size(), kMostLights);
    lights.push_back(Json::object());
    EXPECT_EQ(refusal({{"lights", lights}}), "the scene's lights must be a list of at most 16 objects");
}

TEST(Scene, ErrorsTellThePlace) {
    expectFinding("{\"ao\": {\"radius\": 1},\n  \"sun\": {\"size\": 1, \"elevation\": 91}}", "",
                  {"a.field.json:5:35: error: ", "sun.elevation must be a number from -90 to 90"});
    expectFinding("{\"lights\": [{},\n {\"strength\": -1}]}", "",
                  {"a.field.json:5:15: error: ", "lights.1.strength must be a number from 0 to 1000000000"});
    expectFinding("{\n\"camera\": {\"position\": [0, 0, 0]}}", "",
                  {"a.field.json:5:11: error: ", "camera stands"});
    expectFinding(
        "{\"fog\":\n{\"color\": [1, -1, 1]}}", "",
        {"a.field.json:5:11: error: ", "fog.color must be three numbers from 0 to 1000000000: [red"});
    expectFinding("{\"tone\":\n \"filmic\"}", "",
                  {"a.field.json:5:2: error: ", "tone must be \"aces\" or \"neutral\""});
    expectFinding("{\"exposure\":\n 21}", "",
                  {"a.field.json:5:2: error: ", "exposure must be a number from -20 to 20"});
    expectFinding(
        "{\"ground\":\n{\"height\": -1e10}}", "",
        {"a.field.json:5:12: error: ", "ground.height must be a number from -1000000000 to 1000000000"});
    expectFinding("{\"camera\":\n{\"position\": [0, 1e10, 0]}}", "",
                  {"a.field.json:5:14: error: ",
                   "camera.position must be three numbers from -1000000000 to 1000000000: [x, y, z]"});
}

TEST(Scene, RefusesNumbersBeyondAllBounds) {
    const Result<Graph> graph =
        parseGraph(documentWith(R"({"sun": {"strength": 1e999}})"), "a.field.json", nullptr);
    ASSERT_FALSE(graph);
    EXPECT_NE(format(graph.error()).find("a.field.json:4:31"), std::string::npos) << format(graph.error());
}

TEST(SceneTracks, MoveKeysThatTheDocumentLacks) {
    for (const char* scene : {"", "{}", R"({"sun": {"strength": 2}})"}) {
        const std::string tracks = track("sun.azimuth", kRising) + ", " + track("exposure", kRising) + ", " +
                                   track("fog.density", kRising) + ", " +
                                   track("camera.position", R"({"time": 0, "value": [1, 2, 3]})");
        EXPECT_TRUE(findings(scene, tracks).empty()) << scene << "\n" << findings(scene, tracks)[0];
        const Graph graph = graphWith(scene, tracks);
        const Result<Scene> at = readScene(sceneAt(graph, *readTimeline(graph), 1.0));
        ASSERT_TRUE(at) << scene;
        EXPECT_EQ(at->sun->azimuth, 2.0);
        EXPECT_EQ(at->exposure, 2.0);
        EXPECT_EQ(at->fog->density, 2.0);
        EXPECT_EQ(at->camera->position, (Triple{1, 2, 3}));
        EXPECT_EQ(at->sun->strength,
                  std::string(scene).find("strength") == std::string::npos ? Sun{}.strength : 2.0);
        EXPECT_EQ(at->sun->elevation, Sun{}.elevation);
    }
}

TEST(SceneTracks, SayWhatCannotMove) {
    const std::string line = "a.field.json:5:";
    // Switched off, or beyond the end of a list: there is nothing to move.
    expectFinding(R"({"sun": false})", track("sun.azimuth", kRising), {line, "no value there"});
    expectFinding(R"({"lights": [{}]})", track("lights.1.position.y", kRising), {line, "no value there"});
    expectFinding(R"({"lights": []})", track("lights.0.strength", kRising), {line, "no value there"});
    expectFinding(R"({"exposure": 1})", track("exposure.x", kRising), {line, "no value there"});
    for (const char* scene : {"", "{}", R"({"lights": [{}, {}]})"})
        expectFinding(scene, track("lights.3.strength", kRising),
                      {"scene 'lights.3.strength': the scene has no value there"});
    // A vector cannot be made from one of its parts.
    expectFinding("{}", track("camera.position.y", kOne),
                  {line, "the scene's camera.position must be three numbers"});
    // Out of range at one key.
    expectFinding("{}", track("sun.elevation", R"({"time": 0, "value": 9}, {"time": 1, "value": 99})"),
                  {line, "the key at 1 s", "sun.elevation must be a number from -90 to 90"});
    expectFinding("{}", track("ao.strength", R"({"time": 0, "value": [1, 2]})"), {line, "ao.strength"});
    // The lamp comes to stand on its target.
    expectFinding(R"({"lights": [{"type": "spot", "position": [0, 1, 0]}]})",
                  track("lights.0.position.y", R"({"time": 0, "value": 0})"), {line, "stands on its target"});
}

TEST(SceneTracks, MoveALightOfTheList) {
    const Graph graph =
        graphWith(R"({"lights": [{}, {"position": [1, 2, 3]}]})", track("lights.1.position.y", kRising));
    EXPECT_TRUE(check(graph).empty());
    const Result<Scene> at = readScene(sceneAt(graph, *readTimeline(graph), 2.0));
    ASSERT_TRUE(at);
    EXPECT_EQ(at->lights[1].position, (Triple{1, 3, 3}));
}

TEST(SceneTracks, ThatMoveNothingAreFound) {
    for (const char* path : {"sun.elevaton", "moon.azimuth", "lights.0.colour", "sun.color.w"})
        expectFinding(R"({"lights": [{}], "sun": {"color": [1, 1, 1]}})", track(path, kRising), {});
}

}  // namespace fw::scene_test
