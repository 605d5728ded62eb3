// Files of 32-bit words in the user's cache folder: compiled shaders and the driver's pipeline cache.
//
// A cache may vanish, be half written by another process, or be unwritable; none of that is an error. Each
// file holds a header with its key, length and checksum, is written beside its place and renamed into it, and
// is ignored (and then replaced) if anything about it is wrong.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace fw {

/// FNV-1a over bytes; `seed` chains calls.
uint64_t hashBytes(const void* data, std::size_t size, uint64_t seed = 0xcbf29ce484222325ull);

/// Path of a file of the cache, "" without a cache folder. `kind` is a subfolder, `name` a file name.
std::string cachePath(const std::string& kind, const std::string& name);

/// The words of the file, empty if it is missing, damaged or of another key.
std::vector<uint32_t> readCacheFile(const std::string& path, uint64_t key);

/// Writes the file; silent if that fails. Safe against other processes that write the same file.
void writeCacheFile(const std::string& path, uint64_t key, const std::vector<uint32_t>& words);

}  // namespace fw
