// Messages of the server: JSON-RPC 2.0, one on a line, and blobs of raw bytes behind it.
//
//     {"jsonrpc": "2.0", "id": 1, "method": "mesh", "params": {"document": 1, "resolution": 128}}
//     {"jsonrpc": "2.0", "id": 1, "result": {"vertices": 72182, …, "blobs": [{"name": "positions", "type":
//     "f32",
//      "shape": [72182, 3], "bytes": 866184}, …]}}
//     … 866184 bytes, and those of the others
//
// docs/server.md is the page for those who write a client, docs/server.schema.json the same as a JSON schema.
// Numbers in blobs are little-endian, as they lie in memory.
//
// Lifetime: plain values. A Blob refers to bytes that Reply::keeps has.
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "graph/base/result.h"
#include "graph/document/graph.h"

namespace fw::serve {

inline constexpr int kProtocol = 1;  ///< another number if a client must change

// What bounds the memory that a client can claim.
inline constexpr std::size_t kMostMessageBytes = 32u << 20;  ///< of one line: a graph file, written in a text
inline constexpr std::size_t kMostBlobBytes = 256u << 20;    ///< of blobs that wait to be worked on, together
inline constexpr std::size_t kMostReplyBytes = 1u << 30;     ///< of blobs of one reply
inline constexpr std::size_t kMostBlobs = 16;                ///< of one message
inline constexpr std::size_t kMostDocuments = 16;            ///< open at once, of one client
inline constexpr std::size_t kMostWaiting = 256;             ///< requests of one client without an answer
inline constexpr std::size_t kMostClients = 8;               ///< of a socket, at once

/// Codes of errors: those of JSON-RPC, and the server's own.
enum FaultCode : int {
    kNoJson = -32700,     ///< the line is no JSON
    kNoRequest = -32600,  ///< it is no request
    kNoMethod = -32601,   ///< there is no such method
    kWrongParameters = -32602,
    kWrongInput = -32000,   ///< a graph, a file, a value: what `data` says
    kSystemFault = -32001,  ///< device, memory, disk
    kTooMuch = -32002,      ///< beyond one of the limits above
    kCancelled = -32800,
};

/// Why a request was not answered otherwise.
struct Fault {
    int code = kWrongInput;
    Error error = {};
    std::vector<Error> findings = {};  ///< of a graph, all of them; the error is the first

    Fault(Error error_)
        : code(error_.code == Error::Code::cancelled ? kCancelled : kWrongInput), error(std::move(error_)) {}
    Fault(int code_, std::string message) : code(code_), error{.message = std::move(message)} {}
};

/// Bytes behind a message.
struct Blob {
    std::string name, type;               ///< "f32", "f64", "u32", "u8", or "png"
    std::vector<std::size_t> shape = {};  ///< of an array, its slowest index first
    std::string_view bytes = {};
};

template <class T>
std::string_view bytesOf(const std::vector<T>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

struct Reply {
    Json result = Json::object();
    std::vector<Blob> blobs = {};
    std::shared_ptr<const void> keeps = {};  ///< what the blobs refer to
};

using Answer = std::variant<Reply, Fault>;

/// What a request announces of a blob that follows it.
struct ComingBlob {
    std::string name, type;
    Json shape = nullptr;  ///< as it is given
    std::size_t bytes = 0;
};

struct Request {
    Json id = nullptr;      ///< a number or a text
    bool answered = false;  ///< it has an id: else nobody waits for an answer
    std::string method = {};
    Json params = Json::object();
    std::vector<ComingBlob> coming = {};
    std::vector<std::string> blobs = {};  ///< the bytes of those
};

/// A line that is no request; `id` is that of the answer, null where it has none. `coming` bytes follow it
/// nevertheless.
struct NoRequest {
    Json id = nullptr;
    Fault fault;
    std::size_t coming = 0;
};

/// The request in a line, without the bytes of its blobs.
std::variant<Request, NoRequest> readRequest(std::string_view line);

/// The line of an answer, without its end.
std::string answerLine(const Json& id, const Answer& answer);
/// The line of a notification.
std::string notificationLine(const char* method, Json params);

/// {"severity", "message", "remedy", "file", "node", "input", "line", "column", "codeLine", "codeColumn"}:
/// what is known of it. The remedy is the name that may be meant, or what the message says behind its last
/// colon, those within brackets and quotes aside.
Json findingJson(const Error& error);
Json findingsJson(const std::vector<Error>& findings);

/// `text` as one line of JSON, whatever bytes are in it.
std::string inLine(const Json& json);

}  // namespace fw::serve
