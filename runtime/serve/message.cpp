#include "runtime/serve/message.h"

#include <algorithm>

#include "graph/document/json_tokens.h"

namespace fw::serve {

namespace {

bool isId(const Json& id) { return id.is_string() || id.is_number(); }

/// The blobs that a message announces in its parameters, and how many bytes follow it in any case; false if
/// they are not as they should be.
bool readComing(const Json& params, std::vector<ComingBlob>& coming, std::size_t& bytes) {
    const auto list = params.find("blobs");
    if (list == params.end()) return true;
    if (!list->is_array()) return false;
    bool sound = list->size() <= kMostBlobs;
    for (const Json& blob : *list) {
        const auto word = [&](const char* key) -> std::string {
            const auto found = blob.is_object() ? blob.find(key) : blob.end();
            return found != blob.end() && found->is_string() ? found->get<std::string>() : std::string();
        };
        const auto size = blob.is_object() ? blob.find("bytes") : blob.end();
        const bool known = size != blob.end() && size->is_number_integer() && *size >= 0;
        // Of a message that cannot be right as many bytes follow as it says, if it says so.
        const std::size_t count = known ? size->get<std::size_t>() : 0;
        sound = sound && known && !word("name").empty();
        bytes = count > SIZE_MAX - bytes ? SIZE_MAX : bytes + count;
        if (sound) coming.push_back({word("name"), word("type"), blob.value("shape", Json()), count});
    }
    return sound;
}

/// Whether each bracket and quote in it is closed.
bool isWhole(std::string_view text) {
    const auto count = [&](char c) { return std::ranges::count(text, c); };
    return count('(') == count(')') && count('[') == count(']') && count('{') == count('}') &&
           count('"') % 2 == 0;
}

/// The name that may be meant, or else what stands behind the last colon that is no part of an example in it.
std::string remedyIn(const std::string& message) {
    if (const std::size_t meant = message.rfind("did you mean "); meant != std::string::npos)
        return message.substr(meant);
    for (std::size_t colon = message.rfind(": "); colon != std::string::npos && colon > 0;
         colon = message.rfind(": ", colon - 1))
        if (isWhole(std::string_view(message).substr(colon + 2))) return message.substr(colon + 2);
    return {};
}

}  // namespace

std::variant<Request, NoRequest> readRequest(std::string_view line) {
    const auto refused = [](Json id, int code, std::string message, std::size_t coming = 0) {
        return NoRequest{std::move(id), Fault(code, std::move(message)), coming};
    };
    const Result<JsonTokens> tokens = tokenize(line, "", {.what = "message", .most = kMostMessageBytes});
    if (!tokens) {
        NoRequest none = refused(nullptr, kNoJson, tokens.error().message);
        none.fault.error.line = tokens.error().line, none.fault.error.column = tokens.error().column;
        return none;
    }
    Json json = toJson(*tokens, 0);
    if (json.is_array())
        return refused(nullptr, kNoRequest,
                       "several requests in one message are not taken: write a line each");
    if (!json.is_object())
        return refused(nullptr, kNoRequest, "a message is an object: {\"jsonrpc\": \"2.0\", …}");
    Request request;
    std::size_t coming = 0;
    if (const auto none = json.find("params"); none != json.end() && none->is_null()) json.erase(none);
    const auto params = json.find("params");
    const bool known = params == json.end() || params->is_object();
    const bool blobs = params == json.end() || !known || readComing(*params, request.coming, coming);
    if (const auto id = json.find("id"); id != json.end()) {
        if (!isId(*id)) return refused(nullptr, kNoRequest, "an id is a number or a text", coming);
        request.id = *id, request.answered = true;
    }
    if (const auto version = json.find("jsonrpc"); version == json.end() || *version != "2.0")
        return refused(request.id, kNoRequest, "a message is of \"jsonrpc\" \"2.0\", and says so", coming);
    const auto method = json.find("method");
    if (method == json.end() || !method->is_string())
        return refused(request.id, kNoRequest, "a request says its \"method\"", coming);
    if (!known) return refused(request.id, kWrongParameters, "\"params\" is an object: {\"document\": 1}");
    if (!blobs)
        return refused(request.id, kWrongParameters,
                       "\"blobs\" lists at most " + std::to_string(kMostBlobs) +
                           " objects with \"name\", \"type\" and \"bytes\"",
                       coming);
    if (coming > kMostBlobBytes)
        return refused(request.id, kTooMuch,
                       "the blobs of a request are " + std::to_string(kMostBlobBytes >> 20) +
                           " MiB together at most: send them in parts",
                       coming);
    request.method = method->get<std::string>();
    if (params != json.end()) request.params = std::move(*params);
    if (request.coming.empty()) request.params.erase("blobs");  // a list of none
    return request;
}

std::string inLine(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

Json findingJson(const Error& error) {
    Json json = Json::object();
    json["severity"] = error.severity == Error::Severity::error ? "error" : "warning";
    json["message"] = error.message;
    const auto text = [&](const char* key, const std::string& value) {
        if (!value.empty()) json[key] = value;
    };
    const auto place = [&](const char* key, int value) {
        if (value > 0) json[key] = value;
    };
    text("remedy", remedyIn(error.message));
    text("file", error.file), text("node", error.node), text("input", error.input);
    place("line", error.line), place("column", error.column);
    place("codeLine", error.codeLine), place("codeColumn", error.codeColumn);
    return json;
}

Json findingsJson(const std::vector<Error>& findings) {
    Json list = Json::array();
    for (const Error& finding : findings) list.push_back(findingJson(finding));
    return list;
}

std::string answerLine(const Json& id, const Answer& answer) {
    Json message = {{"jsonrpc", "2.0"}, {"id", id}};
    if (const Fault* fault = std::get_if<Fault>(&answer)) {
        Json data = findingJson(fault->error);
        data.erase("message");
        if (!fault->findings.empty()) data["findings"] = findingsJson(fault->findings);
        message["error"] = {
            {"code", fault->code}, {"message", fault->error.message}, {"data", std::move(data)}};
        return inLine(message);
    }
    const Reply& reply = std::get<Reply>(answer);
    Json& result = message["result"] = reply.result;
    if (!reply.blobs.empty()) {
        Json& list = result["blobs"] = Json::array();
        for (const Blob& blob : reply.blobs) {
            Json entry = {{"name", blob.name}, {"type", blob.type}};
            if (!blob.shape.empty()) entry["shape"] = blob.shape;
            entry["bytes"] = blob.bytes.size();
            list.push_back(std::move(entry));
        }
    }
    return inLine(message);
}

std::string notificationLine(const char* method, Json params) {
    return inLine({{"jsonrpc", "2.0"}, {"method", method}, {"params", std::move(params)}});
}

}  // namespace fw::serve
