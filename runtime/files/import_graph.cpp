#include "runtime/files/import_graph.h"

#include <filesystem>
#include <fstream>
#include <iterator>

#include "graph/base/file_kind.h"
#include "graph/document/json.h"
#include "graph/implicit3mf/import.h"
#include "runtime/system/output_file.h"

namespace fw {

namespace {

constexpr std::string_view k3mfEndings[] = {k3mfEnding};
constexpr FileKind k3mfFile = {.noun = "3MF file", .endings = k3mfEndings, .mostBytes = 256u << 20};

Result<std::string> bytesOf(const std::string& path) {
    const auto problem = [&](const std::string& what) {
        Error error = fileProblem(path, k3mfFile, what);
        error.file = path;
        return error;
    };
    std::error_code unknown;
    if (!std::filesystem::exists(path, unknown)) return problem("is not there: check the path");
    if (!std::filesystem::is_regular_file(path, unknown)) return problem("is no file");
    const std::uintmax_t size = std::filesystem::file_size(path, unknown);
    if (size > k3mfFile.mostBytes)
        return problem("is larger than " + std::to_string(k3mfFile.mostBytes >> 20) + " MB");
    std::ifstream in(path, std::ios::binary);
    std::string bytes(std::istreambuf_iterator<char>(in), {});
    if (!in) return problem("cannot be read: check its permissions");
    return bytes;
}

Done writeBeside(const std::filesystem::path& file, const std::string& bytes) {
    std::error_code problem;
    std::filesystem::create_directories(file.parent_path(), problem);
    if (problem)
        return Error{.message = "cannot make the folder: " + problem.message(),
                     .file = file.parent_path().string()};
    Result<OutputFile> out = OutputFile::open(file.string(), nullptr);
    if (!out) return out.error();
    out->write(bytes);
    return out->commit();
}

}  // namespace

bool isImported(const std::string& path) { return endingOf(path) == k3mfEnding; }

Result<ImportedFiles> importGraph(const std::string& path, const std::string& graphPath) {
    if (!isImported(path)) return wrongEnding(path, k3mfFile);
    const Result<std::string> bytes = bytesOf(path);
    if (!bytes) return bytes.error();
    const std::filesystem::path to(graphPath);
    std::string stem = to.filename().string();
    stem = stem.substr(0, stem.find('.'));
    Result<Imported> imported = import3mf(*bytes, path, (stem.empty() ? "imported" : stem) + "_3mf");
    if (!imported) return imported.error();
    ImportedFiles files{graphPath, {}, std::move(imported->warnings)};
    for (const FileBeside& file : imported->files) {
        const std::filesystem::path beside = to.parent_path() / file.path;
        if (const Done written = writeBeside(beside, file.bytes); !written) return written.error();
        files.beside.push_back(beside.string());
    }
    if (const Done saved = saveGraph(imported->graph, graphPath); !saved) return saved.error();
    return files;
}

}  // namespace fw
