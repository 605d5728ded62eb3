#include "runtime/gpu/texels.h"

#include "graph/base/result.h"

namespace fw {
namespace {

constexpr std::string_view kDeclared = "uniform uimageBuffer ", kFormat = ", rgba32ui)", kLayout = "layout(";

void replaceAll(std::string& text, const std::string& from, const std::string& to) {
    for (std::size_t at = 0; (at = text.find(from, at)) != text.npos; at += to.size())
        text.replace(at, from.size(), to);
}

/// Declares one anew; both functions stand in the same line, so that lines keep their numbers.
std::string storageOf(std::string_view layout, std::string_view qualifiers, const std::string& name) {
    std::string text = std::string(layout) + ", std430)" + std::string(qualifiers) + "buffer " + name +
                       "Storage { uvec4 " + name + "[]; };";
    if (qualifiers.find("writeonly") == qualifiers.npos)
        text += " uvec4 " + name + "Load(int at) { return " + name + "[at]; }";
    if (qualifiers.find("readonly") == qualifiers.npos)
        text += " void " + name + "Store(int at, uvec4 texel) { " + name + "[at] = texel; }";
    return text;
}

}  // namespace

std::string withTexelsInStorage(std::string text) {
    for (std::size_t at = 0; (at = text.find(kDeclared, at)) != text.npos;) {
        const std::size_t line = text.rfind('\n', at) + 1, end = text.find(';', at);
        const std::size_t layout = text.find(kLayout, line), format = text.find(kFormat, line);
        if (!(layout < format && format < at && end != text.npos))
            throw SystemError("a texel buffer is not declared as expected: " +
                              text.substr(line, text.find('\n', at) - line));
        const std::size_t nameAt = at + kDeclared.size(), qualifiers = format + kFormat.size();
        const std::string name = text.substr(nameAt, end - nameAt);
        const std::string storage =
            storageOf(std::string_view(text).substr(layout, format - layout),
                      std::string_view(text).substr(qualifiers, at - qualifiers), name);
        text.replace(layout, end + 1 - layout, storage);
        replaceAll(text, "imageLoad(" + name + ",", name + "Load(");
        replaceAll(text, "imageStore(" + name + ",", name + "Store(");
        at = layout + storage.size();
    }
    return text;
}

}  // namespace fw
