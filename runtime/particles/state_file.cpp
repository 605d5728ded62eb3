#include "runtime/particles/state_file.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "graph/base/fence.h"
#include "graph/base/hash.h"
#include "runtime/system/output_file.h"

namespace fw {

namespace fs = std::filesystem;

namespace {

static_assert(std::endian::native == std::endian::little, "states are written as they lie in memory");

struct StateHeader {
    uint64_t magic = 0x3145544154535746;  // "FWSTATE1"
    uint64_t key = 0;
    uint32_t step = 0, slots = 0;
    double born = 0.0;
    double drift[3] = {0.0, 0.0, 0.0};
    uint64_t bytes = 0, checksum = 0;
};

/// Of whole words: states have no others.
uint64_t checksumOf(const std::vector<char>& bytes) {
    uint64_t sum = 0;
    for (std::size_t at = 0; at + 4 <= bytes.size(); at += 4) {
        uint32_t word = 0;
        std::memcpy(&word, &bytes[at], 4);
        sum = mixed(sum, word);
    }
    return sum;
}

/// The header of an ordinary file that is as long as it says.
bool openState(const CachedStates& of, int step, std::ifstream& file, StateHeader& header) {
    const std::string path = statePath(of, step);
    std::error_code failure;
    if (!checkMayRead(path) || !fs::is_regular_file(path, failure)) return false;
    file.open(path, std::ios::binary);
    if (!file.read(reinterpret_cast<char*>(&header), sizeof header)) return false;
    return header.magic == StateHeader{}.magic && header.key == of.key && int64_t(header.step) == step &&
           fs::file_size(path, failure) == sizeof header + header.bytes && !failure;
}

}  // namespace

std::string statePath(const CachedStates& of, int step) {
    const std::string number = std::to_string(step);
    return (fs::path(of.folder) /
            (std::string(6 - std::min<std::size_t>(number.size(), 6), '0') + number + ".state"))
        .string();
}

bool stateIsThere(const CachedStates& of, int step) {
    std::ifstream file;
    StateHeader header;
    return openState(of, step, file, header);
}

std::vector<int> statesUpTo(const CachedStates& of, int step) {
    std::vector<int> steps;
    std::error_code failure;
    fs::directory_iterator each(of.folder, failure);
    for (; !failure && each != fs::directory_iterator(); each.increment(failure)) {
        const std::string name = each->path().filename().string();
        int number = -1;
        std::from_chars(name.data(), name.data() + name.size(), number);
        if (number >= 0 && number <= step && each->path() == statePath(of, number)) steps.push_back(number);
    }
    std::ranges::sort(steps, std::greater());
    return steps;
}

Result<ParticleState> readState(const CachedStates& of, int step) {
    const auto wrong = [&](const std::string& what) {
        return Error{.message = "the state of particles " + inQuotes(statePath(of, step)) + " " + what +
                                ": remove it, and simulate again"};
    };
    std::ifstream file;
    StateHeader header;
    if (!openState(of, step, file, header)) return wrong("cannot be read");
    ParticleState state{.step = header.step, .slots = header.slots, .born = header.born};
    std::ranges::copy(header.drift, state.drift);
    state.bytes.resize(header.bytes);
    if (!file.read(state.bytes.data(), std::streamsize(state.bytes.size()))) return wrong("cannot be read");
    if (checksumOf(state.bytes) != header.checksum) return wrong("was damaged");
    return state;
}

Done writeState(const CachedStates& of, const ParticleState& state) {
    Result<OutputFile> file = OutputFile::open(statePath(of, int(state.step)), nullptr);
    if (!file) return file.error();
    StateHeader header{.key = of.key,
                       .step = state.step,
                       .slots = state.slots,
                       .born = state.born,
                       .bytes = state.bytes.size(),
                       .checksum = checksumOf(state.bytes)};
    std::ranges::copy(state.drift, header.drift);
    file->write(&header, sizeof header);
    file->write(state.bytes.data(), state.bytes.size());
    return file->commit();
}

}  // namespace fw
