// The picture split in up to four, each seen through an eye of its own: perspective, and orthographic from
// the front, the right and the top, as drawings of machines and quad views have them.
//
//     2: side by side, or the second below      3, 4: the third angle
//                                               | top |     |     first     |
//        | first | front |                      |     | 1st |               |
//                                               |front|right|  front | right|
//
// One of them has the hand: the one under the mouse, or that which had it last. The Viewport is that one, so
// that all that looks, clicks, drags and draws knows of one picture alone; the others lie beside it as values
// until takeHand() exchanges them. Cameras are no part of the document, and no step of undo.
#pragma once

#include <imgui.h>

#include <array>
#include <memory>
#include <optional>

#include "editor/canvas/view.h"
#include "editor/preview/preview.h"
#include "editor/viewport/orbit.h"

namespace fw::editor {

class Shell;
struct Editor;
struct Viewport;

inline constexpr std::size_t kMostPictures = 4;

/// Through what a picture is looked at.
struct Eye {
    bool ownCamera = false;  ///< rather than the scene's, or the solid framed
    Orbit orbit;             ///< of the own camera
    /// Through a very long lens (projection.h): `orbit` is as if it were not.
    bool orthographic = false;
    /// Made the scene's in this revision: what is seen, until a picture of it has come.
    std::optional<Camera> handed;
    uint64_t handedIn = 0;
    /// It is to look from there at the whole solid, once that is known; until then it has no picture.
    std::optional<Side> awaits;

    /// The own camera.
    Camera own() const;
};
using Eyes = std::array<Eye, kMostPictures>;
/// As they are at first.
Eyes firstEyes();

/// Where one of the pictures is, and what it shows.
struct Pane {
    Area place;  ///< pixels of the window
    ImTextureID texture = nullptr;
    Camera seen = {};  ///< by which that was drawn
    bool hovered = false;
    std::shared_ptr<const Picture> shown = {};  ///< in the texture; null: that of the viewport's result
};

struct Split {
    std::size_t count = 1,
                last = kMostPictures;       ///< pictures; and how many there were when it was split last
    std::size_t hand = 0;                   ///< the one that the Viewport is
    std::array<Pane, kMostPictures> panes;  ///< but for that one
};

/// Where so many pictures are in the room for them, in whole pixels, parted by `gap`.
std::array<Area, kMostPictures> placesOf(const Area& room, std::size_t count, float gap);

/// The hand goes to that picture.
void takeHand(Viewport& viewport, std::size_t picture);
/// As takeHand(), until the end of the block.
class Borrowed {
  public:
    Borrowed(Viewport& viewport, std::size_t picture);
    Borrowed(const Borrowed&) = delete;
    Borrowed& operator=(const Borrowed&) = delete;
    ~Borrowed();

  private:
    Viewport& viewport;
    std::size_t before;
};

/// Whether the mouse is over any of the pictures.
bool anyHovered(const Viewport& viewport);
/// The same of a place that the mouse has come to since the last frame, whatever lies above the pictures.
bool isOverAny(const Viewport& viewport, ImVec2 place);

/// Splits the picture in so many; one: the first alone, as it was.
void splitInto(Editor& editor, std::size_t count);
/// All look as they did at first.
void resetEyes(Viewport& viewport);
/// Puts the eyes to where they look at the whole solid, if they wait for that.
void aimEyes(Viewport& viewport);

/// What all of them are to show.
void wishPictures(Viewport& viewport, PreviewWish& wish);
/// What was made of that.
void takePictures(Viewport& viewport, Shell& shell, PreviewResult result);

}  // namespace fw::editor
