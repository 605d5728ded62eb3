// The samples that come with the program: graphs to learn from, each with a picture.
//
// Lifetime: one gallery a program. The pictures are read on a thread of their own when it is first opened,
// and stay.
#pragma once

#include <atomic>
#include <future>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "editor/shell/shell.h"

namespace fw::editor {

/// The folder that the samples lie in: beside the program or above it, as in the source tree, or where they
/// were installed. Empty if there is none.
std::string samplesFolder();
/// Whether the file is one of them.
bool isSample(const std::string& path);

struct Sample {
    std::string path;
    std::string label;  ///< "Brick block"
};
/// All in the folder, by name.
std::vector<Sample> listSamples(const std::string& folder);
/// A sample's picture at half its size; empty if there is none.
Picture pictureOf(const Sample& sample);

struct Samples {
    Samples() = default;
    Samples(const Samples&) = delete;
    Samples& operator=(const Samples&) = delete;
    ~Samples() { stop = true; }

    bool opening = false;
    std::vector<Sample> all;
    std::vector<ImTextureID> textures;  ///< of each; null as long as it has none

    std::mutex mutex;
    std::vector<std::pair<std::size_t, Picture>> read;  ///< pictures for whoever shows the next frame
    std::atomic<bool> stop = false;
    std::future<void> reading;
};

/// One frame of the gallery, if it is open. The path of the sample that was chosen, once.
std::optional<std::string> show(Samples& samples, Shell& shell);

}  // namespace fw::editor
