// Reading numbers and words out of the bytes of a mesh file, without a copy.
#pragma once

#include <algorithm>
#include <charconv>
#include <cstring>
#include <optional>
#include <string_view>

namespace fw {

/// A place in the bytes of a file that only moves on.
struct Scanner {
    std::string_view rest;

    bool atEnd() const { return rest.empty(); }

    /// The line up to the next end of a line (LF, CR LF or CR alone), which is passed.
    std::string_view line() {
        const std::size_t end = rest.find_first_of("\r\n");
        const std::string_view found = rest.substr(0, end);
        rest.remove_prefix(end == rest.npos ? rest.size() : end + 1);
        if (end != rest.npos && !rest.empty() && rest[0] == '\n' && found.data()[end] == '\r')
            rest.remove_prefix(1);
        return found;
    }

    /// The next run of anything but blanks; empty at the end.
    std::string_view word() {
        constexpr std::string_view kBlanks = " \t\r\n\v\f";
        rest.remove_prefix(std::min(rest.find_first_not_of(kBlanks), rest.size()));
        const std::string_view found = rest.substr(0, rest.find_first_of(kBlanks));
        rest.remove_prefix(found.size());
        return found;
    }

    /// The next word as a number; none if it is not one as a whole.
    template <class T>
    std::optional<T> number() {
        return numberIn<T>(word());
    }

    template <class T>
    static std::optional<T> numberIn(std::string_view word) {
        if (word.starts_with('+')) word.remove_prefix(1);
        T value{};
        const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (end != word.data() + word.size() || word.empty()) return std::nullopt;
        // Too small for the type is nothing; too large is no number.
        if (problem == std::errc::result_out_of_range && word.find_first_of("eE") != word.npos &&
            word[word.find_first_of("eE") + 1] == '-')
            return T{};
        return problem == std::errc() ? std::optional(value) : std::nullopt;
    }

    /// The next bytes as they lie; none if there are too few.
    template <class T>
    std::optional<T> raw() {
        if (rest.size() < sizeof(T)) return std::nullopt;
        T value;
        std::memcpy(&value, rest.data(), sizeof value);
        rest.remove_prefix(sizeof value);
        return value;
    }
};

}  // namespace fw
