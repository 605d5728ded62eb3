#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "graph/document/json.h"

namespace fw::json_write_test {

namespace fs = std::filesystem;

/// The example that the format was designed with: the layout that writing keeps.
constexpr const char* kTower = R"({
  "fieldwright": 1,
  "nodes": [
    {"id": "tower", "type": "box", "at": [0, 0], "inputs": {"half_extents": [1, 2, 1]}},
    {"id": "holes", "type": "expression", "at": [0, 160],
     "code": "vec3 c = abs(mod(p, 0.5) - 0.25) - 0.15; return min(max(c.x, c.y), min(max(c.y, c.z), max(c.x, c.z)));"},
    {"id": "cut", "type": "subtract", "at": [240, 0], "inputs": {"a": {"from": "tower"}, "b": {"from": "holes"}}},
    {"id": "out", "type": "output", "at": [480, 0], "inputs": {"surface": {"from": "cut"}}}
  ]
}
)";

Graph parsed(const std::string& text) {
    const Result<Graph> graph = parseGraph(text, "a.field.json", nullptr);
    EXPECT_TRUE(graph) << (graph ? "" : format(graph.error()));
    return graph ? *graph : Graph();
}

TEST(JsonWrite, WritesTheExampleAsItStands) { EXPECT_EQ(writeGraph(parsed(kTower)), kTower); }

TEST(JsonWrite, LaysLongThingsOutOverLines) {
    Graph graph;
    Node node;
    node.id = "n", node.type = "polygon", node.at = {1.5, -2};
    std::vector<double> numbers;
    for (int i = 0; i < 60; ++i) numbers.push_back(i + 0.25);
    node.set("points", {numbers, {}, 2, {}});
    node.set("row", {numbers, {}, 0, {}});
    node.set("word", {std::string("a"), {}, 0, {}});
    graph.nodes.push_back(node);
    const std::string text = writeGraph(graph);
    EXPECT_NE(text.find("    {\"id\": \"n\", \"type\": \"polygon\", \"at\": [1.5, -2],\n     \"inputs\": {\n "
                        "      \"points\": [\n         [0.25, 1.25],\n"),
              std::string::npos)
        << text;
    EXPECT_NE(text.find("       \"row\": [\n         0.25, 1.25, "), std::string::npos) << text;
    for (std::size_t begin = 0; begin < text.size(); begin = text.find('\n', begin) + 1)
        EXPECT_LE(text.find('\n', begin) - begin, 120u);
    EXPECT_EQ(parsed(text).nodes, graph.nodes);
}

TEST(JsonWrite, WritesNumbersShortAndExact) {
    const std::pair<double, const char*> cases[] = {{1, "1"},
                                                    {-0.0, "-0"},
                                                    {0.1, "0.1"},
                                                    {100000, "100000"},
                                                    {1e-5, "0.00001"},
                                                    {1e-7, "1e-07"},
                                                    {123456789012, "123456789012"},
                                                    {1e16, "1e+16"},
                                                    {5e-324, "5e-324"},
                                                    {1.0 / 3, "0.3333333333333333"},
                                                    {1.7976931348623157e308, "1.7976931348623157e+308"},
                                                    {NAN, "0"},
                                                    {INFINITY, "1.7976931348623157e+308"}};
    for (const auto& [number, text] : cases) {
        Graph graph;
        graph.nodes.push_back({});
        graph.nodes[0].id = "a", graph.nodes[0].type = "value";
        graph.nodes[0].set("value", {number, {}, 0, {}});
        EXPECT_NE(writeGraph(graph).find("\"value\": " + std::string(text) + "}"), std::string::npos)
            << writeGraph(graph);
    }
}

/// Documents of every feature of the format, well-formed but without sense.
class RandomGraphs {
  public:
    explicit RandomGraphs(unsigned seed) : random(seed) {}

    Graph graph() {
        Graph graph;
        graph.nodes = nodes(60);
        for (int i = below(4); i > 0; --i) graph.groups.push_back(group());
        for (int i = below(5); i > 0; --i) {
            ExposedParameter parameter{text(), text(), text(), {}, {}, extra(), {}};
            if (below(2)) parameter.min = number();
            if (below(2)) parameter.max = number();
            graph.parameters.push_back(parameter);
        }
        if (below(2)) graph.scene = Json{{"camera", {number(), number()}}, {text() + "1", json(3)}};
        if (below(2)) graph.timeline = Json::object();
        if (below(2)) graph.frames = Json::array({json(4), json(2)});
        graph.extra = extra();
        graph.path = "r.field.json";
        return graph;
    }

  private:
    int below(int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); }

    double number() {
        switch (below(4)) {
            case 0: return below(1000) - 500;
            case 1: return (below(1990) - 1000) / 8.0;
            case 2: return std::ldexp(below(1 << 30) - (1 << 29), below(1990) - 1000);
            default: return below(2) ? 0.0 : -0.0;
        }
    }

    std::string text() {
        static const std::vector<std::string> parts = {"a",  "b_2", "é", "😀",    "\"",      "\\",
                                                       "\n", " ",   "/", "\x01", "surface", "0"};
        std::string result;
        for (int i = below(8); i > 0; --i)
            result += parts[static_cast<std::size_t>(below(static_cast<int>(parts.size())))];
        return result;
    }

    Json json(int depth) {
        switch (below(depth > 0 ? 7 : 5)) {
            case 0: return nullptr;
            case 1: return below(2) == 1;
            case 2: return text();
            case 3: return number();
            case 4: return below(100) - 50;
            case 5: {
                Json array = Json::array();
                for (int i = below(12); i > 0; --i) array.push_back(json(depth - 1));
                return array;
            }
            default: {
                Json object = Json::object();
                for (int i = below(6); i > 0; --i) object["k" + std::to_string(i) + text()] = json(depth - 1);
                return object;
            }
        }
    }

    Json extra() {
        Json object;
        if (below(4) == 0)
            for (int i = below(3) + 1; i > 0; --i) object["unknown" + std::to_string(i)] = json(3);
        return object;
    }

    InputValue value() {
        switch (below(7)) {
            case 0: return {number(), {}, 0, {}};
            case 1: return {below(2) == 1, {}, 0, {}};
            case 2: return {text(), {}, 0, {}};
            case 3: return {std::vector<double>(static_cast<std::size_t>(below(5)), number()), {}, 0, {}};
            case 4:
                return {
                    std::vector<double>(static_cast<std::size_t>(2 * below(30) + 2), number()), {}, 2, {}};
            case 5:
                return {
                    std::vector<double>(static_cast<std::size_t>(4 * below(30) + 4), number()), {}, 4, {}};
            default: return {Link{text(), below(2) ? text() : ""}, {}, 0, extra()};
        }
    }

    std::vector<Node> nodes(int most) {
        std::vector<Node> result;
        for (int i = below(most); i > 0; --i) {
            Node node;
            node.id = text(), node.type = "x" + text(), node.label = text(), node.group = text(),
            node.code = text();
            if (below(2)) node.at = {number(), number()};
            node.muted = below(2), node.collapsed = below(2);
            for (int k = below(6); k > 0; --k) node.set("i" + std::to_string(k) + text(), value());
            node.extra = extra();
            result.push_back(node);
        }
        return result;
    }

    Group group() {
        Group group;
        group.id = text();
        for (int i = below(4); i > 0; --i) {
            group.inputs.push_back({text(), text(), {}, extra(), {}});
            if (below(2)) group.inputs.back().value = value();
        }
        for (int i = below(4); i > 0; --i) group.outputs.push_back({text(), text(), extra(), {}});
        group.nodes = nodes(8);
        group.extra = extra();
        return group;
    }

    std::mt19937 random;
};

TEST(JsonWrite, RandomDocumentsSurviveWritingAndReading) {
    for (unsigned seed = 0; seed < 500; ++seed) {
        const Graph graph = RandomGraphs(seed).graph();
        const std::string text = writeGraph(graph);
        const Result<Graph> again = parseGraph(text, graph.path, nullptr);
        ASSERT_TRUE(again) << "seed " << seed << ": " << format(again.error()) << "\n" << text;
        ASSERT_TRUE(*again == graph) << "seed " << seed << "\n" << text;
        ASSERT_EQ(writeGraph(*again), text) << "seed " << seed;
    }
}

TEST(JsonWrite, DamagedTextNeverDoesHarm) {
    std::mt19937 random(1);
    const std::string good = writeGraph(RandomGraphs(3).graph());
    for (int i = 0; i < 3000; ++i) {
        std::string text = good;
        for (unsigned k = random() % 4; k < 4; ++k) {
            const std::size_t at = random() % text.size();
            if (random() % 2) text[at] = static_cast<char>(random());
            if (random() % 4 == 0) text.erase(at, random() % 20);
            if (random() % 4 == 0) text.insert(at, text.substr(random() % text.size(), random() % 50));
        }
        const Result<Graph> graph = parseGraph(text, "a.field.json", nullptr);
        if (!graph) {
            EXPECT_FALSE(graph.error().message.empty());
            EXPECT_GT(graph.error().line, 0);
        }
    }
}

TEST(JsonWrite, ReplacesBytesThatAreNotText) {
    Graph graph;
    graph.nodes.push_back({});
    graph.nodes[0].id = "a", graph.nodes[0].type = "x", graph.nodes[0].label = "\xFFok";
    EXPECT_EQ(parsed(writeGraph(graph)).nodes.at(0).label, "\xEF\xBF\xBDok");
}

class JsonFile : public testing::Test {
  protected:
    JsonFile() { fs::create_directories(folder); }
    ~JsonFile() override {
        fs::permissions(folder, fs::perms::owner_all);
        fs::remove_all(folder);
    }

    std::string contents(const fs::path& from) {
        std::ifstream file(from, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    std::size_t filesThere() {
        return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), {}));
    }

    const fs::path folder = fs::temp_directory_path() / ("fieldwright-json-" + std::to_string(getpid()));
    const std::string path = folder / "a.field.json";
};

TEST_F(JsonFile, SavesAndReads) {
    Graph graph = parsed(kTower);
    ASSERT_TRUE(saveGraph(graph, path));
    EXPECT_EQ(contents(path), kTower);
    EXPECT_EQ(filesThere(), 1u);
    const Result<Graph> again = readGraph(path, nullptr);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->path, path);
    graph.nodes.pop_back();
    ASSERT_TRUE(saveGraph(graph, path));
    EXPECT_EQ(readGraph(path, nullptr)->nodes.size(), 3u);
}

TEST_F(JsonFile, KeepsPermissionsAndLinks) {
    const Graph graph = parsed(kTower);
    ASSERT_TRUE(saveGraph(graph, path));
    ASSERT_EQ(chmod(path.c_str(), 0640), 0);
    const std::string link = folder / "link.field.json";
    fs::create_symlink("a.field.json", link);
    ASSERT_TRUE(saveGraph(Graph(), link));
    EXPECT_TRUE(fs::is_symlink(link));
    EXPECT_EQ(contents(path), "{\n  \"fieldwright\": 1,\n  \"nodes\": []\n}\n");
    struct stat status;
    ASSERT_EQ(stat(path.c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 07777, 0640u);
}

TEST_F(JsonFile, NamesWhatPreventsSaving) {
    const Graph graph = parsed(kTower);
    const auto message = [&](const std::string& to) {
        const Done saved = saveGraph(graph, to);
        EXPECT_FALSE(saved) << to;
        if (saved) return std::string();
        EXPECT_EQ(saved.error().file, to);
        return saved.error().message;
    };
    EXPECT_NE(message(folder / "no" / "a.json").find("the folder does not exist"), std::string::npos);
    EXPECT_NE(message(folder).find("this is a folder"), std::string::npos);
    EXPECT_NE(message("/dev/full").find("a device or a pipe"), std::string::npos);
    EXPECT_NE(message(folder / std::string(300, 'a')).find("cannot write the file"), std::string::npos);
    if (geteuid() != 0) {
        fs::permissions(folder, fs::perms::owner_read | fs::perms::owner_exec);
        EXPECT_NE(message(path).find("no permission"), std::string::npos);
    }
    Graph broken = graph;
    broken.nodes[0].set("rounding", {NAN, {}, 0, {}});
    const Done saved = saveGraph(broken, path);
    ASSERT_FALSE(saved);
    EXPECT_EQ(saved.error().node, "tower");
    EXPECT_EQ(saved.error().input, "rounding");
    EXPECT_FALSE(fs::exists(path));
}

TEST_F(JsonFile, LeavesTheFormerFileWholeOnAFullDisk) {
    // A limit on file sizes stands in for the full disk: both make write() fail midway.
    const Graph graph = parsed(kTower);
    ASSERT_TRUE(saveGraph(graph, path));
    const pid_t child = fork();
    if (child == 0) {
        signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{100, 100};
        setrlimit(RLIMIT_FSIZE, &limit);
        _exit(saveGraph(graph, path) ? 1 : 0);
    }
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    EXPECT_EQ(contents(path), kTower);
    EXPECT_EQ(filesThere(), 1u);
}

TEST_F(JsonFile, NamesWhatPreventsReading) {
    const auto message = [](const std::string& from) {
        const Result<Graph> graph = readGraph(from, nullptr);
        EXPECT_FALSE(graph) << from;
        return graph ? "" : format(graph.error());
    };
    EXPECT_EQ(message(path), path + ": error: there is no such file: check the path");
    EXPECT_NE(message(folder).find("this is a folder"), std::string::npos);
    EXPECT_NE(message("/dev/zero").find("larger than 16 MiB"), std::string::npos);
    for (const auto& entry : fs::directory_iterator(FIELDWRIGHT_SOURCE_DIR "/tests/data/bad")) {
        const std::string file = entry.path();
        if (entry.path().filename().string().starts_with("read-")) {
            EXPECT_TRUE(message(file).starts_with(file + ":")) << message(file);
        }
    }
}

}  // namespace fw::json_write_test
