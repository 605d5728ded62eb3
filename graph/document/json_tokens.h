// JSON text as a flat list of values, each with its place in the text.
//
// nlohmann's parser keeps no positions, so its SAX events are followed through the text by a cursor: between
// two events only white space, ':' and ',' can stand, hence the next token starts at the first other
// character. The list costs 40 bytes a value, whatever its kind, which bounds the memory that a hostile file
// can claim.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "graph/base/result.h"
#include "graph/document/graph.h"

namespace fw {

/// One value, or one key of an object. The children of an array or object follow it in the list: a key is
/// followed by its value, and `next` leads past the whole value.
struct JsonToken {
    enum class Kind : uint8_t { null, boolean, number, string, array, object, key };
    Kind kind;
    uint32_t next = 0;      ///< index after this value and all its children; of a key: after its value
    std::string_view text;  ///< of strings and keys the content, of numbers and booleans the text itself
    TextPosition at;
};

struct JsonTokens {
    std::vector<JsonToken> list;  ///< the root value is list[0]
    std::deque<std::string>
        unescaped;  ///< contents of strings with escapes, which `text` cannot take from the file
};

/// What a text is, as its errors call it, and how many bytes it may have.
struct JsonText {
    std::string what = "file";
    std::size_t most = kMaxFileBytes;
};

/// Offset of the first byte that is no part of well-formed UTF-8, or is NUL; npos if there is none.
std::size_t firstBadByte(std::string_view text);

/// The values in `text`, which must outlive the result. Errors: what is not JSON or not UTF-8, a key that
/// stands twice in an object, a number beyond double, nesting or a number of values beyond the limits of
/// graph.h. `path` is the file they name.
Result<JsonTokens> tokenize(std::string_view text, const std::string& path, const JsonText& as = {});

/// The value of a number token; -0 keeps its sign.
double numberOf(const JsonToken& token);

/// The value at `index` as JSON that can be kept and written again.
Json toJson(const JsonTokens& tokens, uint32_t index);

}  // namespace fw
