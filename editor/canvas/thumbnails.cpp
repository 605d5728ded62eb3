#include "editor/canvas/thumbnails.h"

#include <chrono>
#include <exception>

namespace fw::editor {

void Thumbnails::toggle(Shell& shell, const std::string& node) {
    const auto found = shown.find(node);
    if (found == shown.end()) {
        shown.emplace(node, Shown{});
        return;
    }
    shell.forget(found->second.texture);
    shown.erase(found);
}

void Thumbnails::clear(Shell& shell) {
    while (!shown.empty()) toggle(shell, std::string(shown.begin()->first));
    path.clear();
}

void Thumbnails::rename(const std::string& before, const std::string& after) {
    if (auto entry = shown.extract(before)) {
        entry.key() = after;
        shown.insert(std::move(entry));
    }
    if (path == before) path = after;
}

void Thumbnails::keepOnly(Shell& shell, const std::function<bool(const std::string&)>& exists) {
    std::vector<std::string> gone;
    for (const auto& [node, there] : shown)
        if (!exists(node)) gone.push_back(node);
    for (const std::string& node : gone) toggle(shell, node);
}

bool Thumbnails::follow(Shell& shell, const std::shared_ptr<const Graph>& graph, uint64_t current,
                        const std::vector<FieldVolumePtr>& particles, bool rests) {
    bool fresh = false;
    if (working.isThere()) {
        const Result<Thumbnail> result = working.take();
        // It may have been taken away meanwhile.
        if (const auto found = shown.find(path); found != shown.end()) {
            Shown& there = found->second;
            there.revision = revision;
            there.problem = result ? "" : result.error().message;
            there.moves = !result || result->particles;
            there.particles = std::move(given);
            if (result) there.made = result->made;
            if (result && !result->picture.pixels.empty())
                there.texture = shell.show(there.texture, result->picture);
            fresh = true;
        }
    }
    if (working.begun() || !rests) return fresh;
    for (const auto& [node, there] : shown) {
        const bool moved = there.moves && !particles.empty() && there.particles != particles;
        if (there.revision == current && !moved) continue;
        path = node, revision = current, given = particles;
        working.begin([graph, particles, node = node, made = there.made]() -> Result<Thumbnail> {
            try {
                return thumbnail(*graph, node, particles, made);
            } catch (const std::exception& error) { return Error{.message = error.what()}; }
        });
        break;
    }
    return fresh;
}

}  // namespace fw::editor
