// The pictures of their own fields that nodes have above them, on demand: made one at a time beside the
// interface, anew when the document changed, not while a hand still changes it.
//
// Lifetime: part of the Editor; the destructor waits for the picture under way. The textures are the Shell's.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "editor/preview/thumbnail.h"
#include "editor/shell/made_aside.h"

namespace fw::editor {

struct Thumbnails {
    struct Shown {
        uint64_t revision = 0;  ///< of the document that it was last made of
        uint64_t made = 0;      ///< as Thumbnail::made
        ImTextureID texture = nullptr;
        std::string problem;                    ///< why there is none
        bool moves = false;                     ///< whether other particles may change it
        std::vector<FieldVolumePtr> particles;  ///< that it was made with
    };
    std::map<std::string, Shown> shown;  ///< by the node's path, "group/node"

    /// Shows the node's, or takes it away.
    void toggle(Shell& shell, const std::string& path);
    /// Takes away all.
    void clear(Shell& shell);
    /// The node has another path now.
    void rename(const std::string& before, const std::string& after);
    /// Takes away those of nodes that are gone.
    void keepOnly(Shell& shell, const std::function<bool(const std::string&)>& exists);
    /// Takes the picture that was made, and begins the next that is out of date unless `rests` is false.
    /// `particles` are those of the viewport's picture; none while it is being made. Whether there is
    /// something new to be drawn.
    bool follow(Shell& shell, const std::shared_ptr<const Graph>& graph, uint64_t revision,
                const std::vector<FieldVolumePtr>& particles, bool rests);

  private:
    std::string path;  ///< of the one under way
    uint64_t revision = 0;
    std::vector<FieldVolumePtr> given;
    MadeAside<Result<Thumbnail>> working;
};

}  // namespace fw::editor
