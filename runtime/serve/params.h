// The parameters of a request, read by name: what is missing, of another kind, out of range or unknown
// becomes one Fault that says so. Each read gives something to go on with, so that a method reads all and
// looks once.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/serve/message.h"

namespace fw::serve {

/// ": did you mean 'x'?", of the nearest of those names, or `otherwise` if none is near.
std::string meant(std::string_view name, std::span<const std::string> names,
                  const std::string& otherwise = "");

class Params {
  public:
    /// `object` and what `method` refers to must outlive it.
    Params(const Json& object_, std::string method_) : object(object_), method(std::move(method_)) {}

    double number(const char* name, double otherwise, double least, double greatest);
    int whole(const char* name, int otherwise, int least, int greatest);
    bool flag(const char* name, bool otherwise);
    std::string text(const char* name, std::string otherwise);
    std::string oneOf(const char* name, std::span<const std::string> words, std::string otherwise);
    /// Of any kind; nullptr if it is not there.
    const Json* any(const char* name);
    bool has(const char* name) const { return object.contains(name); }
    /// Makes it a fault that this one is not there.
    void need(const char* name);
    /// A fault of this parameter.
    void refuse(const char* name, const std::string& why);

    /// A parameter that was not read, whose name may be why another is missing; else the first thing that was
    /// wrong.
    std::optional<Fault> fault();

  private:
    const Json& object;
    std::string method;
    std::vector<std::string> known = {"_meta"};
    std::optional<Fault> first;
};

}  // namespace fw::serve
