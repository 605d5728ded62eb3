// A real `fieldwright serve` as a child process, and a client of it.
#pragma once

#include <sys/types.h>

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace fw::test {

using ServedJson = nlohmann::ordered_json;

/// What the server says: an answer or a notification, and the blobs behind it, by name.
struct ServerMessage {
    ServedJson json;
    std::map<std::string, std::string> blobs;
    bool isAnswer() const { return json.contains("id"); }
    bool failed() const { return json.contains("error"); }
    const ServedJson& result() const { return json.at("result"); }
    int code() const { return json.at("error").at("code").get<int>(); }
    std::string message() const { return json.at("error").at("message").get<std::string>(); }
};

/// One end of a connection. Reading waits for at most a minute, then the test fails.
class ServerClient {
  public:
    ServerClient(int in_, int out_) : in(in_), out(out_) {}
    ServerClient(ServerClient&& other) noexcept;
    ServerClient& operator=(ServerClient&& other) noexcept;
    ~ServerClient() { hangUp(); }

    /// Sends a request, returns its id.
    int send(const std::string& method, ServedJson params = ServedJson::object(),
             const std::map<std::string, std::pair<std::string, std::string>>& blobs = {});
    void sendLine(const std::string& text);
    void sendBytes(const std::string& bytes);
    /// The next message, whatever it is; an empty one at the end.
    ServerMessage next();
    /// The answer to that request. Notifications before it go to `progress`, answers to others are kept.
    ServerMessage answer(int id);
    ServerMessage ask(const std::string& method, ServedJson params = ServedJson::object(),
                      const std::map<std::string, std::pair<std::string, std::string>>& blobs = {}) {
        return answer(send(method, std::move(params), blobs));
    }
    /// The document of a graph file, or of a graph as text.
    int open(const std::string& path);
    int openText(const std::string& text);
    /// Closes both ends.
    void hangUp();
    /// Closes the one that the server reads.
    void endSending();

    std::vector<ServerMessage> progress;

  private:
    bool fill();
    std::string line();
    std::string bytes(std::size_t size);

    int in, out;
    int last = 0;
    std::string buffer;
    bool ended = false;
    std::vector<ServerMessage> kept;
};

class ServerProcess {
  public:
    /// `fieldwright serve` with these arguments, in this folder, and NAME=VALUE beside what is in the
    /// environment.
    explicit ServerProcess(std::vector<std::string> arguments, const std::string& folder = ".",
                           std::vector<std::string> environment = {});
    ServerProcess(const ServerProcess&) = delete;
    ~ServerProcess();

    /// Of its standard input and output.
    ServerClient client;
    /// Another one, of its socket, once it listens.
    static ServerClient connect(const std::string& path);
    /// Its exit status, once it has ended; 128 + signal if it was killed, as it is if it does not end.
    int wait();
    /// Resident memory, megabytes.
    double megabytes() const;
    std::string errors() const;
    pid_t pid = -1;

  private:
    std::string errorFile;
};

}  // namespace fw::test
