// Devices that fail as real ones do, in this process and in those that it starts: by a Vulkan layer
// (faulty_layer/).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace fw::test {

struct Fault {
    /// Submissions, from 1 on and of all devices that are counted, at which the device is lost; a negative
    /// one is lost when it is awaited.
    std::vector<long> lose = {};
    /// A file: while there is one, the next submission loses the device; it holds how many are lost, and goes
    /// with the last.
    std::string loseWhenThere = {};
    std::optional<bool> presenting = {};  ///< whether devices that present are counted, or the others; all
    std::optional<uint64_t> memory = {};  ///< bytes that all devices together may allocate
    std::optional<uint64_t> mapped = {};  ///< bytes of the largest allocation that can be mapped
};

/// As long as it lives, devices that are made fail so.
class Faults {
  public:
    explicit Faults(const Fault& fault);
    Faults(const Faults&) = delete;
    ~Faults();

    /// "NAME=value" entries, for a process that is to have them.
    static std::vector<std::string> environment(const Fault& fault);
};

}  // namespace fw::test
