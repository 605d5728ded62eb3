#include "tests/support/served.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <fstream>
#include <thread>
#include <utility>

#include "tests/support/graph/temp_dir.h"

namespace fw::test {

namespace {

constexpr int kMostWaitSeconds = 120;

std::pair<int, int> makePipe() {
    int ends[2] = {-1, -1};
    if (::pipe2(ends, O_CLOEXEC) != 0) ADD_FAILURE() << "no pipe";
    return {ends[0], ends[1]};
}

}  // namespace

ServerClient::ServerClient(ServerClient&& other) noexcept
    : progress(std::move(other.progress)),
      in(std::exchange(other.in, -1)),
      out(std::exchange(other.out, -1)),
      last(other.last),
      buffer(std::move(other.buffer)),
      ended(other.ended),
      kept(std::move(other.kept)) {}

ServerClient& ServerClient::operator=(ServerClient&& other) noexcept {
    std::swap(in, other.in), std::swap(out, other.out), std::swap(last, other.last);
    std::swap(buffer, other.buffer), std::swap(ended, other.ended);
    kept.swap(other.kept), progress.swap(other.progress);
    return *this;
}

void ServerClient::endSending() {
    if (out >= 0 && out != in) ::close(out);
    if (out >= 0 && out == in) ::shutdown(in, SHUT_WR);
    out = -1;
}

void ServerClient::hangUp() {
    if (out >= 0 && out != in) ::close(out);
    if (in >= 0) ::close(in);
    in = out = -1;
}

void ServerClient::sendBytes(const std::string& bytes) {
    // Blocked here alone: what is ignored would be ignored by programs that are started later, too.
    sigset_t pipe, before;
    sigemptyset(&pipe);
    sigaddset(&pipe, SIGPIPE);
    pthread_sigmask(SIG_BLOCK, &pipe, &before);
    for (std::size_t at = 0; at < bytes.size();) {
        const ssize_t put = ::write(out, bytes.data() + at, bytes.size() - at);
        if (put < 0 && errno == EINTR) continue;
        if (put <= 0) break;
        at += std::size_t(put);
    }
    const timespec none{};
    while (sigtimedwait(&pipe, nullptr, &none) > 0) continue;
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

void ServerClient::sendLine(const std::string& text) { sendBytes(text + "\n"); }

int ServerClient::send(const std::string& method, ServedJson params,
                       const std::map<std::string, std::pair<std::string, std::string>>& blobs) {
    if (params.is_null()) params = ServedJson::object();
    for (const auto& [name, blob] : blobs)
        params["blobs"].push_back({{"name", name}, {"type", blob.first}, {"bytes", blob.second.size()}});
    sendLine(ServedJson{{"jsonrpc", "2.0"}, {"id", ++last}, {"method", method}, {"params", params}}.dump());
    for (const auto& [name, blob] : blobs) sendBytes(blob.second);
    return last;
}

bool ServerClient::fill() {
    pollfd ready{in, POLLIN, 0};
    const int there = ::poll(&ready, 1, kMostWaitSeconds * 1000);
    if (there == 0) ADD_FAILURE() << "the server says nothing";
    std::string piece(1 << 20, '\0');
    const ssize_t got = there > 0 ? ::read(in, piece.data(), piece.size()) : 0;
    if (got <= 0) return ended = true, false;
    buffer.append(piece, 0, std::size_t(got));
    return true;
}

std::string ServerClient::line() {
    std::size_t end = std::string::npos;
    while ((end = buffer.find('\n')) == std::string::npos)
        if (!fill()) return {};
    std::string text = buffer.substr(0, end);
    buffer.erase(0, end + 1);
    return text;
}

std::string ServerClient::bytes(std::size_t size) {
    while (buffer.size() < size)
        if (!fill()) return {};
    std::string taken = buffer.substr(0, size);
    buffer.erase(0, size);
    return taken;
}

ServerMessage ServerClient::next() {
    ServerMessage message;
    const std::string text = line();
    if (ended && text.empty()) return message;
    message.json = ServedJson::parse(text, nullptr, false);
    if (!message.json.is_object()) {
        ADD_FAILURE() << "no message: " << text.substr(0, 500);
        return {};
    }
    if (message.json.contains("result") && message.json["result"].contains("blobs"))
        for (const auto& blob : message.json["result"]["blobs"])
            message.blobs[blob["name"].get<std::string>()] = bytes(blob["bytes"].get<std::size_t>());
    return message;
}

ServerMessage ServerClient::answer(int id) {
    const auto is = [id](const ServerMessage& message) {
        return message.json.value("id", ServedJson()) == id;
    };
    const auto found = std::ranges::find_if(kept, is);
    if (found != kept.end()) {
        ServerMessage message = std::move(*found);
        kept.erase(found);
        return message;
    }
    for (;;) {
        ServerMessage message = next();
        if (message.json.is_null()) {
            ADD_FAILURE() << "the server is gone, and request " << id << " has no answer";
            message.json = {{"error", {{"code", 0}, {"message", "gone"}}}};
            return message;
        }
        if (!message.isAnswer())
            progress.push_back(std::move(message));
        else if (is(message))
            return message;
        else
            kept.push_back(std::move(message));
    }
}

int ServerClient::open(const std::string& path) {
    const ServerMessage message = ask("open", {{"path", path}});
    EXPECT_FALSE(message.failed()) << message.json.dump();
    return message.failed() ? 0 : message.result().at("document").get<int>();
}

int ServerClient::openText(const std::string& text) {
    const ServerMessage message = ask("open", {{"graph", text}});
    EXPECT_FALSE(message.failed()) << message.json.dump();
    return message.failed() ? 0 : message.result().at("document").get<int>();
}

ServerProcess::ServerProcess(std::vector<std::string> arguments, const std::string& folder,
                             std::vector<std::string> environment)
    : client(-1, -1) {
    static const TempDir caches;
    static int number = 0;
    errorFile = caches.path("errors" + std::to_string(++number));
    writeText(errorFile, "");
    const auto [serverIn, toServer] = makePipe();
    const auto [fromServer, serverOut] = makePipe();
    std::vector<std::string> words = {FIELDWRIGHT_BINARY_DIR "/fieldwright", "serve"};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    const std::string cache = caches.folder.string();
    pid = ::fork();
    if (pid == 0) {
        const int err = ::open(errorFile.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        if (::chdir(folder.c_str()) != 0 || ::dup2(serverIn, 0) < 0 || ::dup2(serverOut, 1) < 0 ||
            ::dup2(err, 2) < 0)
            ::_exit(125);
        ::setenv("XDG_CACHE_HOME", cache.c_str(), 1);
        for (std::string& entry : environment) ::putenv(entry.data());
        ::execv(argv[0], argv.data());
        ::_exit(126);
    }
    ::close(serverIn), ::close(serverOut);
    client = ServerClient(fromServer, toServer);
}

ServerProcess::~ServerProcess() {
    client.hangUp();
    if (pid > 0) ::kill(pid, SIGKILL), wait();
    EXPECT_EQ(errors().find("validation layer:"), std::string::npos) << errors().substr(0, 2000);
}

ServerClient ServerProcess::connect(const std::string& path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::copy_n(path.begin(), std::min(path.size(), sizeof address.sun_path - 1), address.sun_path);
    const int socket = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    for (int i = 0; i < kMostWaitSeconds * 100; ++i) {
        if (::connect(socket, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0)
            return ServerClient(socket, socket);
        std::this_thread::sleep_for(std::chrono::milliseconds(10));  // until it listens
    }
    ADD_FAILURE() << "nobody listens at " << path;
    return ServerClient(socket, socket);
}

int ServerProcess::wait() {
    int status = 0;
    bool ended = pid <= 0;
    for (int i = 0; !ended && i < kMostWaitSeconds * 100; ++i) {
        ended = ::waitpid(pid, &status, WNOHANG) != 0;
        if (!ended) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    if (!ended) {
        ADD_FAILURE() << "the server does not end";
        ::kill(pid, SIGKILL), ::waitpid(pid, &status, 0);
    }
    pid = -1;
    return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

double ServerProcess::megabytes() const {
    std::ifstream file("/proc/" + std::to_string(pid) + "/statm");
    long total = 0, resident = 0;
    file >> total >> resident;
    return double(resident * ::sysconf(_SC_PAGESIZE)) / 1e6;
}

std::string ServerProcess::errors() const { return readText(errorFile); }

}  // namespace fw::test
