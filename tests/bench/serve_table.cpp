// A parameter to its mesh and to a picture, as another program has it: through `fieldwright serve`, a child
// process at the end of two pipes.
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>

#include "graph/base/own_files.h"
#include "runtime/play/player.h"
#include "tests/bench/command.h"
#include "tests/bench/tables.h"
#include "tests/bench/verify.h"

extern char** environ;

namespace fw::bench {
namespace {

constexpr int kServedCells = 128, kServedWidth = 640, kServedHeight = 360;
constexpr double kMostMeshMs = 12, kMostInProcessMs = 5, kMostPictureMs = 60;
constexpr const char* kServedParameter = "tube width";

/// A parameter's values, another one at each call.
double nextWidth() {
    static int call = 0;
    return 0.12 + 0.0005 * (++call % 100);
}

/// `fieldwright serve` and its two pipes.
class Child {
  public:
    explicit Child(const std::string& root, const std::string& device) {
        int in[2], out[2];
        if (pipe2(in, O_CLOEXEC) != 0 || pipe2(out, O_CLOEXEC) != 0)
            throw SystemError("making a pipe failed");
        std::vector<std::string> words = {programFolder() / "fieldwright", "serve", "--root", root};
        if (!device.empty()) words.insert(words.end(), {"--device", device});
        std::vector<char*> argv;
        for (std::string& word : words) argv.push_back(word.data());
        argv.push_back(nullptr);
        posix_spawn_file_actions_t files;
        posix_spawn_file_actions_init(&files);
        posix_spawn_file_actions_adddup2(&files, in[0], STDIN_FILENO);
        posix_spawn_file_actions_adddup2(&files, out[1], STDOUT_FILENO);
        const int error = posix_spawn(&process, argv[0], &files, nullptr, argv.data(), environ);
        posix_spawn_file_actions_destroy(&files);
        close(in[0]), close(out[1]);
        if (error) throw SystemError("starting " + words[0] + " failed");
        to = in[1], from = out[0];
    }
    Child(const Child&) = delete;
    ~Child() {
        close(to), close(from);
        waitpid(process, nullptr, 0);
    }

    void send(const char* method, const nlohmann::ordered_json& params) {
        const nlohmann::ordered_json message = {
            {"jsonrpc", "2.0"}, {"id", ++last}, {"method", method}, {"params", params}};
        const std::string line = message.dump() + "\n";
        if (write(to, line.data(), line.size()) != ssize_t(line.size()))
            throw SystemError("the server is gone");
    }
    /// The next answer, whose blobs are then in `blobs`.
    nlohmann::ordered_json answer() {
        for (;;) {
            const nlohmann::ordered_json message = nlohmann::ordered_json::parse(line());
            if (!message.contains("id")) continue;
            if (message.contains("error")) throw SystemError(message["error"]["message"].get<std::string>());
            std::size_t bytes = 0;
            const auto& result = message["result"];
            if (result.contains("blobs"))
                for (const auto& blob : result["blobs"]) bytes += blob["bytes"].get<std::size_t>();
            blobs.resize(bytes);
            std::size_t have = std::min(bytes, filled - taken);
            std::memcpy(blobs.data(), buffer.data() + taken, have);
            taken += have;
            while (have < bytes) have += more(blobs.data() + have, bytes - have);
            return result;
        }
    }
    nlohmann::ordered_json ask(const char* method, const nlohmann::ordered_json& params) {
        send(method, params);
        return answer();
    }
    std::vector<char> blobs;

  private:
    std::size_t more(char* at, std::size_t size) {
        const ssize_t got = read(from, at, size);
        if (got <= 0) throw SystemError("the server is gone");
        return std::size_t(got);
    }
    std::string line() {
        std::string text;
        for (;;) {
            if (taken == filled) taken = 0, filled = more(buffer.data(), buffer.size());
            const char* begin = buffer.data() + taken;
            const auto* end = static_cast<const char*>(std::memchr(begin, '\n', filled - taken));
            text.append(begin, end ? end : begin + (filled - taken));
            taken += (end ? std::size_t(end - begin) + 1 : filled - taken);
            if (end) return text;
        }
    }

    pid_t process = 0;
    int to = -1, from = -1, last = 0;
    std::vector<char> buffer = std::vector<char>(64 << 10);
    std::size_t taken = 0, filled = 0;
};

/// So many bytes through a pipe to another thread: what no protocol can spare.
double pipeOnce(std::size_t bytes) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) throw SystemError("making a pipe failed");
    fcntl(ends[1], F_SETPIPE_SZ, 1 << 20);
    const std::vector<char> data(bytes, 'x');
    std::vector<char> got(bytes);
    const auto start = Clock::now();
    std::thread writer([&] {
        for (std::size_t at = 0; at < bytes;) at += std::size_t(write(ends[1], &data[at], bytes - at));
    });
    for (std::size_t at = 0; at < bytes;) at += std::size_t(read(ends[0], &got[at], bytes - at));
    writer.join();
    const double elapsed = millisecondsSince(start);
    close(ends[0]), close(ends[1]);
    return elapsed;
}

std::string judged(double ms, double most) {
    return number(most) + " (" + (ms <= most ? "met" : "missed") + ")";
}

}  // namespace

void serveTable(Bench& bench) {
    const std::string graph = benchSample("tower");
    const std::filesystem::path folder = std::filesystem::path(graph).parent_path();
    const int repeats = std::max(bench.options.repeats, 15);
    // In process first: what the server does with the same calls.
    PlayerOptions options{.device = bench.options.device, .resolution = kServedCells};
    Result<Player> player = Player::open(graph, options);
    if (!player) return bench.fail(format(player.error()));
    const auto meshInProcess = [&] {
        const auto start = Clock::now();
        if (const Done set = player->set(kServedParameter, nextWidth()); !set)
            bench.fail(format(set.error()));
        const Result<Mesh> mesh = player->mesh();
        const double elapsed = millisecondsSince(start);
        if (!mesh)
            bench.fail(format(mesh.error()));
        else if (const std::string fault = faultOf(mesh->indices, mesh->positions.size()); !fault.empty())
            bench.fail("in process: " + fault);
        return elapsed;
    };
    const auto pictureInProcess = [&](bool live) {
        const RenderOptions render{.width = kServedWidth,
                                   .height = kServedHeight,
                                   .samples = 1,
                                   .primary = live ? Primary::measured : Primary::traced};
        Picture shown;
        const auto start = Clock::now();
        if (const Done set = player->set(kServedParameter, nextWidth()); !set)
            bench.fail(format(set.error()));
        if (live) {
            if (const Result<bool> drawn = player->show(render, shown); !drawn)
                bench.fail(format(drawn.error()));
        } else if (const Result<Picture> drawn = player->frame(render); !drawn) {
            bench.fail(format(drawn.error()));
        }
        return millisecondsSince(start);
    };
    const Figure meshOwn = measure(repeats, meshInProcess);
    const Figure liveOwn = measure(repeats, [&] { return pictureInProcess(true); });
    const Figure stillOwn = measure(repeats, [&] { return pictureInProcess(false); });

    Child child(folder.string(), bench.options.device);
    const int document = child.ask("open", {{"path", std::filesystem::path(graph).filename()}})["document"];
    std::size_t meshBytes = 0;
    const auto overTheWire = [&](const char* method, nlohmann::ordered_json params) {
        params["document"] = document;
        return measure(repeats, [&] {
            const auto start = Clock::now();
            // Both at once: nothing is to be known before the second.
            child.send("set", {{"document", document}, {"values", {{kServedParameter, nextWidth()}}}});
            child.send(method, params);
            child.answer();
            const nlohmann::ordered_json result = child.answer();
            const double elapsed = millisecondsSince(start);
            if (result.contains("triangles") && result["triangles"] < 1000)
                bench.fail("the served mesh lacks triangles");
            return elapsed;
        });
    };
    const Figure meshWire = overTheWire("mesh", {{"resolution", kServedCells}, {"colors", false}});
    meshBytes = child.blobs.size();
    const nlohmann::ordered_json size = {{"width", kServedWidth}, {"height", kServedHeight}};
    nlohmann::ordered_json live = size, png = size;
    live["quality"] = "live";
    png["quality"] = "live", png["format"] = "png";
    const Figure liveWire = overTheWire("picture", live);
    const Figure stillWire = overTheWire("picture", size);
    const Figure pngWire = overTheWire("picture", png);
    const Figure pipe = measure(repeats, [&] { return pipeOnce(meshBytes); });

    TemporaryFolder temporary;
    const Figure command = measure(std::min(bench.options.repeats, 7), [&] {
        const Outcome outcome =
            runCommand({"export", graph, "--resolution", std::to_string(kServedCells), "--set",
                        std::string(kServedParameter) + "=" + std::to_string(nextWidth()), "-o",
                        temporary.path + "/tower.ply"},
                       temporary.path);
        if (outcome.status != 0) bench.fail("export ended with status " + std::to_string(outcome.status));
        return outcome.milliseconds;
    });
    print({.title = "A parameter of the tower through fieldwright serve (128 cells; 640x360)",
           .header = {"set and", "in process", "over a pipe", "wanted at most"},
           .rows = {{"mesh, in process", text(meshOwn), "", judged(meshOwn.median(), kMostInProcessMs)},
                    {"mesh, " + number(double(meshBytes) / 1e6) + " MB", "", text(meshWire),
                     judged(meshWire.median(), kMostMeshMs)},
                    {"the live view's picture", text(liveOwn), text(liveWire),
                     judged(liveWire.median(), kMostPictureMs)},
                    {"a still picture of one sample", text(stillOwn), text(stillWire),
                     judged(stillWire.median(), kMostPictureMs)},
                    {"the live view's, as PNG", "", text(pngWire), ""},
                    {"baseline: the mesh's bytes alone", "", text(pipe), ""},
                    {"baseline: fieldwright export, a process each", text(command), "", ""}},
           .notes = {"Both requests are sent at once; the time ends with the last byte of the answer. In "
                     "process the "
                     "same calls of Player are made, in this program."}},
          bench.options.markdown);
}

}  // namespace fw::bench
