// The kinds of files that a graph may name: how such a file ends, how large it may be, what messages call it.
//
// An input of the node library refers to its kind here (InputSpec::file); the reader of a kind lies in
// graph/assets/. Whoever asks what an input takes, or which input takes a file, reads these entries: the
// checker, the reference, the editor. Lifetime: constants.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "graph/base/result.h"

namespace fw {

struct FileKind {
    std::string_view noun;                           ///< "picture"
    std::span<const std::string_view> endings = {};  ///< of such files' names, in small letters; none: any
    std::size_t mostBytes = 0;                       ///< of one file
    bool byContent = false;  ///< what it holds tells the format, so that it may end otherwise
    /// It is made from a document and can be made again: it lies wherever there is room, and is not brought
    /// along.
    bool apart = false;
};

inline constexpr std::string_view kPictureEndings[] = {".png", ".jpg", ".jpeg", ".bmp", ".tga"};
inline constexpr std::string_view kMeshEndings[] = {".glb", ".gltf", ".obj", ".stl", ".ply"};
inline constexpr std::string_view kParticleEndings[] = {".ply", ".vtk", ".bgeo", ".obj",
                                                        ".csv", ".txt", ".xyz"};
inline constexpr std::string_view kEnvironmentEndings[] = {".hdr", ".exr", ".png", ".jpg", ".jpeg"};

inline constexpr FileKind kPictureFile = {
    .noun = "picture", .endings = kPictureEndings, .mostBytes = 64u << 20, .byContent = true};
inline constexpr FileKind kMeshFile = {.noun = "mesh", .endings = kMeshEndings, .mostBytes = 512u << 20};
inline constexpr FileKind kParticleFile = {
    .noun = "particle file", .endings = kParticleEndings, .mostBytes = 512u << 20};

inline constexpr std::string_view kParticleCacheEndings[] = {".cache"};
inline constexpr FileKind kParticleCacheFile = {
    .noun = "particle cache", .endings = kParticleCacheEndings, .mostBytes = 64u << 20, .apart = true};

inline constexpr std::string_view kSvgEndings[] = {".svg"};
inline constexpr std::string_view kDxfEndings[] = {".dxf"};
inline constexpr std::string_view kFontEndings[] = {".ttf", ".otf", ".ttc"};
inline constexpr FileKind kSvgFile = {.noun = "drawing", .endings = kSvgEndings, .mostBytes = 16u << 20};
inline constexpr FileKind kDxfFile = {.noun = "drawing", .endings = kDxfEndings, .mostBytes = 64u << 20};
/// Either of the two.
inline constexpr std::string_view kDrawingEndings[] = {".svg", ".dxf"};
inline constexpr FileKind kDrawingFile = {
    .noun = "drawing", .endings = kDrawingEndings, .mostBytes = 64u << 20};
inline constexpr FileKind kFontFile = {.noun = "font", .endings = kFontEndings, .mostBytes = 64u << 20};

inline constexpr FileKind kEnvironmentFile = {
    .noun = "environment map", .endings = kEnvironmentEndings, .mostBytes = 512u << 20, .byContent = true};

/// The ending of the path's name with its point, in small letters: ".png".
std::string endingOf(std::string_view path);

/// Whether files of this kind end as the path does.
bool endsAs(const FileKind& kind, std::string_view path);

/// "a .png, .jpg or .bmp file"; of a kind that may end in any way "a buffer".
std::string anyOf(const FileKind& kind);

/// "the picture 'a.png' " and what is wrong with it.
Error fileProblem(const std::string& path, const FileKind& kind, const std::string& what);

/// That the path's ending is none of the kind's.
Error wrongEnding(const std::string& path, const FileKind& kind);

/// That the input which takes such a file names none.
Error noFileNamed(const FileKind& kind);

}  // namespace fw
