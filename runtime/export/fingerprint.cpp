#include "runtime/export/fingerprint.h"

#include <cstdio>

namespace fw {
namespace {

/// The finish of splitmix64 (Steele, Lea and Flood 2014).
uint64_t mixed(uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

}  // namespace

void Fingerprint::add(const void* data, std::size_t size) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < size; ++i) {
        first = (first ^ bytes[i]) * 0x100000001b3u;
        second = (second + bytes[i]) * 0xd6e8feb86659fd93u;
    }
}

std::string Fingerprint::uuid(unsigned part) const {
    const uint64_t a = mixed(first + part), b = mixed(second + part);
    char text[37];
    std::snprintf(text, sizeof text, "%08x-%04x-8%03x-%04x-%012llx", static_cast<unsigned>(a >> 32),
                  static_cast<unsigned>(a >> 16 & 0xffff), static_cast<unsigned>(a & 0xfff),
                  static_cast<unsigned>(0x8000 | (b >> 48 & 0x3fff)),
                  static_cast<unsigned long long>(b & 0xffffffffffffu));
    return text;
}

}  // namespace fw
