#include "graph/document/kept_json.h"

#include <nlohmann/json.hpp>
#include <utility>

namespace fw {

KeptJson::KeptJson(std::nullptr_t) noexcept {}
KeptJson::KeptJson(Json json) : own(json.is_null() ? nullptr : std::make_unique<Json>(std::move(json))) {}
KeptJson::KeptJson(const KeptJson& other) : own(other.own ? std::make_unique<Json>(*other.own) : nullptr) {}
KeptJson::KeptJson(KeptJson&& other) noexcept = default;
KeptJson& KeptJson::operator=(KeptJson other) noexcept {
    own = std::move(other.own);
    return *this;
}
KeptJson::~KeptJson() = default;

const Json& KeptJson::operator*() const {
    static const Json null;
    return own ? *own : null;
}
Json& KeptJson::operator*() {
    if (!own) own = std::make_unique<Json>();
    return *own;
}
bool KeptJson::operator==(const KeptJson& other) const { return **this == *other; }

}  // namespace fw
