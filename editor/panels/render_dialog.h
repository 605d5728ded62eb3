// The dialog that makes pictures of the document: stills, the frames of its timeline, and turntables. It
// stays open beside the work, and what was asked for is made one after the other (files/render_queue.h),
// while the dialog is closed too.
//
// Lifetime: part of the Editor; the list is of this run of the program.
#pragma once

#include <imgui.h>

#include <array>
#include <memory>
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
    RenderSubject subject = RenderSubject::still;
    std::string file = {}, folder = {};  ///< of a still, of frames
    std::string forFile = {};            ///< the document's file when they were proposed
    PictureWish picture = {};
    double seconds = 0.0;          ///< on the timeline, of what rests
    double framesPerSecond = 0.0;  ///< 0: the timeline's
    double turn = 4.0;             ///< seconds that a turntable takes
    bool overwrite = false;
    bool asSeen = false;  ///< by the viewport's camera, rather than the document's
    FileBrowser browser;
    std::unique_ptr<RenderQueue> queue = {};  ///< null: nothing was asked for yet
    uint64_t looked = 0;                      ///< the item whose picture is shown; 0: the last one
    uint64_t heard = 0;                       ///< items up to this one have ended, and it was said
    ImTextureID texture = nullptr;
    std::shared_ptr<const Picture> textured = {};  ///< what is in the texture
};

/// Opens it, or brings it to the front. Files beside the document's are proposed.
void openRender(Editor& editor);
/// One frame of it, if it is open; says what came of what ended while it was not.
void showRender(Editor& editor);
/// Whether pictures are being made, or wait to be.
bool renders(const Editor& editor);

}  // namespace fw::editor
