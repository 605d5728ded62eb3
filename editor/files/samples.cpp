#include "editor/files/samples.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "editor/controls/tile.h"
#include "editor/files/browser.h"
#include "graph/assets/image.h"
#include "graph/base/own_files.h"

namespace fw::editor {

namespace {

namespace fs = std::filesystem;

constexpr const char* kTitle = "Samples";
constexpr float kTileWidth = 190.0f;  // pixels at scale 1; pictures are 16:9

/// "brick_block" as "Brick block".
std::string labelOf(std::string name) {
    std::ranges::replace(name, '_', ' ');
    if (!name.empty() && name[0] >= 'a' && name[0] <= 'z') name[0] = char(name[0] - 'a' + 'A');
    return name;
}

/// The mean of each two by two texels.
Picture halved(const FieldImage& image) {
    Picture half{image.width / 2, image.height / 2, {}};
    half.pixels.reserve(std::size_t(half.width) * std::size_t(half.height) * 4);
    for (int y = 0; y < half.height; ++y)
        for (int x = 0; x < half.width; ++x) {
            for (unsigned shift = 0; shift < 24; shift += 8) {
                uint32_t sum = 2;
                for (int i = 0; i < 4; ++i) {
                    const int row = image.height - 1 - (2 * y + i / 2), column = 2 * x + i % 2;
                    sum += image.texels[std::size_t(row) * std::size_t(image.width) + std::size_t(column)] >>
                               shift &
                           255u;
                }
                half.pixels.push_back(uint8_t(sum / 4));
            }
            half.pixels.push_back(255);
        }
    return half;
}

}  // namespace

std::string samplesFolder() { return ownFolder("samples", "tower.field.json").string(); }

bool isSample(const std::string& path) {
    const std::string folder = samplesFolder();
    if (path.empty() || folder.empty()) return false;
    std::error_code error;
    return fs::equivalent(fs::absolute(path, error).parent_path(), folder, error);
}

std::vector<Sample> listSamples(const std::string& folder) {
    std::vector<Sample> samples;
    std::string problem;
    if (folder.empty()) return samples;
    for (const FolderEntry& entry : listFolder(folder, {{std::string(kGraphEnding)}}, problem))
        if (!entry.folder)
            samples.push_back({(fs::path(folder) / entry.name).string(),
                               labelOf(entry.name.substr(0, entry.name.size() - kGraphEnding.size()))});
    return samples;
}

Picture pictureOf(const Sample& sample) {
    const fs::path file = sample.path;
    const std::string name = file.filename().string();
    const Result<FieldImagePtr> image =
        readImage((file.parent_path().parent_path() / "docs/pictures/x").string(),
                  name.substr(0, name.size() - kGraphEnding.size()) + ".png");
    return image ? halved(**image) : Picture();
}

std::optional<std::string> show(Samples& samples, Shell& shell) {
    if (std::exchange(samples.opening, false)) {
        ImGui::OpenPopup(kTitle);
        if (samples.all.empty()) {
            samples.all = listSamples(samplesFolder());
            samples.textures.resize(samples.all.size());
            samples.reading = std::async(std::launch::async, [&samples, all = samples.all] {
                for (std::size_t i = 0; i < all.size() && !samples.stop; ++i) {
                    Picture picture = pictureOf(all[i]);
                    if (picture.pixels.empty()) continue;
                    std::lock_guard lock(samples.mutex);
                    samples.read.emplace_back(i, std::move(picture));
                    Shell::wake();
                }
            });
        }
    }
    const float scale = shell.scale();
    const ImVec2 whole = ImGui::GetMainViewport()->Size;
    ImGui::SetNextWindowSize(
        {std::min(840.0f * scale, whole.x * 0.95f), std::min(620.0f * scale, whole.y * 0.9f)},
        ImGuiCond_Appearing);
    ImGui::SetNextWindowPos({0.5f * whole.x, 0.5f * whole.y}, ImGuiCond_Appearing, {0.5f, 0.5f});
    bool stays = true;
    if (!ImGui::BeginPopupModal(kTitle, &stays, ImGuiWindowFlags_NoSavedSettings)) return std::nullopt;
    {
        std::lock_guard lock(samples.mutex);
        for (const auto& [i, picture] : samples.read) samples.textures[i] = shell.show(nullptr, picture);
        samples.read.clear();
    }
    std::optional<std::string> chosen;
    ImGui::TextDisabled("A sample opens as a copy of yours: saving asks for a name.");
    ImGui::BeginChild("##tiles", {0, -ImGui::GetFrameHeightWithSpacing()});
    if (samples.all.empty()) ImGui::TextDisabled("There are no samples beside this program.");
    const float room = ImGui::GetContentRegionAvail().x, gap = ImGui::GetStyle().ItemSpacing.x;
    const int columns = std::max(1, int((room + gap) / (kTileWidth * scale + gap)));
    const float width = (room - gap * float(columns - 1)) / float(columns);
    for (std::size_t i = 0; i < samples.all.size(); ++i) {
        if (int(i) % columns > 0) ImGui::SameLine();
        ImGui::PushID(int(i));
        if (showTile(samples.textures[i], samples.all[i].label, width, width * 9.0f / 16.0f,
                     ImGuiSelectableFlags_DontClosePopups))
            chosen = samples.all[i].path;
        ImGui::PopID();
    }
    ImGui::EndChild();
    const bool closes =
        ImGui::Button("Close", {110 * scale, 0}) || ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape));
    if (chosen || closes) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
    return chosen;
}

}  // namespace fw::editor
