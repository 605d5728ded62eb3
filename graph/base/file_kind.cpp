#include "graph/base/file_kind.h"

#include <algorithm>
#include <filesystem>

namespace fw {

std::string endingOf(std::string_view path) {
    std::string ending = std::filesystem::path(path).extension().string();
    for (char& c : ending)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return ending;
}

bool endsAs(const FileKind& kind, std::string_view path) {
    return kind.endings.empty() || std::ranges::find(kind.endings, endingOf(path)) != kind.endings.end();
}

std::string anyOf(const FileKind& kind) {
    if (kind.endings.empty()) return "a " + std::string(kind.noun);
    std::string text = "a ";
    for (std::size_t i = 0; i < kind.endings.size(); ++i) {
        if (i > 0) text += i + 1 < kind.endings.size() ? ", " : " or ";
        text += kind.endings[i];
    }
    return text + " file";
}

Error fileProblem(const std::string& path, const FileKind& kind, const std::string& what) {
    return {.message = "the " + std::string(kind.noun) + " " + inQuotes(path) + " " + what};
}

Error wrongEnding(const std::string& path, const FileKind& kind) {
    Error error = fileProblem(path, kind, "is of no format that is read: use " + anyOf(kind));
    error.code = Error::Code::wrongFile;
    return error;
}

Error noFileNamed(const FileKind& kind) {
    return {.message = "no file is named: write the path of " + anyOf(kind)};
}

}  // namespace fw
