// Texel buffers as storage buffers, for devices whose texel buffers are small.
//
// Kernels read buffers of four-word texels as texel buffers, which software devices load twice as fast. Some
// drivers show no more than 65,536 texels of one, a mebibyte; there the same text declares a storage buffer
// at the same binding.
#pragma once

#include <string>

namespace fw {

/// The complete text of a shader with every `uniform uimageBuffer` declared as a storage buffer of uvec4, and
/// each imageLoad() and imageStore() of it as an access of that. Throws SystemError where a declaration is
/// not of the form `layout(binding = N, rgba32ui) QUALIFIERS uniform uimageBuffer NAME;`.
std::string withTexelsInStorage(std::string text);

}  // namespace fw
