// A picture of a graph as it is wanted, by `fieldwright render` or in the editor's render dialog: what both
// make of the same wish has the same bytes.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "runtime/play/player.h"

namespace fw {

enum class PictureFormat : unsigned char { png, exr };
/// "png" or "exr".
std::string nameOf(PictureFormat format);

struct PictureWish {
    int width = 1280, height = 720;  ///< pixels
    int samples = 16;                ///< frames that it is the mean of, or paths of light
    uint32_t view = RENDER_PICTURE;  ///< index in renderViews()
    std::string leastWidth = {};     ///< red below it, where the view is of widths: a length as it is typed
                                     ///< ("0.8mm"); empty: the usual one
    FieldBy quality = FieldBy::sooner;
    PictureFormat format = PictureFormat::png;
    bool transparent = false;  ///< the solid alone, with alpha
    bool reference = false;    ///< the ground truth: the field itself, each ray to its end
    int bounces = 0;           ///< of the reference's paths of light; 0: as many as the solid needs
};

/// The names of what a picture can show, in the order of RENDER_PICTURE and the following.
const std::vector<std::string>& renderViews();

/// What the renderer is told of it.
RenderOptions renderOptions(const PictureWish& wish, const Player& player);
/// Who evaluates the field for it: kernels if its view traces it.
FieldBy renderedBy(const PictureWish& wish);
/// Whether it is made of paths of light, which can be kept when it is ended (kept_paths.h); and whether these
/// leave out a fog that the scene has.
bool tracesPaths(const RenderOptions& render);
bool leavesOutFog(const RenderOptions& render, const Player& player);

/// Writes the picture, of which an EXR file has the light; `kept` as in OutputFile::commit(). Errors: as
/// OutputFile.
Done save(const Picture& picture, const LightPicture& light, PictureFormat format, const std::string& path,
          const std::function<void()>& kept = {});

/// Width and height of the picture in a file; none if it is not one of this format, or not a whole one.
std::optional<std::pair<int, int>> sizeOfPicture(const std::string& path, PictureFormat format);

}  // namespace fw
