// Formats a long list in blocks on all processors while the blocks go into the file in order. Internal to
// runtime/export.
//
// Each thread formats a block into its own buffer, waits until the blocks before it are written, and writes
// it: the formatting of one overlaps the writing of another, and memory is one buffer a thread.
#pragma once

#include <cstddef>
#include <functional>

#include "runtime/system/output_file.h"

namespace fw {

/// Puts the bytes of items first..last at `out` and returns their end. Called from several threads at once.
using FormatBlock = std::function<char*(char* out, std::size_t first, std::size_t last)>;

/// Writes items 0..count; one item takes at most `itemBytes`. Ends early once `file` has failed.
void writeBlocks(std::size_t count, std::size_t itemBytes, const FormatBlock& format, OutputFile& file);

}  // namespace fw
