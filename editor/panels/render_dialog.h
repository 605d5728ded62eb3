// The dialog that makes pictures of the document: stills, the frames of its timeline, and turntables. It
// stays open beside the work, and what was asked for is made one after the other (files/render_queue.h),
// while the dialog is closed too.
//
// Lifetime: part of the Editor; the list is of this run of the program.
#pragma once

#include <imgui.h>

#include <array>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "editor/files/browser.h"
#include "editor/files/render_queue.h"
#include "editor/panels/staying_dialog.h"

namespace fw::editor {

struct Editor;
class Shell;

/// What is made of the document.
enum class RenderSubject : unsigned char { still, timeline, range, turntable };

struct RenderDialog : StayingDialog {
    /// What is asked of the document that is shown; of another one it begins anew.
    struct OfDocument {
        uint64_t document = 0;               ///< Viewport::document
        std::string file = {}, folder = {};  ///< as typed or chosen; empty: the one proposed
        std::optional<double> seconds = {};  ///< on the timeline, of what rests; none: what is seen
        double framesPerSecond = 0.0;        ///< 0: the timeline's
    } of;
    RenderSubject subject = RenderSubject::still;
    PictureWish picture = {};
    double turn = 4.0;  ///< seconds that a turntable takes
    bool overwrite = false;
    bool asSeen = false;  ///< by the viewport's camera, rather than the document's
    FileBrowser browser;
    std::unique_ptr<RenderQueue> queue = {};  ///< null: nothing was asked for yet
    uint64_t looked = 0;                      ///< the item whose picture is shown; 0: the last one
    std::set<uint64_t> awaited = {};          ///< items that had not ended when they were last looked at
    ImTextureID texture = nullptr;
    std::shared_ptr<const Picture> textured = {};  ///< what is in the texture

    /// How many of the frames that are asked for are there already, and of what that was counted when.
    struct Counted {
        std::string asked = {};
        long made = 0;         ///< by the queue until then
        double seconds = 0.0;  ///< of ImGui's clock
        long there = 0;
    } counted;
};

/// Opens it, or brings it to the front. Files beside the document's are proposed.
void openRender(Editor& editor);
/// One frame of it, if it is open; says what came of what ended while it was not.
void showRender(Editor& editor);
/// How far the item is, or what came of it, in a line.
std::string wordsOf(const RenderItem& item);
/// Whether pictures are being made, or wait to be.
bool renders(const Editor& editor);

}  // namespace fw::editor
