// JSON that a document keeps as it was written, as a value that costs its holders nothing to compile.
//
// The JSON library's header takes longer to compile than most of what holds a document, which seldom looks
// into what is kept. Who does includes <nlohmann/json.hpp>.
#pragma once

#include <cstddef>
#include <memory>
#include <nlohmann/json_fwd.hpp>

namespace fw {

/// JSON that keeps the order of keys, so that a saved file differs from the loaded one only where it was
/// edited.
using Json = nlohmann::ordered_json;

/// A Json, by default null. A value like any other: copies are of all that is in it.
class KeptJson {
  public:
    KeptJson(std::nullptr_t = nullptr) noexcept;
    KeptJson(Json json);
    KeptJson(const KeptJson& other);
    KeptJson(KeptJson&& other) noexcept;
    KeptJson& operator=(KeptJson other) noexcept;
    ~KeptJson();

    const Json& operator*() const;
    Json& operator*();
    const Json* operator->() const { return &**this; }
    Json* operator->() { return &**this; }
    operator const Json&() const { return **this; }
    bool operator==(const KeptJson& other) const;

  private:
    std::unique_ptr<Json> own;  // none: null
};

}  // namespace fw
