// Khronos' validator of glTF, which the first test that needs it fetches from npm.
#pragma once

#include <string>
#include <vector>

namespace fw::test {

/// Expects Khronos' validator to find nothing at all in the files, not even a hint; of an extension that it
/// does not know, only that, and that it does not see what the accessors are for.
void expectValidGltf(const std::vector<std::string>& files, bool knownAlone = true);

}  // namespace fw::test
