// JSON that a document keeps as it was written (`scene`, `timeline`), read with the place of every value, so
// that a finding about it names line and column like any other.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>

#include "graph/document/graph.h"

namespace fw {

/// A value and where it stood. Refers to the JSON and the places, which must outlive it.
class PlacedJson {
  public:
    PlacedJson(const Json& json_, const TextPlaces& places_, std::size_t index_ = 0)
        : json(json_), places(places_), index(index_) {}

    const Json& value() const { return json; }
    TextPosition at() const { return index < places.list.size() ? places.list[index] : TextPosition{}; }

    /// Calls use(key, value) for each member of an object until one returns false; whether none did.
    template <class Use>
    bool forMembers(Use use) const {
        std::size_t at = index + 1;
        for (const auto& [key, member] : json.items()) {
            if (!use(key, PlacedJson(member, places, at))) return false;
            at += sizeOf(member);
        }
        return true;
    }

    /// The same for use(entry) and the entries of an array.
    template <class Use>
    bool forEntries(Use use) const {
        return forMembers([&](const std::string&, const PlacedJson& entry) { return use(entry); });
    }

  private:
    /// Number of values in `json`, itself included.
    static std::size_t sizeOf(const Json& json) {
        std::size_t size = 1;
        if (json.is_structured())
            for (const Json& entry : json) size += sizeOf(entry);
        return size;
    }

    const Json& json;
    const TextPlaces& places;
    std::size_t index;
};

}  // namespace fw
