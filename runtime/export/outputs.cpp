#include "runtime/export/outputs.h"

#include <filesystem>

#include "graph/assets/triangle_mesh.h"
#include "graph/document/named_files.h"
#include "runtime/system/output_file.h"

namespace fw {

namespace fs = std::filesystem;

namespace {

bool isOneFile(const std::string& a, const std::string& b) {
    std::error_code failure;
    const auto place = [&](const std::string& path) {
        return fs::weakly_canonical(fs::absolute(path, failure), failure);
    };
    const fs::path path = place(a);  // empty if it cannot be found out
    // equivalent() knows names that the file system takes for one.
    return (!path.empty() && path == place(b)) || fs::equivalent(a, b, failure);
}

}  // namespace

Done checkDistinct(const std::string& graph, const std::vector<std::string>& outputs) {
    std::vector<std::string> seen{graph};
    for (const std::string& output : outputs) {
        for (const std::string& other : seen)
            if (isOneFile(output, other))
                return Error{.message = &other == &seen.front()
                                            ? "this would replace the graph: write to another file"
                                            : "two outputs would go to this file: write to another file",
                             .file = output};
        seen.push_back(output);
    }
    return done();
}

std::vector<std::string> filesRead(const Graph& graph) {
    const fs::path folder = fs::path(graph.path).parent_path();
    std::vector<std::string> files;
    const auto add = [&](const fs::path& file) {
        std::error_code failure;
        const bool there = file.string().find('\0') == std::string::npos && fs::exists(file, failure);
        if (there) files.push_back(file.string());
        return there;
    };
    for (const NamedFile& named : namedFiles(graph)) {
        const fs::path file = folder / named.path;
        if (add(file) && named.kind == &kMeshFile)
            for (const std::string& piece : piecesOfMesh(file.string())) add(file.parent_path() / piece);
    }
    return files;
}

Done checkReplacesNone(const std::vector<std::string>& read, const std::vector<std::string>& outputs) {
    for (const std::string& output : outputs)
        for (const std::string& file : read) {
            std::error_code failure;
            if (fs::equivalent(output, file, failure))
                return Error{.message = "this would replace " + inQuotes(fs::path(file).filename().string()) +
                                        ", which is read: write to another file",
                             .file = output};
        }
    return done();
}

Done checkCanBeWritten(const std::vector<std::string>& outputs) {
    for (const std::string& output : outputs)
        if (const auto created = OutputFile::open(output, nullptr); !created) return created.error();
    return done();
}

}  // namespace fw
