// Words of messages: names that were nearly right, lists, numbers.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fw {

/// The entry of `names` nearest to `name` by edit distance; empty if none is near.
std::string nearestName(std::string_view name, std::span<const std::string> names);

/// With small letters for the capitals of ASCII.
std::string lowered(std::string_view text);

/// A number for reading, six digits.
std::string shortNumber(double value);
/// The shortest text that is read as the very same one.
std::string exactNumber(double value);

/// What to write instead of a number with a unit ("3.2mm", "90deg"), behind ": "; empty if it is none.
std::string unitHint(std::string_view text);

/// "a, b, c", cut after 40.
std::string listed(const std::vector<std::string>& names);

/// "a -> b -> c -> a"; a long one is shortened in the middle.
std::string arrows(const std::vector<std::string_view>& names);

}  // namespace fw
