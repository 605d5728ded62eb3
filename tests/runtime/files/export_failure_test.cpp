// What an export leaves behind when it cannot succeed: one clear error, no new file, and the old file as it
// was.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <limits>

#include "runtime/export/export.h"
#include "runtime/system/output_file.h"
#include "tests/support/graph/temp_dir.h"
#include "tests/support/meshes.h"

namespace fw::export_failure_test {

using test::TempDir;

constexpr const char* kExtensions[] = {".glb", ".gltf", ".obj", ".stl", ".ply", ".3mf", ".vdb"};

std::string messageOf(const Mesh& mesh, const std::string& path, const ExportOptions& options = {}) {
    const Result<ExportedFiles> written = exportMesh(mesh, path, options);
    if (written) return "(written)";
    // The file at fault: the one asked for or the one beside it.
    EXPECT_EQ(std::filesystem::path(written.error().file).replace_extension(),
              std::filesystem::path(path).replace_extension());
    return written.error().message;
}

/// Expects `path` to be refused with a message that contains `part`, and nothing in the folder to change.
void expectRefused(const TempDir& folder, const Mesh& mesh, const std::string& path,
                   const std::string& part) {
    const std::vector<std::string> before = folder.names();
    const std::string message = messageOf(mesh, path);
    EXPECT_NE(message.find(part), std::string::npos) << path << ": " << message;
    EXPECT_EQ(folder.names(), before);
}

TEST(ExportFailure, UnknownExtensionNamesTheKnownOnes) {
    const TempDir folder;
    expectRefused(folder, test::cube(), folder.path("mesh.fbx"),
                  "unknown format '.fbx'; known are .glb, .gltf, .obj, .stl, .ply, .3mf and .vdb");
    expectRefused(folder, test::cube(), folder.path("mesh"), "needs an extension");
    expectRefused(folder, test::cube(), folder.path(""), "needs an extension");
    EXPECT_FALSE(checkExportPath("a.glb.bak"));
    EXPECT_TRUE(checkExportPath("a.b/c.Glb"));
}

TEST(ExportFailure, UnfinishedFilesAreRemovedWhenTheProcessEndsAtOnce) {
    const TempDir folder;
    test::writeText(folder.path("b"), "before");
    {
        Result<OutputFile> done = OutputFile::open(folder.path("a"), nullptr),
                           left = OutputFile::open(folder.path("b"), nullptr);
        ASSERT_TRUE(done && left);
        done->write("text");
        EXPECT_TRUE(done->commit());
        const OutputFile moved = std::move(*left);
        EXPECT_EQ(folder.names().size(), 3u);
        OutputFile::removeUnfinished();
        EXPECT_EQ(folder.names(), (std::vector<std::string>{"a", "b"}));
        for (int i = 0; i < 40; ++i) EXPECT_TRUE(OutputFile::open(folder.path("c"), nullptr));
    }
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"a", "b"}));
    EXPECT_EQ(test::readText(folder.path("b")), "before");
}

TEST(ExportFailure, MeshesThatNoFileCanHold) {
    const TempDir folder;
    for (const char* extension : kExtensions) {
        const std::string path = folder.path(std::string("mesh") + extension);
        expectRefused(folder, Mesh{}, path, "nothing to export");
        Mesh mesh = test::cube();
        mesh.positions[3].y = std::numeric_limits<float>::quiet_NaN();
        expectRefused(folder, mesh, path, "not finite");
        mesh.positions[3].y = -std::numeric_limits<float>::infinity();
        expectRefused(folder, mesh, path, "not finite");
        mesh = test::cube();
        mesh.indices[7] = 8;
        expectRefused(folder, mesh, path, "does not have");
    }
}

TEST(ExportFailure, PathsThatCannotBeWritten) {
    const TempDir folder;
    std::filesystem::create_directory(folder.path("folder.glb"));
    std::filesystem::create_symlink("nowhere/else.glb", folder.path("dangling.glb"));
    ASSERT_EQ(0, ::mkfifo(folder.path("pipe.stl").c_str(), 0600));
    expectRefused(folder, test::cube(), folder.path("missing/mesh.glb"), "No such file or directory");
    expectRefused(folder, test::cube(), folder.path("folder.glb"), "it is a folder");
    expectRefused(folder, test::cube(), folder.path("dangling.glb"), "link to nowhere");
    expectRefused(folder, test::cube(), folder.path("pipe.stl"), "not a regular file");
    // Even root may not create files there.
    for (const char* extension : kExtensions)
        EXPECT_NE(messageOf(test::cube(), std::string("/proc/mesh") + extension)
                      .find("cannot create a file in folder '/proc'"),
                  std::string::npos);
}

TEST(ExportFailure, FolderWithoutPermission) {
    const TempDir folder;
    ASSERT_EQ(0, ::chmod(folder.folder.c_str(), 0555));
    // Root is above permissions: a child without its privileges tries instead.
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        if (::geteuid() == 0 && (::setgid(65534) != 0 || ::setuid(65534) != 0)) ::_exit(2);
        const Result<ExportedFiles> written = exportMesh(test::cube(), folder.path("mesh.glb"));
        ::_exit(!written && written.error().message.find("Permission denied") != std::string::npos ? 0 : 1);
    }
    int status = 0;
    ASSERT_EQ(child, ::waitpid(child, &status, 0));
    EXPECT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 0);
    ASSERT_EQ(0, ::chmod(folder.folder.c_str(), 0755));
    EXPECT_TRUE(folder.names().empty());
}

/// Exports over existing files in every format; expects the error, the old contents and nothing else in the
/// folder.
void expectOldFilesSurvive(const TempDir& folder, const Mesh& mesh, const std::string& part,
                           const ExportOptions& options = {}) {
    const std::vector<std::string> old = {"mesh.3mf", "mesh.bin", "mesh.glb", "mesh.gltf", "mesh.mtl",
                                          "mesh.obj", "mesh.ply", "mesh.stl", "mesh.vdb"};
    for (const std::string& name : old) test::writeText(folder.path(name), "old " + name);
    for (const char* extension : kExtensions) {
        const std::string message = messageOf(mesh, folder.path(std::string("mesh") + extension), options);
        EXPECT_NE(message.find(part), std::string::npos) << extension << ": " << message;
    }
    EXPECT_EQ(folder.names(), old);
    for (const std::string& name : old) EXPECT_EQ(test::readText(folder.path(name)), "old " + name);
}

constexpr float kSmallVoxel = 0.007f;  // metres: the torus' level set has some 5 MB, too

TEST(ExportFailure, FileSizeLimit) {
    // What a full disk does in the middle of writing, without the right to mount one.
    const TempDir folder;
    const Mesh mesh = test::torus(400, 300);  // at least 5 MB in every format
    rlimit old{};
    ASSERT_EQ(0, ::getrlimit(RLIMIT_FSIZE, &old));
    const auto handler = ::signal(SIGXFSZ, SIG_IGN);
    const rlimit small{2u << 20, old.rlim_max};
    ASSERT_EQ(0, ::setrlimit(RLIMIT_FSIZE, &small));
    expectOldFilesSurvive(folder, mesh, "File too large", {.cellSize = kSmallVoxel});
    ASSERT_EQ(0, ::setrlimit(RLIMIT_FSIZE, &old));
    ::signal(SIGXFSZ, handler);
}

TEST(ExportFailure, FullDisk) {
    const TempDir folder;
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        // A namespace of its own: the mount ends with the child.
        if (::unshare(CLONE_NEWNS) != 0 && ::unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) ::_exit(2);
        if (::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0) ::_exit(2);
        if (::mount("tmpfs", folder.folder.c_str(), "tmpfs", 0, "size=2m") != 0) ::_exit(2);
        expectOldFilesSurvive(folder, test::torus(400, 300), "No space left on device",
                              {.cellSize = kSmallVoxel});
        ::_exit(::testing::Test::HasFailure() ? 1 : 0);
    }
    int status = 0;
    ASSERT_EQ(child, ::waitpid(child, &status, 0));
    ASSERT_TRUE(WIFEXITED(status));
    if (WEXITSTATUS(status) == 2)
        std::puts(
            "no right to mount a small file system here; ExportFailure.FileSizeLimit covers the same path");
    else
        EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST(ExportFailure, MeshesThatAreNoSolid) {
    const TempDir folder;
    Mesh open = test::cube(), flipped = test::cube(), thrice = test::cube(), collapsed = test::cube();
    open.indices.resize(33);
    test::flip(flipped, 5);
    thrice.indices.insert(thrice.indices.end(), {0, 4, 6, 0, 6, 4});
    collapsed.indices.insert(collapsed.indices.end(), {0, 0, 4});
    struct Case {
        const char* name;
        const Mesh& mesh;
        const char* why;
        bool manifold;
    };
    const Case cases[] = {{"mesh.3mf", open, "not closed: it has 3 open edges", false},
                          {"mesh.glb", open, "not closed: it has 3 open edges", true},
                          {"mesh.vdb", open, "not closed: it has 3 open edges", false},
                          {"mesh.3mf", flipped, "not manifold: it has 3 edges between", false},
                          {"mesh.gltf", flipped, "not manifold: it has 3 edges between", true},
                          {"mesh.3mf", thrice, "not manifold: it has 3 edges of more than two", false},
                          {"mesh.glb", thrice, "not manifold: it has 3 edges of more than two", true},
                          {"mesh.glb", collapsed, "two corners at one place", true},
                          {"mesh.stl", test::cube(), "marked as a solid in .glb and .gltf alone", true}};
    for (const Case& each : cases) {
        const std::string message = messageOf(each.mesh, folder.path(each.name), {.manifold = each.manifold});
        EXPECT_NE(message.find(each.why), std::string::npos) << each.name << ": " << message;
        EXPECT_TRUE(folder.names().empty());
    }
}

TEST(ExportFailure, CancelledBeforeItBegins) {
    const TempDir folder;
    const std::atomic<bool> cancel = true;
    expectOldFilesSurvive(folder, test::torus(40, 30), "cancelled", {.cancel = &cancel});
}

TEST(ExportFailure, CancelledOnTheWay) {
    const TempDir folder;
    test::writeText(folder.path("mesh.glb"), "old");
    std::atomic<bool> cancel = false;
    Result<OutputFile> file = OutputFile::open(folder.path("mesh.glb"), &cancel);
    ASSERT_TRUE(file) << format(file.error());
    const std::string megabytes(8u << 20, 'x');
    file->write(megabytes);
    EXPECT_TRUE(file->good());
    EXPECT_EQ(folder.names().size(), 2u);
    cancel = true;
    file->write(megabytes);
    EXPECT_FALSE(file->good());
    const Done committed = file->commit();
    ASSERT_FALSE(committed);
    EXPECT_NE(committed.error().message.find("cancelled"), std::string::npos);
    EXPECT_EQ(folder.names(), std::vector<std::string>{"mesh.glb"});
    EXPECT_EQ(test::readText(folder.path("mesh.glb")), "old");
}

TEST(ExportFailure, AbandonedFileIsRemoved) {
    const TempDir folder;
    {
        Result<OutputFile> file = OutputFile::open(folder.path("mesh.glb"), nullptr);
        ASSERT_TRUE(file) << format(file.error());
        file->write("some");
        EXPECT_EQ(folder.names().size(), 1u);
    }
    EXPECT_TRUE(folder.names().empty());
}

TEST(OutputFile, ReplacesTheTargetOfALinkAndKeepsItsPermissions) {
    const TempDir folder;
    std::filesystem::create_directory(folder.path("inner"));
    test::writeText(folder.path("inner/real.stl"), "old");
    ASSERT_EQ(0, ::chmod(folder.path("inner/real.stl").c_str(), 0640));
    std::filesystem::create_symlink("inner/real.stl", folder.path("mesh.stl"));
    ASSERT_TRUE(exportMesh(test::cube(), folder.path("mesh.stl")));
    EXPECT_TRUE(std::filesystem::is_symlink(folder.path("mesh.stl")));
    struct stat status {};
    ASSERT_EQ(0, ::stat(folder.path("inner/real.stl").c_str(), &status));
    EXPECT_EQ(status.st_mode & 07777, 0640u);
    EXPECT_EQ(status.st_size, 84 + 12 * 50);
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"inner", "mesh.stl"}));
}

TEST(ExportPieces, AreRefusedBeforeTheyAreMadeWhereTheFormatEnds) {
    const TempDir folder;
    MeshPieces pieces;
    pieces.vertexCount = 150'000'000;
    pieces.triangleCount = 300'000'000;
    pieces.count = 1;
    pieces.load = [](std::size_t, MeshPieces::Part) -> Result<Mesh> { return Error{.message = "(loaded)"}; };
    const auto messageOfPieces = [&](const std::string& name) {
        return exportPieces(pieces, folder.path(name)).error().message;
    };
    EXPECT_NE(messageOfPieces("a.glb").find("4 GiB"), std::string::npos) << messageOfPieces("a.glb");
    EXPECT_EQ(messageOfPieces("a.ply"), "(loaded)");
    EXPECT_EQ(messageOfPieces("a.gltf"), "(loaded)");
    EXPECT_TRUE(folder.names().empty());
}

TEST(ExportPieces, ThatAreNotAsLargeAsWasSaidAreRefused) {
    const TempDir folder;
    const Mesh ring = test::torus(16, 8);
    MeshPieces pieces;
    pieces.count = 1;
    pieces.triangleCount = ring.triangleCount();
    pieces.load = [&](std::size_t, MeshPieces::Part) -> Result<Mesh> { return ring; };
    for (const char* name : {"a.ply", "a.glb", "a.gltf"}) {
        pieces.vertexCount = ring.positions.size();
        EXPECT_TRUE(exportPieces(pieces, folder.path(name))) << name;
        ++pieces.vertexCount;
        const Result<ExportedFiles> more = exportPieces(pieces, folder.path(name));
        ASSERT_FALSE(more) << name;
        EXPECT_NE(more.error().message.find("run the command again"), std::string::npos);
    }
}

TEST(OutputFile, PlacesAreWrittenInAnyOrder) {
    const TempDir folder;
    Result<OutputFile> file = OutputFile::open(folder.path("bytes.glb"), nullptr);
    ASSERT_TRUE(file);
    const std::string large(3u << 20, 'x');
    file->write("ab");
    file->goTo(4 + large.size());
    file->write("ef");
    file->goTo(2);
    file->write(large);
    file->write("cd");
    EXPECT_EQ(file->position(), 4 + large.size());
    EXPECT_EQ(file->size(), 6 + large.size());
    ASSERT_TRUE(file->commit());
    EXPECT_TRUE(test::readText(folder.path("bytes.glb")) == "ab" + large + "cdef");
}

TEST(OutputFile, WritesOfAnySizeArriveInOrder) {
    const TempDir folder;
    Result<OutputFile> file = OutputFile::open(folder.path("bytes.glb"), nullptr);
    ASSERT_TRUE(file) << format(file.error());
    std::string wanted;
    for (std::size_t size : {0u, 1u, 7u, 262143u, 2u, 262144u, 262145u, 3u, 5000000u, 1u, 100000u, 200000u}) {
        std::string part(size, ' ');
        for (std::size_t i = 0; i < size; ++i) part[i] = static_cast<char>('a' + (wanted.size() + i) % 23);
        wanted += part;
        file->write(part);
    }
    EXPECT_EQ(file->size(), wanted.size());
    ASSERT_TRUE(file->commit());
    EXPECT_EQ(test::readText(folder.path("bytes.glb")), wanted);
}

}  // namespace fw::export_failure_test
