// UUIDs that depend on nothing but a file's content, so that the same mesh gives the same bytes on every run.
// Internal to runtime/export.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace fw {

/// Two hashes of 64 bits over the same bytes: FNV-1a, and a sum times an odd number.
struct Fingerprint {
    uint64_t first = 0xcbf29ce484222325u, second = 0x9e3779b97f4a7c15u;

    void add(const void* data, std::size_t size);
    template <class T>
    void add(std::span<const T> values) {
        add(values.data(), values.size_bytes());
    }
    /// RFC 9562, version 8; another for each `part` of the same content.
    std::string uuid(unsigned part = 0) const;
};

}  // namespace fw
