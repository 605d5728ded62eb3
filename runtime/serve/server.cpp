#include "runtime/serve/server.h"

#include <fcntl.h>
#include <malloc.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <list>
#include <memory>
#include <thread>

#include "graph/base/fence.h"
#include "runtime/serve/assistant.h"
#include "runtime/serve/client.h"
#include "runtime/system/cache_file.h"

namespace fw::serve {

namespace {

Error systemProblem(const std::string& what, const std::string& path) {
    return {.message = what + ": " + std::strerror(errno), .file = path};
}

/// Closed at its end.
struct Descriptor {
    explicit Descriptor(int number_) : number(number_) {}
    Descriptor(const Descriptor&) = delete;
    ~Descriptor() {
        if (number >= 0) ::close(number);
    }
    const int number;
};

/// Standard output for messages alone: what else is printed there goes to standard error.
int ownOutput() {
    const int out = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3);
    ::dup2(STDERR_FILENO, STDOUT_FILENO);
    return out;
}

/// A mesh's arrays go and come with each answer: memory that is kept for the next spares the system's giving
/// it anew, page by page, which takes a tenth of the answer.
void keepSomeMemory() {
    ::mallopt(M_MMAP_THRESHOLD, 16 << 20);
    ::mallopt(M_TRIM_THRESHOLD, 32 << 20);
}

/// A file that is removed at its end.
struct SocketFile {
    ~SocketFile() {
        if (!path.empty()) ::unlink(path.c_str());
    }
    std::string path = {};
};

/// A socket that waits for clients at `path`. One that nobody listens at any more is replaced.
Result<int> listenAt(const std::string& path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    if (path.size() >= sizeof address.sun_path)
        return Error{.message = "is too long for a socket's path: at most " +
                                std::to_string(sizeof address.sun_path - 1) + " bytes",
                     .file = path};
    std::copy(path.begin(), path.end(), address.sun_path);
    const auto* at = reinterpret_cast<const sockaddr*>(&address);
    const int listener = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (listener < 0) return systemProblem("no socket can be made", path);
    const mode_t before = ::umask(0177);  // for its owner alone
    int bound = ::bind(listener, at, sizeof address);
    Error problem{.file = path};
    if (bound != 0 && errno == EADDRINUSE) {
        struct stat status {};
        const Descriptor other(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
        if (::lstat(path.c_str(), &status) != 0 || !S_ISSOCK(status.st_mode)) {
            problem.message = "a file is there that is no socket: choose another path";
        } else if (::connect(other.number, at, sizeof address) == 0) {
            problem.message = "another server listens there: choose another path, or end that one";
        } else if (errno == ECONNREFUSED) {
            ::unlink(path.c_str());
            bound = ::bind(listener, at, sizeof address);
        }
    }
    ::umask(before);
    if (bound == 0 && ::listen(listener, int(kMostClients)) == 0) return listener;
    if (problem.message.empty()) problem = systemProblem("no socket can be made there", path);
    ::close(listener);
    return problem;
}

/// One client of a socket, on a thread of its own.
struct Connection {
    Connection(int descriptor, const OpenDevice& openDevice, const std::function<void()>& shutDown)
        : socket(descriptor), wire(descriptor, descriptor), thread([this, openDevice, shutDown] {
              Client(wire, openDevice, shutDown).serve();
              ::shutdown(socket.number, SHUT_RDWR);
              ended = true;
          }) {}
    ~Connection() { thread.join(); }

    void end() {
        wire.endReading();
        ::shutdown(socket.number, SHUT_RDWR);  // whoever waits to send does no longer
    }

    Descriptor socket;
    Wire wire;
    std::atomic<bool> ended = false;
    std::thread thread;  // last: it uses the others
};

Done serveSocket(const std::string& path, const OpenDevice& openDevice) {
    const Result<int> made = listenAt(path);
    if (!made) return made.error();
    const Descriptor listener(*made);
    const SocketFile file{path};
    int stop[2];
    if (::pipe2(stop, O_CLOEXEC) != 0) return systemProblem("no pipe can be made", path);
    const Descriptor stopRead(stop[0]), stopWrite(stop[1]);
    const auto shutDown = [&stopWrite] {
        while (::write(stopWrite.number, "", 1) < 0 && errno == EINTR) {}
    };
    std::list<Connection> connections;
    for (;;) {
        pollfd ready[2] = {{listener.number, POLLIN, 0}, {stopRead.number, POLLIN, 0}};
        if (::poll(ready, 2, -1) < 0 && errno != EINTR) return systemProblem("the socket failed", path);
        if (ready[1].revents != 0) break;
        connections.remove_if([](const Connection& connection) { return connection.ended.load(); });
        if (ready[0].revents == 0) continue;
        const int client = ::accept4(listener.number, nullptr, nullptr, SOCK_CLOEXEC);
        if (client < 0) continue;
        if (connections.size() < kMostClients) {
            connections.emplace_back(client, openDevice, shutDown);
            continue;
        }
        const Descriptor refused(client);
        Wire(client, client)
            .send(answerLine(nullptr, Fault(kTooMuch, "at most " + std::to_string(kMostClients) +
                                                          " clients are served at once: try again later")));
    }
    for (Connection& connection : connections) connection.end();
    return done();
}

}  // namespace

std::string limitsInWords() {
    return "A message has at most " + std::to_string(kMostMessageBytes >> 20) + " MiB, its blobs " +
           std::to_string(kMostBlobBytes >> 20) + " MiB, an answer's " +
           std::to_string(kMostReplyBytes >> 20) + " MiB; a client has at most " +
           std::to_string(kMostDocuments) + " documents open and " + std::to_string(kMostWaiting) +
           " requests waiting, and a socket " + std::to_string(kMostClients) +
           " clients; a mesh has at most " + std::to_string(kMostServedResolution) +
           " cells along its longest side.";
}

Done serve(const ServeOptions& options) {
    keepSomeMemory();
    // Before the folder is another.
    const std::string socket =
        options.socket.empty() ? std::string() : std::filesystem::absolute(options.socket).string();
    if (const Done fenced = fenceFiles(options.roots, cacheFolder()); !fenced) return fenced.error();
    if (::chdir(options.roots.front().c_str()) != 0)
        return systemProblem("cannot be entered", options.roots.front());
    std::signal(SIGPIPE, SIG_IGN);  // a client that is gone is seen where it is written to
    const OpenDevice openDevice = [pick = options.device] { return createDevice({.pick = pick}); };
    if (!socket.empty()) return serveSocket(socket, openDevice);
    const Descriptor out(ownOutput());
    Wire wire(STDIN_FILENO, out.number);
    if (options.assistant)
        Assistant(wire, openDevice).serve();
    else
        Client(wire, openDevice, [] {}).serve();
    return done();
}

}  // namespace fw::serve
